"""Alignment indices with their fitted slopes, and the Lyapunov exponent."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from symfpu.action_angle.foretold import ForetoldIndices
from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.dynamics.dimension import DECADES
from symfpu.plots.legends import legend
from symfpu.plots.style import QUIET, Axes, axes_for, look, of_solution, require, subject

RINGS, RINGS_APART = 40, 5  # of an integrated index; those of neighbours between them
LEAST_HEIGHT_DECADES = 0.5  # of the picture, for indices that stay where they are
FORETOLD, FORETOLD_ADVICE = "foretold indices", "pass what foretold_indices gave"
WORDS, ADVICE = "alignment indices", "pass what alignment_indices gave"


def alignment(result: Any, ax: Axes | None = None) -> Axes:
    """log10 G_k against log10 t, k = 2, 3, ..., with fitted slopes (Figs. 1(e), 2(b), 9(d)).

    result : what `alignment_indices` gave; dimensionless (section 3.2). ax : axes of matplotlib;
        default new ones.

    Further frames are thin. A dashed line over the last decades has the fitted slope, which is
    in the legend with its uncertainty; the verdict is the title. Returns the axes. Raises
    InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, alignment_indices
    >>> found = alignment_indices(Chain(N=4, alpha=1), [0.1, 0, 0], [0, 0, 0], 1e3, vectors=2)
    >>> alignment(found, Figure().add_subplot()).get_xlabel()
    '$\\\\log_{10}\\\\, t$'
    """
    found = require(result, AlignmentIndices, WORDS, ADVICE)
    x = np.log10(found.times)
    late = x >= x[-1] - DECADES
    with axes_for(ax, subject(found.chain)) as axes:
        for i, slope in enumerate(found.slopes()):
            frames = np.array([one.log10_gali[:, i] for one in found.frames])
            y = frames.mean(axis=0)
            style = look(i) | {"marker": None}
            for others in frames[1:]:
                axes.plot(x, others, **style | {"lw": 0.5, "alpha": 0.5})
            fitted = rf"{slope.value:z.2f} \pm {slope.error:.2f}"
            axes.plot(x, frames[0], label=rf"$G_{{{slope.k}}}$: ${fitted}$", **style)
            line = y[late].mean() + slope.value * (x[late] - x[late].mean())
            axes.plot(x[late], line, color="black", ls=(0, (4, 3)), lw=0.9)
        bottom, top = axes.get_ylim()
        axes.set_ylim(min(bottom, top - LEAST_HEIGHT_DECADES), top)
        axes.set_xlabel(r"$\log_{10}\, t$")
        axes.set_ylabel(r"$\log_{10}\, G_k$")
        axes.set_title(found.dimension().verdict)
        legend(axes, title="slopes, last decades", most=0)
    return axes


def foretold(
    result: Any, ax: Axes | None = None, *, observed: AlignmentIndices | None = None
) -> Axes:
    """Alignment indices of a torus in closed form, and integrated ones as rings on them.

    result : what `foretold_indices` gave; dimensionless. Ours. ax : axes of matplotlib; default
        new ones. observed : what `alignment_indices` gave with the same frame; no line without.

    Triangles on the upper edge are the times from which G_k has the slope of the torus, which is
    in the legend; rings are some of the samples. Returns the axes. Raises InputError.

    >>> import symfpu
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, foretold_indices
    >>> found = foretold_indices(symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.4"}), 1e6)
    >>> foretold(found, Figure().add_subplot()).get_title()
    'regular, dimension 1'
    """
    found = require(result, ForetoldIndices, FORETOLD, FORETOLD_ADVICE)
    if observed is not None:
        require(observed, AlignmentIndices, WORDS, ADVICE)
    x = np.log10(found.times)
    settled = found.settling()
    with axes_for(ax, of_solution(found.torus)) as axes:
        for i, (k, slope) in enumerate(found.asymptotic_slopes.items()):
            style = look(i) | {"marker": None}
            label = rf"$G_{{{k}}} \to t^{{{slope}}}$"
            axes.plot(x, found.log10_gali[:, i], label=label, lw=1.0, **style)
            if observed is not None and k <= observed.vectors:
                _rings(axes, observed, i, style["color"])
        bottom, top = axes.get_ylim()
        top = max(top, 0.0)
        for i, time in enumerate(settled.values()):
            if math.isfinite(time):
                place = math.log10(time), top
                axes.plot(*place, marker="v", color=look(i)["color"], clip_on=False, ms=6)
        _name_marks(axes, rings=observed is not None, settled=settled.values())
        axes.set_ylim(bottom, top)
        axes.set_xlabel(r"$\log_{10}\, t$")
        axes.set_ylabel(r"$\log_{10}\, G_k$")
        axes.set_title(found.verdict)
        legend(axes, most=0)
    return axes


def _rings(axes: Axes, observed: AlignmentIndices, i: int, color: str) -> None:
    """One integrated index: so many rings that the curve below them is seen."""
    every = math.ceil(len(observed.times) / RINGS)
    some = slice(i * every // RINGS_APART % every, None, every)
    points = np.log10(observed.times)[some], observed.log10_gali[some, i]
    axes.plot(*points, ls="none", marker="o", ms=4, mfc="none", color=color)


def _name_marks(axes: Axes, *, rings: bool, settled: Iterable[float]) -> None:
    """What marks mean, in the legend, where there are any."""
    alike: dict[str, Any] = {"ls": "none", "color": QUIET}
    if rings:
        axes.plot([], [], marker="o", ms=4, mfc="none", label="integrated", **alike)
    if any(map(math.isfinite, settled)):
        axes.plot([], [], marker="v", ms=6, label="settled", **alike)


def lyapunov(result: Any, ax: Axes | None = None) -> Axes:
    """The estimate log|v(t)| / t of the maximal Lyapunov exponent against t.

    result : what `alignment_indices` gave; dimensionless (section 3.2). ax : axes of matplotlib;
        default new ones.

    On a torus it falls as log(t)/t, the dashed line through the last value. Returns the axes.
    Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, alignment_indices
    >>> found = alignment_indices(Chain(N=4, alpha=1), [0.1, 0, 0], [0, 0, 0], 1e3, vectors=2)
    >>> lyapunov(found, Figure().add_subplot()).get_xscale()
    'log'
    """
    found = require(result, AlignmentIndices, WORDS, ADVICE)
    positive = found.lyapunov > 0
    times, estimates = found.times[positive], found.lyapunov[positive]
    with axes_for(ax, subject(found.chain)) as axes:
        axes.loglog(times, estimates, color="C0", label="estimate")
        late = times > math.e
        if late.any():
            law = np.log(times[late]) / times[late]
            through = law * estimates[-1] / law[-1]
            axes.loglog(times[late], through, "k--", lw=0.9, label=r"$\propto \log(t)/t$")
        axes.set_xlabel("$t$")
        axes.set_ylabel(r"$\log |v(t)| \,/\, t$")
        legend(axes)
    return axes
