"""The picture that one expects of each kind of result: what its `plot()` draws."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from symfpu.action_angle.foretold import ForetoldIndices
from symfpu.borders.atlas import Atlas
from symfpu.breathers.floquet import Floquet
from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.dynamics.orbits import Orbit
from symfpu.families.family import Family
from symfpu.families.normal_family import NormalFamily
from symfpu.integrable.invariants import TodaInvariants
from symfpu.normal.modes import NormalModes
from symfpu.plots.atlas import atlas_borders
from symfpu.plots.families import family_frequencies
from symfpu.plots.frequency_map import frequency_map
from symfpu.plots.indices import alignment, foretold
from symfpu.plots.lines import lines
from symfpu.plots.motion import time_series
from symfpu.plots.normal import normal_frequencies
from symfpu.plots.normal_family import family_normal_frequencies
from symfpu.plots.rule import propagation
from symfpu.plots.series import amplitudes, residuals, small_divisors
from symfpu.plots.spectra import spectrum
from symfpu.plots.stability import multipliers
from symfpu.plots.style import Axes, picture_bytes
from symfpu.plots.toda import toda_gaps
from symfpu.proofs.certificates import PropagationProof
from symfpu.results.pictures import KNOWN, Picture
from symfpu.series.series import LindstedtSeries
from symfpu.spectral.analysis import FrequencyAnalysis
from symfpu.spectral.mapping import FrequencyMap
from symfpu.tori.amplitudes import AmplitudeHistory
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment

SIZE, DPI = (4.2, 2.9), 75  # of the picture beside an answer


def usual(
    kind: type,
    draw: Callable[..., Axes],
    possible: Callable[[Any], bool] = lambda result: True,
) -> None:
    """What `plot()` of this kind of result draws.

    possible : whether a result has what it shows.
    """

    def small(result: Any) -> bytes:
        return picture_bytes(partial(draw, result), ".png", size=SIZE, dpi=DPI)

    name = draw.__name__.replace("_", " ")
    KNOWN[kind] = Picture(draw, small, name, possible)


def family(found: Family, ax: Axes | None = None) -> Axes:
    """Normal frequencies where they are known, else energies by frequencies."""
    if any(m.normal for m in found.members):
        return family_normal_frequencies(found, ax)
    return family_frequencies(found, ax)


def energy_series(orbit: Orbit, ax: Axes | None = None) -> Axes:
    return time_series(orbit, ax, quantity="E")


usual(Torus, spectrum)
usual(LindstedtSeries, small_divisors, lambda series: bool(series.smallest_divisors))
usual(AmplitudeHistory, amplitudes, lambda history: bool(history.differences()))
usual(Assessment, residuals)
usual(Orbit, energy_series, lambda orbit: orbit.Q.ndim == 2)
usual(AlignmentIndices, alignment)
usual(ForetoldIndices, foretold)
usual(Floquet, multipliers)
usual(NormalModes, normal_frequencies)
usual(NormalFamily, family_normal_frequencies)
usual(Family, family)
usual(PropagationProof, propagation)
usual(FrequencyAnalysis, lines)
usual(FrequencyMap, frequency_map)
usual(Atlas, atlas_borders, lambda atlas: any(b.energy is not None for b in atlas.borders))
usual(TodaInvariants, toda_gaps)
