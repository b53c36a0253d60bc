"""Gaps of Toda's spectral curve: of a state, and along an orbit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from symfpu.errors import InputError
from symfpu.integrable.invariants import TodaInvariants
from symfpu.numbers.arithmetic import DOUBLES
from symfpu.numbers.typed import decimal
from symfpu.plots.legends import legend
from symfpu.plots.style import (
    EPS,
    MARKERS,
    Axes,
    Floats,
    axes_for,
    even,
    rounding_below,
    whole_numbers,
)

ROUNDING = 8 * EPS  # of a gap in doubles, absolute
FEW = 6  # modes that stand in a legend; of more the colour is the mode
ADVICE = "pass what toda_gaps or toda_invariants gave"


def toda_gaps(
    result: Any,
    ax: Axes | None = None,
    *,
    times: ArrayLike | None = None,
    modes: Sequence[int] | None = None,
) -> Axes:
    """Gaps of Toda's spectral curve by mode, or along an orbit: constant if it is Toda's.

    result : what `toda_gaps` gave, (N-1,) of a state or (T, N-1) of an orbit, or what
        `toda_invariants` gave. Dimensionless. Ours, after Flaschka.
    ax : axes of matplotlib; default new ones. times : (T,), of the states of an orbit.
    modes : q of the gaps in their order, (N-1,); default 1 .. N-1. On a ring pass
        `chain.mode_numbers`.

    In doubles gaps below some 1e-15 are rounding, and shaded. Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, toda_invariants
    >>> found = toda_invariants(Chain(4, alpha="1/2"), [0.1, 0, 0], [0, 0, 0.02])
    >>> toda_gaps(found, Figure().add_subplot()).get_xlabel()
    '$q$'
    """
    gaps, doubles = _gaps(result)
    if (gaps.ndim == 2) != (times is not None):
        given = f"gaps of shape {gaps.shape}"
        allowed = "(N-1,) without times, or (T, N-1) with T times"
        raise InputError("times", given, allowed, ADVICE)
    q = _numbers(modes, gaps.shape[-1])
    with axes_for(ax, _subject(result)) as axes:
        if times is None:
            _draw_state(axes, gaps, q)
        else:
            _draw_orbit(axes, gaps, q, _checked(times, len(gaps)))
        axes.set_ylabel("gap")
        if doubles:
            rounding_below(axes, ROUNDING)
        legend(axes, most=0)
    return axes


def _subject(result: Any) -> str:
    """Of a state; an array does not say of which chain it is."""
    if not isinstance(result, TodaInvariants):
        return ""
    return f"N={result.N}, Toda's chain of a={decimal(result.a)}"


def _gaps(result: Any) -> tuple[Floats, bool]:
    """Gaps as doubles, and whether they were."""
    values = result.gaps if isinstance(result, TodaInvariants) else result
    if not isinstance(values, np.ndarray) or values.ndim not in (1, 2) or not values.size:
        given = type(result).__name__
        raise InputError("result", given, "gaps by mode, (N-1,) or (T, N-1)", ADVICE)
    return values.astype(float), values.dtype != object


def _numbers(modes: Sequence[int] | None, count: int) -> Any:
    """The mode of every gap, (N-1,)."""
    q = np.arange(1, count + 1) if modes is None else np.asarray(modes)
    if q.shape != (count,) or q.dtype.kind != "i" or len(set(q.tolist())) < count:
        allowed = f"{count} different whole numbers"
        raise InputError(
            "modes", modes, allowed, "pass chain.mode_numbers, or leave it out"
        )
    return q


def _checked(times: ArrayLike, count: int) -> Floats:
    t = DOUBLES.array(times)
    if t.shape != (count,):
        raise InputError("times", t.shape, f"shape ({count},)", "one for each state")
    return t


def _draw_state(axes: Axes, gaps: Floats, q: Any) -> None:
    seen = gaps > 0
    axes.plot(q[seen], gaps[seen], "o", color="C0")
    axes.set_yscale("log")
    bottom = axes.get_ylim()[0]
    axes.vlines(q[seen], bottom, gaps[seen], color="C0", lw=0.8, alpha=0.6)
    axes.set_ylim(bottom, 4 * gaps.max())
    axes.set_xlim(q.min() - 0.5, q.max() + 0.5)
    whole_numbers(axes.xaxis)
    axes.set_xlabel("$q$")


def _draw_orbit(axes: Axes, gaps: Floats, q: Any, times: Floats) -> None:
    import matplotlib as mpl

    count = gaps.shape[1]
    positive = times > 0
    uneven = not even(times)
    shown = positive if uneven else slice(None)
    scale = mpl.cm.ScalarMappable(mpl.colors.Normalize(q.min(), q.max()), "viridis")
    for i in range(count):
        few = {"color": f"C{i % 5}", "label": f"$q = {q[i]}$", "marker": MARKERS[i % 9]}
        many = {"color": scale.to_rgba(q[i])}
        style = few | {"markevery": max(1, len(times) // 10)} if count <= FEW else many
        axes.plot(times[shown], gaps[shown, i], **style)
    axes.set_yscale("log")
    if uneven:
        axes.set_xscale("log")
    axes.set_xlabel("$t$")
    if count > FEW:
        axes.figure.colorbar(scale, ax=axes, label="$q$")
