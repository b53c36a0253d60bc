"""Lines of the spectrum of an orbit, and how their frequencies drift."""

from __future__ import annotations

import numpy as np

from symfpu.errors import InputError
from symfpu.plots.legends import legend
from symfpu.plots.style import MARK, QUIET, Axes, axes_for, subject
from symfpu.spectral.analysis import FrequencyAnalysis, SpectralLine


def lines(result: FrequencyAnalysis, ax: Axes | None = None) -> Axes:
    """The lines of an orbit: amplitude against frequency, independent frequencies marked.

    result : of `frequency_analysis`; frequencies and amplitudes dimensionless. The linear
    frequencies Omega_q are the ticks at the top; an open circle is a line that is no combination
    beyond accident. Ours.
    ax : axes of matplotlib; default new ones. Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, frequency_analysis, integrate
    >>> found = frequency_analysis(integrate(Chain(N=2, beta=1), [0.2], [0.0], 200, step=0.1))
    >>> lines(found, Figure().add_subplot()).get_xlabel()
    'frequency $f$'
    """
    if not isinstance(result, FrequencyAnalysis):
        advice = "make one with frequency_analysis"
        raise InputError("result", result, "a FrequencyAnalysis", advice)
    moving = [line for line in result.lines if line.frequency > 0]
    with axes_for(ax, subject(result.chain)) as axes:
        axes.set_yscale("log")
        _draw(axes, [x for x in moving if not _is_independent(x)], QUIET, None)
        marked = [x for x in moving if _is_independent(x)]
        _draw(axes, marked, MARK, "independent")
        unknown = [x for x in moving if x.harmonic is None]
        _circle(axes, unknown)
        for Omega in result.chain.frequencies():
            axes.axvline(Omega, 0.97, 1.0, color="0.2", linewidth=0.8)
        axes.set_xlabel(r"frequency $f$")
        axes.set_ylabel(r"amplitude in $Q_q$")
        legend(axes)
    return axes


def _is_independent(line: SpectralLine) -> bool:
    nu = line.harmonic
    return nu is not None and sum(map(abs, nu)) == 1


def _draw(axes: Axes, chosen: list[SpectralLine], colour: str, label: str | None) -> None:
    frequencies = np.array([line.frequency for line in chosen])
    amplitudes = np.array([line.amplitude for line in chosen])
    axes.plot(frequencies, amplitudes, "o", color=colour, markersize=3, label=label)


def _circle(axes: Axes, unknown: list[SpectralLine]) -> None:
    if not unknown:
        return
    frequencies = [line.frequency for line in unknown]
    amplitudes = [line.amplitude for line in unknown]
    axes.plot(
        frequencies, amplitudes, "o", color=MARK, fillstyle="none", label="unidentified"
    )
