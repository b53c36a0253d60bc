"""What Figs. 7, 8 and 9 share: spectra of q-breathers beside those of FPU-trajectories."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symfpu.dynamics.orbits import Orbit
from symfpu.figures.panels import Curve
from symfpu.localization.laws import breather_law
from symfpu.localization.profiles import normalised_averages, profile_distance
from symfpu.paper.claims import Claim, judged
from symfpu.paper.judgements import ENERGY_FLOOR, SIMILAR_DECADES
from symfpu.paper.printed import PrintedTorus
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
SHOWN_MODES = 8  # of Figs. 7 and 9
CONSTANT_DECADES = 0.5  # "practically constant"
SHOWN_ONLY = "(compared in the figure, not stated)"
ALIKE_TEXT = "breathers have quite similar energy profiles as their FPU-trajectories"


def profiles_of(torus: Torus[FromSeries], orbits: dict[str, Orbit]) -> dict[str, Floats]:
    """Normalised average spectra of a series and of orbits."""
    series = np.asarray(torus.average_spectrum() / torus.energy(), dtype=float)
    profiles = {"PL": series}
    for name, orbit in orbits.items():
        profiles[name] = normalised_averages(orbit)[-1]
    return profiles


def law_curve(row: PrintedTorus, energy: float, spectrum: Floats) -> Curve:
    """Eq. brelaw through the energy of mode 1."""
    chain = row.chain
    kappa = np.arange(1.0, chain.N) / chain.N
    law = breather_law(chain, energy, spectrum[0] * energy) / energy
    return Curve("Eq. brelaw", kappa, law, "law")


def law_claim(section: str, spectrum: Floats, law: Curve) -> Claim:
    """How far the law E_q = gamma^(q-1) q^2 E_1 is from a spectrum."""
    found = profile_distance(spectrum, law.y, ENERGY_FLOOR)
    low = profile_distance(spectrum[:SHOWN_MODES], law.y[:SHOWN_MODES], ENERGY_FLOOR)
    ours = f"off by up to {low.distance:.2g} decades in modes 1 to {SHOWN_MODES}, "
    ours += f"by {found.distance:.2g} (mode {found.mode}) in the {found.modes} above 1e-28"
    text = "the law E_q = gamma^(q-1) q^2 E_1 fits the spectrum"
    verdict = judged(found.distance <= SIMILAR_DECADES, low.distance <= SIMILAR_DECADES)
    return Claim(section, text, "", ours, verdict)


def variation(shares: Floats) -> Floats:
    """log10 of largest over smallest E_q(t), by mode."""
    largest = shares.max(axis=0)
    smallest = shares.min(axis=0)
    return np.asarray(np.log10(largest / smallest))


def hierarchy_claim(
    profiles: dict[str, Floats], sequence: list[int], section: str = "6.4.2"
) -> Claim:
    """Whether the FPU-trajectory leaves the breather's spectrum at later modes of the sequence.

    In the same order of modes.
    """
    columns = np.array(sequence) - 1
    fpu = profiles["FPU-trajectory"][columns]
    breather = profiles["PL"][columns]
    above = int(np.sum(breather > ENERGY_FLOOR))
    falling = np.diff(fpu[:above]) < 0
    ordered = int(np.argmin(np.append(falling, False))) + 1
    ratios = np.log10(fpu / breather)[:above]
    shown = ", ".join(f"{ratio:.2f}" for ratio in ratios)
    ours = f"log10 of FPU-trajectory over breather in the order of excitation: {shown}; "
    ours += f"the first {ordered} of {above} modes keep their order"
    text = "the FPU-trajectory leaves the breather's spectrum at modes of higher order; "
    text += "the hierarchy of modes is preserved"
    holds = ordered == above and _grows(np.abs(ratios))
    return Claim(section, text, "", ours, judged(holds, ordered > above // 2))


def _grows(values: Floats) -> bool:
    slope, _ = np.polyfit(np.arange(len(values)), values, 1)
    return bool(slope > 0)
