"""Amplitudes to frequencies: omega_q = Omega_q + sum mu^k omega_q^(k)(A; omega), whose divisors hold the omega themselves.

Eq. omeser read from the other side. The unknowns are the shifts omega_q - Omega_q; a trial costs one series. Every trial frequency
is an exact decimal with so many places that its shift keeps all its digits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import InputError, SymfpuError, UndeterminedAmplitudes
from symfpu.numbers.arithmetic import DOUBLES, GUARD_DIGITS, MULTIPRECISION, Arithmetic, Numbers
from symfpu.numbers.typed import Number, exact, integer, seed_modes
from symfpu.series.lindstedt import lindstedt
from symfpu.series.memory import check_size
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import amplitude_history, by_seed, frequency_orders, order_doubts, residual_doubts, shifts
from symfpu.tori.broyden import Found, NotFound, solve, walk
from symfpu.tori.root_certificate import certify_root
from symfpu.tori.torus import QTorus

EXTREME = 10**60  # size of an amplitude or a weight
SMALLEST_SHIFT = 1e-30  # of a frequency; what `shifts` still sees in doubles
PLACES = 40  # decimals at most beyond the significant ones
ROUNDING = 256 * np.finfo(float).eps  # of the sum of moduli of the series: what a solution may leave
LEAST = 4 * np.finfo(float).eps  # what is not worth another series
SPARE = 3  # digits beyond the asked ones to which a solution with digits is found; its series carry more
REACH = 0.1  # change of the shifts from their prediction, relative, that stays on the family
SAME = 1e-6  # relative difference of amplitudes that are the same root


class NoSelfConsistentFrequencies(SymfpuError):
    """No frequencies for these amplitudes: raised by `torus_at_amplitudes` where the walk from rest ends.

    frequency_order : K. amplitudes : asked for; reached : by seed, the last ones on the way that have
        frequencies.
    frequencies : the last iterate by seed; residual : what it leaves, relative to the shifts. reason : in
        words. All dimensionless. Ours.
    """

    def __init__(self, search: Frequencies, squares: Numbers, reached: Numbers, failure: NotFound) -> None:
        seeds = search.seeds
        self.frequency_order, self.reason, self.residual = search.frequency_order, failure.reason, failure.residual
        self.amplitudes = {q: float(x) ** 0.5 for q, x in zip(seeds, squares, strict=True)}
        self.reached = {q: float(x) ** 0.5 for q, x in zip(seeds, reached, strict=True)}
        self.frequencies = dict(zip(seeds, (search.linear * (1 + failure.iterate.astype(float))).tolist(), strict=True))
        asked, last, omega = (
            ", ".join(f"{name}_{q} = {v:.6g}" for q, v in values.items())
            for name, values in (("A", self.amplitudes), ("A", self.reached), ("omega", self.frequencies))
        )
        left = "" if np.isnan(self.residual) else f" and leaves {self.residual:.2g} of the shifts"
        super().__init__(
            f"no frequencies for {asked} at frequency order {self.frequency_order}: {self.reason}; the last iterate is {omega}{left}; "
            f"solutions were followed from rest to {last}: take smaller amplitudes"
        )


@dataclass(frozen=True, eq=False)
class Point:
    """A solution: A^2, (omega - Omega) / Omega, both (s,); its derivatives by A^2 (s, s); the Broyden matrix; its series."""

    squares: Numbers
    shifts: Numbers
    slopes: Numbers
    inverse: Numbers
    series: LindstedtSeries | None = None

    def predicted(self, squares: Numbers) -> Numbers:
        """The shifts at other amplitudes, by the derivative of the solution."""
        return np.asarray(self.shifts - self.inverse @ self.slopes @ (squares - self.squares))


class Frequencies:
    """The frequencies that belong to amplitudes, for one chain, its seeds (ascending) and a frequency order."""

    def __init__(self, chain: Chain, seeds: tuple[int, ...], frequency_order: int, digits: int | None = None) -> None:
        self.chain, self.seeds, self.frequency_order, self.digits = chain, seeds, frequency_order, digits
        self.linear = chain.frequencies()[np.array(seeds) - 1]
        columns = [frequency_shift(chain, {q: float(q == n) for q in seeds}) for n in seeds]
        slopes = np.array([[column[q] for column in columns] for q in seeds]) / self.linear[:, None]
        self.rest = Point(np.zeros(len(seeds)), np.zeros(len(seeds)), slopes, -np.eye(len(seeds)))

    @property
    def numbers(self) -> Arithmetic:
        """The arithmetic of the shifts."""
        return DOUBLES if self.digits is None else MULTIPRECISION

    def at(self, squares: Numbers, start: Point | None = None) -> Point:
        """The solution at A^2 = squares (s,), positive, by continuation from `start` or from rest, in doubles.

        Raises NoSelfConsistentFrequencies.
        """
        start = start or self.rest

        def reach(point: Point, part: float) -> Point:
            wanted = start.squares + part * (squares - start.squares) if part < 1 else squares
            return self.near(point, wanted)

        end, failure = walk(start, reach)
        if failure is not None:
            raise NoSelfConsistentFrequencies(self, squares, end.squares, failure)
        return end

    def near(self, point: Point, squares: Numbers) -> Point:
        """The solution at other amplitudes near a solution; raises NotFound."""
        guess = point.predicted(squares)
        found: Found[tuple[LindstedtSeries, Numbers]] = solve(
            lambda y: self._equations(y, squares), guess, point.inverse, *self._tolerances()
        )
        size = max(float(np.max(np.abs(guess))), float(np.max(np.abs(found.x))))
        if float(np.max(np.abs(found.x - guess))) > REACH * size:
            raise NotFound(found.x, found.residual, "the solution found is far from its prediction")
        series, slopes = found.value
        return Point(squares, found.x, slopes, found.inverse, series)

    def _tolerances(self) -> tuple[float, float]:
        return (LEAST, ROUNDING) if self.digits is None else (10.0 ** -(self.digits + SPARE),) * 2

    def _equations(self, y: Numbers, squares: Numbers) -> tuple[Numbers, float, tuple[LindstedtSeries, Numbers]]:
        """(Series - shift) / Omega at trial shifts, its size relative to the terms, the series and its slopes by A^2."""
        try:
            series = lindstedt(self.chain, self.seeds, self.exact(y), self.frequency_order, digits=self.digits)
        except InputError as error:  # also ResonantDivisor
            raise NotFound(y, float("nan"), str(error).split(";")[0]) from error
        with np.errstate(over="ignore", invalid="ignore"), self.numbers.context(self.digits):
            terms, slopes = series.frequency_terms(squares, self.frequency_order)
            linear = self.chain.frequencies(self.numbers)[np.array(self.seeds) - 1]
            left = terms[1:].sum(axis=0) / linear - y
            scale = np.abs(terms[1:]).sum(axis=0) / linear + np.abs(y)
            size = float(np.max(np.abs(left)) / np.max(scale)) if np.any(scale != 0) else 0.0
            return left, size, (series, slopes[1:].sum(axis=0) / linear[:, None])

    def exact(self, y: Numbers) -> tuple[Fraction, ...]:
        """Omega (1 + y) as exact decimals in which the shift Omega y has all its digits."""
        significant = 18 if self.digits is None else self.digits + GUARD_DIGITS
        values = []
        with mpmath.workdps(2 * significant + PLACES):
            for q, part in zip(self.seeds, y, strict=True):
                linear = self.chain.linear_frequency(q)
                shift = linear * (part if isinstance(part, mpmath.mpf) else mpmath.mpf(float(part)))
                if not mpmath.isfinite(shift):
                    raise NotFound(y, float("nan"), "the iteration runs away")
                lost = min(PLACES, max(0, -int(mpmath.floor(mpmath.log10(abs(shift)))))) if shift else PLACES
                values.append(Fraction(int(mpmath.nint((linear + shift) * 10 ** (significant + lost))), 10 ** (significant + lost)))
        return tuple(values)

    def polished(self, point: Point, squares: Numbers, digits: int) -> tuple[Frequencies, Point]:
        """The same solution with so many digits; squares as mpf."""
        search = Frequencies(self.chain, self.seeds, self.frequency_order, digits)
        with search.numbers.context(digits):
            array = search.numbers.array
            start = Point(array(point.squares), array(point.shifts), array(point.slopes), array(point.inverse))
            try:
                return search, search.near(start, squares)
            except NotFound as failure:
                raise NoSelfConsistentFrequencies(search, squares, point.squares, failure) from failure


@dataclass(frozen=True)
class Plan:
    """What is asked of a torus: the orders of its series, frequencies and coordinates, its phases and digits."""

    order: int
    frequency_order: int
    coordinate_order: int
    phases: Mapping[int, Number] | None
    digits: int | None

    def check_size(self, chain: Chain, seeds: tuple[int, ...]) -> None:
        """TooLarge before anything is computed."""
        check_size(chain, seeds, self.order, "fixedpoint" if self.digits else "float64", self.digits or 0)


def checked_plan(
    chain: Chain,
    order: int,
    frequency_order: int | None,
    coordinate_order: int | None,
    phases: Mapping[int, Number] | None,
    digits: int | None,
) -> Plan:
    """The arguments checked."""
    if not isinstance(chain, Chain):
        raise InputError("chain", chain, "a Chain", "make one: Chain(N=32, alpha='0.33')")
    order, first = integer(order, "order", 0), 2 // chain.degree_step
    orders = {"frequency_order": frequency_order, "coordinate_order": coordinate_order}
    K, coordinates = (integer(order if k is None else k, name, 0) for name, k in orders.items())
    for name, k in (("order", order), ("frequency_order", K)):
        if k < first:
            raise InputError(name, k, f"{first} or more, the order of the first frequency correction", f"take {first} or more")
    for name, k in (("frequency_order", K), ("coordinate_order", coordinates)):
        if k > order:
            raise InputError(name, k, f"0..{order}, the order of the series", "compute a longer series or lower it")
    if digits is not None:
        integer(digits, "digits", 1)
    return Plan(order, K, coordinates, phases, digits)


def torus_at_amplitudes(
    chain: Chain,
    amplitudes: Mapping[int, Number],
    order: int,
    *,
    frequency_order: int | None = None,
    coordinate_order: int | None = None,
    phases: Mapping[int, Number] | None = None,
    digits: int | None = None,
) -> QTorus:
    """The q-torus with these seed amplitudes; its frequencies are found (Eq. omeser).

    Solves omega = Omega + sum mu^k omega^(k)(A; omega).

    chain : the model; all quantities are dimensionless, phases in radians.
    amplitudes : A_q by seed, positive exact numbers (a phase of pi changes the sign); A_q multiplies
        cos(omega_q t + phi_q) in Q_q and is not Q_q(0).
    order : of the series.
    frequency_order : K of the frequency series, up to order; default the whole.
    coordinate_order : where Q_q(t) is cut, up to order; default order.
    phases : by seed, radians; default 0.
    digits : of all results; None for doubles.

    The paper chooses the frequencies and solves for the amplitudes. Here the divisors are those of the
    frequencies found, so that `solve_amplitudes` at them gives the amplitudes back. Of several solutions it
    is the one that continues the linear modes as the amplitudes grow.
    Raises InputError for arguments out of range, TooLarge as `lindstedt` does, NoSelfConsistentFrequencies
    where the family from rest ends or turns before, as it does at a strong resonance. The warnings of the
    torus are those of `solve_amplitudes`.

    >>> torus = torus_at_amplitudes(Chain(N=16, alpha="0.33"), {1: "0.58", 2: "0.41"}, order=8)
    >>> [round(float(w), 9) for w in torus.frequencies]
    [0.196256458, 0.390456207]
    """
    plan = checked_plan(chain, order, frequency_order, coordinate_order, phases, digits)
    numbers = positive_by_seed(chain, "amplitudes", amplitudes)
    plan.check_size(chain, tuple(numbers))
    search = Frequencies(chain, tuple(numbers), plan.frequency_order)
    squares = np.array([float(a) ** 2 for a in numbers.values()])
    refuse_tiny(search, squares, "amplitudes", amplitudes)
    point = search.at(squares)
    if digits is not None:
        with MULTIPRECISION.context(digits):
            search, point = search.polished(point, np.array([MULTIPRECISION.number(a) ** 2 for a in numbers.values()]), digits)
    return doubted(assembled(search, point, plan, numbers))


def positive_by_seed(chain: Chain, argument: str, values: Mapping[int, Number]) -> dict[int, Fraction]:
    """Exact positive numbers by seed, seeds ascending."""
    if not isinstance(values, Mapping):
        raise InputError(argument, values, "a mapping from seed modes to positive numbers", "write it as {seed: number}")
    seeds = tuple(sorted(seed_modes(values, chain.N)))
    numbers = {q: exact(values[q], f"{argument}, seed {q}") for q in seeds}
    for q, value in numbers.items():
        if not 1 / EXTREME <= value <= EXTREME:
            raise InputError(
                f"{argument}, seed {q}", values[q], "a positive number, 1e-60 to 1e60", "leave out modes at rest; signs are phases"
            )
    return numbers


def refuse_tiny(search: Frequencies, squares: Numbers, argument: str, typed: object) -> None:
    """InputError where the lowest corrections are too small for exact frequencies to show them."""
    shift = float(np.max(np.abs(search.rest.slopes @ squares)))
    if 0 < shift < SMALLEST_SHIFT:
        allowed = f"what changes a frequency by {SMALLEST_SHIFT:g} of itself or more"
        raise InputError(argument, typed, allowed, "take more, or the linear chain")


def assembled(search: Frequencies, point: Point, plan: Plan, amplitudes: Mapping[int, Any]) -> QTorus:
    """The torus of a solution, without warnings; amplitudes as exact numbers or in the arithmetic of the search."""
    series = point.series
    if series is None or series.order != plan.order:
        series = lindstedt(search.chain, search.seeds, search.exact(point.shifts), plan.order, digits=search.digits)
    with search.numbers.context(search.digits):
        terms, _ = series.frequency_terms(point.squares, plan.frequency_order)
        left = float(np.max(np.abs(terms[1:].sum(axis=0) - shifts(series))))
        given = {q: search.numbers.number(a) if isinstance(a, Fraction) else a for q, a in amplitudes.items()}
    return QTorus(
        series=series,
        amplitudes=given,
        phases=dict.fromkeys(series.seeds, 0.0) | by_seed("phases", plan.phases, series),
        frequency_order=plan.frequency_order,
        order=plan.coordinate_order,
        root_residual=left,
    )


def doubted(torus: QTorus) -> QTorus:
    """The same torus with its amplitude history, certificate and reasons to doubt it, as `solve_amplitudes` gives them."""
    series, K = torus.series, torus.frequency_order
    orders = [k for k in frequency_orders(series) if k <= K]
    try:
        history = amplitude_history(series)
    except UndeterminedAmplitudes as failure:
        return torus.doubted((str(failure).split(";")[0], *residual_doubts(torus)))
    amplitudes = tuple(torus.amplitudes.values())
    other = history.amplitudes.get(orders[-1], amplitudes)
    doubts = [*order_doubts(amplitudes, orders, history), *residual_doubts(torus)]
    if max(abs(float(a / b - 1)) for a, b in zip(amplitudes, other, strict=True)) > SAME:
        found = ", ".join(f"A_{q} = {float(a):.6g}" for q, a in zip(series.seeds, other, strict=True))
        doubts.append(f"these frequencies have other amplitudes as well: {found}")
    certificate = None
    if series.digits:
        with series.numbers.context(series.digits):
            certificate = certify_root(series, [a**2 for a in amplitudes], K)
    return replace(torus, history=dict(history.amplitudes), certificate=certificate).doubted(tuple(doubts))
