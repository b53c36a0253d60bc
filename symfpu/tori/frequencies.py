"""Amplitudes to frequencies: Eq. omeser whose divisors hold the omega themselves.

omega_q = Omega_q + sum mu^k omega_q^(k)(A; omega).

Eq. omeser read from the other side. The unknowns are the shifts omega_q - Omega_q; a trial costs
one series. Every trial frequency is an exact decimal with so many places that its shift keeps all
its digits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import Chain, require_chain
from symfpu.errors import InputError, SymfpuError, UndeterminedAmplitudes
from symfpu.numbers.arithmetic import (
    DOUBLES,
    GUARD_DIGITS,
    MULTIPRECISION,
    Arithmetic,
    Numbers,
)
from symfpu.numbers.typed import Number, exact
from symfpu.series.arguments import digits_of
from symfpu.series.lindstedt import lindstedt
from symfpu.series.memory import check_size
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import (
    amplitude_history,
    judged,
    orders_up_to,
    residual_doubts,
    shifts,
)
from symfpu.tori.broyden import Found, NotFound, solve, walk
from symfpu.tori.from_series import FromSeries, require_series_torus
from symfpu.tori.orders import Orders, require_shifts
from symfpu.tori.short_series import shifts_by_squares
from symfpu.tori.torus import Torus

LARGEST_NUMBER = 10**60  # size of an amplitude or a weight
SMALLEST_SHIFT = 1e-30  # of a frequency; what `shifts` still sees in doubles
PLACES = 40  # decimals at most beyond the significant ones
# of the sum of moduli of the series: what a solution may leave
ROUNDING = 256 * np.finfo(float).eps
LEAST_RESIDUAL = 4 * np.finfo(float).eps  # what is not worth another series
# digits beyond the asked ones to which a solution with digits is found; its series carry more
SPARE_DIGITS = 3
LARGEST_DEVIATION = (
    0.1  # change of the shifts from their prediction, relative, that stays on the family
)
SAME_ROOT = 1e-6  # relative difference of amplitudes that are the same root


class NoSelfConsistentFrequencies(SymfpuError):
    """No frequencies for these amplitudes: the walk from rest ends before.

    Raised by `torus` of a series at given amplitudes.

    frequency_order : K. amplitudes : asked for; reached : by seed, the last ones on the way that
        have frequencies.
    frequencies : the last iterate by seed; residual : what it leaves, relative to the shifts.
        reason : in words. All dimensionless. Ours.
    """

    def __init__(
        self, search: Frequencies, squares: Numbers, reached: Numbers, failure: NotFound
    ) -> None:
        seeds = search.seeds
        self.frequency_order = search.frequency_order
        self.reason = failure.reason
        self.residual = failure.residual
        self.amplitudes = _roots_by_seed(seeds, squares)
        self.reached = _roots_by_seed(seeds, reached)
        iterate = search.linear * (1 + failure.iterate.astype(float))
        self.frequencies = dict(zip(seeds, iterate.tolist(), strict=True))
        asked = listed("A", self.amplitudes)
        last = listed("A", self.reached)
        omega = listed("omega", self.frequencies)
        left = (
            ""
            if np.isnan(self.residual)
            else f" and leaves {self.residual:.2g} of the shifts"
        )
        where = f"no frequencies for {asked} at frequency order {self.frequency_order}"
        end = f"the last iterate is {omega}{left}"
        way = f"solutions were followed from rest to {last}"
        super().__init__(f"{where}: {self.reason}; {end}; {way}: take smaller amplitudes")


def _roots_by_seed(seeds: tuple[int, ...], squares: Numbers) -> dict[int, float]:
    return {q: float(x) ** 0.5 for q, x in zip(seeds, squares, strict=True)}


def listed(name: str, values: Mapping[int, float]) -> str:
    """Numbers by seed in a sentence."""
    return ", ".join(f"{name}_{q} = {value:.6g}" for q, value in values.items())


@dataclass(frozen=True, eq=False)
class Point:
    """A solution: A^2, (omega - Omega) / Omega, both (s,).

    Its derivatives by A^2 (s, s); the Broyden matrix; its series.
    """

    squares: Numbers
    shifts: Numbers
    slopes: Numbers
    inverse: Numbers
    series: LindstedtSeries | None = None

    def predicted(self, squares: Numbers) -> Numbers:
        """The shifts at other amplitudes, by the derivative of the solution."""
        change = squares - self.squares
        return np.asarray(self.shifts - self.inverse @ self.slopes @ change)


class Frequencies:
    """The frequencies that belong to amplitudes.

    For one chain, its seeds (ascending) and the orders of its series.
    """

    def __init__(
        self,
        chain: Chain,
        seeds: tuple[int, ...],
        orders: Orders,
        digits: int | None = None,
    ) -> None:
        self.chain = chain
        self.seeds = seeds
        self.orders = orders
        self.frequency_order = orders.frequency_order
        self.digits = digits
        self.modes = np.array(seeds) - 1
        self.linear = chain.frequencies()[self.modes]
        slopes = shifts_by_squares(chain, seeds) / self.linear[:, None]
        s = len(seeds)
        self.rest = Point(np.zeros(s), np.zeros(s), slopes, -np.eye(s))

    @property
    def numbers(self) -> Arithmetic:
        """The arithmetic of the shifts."""
        return DOUBLES if self.digits is None else MULTIPRECISION

    def at(self, squares: Numbers, start: Point | None = None) -> Point:
        """The solution at A^2 = squares (s,), positive, in doubles.

        By continuation from `start` or from rest.

        Raises NoSelfConsistentFrequencies.
        """
        start = start or self.rest

        def reach(point: Point, part: float) -> Point:
            if part < 1:
                change = squares - start.squares
                return self.near(point, start.squares + part * change)
            return self.near(point, squares)

        end, failure = walk(start, reach)
        if failure is not None:
            raise NoSelfConsistentFrequencies(self, squares, end.squares, failure)
        return end

    def point_of(self, torus: Torus[FromSeries]) -> Point:
        """The solution that a torus is, in doubles; InputError for one of other seeds or chain."""
        series = require_series_torus(torus, "near").origin.series
        same = series.chain == self.chain and tuple(sorted(series.seeds)) == self.seeds
        if not same:
            allowed = "a torus of this chain and these seeds"
            raise InputError("near", torus.seeds, allowed, "leave it out")
        squares = np.array([float(torus.amplitudes[q]) ** 2 for q in self.seeds])
        by_mode = dict(zip(series.seeds, shifts(series).astype(float), strict=True))
        y = np.array([by_mode[q] for q in self.seeds]) / self.linear
        known = min(series.order, self.frequency_order)
        _, slopes = series.frequency_terms(squares, known)
        relative = slopes[1:].sum(axis=0).astype(float) / self.linear[:, None]
        return Point(squares, y, relative, self.rest.inverse)

    def near(self, point: Point, squares: Numbers) -> Point:
        """The solution at other amplitudes near a solution; raises NotFound."""
        guess = point.predicted(squares)

        def equations(y: Numbers) -> tuple[Numbers, float, tuple[LindstedtSeries, Numbers]]:
            return self._equations(y, squares)

        tolerances = self._tolerances()
        found: Found[tuple[LindstedtSeries, Numbers]]
        found = solve(equations, guess, point.inverse, *tolerances)
        expected_size = float(np.max(np.abs(guess)))
        found_size = float(np.max(np.abs(found.x)))
        size = max(expected_size, found_size)
        distance = float(np.max(np.abs(found.x - guess)))
        # at rest no shift is predicted where the lowest order has none
        if expected_size and distance > LARGEST_DEVIATION * size:
            raise NotFound(
                found.x, found.residual, "the solution found is far from its prediction"
            )
        series, slopes = found.value
        return Point(squares, found.x, slopes, found.inverse, series)

    def _tolerances(self) -> tuple[float, float]:
        if self.digits is None:
            return LEAST_RESIDUAL, ROUNDING
        last_place = 10.0 ** -(self.digits + SPARE_DIGITS)
        return last_place, last_place

    def _equations(
        self, y: Numbers, squares: Numbers
    ) -> tuple[Numbers, float, tuple[LindstedtSeries, Numbers]]:
        """(Series - shift) / Omega at trial shifts, its relative size, the series and its slopes.

        The size is relative to the terms; the slopes are by A^2.
        """
        series = self._series_at(y)
        with (
            np.errstate(over="ignore", invalid="ignore"),
            self.numbers.context(self.digits),
        ):
            terms, slopes = series.frequency_terms(squares, self.frequency_order)
            linear = self.chain.frequencies(self.numbers)[self.modes]
            corrections = terms[1:]
            left = corrections.sum(axis=0) / linear - y
            scale = np.abs(corrections).sum(axis=0) / linear + np.abs(y)
            size = 0.0
            if np.any(scale != 0):
                size = float(np.max(np.abs(left)) / np.max(scale))
            relative_slopes = slopes[1:].sum(axis=0) / linear[:, None]
            return left, size, (series, relative_slopes)

    def _series_at(self, y: Numbers) -> LindstedtSeries:
        """The series at trial shifts; raises NotFound where there is none."""
        K = self.frequency_order
        try:
            frequencies = self.exact(y)
            return lindstedt(self.chain, self.seeds, frequencies, K, digits=self.digits)
        except InputError as error:  # also ResonantDivisor
            reason = str(error).split(";")[0]
            raise NotFound(y, float("nan"), reason) from error

    def exact(self, y: Numbers) -> tuple[Fraction, ...]:
        """Omega (1 + y) as exact decimals in which the shift Omega y has all its digits."""
        significant = 18 if self.digits is None else self.digits + GUARD_DIGITS
        values = []
        with mpmath.workdps(2 * significant + PLACES):
            for q, part in zip(self.seeds, y, strict=True):
                linear = self.chain.linear_frequency(q)
                relative = part if isinstance(part, mpmath.mpf) else mpmath.mpf(float(part))
                shift = linear * relative
                if not mpmath.isfinite(shift):
                    raise NotFound(y, float("nan"), "the iteration runs away")
                places = significant + _leading_zeros(shift)
                whole = mpmath.nint((linear + shift) * 10**places)
                values.append(Fraction(int(whole), 10**places))
        return tuple(values)

    def polished(
        self, point: Point, squares: Numbers, digits: int
    ) -> tuple[Frequencies, Point]:
        """The same solution with so many digits; squares as mpf."""
        search = Frequencies(self.chain, self.seeds, self.orders, digits)
        with search.numbers.context(digits):
            array = search.numbers.array
            amplitudes = array(point.squares)
            guess = array(point.shifts)
            slopes = array(point.slopes)
            inverse = array(point.inverse)
            start = Point(amplitudes, guess, slopes, inverse)
            try:
                return search, search.near(start, squares)
            except NotFound as failure:
                ended = NoSelfConsistentFrequencies(search, squares, point.squares, failure)
                raise ended from failure

    def torus(self, point: Point, amplitudes: Mapping[int, Any]) -> Torus[FromSeries]:
        """The torus of a solution, without warnings.

        amplitudes : by seed, exact or in the arithmetic of the search.
        """
        series, orders = point.series, self.orders
        if series is None or series.order != orders.order:
            frequencies = self.exact(point.shifts)
            series = lindstedt(
                self.chain, self.seeds, frequencies, orders.order, digits=self.digits
            )
        with self.numbers.context(self.digits):
            terms, _ = series.frequency_terms(point.squares, orders.frequency_order)
            left = terms[1:].sum(axis=0) - shifts(series)
            residual = float(np.max(np.abs(left)))
            given = {}
            for q, a in amplitudes.items():
                given[q] = self.numbers.number(a) if isinstance(a, Fraction) else a
        sizes = tuple(given[q] for q in series.seeds)
        cuts = orders.frequency_order, orders.coordinate_order
        return FromSeries(series, sizes, *cuts, root_residual=residual).torus()


def _leading_zeros(shift: Any) -> int:
    """Zeros of an mpf below 1 after its point, at most PLACES."""
    if not shift:
        return PLACES
    magnitude = int(mpmath.floor(mpmath.log10(abs(shift))))
    return min(PLACES, max(0, -magnitude))


def require_size(
    chain: Chain, seeds: tuple[int, ...], order: int, digits: int | None
) -> None:
    """TooLarge before anything is computed."""
    ring = "fixedpoint" if digits else "float64"
    check_size(chain, seeds, order, ring, digits or 0)


def series_at_amplitudes(
    chain: Chain,
    amplitudes: Mapping[int, Number],
    orders: Orders,
    *,
    digits: int | None = None,
    near: Torus[FromSeries] | None = None,
) -> Torus[FromSeries]:
    """The torus of the series with these seed amplitudes; its frequencies are found (Eq. omeser).

    Solves omega = Omega + sum mu^k omega^(k)(A; omega).

    chain : with fixed ends. amplitudes : A_q by seed, positive exact numbers (a phase of pi changes
        the sign); A_q multiplies cos(omega_q t + phi_q) in Q_q and is not Q_q(0).
    digits : of all results; None for doubles.
    near : a torus of the same chain and seeds, such as the one at amplitudes a little smaller, from
        which the way begins; default rest. It saves time and decides nothing else.

    The paper chooses the frequencies and solves for the amplitudes. Here the divisors are those
    of the frequencies found, so that `solve_amplitudes` at them gives the amplitudes back. Of
    several solutions it is the one that continues the linear modes as the amplitudes grow.
    Raises InputError for arguments out of range, TooLarge as `lindstedt` does,
    NoSelfConsistentFrequencies where the family from rest ends or turns before, as it does at a
    strong resonance. The warnings of the torus are those of `solve_amplitudes`.
    """
    require_chain(chain)
    require_shifts(orders, chain)
    places = None if digits is None else digits_of(digits)
    numbers = positive_by_seed(chain, "amplitudes", amplitudes)
    seeds = tuple(numbers)
    require_size(chain, seeds, orders.order, places)
    search = Frequencies(chain, seeds, orders)
    squares = np.array([float(a) ** 2 for a in numbers.values()])
    refuse_tiny(search, squares, "amplitudes", amplitudes)
    point = search.at(squares, None if near is None else search.point_of(near))
    if places is not None:
        with MULTIPRECISION.context(places):
            exact_squares = np.array(
                [MULTIPRECISION.number(a) ** 2 for a in numbers.values()]
            )
            search, point = search.polished(point, exact_squares, places)
    return doubted(search.torus(point, numbers))


def positive_by_seed(
    chain: Chain, argument: str, values: Mapping[int, Number]
) -> dict[int, Fraction]:
    """Exact positive numbers by seed, seeds ascending."""
    if not isinstance(values, Mapping):
        allowed = "a mapping from seed modes to positive numbers"
        raise InputError(argument, values, allowed, "write it as {seed: number}")
    modes = sorted(chain.seeds_of(values), key=lambda q: (abs(q), -q))
    numbers = {q: exact(values[q], f"{argument}, seed {q}") for q in modes}
    for q, value in numbers.items():
        if not 1 / LARGEST_NUMBER <= value <= LARGEST_NUMBER:
            entry = f"{argument}, seed {q}"
            allowed = "a positive number, 1e-60 to 1e60"
            advice = "leave out modes at rest; signs are phases"
            raise InputError(entry, values[q], allowed, advice)
    return numbers


def refuse_tiny(
    search: Frequencies, squares: Numbers, argument: str, typed: object
) -> None:
    """InputError where the lowest corrections are too small for exact frequencies to show them."""
    lowest = search.rest.slopes @ squares
    shift = float(np.max(np.abs(lowest)))
    if 0 < shift < SMALLEST_SHIFT:
        allowed = f"what changes a frequency by {SMALLEST_SHIFT:g} of itself or more"
        raise InputError(argument, typed, allowed, "take more, or the linear chain")


def doubted(torus: Torus[FromSeries]) -> Torus[FromSeries]:
    """The same torus with its amplitude history, certificate and doubts.

    As `solve_amplitudes` gives them.
    """
    series, K = torus.origin.series, torus.origin.frequency_order
    try:
        history = amplitude_history(series)
    except UndeterminedAmplitudes as failure:
        undetermined = str(failure).split(";")[0]
        return torus.doubted((undetermined, *residual_doubts(torus)))
    found = judged(torus, history)
    amplitudes = tuple(torus.amplitudes.values())
    *_, last = orders_up_to(series, K)
    other = history.amplitudes.get(last, amplitudes)
    distances = [abs(float(a / b - 1)) for a, b in zip(amplitudes, other, strict=True)]
    if max(distances) <= SAME_ROOT:
        return found
    roots = listed("A", dict(zip(series.seeds, map(float, other), strict=True)))
    doubt = f"these frequencies have other amplitudes as well: {roots}"
    return found.doubted((*found.warnings, doubt))
