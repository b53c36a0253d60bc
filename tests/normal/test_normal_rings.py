"""Normal modes of waves of a ring: Floquet, Toda's spectral curve, tori with one wave more, integrated variations."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symfpu.breathers.balance import breather_at_amplitude
from symfpu.breathers.floquet import floquet
from symfpu.bundles.bundle import save
from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.chain.potentials.toda import toda
from symfpu.cli.main import main
from symfpu.errors import InputError
from symfpu.integrable.torus import toda_torus
from symfpu.normal.modes import NoNormalModes
from symfpu.normal.search import normal_modes
from symfpu.refinement.tori import refine, refine_at_amplitudes
from symfpu.refinement.travelling_breather import travelling_breather
from symfpu.saved.results import load
from symfpu.series.travelling import travelling_waves
from symfpu.tori.frequencies import torus_at_amplitudes
from symfpu.tori.ring_torus import travelling_torus, unfold
from tests.tolerances import (
    NORMAL_CONVERGED,
    NORMAL_MULTIPLIER,
    NORMAL_VARIATION,
    PEER_ABSOLUTE,
    PEER_RELATIVE,
    PHANTOM_WAVE,
    SPLIT,
)


def ring(N, **law):
    return Chain(N, **law, ends="periodic")


WAVES = [
    (ring(8, beta=1), 1, "0.3"),
    (ring(7, alpha="0.5"), 2, "0.3"),
    (ring(6, alpha="0.3", beta="0.5"), 3, "0.6"),
    (ring(8, beta=1), 4, "0.6"),
]


@pytest.mark.parametrize(("chain", "seed", "amplitude"), WAVES, ids=repr)
def test_of_one_wave_they_are_the_multipliers(chain, seed, amplitude):
    """The last wave, of zone boundary, is hyperbolic in the modes 3 and -3."""
    wave = travelling_breather(chain, seed, amplitude=amplitude)
    expected, found = floquet(wave), normal_modes(wave)
    assert [mode.mode for mode in found.modes] == [q for q in chain.mode_numbers if q != seed]
    assert found.stable == expected.stable
    ours = np.array(list(found.multipliers().values()))
    ours = np.concatenate([ours, 1 / ours, ours.conj(), 1 / ours.conj()])
    for one, other in ((expected.multipliers[2:], ours), (ours, expected.multipliers[2:])):
        assert max(np.abs(other - value).min() for value in one) < NORMAL_MULTIPLIER


def two_waves(chain, omega, order=8):
    return refine(travelling_torus(travelling_waves(chain, (1, -3), omega, order)))


def test_todas_are_those_of_its_spectral_curve():
    """Signed: those of 2 and -2 differ by 2e-6."""
    chain, omega = ring(8, potential=toda("1/2")), ("0.7661", "1.8486")
    exact = toda_torus(chain, (1, -3), frequencies=omega, digits=18).normal_frequencies
    found = normal_modes(two_waves(chain, omega)).frequencies
    assert found.keys() == exact.keys()
    assert all(abs(found[q] - float(w)) < NORMAL_CONVERGED for q, w in exact.items())
    assert abs(found[2] - found[-2]) > SPLIT


def test_a_normal_frequency_is_that_of_a_wave_more_at_rest():
    """The 2-torus of 1 and -3 with a small wave -3: it misses sigma_-3 by the square of that amplitude."""
    chain = ring(9, beta=1)
    sigma = normal_modes(travelling_breather(chain, 1, amplitude="0.2")).frequencies[-3]
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    guess = two_waves(chain, [f"{linear[q] * 1.001:.12f}" for q in (1, -3)], 6)
    missed = [float(refine_at_amplitudes(guess, {1: "0.2", -3: A}).omega[-3]) - sigma for A in ("0.02", "0.01")]
    assert missed[0] / missed[1] == pytest.approx(4, rel=PHANTOM_WAVE)


def varied(torus, start, T):
    """A deviation of the particles after T, by the linearised equations of motion about the orbit; complex."""
    law, N = torus.chain.law(), torus.chain.N

    def motion(t, state):
        x, p = state[:N], state[N:]
        r = np.roll(torus.positions(t), -1) - torus.positions(t)
        tension = (1 + bonds.anharmonic_stiffness(law, r)) * (np.roll(x, -1) - x)
        return np.concatenate([p, tension - np.roll(tension, 1)])

    run = solve_ivp(motion, (0, T), start, method="DOP853", rtol=PEER_RELATIVE, atol=PEER_ABSOLUTE)
    return run.y[:, -1]


def test_variations_turn_with_them():
    """Of a torus of two opposite waves with phases, in the mode 2 and its opposite."""
    chain = ring(7, alpha="0.4", beta="0.2")
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    omega = [f"{linear[1] * 1.0003:.14f}", f"{linear[-3] * 1.0003:.14f}"]
    series = travelling_waves(chain, (1, -3), omega, 6)
    torus = refine(travelling_torus(series, phases={1: 0.3, -3: 1.1}))
    found = normal_modes(torus, modes=[2, -2])
    offsets = np.array([torus.phases[q] for q in torus.seeds])
    sites = np.arange(chain.N)
    waves = np.exp(-2j * np.pi * np.outer(chain.mode_numbers, sites) / chain.N)
    for mode in found.modes:
        inner = 1j * (mode.sigma + mode.rates)
        turned = np.exp(1j * (mode.harmonics @ offsets))

        def state(t, inner=inner, turned=turned, mode=mode):
            now = turned * np.exp(inner * t)
            return np.concatenate([now @ mode.coefficients @ waves, (inner * now) @ mode.coefficients @ waves])

        assert np.abs(varied(torus, state(0.0), 30.0) - state(30.0)).max() < NORMAL_VARIATION
    theta = offsets + 5.0 * np.array([float(w) for w in torus.frequencies])
    assert np.allclose(mode.variation(theta) @ waves * np.exp(5j * mode.sigma), state(5.0)[:7])


def test_resonances_keep_the_wave():
    found = normal_modes(two_waves(ring(8, potential=toda("1/2")), ("0.7661", "1.8486")))
    for one in found.resonances:
        q, other = one.modes[0], one.modes[-1]
        wave = {"own": q, "parametric": 2 * q, "sum": q + other, "difference": q - other}[one.kind]
        assert (np.array(one.harmonic) @ np.array([1, -3]) - wave) % 8 == 0


def test_the_verb_takes_a_ring(tmp_path, capsys):
    wave = travelling_breather(ring(6, beta=1), 1, amplitude="0.3")
    file, picture = str(save(tmp_path / "wave", wave)), tmp_path / "wave.png"
    assert main(["stability", file, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["normal_frequencies"] == {str(q): repr(w) for q, w in normal_modes(wave).frequencies.items()}
    assert main(["stability", file, "--plot", str(picture)]) == 0
    assert "-1" in capsys.readouterr().out
    assert picture.exists()
    assert main(["stability", file, "--series", "4", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["series"]["2"]["closed_shift"] is None


def test_rough_waves_are_refused():
    rough = travelling_torus(travelling_waves(ring(8, alpha=1), (1,), ("0.78",), 2))
    with pytest.raises(InputError, match="refine it first"):
        normal_modes(rough)


STANDING = [(Chain(4, alpha="0.3", beta="0.4"), 1, "0.5"), (Chain(5, beta=1), 2, "0.6")]


@pytest.mark.parametrize(("chain", "seed", "amplitude"), STANDING, ids=repr)
def test_of_standing_waves_they_are_the_multipliers_and_those_of_fixed_ends(chain, seed, amplitude):
    """Sines are the normal modes of the fixed ends; the cosine of the seed is hyperbolic in both."""
    breather = breather_at_amplitude(chain, seed, amplitude)
    waves = unfold(breather)
    expected, found = floquet(waves), normal_modes(waves)
    assert found.stable == expected.stable
    ours = np.array(list(found.multipliers().values()))
    ours = np.concatenate([ours, 1 / ours, ours.conj(), 1 / ours.conj()])
    for one, other in ((expected.multipliers[2:], ours), (ours, expected.multipliers[2:])):
        assert max(np.abs(other - value).min() for value in one) < NORMAL_MULTIPLIER
    fixed = normal_modes(breather).frequencies
    assert {q: found.frequencies[q] for q in fixed} == pytest.approx(fixed, abs=NORMAL_CONVERGED)
    pairs = [q for q in fixed if abs(found.frequencies[q] - found.frequencies[-q]) > SPLIT]
    assert pairs  # what is one frequency at rest is split
    assert found.mode(-seed).growth > 0


def test_variations_of_standing_waves():
    """Of two angles: sines and cosines, of the norm of fixed ends."""
    amplitudes = {1: "0.3", 2: "0.2"}
    chain = Chain(4, beta=1)
    torus = unfold(refine_at_amplitudes(torus_at_amplitudes(chain, amplitudes, order=6), amplitudes))
    found = normal_modes(torus)
    assert [mode.mode for mode in found.modes] == [-3, -2, -1, 3, 4]
    sites = np.arange(8)
    waves = []
    for q in torus.chain.mode_numbers:
        shape = np.sin if 0 < q < 4 else np.cos
        waves.append(np.sqrt((1 if q == 4 else 2) / 4) * shape(np.pi * abs(q) * sites / 4))
    for mode in map(found.mode, (-2, 3)):
        inner = 1j * (mode.sigma + mode.rates)

        def state(t, inner=inner, mode=mode):
            now = np.exp(inner * t)
            return np.concatenate([now @ mode.coefficients @ waves, (inner * now) @ mode.coefficients @ waves])

        assert np.abs(varied(torus, state(0.0), 8.0) - state(8.0)).max() < NORMAL_VARIATION


def test_a_displacement_that_costs_nothing_is_named():
    """N = 8: sigma_-1 and omega_1 are apart by an Umklapp of high order alone. The others are found."""
    waves = unfold(breather_at_amplitude(Chain(8, beta=1), 1, "0.3"))
    reason = r"mode -1 .*sigma_-1 = \(1\)\.omega, off by"
    for named in ([-1], [-2, -1, 2]):
        with pytest.raises(NoNormalModes, match=reason):
            normal_modes(waves, modes=named)
    found = normal_modes(waves)
    assert re.search(reason, found.missing.pop(-1))
    assert not found.missing
    others = [q for q in waves.chain.mode_numbers if q not in (-1, 1)]
    expected = normal_modes(waves, modes=others)
    assert found.frequencies == expected.frequencies
    assert expected.stable


def test_a_missing_mode_leaves_the_verdict_open(tmp_path, capsys):
    file = str(save(tmp_path / "waves", unfold(breather_at_amplitude(Chain(8, beta=1), 1, "0.3"))))
    kept = str(tmp_path / "modes.symfpu")
    assert main(["stability", file, "--json", "--save", kept]) == 0
    record = json.loads(capsys.readouterr().out)
    found = load(kept).result
    assert record["missing"] == {"-1": found.missing[-1]}
    assert (record["stable"], found.stable) == (None, None)
    assert found.verdict == "undecided: no normal frequency of modes -1"
    assert ", no sigma_-1, residual" in repr(found)
    with pytest.raises(InputError, match="see missing"):
        found.mode(-1)
    assert main(["stability", file]) == 0
    assert found.missing[-1] in capsys.readouterr().out.replace("\n", " ")


def test_waves_that_neither_travel_nor_stand_are_refused():
    waves = unfold(breather_at_amplitude(Chain(4, alpha="0.3"), 1, "0.3"))
    moved = replace(waves, modes=np.where(waves.modes == 2, 3, waves.modes))
    uneven = replace(waves, sines=waves.sines * np.linspace(1, 1 + 1e-10, len(waves.sines)))
    for other in (moved, uneven):
        with pytest.raises(InputError, match=r"refine it first|other waves"):
            normal_modes(other)
