"""Tori of rings against the equations of motion, integrated by another program, and against fixed ends."""

import inspect
import pickle
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import symfpu
from symfpu import (
    Chain,
    breather_at_amplitude,
    lindstedt,
    pade_poles,
    solve_amplitudes,
    toda_torus,
    travelling_breather,
    travelling_torus,
    travelling_waves,
    unfold,
)
from symfpu.chain import bonds
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES
from tests.tolerances import (
    AMPLITUDE,
    GRID_AVERAGE,
    LEAST_BY_NEIGHBOURS,
    MOST_BY_NEIGHBOURS,
    ONLY_THE_SEEDS,
    ORBIT,
    PEER_ABSOLUTE,
    PEER_RELATIVE,
    PERIODIC_ORBIT,
    POLES,
    RATE_OF_ORDERS,
    RESUMMED,
    ROUNDING,
    TWO_ORDERS,
)


def ring(N, **law):
    return Chain(N, **law, ends="periodic")


def torus(N, seeds, shifts, order, **law):
    chain = ring(N, **law)
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    omega = [f"{linear[q] * (1 + shift):.14f}" for q, shift in zip(seeds, shifts, strict=True)]
    phases = {q: 0.3 * q for q in seeds}
    return travelling_torus(travelling_waves(chain, seeds, omega, order), phases=phases)


def integrated(torus, times):
    law, N = torus.chain.law(DOUBLES), torus.chain.N

    def motion(t, state):
        x, p = state[:N], state[N:]
        tension = bonds.tension(law, np.roll(x, -1) - x)
        return np.concatenate([p, tension - np.roll(tension, 1)])

    start = np.concatenate([torus.positions(0.0), torus.momenta(0.0)])
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


@pytest.mark.long
@pytest.mark.parametrize(("N", "seeds", "shifts", "order", "law"), CASES)
def test_orbits_of_the_particles(N, seeds, shifts, order, law):
    found = torus(N, seeds, shifts, order, **law)
    assert found.residual() < ORBIT
    times = np.linspace(0, 40, 9)
    x, p = integrated(found, times)
    size = np.abs(x).max()
    assert np.abs(found.positions(times) - x).max() < ORBIT * max(size, 1)
    assert np.abs(found.momenta(times) - p).max() < ORBIT * max(size, 1)
    H = found.energy(times)
    assert np.abs(H / H[0] - 1).max() < ORBIT
    assert np.abs(found.momenta(times).sum(axis=1)).max() < ROUNDING
    particles = found.positions(1.0), found.momenta(1.0)
    r = np.roll(particles[0], -1) - particles[0]
    direct = (particles[1] ** 2).sum() / 2 + bonds.potential(found.chain.law(DOUBLES), r).sum()
    assert np.isclose(found.energy(1.0), direct, rtol=ROUNDING)


def test_a_seed_is_the_wave_of_the_docstring():
    found = torus(12, (2, -5), (1e-9, 1.3e-9), 2, beta=1)
    j, t = np.arange(12), 0.7
    expected = 0
    for (q, A), omega in zip(found.amplitudes.items(), found.frequencies, strict=True):
        theta = float(omega) * t + found.phases[q]
        expected = expected + A * np.sin(2 * np.pi * abs(q) * j / 12 - np.sign(q) * theta) / 12**0.5
    assert np.abs(found.positions(t) - expected).max() < ONLY_THE_SEEDS * np.abs(expected).max()


def test_average_spectrum_is_the_mean_over_the_angles():
    found = torus(9, (1, 3), (2e-3, 1e-3), 6, alpha="0.4", beta="0.2")
    total = np.zeros(8)
    number = 24
    for theta in found._angle_grid(number):
        Q = found._sums(theta)
        P = found._sums(theta, -1j * found._rates)
        total += found.chain.harmonic_energies(Q, P).sum(axis=0)
    expected = total / number**2
    assert np.allclose(found.average_spectrum(), expected, rtol=GRID_AVERAGE, atol=GRID_AVERAGE * expected.max())


def test_opposite_waves_of_one_frequency_are_the_standing_wave_of_fixed_ends():
    fixed = solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 8))
    series = travelling_waves(ring(16, alpha="0.3"), (1, -1), ("0.3903", "0.3903"), 8)
    waves = travelling_torus(series)
    A = list(waves.amplitudes.values())
    assert np.allclose(A, fixed.amplitude, rtol=AMPLITUDE * 100, atol=0)
    unfolded = unfold(fixed)
    for t in (0.0, 3.3):
        assert np.allclose(waves.positions(t), unfolded.positions(t), rtol=0, atol=RESUMMED)
        x = fixed.chain.positions(fixed.positions(t))
        assert np.allclose(unfolded.positions(t), [0, *x, 0, *-x[::-1]], rtol=0, atol=ROUNDING)
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
    assert np.abs(found.positions(times) - x).max() < ORBIT


