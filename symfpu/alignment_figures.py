"""Pictures of alignment indices: log10 GALI_k against log10 t, and the Lyapunov exponent. Nothing is computed here."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.figures import save_panel

Axes = Any
STYLES = ("-", "--", ":")  # the project's colours come round after five curves
FEW_DECADES = 0.5  # least height of the picture, for indices that stay where they are


def plot_alignment(found: AlignmentIndices, ax: Axes) -> Axes:
    """log10 GALI_k against log10 t, k = 2 .. vectors, with the fitted slopes in the legend; both logarithms to base 10."""
    for i, slope in enumerate(found.slopes()):
        label = rf"$G_{{{slope.k}}}$: ${slope.value:.2f} \pm {slope.error:.2f}$"
        ax.plot(np.log10(found.times), found.log10_gali[:, i], STYLES[i // 5 % len(STYLES)], color=f"C{i % 5}", lw=1.2, label=label)
    bottom, top = ax.get_ylim()
    ax.set_ylim(min(bottom, top - FEW_DECADES), top)
    ax.set_xlabel(r"$\log_{10} t$")
    ax.set_ylabel(r"$\log_{10} G_k$")
    ax.legend(title="slopes, last decades", loc="lower left", fontsize="small")
    return ax


def plot_lyapunov(found: AlignmentIndices, ax: Axes) -> Axes:
    """The estimate log|v(t)| / t of the maximal Lyapunov exponent against time: falls as log(t)/t on a torus."""
    positive = found.lyapunov > 0
    ax.loglog(found.times[positive], found.lyapunov[positive])
    ax.set_xlabel(r"$t$")
    ax.set_ylabel(r"$\log |v(t)| \,/\, t$")
    return ax


def draw_alignment(found: AlignmentIndices, folder: Path, stem: str = "gali") -> list[Path]:
    """Both pictures as PNG and PDF; returns the paths."""
    name = repr(found.chain)[6:-1]
    panels = {stem: (f"Alignment indices, {found.dimension().verdict}", plot_alignment), "lyapunov": ("Lyapunov exponent", plot_lyapunov)}
    return [
        path
        for panel, (title, draw) in panels.items()
        for path in save_panel(partial(draw, found), f"{title} ({name})", folder / (panel if panel == stem else f"{stem}-{panel}"))
    ]
