"""The paper's examples corrected: exact tori of the printed frequencies by Newton's method, and
the errors of the series against them.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import periodic_orbit
from symfpu.errors import SymfpuError
from symfpu.numbers.typed import exact
from symfpu.paper.printed import PrintedTorus
from symfpu.paper.steps import Step, unheard
from symfpu.refinement.newton import Report
from symfpu.refinement.tori import RefinedTorus, refine, refine_at_amplitudes
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import AmplitudeHistory, amplitude_history, solve_amplitudes
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# of two refinements with different harmonics: the digits in which they agree are converged
TOLERANCES = (1e-10, 1e-13)
GUESS_ORDER = 8  # of the series from which Newton's method starts
# shown of an amplitude, at most and where only the first refinement succeeds
MOST_DIGITS, FEW_DIGITS = 12, 8
# seconds for the refinement of one row, looked at between the steps of Newton's method
LIMIT, HEAVY_LIMIT = 420.0, 3600.0
# rows that take minutes, with --full only: their own tolerances and guess order
HEAVY: dict[str, tuple[tuple[float, ...], int]] = {
    "Fig. 5d": ((1e-9, 1e-11), 4),
}
# relative error of coefficients that doubles may leave: below it a series has arrived
FLOOR = 1e-12
ARRIVED = 10.0  # times the least error below FLOOR: the first order within has arrived
# times the least error: no longer falling from the first order within, and growing again
LEVEL, GROWN = 1.02, 2.0
SLOW, CHANGED = 0.9, 0.25  # factors shown with more digits, and change of the factor that is told
NEAR_END = 0.9  # of the longest order: an error that is least beyond still falls
LONG_SERIES, STRIDE = 60, 10  # beyond this order only every tenth one is compared
SCALED_ORDERS = (1, 2, 3, 4)
HALVINGS = 4


class TimeIsUp(SymfpuError):
    """A refinement took longer than it may."""

    def __init__(self, limit: float, line: str) -> None:
        super().__init__(
            f"more than {limit:.0f} s, the last step being: {line}; allow more time by LIMIT"
        )


@dataclass(frozen=True)
class Decay:
    """How an error falls with the order. factor : an order, by regression over the falling part (NaN
    for fewer than two orders).

    late : the same over the second half of the falling part. last : the first order of the least
    error, to LEVEL, or at which rounding is reached. least : the error there. longest : the last
    order that was computed. at_end : the error there. rounding : whether the least error is one
    of doubles.
    """

    factor: float
    late: float
    last: int
    least: float
    longest: int
    at_end: float
    rounding: bool

    def __str__(self) -> str:
        factor = (
            f"{self.factor:.2g} an order" if self.factor < SLOW else f"{self.factor:.3f} an order"
        )
        if abs(self.late / self.factor - 1) > CHANGED:
            factor += f" ({self.late:.2g} in the second half)"
        if self.rounding:
            return f"falls by {factor} and reaches rounding, {self.least:.0e}, at order {self.last}"
        falls = f"falls by {factor} to {self.least:.1e} at order {self.last}"
        if self.last >= NEAR_END * self.longest - 1:
            return f"{falls}; the longest is {self.longest}"
        after = f"grows, to {self.at_end:.1e}" if self.at_end > GROWN * self.least else "stays"
        return f"{falls}, then {after} (order {self.longest})"


@dataclass(frozen=True)
class SeriesErrors:
    """Errors of the truncated series against the exact torus, by order K of coordinates and
    frequencies; none where A(K) has no root.

    solved : largest Omega_q |c_q^PL[nu] - c_q[nu]| with the amplitudes A(K) of the truncated
    frequency series, relative to the largest Omega_q |c_q[nu]|. given : the same with the
    amplitudes of the exact torus. amplitudes : largest |A_q(K) / A_q - 1|.
    """

    solved: Mapping[int, float]
    given: Mapping[int, float]
    amplitudes: Mapping[int, float]


@dataclass(frozen=True)
class CorrectedRow:
    """One printed torus beside the exact one of the same frequencies.

    torus : by Newton's method, or None with the reason. digits : of the amplitudes that are
    converged, at most MOST_DIGITS.
    deviations : printed / exact - 1, of each amplitude. energies : by name, as in the table of the series.
    """

    printed: PrintedTorus
    torus: RefinedTorus | None = field(repr=False)
    reason: str
    digits: int
    deviations: Mapping[int, float]
    energies: Mapping[str, float]
    residual: float
    errors: SeriesErrors | None = field(repr=False)

    @property
    def energy_deviations(self) -> dict[str, float]:
        """Printed / exact - 1 of every energy that may be meant."""
        return {
            name: float(self.printed.energy) / value - 1 for name, value in self.energies.items()
        }

    @property
    def decays(self) -> dict[str, Decay]:
        """How the error falls, with the amplitudes `solved` and `given`.

        Empty where nothing was refined.
        """
        if self.errors is None:
            return {}
        return {"solved": decay(self.errors.solved), "given": decay(self.errors.given)}

    @property
    def verdict(self) -> str:
        """What the comparison says, in a sentence."""
        if self.torus is None:
            return f"not refined: {self.reason}"
        worst = max(self.deviations.values(), key=abs)
        found = f"printed amplitudes differ by up to {abs(worst):.1e}"
        decays = self.decays
        error = f"the error of the series {decays['solved']}; with the exact amplitudes it {decays['given']}"
        return f"{found}; {error}" + (f"; {self.reason}" if self.reason else "")


def corrected_row(
    printed: PrintedTorus, step: Step = unheard, *, series: LindstedtSeries | None = None
) -> CorrectedRow:
    """The exact torus of the printed frequencies, and the errors of the series of the printed order
    at every order.

    series : that series, if it is known already. step : told of every step of Newton's method. A
    row that takes more than LIMIT seconds or does not converge has no torus, and says why.
    """

    def tell(line: str) -> None:
        step(f"corrected: {printed.label}: {line}")

    torus, digits, reason = _refined(printed, tell)
    if torus is None:
        return left_out(printed, reason)
    if series is None:
        tell("series")
        series = lindstedt(printed.chain, printed.seeds, printed.frequencies, printed.order)
    return CorrectedRow(
        printed=printed,
        torus=torus,
        reason=reason,
        digits=digits,
        deviations={
            q: float(a) / torus.amplitudes[q] - 1
            for q, a in zip(printed.seeds, printed.amplitudes, strict=True)
        },
        energies={
            "H": float(torus.energy()),
            "harmonic energy at t = 0": float(torus.harmonic_energies().sum()),
            "harmonic energy, time average": float(torus.average_spectrum().sum()),
        },
        residual=torus.residual(),
        errors=series_errors(series, torus, tell),
    )


def left_out(printed: PrintedTorus, reason: str) -> CorrectedRow:
    """A row that is not refined."""
    return CorrectedRow(printed, None, reason, 0, {}, {}, np.nan, None)


def _refined(printed: PrintedTorus, tell: Report) -> tuple[RefinedTorus | None, int, str]:
    """The exact torus, the converged digits of its amplitudes, and what went wrong."""
    started, limit = time.monotonic(), HEAVY_LIMIT if printed.label in HEAVY else LIMIT

    def report(line: str) -> None:
        tell(line)
        if time.monotonic() - started > limit:
            raise TimeIsUp(limit, line)

    found: list[RefinedTorus] = []
    failed = ""
    try:
        tolerances, order = HEAVY.get(printed.label, (TOLERANCES, GUESS_ORDER))
        guess = _guess(printed, order, report)
        for tolerance in tolerances:
            torus = refine(found[-1] if found else guess, tolerance=tolerance, report=report)
            failed = "; ".join(torus.warnings)
            if failed:
                break
            found.append(torus)
    except SymfpuError as failure:
        failed = str(failure)
    if not found:
        return None, 0, failed
    last = found[-1]
    if failed:
        return last, FEW_DIGITS, f"to a residual of {last.residual():.0e} only: {failed}"
    change = max(abs(found[0].amplitudes[q] / a - 1) for q, a in last.amplitudes.items())
    return last, min(MOST_DIGITS, int(-np.log10(max(change, 1e-15)))), ""


def _guess(printed: PrintedTorus, order: int, tell: Report) -> QuasiPeriodic:
    """Where Newton's method starts: a short series, or for one seed the periodic orbit, which
    needs none.
    """
    chain, seeds = printed.chain, printed.seeds
    if len(seeds) == 1:
        tell("periodic orbit")
        return periodic_orbit(chain, seeds[0], printed.frequencies[0])
    tell("short series")
    return solve_amplitudes(lindstedt(chain, seeds, printed.frequencies, min(order, printed.order)))


class _Comparison:
    """Coefficients of a series, order by order, in one table with those of an exact torus.

    Rows are harmonics, one of each pair +-nu.
    """

    def __init__(self, series: LindstedtSeries, torus: QuasiPeriodic) -> None:
        self.series, self.linear = series, series.chain.frequencies()
        rows = {nu: i for i, nu in enumerate(map(tuple, _positive(torus.harmonics).tolist()))}
        unit = np.zeros(len(series.seeds))
        self.places = []
        for k in range(series.order + 1):
            harmonics = _positive(series.harmonic_terms(unit, k)[0]).tolist()
            self.places.append(
                np.array([rows.setdefault(tuple(nu), len(rows)) for nu in harmonics])
            )
        self.exact = np.zeros((len(rows), series.chain.N - 1))
        self.exact[: len(torus.harmonics)] = torus.cosines.astype(float)
        self.size = float((self.linear * np.abs(self.exact)).max())

    def errors(self, amplitudes: list[float], orders: range) -> list[float]:
        """The error of the series cut at each of some orders.

        The first one includes all orders before it.
        """
        difference, found = -self.exact, []
        for k in range(orders.stop):
            difference[self.places[k]] += self.series.harmonic_terms(amplitudes, k)[1]
            if k in orders:
                found.append(float((self.linear * np.abs(difference)).max()) / self.size)
        return found


def _positive(harmonics: Ints) -> Ints:
    """Harmonics with the first number that is not zero positive."""
    lead = harmonics[np.arange(len(harmonics)), np.argmax(harmonics != 0, axis=1)]
    return np.asarray(harmonics * np.where(lead < 0, -1, 1)[:, None])


def series_errors(
    series: LindstedtSeries, torus: RefinedTorus, tell: Report = unheard
) -> SeriesErrors:
    """Errors of a series against the exact torus of its frequencies, by order from 1 on."""
    history, compared = amplitude_history(series), _Comparison(series, torus)
    exact_ = [torus.amplitudes[q] for q in series.seeds]
    tell("errors with the exact amplitudes")
    orders = range(1, series.order + 1)
    given = dict(zip(orders, compared.errors(exact_, orders), strict=True))
    solved = {}
    for K in orders:
        if K > LONG_SERIES and K % STRIDE and series.order != K:
            continue
        tell(f"errors with the amplitudes of order {K}")
        values = _amplitudes_at(history, K)
        if values is not None:
            solved[K] = compared.errors(list(values), range(K, K + 1))[0]
    amplitudes = {
        k: max(abs(float(a) / b - 1) for a, b in zip(values, exact_, strict=True))
        for k, values in history.amplitudes.items()
    }
    return SeriesErrors(solved, given, amplitudes)


def _amplitudes_at(history: AmplitudeHistory, K: int) -> tuple[Any, ...] | None:
    """A(K), or None where the truncated frequency series has no root or no term."""
    last = max((k for k in history.orders if k <= K), default=None)
    return None if last is None else history.amplitudes.get(last)


def decay(errors: Mapping[int, float]) -> Decay:
    """How errors fall with the order, over the orders up to the least one."""
    least = min(errors, key=lambda k: errors[k])
    rounding = errors[least] < FLOOR
    last = next(
        k for k, e in errors.items() if e <= (ARRIVED if rounding else LEVEL) * errors[least]
    )
    falling = np.array([(k, np.log(e)) for k, e in errors.items() if k <= last and e > 0])
    longest = max(errors)
    return Decay(
        _factor(falling),
        _factor(falling[len(falling) // 2 :]),
        last,
        errors[last],
        longest,
        errors[longest],
        rounding,
    )


def _factor(logarithms: Floats) -> float:
    """exp of the slope of (order, logarithm) pairs (n, 2)."""
    return (
        float(np.exp(np.polyfit(logarithms[:, 0], logarithms[:, 1], 1)[0]))
        if len(logarithms) > 1
        else np.nan
    )


def corrected_rows(
    known: Mapping[PrintedTorus, LindstedtSeries], step: Step = unheard, *, full: bool = False
) -> Iterator[CorrectedRow]:
    """The corrected row of each printed torus with its series; those of HEAVY only if full."""
    for printed, series in known.items():
        if printed.label in HEAVY and not full:
            yield left_out(printed, "takes minutes; computed with --full")
        else:
            yield corrected_row(printed, step, series=series)


@dataclass(frozen=True)
class ScalingStudy:
    """Does the error of order K fall as mu^(K+1)? Errors of the series at tori whose amplitudes are
    halved again and again.

    What counts is mu A (the couplings and amplitudes enter the alpha model as their product), so
    scaling A is scaling mu.
    scales : of the amplitudes. given, solved : errors by order, along the scales, as in SeriesErrors.
    """

    label: str
    scales: tuple[float, ...]
    given: Mapping[int, tuple[float, ...]]
    solved: Mapping[int, tuple[float, ...]]

    def rate(self, errors: tuple[float, ...]) -> float:
        """The exponent of mu: the slope between the two smallest scales at which the error is
        above rounding.
        """
        seen = [(x, e) for x, e in zip(self.scales, errors, strict=True) if e > ARRIVED * FLOOR]
        if len(seen) < 2:
            return np.nan
        (x, e), (y, f) = seen[-2:]
        return float(np.log(e / f) / np.log(x / y))

    @property
    def rates(self) -> dict[int, tuple[float, float]]:
        """Exponents by order, with given and with solved amplitudes (NaN where the frequency
        series has no term).
        """
        return {
            K: (self.rate(e), self.rate(self.solved[K]) if K in self.solved else np.nan)
            for K, e in self.given.items()
        }


def scaling_study(torus: RefinedTorus, label: str, step: Step = unheard) -> ScalingStudy:
    """The errors of the orders SCALED_ORDERS at an exact torus and at those of 1/2, 1/4, ... of its amplitudes."""
    scales = tuple(0.5**j for j in range(HALVINGS + 1))
    given: dict[int, list[float]] = {}
    solved: dict[int, list[float]] = {}
    for scale in scales:
        step(f"corrected: {label}: amplitudes times {scale:g}")
        member = torus if scale == 1 else _scaled(torus, scale)
        series = lindstedt(member.chain, member.seeds, member.frequencies, max(SCALED_ORDERS))
        errors = series_errors(series, member)
        for K in SCALED_ORDERS:
            given.setdefault(K, []).append(errors.given[K])
            if K in errors.solved:
                solved.setdefault(K, []).append(errors.solved[K])
    return ScalingStudy(
        label,
        scales,
        {K: tuple(e) for K, e in given.items()},
        {K: tuple(e) for K, e in solved.items()},
    )


def _scaled(torus: RefinedTorus, scale: float) -> RefinedTorus:
    """The exact torus with scaled amplitudes.

    Its guess has c[nu] scaled by scale^|nu| and, at nu = 0, by its square.
    """
    lengths = np.abs(torus.harmonics).sum(axis=1)
    powers = np.where(lengths == 0, 2, lengths)
    with_digits = [
        exact(repr(float(w)), "frequency")
        for w in torus.chain.frequencies()[np.array(torus.seeds) - 1]
    ]
    rates = tuple(
        w + (x - w) * exact(scale**2, "scale")
        for w, x in zip(with_digits, torus.frequencies, strict=True)
    )
    cosines = torus.cosines * scale ** powers[:, None]
    guess = FourierTorus(torus.chain, torus.seeds, rates, torus.harmonics, cosines, torus.phases)
    return refine_at_amplitudes(guess, {q: a * scale for q, a in torus.amplitudes.items()})
