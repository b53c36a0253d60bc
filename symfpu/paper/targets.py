"""What `symfpu reproduce` can compute: each target with its numbers, its page and its pictures. A
new one is one more line.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from symfpu.paper.claims import PaperFigure
from symfpu.paper.claims_page import figure_markdown, figure_record, write_panel_csv
from symfpu.paper.convergence import breather_study, cancellation_study
from symfpu.paper.corrected import corrected_rows, scaling_study
from symfpu.paper.corrected_page import (
    corrected_markdown,
    corrected_record,
    corrected_text,
    write_corrected_csv,
)
from symfpu.paper.dimensions import VECTORS, full_seconds
from symfpu.paper.drawings import (
    draw_convergence,
    draw_corrected,
    draw_figure1,
    draw_figure6,
    draw_panels,
)
from symfpu.paper.fig1 import figure1, figure1_claims
from symfpu.paper.fig2_fig3 import figure2, figure3
from symfpu.paper.fig4 import figure4
from symfpu.paper.fig5 import figure5
from symfpu.paper.fig6 import figure6, figure6_claims
from symfpu.paper.fig7_fig8 import figure7, figure8
from symfpu.paper.fig9 import figure9
from symfpu.paper.pages import (
    convergence_markdown,
    convergence_record,
    figure1_markdown,
    figure1_record,
    figure6_markdown,
    row_record,
    table_markdown,
    write_convergence_csv,
    write_figure1_csv,
    write_figure6_csv,
)
from symfpu.paper.section5 import section5
from symfpu.paper.steps import Step
from symfpu.paper.table import amplitude_table

SCALED = ("Fig. 1", "Fig. 7")  # rows whose errors are followed to smaller mu


class Page(NamedTuple):
    """record : for JSON. markdown : a section of the report. files : written beside it, by their
    common beginning. lines : for the terminal, one for each row of the table. figure : with the
    claims, for targets that judge any.
    """

    record: Any
    markdown: str
    files: str = ""
    lines: tuple[str, ...] = ()
    figure: PaperFigure | None = None


class Target(Protocol):
    """Computes a page and writes its files into the folder.

    `step` hears what comes next. full : what takes hours, too.
    """

    def __call__(self, folder: Path, step: Step, *, full: bool = False) -> Page: ...


def _table(folder: Path, step: Step, *, full: bool = False) -> Page:
    rows = list(amplitude_table(step))
    corrected = list(corrected_rows({row.printed: row.series for row in rows}, step, full=full))
    studies = [
        scaling_study(row.torus, row.printed.label, step)
        for row in corrected
        if row.torus and row.printed.label in SCALED
    ]
    write_corrected_csv(corrected, studies, folder)
    step("table: pictures")
    draw_corrected(corrected, studies, folder)
    by_label = {study.label: study for study in studies}
    record = [
        row_record(row) | {"corrected": corrected_record(exact, by_label.get(row.printed.label))}
        for row, exact in zip(rows, corrected, strict=True)
    ]
    markdown = table_markdown(rows) + "\n" + corrected_markdown(corrected, studies)
    return Page(
        record,
        markdown,
        f"corrected-a..{'bcd'[len(studies)]}",
        tuple(map(corrected_text, corrected)),
    )


def _figure1(folder: Path, step: Step, *, full: bool = False) -> Page:
    data = figure1(step)
    write_figure1_csv(data, folder)
    step("fig1: pictures")
    draw_figure1(data, folder)
    more = _figure(partial(figure1_claims, data), folder, step, full=full)
    record = figure1_record(data) | {"judged": more.record}
    return Page(
        record,
        figure1_markdown(data) + "\n" + more.markdown,
        f"fig1a..d, {more.files}",
        figure=more.figure,
    )


def _figure6(folder: Path, step: Step, *, full: bool = False) -> Page:
    patterns = figure6()
    write_figure6_csv(patterns, folder)
    step("fig6: pictures")
    draw_figure6(patterns, folder)
    judged = figure6_claims(patterns)
    record = {
        panel: {"seeds": list(seeds), "orders": orders}
        for panel, (seeds, orders) in patterns.panels.items()
    }
    markdown = figure6_markdown(patterns) + "\n" + figure_markdown(judged)
    return Page(record | {"judged": figure_record(judged)}, markdown, "fig6a..c", figure=judged)


def _figure(
    make: Callable[..., PaperFigure], folder: Path, step: Step, *, full: bool = False
) -> Page:
    """A figure of panels and claims."""
    figure = make(folder, step, full=full)
    write_panel_csv(figure, folder)
    step(f"{figure.name}: pictures")
    draw_panels(figure, folder)
    names = [panel.name for panel in figure.panels]
    return Page(figure_record(figure), figure_markdown(figure), ", ".join(names), figure=figure)


def _convergence(folder: Path, step: Step, *, full: bool = False) -> Page:
    questions = cancellation_study(step), breather_study(step)
    write_convergence_csv(*questions, folder)
    step("convergence: pictures")
    draw_convergence(*questions, folder)
    return Page(
        convergence_record(*questions), convergence_markdown(*questions), "convergence-a..e"
    )


TARGETS: dict[str, Target] = {
    "table": _table,
    "section5": partial(_figure, section5),
    "fig1": _figure1,
    "fig2": partial(_figure, figure2),
    "fig3": partial(_figure, figure3),
    "fig4": partial(_figure, figure4),
    "fig5": partial(_figure, figure5),
    "fig6": _figure6,
    "fig7": partial(_figure, figure7),
    "fig8": partial(_figure, figure8),
    "fig9": partial(_figure, figure9),
    "convergence": _convergence,
}
FULL = ("table", "fig1", "fig2", "fig9")  # targets with a part that takes many minutes, or hours


def full_estimate(targets: list[str], folder: Path) -> str:
    """How long --full will take for these targets, and how it goes on if it is stopped."""
    times = {figure: full_seconds(figure) for figure in VECTORS if figure in targets}
    parts = [f"{figure} {seconds / 3600:.1f} h" for figure, seconds in times.items()]
    parts += ["table 10 minutes"] if "table" in targets else []
    resumed = (
        f"; stopped and started again, alignment indices go on from {folder}/*.checkpoint"
        if times
        else ""
    )
    return f"--full, about: {', '.join(parts)}{resumed}"
