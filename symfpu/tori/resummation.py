"""Pade approximants of the series in mu: of frequencies, and of coordinates' coefficients.

With alpha, a frequency or the coefficient of one harmonic gains a term at every second order
only: a series in mu^2. Its diagonal approximants come from Wynn's epsilon algorithm (M. Wynn,
MTAC 10 (1956) 91), whose even columns are the Pade table at the actual mu; what two neighbouring
approximants differ by says how far they can be trusted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.frequency_shift import LARGEST_AMPLITUDE
from symfpu.errors import DidNotConverge, InputError, NoRealAmplitude
from symfpu.numbers.arithmetic import (
    DOUBLES,
    Numbers,
    arithmetic_of,
    mpfr_as_mpf,
    with_digits,
)
from symfpu.numbers.counted import counted
from symfpu.numbers.mpfr import MPFR, at_the_face, in_mpf, inside
from symfpu.numbers.public import public
from symfpu.numbers.typed import order_of
from symfpu.results.attributes import attributes
from symfpu.results.grid import Variable
from symfpu.results.result import Tabled
from symfpu.results.table import Column, Table
from symfpu.series.series import LindstedtSeries, require_any_series
from symfpu.series.sums import require_frequencies
from symfpu.tori.amplitudes import orders_up_to, shifts
from symfpu.tori.from_series import FromSeries, require_series_torus
from symfpu.tori.torus import Origin, Torus, require_fixed_solution

Floats = NDArray[np.float64]

# distance of a zero, relative to its pole, below which both are noise of doubles
FROISSART = 1e-4
# relative to omega - Omega, in doubles, which approximants lose digits of
NEWTON_TOLERANCE = 1e-9
NEWTON_STEPS = 50
LARGEST_PADE = 40  # largest degree of the approximants whose poles are computed
LARGEST_SUM = 20  # and of those that sum a series


@dataclass(frozen=True)
class PadeSum(Tabled):
    """A sum by Pade approximants, and how far it can be trusted.

    values : the highest approximants, dimensionless; (s,) of frequencies, (H, N-1) of coefficients.
    disagreement : doubles of the same shape, the distance from the neighbour of the same terms
        whose denominator has one degree less (zero where the sum is exact). It measures trust,
        and bounds no error.

    Wynn's epsilon algorithm (M. Wynn, MTAC 10 (1956) 91); the paper sums no series this way.

    >>> PadeSum(np.array([0.5]), np.array([0.25]))
    PadeSum(1 sum, largest disagreement 0.25)
    >>> PadeSum(np.array([0.5]), np.array([0.25])).to_frame()
       index_0  value  disagreement
    0        0    0.5          0.25
    """

    values: Numbers
    disagreement: Floats

    def __repr__(self) -> str:
        sums = counted(self.values.size, "sum")
        largest = self.disagreement.max(initial=0.0)
        return f"PadeSum({sums}, largest disagreement {largest:.2g})"

    def _table(self) -> Table:
        """One row for each sum, with its place in the array."""
        columns: dict[str, Column] = {}
        for axis, places in enumerate(np.indices(self.values.shape)):
            columns[f"index_{axis}"] = places.reshape(-1)
        columns["value"] = self.values.reshape(-1)
        columns["disagreement"] = self.disagreement.reshape(-1)
        return Table(columns, attributes(self))


def pade_sum(terms: Numbers) -> PadeSum:
    """The sum of a series by Pade approximants, entry by entry.

    terms : (count, ...) by ascending order, count at least 1.

    Approximants have degree LARGEST_SUM at most: beyond, later terms are not used.

    Where two neighbours of the table coincide, as by a zero term within the series, the highest
    approximant before is taken. Entries that begin with zeros count from their first term that is
    not zero; one that is zero throughout has the sum zero.
    """
    terms = np.asarray(terms)
    if arithmetic_of(terms) is DOUBLES:
        return _pade_sum(terms.astype(float) if terms.dtype.kind in "iu" else terms)
    with mpfr_as_mpf():
        summed = _pade_sum(MPFR.array(terms))
        return replace(summed, values=in_mpf(summed.values))


def _pade_sum(terms: Numbers) -> PadeSum:
    """The same in doubles or MPFR's numbers."""
    shape = terms.shape[1:]
    flat = terms.reshape(len(terms), -1)
    values = flat.sum(axis=0)
    disagreement = np.zeros(flat.shape[1])
    present = flat != 0
    first = np.where(present.any(axis=0), present.argmax(axis=0), len(flat))
    for start in np.unique(first):
        if start < len(flat):
            at = np.flatnonzero(first == start)
            end = start + 2 * LARGEST_SUM + 1
            values[at], disagreement[at] = _epsilon(flat[start:end, at])
    return PadeSum(values.reshape(shape), disagreement.reshape(shape))


