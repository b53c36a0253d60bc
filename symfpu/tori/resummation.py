"""Pade approximants of the series in mu: of the frequencies, and of every coefficient of the coordinates.

With alpha, a frequency or the coefficient of one harmonic gains a term at every second order only: a series in mu^2. Its
diagonal approximants come from Wynn's epsilon algorithm (M. Wynn, MTAC 10 (1956) 91), whose even columns are the Pade table
at the actual mu; what two neighbouring approximants differ by says how far they can be trusted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.errors import DidNotConverge, InputError, NoRealAmplitude
from symfpu.numbers.arithmetic import Numbers, with_digits
from symfpu.numbers.typed import integer
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import frequency_orders, shifts
from symfpu.tori.quasiperiodic import FourierTorus
from symfpu.tori.torus import QTorus

Floats = NDArray[np.float64]

FROISSART = 1e-4  # distance of a zero, relative to its pole, below which both are noise of doubles
NEWTON_TOLERANCE = 1e-9  # relative to omega - Omega, in doubles, which approximants lose digits of
NEWTON_STEPS = 50
LARGEST_PADE = 40  # largest degree of the approximants whose poles are computed
LARGEST_SUM = 20  # and of those that sum a series


@dataclass(frozen=True)
class PadeSum:
    """A sum by Pade approximants, and how far it can be trusted.

    values : the highest approximants, dimensionless; (s,) of frequencies, (H, N-1) of coefficients.
    disagreement : doubles of the same shape, the distance from the neighbour of the same terms whose
        denominator has one degree less (zero where the sum is exact). It measures trust, and bounds no error.

    Wynn's epsilon algorithm (M. Wynn, MTAC 10 (1956) 91); the paper sums no series this way.

    >>> PadeSum(np.array([0.5]), np.array([0.25]))
    PadeSum(values=array([0.5]), disagreement=array([0.25]))
    """

    values: Numbers
    disagreement: Floats


def pade_sum(terms: Numbers) -> PadeSum:
    """The sum of a series by Pade approximants, entry by entry; terms : (count, ...) by ascending order, count at least 1.

    Approximants have degree LARGEST_SUM at most: beyond, later terms are not used.

    Where two neighbours of the table coincide, as by a zero term within the series, the highest approximant before is taken.
    Entries that begin with zeros count from their first term that is not zero; one that is zero throughout has the sum zero.
    """
    terms = np.asarray(terms)
    flat = (terms.astype(float) if terms.dtype.kind in "iu" else terms).reshape(len(terms), -1)
    values, disagreement = flat.sum(axis=0), np.zeros(flat.shape[1])
    present = flat != 0
    first = np.where(present.any(axis=0), present.argmax(axis=0), len(flat))
    for start in np.unique(first):
        if start < len(flat):
            at = np.flatnonzero(first == start)
            used = flat[start : start + 2 * LARGEST_SUM + 1, at]
            values[at], disagreement[at] = _epsilon(used)
    return PadeSum(values.reshape(terms.shape[1:]), disagreement.reshape(terms.shape[1:]))


def _epsilon(terms: Numbers) -> tuple[Numbers, Floats]:
    """Wynn's table: the last entry of the highest even column, and its distance from the one before it along the staircase."""
    before, column = np.zeros_like(terms[:1]), np.cumsum(terms, axis=0)
    best = column[-1]
    previous = column[-2] if len(column) > 1 else np.zeros_like(best)
    alive = np.ones(terms.shape[1], dtype=np.bool_)
    for number in range(1, len(terms)):
        difference = column[1:] - column[:-1]
        if number % 2:  # of approximants: where all agree the sum is exact
            previous = np.where(alive & (difference == 0).all(axis=0), best, previous)
        alive &= (difference != 0).all(axis=0)
        steps = 1 / np.where(difference != 0, difference, 1)
        before, column = column, (before[1 : 1 + len(steps)] if number > 1 else np.zeros_like(steps)) + steps
        if number % 2 == 0:
            previous = np.where(alive, best, previous)
            best = np.where(alive, column[-1], best)
    return best, np.abs(best - previous).astype(float)


