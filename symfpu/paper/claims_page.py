"""Figures of the paper as text: Markdown with every panel and claim, JSON, CSV. Computes nothing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from symfpu.paper.claims import VERDICTS, Claim, PaperFigure
from symfpu.reports.tables import markdown_table, write_csv


def figure_markdown(figure: PaperFigure) -> str:
    """Title, remarks, claims and pictures of a figure."""
    pictures = [f"![{panel.title}]({panel.name}.png)" for panel in figure.panels]
    claims = [claims_table(figure.claims)] if figure.claims else []
    return "\n\n".join([f"## {figure.title}", *figure.remarks, *claims, *pictures]) + "\n"


def claims_table(claims: Iterable[Claim]) -> str:
    """One row for each claim."""
    rows = [
        [_cell(text) for text in (c.section, c.text, c.printed or "-", c.ours, f"**{c.verdict}**")]
        for c in claims
    ]
    return markdown_table(["section", "the paper says", "printed", "found here", "verdict"], rows)


def _cell(text: str) -> str:
    """Moduli would end a cell of a table."""
    return text.replace("|", r"\|")


def claims_markdown(figures: Sequence[PaperFigure]) -> str:
    """How many claims hold, and where they are judged."""
    counts = Counter(claim.verdict for figure in figures for claim in figure.claims)
    summary = ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS if counts[verdict])
    rows = [
        [
            figure.title,
            *(
                str(sum(claim.verdict == verdict for claim in figure.claims) or "")
                for verdict in VERDICTS
            ),
        ]
        for figure in figures
    ]
    return f"## Claims\n\n{summary}.\n\n{markdown_table(['figure', *VERDICTS], rows)}\n"


def figure_record(figure: PaperFigure) -> dict[str, Any]:
    """For JSON: claims, and the curves of each panel by name."""
    return {
        "title": figure.title,
        "remarks": list(figure.remarks),
        "claims": [claim.record() for claim in figure.claims],
        "panels": {panel.name: [curve.label for curve in panel.curves] for panel in figure.panels},
    }


def write_panel_csv(figure: PaperFigure, folder: Path) -> list[Path]:
    """The curves of each panel, one file each."""
    return write_csv({panel.name: panel.table() for panel in figure.panels}, folder)
