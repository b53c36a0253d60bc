"""Tori of rings against the equations of motion, integrated by another program, and against fixed ends."""

import inspect
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import symfpu
from symfpu import Chain, InputError, lindstedt, pade_poles, solve_amplitudes, toda_torus, unfold
from symfpu.chain import bonds
from symfpu.numbers.arithmetic import DOUBLES
from tests import tolerances
from tests.tolerances import AMPLITUDE, GRID_AVERAGE, ORBIT, PEER_ABSOLUTE, PEER_RELATIVE, POLES, RESUMMED, ROUNDING, TWO_ORDERS


def ring(N, **law):
    return Chain(N, **law, ends="periodic")


def torus(N, seeds, shifts, order, **law):
    chain = ring(N, **law)
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    omega = [f"{linear[q] * (1 + shift):.14f}" for q, shift in zip(seeds, shifts, strict=True)]
    phases = {q: 0.3 * q for q in seeds}
    return solve_amplitudes(lindstedt(chain, seeds, omega, order), phases=phases)


def integrated(torus, times):
    law, N = torus.chain.law(DOUBLES), torus.chain.N

    def motion(t, state):
        x, p = state[:N], state[N:]
        tension = bonds.tension(law, np.roll(x, -1) - x)
        return np.concatenate([p, tension - np.roll(tension, 1)])

    start = np.concatenate([torus.x(0.0), torus.p(0.0)])
    run = solve_ivp(motion, (0, times[-1]), start, method="DOP853", rtol=PEER_RELATIVE, atol=PEER_ABSOLUTE, t_eval=times)
    return run.y[:N].T, run.y[N:].T


CASES = [
    (3, (1,), (1e-3,), 16, {"beta": 1}),
    (4, (-1,), (1e-3,), 16, {"beta": 1}),
    (5, (2,), (1e-3,), 18, {"alpha": "0.3"}),
    (2, (1,), (1e-3,), 14, {"beta": 1}),
    (8, (4,), (1e-3,), 14, {"potential": "toda:1/2"}),
    (9, (1, 4), (1.5e-4, 2e-4), 8, {"beta": "0.5"}),
    (16, (1, -3), (2e-4, 1e-4), 10, {"potential": "toda:1/2"}),
    (11, (2, -2), (3e-4, 4e-4), 7, {"beta": 1}),
]


def test_a_seed_is_the_wave_of_the_docstring():
    found = torus(12, (2, -5), (1e-9, 1.3e-9), 2, beta=1)
    j, t = np.arange(12), 0.7
    expected = 0
    for (q, A), omega in zip(found.amplitudes.items(), found.frequencies, strict=True):
        theta = float(omega) * t + found.phases[q]
        expected = expected + A * np.sin(2 * np.pi * abs(q) * j / 12 - np.sign(q) * theta) / 12**0.5
    assert np.abs(found.x(t) - expected).max() < tolerances.ONLY_THE_SEEDS * np.abs(expected).max()


def test_average_spectrum_is_the_mean_over_the_angles():
    found = torus(9, (1, 3), (2e-3, 1e-3), 6, alpha="0.4", beta="0.2")
    total = np.zeros(8)
    number = 24
    for theta in found.angle_grid(number):
        turned = [replace(found, phases=dict(zip(found.seeds, angles, strict=True))) for angles in theta]
        total += sum(torus.harmonic_energies(0.0) for torus in turned)
    expected = total / number**2
    assert np.allclose(found.average_spectrum(), expected, rtol=GRID_AVERAGE, atol=GRID_AVERAGE * expected.max())