def pade_frequencies(series: LindstedtSeries, amplitudes: Mapping[int, Any], frequency_order: int | None = None) -> PadeSum:
    """Resummed frequencies omega_q at these amplitudes, of all terms up to frequency_order.

    series : with chosen frequencies. amplitudes : A by seed, dimensionless.
    frequency_order : K, up to series.order; default the whole series.

    Returns a PadeSum of shape (s,), in the order of the seeds: Eq. omeser summed by Wynn, MTAC 10 (1956) 91,
    where the paper cuts it. Raises InputError for a series in universal form, an order without a correction,
    or a seed left out.

    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)
    >>> pade_frequencies(series, {1: 0.5}).values.round(6)
    array([0.39068])
    """
    _, orders = _checked(series, frequency_order)
    with series.numbers.context(series.digits):
        given = _by_seed(series, "amplitudes", amplitudes)
        squares = series.numbers.array([given[q] for q in series.seeds]) ** 2
        terms, _ = series.frequency_terms(squares, orders[-1])
        resummed = pade_sum(terms[[0, *orders]])
    return replace(resummed, values=with_digits(resummed.values, series.digits))


def pade_amplitudes(series: LindstedtSeries, guess: Mapping[int, Any], frequency_order: int | None = None) -> dict[int, Any]:
    """Amplitudes at which the resummed frequencies are the chosen ones, near a guess by seed.

    series : with chosen frequencies. guess : amplitudes by seed, dimensionless.
    frequency_order : K, up to series.order; default the whole series.

    Returns the amplitudes by seed; Eq. omeser resummed (`pade_frequencies`) where the paper solves it
    truncated.
    Raises InputError as `pade_frequencies` does, DidNotConverge with the last iterate, NoRealAmplitude if a
    squared amplitude comes out negative.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)
    >>> round(pade_amplitudes(series, solve_amplitudes(series).amplitudes)[1], 6)
    0.405162
    """
    guess, orders = _by_seed(series, "guess", guess), _checked(series, frequency_order)[1]
    target = shifts(series)
    with series.numbers.context(series.digits):
        scale = series.numbers.array([guess[q] for q in series.seeds]) ** 2

        def equations(*point: Any) -> list[Any]:
            terms, _ = series.frequency_terms(np.array(point) * scale, orders[-1])
            return list((pade_sum(terms[orders]).values - target) / target)

        root = _solved(equations, len(scale), series.digits)
        left = float(max(abs(x) for x in equations(*root)))
        squares = root * scale
        if not left <= (NEWTON_TOLERANCE if series.digits is None else 10.0**-series.digits):
            iterate = {q: abs(float(x)) ** 0.5 for q, x in zip(series.seeds, squares, strict=True)}
            raise DidNotConverge(orders[-1], iterate, left)
        for q, x in zip(series.seeds, squares, strict=True):
            if x <= 0:
                raise NoRealAmplitude(q, float(x), orders[-1])
        amplitudes = dict(zip(series.seeds, series.numbers.sqrt(squares).tolist(), strict=True))
    return with_digits(amplitudes, series.digits)


def _checked(series: LindstedtSeries, frequency_order: int | None) -> tuple[LindstedtSeries, list[int]]:
    """The orders of the frequency series up to one; InputError if there is none, or none chosen frequency."""
    if series.frequencies is None:
        raise InputError("series", "universal form", "a series with chosen frequencies", "give frequencies= to lindstedt")
    top = series.order if frequency_order is None else integer(frequency_order, "frequency_order", 1)
    orders = [k for k in frequency_orders(series) if k <= top]
    if not orders or top > series.order:
        allowed = f"{2 // series.chain.degree_step}..{series.order}, orders with a frequency correction"
        raise InputError("frequency_order", top, allowed, "take another or compute a longer series")
    return series, orders


