"""Fig. 9: the breather of seed 1 at higher energy, the FPU-trajectory that recurs, its frequencies.

The claims are those of section 6.4.3.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.foretold import ForetoldIndices
from symfpu.breathers.balance import breather_of_frequency
from symfpu.dynamics.dimension import TorusDimension
from symfpu.dynamics.orbits import Orbit
from symfpu.figures.panels import Panel
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.localization.laws import natural_packet
from symfpu.localization.profiles import (
    fpu_trajectory,
    normalised_averages,
    packet_amplitudes,
)
from symfpu.localization.recurrence import recurrence
from symfpu.numbers.typed import Number
from symfpu.paper.breather_claims import closing, pairs_claim
from symfpu.paper.breather_profiles import (
    CONSTANT_DECADES,
    SHOWN_MODES,
    SHOWN_ONLY,
    law_claim,
    law_curve,
    profiles_of,
    variation,
)
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.dimensions import (
    FULL_TIME,
    VECTORS,
    FigureIndices,
    TorusForecast,
    figure_alignment,
    first_shown,
    foretold_dimension,
    indices_panel,
    integrated_text,
)
from symfpu.paper.fig9_tori import approach, distance_from, five_angles, tori_claim
from symfpu.paper.judgements import SIMILAR_DECADES, same_profile
from symfpu.paper.printed import FIG9_PACKETS, FIG9_RECURRENCE, PrintedTorus
from symfpu.paper.starts import (
    energies_panel,
    integrated_orbit,
    normalised_floor,
    printed_amplitudes,
    printed_row,
    printed_torus,
    profile_panel,
)
from symfpu.paper.table import rounds_to
from symfpu.refinement.tori import refine
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
# of the instantaneous energies, our choice: four units of time between looks
TIME, LOOKS = 5e4, 12501
SHOWN_EVERY = 5  # of these looks, in the pictures
AVERAGING_LOOKS = 20
PRINTED_DIMENSION, DOMINANT = 5, 4  # of the torus; without the last of its small scales
TIME_TOLERANCE = 0.05  # relative: a time that the paper reads off a picture
RETURNED_SHARE = 0.95  # of the energy back in its modes: "a nearly complete return"
DIGITS = 40
SLOW_ORDER = 50  # "near k_0 = 50"
ORDER_STRIDE = 50
GAIN_DECADES, LARGE_GAIN_DECADES = 0.5, 1.0  # little; little in part
LOW_FLOOR = 1e-16  # of the energy: its square root is where the low modes end
TRAJECTORY_BOTTOM = 1e-10
PRINTED_E, PRINTED_A = "printed E", "printed A_1"


def figure9(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """Breather and FPU-trajectories at the printed amplitude and at the printed energy."""
    row = printed_row("Fig. 9")
    chain = row.chain
    progress("fig9: series", NO_FRACTION)
    torus = printed_torus(row)
    newton = refine(breather_of_frequency(chain, 1, row.frequencies[0]), digits=DIGITS)
    orbits = _trajectories(row, progress)
    looks = AVERAGING_LOOKS
    exact = integrated_orbit("fig9 breather", chain, newton, TIME, progress, samples=looks)
    series = integrated_orbit("fig9 PLn", chain, torus, TIME, progress, samples=looks)
    main = orbits[PRINTED_E]
    start = (main.Q[0], main.P[0])
    progress("fig9: what five angles foretell", NO_FRACTION)
    near = five_angles()
    forecast = TorusForecast(near, VECTORS["fig9"][1])
    seen = figure_alignment("fig9", start, progress, folder, forecast, full=full)
    times = main.times[::SHOWN_EVERY]
    energies = newton.in_doubles().harmonic_energies(times)
    breather = np.asarray(energies, dtype=float) / float(newton.energy())
    trajectory = main.harmonic_energies()[::SHOWN_EVERY] / main.energies[0]
    profiles = profiles_of(torus, {"PLn": series})
    profiles["FPU-trajectory"] = normalised_averages(main)[-1]
    average = newton.average_spectrum() / newton.energy()
    profiles["Newton"] = np.asarray(average, dtype=float)
    law = law_curve(row, float(row.energy), profiles["Newton"])
    floors = {"PL": normalised_floor(torus), "Newton": normalised_floor(newton)}
    title_c = "Fig. 9(c): average spectra"
    spectra = profile_panel("fig9c", title_c, chain, profiles, law, floors=floors)
    indices = "Fig. 9(d): alignment indices of the FPU-trajectory"
    if seen.beyond is not None:
        indices += ", foretold from a torus of five angles"
    panels = (
        *_energy_panels(times, breather, trajectory),
        spectra,
        indices_panel("fig9d", indices, seen),
    )
    claims = (
        recurrence_claim(row, orbits),
        constancy_claim(breather, exact),
        *_profile_claims(profiles),
        gain_claim(torus),
        pairs_claim({row.label: closing(row, torus)}),
        law_claim("6.4.3", profiles["Newton"], law),
        frequencies_claim(seen, forecast.frames(), distance_from(near, main.Q[0])),
        tori_claim(approach(chain, row.energy, progress)),
        *packet_claims(row),
    )
    title = "Fig. 9: the q-breather and FPU-trajectory of E = 0.014915"
    return PaperFigure("fig9", title, panels, claims)


def _trajectories(row: PrintedTorus, progress: Progress) -> dict[str, Orbit]:
    """FPU-trajectories of the printed energy and of the printed amplitude."""
    amplitudes: dict[str, Mapping[int, Number]] = {}
    amplitudes[PRINTED_E] = packet_amplitudes(row.chain, (1,), row.energy)
    amplitudes[PRINTED_A] = printed_amplitudes(row)
    moments = np.linspace(0.0, TIME, LOOKS)
    orbits = {}
    for name, values in amplitudes.items():
        start = fpu_trajectory(row.chain, values)
        label = f"fig9 {name}"
        orbits[name] = integrated_orbit(
            label, row.chain, start, TIME, progress, samples=moments
        )
    return orbits


def _energy_panels(
    times: Floats, breather: Floats, trajectory: Floats
) -> tuple[Panel, Panel]:
    """Panels (a) and (b): instantaneous energies."""
    modes = tuple(range(1, SHOWN_MODES + 1))
    constant = "Fig. 9(a): breather of the printed frequency"
    returning = "Fig. 9(b): FPU-trajectory of the printed energy"
    bottom = TRAJECTORY_BOTTOM
    return (
        energies_panel("fig9a", constant, times, breather, modes),
        energies_panel("fig9b", returning, times, trajectory, modes, bottom=bottom),
    )


def _profile_claims(profiles: dict[str, Floats]) -> tuple[Claim, Claim]:
    low = "the spectra of breather and FPU-trajectory agree quite well, "
    low += "especially in the low modes"
    by_series = (
        "the series of order 242 shows the spectrum of the breather by Newton's method"
    )
    options = {"floor": LOW_FLOOR, "within": SIMILAR_DECADES}
    return (
        same_profile("6.4.3", low, profiles, "Newton", "FPU-trajectory", **options),
        same_profile("6.4.3", f"{by_series} {SHOWN_ONLY}", profiles, "PL", "Newton"),
    )


def recurrence_claim(row: PrintedTorus, orbits: dict[str, Orbit]) -> Claim:
    """When the energy comes back to its modes, and how much of it."""
    returns = {}
    parts = []
    for name, orbit in orbits.items():
        seen = recurrence(orbit.times, orbit.harmonic_energies())
        time, share = seen.first
        returns[name] = (time, share)
        trajectory = f"the FPU-trajectory of the {name} (H = {orbit.energies[0]:.6f})"
        parts.append(f"{trajectory} returns to {share:.1%} at t = {time:.0f}")
    time, share = returns[PRINTED_E]
    in_time = abs(time / FIG9_RECURRENCE - 1) <= TIME_TOLERANCE
    text = "a nearly complete return of the FPU-trajectory at t = 12000"
    verdict = judged(in_time and share >= RETURNED_SHARE)
    return Claim("6.4.3", text, "12000", "; ".join(parts), verdict)


def gain_claim(torus: Torus[FromSeries]) -> Claim:
    """The residual of the equations of motion by coordinate order.

    From the order on after which the paper sees no gain.
    """
    first = min(SLOW_ORDER, torus.origin.order)
    between = range(SLOW_ORDER + ORDER_STRIDE, torus.origin.order, ORDER_STRIDE)
    residuals = {}
    for k in sorted({first, *between, torus.origin.order}):
        residuals[k] = float(torus.origin.cut_at(k).torus(torus.phases).residual())
    gain = math.log10(residuals[first] / min(residuals.values()))
    shown = ", ".join(f"{k}: {r:.1e}" for k, r in residuals.items())
    ours = f"residual by order {shown}; gain after the first {gain:.2g} decades"
    text = "convergence is very slow, "
    text += "with little gain in precision after a truncation order near 50"
    verdict = judged(gain <= GAIN_DECADES, gain <= LARGE_GAIN_DECADES)
    return Claim("6.4", text, "50", ours, verdict)


def constancy_claim(breather: Floats, orbit: Orbit) -> Claim:
    """How far energies vary on the breather."""
    moves = float(variation(breather[:, :SHOWN_MODES]).max())
    average = normalised_averages(orbit)[-1][0]
    off = float(np.abs(average / breather[:, 0].mean() - 1))
    ours = f"E_q(t) of modes 1 to {SHOWN_MODES} varies by up to {moves:.2g} decades "
    ours += f"on the periodic orbit; integrated, E_1 stays to {off:.0e}"
    text = "the energies of the breather are almost constant"
    return Claim("6.4.3", text, "", ours, judged(moves <= CONSTANT_DECADES))


def frequencies_claim(
    seen: FigureIndices, frames: tuple[ForetoldIndices, ...], off: float
) -> Claim:
    """The dimension of the torus on which the FPU-trajectory lies, at the paper's time.

    frames : foretold from the torus of five angles near it, which starts `off` of the largest
    coordinate beside it; the indices integrated to a shorter time are beside what is foretold
    for it.
    """
    last = float(seen.found.times[-1])
    said, early = (foretold_dimension(frames, T) for T in (FULL_TIME, last))
    rates = ", ".join(f"{rate:.1e}" for rate in frames[0].rates)
    when = ", ".join(f"{s} from {T:.0e}" for s, T in first_shown(frames).items())
    ours = (
        f"foretold from a torus of {len(frames[0].rates)} angles by Newton's method, which "
    )
    ours += f"starts {off:.1e} of the largest coordinate beside the trajectory and whose "
    ours += f"directions grow at the rates {rates}: {said.verdict} at {FULL_TIME:.0e}; "
    ours += f"as dimension {when}; at {last:.0e} {_best(early)}; {integrated_text(seen)}"
    text = "five incommensurable frequencies: G_2, G_3 constant from the start, "
    text += "G_4, G_5 from 5e7 on, a torus of dimension 5"
    verdict = judged(said.value == PRINTED_DIMENSION, said.value == DOMINANT)
    return Claim("6.4.3", text, f"dimension {PRINTED_DIMENSION}", ours, verdict)


def _best(said: TorusDimension) -> str:
    """A verdict, and the best supported value where there is none."""
    if said.value is None and said.supported is not None:
        return f"{said.verdict}, best supported {said.supported}"
    return said.verdict


def packet_claims(row: PrintedTorus) -> tuple[Claim, ...]:
    """Widths of the natural packet by two estimates."""
    claims = []
    specific_energy = float(row.energy) / row.chain.N
    for exponent, printed in FIG9_PACKETS.items():
        width = natural_packet(row.chain, specific_energy, exponent)
        power = "(1/2)" if exponent == "1/4" else "(2/5)"
        text = f"the natural packet has a width of alpha^{power} eps^({exponent}) N"
        verdict = judged(rounds_to(width, printed))
        claims.append(Claim("6.4.3", text, printed, f"{width:.3f}", verdict))
    return tuple(claims)
