"""Pictures of a family as files: energy against frequency, amplitudes, multipliers, spectra."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from symfpu.families.family import Family
from symfpu.figures.drawing import save_panel
from symfpu.plots.families import (
    family_amplitudes,
    family_frequencies,
    family_multipliers,
    family_spectra,
)
from symfpu.plots.normal_family import family_normal_frequencies


def draw_family(found: Family, folder: Path, stem: str = "family") -> list[Path]:
    """The panels as PNG and PDF, what is not known left out; returns the paths."""
    panels = {
        "shifts": ("Energy against relative frequency shift", family_frequencies),
        "amplitudes": ("Amplitudes", family_amplitudes),
        "spectra": ("Average spectra", family_spectra),
    }
    if any(m.multipliers is not None for m in found.members):
        panels["multipliers"] = ("Floquet multipliers", family_multipliers)
    if any(m.normal is not None for m in found.members):
        panels["normal"] = ("Normal frequencies", family_normal_frequencies)
    drawn = []
    for panel, (title, draw) in panels.items():
        drawn += save_panel(partial(draw, found), title, folder / f"{stem}-{panel}")
    return drawn
