"""Errors of a series against the exact torus of its frequencies, by order and by mu."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.numbers.typed import exact
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import AmplitudeHistory, amplitude_history
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# relative error of coefficients that doubles may leave: below it a series has arrived
ROUNDING_ERROR = 1e-12
# times the least error below ROUNDING_ERROR: the first order within has arrived
ROUNDING_FACTOR = 10.0
# times the least error: no longer falling from the first order within, and growing again
LEVEL_FACTOR, GROWTH_FACTOR = 1.02, 2.0
# factors above it are shown with more digits; change of the factor that is told
SLOW_FACTOR, TOLD_CHANGE = 0.9, 0.25
END_SHARE = 0.9  # of the longest order: an error that is least beyond still falls
LONG_SERIES, STRIDE = 60, 10  # beyond this order only every tenth one is compared
SCALED_ORDERS = (1, 2, 3, 4)
HALVINGS = 4


@dataclass(frozen=True)
class Decay:
    """How an error falls with the order.

    factor : an order, by regression over the falling part (NaN for fewer than two orders).
    late : the same over the second half of the falling part. last : the first order of the least
    error, to LEVEL_FACTOR, or at which rounding is reached. least : the error there. longest : the
    last order that was computed. at_end : the error there. rounding : whether the least error is
    one of doubles.
    """

    factor: float
    late: float
    last: int
    least: float
    longest: int
    at_end: float
    rounding: bool

    def __str__(self) -> str:
        digits = ".2g" if self.factor < SLOW_FACTOR else ".3f"
        factor = f"{self.factor:{digits}} an order"
        if abs(self.late / self.factor - 1) > TOLD_CHANGE:
            factor += f" ({self.late:.2g} in the second half)"
        if self.rounding:
            least = f"{self.least:.0e}"
            return f"falls by {factor} and reaches rounding, {least}, at order {self.last}"
        falls = f"falls by {factor} to {self.least:.1e} at order {self.last}"
        if self.last >= END_SHARE * self.longest - 1:
            return f"{falls}; the longest is {self.longest}"
        grows = self.at_end > GROWTH_FACTOR * self.least
        after = f"grows, to {self.at_end:.1e}" if grows else "stays"
        return f"{falls}, then {after} (order {self.longest})"


def decay(errors: Mapping[int, float]) -> Decay:
    """How errors fall with the order, over the orders up to the least one."""
    least_order = min(errors, key=lambda k: errors[k])
    least = errors[least_order]
    rounding = least < ROUNDING_ERROR
    within = (ROUNDING_FACTOR if rounding else LEVEL_FACTOR) * least
    last = next(k for k, e in errors.items() if e <= within)
    falling = np.array([(k, np.log(e)) for k, e in errors.items() if k <= last and e > 0])
    second_half = falling[len(falling) // 2 :]
    longest = max(errors)
    at_end = errors[longest]
    factor, late = _factor(falling), _factor(second_half)
    return Decay(factor, late, last, errors[last], longest, at_end, rounding)


def _factor(logarithms: Floats) -> float:
    """exp of the slope of (order, logarithm) pairs (n, 2)."""
    if len(logarithms) < 2:
        return np.nan
    slope = np.polyfit(logarithms[:, 0], logarithms[:, 1], 1)[0]
    return float(np.exp(slope))


@dataclass(frozen=True)
class SeriesErrors:
    """Errors of the truncated series against the exact torus, by order K.

    K is the order of coordinates and frequencies; there is none where A(K) has no root.
    solved : largest Omega_q |c_q^PL[nu] - c_q[nu]| with the amplitudes A(K) of the truncated
    frequency series, relative to the largest Omega_q |c_q[nu]|. given : the same with the
    amplitudes of the exact torus. amplitudes : largest |A_q(K) / A_q - 1|.
    """

    solved: Mapping[int, float]
    given: Mapping[int, float]
    amplitudes: Mapping[int, float]


class _Comparison:
    """Coefficients of a series, order by order, in one table with those of an exact torus.

    Rows are harmonics, one of each pair +-nu.
    """

    def __init__(self, series: LindstedtSeries, torus: Torus) -> None:
        self.series = series
        self.linear = series.chain.frequencies()
        known = map(tuple, _positive(torus.harmonics).tolist())
        rows = {nu: i for i, nu in enumerate(known)}
        unit = np.zeros(len(series.seeds))
        self.places = []
        for k in range(series.order + 1):
            harmonics, _ = series.harmonic_terms(unit, k)
            found = map(tuple, _positive(harmonics).tolist())
            places = [rows.setdefault(nu, len(rows)) for nu in found]
            self.places.append(np.array(places))
        self.exact = np.zeros((len(rows), series.chain.N - 1))
        self.exact[: len(torus.harmonics)] = torus.cosines.astype(float)
        self.size = float((self.linear * np.abs(self.exact)).max())

    def errors(self, amplitudes: list[float], orders: range) -> list[float]:
        """The error of the series cut at each of some orders.

        The first one includes all orders before it.
        """
        difference = -self.exact
        found = []
        for k in range(orders.stop):
            _, terms = self.series.harmonic_terms(amplitudes, k)
            difference[self.places[k]] += terms
            if k in orders:
                largest = float((self.linear * np.abs(difference)).max())
                found.append(largest / self.size)
        return found


def _positive(harmonics: Ints) -> Ints:
    """Harmonics with the first number that is not zero positive."""
    first = np.argmax(harmonics != 0, axis=1)
    lead = harmonics[np.arange(len(harmonics)), first]
    sign = np.where(lead < 0, -1, 1)
    return np.asarray(harmonics * sign[:, None])


def series_errors(
    series: LindstedtSeries, torus: Torus[Newton], tell: Progress = unheard
) -> SeriesErrors:
    """Errors of a series against the exact torus of its frequencies, by order from 1 on."""
    history = amplitude_history(series)
    compared = _Comparison(series, torus)
    exact_amplitudes = [torus.amplitudes[q] for q in series.seeds]
    tell("errors with the exact amplitudes", NO_FRACTION)
    orders = range(1, series.order + 1)
    errors = compared.errors(exact_amplitudes, orders)
    given = dict(zip(orders, errors, strict=True))
    solved = {}
    for K in _compared_orders(series.order):
        tell(f"errors with the amplitudes of order {K}", NO_FRACTION)
        values = _amplitudes_at(history, K)
        if values is not None:
            (solved[K],) = compared.errors(list(values), range(K, K + 1))
    amplitudes = {}
    for k, values in history.amplitudes.items():
        pairs = zip(values, exact_amplitudes, strict=True)
        amplitudes[k] = max(abs(float(a) / b - 1) for a, b in pairs)
    return SeriesErrors(solved, given, amplitudes)


def _compared_orders(longest: int) -> Iterator[int]:
    """Every order of a short series, every tenth one of a long one beyond its beginning."""
    for K in range(1, longest + 1):
        if K <= LONG_SERIES or K % STRIDE == 0 or longest == K:
            yield K


def _amplitudes_at(history: AmplitudeHistory, K: int) -> tuple[Any, ...] | None:
    """A(K), or None where the truncated frequency series has no root or no term."""
    last = max((k for k in history.orders if k <= K), default=None)
    return None if last is None else history.amplitudes.get(last)


@dataclass(frozen=True)
class ScalingStudy:
    """Does the error of order K fall as mu^(K+1)?

    Errors of the series at tori whose amplitudes are halved again and again.
    What counts is mu A (the couplings and amplitudes enter the alpha model as their product), so
    scaling A is scaling mu.
    scales : of the amplitudes. given, solved : errors by order, along the scales, as in
    SeriesErrors.
    """

    label: str
    scales: tuple[float, ...]
    given: Mapping[int, tuple[float, ...]]
    solved: Mapping[int, tuple[float, ...]]

    def rate(self, errors: tuple[float, ...]) -> float:
        """The exponent of mu.

        The slope between the two smallest scales at which the error is above rounding.
        """
        pairs = zip(self.scales, errors, strict=True)
        seen = [(x, e) for x, e in pairs if e > ROUNDING_FACTOR * ROUNDING_ERROR]
        if len(seen) < 2:
            return np.nan
        (x, e), (y, f) = seen[-2:]
        return float(np.log(e / f) / np.log(x / y))

    @property
    def rates(self) -> dict[int, tuple[float, float]]:
        """Exponents by order, with given and with solved amplitudes.

        NaN where the frequency series has no term.
        """
        exponents = {}
        for K, given in self.given.items():
            solved = self.rate(self.solved[K]) if K in self.solved else np.nan
            exponents[K] = (self.rate(given), solved)
        return exponents


def scaling_study(
    torus: Torus[Newton], label: str, progress: Progress = unheard
) -> ScalingStudy:
    """The errors of the orders SCALED_ORDERS at an exact torus and at scaled ones.

    Those have 1/2, 1/4, ... of its amplitudes.
    """
    scales = tuple(0.5**j for j in range(HALVINGS + 1))
    longest = max(SCALED_ORDERS)
    given: dict[int, tuple[float, ...]] = {}
    solved: dict[int, tuple[float, ...]] = {}
    for scale in scales:
        progress(f"corrected: {label}: amplitudes times {scale:g}", NO_FRACTION)
        member = torus if scale == 1 else _scaled(torus, scale)
        series = lindstedt(member.chain, member.seeds, member.frequencies, longest)
        errors = series_errors(series, member)
        for K in SCALED_ORDERS:
            given[K] = (*given.get(K, ()), errors.given[K])
            if K in errors.solved:
                solved[K] = (*solved.get(K, ()), errors.solved[K])
    return ScalingStudy(label, scales, given, solved)


def _scaled(torus: Torus[Newton], scale: float) -> Torus[Newton]:
    """The exact torus with scaled amplitudes.

    Its guess has c[nu] scaled by scale^|nu| and, at nu = 0, by its square.
    """
    lengths = np.abs(torus.harmonics).sum(axis=1)
    powers = np.where(lengths == 0, 2, lengths)
    cosines = torus.cosines * scale ** powers[:, None]
    linear = torus.chain.frequencies()[np.array(torus.seeds) - 1]
    square = exact(scale**2, "scale")
    rates = []
    for rounded, chosen in zip(linear, torus.frequencies, strict=True):
        seed_rate = exact(repr(float(rounded)), "frequency")
        rates.append(seed_rate + (chosen - seed_rate) * square)
    guess = Torus(
        torus.chain, torus.seeds, tuple(rates), torus.harmonics, cosines, torus.phases
    )
    amplitudes = {q: a * scale for q, a in torus.amplitudes.items()}
    return refine(guess, amplitudes=amplitudes)
