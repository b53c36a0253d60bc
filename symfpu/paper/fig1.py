"""Fig. 1: what the paper says of its 2-torus, judged; and its alignment indices, Fig. 1(e)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.figures.alignment import alignment_panel
from symfpu.localization.floors import spectrum_floor
from symfpu.localization.laws import fit_profile
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.dimensions import FULL_TIME, indices
from symfpu.paper.judgements import NEAR, cancellation_claim, dimension_claim, falls
from symfpu.paper.printed import (
    FIG1_AMPLITUDE_ORDER,
    FIG1_CANCELLATION_ORDER,
    FIG1_CLAIMS,
    FIG1_DIGITS,
    TWO_TORUS,
)
from symfpu.paper.steps import Step, unheard
from symfpu.paper.table import rounds_to
from symfpu.refinement.tori import RefinedTorus, refine
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import amplitude_history, solve_amplitudes
from symfpu.tori.torus import QTorus
from symfpu.tori.verdict import Assessment, assess

Floats = NDArray[np.float64]
SETTLED = (3e-9, 3e-7)  # "a minimum level of 1e-8 .. 1e-7", to a factor of three
LINEAR = 0.5  # decades of scatter about a line that is one to the eye, over twenty decades
TIMES = 3.0  # factor within which a size is the printed power of ten


def figure1_claims(data: Figure1, folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """Claims of section 3.2 on the 2-torus, and panel (e). data : of panels (a) to (d)."""
    torus = data.torus
    exact = refine(torus, report=lambda line: step(f"fig1: exact torus: {line}"))
    start = (
        np.asarray(torus.positions(0.0), dtype=float),
        np.asarray(torus.momenta(0.0), dtype=float),
    )
    found = indices("fig1", start, step, folder, full=full)
    dimension = (
        "G_2 stays constant to 1e9, G_3, G_4, G_5 fall as 1/t, 1/t^2, 1/t^3: a torus of dimension 2"
    )
    claims = (
        _amplitudes(torus),
        _settling(data),
        _convergence(data, exact),
        cancellation_claim(
            "3.2",
            "cancellations by four orders of magnitude at k = 14",
            4.0,
            data.sums,
            FIG1_CANCELLATION_ORDER,
        ),
        _residual_terms(data),
        _parallel(data),
        _sizes(data),
        _energy(data),
        _errors(data),
        _localized(exact),
        dimension_claim("3.2", dimension, 2, found, whole=FULL_TIME),
    )
    panels = (
        alignment_panel(
            "fig1e", "Fig. 1(e): alignment indices of the orbit from the series", found
        ),
    )
    return PaperFigure("fig1", "Fig. 1: what the text says of it", panels, claims)


def _amplitudes(torus: QTorus) -> Claim:
    met = [
        k
        for k, values in torus.history.items()
        if all(
            rounds_to(float(a), printed)
            for a, printed in zip(values, TWO_TORUS.amplitudes, strict=True)
        )
    ]
    ours = ", ".join(f"A_{q} = {float(a):.8f}" for q, a in torus.amplitudes.items())
    ours += f" at order {FIG1_AMPLITUDE_ORDER}; the printed digits at order {', '.join(map(str, met)) or 'none'}"
    text = "the amplitudes of order 24 are A_1 = 0.5848897, A_2 = 0.4115552"
    return Claim(
        "3.2",
        text,
        ", ".join(TWO_TORUS.amplitudes),
        ours,
        judged(FIG1_AMPLITUDE_ORDER in met, bool(met)),
    )


def _settling(data: Figure1) -> Claim:
    largest = {k: max(d) for k, d in data.differences.items()}
    order = min(largest, key=lambda k: largest[k])
    level = SETTLED[0] <= largest[order] <= SETTLED[1]
    text = "the errors of A_1 and A_2 fall to 1e-8 .. 1e-7 at k = 24 and then rise slightly"
    verdict = judged(level and order == FIG1_AMPLITUDE_ORDER, level)
    return Claim(
        "3.2", text, FIG1_CLAIMS["best_difference"], data.claims()["best_difference"], verdict
    )


def _convergence(data: Figure1, exact: RefinedTorus) -> Claim:
    best, last = data.best_order, max(data.residuals)
    ours = (
        f"the series is {data.assessment.headline} (residual {data.residuals[best]:.0e} there, "
        f"{data.residuals[last]:.0e} at order {last}); "
        f"the torus itself exists, found by Newton's method to {exact.residual():.0e}"
    )
    text = "up to k = 24 the behaviour of the series appears as convergent"
    return Claim("3.2", text, "", ours, judged(data.assessment.word == "converged"))


def _residual_terms(data: Figure1) -> Claim:
    """Terms of increasing size leave a residual that decreases."""
    upper, lower = data.sums
    k = FIG1_CANCELLATION_ORDER
    grows, least = bool(upper[k] > upper[2]), int(np.argmin(lower[1:])) + 1
    ours = (
        f"S_1 goes from {upper[2]:.0e} at k = 2 to {upper[k]:.0e} at k = {k}; S_2 from {lower[2]:.0e} to {lower[k]:.0e}, is least at k = "
        f"{least} and {lower[-1]:.0e} at k = {len(lower) - 1}"
    )
    text = "a near-cancellation of terms of increasing size leaves a residual that decreases as k increases"
    return Claim(
        "3.2", text, "", ours, judged(grows and falls(lower, len(lower) - 1), grows and least >= k)
    )


def _parallel(data: Figure1) -> Claim:
    """Beyond order 14: no better cancellation, and curves that keep their distance."""
    decades = np.log10(
        data.sums[0][FIG1_CANCELLATION_ORDER::2] / data.sums[1][FIG1_CANCELLATION_ORDER::2]
    )
    drift = float(decades.max() - decades.min())
    ours = f"log10 S_1/S_2 of the even orders from {FIG1_CANCELLATION_ORDER} on: at most {decades.max():.2f}, in the end {decades[-1]:.2f}"
    text = "beyond k = 14 no cancellation is better than one part in 1e4, and both curves rise in parallel"
    return Claim(
        "3.2",
        text,
        "1e4",
        ours,
        judged(bool(decades.max() <= 4.0 and drift <= NEAR), bool(decades.max() <= 4.0)),
    )


def _sizes(data: Figure1) -> Claim:
    size = float(data.sums[1][FIG1_CANCELLATION_ORDER])
    verdict = judged(_near(size, 1e-5), 0.1 <= size / 1e-5 <= 10)
    return Claim(
        "3.2",
        "the terms of Q_1^(14) are about 1e-5",
        FIG1_CLAIMS["term_size"],
        data.claims()["term_size"],
        verdict,
    )


def _energy(data: Figure1) -> Claim:
    values = {
        k: float(replace(data.torus, order=k).energy()) for k in (data.best_order, data.torus.order)
    }
    met = [rounds_to(value, TWO_TORUS.energy) for value in values.values()]
    ours = ", ".join(
        f"H = {value:.6f} with coordinates of order {k}" for k, value in values.items()
    )
    return Claim(
        "3.2",
        "the solution has the total energy E = 0.02345",
        TWO_TORUS.energy,
        ours,
        judged(all(met), any(met)),
    )


def _errors(data: Figure1) -> Claim:
    """Fluctuations of both energies, at the order of the text and at the best one."""
    pairs = [
        [float(np.abs(e).max()) for e in data.errors[k]]
        for k in (FIG1_AMPLITUDE_ORDER, data.best_order)
    ]
    claims = data.claims()
    ours = f"H: {claims['energy_error']}; harmonic energy: {claims['harmonic_error']}"
    text = "along the series H fluctuates by 1e-4, the harmonic energy by 1e-2"
    late, early = (_near(total, 1e-4) and _near(harmonic, 1e-2) for total, harmonic in pairs)
    return Claim("3.2", text, "1e-4, 1e-2", ours, judged(late, early))


def _near(value: float, printed: float) -> bool:
    return printed / TIMES <= value <= TIMES * printed


def _localized(exact: RefinedTorus) -> Claim:
    spectrum = np.asarray(exact.average_spectrum(), dtype=float)
    fit = fit_profile(exact.chain, spectrum, len(exact.seeds), floor=spectrum_floor(exact))
    holds = -fit.line.slope > 3 * fit.errors[0] and fit.scatter < LINEAR
    return Claim(
        "3.2",
        "the energies E_q fall exponentially with q",
        "",
        f"{fit!r} (exact torus)",
        judged(holds),
    )


@dataclass(frozen=True)
class Figure1:
    """Data of Fig. 1 (a) to (d): the 2-torus of N = 16, alpha = 0.33, seeds 1 and 2.

    assessment : verdict with amplitudes, sums and residuals by order. spectra, errors : by
    coordinate order, for the order of least residual and for the amplitudes' own order. spectra :
    time averages of E_q over the total energy. errors : relative errors in time (total,
    harmonic). rounding : largest relative error of the amplitudes of all orders if computed in
    doubles.
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
        """What the paper's text says of Fig.

        1, in our numbers; the keys are those of paper.FIG1_CLAIMS.
        """
        largest = {k: max(d) for k, d in self.differences.items()}
        least = min(largest, key=lambda k: largest[k])
        k = FIG1_CANCELLATION_ORDER
        total, harmonic = (float(np.abs(e).max()) for e in self.errors[self.best_order])
        late_total, late_harmonic = (
            float(np.abs(e).max()) for e in self.errors[FIG1_AMPLITUDE_ORDER]
        )
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