def _epsilon(terms: Numbers) -> tuple[Numbers, Floats]:
    """Wynn's table: the last entry of the highest even column, and how far it is settled.

    That is its distance from the one before it along the staircase.
    """
    before = np.zeros_like(terms[:1])
    column = np.cumsum(terms, axis=0)
    best = column[-1]
    previous = column[-2] if len(column) > 1 else np.zeros_like(best)
    alive = np.ones(terms.shape[1], dtype=np.bool_)
    for number in range(1, len(terms)):
        difference = column[1:] - column[:-1]
        if number % 2:  # of approximants: where all agree the sum is exact
            settled = alive & (difference == 0).all(axis=0)
            previous = np.where(settled, best, previous)
        alive &= (difference != 0).all(axis=0)
        steps = 1 / np.where(difference != 0, difference, 1)
        earlier = before[1 : 1 + len(steps)] if number > 1 else np.zeros_like(steps)
        before = column
        column = earlier + steps
        if number % 2 == 0:
            previous = np.where(alive, best, previous)
            best = np.where(alive, column[-1], best)
    distance = np.abs(best - previous)
    return best, distance.astype(float)


@public
def pade_frequencies(
    series: LindstedtSeries,
    amplitudes: Mapping[int, Any],
    frequency_order: int | None = None,
) -> PadeSum:
    """Resummed frequencies omega_q at these amplitudes, of all terms up to frequency_order.

    series : with chosen frequencies. amplitudes : A by seed, dimensionless.
    frequency_order : K, up to series.order; default the whole series.

    Returns a PadeSum of shape (s,), in the order of the seeds: Eq. omeser summed by Wynn, MTAC 10
    (1956) 91, where the paper cuts it. Raises InputError for a series in universal form, an order
    without a correction, or a seed left out.

    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)
    >>> pade_frequencies(series, {1: 0.5}).values.round(6)
    array([0.39068])
    """
    require_any_series(series)
    orders = _checked(series, frequency_order)
    with series.numbers.context(series.digits):
        given = _by_seed(series, "amplitudes", amplitudes)
        squares = _squares(series, "amplitudes", given)
        terms, _ = series.frequency_terms(squares, orders[-1])
        resummed = pade_sum(terms[[0, *orders]])
    return replace(resummed, values=with_digits(resummed.values, series.digits))


@public
def pade_amplitudes(
    series: LindstedtSeries, guess: Mapping[int, Any], frequency_order: int | None = None
) -> dict[int, Any]:
    """Amplitudes at which the resummed frequencies are the chosen ones, near a guess by seed.

    series : with chosen frequencies. guess : amplitudes by seed, dimensionless.
    frequency_order : K, up to series.order; default the whole series.

    Returns the amplitudes by seed; Eq. omeser resummed (`pade_frequencies`) where the paper
    solves it truncated.
    Raises InputError as `pade_frequencies` does, DidNotConverge with the last iterate,
    NoRealAmplitude if a squared amplitude comes out negative.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)
    >>> round(pade_amplitudes(series, solve_amplitudes(series).amplitudes)[1], 6)
    0.405162
    """
    require_any_series(series)
    guess = _by_seed(series, "guess", guess)
    orders = _checked(series, frequency_order)
    K = orders[-1]
    target = shifts(series)
    with series.numbers.context(series.digits):
        scale = _squares(series, "guess", guess)

        def equations(*point: Any) -> list[Any]:
            squares = np.array(point) * scale
            terms, _ = series.frequency_terms(squares, K)
            resummed = pade_sum(terms[orders])
            return list((resummed.values - target) / target)

        root = _solved(equations, len(scale), series.digits)
        residuals = [abs(x) for x in equations(*root)]
        left = float(max(residuals))
        squares = root * scale
        by_seed = dict(zip(series.seeds, squares, strict=True))
        allowed = NEWTON_TOLERANCE if series.digits is None else 10.0**-series.digits
        if not left <= allowed:
            iterate = {q: abs(float(x)) ** 0.5 for q, x in by_seed.items()}
            raise DidNotConverge(K, iterate, left)
        for q, x in by_seed.items():
            if x <= 0:
                raise NoRealAmplitude(q, float(x), K)
        roots = series.numbers.sqrt(squares)
        amplitudes = dict(zip(series.seeds, roots.tolist(), strict=True))
    return with_digits(amplitudes, series.digits)


def _checked(series: LindstedtSeries, frequency_order: int | None) -> list[int]:
    """The orders of the frequency series up to one.

    InputError if there is none, or none chosen frequency.
    """
    require_frequencies(series)
    return orders_up_to(series, frequency_order)


