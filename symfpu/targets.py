"""What `symfpu reproduce` can compute: each target with its numbers, its page and its pictures. A new one is one more line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from symfpu.convergence import breather_study, cancellation_study
from symfpu.figures import draw_convergence, draw_figure1, draw_figure6
from symfpu.report import (
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
from symfpu.reproduction import Step, amplitude_table, figure1, figure6


class Page(NamedTuple):
    """record : for JSON. markdown : a section of the report. files : written beside it, by their common beginning."""

    record: Any
    markdown: str
    files: str = ""


def _table(folder: Path, step: Step) -> Page:
    rows = list(amplitude_table(step))
    return Page([row_record(row) for row in rows], table_markdown(rows))


def _figure1(folder: Path, step: Step) -> Page:
    data = figure1(step)
    write_figure1_csv(data, folder)
    step("fig1: pictures")
    draw_figure1(data, folder)
    return Page(figure1_record(data), figure1_markdown(data), "fig1a..d")


def _figure6(folder: Path, step: Step) -> Page:
    patterns = figure6()
    write_figure6_csv(patterns, folder)
    step("fig6: pictures")
    draw_figure6(patterns, folder)
    record = {panel: {"seeds": list(seeds), "orders": orders} for panel, (seeds, orders) in patterns.panels.items()}
    return Page(record, figure6_markdown(patterns), "fig6a..c")


def _convergence(folder: Path, step: Step) -> Page:
    questions = cancellation_study(step), breather_study(step)
    write_convergence_csv(*questions, folder)
    step("convergence: pictures")
    draw_convergence(*questions, folder)
    return Page(convergence_record(*questions), convergence_markdown(*questions), "convergence-a..d")


TARGETS: dict[str, Callable[[Path, Step], Page]] = {
    "table": _table,
    "fig1": _figure1,
    "fig6": _figure6,
    "convergence": _convergence,
}
