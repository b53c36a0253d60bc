"""Pictures of a family: energy against frequency, amplitudes, multipliers, spectra.

Nothing is computed here.
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
# of the smallest of the largest shifts: below it a scale with folds is linear
LINEAR_SCALE_SHARE = 0.01
SHIFT_ROUNDING = 1e-15  # of a relative shift in doubles
SPECTRA_SHOWN = 5  # as many as the style has colours


def plot_shifts(found: Family, ax: Axes) -> Axes:
    """H against omega_q / Omega_q - 1 of every seed, in powers of ten on both sides of zero.

    Folds as lines.
    """
    energies = np.array([m.energy for m in found.members])
    linear = found.chain.frequencies()
    smallest = np.inf
    for i, q in enumerate(found.seeds):
        rates = np.array([float(m.torus.frequencies[i]) for m in found.members])
        shifts = (rates - linear[q - 1]) / linear[q - 1]
        ax.plot(shifts, energies, marker=".", label=rf"$q = {q}$")
        largest = float(np.abs(shifts).max())
        smallest = min(smallest, largest)
    folds = [event.energy for event in found.events if event.kind == "fold"]
    for i, energy in enumerate(folds):
        label = None if i else "fold"
        ax.axhline(energy, color="0.7", lw=0.8, zorder=0, label=label)
    if folds:
        linear_below = max(LINEAR_SCALE_SHARE * smallest, SHIFT_ROUNDING)
        ax.set_xscale("symlog", linthresh=linear_below)
    ax.set_yscale("log")
    ax.set_xlabel(r"$\omega_q / \Omega_q - 1$")
    ax.set_ylabel(r"$H$")
    ax.legend()
    return ax


def plot_amplitudes(found: Family, ax: Axes) -> Axes:
    """Amplitudes against H; resonances as ticks below, changes of stability as lines."""
    energies = [m.energy for m in found.members]
    for q in found.seeds:
        sizes = [abs(m.amplitudes[q]) for m in found.members]
        ax.loglog(energies, sizes, marker=".", label=rf"$A_{{{q}}}$")
    resonances = [e.energy for e in found.events if e.kind == "resonance"]
    for i, energy in enumerate(resonances):
        label = None if i else "resonance"
        ax.axvline(energy, ymax=0.04, color="C3", lw=1, label=label)
    changes = [e.energy for e in found.events if e.kind == "stability"]
    for i, energy in enumerate(changes):
        label = None if i else "change of stability"
        ax.axvline(energy, color="0.5", ls=":", lw=1, label=label)
    ax.set_xlabel(r"$H$")
    ax.set_ylabel(r"$A_q$")
    ax.legend()
    return ax


def plot_multipliers(found: Family, ax: Axes) -> Axes:
    """Angles of the multipliers on the unit circle against H.

    Moduli of those off it as crosses on a second axis.
    """
    off: list[tuple[float, float]] = []
    for m in found.members:
        if m.multipliers is None:
            continue
        firsts = m.multipliers.pairs[:, 0]
        angles = np.abs(np.angle(firsts))
        same_energy = np.full(len(angles), m.energy)
        ax.plot(same_energy, angles, ".", color="C0", ms=2)
        unstable = [kind not in (TRIVIAL, ELLIPTIC) for kind in m.multipliers.kinds]
        off += [(m.energy, float(size)) for size in np.abs(firsts[unstable])]
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
    last = len(found.members) - 1
    places = np.linspace(0, last, SPECTRA_SHOWN).round().astype(int)
    for i, k in enumerate(np.unique(places)):
        m = found.members[k]
        spectrum = np.asarray(m.torus.average_spectrum(), dtype=float)
        known = np.flatnonzero(spectrum > spectrum_floor(m.torus))
        shares = spectrum[known] / spectrum.sum()
        label = f"$H$ = {m.energy:.2g}"
        ax.semilogy(known + 1, shares, marker=".", color=f"C{i}", label=label)
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
    chain = repr(found.chain)[6:-1]
    word = "seed" if len(found.seeds) == 1 else "seeds"
    seeds = ", ".join(map(str, found.seeds))
    drawn = []
    for panel, (title, draw) in panels.items():
        full_title = f"{title} ({chain}, {word} {seeds})"
        drawn += save_panel(partial(draw, found), full_title, folder / f"{stem}-{panel}")
    return drawn
