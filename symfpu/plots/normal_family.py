"""Normal frequencies along a line of tori, with their events."""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.families.normal_events import STABILITY
from symfpu.families.normal_family import NormalFamily
from symfpu.plots.style import QUIET, Axes, axes_for, require
from symfpu.tori.quasiperiodic import amplitudes_of


def family_normal_frequencies(result: Any, ax: Axes | None = None) -> Axes:
    """Shifts sigma_q - Omega_q along a line of tori, by the amplitude that changes most.

    result : what `normal_family` gave; dimensionless. Ours. ax : axes of matplotlib; default new
        ones.

    Elliptic directions have full marks, hyperbolic ones, of which the real part is shown, empty
    diamonds; vertical lines are events: broken where stability changes, dotted
    where a resonance is crossed. Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, breather_at_amplitude, normal_family
    >>> breather = breather_at_amplitude(Chain(N=4, beta=1), 2, "0.1")
    >>> found = normal_family(breather, {2: "0.2"}, members=2)
    >>> family_normal_frequencies(found, Figure().add_subplot()).get_title()
    '2 tori, stable'
    """
    advice = "pass what symfpu.normal_family gave"
    found = require(result, NormalFamily, "normal frequencies of a line of tori", advice)
    linear = found.members[0].torus.chain.frequencies()
    seed, x = _axis(found)
    with axes_for(ax) as axes:
        for place, mode in enumerate(found.members[0].modes):
            q = mode.mode
            sigma = np.array([complex(m.modes[place].sigma) for m in found.members])
            _line(axes, x, sigma - linear[q - 1], f"$q={q}$")
        for event in found.events:
            style = "--" if event.kind == STABILITY else ":"
            axes.axvline(event.amplitudes[seed], color=QUIET, ls=style, lw=1, zorder=0)
        axes.set_xlabel(f"$A_{{{seed}}}$")
        axes.set_ylabel(r"$\mathrm{Re}\,\sigma_q - \Omega_q$")
        axes.set_title(f"{len(found.members)} tori, {found.verdict}")
        axes.legend()
    return axes


def _axis(found: NormalFamily) -> tuple[int, Any]:
    """The seed whose amplitude changes most, and that amplitude along the line."""
    rows = [amplitudes_of(member.torus) for member in found.members]
    seed = max(rows[0], key=lambda q: abs(float(rows[-1][q]) - float(rows[0][q])))
    return seed, np.array([float(row[seed]) for row in rows])


def _line(axes: Axes, x: Any, shift: Any, label: str) -> None:
    """One mode: a curve, and marks where tori are."""
    unstable = shift.imag != 0
    (curve,) = axes.plot(x, shift.real, label=label)
    alike = {"color": curve.get_color(), "ls": "none"}
    axes.plot(x[~unstable], shift.real[~unstable], marker="o", ms=4, **alike)
    empty = {"marker": "D", "ms": 8, "mfc": "none"}
    axes.plot(x[unstable], shift.real[unstable], **empty, **alike)
