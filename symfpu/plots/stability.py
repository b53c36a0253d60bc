"""Floquet multipliers on the unit circle."""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.breathers.floquet import (
    DOUBLING,
    ELLIPTIC,
    QUADRUPLE,
    TANGENT,
    TRIVIAL,
    Floquet,
)
from symfpu.plots.legends import leave_room_beside, legend
from symfpu.plots.style import QUIET, Axes, axes_for, of_solution, require

LARGEST_SHOWN = 3.0  # modulus; larger multipliers stand at the edge with their number
BEYOND = 1 + 1e-9  # times the edge, from which a multiplier is beyond it
LOOKS = {
    TRIVIAL: {"marker": "s", "color": "C4", "mfc": "none", "ms": 9},
    ELLIPTIC: {"marker": "o", "color": "C0", "ms": 5},
    TANGENT: {"marker": "D", "color": "C1", "ms": 7},
    DOUBLING: {"marker": "v", "color": "C1", "ms": 8},
    QUADRUPLE: {"marker": "P", "color": "C1", "ms": 8},
}


def multipliers(result: Any, ax: Axes | None = None) -> Axes:
    """Floquet multipliers in the complex plane, with the unit circle; markers say their kind.

    result : what `floquet` gave; dimensionless. Ours. ax : axes of matplotlib; default new ones.

    Multipliers beyond a modulus of three stand at the edge, with their number. Returns the axes.
    Raises InputError.

    >>> import symfpu
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, floquet
    >>> found = floquet(symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.1"}))
    >>> multipliers(found, Figure().add_subplot()).get_title()
    'stable'
    """
    found = require(result, Floquet, "Floquet multipliers", "pass what floquet gave")
    kinds = np.array(found.kinds)
    reach = min(LARGEST_SHOWN, found.largest)
    with axes_for(ax, of_solution(found.orbit)) as axes:
        turn = np.linspace(0, 2 * np.pi, 361)
        axes.plot(np.cos(turn), np.sin(turn), color=QUIET, lw=0.8, zorder=0)
        for kind, style in LOOKS.items():
            of_kind = found.pairs[kinds == kind].reshape(-1)
            if len(of_kind):
                shown = _within(of_kind, reach)
                label = f"{kind}: {len(of_kind)}"
                axes.plot(shown.real, shown.imag, ls="none", label=label, **style)
        _name_far(axes, found, reach)
        edge = 1.18 * reach
        axes.set_xlim(-edge, edge)
        axes.set_ylim(-edge, edge)
        axes.set_aspect("equal")
        axes.set_xlabel(r"$\mathrm{Re}\,\lambda$")
        axes.set_ylabel(r"$\mathrm{Im}\,\lambda$")
        verdict = (
            "stable"
            if found.stable
            else f"unstable: $|\\lambda|$ up to {found.largest:.4g}"
        )
        axes.set_title(verdict)
        leave_room_beside(axes, "compressed")
        legend(axes, first="center")
    return axes


def _within(values: Any, reach: float) -> Any:
    """The multipliers, those beyond the reach moved to its edge."""
    sizes = np.abs(values)
    beyond = sizes > reach * BEYOND
    return np.where(beyond, values / sizes * reach, values)


def _name_far(axes: Axes, found: Floquet, reach: float) -> None:
    for value in found.pairs[:, 0]:
        if abs(value) > reach * BEYOND:
            at = value / abs(value) * reach
            style = {"textcoords": "offset points", "ha": "center", "fontsize": "small"}
            number = f"$|\\lambda|$ = {abs(value):.3g}"
            axes.annotate(number, (at.real, at.imag), xytext=(0, 10), **style)
