"""Data of Fig. 1(a) to (d): the 2-torus of N = 16, alpha = 0.33, seeds 1 and 2."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.paper.printed import (
    FIG1_AMPLITUDE_ORDER,
    FIG1_CANCELLATION_ORDER,
    FIG1_DIGITS,
    TWO_TORUS,
)
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import amplitude_history, solve_amplitudes
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment, assess

Floats = NDArray[np.float64]
LAST_TIME, LOOKS = 1000.0, 2001  # of the errors in time


@dataclass(frozen=True)
class Figure1:
    """Data of Fig. 1(a) to (d).

    assessment : verdict with amplitudes, sums and residuals by order. spectra, errors : by
    coordinate order, for the order of least residual and for the amplitudes' own order. spectra :
    time averages of E_q over the total energy. errors : relative errors in time (total,
    harmonic). rounding : largest relative error of the amplitudes of all orders if computed in
    doubles.
    """

    torus: Torus[FromSeries]
    assessment: Assessment
    spectra: dict[int, Floats]
    times: Floats
    errors: dict[int, tuple[Floats, Floats]]
    rounding: float

    @property
    def sums(self) -> tuple[Floats, Floats]:
        """mu^k S_1(k) and mu^k S_2(k) of mode 1."""
        return self.assessment.sums[1]

    @property
    def differences(self) -> Mapping[int, tuple[float, ...]]:
        """Delta A(k) of both seeds."""
        return self.assessment.differences

    @property
    def residuals(self) -> dict[int, float]:
        """Residual of the equations of motion by coordinate order."""
        return {k: float(r) for k, r in enumerate(self.assessment.residuals) if k >= 2}

    @property
    def best_order(self) -> int:
        """The coordinate order with the least residual of the equations of motion."""
        return self.assessment.best_order

    def claims(self) -> dict[str, str]:
        """What the paper's text says of Fig. 1, in our numbers; the keys are of FIG1_CLAIMS."""
        best, late = self.best_order, FIG1_AMPLITUDE_ORDER
        total, harmonic = self._largest_errors(best)
        late_total, late_harmonic = self._largest_errors(late)
        at_best, at_late = f"at order {best}", f"at order {late}"
        return {
            "best_difference": self._best_difference(),
            "cancellation": self._cancellation(),
            "term_size": self._term_size(),
            "harmonic_error": f"{harmonic:.1e} {at_best}, {late_harmonic:.1e} {at_late}",
            "energy_error": f"{total:.1e} {at_best}, {late_total:.1e} {at_late}",
        }

    def _best_difference(self) -> str:
        largest = {k: max(d) for k, d in self.differences.items()}
        least = min(largest, key=lambda k: largest[k])
        last = max(largest)
        return f"{largest[least]:.1e} at k = {least}; {largest[last]:.1e} at k = {last}"

    def _cancellation(self) -> str:
        k = FIG1_CANCELLATION_ORDER
        upper, lower = self.sums
        decades = np.log10(upper[k] / lower[k])
        return f"{decades:.1f} orders of magnitude at k = {k}"

    def _term_size(self) -> str:
        k = FIG1_CANCELLATION_ORDER
        size = self.sums[1][k]
        without_mu = size / self.torus.origin.series.chain.mu**k
        return f"{size:.1e} at k = {k} (with mu^k; {without_mu:.1e} without)"

    def _largest_errors(self, order: int) -> tuple[float, float]:
        """Of total and harmonic energy in time, at a coordinate order."""
        total, harmonic = self.errors[order]
        return float(np.abs(total).max()), float(np.abs(harmonic).max())


def figure1_data(progress: Progress = unheard) -> Figure1:
    """Compute the data of Fig. 1(a) to (d) from the printed frequencies, with FIG1_DIGITS digits.

    Doubles run beside them show what precision is needed: they lose no more than `rounding`.
    """
    chain, seeds, rates = TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies
    progress("fig1: series", NO_FRACTION)
    series = lindstedt(chain, seeds, rates, TWO_TORUS.order, digits=FIG1_DIGITS)
    torus = solve_amplitudes(series, frequency_order=FIG1_AMPLITUDE_ORDER)
    progress("fig1: verdict", NO_FRACTION)
    assessment = assess(series, torus)
    progress("fig1: doubles", NO_FRACTION)
    rounding = _rounding_of_doubles(torus)
    progress("fig1: errors in time", NO_FRACTION)
    times = np.linspace(0.0, LAST_TIME, LOOKS)
    spectra, errors = {}, {}
    for k in sorted({assessment.best_order, FIG1_AMPLITUDE_ORDER}):
        cut = torus.origin.cut_at(k).torus(torus.phases).in_doubles()
        spectra[k] = cut.average_spectrum() / cut.energy()
        total = cut.energy_error(times)
        errors[k] = (total, cut.energy_error(times, harmonic=True))
    return Figure1(torus, assessment, spectra, times, errors, rounding)


def _rounding_of_doubles(torus: Torus[FromSeries]) -> float:
    """Largest relative error of the amplitudes of all orders, computed in doubles."""
    chain, seeds, rates = TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies
    doubles = amplitude_history(lindstedt(chain, seeds, rates, TWO_TORUS.order))
    errors = []
    for k, amplitudes in torus.origin.history.items():
        pairs = zip(amplitudes, doubles.amplitudes[k], strict=True)
        errors += [abs(float(b / a - 1)) for a, b in pairs]
    return max(errors)
