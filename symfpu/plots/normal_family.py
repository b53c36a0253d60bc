"""Normal frequencies along a line or a family of tori, with their events."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from symfpu.families.family import Family
from symfpu.families.normal_events import STABILITY, NormalEvent
from symfpu.families.normal_family import NormalFamily
from symfpu.numbers.counted import counted
from symfpu.plots.legends import legend
from symfpu.plots.style import QUIET, Axes, axes_for, look, require, subject
from symfpu.tori.torus import Torus


class _Row(NamedTuple):
    """One torus, and its normal frequencies by mode."""

    torus: Torus
    sigma: Mapping[int, complex]

    @property
    def stable(self) -> bool:
        """Whether all that are known are elliptic."""
        return not any(complex(w).imag for w in self.sigma.values())


def family_normal_frequencies(result: Any, ax: Axes | None = None) -> Axes:
    """Shifts sigma_q - Omega_q along a line or a family, by the amplitude that changes most.

    result : what `normal_family` gave, or `family` with normal=True; dimensionless. Ours. ax :
        axes of matplotlib; default new ones.

    Elliptic directions have full marks, hyperbolic ones, of which the real part is shown, empty
    diamonds; vertical lines are events: broken where stability changes, dotted
    where a resonance is crossed. Returns the axes. Raises InputError.

    >>> import symfpu
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, normal_family
    >>> breather = symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.1"})
    >>> found = normal_family(breather, {2: "0.2"}, members=2)
    >>> family_normal_frequencies(found, Figure().add_subplot()).get_title()
    '2 tori, stable'
    """
    rows, events = _rows(result)
    chain = rows[0].torus.chain
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    seed, x = _axis(rows)
    unstable = sum(not row.stable for row in rows)
    verdict = f"{unstable} of them unstable" if unstable else "stable"
    with axes_for(ax, subject(chain, rows[0].torus.seeds)) as axes:
        for i, q in enumerate(rows[0].sigma):
            sigma = np.array([complex(row.sigma.get(q, np.nan)) for row in rows])
            _line(axes, x, sigma - linear[q], look(i), f"$q={q}$")
        for event in events:
            style = "--" if event.kind == STABILITY else ":"
            axes.axvline(event.amplitudes[seed], color=QUIET, ls=style, lw=1, zorder=0)
        axes.set_xlabel(f"$A_{{{seed}}}$")
        axes.set_ylabel(r"$\mathrm{Re}\,\sigma_q - \Omega_q$")
        axes.set_title(f"{counted(len(rows), 'torus', 'tori')}, {verdict}")
        legend(axes)
    return axes


def _rows(result: Any) -> tuple[list[_Row], tuple[NormalEvent, ...]]:
    """The members whose normal frequencies are known, and the events."""
    if isinstance(result, Family) and any(m.normal for m in result.members):
        known = [m.normal for m in result.members if m.normal]
        return [_Row(one.torus, one.frequencies) for one in known], result.normal_events
    advice = "pass what symfpu.normal_family gave, or symfpu.family with normal=True"
    found = require(result, NormalFamily, "normal frequencies of a family of tori", advice)
    return [_Row(one.torus, one.frequencies) for one in found.members], found.events


def _axis(rows: list[_Row]) -> tuple[int, Any]:
    """The seed whose amplitude changes most, and that amplitude along the way."""
    known = [row.torus.amplitudes for row in rows]
    seed = max(known[0], key=lambda q: abs(float(known[-1][q]) - float(known[0][q])))
    return seed, np.array([float(row[seed]) for row in known])


def _line(axes: Axes, x: Any, shift: Any, style: Mapping[str, Any], label: str) -> None:
    """One mode: a curve, and marks where tori are."""
    unstable = shift.imag != 0
    elliptic = [int(i) for i in np.flatnonzero(~unstable)]
    axes.plot(x, shift.real, label=label, ms=4, markevery=elliptic, **style)
    alike = {"color": style["color"], "ls": "none"}
    empty = {"marker": "D", "ms": 8, "mfc": "none"}
    axes.plot(x[unstable], shift.real[unstable], **empty, **alike)