def _by_seed(
    series: LindstedtSeries, argument: str, values: Mapping[int, Any]
) -> Mapping[int, Any]:
    if any(q not in values for q in series.seeds):
        allowed = f"a mapping with an amplitude for each of the seeds {series.seeds}"
        raise InputError(argument, values, allowed, "complete it")
    return values


def _squares(series: LindstedtSeries, argument: str, values: Mapping[int, Any]) -> Numbers:
    """A^2 in the order of the seeds; InputError beyond what series can be summed at."""
    amplitudes = series.numbers.array([values[q] for q in series.seeds])
    if not (abs(amplitudes) <= LARGEST_AMPLITUDE).all():
        allowed = f"amplitudes up to {LARGEST_AMPLITUDE:g}"
        raise InputError(argument, values, allowed, "rescale the amplitudes")
    return np.asarray(amplitudes**2)


def _solved(equations: Callable[..., list[Any]], count: int, digits: int | None) -> Numbers:
    """The root near (1, ..., 1), or the last iterate."""
    from scipy.optimize import root

    def doubles(point: Floats) -> Floats:
        return np.array(equations(*point)).astype(float)

    near = root(doubles, np.ones(count), method="hybr", tol=1e-14).x
    if digits is None:
        return np.asarray(near)
    start = [mpmath.mpf(float(x)) for x in near]
    tolerance = mpmath.mpf(10) ** -(digits + 2)
    options = {"tol": tolerance, "maxsteps": NEWTON_STEPS, "verify": False}
    try:
        found = mpmath.findroot(equations, start, solver="mdnewton", **options)
    except ZeroDivisionError:  # a singular Jacobian
        return np.array(start, dtype=object)
    return np.array(list(found), dtype=object)


@dataclass(frozen=True, eq=False, repr=False)
class Resummed(Origin):
    """Where a torus comes from: its coefficients are Pade sums of a series (`resum`).

    disagreement : of neighbouring approximants, doubles, (H, N-1), dimensionless; trust, no bound.
        Wynn, MTAC 10 (1956) 91.

    >>> from symfpu import Chain, lindstedt, resum, solve_amplitudes
    >>> torus = resum(solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 4)))
    >>> torus.origin.disagreement.shape == torus.cosines.shape
    True
    >>> "disagreement" in torus.to_xarray()
    True
    """

    name: ClassVar[str] = "Pade sums"

    disagreement: Floats

    def facts(self) -> tuple[str, ...]:
        largest = self.disagreement.max(initial=0.0)
        return (f"Pade sums, largest disagreement {largest:.2g}",)

    def variables(self) -> dict[str, Variable]:
        meaning = "distance of neighbouring approximants of a coefficient"
        return {"disagreement": Variable(("harmonic", "mode"), self.disagreement, meaning)}


@public
def resum(torus: Torus[FromSeries]) -> Torus[Resummed]:
    """The same torus with every coefficient c_q[nu] resummed, up to the torus' own order.

    torus : of a series, from `solve_amplitudes`; its amplitudes and phases stay. Everything is
        dimensionless.

    The terms of Eq. qser for one harmonic are summed by Pade approximants (Wynn, MTAC 10 (1956)
    91), where the paper cuts them at an order. Where approximants do not exist, the last one that
    does is taken. Raises InputError for a torus without a series.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> torus = solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 8))
    >>> bool(resum(torus).residual() < torus.residual())
    True
    """
    require_fixed_solution(require_series_torus(torus), "torus")
    return next(resum_by_order(torus, [torus.origin.order]))


def resum_by_order(
    torus: Torus[FromSeries], orders: Iterable[int]
) -> Iterator[Torus[Resummed]]:
    """The torus resummed from the terms up to each of some orders.

    InputError for one above its own.
    """
    orders = [order_of(order) for order in orders]
    highest = max(orders, default=0)
    if highest > torus.origin.order:
        allowed = f"0..{torus.origin.order}, the order of the torus"
        raise InputError("order", highest, allowed, "take a torus of higher order")
    context = torus.origin.series.numbers.context
    digits = torus.origin.series.digits
    keep = (torus.chain, torus.seeds, torus.frequencies, torus.harmonics)
    with context(digits):
        table = _terms_by_order(torus)
    for order in orders:
        with context(digits):
            cosines, disagreement = _resummed(table[: order + 1], torus)
        yield Torus(
            *keep, cosines, torus.phases, torus.digits, origin=Resummed(disagreement)
        )


def _terms_by_order(torus: Torus[FromSeries]) -> Numbers:
    """The terms of the coefficients of a torus by order; shape (order + 1, H, N-1).

    With digits, MPFR's numbers.
    """
    series = torus.origin.series
    grading = series.grading
    keys = grading.harmonic_keys(torus.harmonics)
    table = inside(series.numbers).zeros((torus.origin.order + 1, *torus.cosines.shape))
    for k, (nu, values) in enumerate(torus.origin.terms_by_order):
        rows = np.searchsorted(keys, grading.harmonic_keys(nu))
        table[k, rows] = values
    return table


