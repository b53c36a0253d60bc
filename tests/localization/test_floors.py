"""Floors of spectra against orbits and series of many digits, and what pictures and fits leave out below them."""

from fractions import Fraction
from functools import lru_cache

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, fit_profile, lindstedt, refine, solve_amplitudes, spectrum_floor
from tests.tolerances import KNOWN_ERROR, LONG_SERIES_RESIDUAL, RELATIVE_SHIFT, SMALL_CHANGE, TWO_DIGITS, UNSEEN_TAIL

# A floor is an estimate of first order, made twice as large: four times the energy of the error, and more where errors do not add up.
# Rounding in long doubles is taken at random, ten times and more its size in single modes of some orbits.
LOOSE = 1e6

# The many digits of the truth, and those of its sums.
DIGITS = 60

STATED = (Chain(32, alpha="0.33"), 1, "5e-5")
BREATHERS = {
    "alpha, small": STATED,
    "alpha, large": (Chain(32, alpha="0.33"), 1, "0.05"),
    "beta": (Chain(16, beta="0.5"), 3, "0.1"),
    "both, high seed": (Chain(16, alpha="0.25", beta="0.5"), 15, "0.3"),
    "alpha, seed 5": (Chain(16, alpha="0.4"), 5, "1e-3"),
}
SERIES = {
    "breather": (Chain(32, alpha="0.33"), (1,), ("0.0982",), 31),
    "2-torus": (Chain(16, alpha="0.33"), (1, 2), ("0.19626", "0.39046"), 12),
    "beta": (Chain(16, beta="0.3"), (1, 3), ("0.1963", "0.5812"), 6),
    "both": (Chain(16, alpha="0.33", beta="0.3"), (5,), ("0.9432",), 12),
}


@lru_cache
def orbit(case):
    chain, seed, energy = BREATHERS[case]
    return symfpu.torus(chain, (seed,), energy=energy)


@lru_cache
def precise(case):
    return symfpu.refine(orbit(case), digits=DIGITS)


def torus_of(breather):
    harmonics = np.arange(len(breather.cosines))[:, None]
    return symfpu.Torus(breather.chain, (breather.seed,), (breather.frequency,), harmonics, breather.cosines, {breather.seed: 0.0})


def rows(solution):
    return {tuple(nu): row for nu, row in zip(solution.harmonics.tolist(), solution.cosines, strict=True)}


def error_energies(solution, truth):
    """Average mode energies of the difference, with the digits of the truth; shape (N-1,)."""
    linear = truth.chain.frequencies()
    omega = np.array([float(w) for w in truth.frequencies])
    mine, right, total = rows(solution), rows(truth), np.zeros(len(linear), dtype=object)
    with mpmath.workdps(DIGITS + 20):
        for nu in mine.keys() | right.keys():
            difference = np.zeros(len(linear), dtype=object)
            for sign, known in ((1, mine), (-1, right)):
                if nu in known:
                    difference = difference + sign * np.array([mpmath.mpf(x) for x in known[nu]])
            total = total + (0.25 if any(nu) else 0.5) * ((np.dot(nu, omega)) ** 2 + linear**2) * difference**2
        return np.array([float(x) for x in total])


def require_above(floor, errors, loose=LOOSE):
    """Above the true error in every mode, and not by much."""
    excited = errors > 0
    assert excited.any()
    assert (floor[excited] >= errors[excited]).all()
    assert (floor[excited] <= loose * errors[excited]).all()


@pytest.mark.parametrize("case", [pytest.param(case, marks=[pytest.mark.long] * case.startswith("alpha,")) for case in BREATHERS])
def test_floors_of_breathers_are_above_their_errors(case):
    """Harmonic balance in doubles, and Newton's method on tori, whose residuals are long doubles."""
    require_above(spectrum_floor(orbit(case)), error_energies(orbit(case), precise(case)))
    refined = refine(torus_of(orbit(case)))
    require_above(spectrum_floor(refined), error_energies(refined, precise(case)))


