"""Tables and numbers as text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

GAP = "  "  # between the columns of a table in a terminal


def text_table(
    head: Sequence[str], rows: Sequence[Sequence[str]], width: int | None = None
) -> list[str]:
    """A table in lines.

    Columns beyond the width follow in a further one with the same first column.
    """
    table = [head, *rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = []
    for part in _parts(widths, width):
        for row in table:
            cells = [row[i].ljust(widths[i]) for i in part]
            line = GAP.join(cells)
            lines.append(line.rstrip())
    return lines


def _parts(widths: Sequence[int], width: int | None) -> list[list[int]]:
    """The columns of each table."""
    if width is None:
        return [list(range(len(widths)))]
    parts = [[0]]
    taken = widths[0]
    for i in range(1, len(widths)):
        needed = len(GAP) + widths[i]
        if taken + needed > width and len(parts[-1]) > 1:
            parts.append([0])
            taken = widths[0]
        parts[-1].append(i)
        taken += needed
    return parts


def markdown_table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    rule = ["---"] * len(header)
    lines = [header, rule, *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
