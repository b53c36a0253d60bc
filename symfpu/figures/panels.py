"""Panels and their curves, as data."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.errors import InputError

Floats = NDArray[np.float64]
STYLES = (
    "line",
    "dotted",
    "law",
    "points",
    "dots",
    "triangles",
    "rings",
    "marks",
    "joined",
    "beads",
    "crosses",
    "span",
)


@dataclass(frozen=True, eq=False)
class Curve:
    """y against x, both (n,), in one of STYLES; a logarithmic axis leaves out what is not positive.

    label : in the legend, unless it is empty. The style "span" shades the panel from the first to
    the last x, and writes its label there at the first y.
    group : curves of one group share a colour and a marker, and those of one style in it the
    label of the first; default each its own. name : in the table, where a label is of many curves
    or has LaTeX in it; default the label.
    """

    label: str
    x: Floats = field(repr=False)
    y: Floats = field(repr=False)
    style: str = "line"
    group: int | None = None
    name: str = ""

    def __post_init__(self) -> None:
        if np.shape(self.x) != np.shape(self.y) or np.ndim(self.x) != 1:
            given = np.shape(self.y)
            allowed = f"as many numbers as x, {np.shape(self.x)}"
            raise InputError("y", given, allowed, "pass one y for each x")
        if self.style not in STYLES:
            raise InputError("style", self.style, ", ".join(STYLES), "choose one of them")


@dataclass(frozen=True, eq=False)
class Panel:
    """One picture, and the table behind it.

    name : of its files. x_label, y_label : LaTeX. axes : of the table, what x and y are, in words
    without blanks.
    log_x, log_y : logarithmic axes. bottom, top : of the y axis. x_limits : of the x axis.
    falling : whether the y axis goes down.
    legend : its place, in the words of matplotlib; default inside, or beside many curves.
    columns : of the table, by name, where they are other than the points of the curves.
    """

    name: str
    title: str
    x_label: str
    y_label: str
    curves: tuple[Curve, ...]
    axes: tuple[str, str]
    log_x: bool = False
    log_y: bool = True
    bottom: float | None = None
    top: float | None = None
    x_limits: tuple[float, float] | None = None
    falling: bool = False
    legend: str | None = None
    legend_columns: int = 1
    columns: Mapping[str, Sequence[Any]] | None = field(default=None, repr=False)

    def table(self) -> tuple[list[str], Iterable[Sequence[Any]]]:
        """Header and rows: those of the columns, or one row for each point of each curve."""
        if self.columns is not None:
            return list(self.columns), zip(*self.columns.values(), strict=True)
        rows = []
        for curve in self.curves:
            name = curve.name or curve.label
            for x, y in zip(curve.x, curve.y, strict=True):
                rows.append([name, float(x), float(y)])
        return ["curve", *self.axes], rows
