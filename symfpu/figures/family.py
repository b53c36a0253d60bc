"""Pictures of a family: energy against frequency, amplitudes, multipliers, spectra. Nothing is
computed here.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from symfpu.breathers.floquet import ELLIPTIC, TRIVIAL
from symfpu.families.family import Family
from symfpu.figures.drawing import save_panel
from symfpu.localization.floors import spectrum_floor

Axes = Any
FOLDED = 0.01  # of the smallest of the largest shifts, below which a scale with folds is linear
ROUNDING = 1e-15  # of a relative shift in doubles
SPECTRA = 5  # as many as the style has colours


def plot_shifts(found: Family, ax: Axes) -> Axes:
    """H against omega_q / Omega_q - 1 of every seed, in powers of ten on both sides of zero.

    Folds as lines.
    """
    energies = np.array([m.energy for m in found.members])
    linear, smallest = found.chain.frequencies(), np.inf
    for i, q in enumerate(found.seeds):
        shifts = np.array([float(m.torus.frequencies[i]) for m in found.members]) - linear[q - 1]
        ax.plot(shifts / linear[q - 1], energies, marker=".", label=rf"$q = {q}$")
        smallest = min(smallest, float(np.abs(shifts / linear[q - 1]).max()))
    folds = [event.energy for event in found.events if event.kind == "fold"]
    for i, energy in enumerate(folds):
        ax.axhline(energy, color="0.7", lw=0.8, zorder=0, label=None if i else "fold")
    if folds:
        ax.set_xscale("symlog", linthresh=max(FOLDED * smallest, ROUNDING))
    ax.set_yscale("log")
    ax.set_xlabel(r"$\omega_q / \Omega_q - 1$")
    ax.set_ylabel(r"$H$")
    ax.legend()
    return ax


def plot_amplitudes(found: Family, ax: Axes) -> Axes:
    """Amplitudes against H; resonances as ticks below, changes of stability as lines."""
    energies = [m.energy for m in found.members]
    for q in found.seeds:
        ax.loglog(
            energies,
            [abs(m.amplitudes[q]) for m in found.members],
            marker=".",
            label=rf"$A_{{{q}}}$",
        )
    for i, event in enumerate(e for e in found.events if e.kind == "resonance"):
        ax.axvline(event.energy, ymax=0.04, color="C3", lw=1, label=None if i else "resonance")
    for i, event in enumerate(e for e in found.events if e.kind == "stability"):
        ax.axvline(
            event.energy, color="0.5", ls=":", lw=1, label=None if i else "change of stability"
        )
    ax.set_xlabel(r"$H$")
    ax.set_ylabel(r"$A_q$")
    ax.legend()
    return ax


def plot_multipliers(found: Family, ax: Axes) -> Axes:
    """Angles of the multipliers on the unit circle against H, and the moduli of those off it as
    crosses on a second axis.
    """
    known = [(m.energy, m.multipliers) for m in found.members if m.multipliers is not None]
    off: list[tuple[float, float]] = []
    for energy, multipliers in known:
        angles = np.abs(np.angle(multipliers.pairs[:, 0]))
        ax.plot(np.full(len(angles), energy), angles, ".", color="C0", ms=2)
        unstable = [kind not in (TRIVIAL, ELLIPTIC) for kind in multipliers.kinds]
        off += [(energy, float(size)) for size in np.abs(multipliers.pairs[unstable, 0])]
    ax.set_xscale("log")
    ax.set_xlabel(r"$H$")
    ax.set_ylabel(r"$|\arg \lambda|$")
    if off:
        right = ax.twinx()
        right.plot(*zip(*off, strict=True), "x", color="C3", ms=4)
        right.set_ylim(bottom=1)
        right.set_ylabel(r"$|\lambda|$ off the circle", color="C3")
    return ax


def plot_spectra(found: Family, ax: Axes) -> Axes:
    """Average spectra of some members, normalised.

    Modes at or below the `spectrum_floor` of their member are not drawn.
    """
    chosen = np.unique(np.linspace(0, len(found.members) - 1, SPECTRA).round().astype(int))
    for i, m in enumerate(found.members[k] for k in chosen):
        spectrum = np.asarray(m.torus.average_spectrum(), dtype=float)
        q = np.flatnonzero(spectrum > spectrum_floor(m.torus))
        ax.semilogy(
            q + 1,
            spectrum[q] / spectrum.sum(),
            marker=".",
            color=f"C{i}",
            label=f"$H$ = {m.energy:.2g}",
        )
    ax.set_xlabel(r"$q$")
    ax.set_ylabel(r"$\overline{E}_q / E$")
    ax.legend(fontsize="small")
    return ax


def draw_family(found: Family, folder: Path, stem: str = "family") -> list[Path]:
    """The panels as PNG and PDF, multipliers only where they are known; returns the paths."""
    panels = {
        "shifts": ("Energy against relative frequency shift", plot_shifts),
        "amplitudes": ("Amplitudes", plot_amplitudes),
        "spectra": ("Average spectra", plot_spectra),
    }
    if any(m.multipliers is not None for m in found.members):
        panels["multipliers"] = ("Floquet multipliers", plot_multipliers)
    name = f"{repr(found.chain)[6:-1]}, {'seed' if len(found.seeds) == 1 else 'seeds'} {', '.join(map(str, found.seeds))}"
    drawn = []
    for panel, (title, draw) in panels.items():
        drawn += save_panel(partial(draw, found), f"{title} ({name})", folder / f"{stem}-{panel}")
    return drawn
