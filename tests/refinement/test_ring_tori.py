"""Tori of travelling waves by Newton's method: against integrated orbits, against their series, against Toda's spectral curve."""

from fractions import Fraction
from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, NoTorus, lindstedt, refine, toda_gaps, unfold
from tests.tolerances import CLOSED_GAP_OF_A_TORUS, CONVERGED_DIGITS, NEWTON_SLOPE, ORBIT, PROMISED_RESIDUAL, ROUNDING
from tests.tori.test_ring_torus import integrated, ring

TODA = {"potential": "toda:1/2"}
CASES = {
    "N = 2": (2, {1: 1e-2}, {"beta": 1}),
    "N = 3": (3, {1: 1e-2}, {"alpha": "0.3"}),
    "N = 4, to the left": (4, {-1: 1e-2}, {"beta": 1}),
    "N = 5, wrapped": (5, {2: 1e-2}, {"alpha": "0.3", "beta": "0.2"}),
    "q = N/2": (8, {4: 1e-2}, TODA),
    "softening": (7, {2: -1e-2}, {"beta": -1}),
    "two": (9, {1: 1.5e-3, 4: 2e-3}, {"beta": "0.5"}),
    "opposite": (11, {2: 3e-3, -2: 4e-3}, {"beta": 1}),
    "one to each side": (16, {1: 2e-3, -3: 1e-3}, TODA),
    "an expression": (8, {1: 1e-2, -2: 1e-2}, {"potential": "expr:cosh(r)-1"}),
}
QUICK = {"N = 5, wrapped", "two"}
LONG = {
    "three, a wall": (16, {1: 2e-3, 2: 1e-3, -3: 3e-3}, {"potential": "lj:12,6"}),
    "q = N/2 of three": (16, {1: 2e-3, 8: 1e-3, -3: 2e-3}, TODA),
    "long": (128, {1: 1e-5, 3: 1e-5}, {"alpha": "0.3"}),
}
ALL = [pytest.param(name, marks=[] if name in QUICK else pytest.mark.long) for name in CASES | LONG]
ONE = [pytest.param(name, marks=pytest.mark.long) for name in ("N = 4, to the left", "N = 5, wrapped", "softening")]


def of_series(N, shifts, law, order=4):
    """A torus of travelling waves with omega = Omega (1 + shift), at phases of no symmetry."""
    chain = ring(N, **law)
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    omega = [f"{linear[q] * (1 + shift):.14f}" for q, shift in shifts.items()]
    series = lindstedt(chain, tuple(shifts), omega, order)
    return symfpu.solve_amplitudes(series, phases={q: 0.3 * q for q in shifts})


@cache
def start(name):
    return of_series(*(CASES | LONG)[name])


@cache
def refined(name):
    return refine(start(name))


def seeds_alone(chain, seeds, frequencies, amplitudes):
    """Plain waves, as a guess where no series is."""
    units = np.eye(len(seeds), dtype=np.int64)
    omega = tuple(map(Fraction, frequencies))
    return symfpu.Torus(chain, seeds, omega, units, np.array(amplitudes, dtype=float)[:, None], travels=True)


@pytest.mark.parametrize("name", ALL)
def test_it_solves_the_equations_of_motion(name):
    found, guess = refined(name), start(name)
    assert found.residual() < PROMISED_RESIDUAL < guess.residual()
    assert found.energy_range() < PROMISED_RESIDUAL
    assert (found.frequencies, found.phases, found.seeds) == (guess.frequencies, guess.phases, guess.seeds)
    assert found.warnings == ()
    times = np.linspace(0, 10, 3)
    x, p = integrated(found, times)
    assert np.abs(found.x(times) - x).max() < ORBIT
    assert np.abs(found.p(times) - p).max() < ORBIT
    assert np.abs(found.p(times).sum(axis=1)).max() < ROUNDING


