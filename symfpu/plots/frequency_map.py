"""Frequencies of FPU-trajectories by their energy, and how much they drift."""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.plots.legends import legend
from symfpu.plots.style import MARK, QUIET, Axes, axes_for, look, require, subject
from symfpu.spectral.mapping import FrequencyMap

ADVICE = "make one with frequency_map"
WORDS = "a FrequencyMap"
SMALLEST_SHIFT = 1e-9
LOW_QUANTILE = 0.05


def frequency_map(result: FrequencyMap, ax: Axes | None = None) -> Axes:
    """Shifts omega_q/Omega_q - 1 of the independent frequencies above the level, by the energy.

    result : what `frequency_map` gave; dimensionless. Ours. ax : axes of matplotlib; default new
        ones.

    A curve a mode, the axis even about 0 and logarithmic beyond; the numbers along the top say
    how many independent frequencies are above the level: of two whose strongest lines are in one
    mode its curve has the stronger. Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain
    >>> from symfpu.spectral.mapping import frequency_map as found
    >>> made = found(Chain(N=4, beta=1), ("0.01", "0.1"), T=500, step=0.1)
    >>> frequency_map(made, Figure().add_subplot()).get_xlabel()
    'energy $H$'
    """
    found = require(result, FrequencyMap, WORDS, ADVICE)
    shifts = found.shifts()
    with axes_for(ax, subject(found.chain, found.packet)) as axes:
        axes.set_xscale("log")
        axes.set_yscale("symlog", linthresh=_least(shifts))
        axes.axhline(0.0, color=QUIET, lw=0.8, zorder=0)
        shown = [q for q in found.chain.mode_numbers if np.isfinite(shifts[:, q - 1]).any()]
        for i, q in enumerate(shown):
            style = look(i) | {"ms": 3, "label": f"$q={q}$"}
            axes.plot(found.energies, shifts[:, q - 1], **style)
        _say_counts(axes, found)
        axes.set_xlabel("energy $H$")
        axes.set_ylabel(r"$\omega_q / \Omega_q - 1$")
        legend(axes)
    return axes


def _least(shifts: Any) -> float:
    """The size below which the axis is even: a power of ten below most shifts."""
    sizes = np.abs(shifts[~np.isnan(shifts) & (shifts != 0)])
    if not sizes.size:
        return SMALLEST_SHIFT
    low = float(np.quantile(sizes, LOW_QUANTILE))
    return max(SMALLEST_SHIFT, float(10.0 ** np.floor(np.log10(low))))


def _say_counts(axes: Axes, found: FrequencyMap) -> None:
    for energy, count in zip(found.energies, found.counts, strict=True):
        axes.annotate(
            str(count),
            xy=(energy, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(0, 2),
            textcoords="offset points",
            ha="center",
            color=QUIET,
            fontsize="small",
        )


def frequency_drift(result: FrequencyMap, ax: Axes | None = None) -> Axes:
    """Largest relative change of a frequency between the halves of each orbit, by the energy.

    result : what `frequency_map` gave; dimensionless. Ours. ax : axes of matplotlib; default new
        ones. Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain
    >>> from symfpu.spectral.mapping import frequency_map as found
    >>> made = found(Chain(N=4, beta=1), ("0.01", "0.1"), T=500, step=0.1)
    >>> frequency_drift(made, Figure().add_subplot()).get_yscale()
    'log'
    """
    found = require(result, FrequencyMap, WORDS, ADVICE)
    with axes_for(ax, subject(found.chain, found.packet)) as axes:
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.plot(found.energies, found.drifts, "o-", color=MARK, markersize=3)
        axes.set_xlabel("energy $H$")
        axes.set_ylabel(rf"drift $|\Delta\omega|/\omega$ over $T$ = {found.T:,.0f}")
    return axes
