"""The paper's numbers computed anew from the printed frequencies, beside the printed ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from decimal import Decimal

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.propagation import excitation_sequence
from symfpu.paper.printed import (
    APPENDIX_F,
    FIG1_AMPLITUDE_ORDER,
    FIG1_CANCELLATION_ORDER,
    FIG1_DIGITS,
    FIG6_CHAIN,
    FIG6_WIDTH,
    TWO_TORUS,
    PrintedTorus,
)
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import AmplitudeHistory, amplitude_history, solve_amplitudes
from symfpu.tori.torus import QTorus
from symfpu.tori.verdict import Assessment, assess

Floats = NDArray[np.float64]
Step = Callable[[str], None]

MET_DIGITS = 8.5  # agreement, in digits of the worst amplitude, from which a printed row counts as met


@dataclass(frozen=True)
class AmplitudeRow:
    """One printed torus beside ours.

    digits : frequency order -> digits of agreement of the worst amplitude, -log10 |ours / printed - 1|.
    met : orders at which the printed amplitudes are met: to every printed digit, or to MET_DIGITS digits.
    torus : ours at the best of those orders (the whole series if none), with the paper's coordinate order.
    energies : name -> value, for H at t = 0, harmonic energy at t = 0 and its time average.
    energy_matches : the names whose value rounds to the printed energy. energy_orders : if none does, name -> other
    coordinate orders at which it would.
    """

    printed: PrintedTorus
    series: LindstedtSeries = field(repr=False)
    history: AmplitudeHistory = field(repr=False)
    digits: dict[int, float]
    met: tuple[int, ...]
    torus: QTorus
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
        if self.met:
            amplitudes = f"amplitudes met at frequency order {self.best} to {self.digits[self.best]:.1f} digits"
            others = [k for k in self.met if k != self.best]
            amplitudes += f" (also at {', '.join(map(str, others))})" if others else ""
        else:
            nearest = f"nearest is {self.best}, {self.digits[self.best]:.1f} digits"
            amplitudes = f"amplitudes met at no frequency order ({nearest}): unexplained"
        if self.energy_matches:
            energy = f"printed E is {' and '.join(self.energy_matches)}"
        elif self.energy_orders:
            cuts = [f"{name} of coordinate orders {', '.join(map(str, orders))}" for name, orders in self.energy_orders.items()]
            energy = f"printed E is not that of the printed order {self.printed.order}, but {' and '.join(cuts)}"
        else:
            energy = f"printed E = {self.printed.energy} is none of ours: unexplained"
        doubts = "".join(f"; {warning}" for warning in self.torus.warnings)
        return f"{amplitudes}; {energy}{doubts}"


def agreement_digits(ours: tuple[float, ...], printed: tuple[str, ...]) -> float:
    """Digits to which the worst of several numbers agrees; at most 16, the digits of a double."""
    worst = max(abs(float(Decimal(a) / Decimal(p) - 1)) for a, p in zip(ours, printed, strict=True))
    return 16.0 if worst < 1e-16 else float(-np.log10(worst))


def rounds_to(ours: float, printed: str) -> bool:
    """Whether a number differs from a printed one by at most half a unit of its last digit."""
    exponent = Decimal(printed).as_tuple().exponent
    assert isinstance(exponent, int)
    return abs(Decimal(ours) - Decimal(printed)) <= Decimal(1).scaleb(exponent) / 2


def amplitude_row(printed: PrintedTorus) -> AmplitudeRow:
    """Series, amplitudes at every frequency order, and energies of one printed torus, from its frequencies alone."""
    series = lindstedt(printed.chain, printed.seeds, printed.frequencies, printed.order)
    history = amplitude_history(series)
    digits = {k: agreement_digits(a, printed.amplitudes) for k, a in history.amplitudes.items()}
    met = tuple(
        k
        for k, values in history.amplitudes.items()
        if digits[k] >= MET_DIGITS or all(rounds_to(a, p) for a, p in zip(values, printed.amplitudes, strict=True))
    )
    chosen = max(met, key=lambda k: digits[k]) if met else None
    torus = solve_amplitudes(series, frequency_order=chosen)
    values = energies(torus)
    matches = tuple(name for name, value in values.items() if rounds_to(value, printed.energy))
    other = {} if matches else _energy_orders(torus, printed.energy)
    return AmplitudeRow(printed, series, history, digits, met, torus, values, matches, other, torus.residual())


def energies(torus: QTorus) -> dict[str, float]:
    """What a paper may mean by "energy", by name."""
    return {
        "H(0)": float(torus.energy()),
        "harmonic energy at t = 0": float(torus.harmonic_energies().sum()),
        "harmonic energy, time average": float(torus.average_spectrum().sum()),
    }


def _energy_orders(torus: QTorus, printed: str) -> dict[str, tuple[int, ...]]:
    found: dict[str, tuple[int, ...]] = {}
    for order in range(1, torus.series.order + 1):
        for name, value in energies(replace(torus, order=order)).items():
            if rounds_to(value, printed):
                found[name] = (*found.get(name, ()), order)
    return found


def amplitude_table(step: Step = lambda label: None) -> Iterator[AmplitudeRow]:
    """Every torus of Appendix F and the pair of Fig. 1; `step` is told which one comes next."""
    for printed in (TWO_TORUS, *APPENDIX_F):
        step(f"table: {printed.label}")
        yield amplitude_row(printed)


@dataclass(frozen=True)
class Figure6:
    """Order at which each mode is first excited by packets around N/4, N/2, 3N/4 (alpha); seeds and orders by panel."""

    N: int
    panels: dict[str, tuple[tuple[int, ...], dict[int, int]]]


def figure6() -> Figure6:
    """Compute the data of Fig. 6: packets of half-width FIG6_WIDTH modes, up to the order that excites every mode."""
    N, w = FIG6_CHAIN, FIG6_WIDTH
    panels = {}
    for panel, quarter in zip("abc", (1, 2, 3), strict=True):
        seeds = tuple(range(quarter * N // 4 - w, quarter * N // 4 + w + 1))
        sequence = excitation_sequence(N, seeds, N // w)
        panels[panel] = (seeds, {q: k for k, modes in enumerate(sequence) for q in modes})
    return Figure6(N, panels)


@dataclass(frozen=True)
class Figure1:
    """Data of Fig. 1 (a) to (d): the 2-torus of N = 16, alpha = 0.33, seeds 1 and 2.

    assessment : verdict with amplitudes, sums and residuals by order. spectra, errors : by coordinate order, for the order of
    least residual and for the amplitudes' own order. spectra : time averages of E_q over the total energy. errors : relative
    errors in time (total, harmonic). rounding : largest relative error of the amplitudes of all orders if computed in doubles.
    """

    torus: QTorus
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
        """What the paper's text says of Fig. 1, in our numbers; the keys are those of paper.FIG1_CLAIMS."""
        largest = {k: max(d) for k, d in self.differences.items()}
        least = min(largest, key=lambda k: largest[k])
        k = FIG1_CANCELLATION_ORDER
        total, harmonic = (float(np.abs(e).max()) for e in self.errors[self.best_order])
        late_total, late_harmonic = (float(np.abs(e).max()) for e in self.errors[FIG1_AMPLITUDE_ORDER])
        return {
            "best_difference": f"{largest[least]:.1e} at k = {least}; {largest[max(largest)]:.1e} at k = {max(largest)}",
            "cancellation": f"{np.log10(self.sums[0][k] / self.sums[1][k]):.1f} orders of magnitude at k = {k}",
            "term_size": f"{self.sums[1][k]:.1e} at k = {k} (with mu^k; {self.sums[1][k] / self._mu**k:.1e} without)",
            "harmonic_error": f"{harmonic:.1e} at order {self.best_order}, {late_harmonic:.1e} at order {FIG1_AMPLITUDE_ORDER}",
            "energy_error": f"{total:.1e} at order {self.best_order}, {late_total:.1e} at order {FIG1_AMPLITUDE_ORDER}",
        }

    @property
    def _mu(self) -> float:
        return self.torus.series.chain.mu


