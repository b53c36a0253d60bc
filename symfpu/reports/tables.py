"""Tables and numbers as text."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from symfpu.numbers.arithmetic import text


def fifteen_digits(value: float) -> float:
    """A measure of size to 15 digits, the most that a number in JSON has; what needs more is written as a string."""
    return float(f"{value:.15g}")


def number_text(value: Any, digits: int | None) -> str:
    """A number that loses no digit: the shortest decimal of a double, or so many digits of an mpf."""
    return repr(float(value)) if digits is None else text(value, digits)


def markdown_table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def write_csv(tables: Mapping[str, tuple[Sequence[str], Iterable[Sequence[Any]]]], folder: Path) -> list[Path]:
    """Tables by name, each with its header, as CSV files in a folder."""
    paths = []
    for name, (header, lines) in tables.items():
        path = folder / f"{name}.csv"
        with path.open("w", newline="") as file:
            csv.writer(file).writerows([header, *lines])
        paths.append(path)
    return paths