@pytest.mark.parametrize(
    ("law", "N", "q"), [({"beta": 1}, 5, 2), ({"alpha": "0.4"}, 8, -1), pytest.param(TODA, 7, 3, marks=pytest.mark.long)]
)
def test_its_difference_from_a_series_falls_with_the_order_of_the_series(law, N, q):
    """Order K leaves A^(K+2) in omega, that is A^K in the amplitude relative to itself."""
    order, shifts = 4, 1e-3 / 4.0 ** np.arange(3)
    tori = [of_series(N, {q: shift}, law, order // ring(N, **law).degree_step) for shift in shifts]
    errors = [abs(torus.amplitudes[q] / refine(torus).amplitudes[q] - 1) for torus in tori]
    slopes = np.diff(np.log2(errors))
    assert np.abs(slopes + order).max() < NEWTON_SLOPE


TODA_LONG = [(3, (1,)), (4, (2,)), (4, (-1,)), (8, (1, -3)), (7, (3, 2)), (7, (2, -2)), (16, (5, -7, 8))]
TODA_CASES = [(5, (-2,)), (6, (3, 1)), *(pytest.param(*case, marks=pytest.mark.long) for case in TODA_LONG)]


@pytest.mark.parametrize(("N", "seeds"), TODA_CASES)
def test_of_toda_all_gaps_but_those_of_the_seeds_are_closed(N, seeds):
    """One seed is a cnoidal wave; energies are those of the spectral curve with these frequencies."""
    chain = ring(N, **TODA)
    linear = [float(chain.frequencies()[chain.mode_numbers.index(q)]) for q in seeds]
    guess = seeds_alone(chain, seeds, linear, [0.3] * len(seeds))
    found = refine(guess, amplitudes={q: f"0.{3 + i}" for i, q in enumerate(seeds)})
    gaps = dict(zip(chain.mode_numbers, toda_gaps(chain, *found.state()), strict=True))
    open_gaps = {q for q, gap in gaps.items() if gap > CLOSED_GAP_OF_A_TORUS}
    assert open_gaps == set(seeds)
    exact = symfpu.toda_torus(chain, seeds, frequencies=found.frequencies)
    assert np.isclose(found.energy(), float(exact.energy), rtol=CONVERGED_DIGITS)


@pytest.mark.parametrize("name", ["two", pytest.param("opposite", marks=pytest.mark.long)])
def test_amplitudes_give_back_the_frequencies(name):
    found = refined(name)
    given = {q: repr(A) for q, A in found.amplitudes.items()}
    again = refine(start(name), amplitudes=given)
    frequencies = [np.array(torus.frequencies, dtype=float) for torus in (found, again)]
    assert np.allclose(*frequencies, rtol=CONVERGED_DIGITS, atol=0)


@pytest.mark.parametrize("name", ["two", *(pytest.param(name, marks=pytest.mark.long) for name in ("N = 3", "opposite"))])
def test_energies_are_what_was_asked_for(name):
    guess = start(name)
    at_energy = refine(guess, energy="0.02")
    assert np.isclose(at_energy.energy(1.3), 0.02, rtol=CONVERGED_DIGITS)
    sizes = [np.array(list(torus.amplitudes.values())) for torus in (guess, at_energy)]
    assert np.allclose(sizes[0] / sizes[0][0], sizes[1] / sizes[1][0], rtol=CONVERGED_DIGITS)
    harmonic = refine(guess, energy=symfpu.Energy("0.02", harmonic=True))
    assert np.isclose(harmonic.average_spectrum().sum(), 0.02, rtol=CONVERGED_DIGITS)


def test_a_ratio_of_energies_is_that_of_the_averaged_modes():
    """Mode N/2 is its own opposite: all of its waves are in it, half of those of the others."""
    guess = seeds_alone(ring(8, beta=1), (1, 4), (1, 2), (0.2, 0.1))
    found = refine(guess, energy=symfpu.Energy("0.05", energy_ratio={1: 1, 4: 3}))
    spectrum = dict(zip(found.chain.mode_numbers, found.average_spectrum(), strict=True))
    assert np.isclose(spectrum[4] / spectrum[1], 3, rtol=CONVERGED_DIGITS)


@pytest.mark.parametrize("name", ONE)
def test_the_mirror_image_runs_the_other_way(name):
    """x_j(t) and -x_(-j)(t) are both orbits, of any potential."""
    N, shifts, law = CASES[name]
    one = refined(name)
    (q,) = one.seeds
    other = refine(of_series(N, {-q: shifts[q]}, law))
    assert np.isclose(one.amplitude, other.amplitude, rtol=CONVERGED_DIGITS)
    delay = (one.phases[q] - other.phases[-q]) / float(one.frequency)
    x, mirrored = one.x(1.0), other.x(1.0 + delay)
    assert np.abs(x + np.roll(mirrored[::-1], 1)).max() < ORBIT


def test_standing_waves_and_equal_frequencies_are_refused():
    standing = unfold(symfpu.solve_amplitudes(symfpu.lindstedt(Chain(8, beta=1), (1,), ("0.391",), 2)))
    for door in (refine, lambda torus: refine(torus, amplitudes={1: 1})):
        with pytest.raises(InputError, match="unfold"):
            door(standing)
    equal = seeds_alone(ring(16, beta=1), (2, -2), ("0.775", "0.775"), (0.2, 0.2))
    with pytest.raises(InputError, match="omega_2 -1 omega_-2 = 0"):
        refine(equal)
    free = seeds_alone(ring(16, beta=1), (2, -2), ("0.775", "0.776"), (0.2, 0.2))
    with pytest.raises(InputError, match="amplitude_ratio"):
        refine(free, energy=symfpu.Energy(1, energy_ratio={2: 1, -2: 1}))
    series = lindstedt(ring(5, beta=1), (1,), ("1.2",), 2)
    with pytest.raises(InputError, match="torus"):
        refine(series)
    with pytest.raises(InputError, match="tolerance"):
        refine(start("N = 3"), tolerance=0)


@pytest.mark.long
def test_an_umklapp_resonance_is_named():
    guess = seeds_alone(ring(16, beta=1), (4, -4), ("1.43", "1.432"), (0.2, 0.2))
    with pytest.raises(NoTorus, match="Umklapp") as caught:
        refine(guess, amplitudes={4: "0.2", -4: "0.15"})
    assert caught.value.iterate.seeds == (4, -4)
    assert caught.value.residual > PROMISED_RESIDUAL


def test_a_wave_that_its_chain_leaves_harmonic_has_no_amplitude_of_its_own():
    """r_j = +-r: alpha r^2 pulls both neighbours alike, so that omega = 2 at any amplitude."""
    guess = seeds_alone(ring(8, alpha="0.3"), (4,), (2,), (0.1,))
    assert refine(guess, amplitudes={4: "0.2"}).frequencies == (2,)
    with pytest.raises(NoTorus, match="singular"):
        refine(guess)


def test_its_small_divisors_are_what_they_say():
    found = refined("two")
    linear = dict(zip(found.chain.mode_numbers, found.chain.frequencies(), strict=True))
    for near in found.origin.near_resonances:
        rate = sum(n * float(w) for n, w in zip(near.harmonic, found.frequencies, strict=True))
        assert (np.dot(near.harmonic, found.seeds) - near.mode) % 9 == 0
        assert np.isclose(near.divisor, rate**2 - linear[near.mode] ** 2, rtol=ORBIT)
