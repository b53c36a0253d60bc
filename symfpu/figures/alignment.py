"""Pictures of alignment indices as files, and log10 GALI_k against log10 t as a panel."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.figures.drawing import save_panel
from symfpu.figures.panels import Curve, Panel
from symfpu.plots.indices import alignment, lyapunov


def draw_alignment(found: AlignmentIndices, folder: Path, stem: str = "gali") -> list[Path]:
    """Both pictures as PNG and PDF; returns the paths."""
    chain = repr(found.chain)[6:-1]
    verdict = found.dimension().verdict
    indices = partial(alignment, found)
    exponent = partial(lyapunov, found)
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
