"""Normal frequencies of a torus, by mode."""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.normal.modes import ELLIPTIC, HYPERBOLIC, NormalModes
from symfpu.plots.legends import legend
from symfpu.plots.style import QUIET, Axes, axes_for, of_solution, require, whole_numbers

LOOKS = {
    ELLIPTIC: {"marker": "o", "color": "C0", "ms": 5},
    HYPERBOLIC: {"marker": "D", "color": "C1", "ms": 7},
}


def normal_frequencies(result: Any, ax: Axes | None = None) -> Axes:
    """Shifts sigma_q - Omega_q of the normal frequencies by mode; markers say their kind.

    result : what `normal_modes` gave; dimensionless. Ours. ax : axes of matplotlib; default new
        ones.

    Of hyperbolic modes the real part is shown; the title has the rate of growth. Crosses are the
    closed shifts of second order, with fixed ends. Returns the axes. Raises InputError.

    >>> import symfpu
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, normal_modes
    >>> found = normal_modes(symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.1"}))
    >>> normal_frequencies(found, Figure().add_subplot()).get_title()
    'stable'
    """
    found = require(result, NormalModes, "normal modes", "pass what normal_modes gave")
    chain = found.torus.chain
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    with axes_for(ax, of_solution(found.torus)) as axes:
        for kind, style in LOOKS.items():
            modes = [mode for mode in found.modes if mode.kind == kind]
            if modes:
                q = np.array([mode.mode for mode in modes])
                sigma = np.array([complex(mode.sigma).real for mode in modes])
                label = f"{kind}: {len(modes)}"
                shifts = sigma - [linear[mode.mode] for mode in modes]
                axes.plot(q, shifts, ls="none", label=label, **style)
        if chain.ends == "fixed":
            closed = [guess - linear[q] for q, guess in found.guesses.items()]
            cross = {"marker": "x", "color": QUIET, "ms": 7, "zorder": 0}
            axes.plot(list(found.guesses), closed, ls="none", label="second order", **cross)
        whole_numbers(axes.xaxis)
        axes.set_xlabel(r"$q$")
        axes.set_ylabel(r"$\mathrm{Re}\,\sigma_q - \Omega_q$")
        axes.set_title(found.verdict)
        legend(axes)
    return axes
