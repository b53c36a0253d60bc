"""Fig. 7: the q-breather of mode 1 by series, integration and Newton, and its FPU-trajectory.

The claims are those of section 6.4.1.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import breather_of_frequency
from symfpu.figures.panels import Curve, Panel
from symfpu.files.progress import Progress
from symfpu.localization.profiles import fpu_trajectory
from symfpu.paper.breather_profiles import (
    ALIKE_TEXT,
    CONSTANT_DECADES,
    SHOWN_MODES,
    SHOWN_ONLY,
    hierarchy_claim,
    law_claim,
    law_curve,
    profiles_of,
    variation,
)
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.judgements import SIMILAR_DECADES, same_profile
from symfpu.paper.printed import PrintedTorus
from symfpu.paper.starts import (
    Starting,
    energies_panel,
    integrated_orbit,
    normalised_floor,
    period_digits,
    printed_amplitudes,
    printed_row,
    printed_torus,
    profile_panel,
)
from symfpu.refinement.tori import refine
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
TIME, LOOKS = 1e5, 2001  # of the instantaneous energies, our choice
NEWTON_DIGITS = 40  # of the periodic orbit: its tails end below 1e-60 of the energy
RETURN_DIGITS = 10  # "up to 10 significant digits"
MEAN_DECADES = 0.3  # a factor of two: means that "follow closely"
VARYING_DECADES = 1.0  # "more than one order of magnitude"
BOTTOM_SHARE = 1e-3  # of the least energy of the last mode shown, the bottom of the picture


def figure7(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """The breather of seed 1 and its FPU-trajectory, N = 32."""
    row = printed_row("Fig. 7")
    chain = row.chain
    torus = printed_torus(row)
    newton = refine(
        breather_of_frequency(chain, 1, row.frequencies[0]), digits=NEWTON_DIGITS
    )
    fpu = fpu_trajectory(chain, printed_amplitudes(row))
    starts: dict[str, Starting | tuple[Floats, Floats]] = {
        "PLn": torus,
        "FPU-trajectory": fpu,
    }
    moments = np.linspace(0.0, TIME, LOOKS)
    orbits = {}
    for name, start in starts.items():
        orbits[name] = integrated_orbit(
            f"fig7 {name}", chain, start, TIME, progress, samples=moments
        )
    times = orbits["PLn"].times
    series = torus.harmonic_energies(times) / torus.energy()
    shares = {"PL": np.asarray(series, dtype=float)}
    for name, orbit in orbits.items():
        shares[name] = orbit.harmonic_energies() / orbit.energies[0]
    profiles = profiles_of(torus, orbits)
    exact = newton.average_spectrum() / newton.energy()
    profiles["Newton"] = np.asarray(exact, dtype=float)
    law = law_curve(row, float(torus.energy()), profiles["PL"])
    floors = {"PL": normalised_floor(torus), "Newton": normalised_floor(newton)}
    title_d = "Fig. 7(d): average spectra"
    spectra = profile_panel("fig7d", title_d, chain, profiles, law, floors=floors)
    panels = (*_energy_panels(times, shares), spectra)
    claims = (return_claim(row, torus), *_claims(row, shares, profiles, law))
    title = "Fig. 7: the q-breather of mode 1, E = 0.00016635"
    return PaperFigure("fig7", title, panels, claims)


def _energy_panels(times: Floats, shares: dict[str, Floats]) -> list[Panel]:
    """Panels (a) to (c): instantaneous energies by three routes."""
    modes = tuple(range(1, SHOWN_MODES + 1))
    least = float(shares["PL"][:, SHOWN_MODES - 1].min())
    bottom = BOTTOM_SHARE * least
    panels = []
    for letter, (name, energies) in zip("abc", shares.items(), strict=True):
        title = f"Fig. 7({letter}): {name}"
        panel = energies_panel(
            f"fig7{letter}", title, times, energies, modes, bottom=bottom
        )
        panels.append(panel)
    return panels


def _claims(
    row: PrintedTorus, shares: dict[str, Floats], profiles: dict[str, Floats], law: Curve
) -> tuple[Claim, ...]:
    breather, fpu = shares["PL"], shares["FPU-trajectory"]
    integrated = f"the spectra of PL and PLn are the same {SHOWN_ONLY}"
    by_newton = f"the spectrum by Newton's method is that of the series {SHOWN_ONLY}"
    alike = f"{ALIKE_TEXT}, mode 1"
    modes = list(range(1, row.chain.N))
    within = SIMILAR_DECADES
    return (
        constancy_claim(breather, fpu),
        means_claim(breather, fpu),
        same_profile("6.4.1", integrated, profiles, "PL", "PLn"),
        same_profile("6.4.1", by_newton, profiles, "PL", "Newton"),
        same_profile("6.4", alike, profiles, "PL", "FPU-trajectory", within=within),
        hierarchy_claim(profiles, modes, "6.4.2, of Fig. 7(d)"),
        law_claim("6.4.1", profiles["PL"], law),
    )


def return_claim(row: PrintedTorus, torus: Torus[FromSeries]) -> Claim:
    """Back at its start after a period, by integration."""
    digits = period_digits(row, torus)
    ours = f"to {digits:.1f} digits of the largest coordinate, "
    ours += "with the amplitude that belongs to the printed frequency"
    text = "the series at k_0 = 51 returns to its start after a period "
    text += "up to 10 significant digits"
    verdict = judged(digits >= RETURN_DIGITS - 0.5)
    return Claim("6.4.1", text, "10 digits", ours, verdict)


def constancy_claim(breather: Floats, fpu: Floats) -> Claim:
    """How far energies vary on the breather and on the FPU-trajectory."""
    of_breather = variation(breather[:, :SHOWN_MODES])
    # it begins without energy elsewhere
    of_trajectory = variation(fpu[1:, 1:SHOWN_MODES])
    ours = f"E_q(t) of the breather varies by {of_breather.max():.2g} decades "
    ours += f"in modes 1 to {SHOWN_MODES}, of the FPU-trajectory by {of_trajectory.min():.2g} to "
    ours += f"{of_trajectory.max():.2g} in modes 2 to {SHOWN_MODES}"
    text = "E_q(t) is practically constant on the breather, "
    text += "and varies by more than one order of magnitude on the FPU-trajectory"
    constant = bool(of_breather.max() <= CONSTANT_DECADES)
    varies = bool(of_trajectory.min() >= VARYING_DECADES)
    return Claim("6.4.1", text, "", ours, judged(constant and varies, constant or varies))


def means_claim(breather: Floats, fpu: Floats) -> Claim:
    """Times 0 .. T of both, evenly spaced."""
    means = fpu[:, :SHOWN_MODES].mean(axis=0)
    expected = breather[:, :SHOWN_MODES].mean(axis=0)
    off = np.abs(np.log10(means / expected))
    shown = ", ".join(f"{value:.2f}" for value in off)
    ours = f"decades between the means in modes 1 to {SHOWN_MODES}: {shown}"
    text = "E_q(t) of the FPU-trajectory oscillate around means "
    text += "that follow closely the energies of the breather"
    low_modes = off[: SHOWN_MODES // 2]
    everywhere = bool(off.max() <= MEAN_DECADES)
    verdict = judged(everywhere, bool(low_modes.max() <= MEAN_DECADES))
    return Claim("6.4.1", text, "", ours, verdict)