def test_opposite_waves_of_one_frequency_are_the_standing_wave_of_fixed_ends():
    fixed = solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 8))
    series = lindstedt(ring(16, alpha="0.3"), (1, -1), ("0.3903", "0.3903"), 8)
    waves = solve_amplitudes(series)
    A = list(waves.amplitudes.values())
    assert np.allclose(A, fixed.amplitude, rtol=AMPLITUDE * 100, atol=0)
    unfolded = unfold(fixed)
    for t in (0.0, 3.3):
        assert np.allclose(waves.x(t), unfolded.x(t), rtol=0, atol=RESUMMED)
        x = fixed.chain.positions(fixed.Q(t))
        assert np.allclose(unfolded.x(t), [0, *x, 0, *-x[::-1]], rtol=0, atol=ROUNDING)
    assert np.isclose(unfolded.energy(), 2 * fixed.energy(), rtol=ROUNDING)
    spectrum = dict(zip(unfolded.chain.mode_numbers, unfolded.average_spectrum(), strict=True))
    both = [(spectrum[q], spectrum[-q]) for q in range(1, 8)]
    assert np.allclose(both, fixed.average_spectrum()[:, None], rtol=RESUMMED, atol=ROUNDING)
    assert fixed.residual() / 2 < unfolded.residual() < 2 * fixed.residual()


def test_the_way_out_of_a_resonance_solves_the_ring():
    """Seeds 1 and -1 drive the wave -7 of the ring of 16 in resonance with 7; all four as standing waves are a torus."""
    series = lindstedt(Chain(8, beta="0.5"), (1, 7), ("0.3905", "1.9631"), 8)
    found = unfold(solve_amplitudes(series))
    assert found.chain == ring(16, beta="0.5")
    assert found.residual() < ORBIT
    times = np.linspace(0, 40, 5)
    x, _ = integrated(found, times)
    assert np.abs(found.x(times) - x).max() < ORBIT


def test_waves_of_toda_converge_to_the_exact_torus():
    """The exact torus by its spectral curve; the mirror image of one wave has another energy."""
    omega = ("0.7661", "1.8486")
    chain = ring(8, potential="toda:1/2")
    exact = float(toda_torus(chain, (1, -3), frequencies=omega).energy)
    energies = [solve_amplitudes(lindstedt(chain, (1, -3), omega, K)).energy() for K in (4, 6, 8, 10, 12)]
    errors = np.abs(np.array(energies) / exact - 1)
    ratios = errors[1:] / errors[:-1]
    assert np.allclose(ratios, ratios[0], rtol=tolerances.RATE_OF_ORDERS)
    assert ratios.max() < TWO_ORDERS
    same_way = solve_amplitudes(lindstedt(chain, (1, 3), omega, 12)).energy()
    exact_same_way = toda_torus(chain, (1, 3), frequencies=omega).energy
    assert np.isclose(same_way, float(exact_same_way), rtol=tolerances.PERIODIC_ORBIT)


def test_poles_of_the_frequencies_of_opposite_waves_are_those_of_the_standing_wave():
    fixed = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 10)
    waves = lindstedt(ring(16, alpha="0.3"), (1, -1), ("0.3903", "0.3903"), 10)
    poles = pade_poles(fixed, 1, {1: 0.3})
    assert len(poles)
    assert np.allclose(pade_poles(waves, 1, {1: 0.3, -1: 0.3}), poles, rtol=POLES)


def test_sums_of_the_frequencies_of_opposite_waves_are_those_of_the_standing_wave():
    """Amplitudes by order, and resummed frequencies and amplitudes."""
    fixed = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 8)
    waves = lindstedt(ring(16, alpha="0.3"), (1, -1), ("0.3903", "0.3903"), 8)
    history, both = symfpu.amplitude_history(fixed), symfpu.amplitude_history(waves)
    assert history.orders == both.orders
    for K, (A,) in history.amplitudes.items():
        assert np.allclose(both.amplitudes[K], A, rtol=tolerances.COEFFICIENT)
    [A] = history.amplitudes[8]
    one, two = symfpu.pade_frequencies(fixed, {1: A}), symfpu.pade_frequencies(waves, {1: A, -1: A})
    assert np.allclose(two.values, one.values[0], rtol=tolerances.COEFFICIENT)
    alone, shared = symfpu.pade_amplitudes(fixed, {1: A}), symfpu.pade_amplitudes(waves, {1: A, -1: A})
    assert shared[1] == pytest.approx(alone[1], rel=tolerances.RESUMMED_AMPLITUDE)


