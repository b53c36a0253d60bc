"""The paper's examples corrected: exact tori of the printed frequencies by Newton's method."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from symfpu.breathers.balance import breather_of_frequency
from symfpu.errors import SymfpuError
from symfpu.files.progress import NO_FRACTION, Progress, labelled, unheard
from symfpu.paper.printed import PrintedTorus
from symfpu.paper.series_errors import Decay, SeriesErrors, decay, series_errors
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.torus import Torus

# of two refinements with different harmonics: the digits in which they agree are converged
TOLERANCES = (1e-10, 1e-13)
GUESS_ORDER = 8  # of the series from which Newton's method starts
# shown of an amplitude or energy, at most and where only the first refinement succeeds
MOST_DIGITS, LEAST_DIGITS = 12, 8
LEAST_CHANGE = 1e-15  # relative, from which digits are counted
# seconds for the refinement of one row, looked at between the steps of Newton's method
LIMIT, HEAVY_LIMIT = 420.0, 3600.0
# rows that take half a minute, with --full only: their own tolerances and guess order
HEAVY_ROWS: dict[str, tuple[tuple[float, ...], int]] = {
    "Fig. 5d": ((1e-9, 1e-11), 4),
}


class TimeIsUp(SymfpuError):
    """A refinement took longer than it may."""

    def __init__(self, limit: float, line: str) -> None:
        last = f"the last step being: {line}"
        super().__init__(f"more than {limit:.0f} s, {last}; allow more time by LIMIT")


@dataclass(frozen=True)
class CorrectedRow:
    """One printed torus beside the exact one of the same frequencies.

    torus : by Newton's method, or None with the reason. digits, energy_digits : of the amplitudes
    and of the energies that are converged, at most MOST_DIGITS.
    deviations : printed / exact - 1, of each amplitude. energies : by name, as in the table of
    the series.
    """

    printed: PrintedTorus
    torus: Torus[Newton] | None = field(repr=False)
    reason: str
    digits: int
    energy_digits: int
    deviations: Mapping[int, float]
    energies: Mapping[str, float]
    residual: float
    errors: SeriesErrors | None = field(repr=False)

    @property
    def energy_deviations(self) -> dict[str, float]:
        """Printed / exact - 1 of every energy that may be meant."""
        printed = float(self.printed.energy)
        return {name: printed / value - 1 for name, value in self.energies.items()}

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
        decays = self.decays
        parts = [f"printed amplitudes differ by up to {abs(worst):.1e}"]
        solved = f"the error of the series {decays['solved']}"
        parts += [solved, f"with the exact amplitudes it {decays['given']}"]
        if self.reason:
            parts.append(self.reason)
        return "; ".join(parts)


def corrected_rows(
    known: Mapping[PrintedTorus, LindstedtSeries],
    progress: Progress = unheard,
    *,
    full: bool = False,
) -> Iterator[CorrectedRow]:
    """The corrected row of each printed torus with its series; those of HEAVY_ROWS only if full."""
    for printed, series in known.items():
        if printed.label in HEAVY_ROWS and not full:
            yield left_out(printed, "takes half a minute; computed with --full")
        else:
            yield corrected_row(printed, progress, series=series)


def corrected_row(
    printed: PrintedTorus,
    progress: Progress = unheard,
    *,
    series: LindstedtSeries | None = None,
) -> CorrectedRow:
    """The exact torus of the printed frequencies, and the errors of the series at every order.

    series : that of the printed order, if it is known already. progress : told of every step of
    Newton's method. A row that takes more than LIMIT seconds or does not converge has no torus,
    and says why.
    """
    tell = labelled(progress, f"corrected: {printed.label}")
    found, reason = _refined(printed, tell)
    if not found:
        return left_out(printed, reason)
    torus = found[-1]
    if series is None:
        tell("series", NO_FRACTION)
        series = lindstedt(printed.chain, printed.seeds, printed.frequencies, printed.order)
    deviations = {}
    for q, a in zip(printed.seeds, printed.amplitudes, strict=True):
        deviations[q] = float(a) / torus.amplitudes[q] - 1
    # where one refinement failed nothing says what is converged
    pair = (found[0], torus) if not reason else ()
    return CorrectedRow(
        printed=printed,
        torus=torus,
        reason=reason,
        digits=_common_digits([each.amplitudes for each in pair]),
        energy_digits=_common_digits([_energies(each) for each in pair]),
        deviations=deviations,
        energies=_energies(torus),
        residual=torus.residual(),
        errors=series_errors(series, torus, tell),
    )


def _common_digits(values: Sequence[Mapping[Any, float]]) -> int:
    """In which the values of two refinements agree, the worst of them; few without two."""
    if not values:
        return LEAST_DIGITS
    first, last = values
    change = max(abs(first[key] / value - 1) for key, value in last.items())
    return min(MOST_DIGITS, int(-np.log10(max(change, LEAST_CHANGE))))


def _energies(torus: Torus[Newton]) -> dict[str, float]:
    harmonic = torus.harmonic_energies().sum()
    average = torus.average_spectrum().sum()
    energies = {"H": float(torus.energy())}
    energies["harmonic energy at t = 0"] = float(harmonic)
    energies["harmonic energy, time average"] = float(average)
    return energies


def left_out(printed: PrintedTorus, reason: str) -> CorrectedRow:
    """A row that is not refined."""
    return CorrectedRow(printed, None, reason, 0, 0, {}, {}, np.nan, None)


def _refined(printed: PrintedTorus, tell: Progress) -> tuple[list[Torus[Newton]], str]:
    """Exact tori with ever more harmonics, and what went wrong."""
    started = time.monotonic()
    limit = HEAVY_LIMIT if printed.label in HEAVY_ROWS else LIMIT

    def timed(label: str, fraction: float) -> None:
        tell(label, fraction)
        if time.monotonic() - started > limit:
            raise TimeIsUp(limit, label)

    found, failed = _refinements(printed, timed)
    if not (found and failed):
        return found, failed
    reached = f"to a residual of {found[-1].residual():.0e} only"
    return found, f"{reached}: {failed}"


def _refinements(
    printed: PrintedTorus, progress: Progress
) -> tuple[list[Torus[Newton]], str]:
    """The tori of all tolerances until one fails, and how that one failed."""
    found: list[Torus[Newton]] = []
    try:
        tolerances, order = HEAVY_ROWS.get(printed.label, (TOLERANCES, GUESS_ORDER))
        guess = _guess(printed, order, progress)
        for tolerance in tolerances:
            start = found[-1] if found else guess
            torus = refine(start, tolerance=tolerance, progress=progress)
            if torus.warnings:
                return found, "; ".join(torus.warnings)
            found.append(torus)
    except SymfpuError as failure:
        return found, str(failure)
    return found, ""


def _guess(printed: PrintedTorus, order: int, tell: Progress) -> Torus:
    """Where Newton's method starts.

    A short series, or for one seed the periodic orbit, which needs none.
    """
    chain, seeds, rates = printed.chain, printed.seeds, printed.frequencies
    if len(seeds) == 1:
        tell("periodic orbit", NO_FRACTION)
        return breather_of_frequency(chain, seeds[0], rates[0])
    tell("short series", NO_FRACTION)
    series = lindstedt(chain, seeds, rates, min(order, printed.order))
    return solve_amplitudes(series)