def _resummed(table: Numbers, torus: Torus[FromSeries]) -> tuple[Numbers, Floats]:
    """Every coefficient of (orders, H, N-1) summed over its orders.

    Those at which its harmonic can appear.
    """
    cosines = inside(torus.numbers).zeros(torus.cosines.shape)
    disagreement = np.zeros(torus.cosines.shape)
    step = 2 // torus.chain.degree_step
    degrees = np.abs(torus.harmonics).sum(axis=1)
    for parity in (0, 1):
        rows = np.flatnonzero(degrees % 2 == parity)
        if len(rows) == 0:
            continue
        # degree k + 1 has the parity of its harmonics
        first = 1 - parity if step == 2 else 0
        if first < len(table):
            part = _pade_sum(table[first::step, rows])
            cosines[rows] = part.values
            disagreement[rows] = part.disagreement
    return at_the_face(cosines), disagreement


@public
def pade_poles(
    series: LindstedtSeries, q: int, amplitudes: Mapping[int, Any]
) -> NDArray[np.complex128]:
    """Poles of the approximant of omega_q, in units of the actual mu, nearest first.

    With alpha in units of mu^2.

    series : of numbers, that of a ring too. q : a seed. amplitudes : A by seed, dimensionless.
        Returns complex numbers, shape (n,).

    The approximant is the diagonal one. A pole beside a zero of the numerator is an artefact of
    noise (Froissart doublet) and left out. A pole at r suggests a singularity at r times the mu
    (mu^2) at hand. It is a hint only: short or noisy series have poles of their own and miss weak
    ones. Pade table by Wynn, MTAC 10 (1956) 91. Raises InputError for a mode that is no seed, or
    a series without frequency corrections.

    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 12)
    >>> pade_poles(series, 1, {1: 0.405}).round(1)
    array([13.5+0.j, 28.5+0.j])
    """
    if not hasattr(series, "frequency_terms"):
        raise InputError(
            "series", type(series).__name__, "a series", "pass what lindstedt gave"
        )
    orders = _checked(series, None)
    if q not in series.seeds:
        allowed = f"a seed, one of {series.seeds}"
        raise InputError("q", q, allowed, "only seeds have frequency corrections")
    given = _by_seed(series, "amplitudes", amplitudes)
    with mpmath.workdps((series.digits or 17) + 10):
        squares = [mpmath.mpf(given[k]) ** 2 for k in series.seeds]
        terms, _ = series.frequency_terms(squares, orders[-1])
        column = terms[list(orders), series.seeds.index(q)]
        coefficients = [mpmath.mpf(x) for x in column]
        close = FROISSART if series.digits is None else 10.0 ** (-series.digits / 2)
        genuine = _genuine_poles(coefficients, close)
    poles = [complex(p) for p in genuine]
    return np.array(sorted(poles, key=abs))


def _genuine_poles(coefficients: list[Any], close: float) -> list[Any]:
    """Poles without a zero beside them of the highest diagonal approximant.

    The highest there is, whose system is not singular.
    """
    present = [n for n, c in enumerate(coefficients) if c]
    if len(present) < 2:
        return []
    first, last = present[0], present[-1]
    leading = coefficients[first]
    # scaled, terms are alike
    decay = abs(leading / coefficients[last])
    ratio = decay ** (mpmath.mpf(1) / (last - first))
    scaled = [c / leading * ratio**n for n, c in enumerate(coefficients)]
    highest = min((len(scaled) - 1) // 2, LARGEST_PADE)
    for half in range(highest, 0, -1):
        options = {"maxsteps": 500, "extraprec": 200 + 10 * half}
        try:
            top, bottom = mpmath.pade(scaled[: 2 * half + 1], half, half)
            zeros = mpmath.polyroots(_trimmed(top), **options)
            poles = mpmath.polyroots(_trimmed(bottom), **options)
        except (ZeroDivisionError, mpmath.libmp.NoConvergence):
            continue
        return [ratio * p for p in poles if _is_alone(p, zeros, close)]
    return []


def _is_alone(pole: Any, zeros: list[Any], close: float) -> bool:
    distance = close * abs(pole)
    return all(abs(zero - pole) > distance for zero in zeros)


def _trimmed(polynomial: list[Any]) -> list[Any]:
    """Coefficients from the highest power down, without leading zeros."""
    reverse = list(polynomial[::-1])
    while len(reverse) > 1 and not reverse[0]:
        reverse.pop(0)
    return reverse
