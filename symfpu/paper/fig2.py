"""Fig. 2: the 4-torus of the lowest modes, its alignment indices, its cancellations.

The claims are those of section 4.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.foretold import ForetoldIndices
from symfpu.dynamics.orbits import Orbit
from symfpu.figures.panels import Curve, Panel
from symfpu.files.progress import NO_FRACTION, Progress, labelled
from symfpu.localization.floors import spectrum_floor
from symfpu.localization.laws import fit_profile, middle_modes
from symfpu.localization.profiles import normalised_averages
from symfpu.paper.captions import caption_claim, caption_curve, law_of, printed_line
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.dimensions import (
    VECTORS,
    FigureIndices,
    TorusForecast,
    figure_alignment,
    indices_panel,
)
from symfpu.paper.judgements import (
    SIMILAR_DECADES,
    cancellation_claim,
    falls,
    foretold_claim,
    same_profile,
    sums_panel,
)
from symfpu.paper.printed import PrintedLine
from symfpu.paper.starts import (
    integrated_orbit,
    normalised_floor,
    printed_row,
    printed_torus,
    profile_panel,
)
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import refine
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
TIME = 1e6  # the paper's
IDENTICAL_SHARE = 1e-3  # of the largest coordinate: a picture cannot tell orbits apart
PLATEAU = 3e7  # the time of stabilization of G_4, after which G_5 falls
# of the equations of motion, that no truncated series of this torus has
EXACT_RESIDUAL = 1e-10
CANCELLATION_DECADES = 2.0
SLOPE_ERRORS = 3  # by which the slope of a decay is below zero


def figure2(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """The 4-torus of N = 32: its spectrum three ways, its alignment indices, its sums."""
    row = printed_row("Fig. 2")
    progress("fig2: series", NO_FRACTION)
    torus = printed_torus(row)
    exact = refine(torus, progress=labelled(progress, "fig2: exact torus"))
    orbit = integrated_orbit("fig2 PLn", row.chain, torus, TIME, progress)
    start = (torus.Q(0.0), torus.P(0.0))
    progress("fig2: indices foretold", NO_FRACTION)
    forecast = TorusForecast(exact, VECTORS["fig2"][1])
    frames = forecast.frames()
    seen = figure_alignment("fig2", start, progress, folder, forecast, full=full)
    profiles = {
        "PL": torus.average_spectrum() / torus.energy(),
        "PLn": normalised_averages(orbit)[-1],
        "exact torus": exact.average_spectrum() / exact.energy(),
    }
    floors = {"PL": normalised_floor(torus), "exact torus": normalised_floor(exact)}
    line = printed_line("Fig. 2a")
    amplitudes = list(torus.amplitudes.values())
    sums = torus.origin.series.absolute_sums(1, amplitudes, with_mu=True)
    title = "Fig. 2: the 4-torus of N = 32, seeds 1 to 4"
    claims = (
        *_profile_claims(profiles),
        identical_claim(torus, orbit),
        exponential_claim(exact),
        _caption_claim(line, torus),
        line_claim(line, profiles["exact torus"]),
        _dimension_claim(seen, frames),
        *_sums_claims(sums, row.order),
        root_finding_claim(exact),
    )
    panels = (_profile_panel(line, profiles, floors), *_other_panels(seen, sums))
    return PaperFigure("fig2", title, panels, claims)


def _profile_panel(
    line: PrintedLine, profiles: dict[str, Floats], floors: dict[str, Floats]
) -> Panel:
    """Spectra with the line of the caption and the law it is said to be."""
    (chain,) = line.chains
    kappa = np.arange(1.0, chain.N) / chain.N
    law = law_of(line, chain)
    laws = (caption_curve(line, kappa), Curve("Eq. eksa2", kappa, 10 ** law(kappa)))
    title = "Fig. 2(a): the 4-torus, average spectrum"
    return profile_panel("fig2a", title, chain, profiles, *laws, floors=floors)


def _other_panels(seen: FigureIndices, sums: tuple[Floats, Floats]) -> tuple[Panel, Panel]:
    """Alignment indices; sums of the terms."""
    indices = "Fig. 2(b): alignment indices of PLn"
    cancellations = "Fig. 2(c): cancellations in the series of mode 1"
    return (
        indices_panel("fig2b", indices, seen),
        sums_panel("fig2c", cancellations, 1, sums),
    )


def _profile_claims(profiles: dict[str, Floats]) -> tuple[Claim, Claim]:
    same = "PL and PLn have no distinguishable difference in their profiles"
    shown = "the truncated series shows the profile of a q-torus"
    return (
        same_profile("4", same, profiles, "PL", "PLn"),
        same_profile("4", shown, profiles, "PL", "exact torus"),
    )


def identical_claim(torus: Torus[FromSeries], orbit: Orbit) -> Claim:
    """How far the integrated orbit leaves the series, and from when on."""
    times = orbit.times
    there = torus.Q(times)
    apart = np.max(np.abs(orbit.Q - there), axis=1)
    off = apart / np.max(np.abs(there))
    late = times[off > IDENTICAL_SHARE]
    ours = f"they part by {off[1]:.0e} of the largest coordinate at t = {times[1]:.2g}, "
    ours += f"{off[-1]:.1e} at t = {times[-1]:.0e}"
    if late.size:
        ours += f", more than {IDENTICAL_SHARE:g} from t = {late[0]:.1e} on"
    text = "the solutions themselves, PL(t) and PLn(t), are almost identical"
    for_long = bool(late.size and late[0] > times[-1] / 10)
    return Claim("4, note", text, "", ours, judged(not late.size, for_long))


def exponential_claim(
    exact: Torus[Newton], floor_of: Callable[[Torus[Newton]], Any] = spectrum_floor
) -> Claim:
    """A straight line beyond the seeds."""
    spectrum = np.asarray(exact.average_spectrum(), dtype=float)
    floor = floor_of(exact)
    fit = fit_profile(exact.chain, spectrum, len(exact.seeds), floor=floor)
    text = "strong localization in the first four modes, "
    text += "then an exponential decay of e_kappa with kappa"
    decays = -fit.line.slope > SLOPE_ERRORS * fit.errors[0]
    verdict = judged(decays and fit.scatter <= SIMILAR_DECADES)
    return Claim("4", text, "", f"{fit!r} (exact torus)", verdict)


def _caption_claim(line: PrintedLine, torus: Torus[FromSeries]) -> Claim:
    """The line of the caption, which has another energy and another power of kappa."""
    (chain,) = line.chains
    H = float(torus.energy())
    reading = f"the total energy H = {H:.9f} for E, and + 2 log kappa"
    law = law_of(line, chain, specific_energy=H / chain.N)
    return caption_claim(line, "4", {reading: law})


def line_claim(line: PrintedLine, spectrum: Floats) -> Claim:
    """How far the line of the caption is from the middle modes, for which the law is made."""
    (chain,) = line.chains
    middle = np.array(middle_modes(chain, line.seeds(chain)))
    kappa = middle / chain.N
    levels = np.log10(spectrum[middle - 1])
    printed = np.log10(caption_curve(line, kappa).y)
    law = law_of(line, chain)(kappa)
    off = float(np.max(np.abs(levels - printed)))
    meant = float(np.max(np.abs(levels - law)))
    modes = ", ".join(map(str, middle))
    ours = f"middle modes {modes}: off by up to {off:.2g} decades as printed, "
    ours += f"{meant:.2g} from Eq. eksa2"
    text = "the theoretical line of Fig. 2(a) predicts the localization profile"
    verdict = judged(off <= SIMILAR_DECADES, meant <= SIMILAR_DECADES)
    return Claim("4", text, "", ours, verdict)


def _dimension_claim(seen: FigureIndices, frames: tuple[ForetoldIndices, ...]) -> Claim:
    text = "G_2, G_3 soon constant, G_4 after 3e7, G_5 falls as 1/t from there to 1e9"
    return foretold_claim("4", text, 4, frames, seen, (4, PLATEAU))


def _sums_claims(sums: tuple[Floats, Floats], order: int) -> tuple[Claim, Claim]:
    text = "cancellations make about two orders of magnitude between S_1 and S_2 at k = 11"
    cancellation = cancellation_claim("4", text, CANCELLATION_DECADES, sums, order)
    return (falling_sums_claim(sums, order), cancellation)


def falling_sums_claim(sums: tuple[Floats, Floats], order: int) -> Claim:
    """Whether the sums of moduli and the sums themselves fall."""
    upper, lower = (falls(values, order) for values in sums)
    words = {True: "falls", False: "does not fall"}
    ours = f"from every k to k + 2, S_1 {words[upper]}, S_2 {words[lower]}"
    text = "both sums decay up to k = 11"
    return Claim("4", text, "", ours, judged(upper and lower, upper or lower))


def root_finding_claim(exact: Torus[Newton]) -> Claim:
    """An exact torus of four frequencies, by the method that is said not to find it."""
    residual = exact.residual()
    found = residual < EXACT_RESIDUAL
    ours = "Newton's method in Fourier space has found this 4-torus, "
    ours += f"residual {residual:.0e}"
    if not found:
        ours += ": not found"
    text = "a root-finding determination is possible only for q-breathers, "
    text += "not for tori of dimension above one"
    return Claim("6.4", text, "", ours, judged(residual >= EXACT_RESIDUAL))
