"""Panels drawn into axes, and as files; nothing is computed here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.figures.panels import Curve, Panel
from symfpu.plots.style import COLOURS, MARKERS, write_picture

Floats = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Axes = Any
# with more of them, or of lines among them, the legend goes beside the picture
INSIDE_CURVES, INSIDE_LINES = 5, 3
SPAN_COLOUR = "0.92"

# a marker of several letters is one for each curve
CURVE_STYLES: Mapping[str, dict[str, Any]] = {
    "line": {"lw": 1.2},
    "dotted": {"ls": ":", "lw": 1.2},
    "law": {"ls": "--", "lw": 1.2},
    "points": {"marker": "o", "ls": "none", "ms": 7, "alpha": 0.8},
    "dots": {"marker": ".", "ls": "none", "ms": 4},
    "triangles": {"marker": "^", "ls": "none", "ms": 7},
    "rings": {"marker": "o", "ls": "none", "ms": 9, "mfc": "none"},
    "marks": {"marker": MARKERS, "ls": "none", "ms": 5},
    "joined": {"marker": MARKERS, "ms": 9, "mfc": "none"},
    "beads": {"marker": MARKERS, "ms": 4, "lw": 1, "mfc": "none"},
    "crosses": {"marker": "x", "ls": ":", "ms": 5},
}
# of which the sixth and later ones are dashed, as their colours are those of the first
DASHED_STYLES = ("line", "beads")


def plot_panel(panel: Panel, ax: Axes) -> Axes:
    """A panel of curves; of points that lie on each other the first ones are the largest."""
    labelled: set[tuple[int, str]] = set()
    for i, curve in enumerate(panel.curves):
        if curve.style == "span":
            _shade(panel, curve, ax)
            continue
        label = curve.label or None
        if curve.group is not None:
            kind = (curve.group, curve.style)
            label = None if kind in labelled else label
            labelled.add(kind)
        shown = _shown(panel, curve)
        look = _look(panel, i)
        ax.plot(curve.x[shown], curve.y[shown], label=label, **look)
    _set_axes(panel, ax)
    _add_legend(panel, ax)
    return ax


def _shown(panel: Panel, curve: Curve) -> Booleans:
    """Which points of a curve (n,) the axes can show."""
    finite = np.isfinite(curve.x) & np.isfinite(curve.y)
    on_x = (curve.x > 0) | (not panel.log_x)
    on_y = (curve.y > 0) | (not panel.log_y)
    return np.asarray(finite & on_x & on_y)


def _look(panel: Panel, i: int) -> dict[str, Any]:
    """Colour, line and marker of a curve of a panel."""
    curve = panel.curves[i]
    place = i if curve.group is None else curve.group
    look = dict(CURVE_STYLES[curve.style])
    markers = look.get("marker")
    if markers:
        look["marker"] = markers[place % len(markers)]
    if markers and curve.style != "beads":
        look["ms"] *= 1 - 0.5 * i / len(panel.curves)
    dashed = curve.style in DASHED_STYLES and curve.group is None
    if dashed and i >= COLOURS:
        look["ls"] = "--"
    own_colour = f"C{place % COLOURS}"
    look["color"] = "black" if curve.style == "law" else own_colour
    return look


def _shade(panel: Panel, curve: Curve, ax: Axes) -> None:
    """A span of the x axis, with its label in the middle."""
    first, last = float(curve.x[0]), float(curve.x[-1])
    ax.axvspan(first, last, color=SPAN_COLOUR, zorder=0)
    middle = np.sqrt(first * last) if panel.log_x else (first + last) / 2
    ax.text(middle, float(curve.y[0]), curve.label, ha="center")


def _set_axes(panel: Panel, ax: Axes) -> None:
    ax.set_xscale("log" if panel.log_x else "linear")
    ax.set_yscale("log" if panel.log_y else "linear")
    if panel.bottom is not None:
        ax.set_ylim(bottom=panel.bottom)
    if panel.top is not None:
        ax.set_ylim(top=panel.top)
    if panel.x_limits is not None:
        ax.set_xlim(*panel.x_limits)
    if panel.falling:
        ax.invert_yaxis()
    ax.set_xlabel(panel.x_label)
    ax.set_ylabel(panel.y_label)


def _add_legend(panel: Panel, ax: Axes) -> None:
    """Where the panel says, or beside many curves, or where there is room; none without labels."""
    labelled, _ = ax.get_legend_handles_labels()
    lines = 0
    for curve in panel.curves:
        lines += curve.style == "line" and curve.group is None
    if not labelled:
        return
    if panel.legend is not None:
        ax.legend(loc=panel.legend, ncols=panel.legend_columns)
    elif len(labelled) > INSIDE_CURVES or lines > INSIDE_LINES:
        ax.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    else:
        ax.legend()


def draw_panel(panel: Panel, folder: Path) -> list[Path]:
    """Write a panel as PNG and PDF; returns the paths."""
    stem = folder / panel.name
    return save_panel(partial(plot_panel, panel), panel.title, stem)


def save_panel(panel: Callable[[Axes], Axes], title: str, stem: Path) -> list[Path]:
    """Draw one panel with the project's style and write it as PNG and PDF."""
    paths = [stem.with_suffix(suffix) for suffix in (".png", ".pdf")]
    return [write_picture(panel, path, title=title) for path in paths]
