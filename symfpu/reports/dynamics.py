"""Orbits and alignment indices for JSON."""

from __future__ import annotations

from typing import Any

from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.dynamics.orbits import Orbit
from symfpu.reports.tables import fifteen_digits


def orbit_record(made: Orbit) -> dict[str, Any]:
    """An orbit: how it was integrated, its energy, and the time averages at its end.

    `modes` of a ring are in the order of its spectra. An orbit of several states has their first.
    """
    modes = {"modes": list(made.chain.mode_numbers)} if made.chain.periodic else {}
    average = None
    if made.averages is not None and made.averages.ndim == 2:
        average = [fifteen_digits(value) for value in made.averages[-1]]
    energy = made.energies[0] if made.energies.ndim == 1 else made.energies[0].flat[0]
    return {
        **made.chain.typed,
        **modes,
        "scheme": made.scheme.name,
        "step": fifteen_digits(made.step),
        "time": fifteen_digits(made.times[-1]),
        "samples": len(made.times),
        "energy": repr(float(energy)),
        "energy_error": fifteen_digits(made.energy_error),
        "average_spectrum": average,
        "seconds": round(made.seconds, 3),
    }


def alignment_record(found: AlignmentIndices) -> dict[str, Any]:
    """Alignment indices; `dimension` is null where nothing is decided, and in chaos."""
    dimension = found.dimension()
    decided = dimension.value is not None
    slopes = {}
    for slope in found.slopes():
        value = fifteen_digits(slope.value)
        slopes[str(slope.k)] = {"value": value, "error": fifteen_digits(slope.error)}
    indices = {}
    for k, index in enumerate(found.log10_gali[-1].tolist(), start=2):
        indices[str(k)] = fifteen_digits(index)
    return {
        **found.chain.typed,
        "time": fifteen_digits(float(found.times[-1])),
        "scheme": found.scheme.name,
        "step": fifteen_digits(found.step),
        "slopes": slopes,
        "log10_gali": indices,
        "dimension": dimension.value,
        "dimension_error": fifteen_digits(dimension.error) if decided else None,
        "supported_dimension": dimension.supported,
        "dimension_by_frame": list(dimension.frames),
        "verdict": dimension.verdict,
        "reason": dimension.reason,
        "lyapunov": fifteen_digits(float(found.lyapunov[-1])),
        "energy_error": fifteen_digits(found.energy_error),
    }
