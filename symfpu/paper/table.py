"""The paper's numbers (Eq. Table1) computed anew, beside the printed ones.

They follow from the printed frequencies.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from decimal import Decimal

import numpy as np

from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS, PrintedTorus
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import AmplitudeHistory, amplitude_history, solve_amplitudes
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

# agreement, in digits of the worst amplitude, from which a printed row counts as met
MET_DIGITS = 8.5
DOUBLE_DIGITS = 16.0


@dataclass(frozen=True)
class AmplitudeRow:
    """One printed torus beside ours.

    digits : frequency order -> digits of agreement of the worst amplitude, -log10 |ours / printed
    - 1|.
    met : orders at which the printed amplitudes are met: to every printed digit, or to MET_DIGITS
    digits.
    torus : ours at the best of those orders (the whole series if none), with the paper's
    coordinate order.
    energies : name -> value, for H at t = 0, harmonic energy at t = 0 and its time average.
    energy_matches : the names whose value rounds to the printed energy. energy_orders : if none
    does, name -> other coordinate orders at which it would.
    """

    printed: PrintedTorus
    series: LindstedtSeries = field(repr=False)
    history: AmplitudeHistory = field(repr=False)
    digits: dict[int, float]
    met: tuple[int, ...]
    torus: Torus[FromSeries]
    energies: dict[str, float]
    energy_matches: tuple[str, ...]
    energy_orders: dict[str, tuple[int, ...]]
    residual: float

    @property
    def best(self) -> int:
        """The frequency order that comes nearest to the printed amplitudes."""
        return max(self.digits, key=lambda k: self.digits[k])

    @property
    def verdict(self) -> str:
        """What the comparison says, in a sentence."""
        doubts = "".join(f"; {warning}" for warning in self.torus.warnings)
        return f"{self._amplitudes_verdict()}; {self._energy_verdict()}{doubts}"

    def _amplitudes_verdict(self) -> str:
        best = self.best
        digits = f"{self.digits[best]:.1f} digits"
        if not self.met:
            nearest = f"nearest is {best}, {digits}"
            return f"amplitudes met at no frequency order ({nearest}): unexplained"
        others = [str(k) for k in self.met if k != best]
        also = f" (also at {', '.join(others)})" if others else ""
        return f"amplitudes met at frequency order {best} to {digits}{also}"

    def _energy_verdict(self) -> str:
        if self.energy_matches:
            return f"printed E is {' and '.join(self.energy_matches)}"
        if not self.energy_orders:
            return f"printed E = {self.printed.energy} is none of ours: unexplained"
        cuts = []
        for name, orders in self.energy_orders.items():
            numbers = ", ".join(map(str, orders))
            cuts.append(f"{name} of coordinate orders {numbers}")
        order = self.printed.order
        return (
            f"printed E is not that of the printed order {order}, but {' and '.join(cuts)}"
        )


def agreement_digits(ours: tuple[float, ...], printed: tuple[str, ...]) -> float:
    """Digits to which the worst of several numbers agrees; at most 16, the digits of a double."""
    ratios = [Decimal(a) / Decimal(p) for a, p in zip(ours, printed, strict=True)]
    worst = max(abs(float(ratio - 1)) for ratio in ratios)
    return DOUBLE_DIGITS if worst < 1e-16 else float(-np.log10(worst))


def rounds_to(ours: float, printed: str) -> bool:
    """Whether a number differs from a printed one by at most half a unit of its last digit."""
    exponent = Decimal(printed).as_tuple().exponent
    assert isinstance(exponent, int)
    unit = Decimal(1).scaleb(exponent)
    return abs(Decimal(ours) - Decimal(printed)) <= unit / 2


def amplitude_row(printed: PrintedTorus) -> AmplitudeRow:
    """One printed torus from its frequencies alone.

    Series, amplitudes at every frequency order, and energies.
    """
    series = lindstedt(printed.chain, printed.seeds, printed.frequencies, printed.order)
    history = amplitude_history(series)
    digits = {
        k: agreement_digits(a, printed.amplitudes) for k, a in history.amplitudes.items()
    }
    met = _met_orders(printed, history, digits)
    chosen = max(met, key=lambda k: digits[k]) if met else None
    torus = solve_amplitudes(series, frequency_order=chosen)
    values = energies(torus)
    matches = tuple(
        name for name, value in values.items() if rounds_to(value, printed.energy)
    )
    other = {} if matches else _energy_orders(torus, printed.energy)
    return AmplitudeRow(
        printed,
        series,
        history,
        digits,
        met,
        torus,
        values,
        matches,
        other,
        torus.residual(),
    )


def _met_orders(
    printed: PrintedTorus, history: AmplitudeHistory, digits: dict[int, float]
) -> tuple[int, ...]:
    """Orders at which the printed amplitudes are met."""
    met = []
    for k, values in history.amplitudes.items():
        pairs = zip(values, printed.amplitudes, strict=True)
        if digits[k] >= MET_DIGITS or all(rounds_to(a, p) for a, p in pairs):
            met.append(k)
    return tuple(met)


def energies(torus: Torus[FromSeries]) -> dict[str, float]:
    """What a paper may mean by "energy", by name."""
    return {
        "H(0)": float(torus.energy()),
        "harmonic energy at t = 0": float(torus.harmonic_energies().sum()),
        "harmonic energy, time average": float(torus.average_spectrum().sum()),
    }


def _energy_orders(torus: Torus[FromSeries], printed: str) -> dict[str, tuple[int, ...]]:
    found: dict[str, tuple[int, ...]] = {}
    for order in range(1, torus.origin.series.order + 1):
        cut = torus.origin.cut_at(order).torus(torus.phases)
        for name, value in energies(cut).items():
            if rounds_to(value, printed):
                found[name] = (*found.get(name, ()), order)
    return found


def amplitude_table(progress: Progress = unheard) -> Iterator[AmplitudeRow]:
    """Every torus of Appendix F (Eq. Table1) and the pair of Fig. 1; `step` is told of each one."""
    for printed in (TWO_TORUS, *APPENDIX_F):
        progress(f"table: {printed.label}", NO_FRACTION)
        yield amplitude_row(printed)
