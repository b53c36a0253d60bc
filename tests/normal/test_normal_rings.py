"""Normal modes of waves of a ring: Floquet, Toda's spectral curve, tori with one wave more, integrated variations."""

import json
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import symfpu
from symfpu import Chain, InputError, lindstedt, normal_modes, refine, save, solve_amplitudes, unfold
from symfpu.chain import bonds
from symfpu.cli.main import main
from tests.normal.cases import assert_multipliers
from tests.normal.cases import torus as refined
from tests.tolerances import NORMAL_CONVERGED, NORMAL_VARIATION, PEER_ABSOLUTE, PEER_RELATIVE, PHANTOM_WAVE, SPLIT


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
    wave = symfpu.torus(chain, (seed,), amplitudes={seed: amplitude})
    expected, found = symfpu.floquet(wave), normal_modes(wave)
    assert [mode.mode for mode in found.modes] == [q for q in chain.mode_numbers if q != seed]
    assert_multipliers(found, expected)


def two_waves(chain, omega, order=8):
    return refine(solve_amplitudes(lindstedt(chain, (1, -3), omega, order)))


def test_todas_are_those_of_its_spectral_curve():
    """Signed: those of 2 and -2 differ by 2e-6."""
    chain, omega = ring(8, potential=symfpu.toda("1/2")), ("0.7661", "1.8486")
    exact = symfpu.toda_torus(chain, (1, -3), frequencies=omega, digits=18).normal_frequencies
    found = normal_modes(two_waves(chain, omega)).frequencies
    assert found.keys() == exact.keys()
    assert all(abs(found[q] - float(w)) < NORMAL_CONVERGED for q, w in exact.items())
    assert abs(found[2] - found[-2]) > SPLIT


def test_a_normal_frequency_is_that_of_a_wave_more_at_rest():
    """The 2-torus of 1 and -3 with a small wave -3: it misses sigma_-3 by the square of that amplitude."""
    chain = ring(9, beta=1)
    sigma = normal_modes(symfpu.torus(chain, (1,), amplitudes={1: "0.2"})).frequencies[-3]
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    guess = two_waves(chain, [f"{linear[q] * 1.001:.12f}" for q in (1, -3)], 6)
    missed = [float(symfpu.refine(guess, amplitudes={1: "0.2", -3: A}).omega[-3]) - sigma for A in ("0.02", "0.01")]
    assert missed[0] / missed[1] == pytest.approx(4, rel=PHANTOM_WAVE)


def varied(torus, start, T):
    """A deviation of the particles after T, by the linearised equations of motion about the orbit; complex."""
    law, N = torus.chain.law(), torus.chain.N

    def motion(t, state):
        x, p = state[:N], state[N:]
        r = np.roll(torus.x(t), -1) - torus.x(t)
        tension = (1 + bonds.anharmonic_stiffness(law, r)) * (np.roll(x, -1) - x)
        return np.concatenate([p, tension - np.roll(tension, 1)])

    run = solve_ivp(motion, (0, T), start, method="DOP853", rtol=PEER_RELATIVE, atol=PEER_ABSOLUTE)
    return run.y[:, -1]


def deviation(mode, waves, t, turned=1.0):
    """Positions and momenta of a normal mode at a time, its harmonics turned by the phases of the torus."""
    inner = 1j * (mode.sigma + mode.rates)
    now = turned * np.exp(inner * t)
    return np.concatenate([now @ mode.coefficients @ waves, (inner * now) @ mode.coefficients @ waves])


@pytest.mark.long
def test_variations_turn_with_them():
    """Of a torus of two opposite waves with phases, in the mode 2 and its opposite."""
    chain = ring(7, alpha="0.4", beta="0.2")
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    omega = [f"{linear[1] * 1.0003:.14f}", f"{linear[-3] * 1.0003:.14f}"]
    series = lindstedt(chain, (1, -3), omega, 6)
    torus = refine(solve_amplitudes(series, phases={1: 0.3, -3: 1.1}))
    found = normal_modes(torus, modes=[2, -2])
    offsets = np.array([torus.phases[q] for q in torus.seeds])
    sites = np.arange(chain.N)
    waves = np.exp(-2j * np.pi * np.outer(chain.mode_numbers, sites) / chain.N)
    for mode in found.modes:
        start, end = (deviation(mode, waves, t, np.exp(1j * (mode.harmonics @ offsets))) for t in (0.0, 30.0))
        assert np.abs(varied(torus, start, 30.0) - end).max() < NORMAL_VARIATION
    theta = offsets + 5.0 * np.array([float(w) for w in torus.frequencies])
    assert np.allclose(
        mode.variation(theta) @ waves * np.exp(5j * mode.sigma), deviation(mode, waves, 5.0, np.exp(1j * (mode.harmonics @ offsets)))[:7]
    )