def figure1(step: Step = lambda label: None) -> Figure1:
    """Compute the data of Fig. 1 (a) to (d) from the printed frequencies, with FIG1_DIGITS digits.

    Doubles run beside them show what precision is needed: they lose no more than `rounding`.
    """
    step("fig1: series")
    printed = TWO_TORUS
    series = lindstedt(printed.chain, printed.seeds, printed.frequencies, printed.order, digits=FIG1_DIGITS)
    torus = solve_amplitudes(series, frequency_order=FIG1_AMPLITUDE_ORDER)
    step("fig1: verdict")
    assessment = assess(series, torus)
    step("fig1: doubles")
    doubles = amplitude_history(lindstedt(printed.chain, printed.seeds, printed.frequencies, printed.order)).amplitudes
    pairs = [(a, b) for k, row in torus.history.items() for a, b in zip(row, doubles[k], strict=True)]
    step("fig1: errors in time")
    shown = sorted({assessment.best_order, FIG1_AMPLITUDE_ORDER})
    tori = {k: replace(torus, order=k).in_doubles() for k in shown}
    times = np.linspace(0.0, 1000.0, 2001)
    return Figure1(
        torus=torus,
        assessment=assessment,
        spectra={k: t.average_spectrum() / t.energy() for k, t in tori.items()},
        times=times,
        errors={k: (t.energy_error(times), t.energy_error(times, harmonic=True)) for k, t in tori.items()},
        rounding=max(abs(float(b / a - 1)) for a, b in pairs),
    )
