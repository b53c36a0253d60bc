"""Pictures of alignment indices as files, and log10 GALI_k against log10 t as a panel."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.figures.drawing import save_panel
from symfpu.figures.panels import Curve, Panel
from symfpu.plots.indices import alignment, lyapunov

Floats = NDArray[np.float64]
Curves = tuple[Floats, Floats]
ABOVE, TOP = (
    0.25,
    1.25,
)  # of all indices, which are at most 0: where a word is written, and room


def draw_alignment(found: AlignmentIndices, folder: Path, stem: str = "gali") -> list[Path]:
    """Both pictures as PNG and PDF; returns the paths."""
    chain = found.chain.label
    verdict = found.dimension().verdict
    indices = partial(alignment, found)
    exponent = partial(lyapunov, found)
    paths = save_panel(indices, f"Alignment indices, {verdict} ({chain})", folder / stem)
    beside = folder / f"{stem}-lyapunov"
    paths += save_panel(exponent, f"Lyapunov exponent ({chain})", beside)
    return paths


def alignment_panel(
    name: str,
    title: str,
    found: AlignmentIndices,
    beyond: Curves | None = None,
) -> Panel:
    """log10 G_k against log10 t.

    beyond : times (S,) and log10 G_k (S, vectors-1) that are foretold, drawn dotted and shaded from
    the end of what was integrated on.
    """
    log_times = np.log10(found.times)
    curves = []
    for i, slope in enumerate(found.slopes()):
        fitted = rf"{slope.value:.2f} \pm {slope.error:.2f}"
        label = rf"$G_{{{slope.k}}}$: ${fitted}$"
        log_index = found.log10_gali[:, i]
        curves.append(Curve(label, log_times, log_index, name=f"G_{slope.k}"))
    if beyond is not None:
        curves += _foretold_curves(float(found.times[-1]), *beyond)
    labels = (r"$\log_{10} t$", r"$\log_{10} G_k$")
    axes = ("log10_t", "log10_G")
    top = None if beyond is None else TOP
    return Panel(name, title, *labels, tuple(curves), axes, log_y=False, top=top)


def _foretold_curves(last: float, times: Floats, log10_gali: Floats) -> Iterator[Curve]:
    """From the end of the integration on, after the span that they are drawn in."""
    later = times > last
    x = np.log10(times[later])
    y = log10_gali[later]
    above = np.full(2, ABOVE)
    yield Curve("foretold", x[[0, -1]], above, "span", name="foretold from")
    for i, values in enumerate(y.T):
        yield Curve("", x, values, "dotted", name=f"G_{i + 2} foretold", group=i)