def test_resonances_keep_the_wave():
    found = normal_modes(two_waves(ring(8, potential=symfpu.toda("1/2")), ("0.7661", "1.8486")))
    for one in found.resonances:
        q, other = one.modes[0], one.modes[-1]
        wave = {"own": q, "parametric": 2 * q, "sum": q + other, "difference": q - other}[one.kind]
        assert (np.array(one.harmonic) @ np.array([1, -3]) - wave) % 8 == 0


def test_the_verb_has_series_of_a_ring_and_why_one_has_none(tmp_path, capsys):
    wave = symfpu.torus(ring(6, beta=1), (1,), amplitudes={1: "0.3"})
    assert main(["stability", str(save(tmp_path / "wave", wave)), "--series", "4", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["series"]
    assert found["2"]["closed_shift"] is None
    assert found["-2"]["reason"].startswith("no normal frequency continues mode -2")


def test_rough_waves_are_refused():
    rough = solve_amplitudes(lindstedt(ring(8, alpha=1), (1,), ("0.78",), 2))
    with pytest.raises(InputError, match="refine it first"):
        normal_modes(rough)


STANDING = [(Chain(4, alpha="0.3", beta="0.4"), 1, "0.5"), (Chain(5, beta=1), 2, "0.6")]


@pytest.mark.parametrize(("chain", "seed", "amplitude"), STANDING, ids=repr)
def test_of_standing_waves_they_are_the_multipliers_and_those_of_fixed_ends(chain, seed, amplitude):
    """Sines are the normal modes of the fixed ends; the cosine of the seed is hyperbolic in both."""
    breather = symfpu.torus(chain, (seed,), amplitudes={seed: amplitude})
    waves = unfold(breather)
    expected, found = symfpu.floquet(waves), normal_modes(waves)
    assert_multipliers(found, expected)
    fixed = normal_modes(breather).frequencies
    assert {q: found.frequencies[q] for q in fixed} == pytest.approx(fixed, abs=NORMAL_CONVERGED)
    pairs = [q for q in fixed if abs(found.frequencies[q] - found.frequencies[-q]) > SPLIT]
    assert pairs  # what is one frequency at rest is split
    assert found.mode(-seed).growth > 0


@pytest.mark.long
def test_variations_of_standing_waves():
    """Of two angles: sines and cosines, of the norm of fixed ends."""
    torus = unfold(refined(Chain(4, beta=1), ((1, "0.3"), (2, "0.2"))))
    found = normal_modes(torus)
    assert [mode.mode for mode in found.modes] == [-3, -2, -1, 3, 4]
    sites = np.arange(8)
    waves = []
    for q in torus.chain.mode_numbers:
        shape = np.sin if 0 < q < 4 else np.cos
        waves.append(np.sqrt((1 if q == 4 else 2) / 4) * shape(np.pi * abs(q) * sites / 4))
    for mode in map(found.mode, (-2, 3)):
        start, end = (deviation(mode, waves, t) for t in (0.0, 8.0))
        assert np.abs(varied(torus, start, 8.0) - end).max() < NORMAL_VARIATION


def test_a_displacement_that_costs_nothing_is_named():
    """N = 8: sigma_-1 and omega_1 are apart by an Umklapp of high order alone. The others are found."""
    waves = unfold(symfpu.torus(Chain(8, beta=1), (1,), amplitudes={1: "0.3"}))
    reason = r"mode -1 .*sigma_-1 = \(1\)\.omega, off by"
    for named in ([-1], [-2, -1, 2]):
        with pytest.raises(symfpu.NoNormalModes, match=reason):
            normal_modes(waves, modes=named)
    found = normal_modes(waves)
    assert re.search(reason, found.missing.pop(-1))
    assert not found.missing
    others = [q for q in waves.chain.mode_numbers if q not in (-1, 1)]
    expected = normal_modes(waves, modes=others)
    assert found.frequencies == expected.frequencies
    assert expected.stable


def test_a_missing_mode_leaves_the_verdict_open(tmp_path, capsys):
    file = str(save(tmp_path / "waves", unfold(symfpu.torus(Chain(8, beta=1), (1,), amplitudes={1: "0.3"}))))
    kept = str(tmp_path / "modes.symfpu")
    assert main(["stability", file, "--json", "--save", kept]) == 0
    record = json.loads(capsys.readouterr().out)
    found = symfpu.load(kept)
    assert record["missing"] == {"-1": found.missing[-1]}
    assert (record["stable"], found.stable) == (None, None)
    assert found.verdict == "undecided: no normal frequency of modes -1"
    assert ", no sigma_-1, residual" in repr(found)
    with pytest.raises(InputError, match="see missing"):
        found.mode(-1)
    assert main(["stability", file]) == 0
    assert found.missing[-1] in capsys.readouterr().out.replace("\n", " ")
