"""Panels and their curves, as data."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.errors import InputError

Floats = NDArray[np.float64]
STYLES = ("line", "points", "dots", "triangles", "rings", "law")


@dataclass(frozen=True, eq=False)
class Curve:
    """y against x, both (n,), with a label and one of STYLES; points that are not positive are left
    out of logarithmic axes.

    group : curves of one group share a colour, and the label of the first stands for all; default
    each its own. name : in the table, where a label is of many curves or has LaTeX in it; default
    the label.
    """

    label: str
    x: Floats = field(repr=False)
    y: Floats = field(repr=False)
    style: str = "line"
    group: int | None = None
    name: str = ""

    def __post_init__(self) -> None:
        if np.shape(self.x) != np.shape(self.y) or np.ndim(self.x) != 1:
            raise InputError(
                "y",
                np.shape(self.y),
                f"as many numbers as x, {np.shape(self.x)}",
                "pass one y for each x",
            )
        if self.style not in STYLES:
            raise InputError("style", self.style, ", ".join(STYLES), "choose one of them")


@dataclass(frozen=True, eq=False)
class Panel:
    """One picture. name : of its files. x_label, y_label : LaTeX. log_x, log_y : logarithmic axes.
    bottom : of the y axis. axes : of the table, what x and y are, in words without blanks.
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

    def table(self) -> tuple[list[str], Iterable[list[Any]]]:
        """Header and rows: one row for each point of each curve."""
        rows = (
            [curve.name or curve.label, float(x), float(y)]
            for curve in self.curves
            for x, y in zip(curve.x, curve.y, strict=True)
        )
        return ["curve", *self.axes], rows
