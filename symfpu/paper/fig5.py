"""Fig. 5: average spectra of tori with seeds anywhere in the spectrum, by the series and by
integration.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.propagation import excitation_sequence
from symfpu.figures.panels import Panel
from symfpu.localization.profiles import normalised_averages
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.judgements import AGREEMENT, groups_claim, parting_level, runs
from symfpu.paper.starts import follow, normalised_floor, printed_row, printed_torus, profile_panel
from symfpu.paper.steps import Step

Floats = NDArray[np.float64]
TIME = 1e5  # our choice; slow beats of the lowest modes average out by then
EXAMPLES = {
    "Fig. 5a": "evenly spread seeds",
    "Fig. 5b": "the highest modes",
    "Fig. 5c": "the middle modes",
    "Fig. 5d": "at 3/4",
}
PRINTED_LEVELS = {"Fig. 5c": 1e-60}  # down to which the text says that both spectra agree
MIRROR_PAIRS = ((10, 12), (9, 13), (20, 22), (19, 23))  # around the seeds 11 and 21 of Example 1
GROUPS_TEXT = (
    "modes of one group D_k have like energies, distinct groups quite different ones (section 5)"
)
STATED = ("Fig. 5a",)  # where the text says that both spectra agree; of b and d it says nothing
# a level given by its order of magnitude where neighbouring groups are five decades apart
LEVEL_DECADES = 5.0


def figure5(folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """The four examples of section 6.2."""
    panels: list[Panel] = []
    claims: list[Claim] = []
    for label, where in EXAMPLES.items():
        row = printed_row(label)
        step(f"fig5: {label}: series")
        torus = printed_torus(row)
        orbit = follow(f"fig5 {label[-1]}", row.chain, torus, TIME, step)
        profiles = {
            "PL": np.asarray(torus.average_spectrum() / torus.energy(), dtype=float),
            "PLn": normalised_averages(orbit)[-1],
        }
        title = f"Fig. 5({label[-1]}): {where}, seeds {runs(row.seeds)}, N = {row.chain.N}"
        floors = {"PL": normalised_floor(torus)}
        panel = f"fig5{label[-1]}"
        panels.append(
            profile_panel(panel, title, row.chain, profiles, by_kappa=False, floors=floors)
        )
        groups = excitation_sequence(row.chain.N, row.seeds, row.order)
        claims += [
            _agreement(label, profiles),
            groups_claim(f"6.2, {label}", GROUPS_TEXT, groups, profiles["PL"]),
        ]
        if label == "Fig. 5a":
            claims.append(_mirror_pairs(profiles["PL"]))
    remark = f"PLn: the initial condition of the series integrated in mode space to t = {TIME:.0e}."
    return PaperFigure(
        "fig5",
        "Fig. 5: localization patterns of seeds anywhere in the spectrum",
        tuple(panels),
        tuple(claims),
        (remark,),
    )


def _agreement(label: str, profiles: dict[str, Floats]) -> Claim:
    level, mode = parting_level(profiles["PL"], profiles["PLn"])
    lowest = float(min(e[e > 0].min() for e in profiles.values()))
    ours = f"they agree within {AGREEMENT} decades in all modes, down to {lowest:.0e}"
    if level:
        ours = f"the first to differ by more than {AGREEMENT} decades is mode {mode}, at {level:.0e} (all modes lie above {lowest:.0e})"
    section = f"6.2, {label}"
    if label in PRINTED_LEVELS:
        printed = PRINTED_LEVELS[label]
        near = level > 0 and abs(np.log10(level / printed)) <= LEVEL_DECADES
        return Claim(
            section, "PLn follows PL down to 1e-60", f"{printed:.0e}", ours, judged(bool(near))
        )
    text = "the spectra of PL and PLn agree very precisely" + (
        "" if label in STATED else " (compared in the figure, not stated)"
    )
    return Claim(section, text, "", ours, judged(not level, level < 1e-10))


def _mirror_pairs(spectrum: Floats) -> Claim:
    ratios = {
        pair: abs(float(np.log10(spectrum[pair[0] - 1] / spectrum[pair[1] - 1])))
        for pair in MIRROR_PAIRS
    }
    ours = "decades apart: " + ", ".join(
        f"{a} and {b}: {value:.2f}" for (a, b), value in ratios.items()
    )
    holds = (
        max(ratios.values()) <= 0.5
    )  # "quite similar", where neighbouring groups are two to four decades apart
    return Claim(
        "6.2, Fig. 5a",
        "the pairs {10, 12}, {9, 13}, ... share quite similar energies",
        "",
        ours,
        judged(holds),
    )
