"""Fig. 5: average spectra of tori with seeds anywhere in the spectrum.

They are computed by series and by integration.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.propagation import excitation_sequence
from symfpu.figures.panels import Panel
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.localization.profiles import normalised_averages
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.judgements import SAME_DECADES, groups_claim, parting_level, runs
from symfpu.paper.starts import (
    integrated_orbit,
    normalised_floor,
    printed_row,
    printed_torus,
    profile_panel,
)
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
TIME = 1e5  # our choice; slow beats of the lowest modes average out by then
EXAMPLES = {
    "Fig. 5a": "evenly spread seeds",
    "Fig. 5b": "the highest modes",
    "Fig. 5c": "the middle modes",
    "Fig. 5d": "at 3/4",
}
PRINTED_LEVELS = {"Fig. 5c": 1e-60}  # down to which the text says that both spectra agree
MIRROR_PAIRS = (
    (10, 12),
    (9, 13),
    (20, 22),
    (19, 23),
)  # around the seeds 11 and 21 of Example 1
# Example 1 and 3: where the text sees peaks, and how far from there a mode may be
PEAKS = {"Fig. 5a": (1, 11, 21, 31), "Fig. 5c": (1, 64, 127)}
PEAK_DISTANCE = 1
SIDES = (11, 21)  # seeds of Example 1 with modes on both sides
SIDE_MODES = 5  # before the next peak
BRANCH_END = 32  # of Example 2, where both branches meet
# what the paper integrates with; its rounding grows with time, so that a short one is in its favour
PAPER_SCHEME, PAPER_STEP, PAPER_TIME = "yoshida4", 0.05, 1e3
# "quite similar", where neighbouring groups are two to four decades apart
PAIR_DECADES = 0.5
LIKE_ENERGIES = "modes of one group D_k have like energies"
GROUPS_TEXT = f"{LIKE_ENERGIES}, distinct groups quite different ones (section 5)"
# where the text says that both spectra agree; of b and d it says nothing
STATED_FIGURES = ("Fig. 5a",)
# a level given by its order of magnitude where neighbouring groups are five decades apart
LEVEL_DECADES = 5.0
BRANCH_SHARE = 0.1  # of the fall of a branch: steps of groups about the line
HIGH_LEVEL = 1e-10  # of the energy: spectra that part below it agree in part


def figure5(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """The four examples of section 6.2."""
    panels: list[Panel] = []
    claims: list[Claim] = []
    for label in EXAMPLES:
        progress(f"fig5: {label}: series", NO_FRACTION)
        panel, judgements = _example(label, progress)
        panels.append(panel)
        claims += judgements
    remark = "PLn: the initial condition of the series integrated in mode space "
    remark += f"to t = {TIME:.0e}."
    title = "Fig. 5: localization patterns of seeds anywhere in the spectrum"
    return PaperFigure("fig5", title, tuple(panels), tuple(claims), (remark,))


def _example(label: str, progress: Progress) -> tuple[Panel, list[Claim]]:
    """Spectra of one example, and what is said of them."""
    row = printed_row(label)
    letter = label[-1]
    torus = printed_torus(row)
    orbit = integrated_orbit(f"fig5 {letter}", row.chain, torus, TIME, progress)
    series = np.asarray(torus.average_spectrum() / torus.energy(), dtype=float)
    profiles = {"PL": series, "PLn": normalised_averages(orbit)[-1]}
    title = (
        f"Fig. 5({letter}): {EXAMPLES[label]}, seeds {runs(row.seeds)}, N = {row.chain.N}"
    )
    floors = {"PL": normalised_floor(torus)}
    name = f"fig5{letter}"
    panel = profile_panel(name, title, row.chain, profiles, by_kappa=False, floors=floors)
    groups = excitation_sequence(row.chain.N, row.seeds, row.order)
    claims = [agreement_claim(label, profiles)]
    claims.append(groups_claim(f"6.2, {label}", GROUPS_TEXT, groups, series))
    if label == "Fig. 5a":
        claims += [mirror_claim(series), sides_claim(series)]
    if label == "Fig. 5b":
        claims.append(branches_claim(series))
    if label in PEAKS:
        claims.append(peaks_claim(label, series))
    if label in PRINTED_LEVELS:
        claims.append(paper_scheme_claim(label, torus, progress))
    return panel, claims


def agreement_claim(label: str, profiles: dict[str, Floats]) -> Claim:
    """Down to which energy series and integration agree."""
    level, mode = parting_level(profiles["PL"], profiles["PLn"])
    lowest = float(min(e[e > 0].min() for e in profiles.values()))
    ours = f"they agree within {SAME_DECADES} decades in all modes, down to {lowest:.0e}"
    if level:
        ours = f"the first to differ by more than {SAME_DECADES} decades is mode {mode}, "
        ours += f"at {level:.0e} (all modes lie above {lowest:.0e})"
    section = f"6.2, {label}"
    if label in PRINTED_LEVELS:
        printed = PRINTED_LEVELS[label]
        near = level > 0 and abs(np.log10(level / printed)) <= LEVEL_DECADES
        text = "PLn follows PL down to 1e-60"
        return Claim(section, text, f"{printed:.0e}", ours, judged(bool(near)))
    text = "the spectra of PL and PLn agree very precisely"
    if label not in STATED_FIGURES:
        text += " (compared in the figure, not stated)"
    return Claim(section, text, "", ours, judged(not level, level < HIGH_LEVEL))


def mirror_claim(spectrum: Floats) -> Claim:
    """Energies of modes on both sides of a seed."""
    parts = []
    worst = 0.0
    for a, b in MIRROR_PAIRS:
        ratio = spectrum[a - 1] / spectrum[b - 1]
        decades = abs(float(np.log10(ratio)))
        worst = max(worst, decades)
        parts.append(f"{a} and {b}: {decades:.2f}")
    text = "the pairs {10, 12}, {9, 13}, ... share quite similar energies"
    ours = f"decades apart: {', '.join(parts)}"
    return Claim("6.2, Fig. 5a", text, "", ours, judged(worst <= PAIR_DECADES))


def peaks_claim(label: str, spectrum: Floats) -> Claim:
    """Local maxima of a spectrum against the peaks that the text sees."""
    stated = PEAKS[label]
    e = np.concatenate([[0.0], spectrum, [0.0]])
    higher = (e[1:-1] > e[:-2]) & (e[1:-1] > e[2:])
    found = [int(place) + 1 for place in np.flatnonzero(higher)]
    near = [any(abs(q - p) <= PEAK_DISTANCE for q in found) for p in stated]
    ours = f"local maxima at modes {', '.join(map(str, found))} and nowhere else"
    text = (
        f"{len(stated)} peaks of the spectrum, around modes {', '.join(map(str, stated))}"
    )
    same = all(near) and len(found) == len(stated)
    return Claim(f"6.2, {label}", text, "", ours, judged(same, all(near)))


def _line(spectrum: Floats, modes: range) -> tuple[float, float]:
    """Decades a mode along a run of modes, and the largest distance from the line."""
    levels = np.log10(spectrum[np.array(modes) - 1])
    steps = np.arange(len(levels))
    slope, start = np.polyfit(steps, levels, 1)
    off = np.abs(levels - start - slope * steps)
    return float(slope), float(off.max())


def sides_claim(spectrum: Floats) -> Claim:
    """Whether the spectrum is exponential on either side of a peak."""
    parts = []
    lines = []
    for seed in SIDES:
        left = range(seed - 1, seed - SIDE_MODES - 1, -1)
        right = range(seed + 1, seed + SIDE_MODES + 1)
        for name, modes in (("below", left), ("above", right)):
            slope, off = _line(spectrum, modes)
            lines.append((slope, off))
            parts.append(f"{name} {seed} {slope:.2f} (line within {off:.2f})")
    text = "the local form of the spectrum on either side of one peak is exponential"
    ours = f"decades a mode over {SIDE_MODES} modes: {', '.join(parts)}"
    falling = all(slope < 0 for slope, _ in lines)
    straight = all(off <= PAIR_DECADES for _, off in lines)
    return Claim("6.2, Fig. 5a", text, "", ours, judged(falling and straight, falling))


def branches_claim(spectrum: Floats) -> Claim:
    """Whether both branches of Example 2 fall exponentially."""
    last = len(spectrum)
    branches = {
        "low": range(1, BRANCH_END + 1),
        "high": range(last, BRANCH_END - 1, -1),
    }
    lines = {name: _line(spectrum, modes) for name, modes in branches.items()}
    parts = []
    for name, (slope, off) in lines.items():
        parts.append(f"{name} branch {slope:.2f} decades a mode, line within {off:.2f}")
    text = (
        "the energy falls exponentially along a low-frequency and a high-frequency branch"
    )
    falling = all(slope < 0 for slope, _ in lines.values())
    drop = min(-slope * BRANCH_END for slope, _ in lines.values())
    straight = all(off <= BRANCH_SHARE * drop for _, off in lines.values())
    ours = f"{'; '.join(parts)}: what is left are the steps of the groups"
    return Claim("6.2, Fig. 5b", text, "", ours, judged(falling and straight, falling))


def paper_scheme_claim(label: str, torus: Torus[FromSeries], progress: Progress) -> Claim:
    """How far down the paper's own integrator follows the series."""
    orbit = integrated_orbit(
        f"{label} {PAPER_SCHEME}",
        torus.chain,
        torus,
        PAPER_TIME,
        progress,
        scheme=PAPER_SCHEME,
        step=PAPER_STEP,
    )
    return scheme_level_claim(label, torus, normalised_averages(orbit)[-1])


def scheme_level_claim(label: str, torus: Torus[FromSeries], integrated: Floats) -> Claim:
    """spectrum of the integration, over the energy."""
    series = np.asarray(torus.average_spectrum() / torus.energy(), dtype=float)
    printed = PRINTED_LEVELS[label]
    known = (series > 0) & (integrated > 0)
    series, integrated = series[known], integrated[known]
    lowest = series.min()
    apart = np.abs(np.log10(integrated / series)) > PAIR_DECADES
    level = float(series[apart].max()) if apart.any() else 0.0
    ours = f"Yoshida's fourth order on T + V in doubles, step {PAPER_STEP}, "
    ours += f"to t = {PAPER_TIME:.0e}: spectra part by {PAIR_DECADES} decades "
    ours += f"at {level:.0e} of the energy, "
    ours += "where rounding is; the level above is reached by integration in mode space"
    if not level:
        ours = f"they agree in all modes, down to {lowest:.0e}"
    text = (
        "PLn follows PL down to 1e-60 with the paper's own integrator (note of section 4)"
    )
    near = level <= printed * 10**LEVEL_DECADES
    return Claim(f"6.2, {label}", text, f"{printed:.0e}", ours, judged(bool(near)))