def test_waves_of_toda_converge_to_the_exact_torus():
    """The exact torus by its spectral curve; the mirror image of one wave has another energy."""
    omega = ("0.7661", "1.8486")
    chain = ring(8, potential="toda:1/2")
    exact = float(toda_torus(chain, (1, -3), frequencies=omega).energy)
    energies = [travelling_torus(travelling_waves(chain, (1, -3), omega, K)).energy() for K in (4, 6, 8, 10, 12)]
    errors = np.abs(np.array(energies) / exact - 1)
    ratios = errors[1:] / errors[:-1]
    assert np.allclose(ratios, ratios[0], rtol=RATE_OF_ORDERS)
    assert ratios.max() < TWO_ORDERS
    same_way = travelling_torus(travelling_waves(chain, (1, 3), omega, 12)).energy()
    exact_same_way = toda_torus(chain, (1, 3), frequencies=omega).energy
    assert np.isclose(same_way, float(exact_same_way), rtol=PERIODIC_ORBIT)


def test_breathers_unfold():
    orbit = breather_at_amplitude(Chain(6, alpha="0.3"), 2, "0.4")
    assert np.isclose(unfold(orbit).energy(1.0), 2 * orbit.energy(1.0), rtol=RESUMMED)
    assert unfold(orbit).residual() < PERIODIC_ORBIT


def test_poles_of_the_frequencies_of_opposite_waves_are_those_of_the_standing_wave():
    fixed = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 10)
    waves = travelling_waves(ring(16, alpha="0.3"), (1, -1), ("0.3903", "0.3903"), 10)
    poles = pade_poles(fixed, 1, {1: 0.3})
    assert len(poles)
    assert np.allclose(pade_poles(waves, 1, {1: 0.3, -1: 0.3}), poles, rtol=POLES)
    with pytest.raises(InputError, match="travelling_waves"):
        pade_poles(travelling_torus(waves), 1, {1: 0.3})


def test_waves_of_long_rings_keep_their_digits():
    """Neighbours move nearly alike: forces by differences of positions would be off by 1e-11 of themselves."""
    chain = ring(1024, beta=1)
    wave = travelling_breather(chain, 1, energy="1e-5")
    assert wave.residual() < ROUNDING
    assert not wave.warnings
    Q = wave.mode_coordinates(0.3)
    by_particles = chain.kind_of_ends.forces(bonds.tension(chain.law(), chain.stretches(Q)))
    force = chain.accelerations(Q)
    off = np.abs(chain.modes(by_particles) - force).max() / np.abs(force).max()
    assert LEAST_BY_NEIGHBOURS < off < MOST_BY_NEIGHBOURS


def test_beyond_the_wall_of_a_potential_the_residual_is_infinite():
    chain = Chain(5, potential="lj:12,6", ends="periodic")
    wave = travelling_breather(chain, 1, amplitude="0.01")
    far = replace(wave, sines=500 * wave.sines)
    assert far.residual() == np.inf


def test_other_objects_are_refused():
    found = torus(5, (1,), (1e-3,), 4, beta=1)
    with pytest.raises(InputError, match="travelling_waves"):
        travelling_torus(lindstedt(Chain(8, beta=1), (1,), ("0.4",), 2))
    with pytest.raises(InputError, match="solution"):
        unfold(found)
    with pytest.raises(InputError, match="finite"):
        found.positions(np.inf)
    with pytest.raises(InputError, match="frequency_order"):
        travelling_torus(travelling_waves(ring(5, alpha=1), (1,), ("1.2",), 1))
    copy = pickle.loads(pickle.dumps(found))
    assert np.array_equal(copy.positions(1.0), found.positions(1.0))


SERIES_OR_TORUS = {"series", "torus", "solution", "orbit", "result", "found"}
TAKE_WAVES = {"actions", "travelling_torus", "pade_poles", "save", "refine", "refine_at_amplitudes", "refine_at_energy", "floquet"}
TAKE_WAVES |= {"foretold_indices", "normal_modes", "prove_existence", "solve_normal_frequency", "twist"}
OTHERS = {"path": "never_written", "language": "c", "folder": "never_written", "q": 1, "order": 2, "frequencies": ("0.4",)}


def doors_of_results():
    found = []
    for name in sorted(set(symfpu.__all__) - TAKE_WAVES):
        door = getattr(symfpu, name)
        parameters = [] if inspect.isclass(door) else inspect.signature(door).parameters
        found += [(name, taken) for taken in sorted(SERIES_OR_TORUS & set(parameters))]
    return found


@pytest.mark.parametrize(("name", "taken"), doors_of_results())
def test_doors_of_series_and_solutions_refuse_those_of_a_ring(name, taken):
    """A door that takes both a series and a torus is asked with a ring's in both places."""
    door = getattr(symfpu, name)
    waves = travelling_waves(ring(5, beta=1), (1,), ("1.2",), 2)
    for value in (waves, travelling_torus(waves)):
        needed = [p.name for p in inspect.signature(door).parameters.values() if p.default is p.empty]
        arguments = {p: value if p in SERIES_OR_TORUS else OTHERS.get(p, 1) for p in {*needed, taken}}
        with pytest.raises(InputError, match="|".join(SERIES_OR_TORUS)) as caught:
            door(**arguments)
        assert "\n" not in str(caught.value)