def test_the_stated_case():
    """E_28 of the refined breather is rounding: 1e-50 where the truth is 3e-75. What is above the floor is right."""
    chain, seed, energy = STATED
    truth = precise("alpha, small").average_spectrum().astype(float)
    member = symfpu.family(chain, (seed,), "0.001", from_energy=energy, members=1).members[0].torus
    assert truth[27] == pytest.approx(2.7e-75, rel=TWO_DIGITS)
    for solution in (orbit("alpha, small"), member):
        E, floor = solution.average_spectrum(), spectrum_floor(solution)
        assert truth[27] < UNSEEN_TAIL * E[27]
        assert E[27] <= floor[27]
        known = floor < E
        assert known.tolist() == sorted(known, reverse=True)
        assert 12 <= known.sum() <= 18
        off = np.abs(np.sqrt(E) - np.sqrt(truth))
        assert (off[known] <= np.sqrt(floor[known]) + RELATIVE_SHIFT * np.sqrt(truth[known])).all()


@pytest.mark.parametrize("case", [pytest.param(case, marks=[pytest.mark.long] * (case == "alpha, large")) for case in BREATHERS])
def test_coefficients_know_their_errors(case):
    breather = orbit(case)
    errors = symfpu.coefficient_errors(breather)
    assert errors.shape == breather.cosines.shape
    right = precise(case).by_harmonic()[: len(breather.cosines)]
    with mpmath.workdps(DIGITS):
        off = np.abs(np.array(right) - breather.cosines).astype(float)
    assert (off <= errors).all()
    assert errors.max() < KNOWN_ERROR * breather.amplitude
    refined = refine(torus_of(breather))
    assert symfpu.coefficient_errors(refined).shape == refined.cosines.shape


@pytest.mark.long
@pytest.mark.parametrize("case", SERIES)
def test_floors_of_series_in_doubles_are_above_their_errors(case):
    chain, seeds, frequencies, order = SERIES[case]
    torus = solve_amplitudes(lindstedt(chain, seeds, frequencies, order))
    truth = solve_amplitudes(lindstedt(chain, seeds, frequencies, order, digits=40))
    require_above(spectrum_floor(torus), error_energies(torus, truth))
    assert symfpu.coefficient_errors(torus).shape == torus.cosines.shape


@pytest.mark.long
def test_floors_with_digits_are_bounds():
    """They fall with the digits asked for; what is carried beyond these they do not count."""
    chain, seeds, frequencies, order = SERIES["2-torus"]
    truth = solve_amplitudes(lindstedt(chain, seeds, frequencies, order, digits=60))
    for digits in (15, 30):
        torus = solve_amplitudes(lindstedt(chain, seeds, frequencies, order, digits=digits))
        floor, E = spectrum_floor(torus), torus.average_spectrum().astype(float)
        assert (floor >= error_energies(torus, truth)).all()
        assert (floor[:5] < 10.0 ** (-2 * digits + 6) * E[:5]).all()
    few = symfpu.refine(orbit("alpha, small"), digits=30)
    floor, E = spectrum_floor(few), few.average_spectrum().astype(float)
    assert (floor >= error_energies(few, precise("alpha, small"))).all()
    least = 10.0**-60 * E.max()  # the square of the last digit
    seen = least < E
    assert seen.sum() > 20
    assert (floor[seen] < E[seen]).all()


@pytest.mark.long
def test_the_floor_of_a_torus_with_digits_is_above_its_error():
    torus = solve_amplitudes(lindstedt(Chain(8, beta=1), (1, 3), ("0.39020", "1.11119"), 6))
    few, truth = refine(torus, digits=20), refine(torus, digits=40)
    floor, E = spectrum_floor(few), few.average_spectrum().astype(float)
    assert (floor >= error_energies(few, truth)).all()
    excited = np.array([1, 3, 5, 7]) - 1
    assert (floor[excited] < E[excited]).all()


@pytest.mark.long
def test_the_floor_of_a_refined_torus_is_above_its_error():
    """The truth is a series that has converged far below doubles."""
    chain, seeds, frequencies = Chain(8, beta=1), (1, 3), ("0.39020", "1.11119")
    truth = solve_amplitudes(lindstedt(chain, seeds, frequencies, 12, digits=DIGITS))
    assert truth.residual() < LONG_SERIES_RESIDUAL
    refined = refine(truth)
    errors = error_energies(refined, truth)
    require_above(spectrum_floor(refined), errors)


