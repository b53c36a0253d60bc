"""Where a spectrum ends: errors of Fourier coefficients, and the mode energies that they make.

A mode far from the seeds has less energy than rounding gives it, and its number means nothing.
Every kind of solution knows its errors:
- tori and orbits by Newton's method: what the coefficients leave of the equations of motion, taken
  in long doubles and at harmonics that were left out too, over the divisors. That is the correction
  of one more step of Newton's method with the divisors alone as its matrix; the rest of the matrix
  is applied to it a few times;
- series in doubles: rounding relative to the largest force of a harmonic, since products over the
  bonds mix modes, over the divisor;
- series with digits: the proved radii of the tables;
- orbits and tori with digits: the bound of their residual over the divisors.
An error of the amplitudes changes all coefficients along the family: one of degree d in the
amplitudes by d times its relative size.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.chain.propagation import excitation_sequence
from symfpu.numbers.public import public
from symfpu.refinement.digits import IterativeRefinement
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import alias_free_set, canonical_signs, dilated, places_of
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus, comes_from, require_fixed_solution

Floats = NDArray[Any]
Ints = NDArray[np.int64]

EPS = 2.0**-52
WIDENING = (
    1.5  # times the largest harmonic of one angle: up to there left out ones are solved for
)
SAFETY = 2.0  # on errors of first order
PERIODS, SAMPLES = (
    50,
    512,
)  # of the slowest angle, and times in all, for a largest acceleration
CORRECTIONS = 3  # times that the rest of Newton's matrix is applied


class _Errors:
    """Errors of coefficients : (H, N-1), their harmonics (H, s) and frequencies (H,)."""

    def __init__(self, harmonics: Ints, rates: Floats, sizes: Floats) -> None:
        self.harmonics, self.rates, self.sizes = harmonics, rates, sizes

    def energies(self, chain: Chain) -> NDArray[np.float64]:
        """Average mode energies of a motion with these coefficients; shape (N-1,)."""
        weights = np.where((self.harmonics != 0).any(axis=1), 0.25, 0.5)[:, None]
        squared = self.rates[:, None] ** 2 + chain.frequencies() ** 2
        return np.asarray((weights * squared * self.sizes**2).sum(axis=0), dtype=np.float64)


@public
def spectrum_floor(solution: Torus) -> NDArray[np.float64]:
    """The energies at and below which the modes of a torus or breather are rounding; shape (N-1,).

    solution : a torus or periodic orbit of any kind.

    Dimensionless, as `average_spectrum()`: the average energy of the errors of all coefficients
    of a mode. Above it sqrt(E_q) is within sqrt(floor_q) of the truth, so that at 100 times the
    floor E_q is off by a fifth at most. For tori and orbits by Newton's method the truth is the
    solution with these frequencies; for a series its exact sum at its orders: what truncation
    leaves out is not rounding (see `residual`).

    An estimate of first order, above the true error wherever it was compared with many digits
    (docs/precision.md). With digits it counts on those asked for, not on those carried beyond.
    Next to a divisor that is zero it is as large as the inverse says, or infinite. Raises
    InputError. Ours.

    >>> import symfpu
    >>> from symfpu import Chain
    >>> breather = symfpu.torus(Chain(N=32, alpha="0.33"), (1,), energy="5e-5")
    >>> int(sum(breather.average_spectrum() > spectrum_floor(breather)))  # modes that are known
    12
    """
    errors = _errors(solution)
    return errors.energies(solution.chain)


@public
def coefficient_errors(solution: Torus) -> NDArray[np.float64]:
    """How far off the Fourier coefficients of a torus or breather are; shape (H, N-1).

    solution : a torus or periodic orbit of any kind. Dimensionless; what they count on is said in
        `spectrum_floor`. Raises InputError. Ours.

    >>> import symfpu
    >>> from symfpu import Chain
    >>> breather = symfpu.torus(Chain(N=32, alpha="0.33"), (1,), energy="5e-5")
    >>> bool(coefficient_errors(breather).max() < 1e-11 * breather.amplitude)
    True
    """
    errors = _errors(solution)
    known = canonical_signs(errors.harmonics)
    places = places_of(canonical_signs(solution.harmonics), known)
    return np.asarray(errors.sizes[places], dtype=np.float64)


def _errors(solution: Torus) -> _Errors:
    require_fixed_solution(solution, "solution")
    if comes_from(solution, FromSeries):
        return _of_series(solution)
    if comes_from(solution, IterativeRefinement):
        return _of_digits(solution)
    return _of_newton(solution)


@lru_cache(maxsize=64)
def _degrees(chain: Chain, seeds: tuple[int, ...]) -> Ints:
    """The lowest degree in the amplitudes with which each mode is excited by the rule, at most N.

    Shape (N-1,).
    """
    model = "beta" if chain.potential.even else "alpha"
    degrees = np.full(chain.N - 1, chain.N)
    for order, modes in enumerate(
        excitation_sequence(chain.N, seeds, chain.N, model=model)
    ):
        degrees[np.array(modes, dtype=np.int64) - 1] = min(
            1 + chain.degree_step * order, chain.N
        )
    return degrees


def _along_the_family(
    chain: Chain, seeds: tuple[int, ...], harmonics: Ints, cosines: Floats, relative: float
) -> Floats:
    """What a relative error of the amplitudes makes of coefficients (H, N-1).

    As many times as their degree, |nu| or more.
    """
    lengths = np.abs(harmonics).sum(axis=1)
    degrees = np.maximum(_degrees(chain, seeds), lengths[:, None])
    changes = np.where(cosines == 0, 0.0, degrees * np.abs(cosines))
    with np.errstate(
        invalid="ignore"
    ):  # what is zero stays so, however far the amplitudes are off
        return np.where(changes == 0, 0.0, changes * relative)


# Newton's method


def _of_newton(torus: Torus) -> _Errors:
    """One more step of Newton's method, on more harmonics.

    That of the amplitudes goes along the family.
    """
    equation = InvarianceEquation(torus.chain, torus.seeds, _harmonics(torus))
    shifts, cosines = shifts_of(torus), _on(torus, equation.harmonics)
    divisors = np.where(equation.mask, equation.divisors(shifts), 1)
    left = np.where(equation.mask, divisors * cosines - equation.force(cosines), 0)
    rounding = equation.rounding(cosines, np.longdouble)
    with np.errstate(divide="ignore"):
        inverse = np.where(equation.mask, 1 / np.abs(divisors), 0)
        first = left / divisors
    seeds = equation.seed_rows, equation.seed_columns
    slopes = equation.slopes(cosines)
    sizes, correction = np.abs(first) + inverse * rounding, first
    for _ in range(CORRECTIONS):
        finite = np.where(np.isfinite(correction), correction, 0)
        change = equation.force_change(slopes, finite.astype(float))
        change[seeds] = 0  # the amplitudes go along the family
        correction = inverse * change
        sizes += np.abs(correction)
    sizes *= SAFETY
    relative = float(np.max(sizes[seeds] / np.abs(cosines[seeds])))
    relative += EPS / 2  # they are rounded to doubles
    sizes += _along_the_family(
        torus.chain, torus.seeds, equation.harmonics, cosines, relative
    )
    harmonics, rates, omitted = _left_out(equation, shifts, cosines, rounding)
    return _Errors(
        np.concatenate([equation.harmonics, harmonics]),
        np.concatenate([equation.rates(shifts), rates]),
        np.concatenate([sizes, omitted]),
    )


def _harmonics(torus: Torus) -> Ints:
    """The harmonics of a torus, one of each pair.

    Of one angle also those up to WIDENING times as large.
    """
    own = canonical_signs(np.asarray(torus.harmonics))
    if len(torus.seeds) == 1:
        own = np.arange(int(WIDENING * own.max()) + 1)[:, None]
    return np.unique(own, axis=0)


def _left_out(
    equation: InvarianceEquation, shifts: Floats, cosines: Floats, rounding: Floats
) -> tuple[Ints, Floats, Floats]:
    """Harmonics next to those of the equation, their frequencies, and coefficients by forces."""
    known = set(map(tuple, equation.harmonics.tolist()))
    around = np.unique(canonical_signs(alias_free_set(equation.harmonics)), axis=0)
    harmonics = around[[nu not in known for nu in map(tuple, around.tolist())]]
    forces = equation.force(cosines, at=harmonics)
    rates = harmonics @ (equation.seed_frequencies + shifts)
    divisors = np.abs(
        (rates[:, None] - equation.linear) * (rates[:, None] + equation.linear)
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        sizes = SAFETY * (np.abs(forces) + rounding) / divisors
    return harmonics, rates, np.where(equation.projection.at(harmonics).mask, sizes, 0)


def _on(torus: Torus, harmonics: Ints) -> Floats:
    """The coefficients of a torus, in long doubles, at given harmonics; shape (H, N-1)."""
    places = places_of(canonical_signs(np.asarray(torus.harmonics)), harmonics)
    cosines = np.zeros((len(harmonics), torus.chain.N - 1), dtype=np.longdouble)
    cosines[places] = torus.cosines.astype(float)
    return cosines


# series


def _of_series(torus: Torus[FromSeries]) -> _Errors:
    """Rounding of the tables at these amplitudes, order by order, and of the amplitudes."""
    series = torus.origin.series
    amplitudes = [torus.amplitudes[q] for q in torus.seeds]
    keys = series.grading.harmonic_keys(torus.harmonics)
    sizes = np.zeros(torus.cosines.shape)
    of_order = _rounded if series.digits is None else _within_radii
    for order in range(1, torus.origin.order + 1):
        nu, errors = of_order(torus, amplitudes, order)
        sizes[np.searchsorted(keys, series.grading.harmonic_keys(nu))] += errors
    cosines, relative = torus.cosines.astype(float), _of_amplitudes(torus)
    sizes += _along_the_family(torus.chain, torus.seeds, torus.harmonics, cosines, relative)
    rates = torus.harmonics @ np.array([float(w) for w in torus.frequencies])
    return _Errors(torus.harmonics, rates, sizes)


def _rounded(
    torus: Torus[FromSeries], amplitudes: list[Any], order: int
) -> tuple[Ints, Floats]:
    """An order in doubles: the errors are those of forces, over their divisors.

    The largest force of a harmonic is known to about as many EPS as the order says.
    """
    series, linear = torus.origin.series, torus.chain.frequencies()
    nu, moduli = series.harmonic_terms(amplitudes, order, absolute=True)
    omega = np.array([float(w) for w in torus.frequencies])
    chosen = linear.copy()
    chosen[np.array(torus.seeds) - 1] = omega
    rates = np.abs(nu @ omega)[:, None]
    divisors = np.abs((chosen - rates) * (chosen + rates))
    divisors /= linear  # forces on bonds: those of u_q = Omega_q Q_q over Omega_q^2
    forces = (moduli * divisors).max(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        errors = (order + 2) * EPS * forces[:, None] / divisors
    return nu, np.where(moduli > 0, errors, 0.0)


def _within_radii(
    torus: Torus[FromSeries], amplitudes: list[Any], order: int
) -> tuple[Ints, Floats]:
    """An order with digits: its radius, for every monomial of a harmonic."""
    series = torus.origin.series
    nu, index = series.grading.harmonics(series.degree(order))
    seeds = np.abs(series.scaled_seeds(amplitudes).astype(float))
    monomials = np.prod(seeds ** series.grading.powers(series.degree(order)), axis=1)
    sums = np.bincount(index, weights=monomials, minlength=len(nu))
    radius = float(np.ldexp(series.radii[order][0], -series.bits))
    linear = torus.chain.frequencies()
    kappa = 2 * abs(float(series.seed_factors[0])) / linear[torus.seeds[0] - 1]
    return nu, 2 * radius / kappa * sums[:, None] / linear


def _of_amplitudes(torus: Torus[FromSeries]) -> float:
    """Relative error of the amplitudes: rounding of the frequency series over its derivative.

    With digits what was asked for.
    """
    if torus.digits is not None:
        return float(10.0**-torus.digits)
    squares = np.array([float(a) ** 2 for a in torus.amplitudes.values()])
    terms, slopes = torus.origin.series.frequency_terms(
        squares, torus.origin.frequency_order
    )
    left = EPS * np.abs(terms[1:]).sum(axis=0) * (torus.origin.frequency_order + 2)
    try:
        inverse = np.abs(np.linalg.inv(slopes.sum(axis=0)))
    except np.linalg.LinAlgError:
        return float("inf")
    return float(np.max(inverse @ left / (2 * squares))) + EPS / 2


# tori with digits


def _of_digits(torus: Torus[IterativeRefinement]) -> _Errors:
    """The bound of the residual over the divisors, at harmonics next to its own, too.

    That of the amplitudes goes along the family.
    """
    chain, seeds = torus.chain, torus.seeds
    equation = InvarianceEquation(chain, seeds, canonical_signs(torus.harmonics))
    around = np.unique(canonical_signs(dilated(torus.harmonics, WIDENING)), axis=0)
    rows = places_of(equation.harmonics, around)
    rates = around @ (equation.seed_frequencies + shifts_of(torus))
    divisors = np.abs(
        (rates[:, None] - equation.linear) * (rates[:, None] + equation.linear)
    )
    divisors[rows] = np.abs(equation.divisors(shifts_of(torus)))
    left = SAFETY * float(torus.origin.bound) * _largest_acceleration(torus)
    with np.errstate(divide="ignore"):
        sizes = np.where(equation.projection.at(around).mask, left / divisors, 0.0)
    cosines = torus.cosines.astype(float)
    seed = equation.seed_rows, equation.seed_columns
    relative = float(np.max(sizes[rows][seed] / np.abs(cosines[seed])))
    sizes[rows] += _along_the_family(chain, seeds, equation.harmonics, cosines, relative)
    return _Errors(around, rates, sizes)


def _largest_acceleration(torus: Torus[IterativeRefinement]) -> float:
    """Of a mode, at some times."""
    doubles = torus.in_doubles()
    slowest = min(float(w) for w in torus.frequencies)
    times = np.linspace(0, PERIODS * 2 * np.pi / slowest, SAMPLES)
    return float(np.abs(torus.chain.accelerations(doubles.Q(times))).max())
