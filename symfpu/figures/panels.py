"""What a figure of the paper comes to: panels with their curves, and what the paper says of them beside what we find. Data only."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.errors import InputError

Floats = NDArray[np.float64]

HOLDS, PARTLY, FAILS, OPEN = "holds", "holds in part", "does not hold", "undecided"
VERDICTS = (HOLDS, PARTLY, FAILS, OPEN)
STYLES = ("line", "points", "dots", "triangles", "rings", "law")


@dataclass(frozen=True, eq=False)
class Curve:
    """y against x, both (n,), with a label and one of STYLES; points that are not positive are left out of logarithmic axes.

    group : curves of one group share a colour, and the label of the first stands for all; default each its own. name : in the table, where
    a label is of many curves or has LaTeX in it; default the label.
    """

    label: str
    x: Floats = field(repr=False)
    y: Floats = field(repr=False)
    style: str = "line"
    group: int | None = None
    name: str = ""

    def __post_init__(self) -> None:
        if np.shape(self.x) != np.shape(self.y) or np.ndim(self.x) != 1:
            raise InputError("y", np.shape(self.y), f"as many numbers as x, {np.shape(self.x)}", "pass one y for each x")
        if self.style not in STYLES:
            raise InputError("style", self.style, ", ".join(STYLES), "choose one of them")


@dataclass(frozen=True, eq=False)
class Panel:
    """One picture. name : of its files. x_label, y_label : LaTeX. log_x, log_y : logarithmic axes. bottom : of the y axis. axes : of the
    table, what x and y are, in words without blanks."""

    name: str
    title: str
    x_label: str
    y_label: str
    curves: tuple[Curve, ...]
    axes: tuple[str, str]
    log_x: bool = False
    log_y: bool = True
    bottom: float | None = None

    def table(self) -> tuple[list[str], Iterable[list[Any]]]:
        """Header and rows: one row for each point of each curve."""
        rows = ([curve.name or curve.label, float(x), float(y)] for curve in self.curves for x, y in zip(curve.x, curve.y, strict=True))
        return ["curve", *self.axes], rows


@dataclass(frozen=True)
class Claim:
    """A statement or number of the paper and what became of it.

    section : where the paper says it. text : what it says. printed : its number, if there is one. ours : what we find, with numbers.
    verdict : one of VERDICTS.
    """

    section: str
    text: str
    printed: str
    ours: str
    verdict: str

    def __post_init__(self) -> None:
        if self.verdict not in VERDICTS:
            raise InputError("verdict", self.verdict, ", ".join(VERDICTS), "choose one of them")

    def record(self) -> dict[str, str]:
        """For JSON."""
        return {name: getattr(self, name) for name in ("section", "text", "printed", "ours", "verdict")}


@dataclass(frozen=True)
class PaperFigure:
    """A figure of the paper computed anew. name : such as "fig2". remarks : how, in sentences."""

    name: str
    title: str
    panels: tuple[Panel, ...]
    claims: tuple[Claim, ...]
    remarks: tuple[str, ...] = ()

    def __repr__(self) -> str:
        counts = ", ".join(f"{n} {verdict}" for verdict in VERDICTS if (n := sum(c.verdict == verdict for c in self.claims)))
        return f"PaperFigure({self.name}, panels {', '.join(panel.name for panel in self.panels)}; claims: {counts or 'none'})"


def judged(holds: bool, partly: bool = False) -> str:
    """The verdict on a claim that can be decided."""
    return HOLDS if holds else PARTLY if partly else FAILS
