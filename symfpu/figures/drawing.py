"""Pictures from results: functions take axes and return them; nothing is computed here.
Matplotlib is loaded when needed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.figures.panels import Panel

Floats = NDArray[np.float64]
Axes = Any
# with more of them, or of lines among them, the legend goes beside the picture
FEW_CURVES, FEW_LINES = 5, 3

CURVE_STYLES: Mapping[str, dict[str, Any]] = {
    "line": {"lw": 1.2},
    "points": {"marker": "o", "ls": "none", "ms": 7, "alpha": 0.8},
    "dots": {"marker": ".", "ls": "none", "ms": 4},
    "triangles": {"marker": "^", "ls": "none", "ms": 7},
    "rings": {"marker": "o", "ls": "none", "ms": 9, "mfc": "none"},
    "law": {"ls": "--", "lw": 1.2},
}


def plot_spectrum(
    spectrum: Floats, ax: Axes, *, label: str = "", marker: str = "o", floor: Floats | float = 0.0
) -> Axes:
    """Normalised average energies of the modes against q, on a logarithmic scale; spectrum (N-1,).

    floor : in the unit of the spectrum, (N-1,) or one for all, as from `spectrum_floor`; modes at
    or below it are not drawn.
    """
    q = np.arange(1, len(spectrum) + 1)
    known = spectrum > floor
    ax.semilogy(q[known], spectrum[known], marker=marker, label=label)
    ax.set_xlabel(r"$q$")
    ax.set_ylabel(r"$\overline{E}_q / E$")
    return ax


def plot_panel(panel: Panel, ax: Axes) -> Axes:
    """A panel of curves; of points that lie on each other the first ones are the largest."""
    for i, curve in enumerate(panel.curves):
        shown = (
            np.isfinite(curve.x)
            & np.isfinite(curve.y)
            & ((curve.x > 0) | (not panel.log_x))
            & ((curve.y > 0) | (not panel.log_y))
        )
        look = dict(CURVE_STYLES[curve.style])
        if look.get("marker"):
            look["ms"] *= 1 - 0.5 * i / len(panel.curves)
        color = (
            "black"
            if curve.style == "law"
            else f"C{(i if curve.group is None else curve.group) % 5}"
        )
        known = curve.group is not None and curve.group in [
            earlier.group for earlier in panel.curves[:i]
        ]
        if curve.style == "line" and curve.group is None and i >= FEW_CURVES:
            look["ls"] = "--"  # colours come round
        ax.plot(
            curve.x[shown],
            curve.y[shown],
            color=color,
            label=None if known else curve.label,
            **look,
        )
    ax.set_xscale("log" if panel.log_x else "linear")
    ax.set_yscale("log" if panel.log_y else "linear")
    if panel.bottom is not None:
        ax.set_ylim(bottom=panel.bottom)
    ax.set_xlabel(panel.x_label)
    ax.set_ylabel(panel.y_label)
    lines = sum(curve.style == "line" and curve.group is None for curve in panel.curves)
    many = len(ax.get_legend_handles_labels()[0]) > FEW_CURVES or lines > FEW_LINES
    ax.legend(
        **(
            {"fontsize": "small", "loc": "center left", "bbox_to_anchor": (1.0, 0.5)}
            if many
            else {}
        )
    )
    return ax


def save_panel(panel: Callable[[Axes], Axes], title: str, stem: Path) -> list[Path]:
    """Draw one panel with the project's style and write it as PNG and PDF."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with (
        as_file(files("symfpu.figures") / "symfpu.mplstyle") as style,
        mpl.rc_context(mpl.rc_params_from_file(style, use_default_template=False)),
    ):
        figure = Figure()
        panel(figure.add_subplot()).set_title(title)
        paths = [stem.with_suffix(".png"), stem.with_suffix(".pdf")]
        for path in paths:
            figure.savefig(path, metadata={"CreationDate": None} if path.suffix == ".pdf" else None)
    return paths