def _by_seed(series: LindstedtSeries, argument: str, values: Mapping[int, Any]) -> Mapping[int, Any]:
    if any(q not in values for q in series.seeds):
        raise InputError(argument, values, f"a mapping with an amplitude for each of the seeds {series.seeds}", "complete it")
    return values


def _solved(equations: Callable[..., list[Any]], count: int, digits: int | None) -> Numbers:
    """The root near (1, ..., 1), or the last iterate."""
    from scipy.optimize import root

    near = root(lambda x: np.array(equations(*x)).astype(float), np.ones(count), method="hybr", tol=1e-14).x
    if digits is None:
        return np.asarray(near)
    start = [mpmath.mpf(float(x)) for x in near]
    options = {"tol": mpmath.mpf(10) ** -(digits + 2), "maxsteps": NEWTON_STEPS, "verify": False}
    try:
        return np.array(list(mpmath.findroot(equations, start, solver="mdnewton", **options)), dtype=object)
    except ZeroDivisionError:  # a singular Jacobian
        return np.array(start, dtype=object)


@dataclass(frozen=True, eq=False)
class ResummedTorus(FourierTorus):
    """A torus whose coefficients are Pade sums. Made by `resum`; dimensionless, phases in radians.

    chain, seeds, frequencies, phases, digits : those of the torus. harmonics : (H, s). cosines : resummed,
        (H, N-1).
    disagreement : of neighbouring approximants, doubles, (H, N-1); trust, no bound. Wynn, MTAC 10 (1956) 91.

    >>> from symfpu import Chain, lindstedt, resum, solve_amplitudes
    >>> torus = resum(solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 4)))
    >>> torus
    ResummedTorus(chain=Chain(N=8, alpha=0.3), seeds=(1,), frequencies=(Fraction(781, 2000),), ...)
    >>> torus.disagreement.shape == torus.cosines.shape
    True
    """

    disagreement: Floats = field(repr=False, default_factory=lambda: np.zeros((0, 0)))


def resum(torus: QTorus) -> ResummedTorus:
    """The same torus with every coefficient c_q[nu] resummed over its orders, up to the torus' own order.

    torus : of a series, from `solve_amplitudes`; its amplitudes and phases stay. Everything is dimensionless.

    The terms of Eq. qser for one harmonic are summed by Pade approximants (Wynn, MTAC 10 (1956) 91), where
    the paper cuts them at an order. Raises nothing: where approximants do not exist, the last one that does
    is taken.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> torus = solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 8))
    >>> bool(resum(torus).residual() < torus.residual())
    True
    """
    return next(resum_by_order(torus, [torus.order]))


def resum_by_order(torus: QTorus, orders: Iterable[int]) -> Iterator[ResummedTorus]:
    """The torus resummed from the terms up to each of some orders; InputError for one above its own."""
    orders = [integer(order, "order", 0) for order in orders]
    if max(orders, default=0) > torus.order:
        raise InputError("order", max(orders), f"0..{torus.order}, the order of the torus", "take a torus of higher order")
    series, keep = torus.series, (torus.chain, torus.seeds, torus.frequencies, torus.harmonics)
    amplitudes = [torus.amplitudes[q] for q in torus.seeds]
    with series.numbers.context(series.digits):
        table = series.numbers.zeros((torus.order + 1, *torus.cosines.shape))
        keys = series.grading.harmonic_keys(torus.harmonics)
        for k in range(torus.order + 1):
            nu, values = series.harmonic_terms(amplitudes, k)
            table[k, np.searchsorted(keys, series.grading.harmonic_keys(nu))] = values
    for order in orders:
        with series.numbers.context(series.digits):
            cosines, disagreement = _resummed(table[: order + 1], torus)
        yield ResummedTorus(*keep, cosines, torus.phases, torus.digits, disagreement=disagreement)