def figure1(step: Step = unheard) -> Figure1:
    """Compute the data of Fig. 1 (a) to (d) from the printed frequencies, with FIG1_DIGITS digits.

    Doubles run beside them show what precision is needed: they lose no more than `rounding`.
    """
    step("fig1: series")
    printed = TWO_TORUS
    series = lindstedt(
        printed.chain, printed.seeds, printed.frequencies, printed.order, digits=FIG1_DIGITS
    )
    torus = solve_amplitudes(series, frequency_order=FIG1_AMPLITUDE_ORDER)
    step("fig1: verdict")
    assessment = assess(series, torus)
    step("fig1: doubles")
    doubles = amplitude_history(
        lindstedt(printed.chain, printed.seeds, printed.frequencies, printed.order)
    ).amplitudes
    pairs = [
        (a, b) for k, row in torus.history.items() for a, b in zip(row, doubles[k], strict=True)
    ]
    step("fig1: errors in time")
    shown = sorted({assessment.best_order, FIG1_AMPLITUDE_ORDER})
    tori = {k: replace(torus, order=k).in_doubles() for k in shown}
    times = np.linspace(0.0, 1000.0, 2001)
    return Figure1(
        torus=torus,
        assessment=assessment,
        spectra={k: t.average_spectrum() / t.energy() for k, t in tori.items()},
        times=times,
        errors={
            k: (t.energy_error(times), t.energy_error(times, harmonic=True))
            for k, t in tori.items()
        },
        rounding=max(abs(float(b / a - 1)) for a, b in pairs),
    )