def test_waves_of_long_rings_keep_their_digits():
    """Neighbours move nearly alike: forces by differences of positions would be off by 1e-11 of themselves."""
    chain = ring(1024, beta=1)
    wave = symfpu.torus(chain, (1,), energy="1e-5")
    assert wave.residual() < ROUNDING
    assert not wave.warnings
    Q = wave.Q(0.3)
    by_particles = chain.kind_of_ends.forces(bonds.tension(chain.law(), chain.stretches(Q)))
    force = chain.accelerations(Q)
    off = np.abs(chain.modes(by_particles) - force).max() / np.abs(force).max()
    assert tolerances.LEAST_BY_NEIGHBOURS < off < tolerances.MOST_BY_NEIGHBOURS


def test_beyond_the_wall_of_a_potential_the_residual_is_infinite():
    chain = Chain(5, potential="lj:12,6", ends="periodic")
    wave = symfpu.torus(chain, (1,), amplitudes={1: "0.01"})
    far = replace(wave, cosines=500 * wave.cosines)
    assert far.residual() == np.inf


def test_other_objects_are_refused():
    found = torus(5, (1,), (1e-3,), 4, beta=1)
    with pytest.raises(InputError, match="solution"):
        unfold(found)
    with pytest.raises(InputError, match="finite"):
        found.x(np.inf)
    with pytest.raises(InputError, match="frequency_order"):
        solve_amplitudes(lindstedt(ring(5, alpha=1), (1,), ("1.2",), 1))


SERIES_OR_TORUS = {"series", "torus", "solution", "orbit", "result", "found"}
TAKE_WAVES = {
    "actions",
    "solve_amplitudes",
    "assess",
    "pade_poles",
    "save",
    "refine",
    "floquet",
}
TAKE_WAVES |= {"amplitude_history", "pade_amplitudes", "pade_frequencies"}
TAKE_WAVES |= {"foretold_indices", "normal_modes", "prove_existence", "solve_normal_frequency", "twist"}
OTHERS = {"path": "never_written", "language": "c", "folder": "never_written", "q": 1, "order": 2, "frequencies": ("0.4",)}


def doors_of_results():
    found = []
    for name in sorted(set(symfpu.__all__) - TAKE_WAVES):
        door = getattr(symfpu, name)
        parameters = inspect.signature(door).parameters if inspect.isfunction(door) else []
        found += [(name, taken) for taken in sorted(SERIES_OR_TORUS & set(parameters))]
    return found


@pytest.mark.parametrize(("name", "taken"), doors_of_results())
def test_doors_of_series_and_solutions_refuse_those_of_a_ring(name, taken):
    """A door that takes both a series and a torus is asked with a ring's in both places."""
    door = getattr(symfpu, name)
    waves = lindstedt(ring(5, beta=1), (1,), ("1.2",), 2)
    for value in (waves, solve_amplitudes(waves)):
        needed = [p.name for p in inspect.signature(door).parameters.values() if p.default is p.empty]
        arguments = {p: value if p in SERIES_OR_TORUS else OTHERS.get(p, 1) for p in {*needed, taken}}
        with pytest.raises(InputError, match="|".join(SERIES_OR_TORUS)) as caught:
            door(**arguments)
        assert "\n" not in str(caught.value)


STRANGE = {
    "travels with fixed ends": (Chain(4, alpha=1), (1,), 3, {"travels": True}, "travels"),
    "stands on an odd ring": (ring(5, alpha=1), (1,), 1, {}, "travels"),
    "stands on two bonds": (ring(2, alpha=1), (1,), 1, {}, "travels"),
    "stands with a seed of N/2": (ring(8, alpha=1), (4,), 3, {}, "travels"),
    "columns of a ring": (ring(8, alpha=1), (1,), 1, {}, "cosines"),
    "columns of fixed ends": (Chain(4, alpha=1), (1,), 2, {}, "cosines"),
    "columns of waves": (ring(8, alpha=1), (1,), 7, {"travels": True}, "cosines"),
}


@pytest.mark.parametrize("name", STRANGE)
def test_coefficients_of_another_kind_of_torus_are_refused(name):
    chain, seeds, columns, how, argument = STRANGE[name]
    with pytest.raises(InputError, match=f"^{argument} = "):
        symfpu.Torus(chain, seeds, (Fraction(3, 4),), np.array([[1]]), np.full((1, columns), 0.1), **how)
