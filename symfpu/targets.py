"""What `symfpu reproduce` can compute: each target with its numbers, its page and its pictures. A new one is one more line."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from symfpu.convergence import breather_study, cancellation_study
from symfpu.corrected import corrected_rows, scaling_study
from symfpu.corrected_report import corrected_markdown, corrected_record, corrected_text, write_corrected_csv
from symfpu.figures import draw_convergence, draw_corrected, draw_figure1, draw_figure6
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

SCALED = ("Fig. 1", "Fig. 7")  # rows whose errors are followed to smaller mu


class Page(NamedTuple):
    """record : for JSON. markdown : a section of the report. files : written beside it, by their common beginning. lines : for the
    terminal, one for each row of the table."""

    record: Any
    markdown: str
    files: str = ""
    lines: tuple[str, ...] = ()


def _table(folder: Path, step: Step, *, full: bool = False) -> Page:
    rows = list(amplitude_table(step))
    corrected = list(corrected_rows({row.printed: row.series for row in rows}, step, full=full))
    studies = [scaling_study(row.torus, row.printed.label, step) for row in corrected if row.torus and row.printed.label in SCALED]
    write_corrected_csv(corrected, studies, folder)
    step("table: pictures")
    draw_corrected(corrected, studies, folder)
    by_label = {study.label: study for study in studies}
    record = [
        row_record(row) | {"corrected": corrected_record(exact, by_label.get(row.printed.label))}
        for row, exact in zip(rows, corrected, strict=True)
    ]
    markdown = table_markdown(rows) + "\n" + corrected_markdown(corrected, studies)
    return Page(record, markdown, f"corrected-a..{'bcd'[len(studies)]}", tuple(map(corrected_text, corrected)))


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
    return Page(convergence_record(*questions), convergence_markdown(*questions), "convergence-a..e")


FULL: dict[str, Callable[[Path, Step], Page]] = {"table": partial(_table, full=True)}  # with rows that take many minutes

TARGETS: dict[str, Callable[[Path, Step], Page]] = {
    "table": _table,
    "fig1": _figure1,
    "fig6": _figure6,
    "convergence": _convergence,
}
