"""What section 3.2 says of the 2-torus of Fig. 1, judged."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from symfpu.localization.floors import spectrum_floor
from symfpu.localization.laws import fit_profile
from symfpu.paper.claims import Claim, judged
from symfpu.paper.dimensions import FULL_TIME, FigureIndices, TorusForecast
from symfpu.paper.fig1_data import Figure1
from symfpu.paper.judgements import (
    SIZE_DECADES,
    cancellation_claim,
    dimension_claim,
    falls,
    foretold_claim,
)
from symfpu.paper.printed import (
    FIG1_AMPLITUDE_ORDER,
    FIG1_CANCELLATION_ORDER,
    FIG1_CLAIMS,
    TWO_TORUS,
)
from symfpu.paper.table import rounds_to
from symfpu.refinement.newton import Newton
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

LEAST_DIFFERENCES = (3e-9, 3e-7)  # "a minimum level of 1e-8 .. 1e-7", to a factor of three
LINE_SCATTER_DECADES = 0.5  # about a line that is one to the eye, over twenty decades
SIZE_FACTOR = 3.0  # within which a size is the printed power of ten
CANCELLATION_DECADES = 4.0  # "four orders of magnitude", "one part in 1e4"
TERM_SIZE = 1e-5
TOTAL_ERROR, HARMONIC_ERROR = 1e-4, 1e-2
SLOPE_ERRORS = 3  # by which the slope of a decay is below zero


def figure1_claims(
    data: Figure1, exact: Torus[Newton], seen: FigureIndices, forecast: TorusForecast
) -> tuple[Claim, ...]:
    """Claims on data of panels (a) to (d), the exact torus, and alignment indices of panel (e)."""
    cancellations = "cancellations by four orders of magnitude at k = 14"
    order = FIG1_CANCELLATION_ORDER
    return (
        amplitudes_claim(data.torus),
        settling_claim(data),
        convergence_claim(data, exact),
        cancellation_claim("3.2", cancellations, CANCELLATION_DECADES, data.sums, order),
        residual_terms_claim(data),
        parallel_claim(data),
        size_claim(data),
        energy_claim(data),
        errors_claim(data),
        localized_claim(exact),
        two_torus_claim(seen, forecast),
    )


def two_torus_claim(seen: FigureIndices, forecast: TorusForecast) -> Claim:
    """By what was integrated, where that is to the paper's time; else by what is foretold."""
    text = "G_2 stays constant to 1e9, G_3, G_4, G_5 fall as 1/t, 1/t^2, 1/t^3: "
    text += "a torus of dimension 2"
    if seen.there is None:
        return dimension_claim("3.2", text, 2, seen.found, whole=FULL_TIME)
    return foretold_claim("3.2", text, 2, forecast.frames(), seen)


def amplitudes_claim(torus: Torus[FromSeries]) -> Claim:
    """The printed amplitudes, and the orders at which they come out."""
    met = []
    for k, values in torus.origin.history.items():
        pairs = zip(values, TWO_TORUS.amplitudes, strict=True)
        if all(rounds_to(float(a), printed) for a, printed in pairs):
            met.append(k)
    amplitudes = [f"A_{q} = {float(a):.8f}" for q, a in torus.amplitudes.items()]
    orders = ", ".join(map(str, met)) or "none"
    ours = f"{', '.join(amplitudes)} at order {FIG1_AMPLITUDE_ORDER}; "
    ours += f"the printed digits at order {orders}"
    text = "the amplitudes of order 24 are A_1 = 0.5848897, A_2 = 0.4115552"
    printed = ", ".join(TWO_TORUS.amplitudes)
    verdict = judged(FIG1_AMPLITUDE_ORDER in met, bool(met))
    return Claim("3.2", text, printed, ours, verdict)


def settling_claim(data: Figure1) -> Claim:
    """At which order amplitudes change least, and by how much."""
    largest = {k: max(d) for k, d in data.differences.items()}
    order = min(largest, key=lambda k: largest[k])
    low, high = LEAST_DIFFERENCES
    level = low <= largest[order] <= high
    verdict = judged(level and order == FIG1_AMPLITUDE_ORDER, level)
    text = "the errors of A_1 and A_2 fall to 1e-8 .. 1e-7 at k = 24 and then rise slightly"
    ours = data.claims()["best_difference"]
    return Claim("3.2", text, FIG1_CLAIMS["best_difference"], ours, verdict)


