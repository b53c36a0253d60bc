"""Pictures of alignment indices: log10 GALI_k against log10 t, and the Lyapunov exponent. Nothing
is computed here.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.figures.drawing import plot_panel, save_panel
from symfpu.figures.panels import Curve, Panel

Axes = Any
FEW_DECADES = 0.5  # least height of the picture, for indices that stay where they are


def plot_alignment(found: AlignmentIndices, ax: Axes) -> Axes:
    """log10 GALI_k against log10 t, k = 2 .. vectors, with the fitted slopes in the legend; both logarithms to base 10."""
    ax = plot_panel(alignment_panel("gali", "alignment indices", found), ax)
    bottom, top = ax.get_ylim()
    ax.set_ylim(min(bottom, top - FEW_DECADES), top)
    ax.get_legend().set_title("slopes, last decades")
    return ax


def plot_lyapunov(found: AlignmentIndices, ax: Axes) -> Axes:
    """The estimate log|v(t)| / t of the maximal Lyapunov exponent against time: falls as log(t)/t
    on a torus.
    """
    positive = found.lyapunov > 0
    ax.loglog(found.times[positive], found.lyapunov[positive])
    ax.set_xlabel(r"$t$")
    ax.set_ylabel(r"$\log |v(t)| \,/\, t$")
    return ax


def draw_alignment(found: AlignmentIndices, folder: Path, stem: str = "gali") -> list[Path]:
    """Both pictures as PNG and PDF; returns the paths."""
    name = repr(found.chain)[6:-1]
    panels = {
        stem: (f"Alignment indices, {found.dimension().verdict}", plot_alignment),
        "lyapunov": ("Lyapunov exponent", plot_lyapunov),
    }
    return [
        path
        for panel, (title, draw) in panels.items()
        for path in save_panel(
            partial(draw, found),
            f"{title} ({name})",
            folder / (panel if panel == stem else f"{stem}-{panel}"),
        )
    ]


def alignment_panel(name: str, title: str, found: AlignmentIndices) -> Panel:
    """log10 G_k against log10 t."""
    curves = tuple(
        Curve(
            rf"$G_{{{s.k}}}$: ${s.value:.2f} \pm {s.error:.2f}$",
            np.log10(found.times),
            found.log10_gali[:, i],
            name=f"G_{s.k}",
        )
        for i, s in enumerate(found.slopes())
    )
    return Panel(
        name,
        title,
        r"$\log_{10} t$",
        r"$\log_{10} G_k$",
        curves,
        ("log10_t", "log10_G"),
        log_y=False,
    )
