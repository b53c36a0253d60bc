"""What `symfpu reproduce` can compute: the maker of each figure. A new one is one more line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Protocol

from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.paper.claims import PaperFigure
from symfpu.paper.claims_page import draw_panels, write_panel_csv
from symfpu.paper.convergence import convergence
from symfpu.paper.dimensions import VECTORS, full_seconds
from symfpu.paper.fig1 import figure1
from symfpu.paper.fig2 import figure2
from symfpu.paper.fig3 import figure3
from symfpu.paper.fig4 import figure4
from symfpu.paper.fig5 import figure5
from symfpu.paper.fig6 import figure6
from symfpu.paper.fig7 import figure7
from symfpu.paper.fig8 import figure8
from symfpu.paper.fig9 import figure9
from symfpu.paper.section5 import section5
from symfpu.paper.statements import statements
from symfpu.paper.table_page import table
from symfpu.paper.toda import toda_page


class Maker(Protocol):
    """Computes a figure; the folder is for checkpoints.

    `progress` hears what comes next. full : what takes hours, too.
    """

    def __call__(
        self, folder: Path, progress: Progress, *, full: bool = False
    ) -> PaperFigure: ...


TARGETS: dict[str, Maker] = {
    "table": table,
    "section5": section5,
    "statements": statements,
    "fig1": figure1,
    "fig2": figure2,
    "fig3": figure3,
    "fig4": figure4,
    "fig5": figure5,
    "fig6": figure6,
    "fig7": figure7,
    "fig8": figure8,
    "fig9": figure9,
    "convergence": convergence,
    "toda": toda_page,
}
# with a part that takes many minutes, or hours
LONG_TARGETS = ("table", "fig1", "fig2", "fig9")
# of processor time without AVX-512: what is begun first, and how long all will take
SECONDS: dict[str, float] = {
    "table": 33.0,
    "section5": 5.0,
    "statements": 15.0,
    "fig1": 10.0,
    "fig2": 38.0,
    "fig3": 13.0,
    "fig4": 43.0,
    "fig5": 18.0,
    "fig6": 3.0,
    "fig7": 6.0,
    "fig8": 5.0,
    "fig9": 38.0,
    "convergence": 46.0,
    "toda": 37.0,
}
FULL_TABLE = 25.0  # seconds, of Fig. 5d refined
FIRST_PICTURE = "fig6"  # drawn within seconds


def reproduced(
    target: str, folder: Path, progress: Progress, *, full: bool = False
) -> PaperFigure:
    """The figure of a target, with its tables and pictures in the folder."""
    progress(target, NO_FRACTION)
    figure = TARGETS[target](folder, progress, full=full)
    write_panel_csv(figure, folder)
    progress(f"{target}: pictures", NO_FRACTION)
    draw_panels(figure, folder)
    return figure


def full_seconds_of(targets: Iterable[str]) -> dict[str, float]:
    """By target, the seconds that --full adds."""
    times = {figure: full_seconds(figure) for figure in VECTORS if figure in targets}
    if "table" in targets:
        times["table"] = FULL_TABLE
    return times


def full_estimate(added: Mapping[str, float], folder: Path) -> str:
    """How long --full will take for these targets, and how it goes on if it is stopped."""
    parts = []
    for target, seconds in added.items():
        hours, few = f"{seconds / 3600:.1f} h", f"{seconds:.0f} s"
        parts.append(f"{target} {hours if target in VECTORS else few}")
    estimate = f"--full, about: {', '.join(parts)}"
    if any(target in VECTORS for target in added):
        estimate += "; stopped and started again, alignment indices go on from "
        estimate += f"{folder}/*.checkpoint"
    return estimate
