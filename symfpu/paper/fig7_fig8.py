"""Figs. 7 and 8: q-breathers by the series, by integration and by Newton's method, beside their
FPU-trajectories.

The claims are those of sections 6.4.1 and 6.4.2.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import periodic_orbit
from symfpu.breathers.digits import periodic_orbit_digits
from symfpu.chain.propagation import excitation_sequence
from symfpu.dynamics.orbits import Orbit
from symfpu.figures.panels import Curve, Panel
from symfpu.localization.laws import breather_law
from symfpu.localization.profiles import fpu_trajectory, normalised_averages, profile_distance
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.judgements import SIMILAR, same_profile
from symfpu.paper.printed import PrintedTorus
from symfpu.paper.starts import (
    energies_panel,
    follow,
    normalised_floor,
    printed_amplitudes,
    printed_row,
    printed_torus,
    profile_panel,
)
from symfpu.paper.steps import Step, unheard
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.torus import QTorus

Floats = NDArray[np.float64]
AVERAGING = 1e5  # time of the averages, our choice
SHOWN = 8  # modes of Figs. 7 and 9
TIME_7, TIME_8 = 1e5, 1000.0  # of the instantaneous energies, our choice
NEWTON_DIGITS = 40  # of the periodic orbit: its tails end below 1e-60 of the energy
BREATHER_STEP = 0.35  # resolves the recurrences of tails to 1e-4
EPS = float(np.finfo(float).eps)
RETURN_STEP = 0.05  # for a period to 12 digits
RETURN_DIGITS = 10  # "up to 10 significant digits"
CLOSE = 0.3  # decades: a factor of two
NARROW, WIDE = 0.5, 1.0  # decades: "practically constant", "more than one order of magnitude"
DEEP = 1e-15  # of the energy: below it the paper's integration shows differences
SHOWN_ONLY = "(compared in the figure, not stated)"
ALIKE = "breathers have quite similar energy profiles as their FPU-trajectories"
LEFT = 0.1  # of the mean energy of a mode: the integration has left the series


def figure7(folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """The breather of seed 1 and its FPU-trajectory, N = 32."""
    row = printed_row("Fig. 7")
    torus, newton = (
        printed_torus(row),
        periodic_orbit_digits(periodic_orbit(row.chain, 1, row.frequencies[0]), NEWTON_DIGITS),
    )
    fpu = fpu_trajectory(row.chain, printed_amplitudes(row))
    starts: dict[str, QuasiPeriodic | tuple[Floats, Floats]] = {"PLn": torus, "FPU-trajectory": fpu}
    moments = np.linspace(0.0, TIME_7, 2001)
    orbits = {
        name: follow(f"fig7 {name}", row.chain, start, TIME_7, step, samples=moments)
        for name, start in starts.items()
    }
    times = orbits["PLn"].times
    shares = {"PL": np.asarray(torus.harmonic_energies(times) / torus.energy(), dtype=float)}
    shares |= {
        name: orbit.harmonic_energies() / orbit.energies[0] for name, orbit in orbits.items()
    }
    profiles = profiles_of(torus, orbits) | {
        "Newton": np.asarray(newton.average_spectrum() / newton.energy(), dtype=float)
    }
    modes = tuple(range(1, SHOWN + 1))
    bottom = 1e-3 * float(shares["PL"][:, SHOWN - 1].min())
    panels = tuple(
        energies_panel(
            f"fig7{letter}", f"Fig. 7({letter}): {name}", times, shares[name], modes, bottom=bottom
        )
        for letter, name in zip("abc", shares, strict=True)
    )
    law = law_curve(row, float(torus.energy()), profiles["PL"])
    floors = {"PL": normalised_floor(torus), "Newton": normalised_floor(newton)}
    panels += (
        profile_panel(
            "fig7d", "Fig. 7(d): average spectra", row.chain, profiles, law, floors=floors
        ),
    )
    claims = (
        _return(row, torus),
        _constancy(shares["PL"], shares["FPU-trajectory"]),
        _means(shares["PL"], shares["FPU-trajectory"]),
        same_profile(
            "6.4.1", f"the spectra of PL and PLn are the same {SHOWN_ONLY}", profiles, "PL", "PLn"
        ),
        same_profile(
            "6.4.1",
            f"the spectrum by Newton's method is that of the series {SHOWN_ONLY}",
            profiles,
            "PL",
            "Newton",
        ),
        same_profile("6.4", f"{ALIKE}, mode 1", profiles, "PL", "FPU-trajectory", within=SIMILAR),
        _hierarchy(profiles, list(range(1, row.chain.N)), "6.4.2, of Fig. 7(d)"),
        law_claim("6.4.1", profiles["PL"], law),
    )
    return PaperFigure("fig7", "Fig. 7: the q-breather of mode 1, E = 0.00016635", panels, claims)


def profiles_of(torus: QTorus, orbits: dict[str, Orbit]) -> dict[str, Floats]:
    """Normalised average spectra of a series and of orbits."""
    series = np.asarray(torus.average_spectrum() / torus.energy(), dtype=float)
    return {"PL": series} | {name: normalised_averages(orbit)[-1] for name, orbit in orbits.items()}


def law_curve(row: PrintedTorus, energy: float, spectrum: Floats) -> Curve:
    """Eq. brelaw through the energy of mode 1."""
    chain = row.chain
    return Curve(
        "Eq. brelaw",
        np.arange(1.0, chain.N) / chain.N,
        breather_law(chain, energy, spectrum[0] * energy) / energy,
        "law",
    )


def law_claim(section: str, spectrum: Floats, law: Curve) -> Claim:
    """How far the law E_q = gamma^(q-1) q^2 E_1 is from a spectrum."""
    found, low = (
        profile_distance(spectrum, law.y, 1e-28),
        profile_distance(spectrum[:SHOWN], law.y[:SHOWN], 1e-28),
    )
    deep = f"by {found.distance:.2g} (mode {found.mode}) in the {found.modes} above 1e-28"
    ours = f"off by up to {low.distance:.2g} decades in modes 1 to {SHOWN}, {deep}"
    text = "the law E_q = gamma^(q-1) q^2 E_1 fits the spectrum"
    return Claim(
        section, text, "", ours, judged(found.distance <= SIMILAR, low.distance <= SIMILAR)
    )


def _return(row: PrintedTorus, torus: QTorus) -> Claim:
    """Back at its start after a period, by integration."""
    period = 2 * math.pi / float(row.frequencies[0])
    orbit = follow(
        "fig7 period",
        row.chain,
        torus,
        period,
        unheard,
        step=RETURN_STEP,
        samples=1,
        averages=False,
    )
    off = float(
        max(np.abs(orbit.Q[-1] - orbit.Q[0]).max(), np.abs(orbit.P[-1] - orbit.P[0]).max())
        / np.abs(orbit.Q[0]).max()
    )
    digits = -math.log10(max(off, EPS))
    ours = f"to {digits:.1f} digits of the largest coordinate, with the amplitude that belongs to the printed frequency"
    text = "the series at k_0 = 51 returns to its start after a period up to 10 significant digits"
    return Claim("6.4.1", text, "10 digits", ours, judged(digits >= RETURN_DIGITS - 0.5))


def variation(shares: Floats) -> Floats:
    """log10 of largest over smallest E_q(t), by mode."""
    return np.asarray(np.log10(shares.max(axis=0) / shares.min(axis=0)))


def _constancy(breather: Floats, fpu: Floats) -> Claim:
    # an FPU-trajectory begins without energy elsewhere
    still, moving = variation(breather[:, :SHOWN]), variation(fpu[1:, 1:SHOWN])
    ours = (
        f"E_q(t) of the breather varies by {still.max():.2g} decades in modes 1 to {SHOWN}, of the FPU-trajectory by {moving.min():.2g} to "
        f"{moving.max():.2g} in modes 2 to {SHOWN}"
    )
    text = "E_q(t) is practically constant on the breather, and varies by more than one order of magnitude on the FPU-trajectory"
    constant, varies = bool(still.max() <= NARROW), bool(moving.min() >= WIDE)
    return Claim("6.4.1", text, "", ours, judged(constant and varies, constant or varies))


def _means(breather: Floats, fpu: Floats) -> Claim:
    """Times 0 .. T of both, evenly spaced."""
    off = np.abs(np.log10(fpu[:, :SHOWN].mean(axis=0) / breather[:, :SHOWN].mean(axis=0)))
    ours = f"decades between the means in modes 1 to {SHOWN}: {', '.join(f'{value:.2f}' for value in off)}"
    text = "E_q(t) of the FPU-trajectory oscillate around means that follow closely the energies of the breather"
    return Claim(
        "6.4.1",
        text,
        "",
        ours,
        judged(bool(off.max() <= CLOSE), bool(off[: SHOWN // 2].max() <= CLOSE)),
    )


def figure8(folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """The breather of seed 25, integrated in mode space and as in the paper."""
    row = printed_row("Fig. 8")
    torus = printed_torus(row)
    sequence = [
        modes[0] for modes in excitation_sequence(row.chain.N, row.seeds, row.order) if modes
    ]
    moments = np.linspace(0.0, TIME_8, 1001)
    deep = follow(
        "fig8 PLn",
        row.chain,
        torus,
        TIME_8,
        step,
        samples=moments,
        averages=False,
        step=BREATHER_STEP,
    )
    paper = follow(
        "fig8 PLn T+V",
        row.chain,
        torus,
        TIME_8,
        step,
        samples=moments,
        averages=False,
        scheme="yoshida4",
        step=0.05,
    )
    E = float(torus.energy())
    series = np.asarray(torus.harmonic_energies(deep.times) / E, dtype=float)
    # times of samples are those of the nearest steps
    orbits = {"PLn, Yoshida 4": paper, "PLn, mode space": deep}
    by_route = {
        name: (orbit.times, orbit.harmonic_energies() / E) for name, orbit in orbits.items()
    } | {"PL": (deep.times, series)}
    seen = tuple(sequence[:7])
    curves = tuple(
        Curve(
            name,
            times,
            values[:, q - 1],
            "line" if name == "PL" else "dots",
            group=i,
            name=f"{name} q={q}",
        )
        for i, (name, (times, values)) in enumerate(by_route.items())
        for q in seen
    )
    long = {
        "PLn": follow(
            "fig8 PLn", row.chain, torus, AVERAGING, step, samples=20, step=BREATHER_STEP
        ),
        "FPU-trajectory": follow(
            "fig8 FPU-trajectory",
            row.chain,
            fpu_trajectory(row.chain, printed_amplitudes(row)),
            AVERAGING,
            step,
            samples=20,
        ),
    }
    profiles = profiles_of(torus, long)
    floors = {"PL": normalised_floor(torus)}
    title = f"Fig. 8(a): energies of modes {', '.join(map(str, seen))}"
    panels = (
        Panel(
            "fig8a", title, r"$t$", r"$E_q(t) / E$", curves, ("t", "energy_over_H"), bottom=1e-40
        ),
        profile_panel(
            "fig8b",
            "Fig. 8(b): average spectra, seed 25",
            row.chain,
            profiles,
            by_kappa=False,
            floors=floors,
        ),
    )
    claims = (
        _rounding({name: values for name, (_, values) in by_route.items()}, seen),
        same_profile(
            "6.4.2", f"the spectra of PL and PLn are the same {SHOWN_ONLY}", profiles, "PL", "PLn"
        ),
        same_profile("6.4", f"{ALIKE}, mode 25", profiles, "PL", "FPU-trajectory", within=SIMILAR),
        _hierarchy(profiles, sequence),
    )
    return PaperFigure("fig8", "Fig. 8: the q-breather of mode 25, E = 0.00465079", panels, claims)


def _rounding(routes: dict[str, Floats], modes: tuple[int, ...]) -> Claim:
    """At which energy the integrations leave the series."""
    columns = np.array(modes) - 1
    # which do not see phases
    means = {
        name: values[len(values) // 2 :, columns].mean(axis=0) for name, values in routes.items()
    }
    expected = means["PL"]
    levels = {}
    for name, values in means.items():
        left = np.abs(values / expected - 1) > LEFT
        levels[name] = float(expected[left].max()) if left.any() else 0.0
    nowhere = f"nowhere down to {expected.min():.0e}"
    parts = (
        f"{name}: {f'at {level:.0e} of E' if level else nowhere}"
        for name, level in levels.items()
        if name != "PL"
    )
    ours = (
        f"means of E_q over the second half leave the series by more than {LEFT:.0%} - "
        + "; ".join(parts)
    )
    text = "below 1e-15 of the energy the integrated orbit shows small oscillations: integration cannot keep the analytical construction"
    paper = levels["PLn, Yoshida 4"]
    return Claim(
        "6.4.2",
        text,
        "1e-15",
        ours,
        judged(bool(paper and DEEP / 100 < paper < DEEP * 100), paper > 0),
    )


def _hierarchy(profiles: dict[str, Floats], sequence: list[int], section: str = "6.4.2") -> Claim:
    """The FPU-trajectory leaves the breather's spectrum at later modes of the sequence, in the
    same order.
    """
    fpu, breather = (profiles[name][np.array(sequence) - 1] for name in ("FPU-trajectory", "PL"))
    ratios = np.log10(fpu / breather)
    seen = int(np.sum(breather > 1e-28))
    ordered = int(np.argmin(np.append(np.diff(fpu[:seen]) < 0, False))) + 1
    ours = (
        f"log10 of FPU-trajectory over breather in the order of excitation: {', '.join(f'{r:.2f}' for r in ratios[:seen])}; "
        f"the first {ordered} of {seen} modes keep their order"
    )
    text = "the FPU-trajectory leaves the breather's spectrum at modes of higher order; the hierarchy of modes is preserved"
    holds = ordered == seen and bool(np.polyfit(np.arange(seen), np.abs(ratios[:seen]), 1)[0] > 0)
    return Claim(section, text, "", ours, judged(holds, ordered > seen // 2))
