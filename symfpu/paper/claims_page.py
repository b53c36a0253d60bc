"""Figures of the paper as text, data and pictures: Markdown, JSON, CSV, PNG and PDF.

Computes nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from symfpu.figures.drawing import draw_panel
from symfpu.figures.panels import Panel
from symfpu.files.writing import write_rows
from symfpu.paper.claims import VERDICTS, Claim, PaperFigure
from symfpu.results.text_tables import markdown_table


def figure_markdown(figure: PaperFigure) -> str:
    """Title, remarks, text, claims and pictures of a figure."""
    parts = [f"## {figure.title}", *figure.remarks, *figure.text]
    if figure.claims:
        parts.append(claims_table(figure.claims))
    parts += [f"![{panel.title}]({panel.name}.png)" for panel in figure.panels]
    return "\n\n".join(parts) + "\n"


def claims_table(claims: Iterable[Claim]) -> str:
    """One row for each claim."""
    rows = []
    for claim in claims:
        printed = claim.printed or "-"
        verdict = f"**{claim.verdict}**"
        row = (claim.section, claim.text, printed, claim.ours, verdict)
        rows.append([_cell(text) for text in row])
    return markdown_table(
        ["section", "the paper says", "printed", "found here", "verdict"], rows
    )


def _cell(text: str) -> str:
    """Moduli would end a cell of a table."""
    return text.replace("|", r"\|")


def claims_markdown(figures: Iterable[PaperFigure]) -> str:
    """How many claims hold, and in which figures; figures without claims are left out."""
    total = dict.fromkeys(VERDICTS, 0)
    rows = []
    for figure in figures:
        if not figure.claims:
            continue
        found = [claim.verdict for claim in figure.claims]
        row = [figure.title]
        for verdict in VERDICTS:
            count = found.count(verdict)
            total[verdict] += count
            row.append(str(count or ""))
        rows.append(row)
    summary = ", ".join(f"{count} {verdict}" for verdict, count in total.items() if count)
    table = markdown_table(["figure", *VERDICTS], rows)
    return f"## Claims\n\n{summary}.\n\n{table}\n"


def figure_record(figure: PaperFigure) -> dict[str, Any]:
    """For JSON: claims, the curves of each panel by name, and numbers of the figure's own."""
    return {
        "kind": type(figure).__name__,
        "title": figure.title,
        "remarks": list(figure.remarks),
        "claims": [claim.record() for claim in figure.claims],
        "panels": {panel.name: _curve_names(panel) for panel in figure.panels},
        "numbers": figure.numbers,
    }


def _curve_names(panel: Panel) -> list[str]:
    return [curve.label or curve.name for curve in panel.curves]


def write_panel_csv(figure: PaperFigure, folder: Path) -> list[Path]:
    """The table of each panel, one file each."""
    paths = []
    for panel in figure.panels:
        header, rows = panel.table()
        paths.append(folder / f"{panel.name}.csv")
        write_rows(paths[-1], [header, *rows])
    return paths


def draw_panels(figure: PaperFigure, folder: Path) -> list[Path]:
    """Write every panel of a figure as PNG and PDF; returns the paths."""
    paths = []
    for panel in figure.panels:
        paths += draw_panel(panel, folder)
    return paths


def file_names(figure: PaperFigure) -> str:
    """The names of a figure's files, those that differ in a last letter together: fig6a..c."""
    runs: list[list[str]] = []
    for panel in figure.panels:
        if runs and _follows(runs[-1][-1], panel.name):
            runs[-1].append(panel.name)
        else:
            runs.append([panel.name])
    return ", ".join(_run_text(run) for run in runs)


def _follows(name: str, other: str) -> bool:
    """Whether a name is the one after another: the same but for the next letter."""
    return name[:-1] == other[:-1] and ord(name[-1]) + 1 == ord(other[-1])


def _run_text(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{names[0]}..{names[-1][-1]}"
