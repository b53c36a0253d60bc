"""Pictures of alignment indices: log10 GALI_k against log10 t, and the Lyapunov exponent.

Nothing is computed here.
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
LEAST_HEIGHT_DECADES = 0.5  # of the picture, for indices that stay where they are


def plot_alignment(found: AlignmentIndices, ax: Axes) -> Axes:
    """log10 GALI_k against log10 t for k = 2, 3, ..., with the fitted slopes in the legend.

    Both logarithms are to base 10.
    """
    panel = alignment_panel("gali", "alignment indices", found)
    ax = plot_panel(panel, ax)
    bottom, top = ax.get_ylim()
    highest_bottom = top - LEAST_HEIGHT_DECADES
    ax.set_ylim(min(bottom, highest_bottom), top)
    ax.get_legend().set_title("slopes, last decades")
    return ax


def plot_lyapunov(found: AlignmentIndices, ax: Axes) -> Axes:
    """The estimate log|v(t)| / t of the maximal Lyapunov exponent against time.

    Falls as log(t)/t on a torus.
    """
    positive = found.lyapunov > 0
    times = found.times[positive]
    ax.loglog(times, found.lyapunov[positive])
    ax.set_xlabel(r"$t$")
    ax.set_ylabel(r"$\log |v(t)| \,/\, t$")
    return ax


def draw_alignment(found: AlignmentIndices, folder: Path, stem: str = "gali") -> list[Path]:
    """Both pictures as PNG and PDF; returns the paths."""
    chain = repr(found.chain)[6:-1]
    verdict = found.dimension().verdict
    indices = partial(plot_alignment, found)
    exponent = partial(plot_lyapunov, found)
    paths = save_panel(indices, f"Alignment indices, {verdict} ({chain})", folder / stem)
    beside = folder / f"{stem}-lyapunov"
    paths += save_panel(exponent, f"Lyapunov exponent ({chain})", beside)
    return paths


def alignment_panel(name: str, title: str, found: AlignmentIndices) -> Panel:
    """log10 G_k against log10 t."""
    log_times = np.log10(found.times)
    curves = []
    for i, slope in enumerate(found.slopes()):
        fitted = rf"{slope.value:.2f} \pm {slope.error:.2f}"
        label = rf"$G_{{{slope.k}}}$: ${fitted}$"
        log_index = found.log10_gali[:, i]
        curves.append(Curve(label, log_times, log_index, name=f"G_{slope.k}"))
    labels = (r"$\log_{10} t$", r"$\log_{10} G_k$")
    axes = ("log10_t", "log10_G")
    return Panel(name, title, *labels, tuple(curves), axes, log_y=False)
