"""Fig. 9: the breather of seed 1 at higher energy, the FPU-trajectory that recurs, and how many
frequencies it has.

The claims are those of section 6.4.3.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import periodic_orbit
from symfpu.breathers.digits import periodic_orbit_digits
from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.dynamics.orbits import Orbit
from symfpu.figures.alignment import alignment_panel
from symfpu.localization.laws import natural_packet
from symfpu.localization.profiles import fpu_trajectory, normalised_averages, packet_amplitudes
from symfpu.localization.recurrence import recurrence
from symfpu.numbers.typed import Number
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.dimensions import FULL_TIME, indices, settled_after
from symfpu.paper.fig7_fig8 import (
    NARROW,
    SHOWN,
    SHOWN_ONLY,
    law_claim,
    law_curve,
    profiles_of,
    variation,
)
from symfpu.paper.judgements import SIMILAR, dimension_claim, same_profile
from symfpu.paper.printed import FIG9_PACKETS, FIG9_RECURRENCE, PrintedTorus
from symfpu.paper.starts import (
    energies_panel,
    follow,
    normalised_floor,
    printed_amplitudes,
    printed_row,
    printed_torus,
    profile_panel,
)
from symfpu.paper.steps import Step
from symfpu.paper.table import rounds_to
from symfpu.tori.torus import QTorus

Floats = NDArray[np.float64]
# of the instantaneous energies, our choice: four units of time between looks
TIME, LOOKS = 5e4, 12501
SHOWN_EVERY = 5  # of these looks, in the pictures
PLATEAU = 5e7  # the time at which G_4 and G_5 become constant
NEAR = 0.05  # relative: a time that the paper reads off a picture
COMPLETE = 0.95  # of the energy back in its modes: "a nearly complete return"
DIGITS = 40
SLOW, LITTLE = 50, 0.5  # "near k_0 = 50"; decades
LOW = 1e-16  # of the energy: its square root is where the low modes end


def figure9(folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """Breather and FPU-trajectories at the printed amplitude and at the printed energy."""
    row = printed_row("Fig. 9")
    step("fig9: series")
    torus = printed_torus(row)
    newton = periodic_orbit_digits(periodic_orbit(row.chain, 1, row.frequencies[0]), DIGITS)
    starts: dict[str, Mapping[int, Number]] = {
        "printed E": packet_amplitudes(row.chain, (1,), row.energy),
        "printed A_1": printed_amplitudes(row),
    }
    moments = np.linspace(0.0, TIME, LOOKS)
    orbits = {
        name: follow(
            f"fig9 {name}",
            row.chain,
            fpu_trajectory(row.chain, amplitudes),
            TIME,
            step,
            samples=moments,
        )
        for name, amplitudes in starts.items()
    }
    exact = follow("fig9 breather", row.chain, newton, TIME, step, samples=20)
    series = follow("fig9 PLn", row.chain, torus, TIME, step, samples=20)
    main = orbits["printed E"]
    found = indices("fig9", (main.Q[0], main.P[0]), step, folder, full=full)
    seen = orbits["printed E"].times[::SHOWN_EVERY]
    breather = np.asarray(newton.in_doubles().harmonic_energies(seen), dtype=float) / float(
        newton.energy()
    )
    shares = main.harmonic_energies()[::SHOWN_EVERY] / main.energies[0]
    profiles = profiles_of(torus, {"PLn": series}) | {
        "FPU-trajectory": normalised_averages(main)[-1],
        "Newton": np.asarray(newton.average_spectrum() / newton.energy(), dtype=float),
    }
    floors = {"PL": normalised_floor(torus), "Newton": normalised_floor(newton)}
    law = law_curve(row, float(row.energy), profiles["Newton"])
    modes = tuple(range(1, SHOWN + 1))
    panels = (
        energies_panel(
            "fig9a", "Fig. 9(a): breather of the printed frequency", seen, breather, modes
        ),
        energies_panel(
            "fig9b",
            "Fig. 9(b): FPU-trajectory of the printed energy",
            seen,
            shares,
            modes,
            bottom=1e-10,
        ),
        profile_panel(
            "fig9c", "Fig. 9(c): average spectra", row.chain, profiles, law, floors=floors
        ),
        alignment_panel("fig9d", "Fig. 9(d): alignment indices of the FPU-trajectory", found),
    )
    text = (
        "the spectra of breather and FPU-trajectory agree quite well, especially in the low modes"
    )
    claims = (
        _recurrence(row, orbits),
        _still(breather, exact),
        same_profile(
            "6.4.3", text, profiles, "Newton", "FPU-trajectory", floor=LOW, within=SIMILAR
        ),
        same_profile(
            "6.4.3",
            f"the series of order 242 shows the spectrum of the breather by Newton's method {SHOWN_ONLY}",
            profiles,
            "PL",
            "Newton",
        ),
        _little_gain(torus),
        law_claim("6.4.3", profiles["Newton"], law),
        _frequencies(found),
        *_packets(row),
    )
    return PaperFigure(
        "fig9", "Fig. 9: the q-breather and FPU-trajectory of E = 0.014915", panels, claims
    )


def _recurrence(row: PrintedTorus, orbits: dict[str, Orbit]) -> Claim:
    found = {
        name: recurrence(orbit.times, orbit.harmonic_energies()) for name, orbit in orbits.items()
    }
    parts = (
        f"the FPU-trajectory of the {name} (H = {orbits[name].energies[0]:.6f}) returns to {seen.first[1]:.1%} at t = {seen.first[0]:.0f}"
        for name, seen in found.items()
    )
    time, back = found["printed E"].first
    holds = abs(time / FIG9_RECURRENCE - 1) <= NEAR and back >= COMPLETE
    return Claim(
        "6.4.3",
        "a nearly complete return of the FPU-trajectory at t = 12000",
        "12000",
        "; ".join(parts),
        judged(holds),
    )


def _little_gain(torus: QTorus) -> Claim:
    """The residual of the equations of motion by coordinate order, from the order on after which
    the paper sees no gain.
    """
    orders = sorted({min(SLOW, torus.order), *range(SLOW + 50, torus.order, 50), torus.order})
    residuals = {k: float(replace(torus, order=k).residual()) for k in orders}
    gain = math.log10(residuals[orders[0]] / min(residuals.values()))
    ours = f"residual by order {', '.join(f'{k}: {r:.1e}' for k, r in residuals.items())}; gain after the first {gain:.2g} decades"
    text = (
        "convergence is very slow, with little gain in precision after a truncation order near 50"
    )
    return Claim("6.4", text, "50", ours, judged(gain <= LITTLE, gain <= 1.0))


def _still(breather: Floats, orbit: Orbit) -> Claim:
    moves = float(variation(breather[:, :SHOWN]).max())
    off = float(np.abs(normalised_averages(orbit)[-1][0] / breather[:, 0].mean() - 1))
    ours = f"E_q(t) of modes 1 to {SHOWN} varies by up to {moves:.2g} decades on the periodic orbit; integrated, E_1 stays to {off:.0e}"
    return Claim(
        "6.4.3",
        "the energies of the breather are almost constant",
        "",
        ours,
        judged(moves <= NARROW),
    )


def _frequencies(found: AlignmentIndices) -> Claim:
    times = ", ".join(f"G_{k} {settled_after(found, k):.0e}" for k in range(2, 6))
    text = "five incommensurable frequencies: G_2, G_3 constant from the start, G_4, G_5 from 5e7 on, a torus of dimension 5"
    more = f"; within 0.3 decades of the last value from t = {times} on"
    return dimension_claim("6.4.3", text, 5, found, shown_after=PLATEAU, whole=FULL_TIME, more=more)


def _packets(row: PrintedTorus) -> tuple[Claim, ...]:
    """Widths of the natural packet by two estimates."""
    claims = []
    for exponent, printed in FIG9_PACKETS.items():
        width = natural_packet(row.chain, float(row.energy) / row.chain.N, exponent)
        text = f"the natural packet has a width of alpha^{'(1/2)' if exponent == '1/4' else '(2/5)'} eps^({exponent}) N"
        claims.append(
            Claim("6.4.3", text, printed, f"{width:.3f}", judged(rounds_to(width, printed)))
        )
    return tuple(claims)