def _resummed(table: Numbers, torus: QTorus) -> tuple[Numbers, Floats]:
    """Every coefficient of (orders, H, N-1) summed over the orders at which its harmonic can appear."""
    cosines, disagreement = np.zeros_like(torus.cosines), np.zeros(torus.cosines.shape)
    step = 2 // torus.chain.degree_step
    parity = np.abs(torus.harmonics).sum(axis=1) % 2
    for rows in (np.flatnonzero(parity == p) for p in (0, 1)):
        if len(rows) == 0:
            continue
        first = 1 - int(parity[rows[0]]) if step == 2 else 0  # degree k + 1 has the parity of its harmonics
        if first < len(table):
            part = pade_sum(table[first::step, rows])
            cosines[rows], disagreement[rows] = part.values, part.disagreement
    return cosines, disagreement


def pade_poles(series: LindstedtSeries, q: int, amplitudes: Mapping[int, Any]) -> NDArray[np.complex128]:
    """Poles of the approximant of omega_q, in units of the actual mu (mu^2 with alpha), nearest first.

    series : of numbers. q : a seed. amplitudes : A by seed, dimensionless. Returns complex numbers, shape
        (n,).

    The approximant is the diagonal one. A pole beside a zero of the numerator is an artefact of noise
    (Froissart doublet) and left out. A pole at r suggests a singularity at r times the mu (mu^2) at hand. It
    is a hint only: short or noisy series have poles of their own and miss weak ones. Pade table by Wynn, MTAC
    10 (1956) 91. Raises InputError for a mode that is no seed, or a series without frequency corrections.

    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 12)
    >>> pade_poles(series, 1, {1: 0.405}).round(1)
    array([13.5+0.j, 28.5+0.j])
    """
    _, orders = _checked(series, None)
    if q not in series.seeds:
        raise InputError("q", q, f"a seed, one of {series.seeds}", "only seeds have frequency corrections")
    given = _by_seed(series, "amplitudes", amplitudes)
    with mpmath.workdps((series.digits or 17) + 10):
        squares = [mpmath.mpf(given[k]) ** 2 for k in series.seeds]
        terms, _ = series.frequency_terms(squares, orders[-1])
        coefficients = [mpmath.mpf(x) for x in terms[list(orders), series.seeds.index(q)]]
        close = FROISSART if series.digits is None else 10.0 ** (-series.digits / 2)
        genuine = _genuine_poles(coefficients, close)
    return np.array(sorted((complex(p) for p in genuine), key=abs))


def _genuine_poles(coefficients: list[Any], close: float) -> list[Any]:
    """Poles without a zero beside them of the highest diagonal approximant there is, whose system is not singular."""
    present = [n for n, c in enumerate(coefficients) if c]
    if len(present) < 2:
        return []
    first, last = present[0], present[-1]
    ratio = abs(coefficients[first] / coefficients[last]) ** (mpmath.mpf(1) / (last - first))  # scaled, terms are alike
    scaled = [c / coefficients[first] * ratio**n for n, c in enumerate(coefficients)]
    for half in range(min((len(scaled) - 1) // 2, LARGEST_PADE), 0, -1):
        options = {"maxsteps": 500, "extraprec": 200 + 10 * half}
        try:
            top, bottom = mpmath.pade(scaled[: 2 * half + 1], half, half)
            zeros, poles = (mpmath.polyroots(_trimmed(p), **options) for p in (top, bottom))
        except (ZeroDivisionError, mpmath.libmp.NoConvergence):
            continue
        return [ratio * p for p in poles if all(abs(z - p) > close * abs(p) for z in zeros)]
    return []


def _trimmed(polynomial: list[Any]) -> list[Any]:
    """Coefficients from the highest power down, without leading zeros."""
    reverse = list(polynomial[::-1])
    while len(reverse) > 1 and not reverse[0]:
        reverse.pop(0)
    return reverse