def test_harmonics_that_were_left_out_are_in_the_floor():
    """A looser tolerance takes fewer harmonics: the modes that have only these are not known."""
    loose = refine(torus_of(orbit("both, high seed")), tolerance=1e-6)
    tight = refine(torus_of(orbit("both, high seed")))
    assert len(loose.harmonics) < len(tight.harmonics)
    require_above(spectrum_floor(loose), error_energies(loose, precise("both, high seed")), loose=1e8)


def test_a_resonant_divisor_leaves_its_mode_unknown():
    """N = 3: Omega_1 = 1 is three times the frequency, and a cubic force has this harmonic."""
    chain = Chain(3, beta=1)
    assert chain.linear_frequency(1) == 1
    cosines = np.zeros((6, 2))
    cosines[1, 0] = 0.1
    torus = symfpu.Torus(chain, (1,), (Fraction(1, 3),), np.arange(6)[:, None], cosines, {1: 0.0})
    assert spectrum_floor(torus)[0] > 1e20


def test_what_has_no_spectrum_has_no_floor():
    with pytest.raises(symfpu.InputError, match=r"^solution = "):
        spectrum_floor(np.ones(3))


def test_fits_stop_at_the_floor():
    """The line through all modes takes in rounding; the one above the floor is that of the truth."""
    breather = orbit("alpha, small")
    chain, E = breather.chain, breather.average_spectrum()
    truth = np.array([float(x) for x in precise("alpha, small").average_spectrum()])
    fit = fit_profile(chain, E, 1, power=2.0, floor=spectrum_floor(breather))
    right = fit_profile(chain, truth, 1, power=2.0, modes=fit.modes, floor=0.0)
    assert fit.modes == tuple(range(2, 13))
    assert fit.line.slope == pytest.approx(right.line.slope, rel=SMALL_CHANGE)
    assert fit_profile(chain, E, 1, power=2.0, floor=0.0).line.slope > 0.8 * right.line.slope


def harmonic(chain, seed):
    """A mode that moves alone, with one frequency at every amplitude."""
    guess = symfpu.torus(chain, (seed,), amplitudes={seed: "0.1"}, method="series", order=4)
    with pytest.raises(symfpu.NoTorus, match="give the amplitudes"):
        refine(guess)
    return symfpu.refine(guess, amplitudes={seed: "0.1"})


FORBIDDEN = {
    "breather": lambda: symfpu.torus(Chain(33, beta=1), (3,), energy="0.0353"),
    "refined breather": lambda: refine(symfpu.torus(Chain(33, beta=1), (3,), energy="0.0353")),
    "series": lambda: symfpu.torus(Chain(12, alpha="0.3"), (4,), amplitudes={4: "0.1"}, method="series", order=6),
    "torus": lambda: refine(symfpu.torus(Chain(9, alpha="0.3", beta=1), (3, 6), amplitudes={3: "0.1", 6: "0.1"}, method="series", order=4)),
    "digits": lambda: symfpu.refine(symfpu.torus(Chain(9, beta=1), (3,), energy="0.1"), digits=30),
    "torus of digits": lambda: refine(
        symfpu.torus(Chain(9, beta=1), (3, 6), amplitudes={3: "0.1", 6: "0.05"}, method="series", order=3), digits=30
    ),
    "the middle mode": lambda: symfpu.torus(Chain(4, alpha="0.3"), (2,), amplitudes={2: "0.1"}),
    "the middle mode by its amplitude": lambda: harmonic(Chain(4, alpha="0.3"), 2),
    "two bonds": lambda: harmonic(Chain(2, alpha="0.3"), 1),
}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", FORBIDDEN)
def test_modes_that_the_couplings_forbid_are_zero_and_have_no_floor(name):
    """Those of no signed sum of seeds: rounding made energies above their floors of them."""
    solution = FORBIDDEN[name]()
    chain = solution.chain
    model = "beta" if chain.potential.even else "alpha"
    reached = {q for modes in symfpu.reachable_modes(chain.N, solution.seeds, 2 * chain.N, model=model) for q in modes}
    energies = np.array(solution.average_spectrum(), dtype=float)
    assert {int(q) + 1 for q in np.flatnonzero(energies)} <= reached
    assert {int(q) + 1 for q in np.flatnonzero(spectrum_floor(solution))} <= reached
    assert energies[solution.seeds[0] - 1] > 0