def convergence_claim(data: Figure1, exact: Torus[Newton]) -> Claim:
    """The verdict on the series; that on the torus is another."""
    best = data.best_order
    last = max(data.residuals)
    ours = f"the series is {data.assessment.verdict} "
    ours += f"(residual {data.residuals[best]:.0e} there, "
    ours += f"{data.residuals[last]:.0e} at order {last}); "
    ours += f"the torus itself exists, found by Newton's method to {exact.residual():.0e}"
    text = "up to k = 24 the behaviour of the series appears as convergent"
    return Claim("3.2", text, "", ours, judged(data.assessment.word == "converged"))


def residual_terms_claim(data: Figure1) -> Claim:
    """Terms of increasing size leave a residual that decreases."""
    upper, lower = data.sums
    k = FIG1_CANCELLATION_ORDER
    last = len(lower) - 1
    grows = bool(upper[k] > upper[2])
    least = int(np.argmin(lower[1:])) + 1
    ours = f"S_1 goes from {upper[2]:.0e} at k = 2 to {upper[k]:.0e} at k = {k}; "
    ours += f"S_2 from {lower[2]:.0e} to {lower[k]:.0e}, "
    ours += f"is least at k = {least} and {lower[-1]:.0e} at k = {last}"
    text = (
        "a near-cancellation of terms of increasing size leaves a residual that decreases "
    )
    text += "as k increases"
    verdict = judged(grows and falls(lower, last), grows and least >= k)
    return Claim("3.2", text, "", ours, verdict)


def parallel_claim(data: Figure1) -> Claim:
    """Beyond order 14: no better cancellation, and curves that keep their distance."""
    upper, lower = data.sums
    first = FIG1_CANCELLATION_ORDER
    decades = np.log10(upper[first::2] / lower[first::2])
    most = decades.max()
    drift = float(most - decades.min())
    ours = f"log10 S_1/S_2 of the even orders from {first} on: "
    ours += f"at most {most:.2f}, in the end {decades[-1]:.2f}"
    text = "beyond k = 14 no cancellation is better than one part in 1e4, "
    text += "and both curves rise in parallel"
    no_better = bool(most <= CANCELLATION_DECADES)
    verdict = judged(no_better and drift <= SIZE_DECADES, no_better)
    return Claim("3.2", text, "1e4", ours, verdict)


def size_claim(data: Figure1) -> Claim:
    """The size of the terms of one order."""
    size = float(data.sums[1][FIG1_CANCELLATION_ORDER])
    verdict = judged(_near(size, TERM_SIZE), 0.1 <= size / TERM_SIZE <= 10)
    text = "the terms of Q_1^(14) are about 1e-5"
    ours = data.claims()["term_size"]
    return Claim("3.2", text, FIG1_CLAIMS["term_size"], ours, verdict)


def energy_claim(data: Figure1) -> Claim:
    """The energy at the best order, and at the last one."""
    met = []
    parts = []
    for k in dict.fromkeys((data.best_order, data.torus.origin.order)):
        value = float(data.torus.origin.cut_at(k).torus().energy())
        met.append(rounds_to(value, TWO_TORUS.energy))
        parts.append(f"H = {value:.6f} with coordinates of order {k}")
    text = "the solution has the total energy E = 0.02345"
    verdict = judged(all(met), any(met))
    return Claim("3.2", text, TWO_TORUS.energy, ", ".join(parts), verdict)


def errors_claim(data: Figure1) -> Claim:
    """Fluctuations of both energies, at the order of the text and at the best one."""
    as_printed = []
    for order in (FIG1_AMPLITUDE_ORDER, data.best_order):
        total, harmonic = (float(np.abs(e).max()) for e in data.errors[order])
        near_total = _near(total, TOTAL_ERROR)
        as_printed.append(near_total and _near(harmonic, HARMONIC_ERROR))
    claims = data.claims()
    ours = f"H: {claims['energy_error']}; harmonic energy: {claims['harmonic_error']}"
    text = "along the series H fluctuates by 1e-4, the harmonic energy by 1e-2"
    return Claim("3.2", text, "1e-4, 1e-2", ours, judged(*as_printed))


def _near(value: float, printed: float) -> bool:
    return printed / SIZE_FACTOR <= value <= SIZE_FACTOR * printed


def localized_claim(
    exact: Torus[Newton], floor_of: Callable[[Torus[Newton]], Any] = spectrum_floor
) -> Claim:
    """Exponential decay beyond the seeds."""
    spectrum = np.asarray(exact.average_spectrum(), dtype=float)
    floor = floor_of(exact)
    fit = fit_profile(exact.chain, spectrum, len(exact.seeds), floor=floor)
    decays = -fit.line.slope > SLOPE_ERRORS * fit.errors[0]
    verdict = judged(decays and fit.scatter < LINE_SCATTER_DECADES)
    text = "the energies E_q fall exponentially with q"
    return Claim("3.2", text, "", f"{fit!r} (exact torus)", verdict)
