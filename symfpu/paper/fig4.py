"""Fig. 4: packets of a fixed fraction of the modes at fixed energy a particle, in longer and longer
chains; the laws on trial.

The claims are those of section 6.1.
"""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.figures.panels import Curve, Panel
from symfpu.localization.laws import least_packet, middle_modes, packet_parameter
from symfpu.localization.profiles import fpu_trajectory, packet_amplitudes
from symfpu.localization.trials import ProfileInvariance, Trend, profile_invariance, slope_by_energy
from symfpu.paper.captions import caption_claim, caption_curve, law_of, printed_line
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.judgements import SIMILAR
from symfpu.paper.printed import PrintedLine
from symfpu.paper.starts import follow
from symfpu.paper.steps import Step, unheard

Floats = NDArray[np.float64]
TIME, RANDOM_TIME = 1e6, 1e5  # the paper's with phases 0; ours with random phases
REALISATIONS = 4  # of random phases
STILL = 0.15  # an exponent of N that is 0 within what edges of groups and few chains leave
# decades, over all chains: what a picture of thirty decades does not show; a fiftieth of its
# height
SEEN, SMALL = 0.2, 0.6
SLOPE_CHAIN, SLOPE_SEEDS, SLOPE_TIME = 32, 4, 3e4  # packets whose slope is followed in energy
LAMBDAS = {"weak": (5e-10, 5e-9, 5e-8), "strong": (5e-4, 5e-3, 5e-2)}
SAME = 0.005  # of slopes and intercepts of a law: half a unit of the last printed digit
SAME_RATE = 0.05  # relative


def figure4(folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """Spectra of FPU-trajectories for N = 64 .. 512, both models, phases 0 and random."""
    lines = [printed_line(label) for label in ("Fig. 4a", "Fig. 4b")]
    step("fig4: phases 0")
    with ThreadPoolExecutor(2) as pool:
        equal = list(pool.map(lambda line: _trial(line, TIME), lines))
        step("fig4: random phases")
        random = list(pool.map(lambda line: _trial(line, RANDOM_TIME, random=True), lines))
    panels = [_panel(line, found) for line, found in zip(lines, equal, strict=True)]
    panels += [_panel(line, found, random=True) for line, found in zip(lines, random, strict=True)]
    claims = [*_captions(*lines), *map(_unaltered, lines)]
    claims += [_line_fits(line, found) for line, found in zip(lines, equal, strict=True)]
    claims += [_same_line(line, found) for line, found in zip(lines, equal, strict=True)]
    claims += [_law_scaling(line, found) for line, found in zip(lines, random, strict=True)]
    step("fig4: slopes by energy")
    claims += [_logarithmic(name, _rates(name)) for name in LAMBDAS]
    claims += [_condition(line) for line in lines]
    remarks = (
        f"Phases 0 to t = {TIME:.0e}; random phases, {REALISATIONS} realisations, to {RANDOM_TIME:.0e}. Seeds share the energy equally. "
        "Modes below the rounding noise of the integration are not shown.",
    )
    return PaperFigure(
        "fig4", "Fig. 4: packets in longer chains", tuple(panels), tuple(claims), remarks
    )


def _trial(line: PrintedLine, T: float, *, random: bool = False) -> ProfileInvariance:
    sizes = tuple(chain.N for chain in line.chains)
    return profile_invariance(
        line.chains[0],
        line.fraction,
        line.specific_energy,
        sizes,
        T,
        phases="random" if random else "equal",
        realisations=REALISATIONS if random else 1,
    )


def _panel(line: PrintedLine, found: ProfileInvariance, *, random: bool = False) -> Panel:
    letter = line.label[-1]
    curves = []
    for chain, rows, floor in zip(found.chains, found.spectra, found.floors, strict=True):
        kappa, e = np.arange(1.0, chain.N) / chain.N, rows.mean(axis=0)
        above = e > floor
        curves.append(Curve(f"$N = {chain.N}$", kappa[above], e[above], "points"))
    least = min(float(curve.y.min()) for curve in curves)
    kappa = np.linspace(0.01, max(float(curve.x.max()) for curve in curves), 200)
    title = f"Fig. 4({letter}): {line.chains[0].model} model, {'random phases' if random else 'phases 0'}"
    axes = ("kappa", "average_energy_over_E")
    name = f"fig4{letter}-random" if random else f"fig4{letter}"
    return Panel(
        name,
        title,
        r"$\kappa = q/N$",
        r"$e_\kappa$",
        (*curves, caption_curve(line, kappa)),
        axes,
        bottom=least / 10,
    )


def _captions(alpha: PrintedLine, beta: PrintedLine) -> tuple[Claim, Claim]:
    first, third = alpha.chains[0], beta.chains[2]
    readings = {f"N = {first.N} and kappa = q/(N-1)": law_of(alpha, first, denominator=first.N - 1)}
    return caption_claim(alpha, "6.1.1", readings), caption_claim(
        beta, "6.1.2", {f"N = {third.N} alone": law_of(beta, third)}
    )


def _unaltered(line: PrintedLine) -> Claim:
    """What the law itself says of longer chains."""
    laws = [law_of(line, chain) for chain in line.chains]
    slopes, intercepts = (
        [float(getattr(law, name)) for law in laws] for name in ("slope", "intercept")
    )
    same_slope, same_intercept = (
        max(values) - min(values) <= SAME for values in (slopes, intercepts)
    )
    ours = (
        f"slope {slopes[0]:.2f} for N = {line.chains[0].N}, {slopes[-1]:.2f} for N = {line.chains[-1].N}; intercept {intercepts[0]:.2f}, "
        f"{intercepts[-1]:.2f}"
    )
    ours += (
        ""
        if same_intercept
        else ": e_kappa is a share of the whole energy and falls as 1/N; what stays is N e_kappa = E_q/eps"
    )
    text = f"by Eq. {'eksa2' if line.chains[0].alpha else 'eksp2'} the normalised profile remains unaltered as N increases at fixed M and eps"
    return Claim(_section(line), text, "", ours, judged(same_slope and same_intercept, same_slope))


def _section(line: PrintedLine) -> str:
    return "6.1.1" if line.chains[0].alpha else "6.1.2"


def _line_fits(line: PrintedLine, found: ProfileInvariance) -> Claim:
    """How far middle modes of the groups, for which the laws are made, are from the line of the
    caption.
    """
    worst = []
    for chain, rows, floor in zip(found.chains, found.spectra, found.floors, strict=True):
        e, middle = rows.mean(axis=0), np.array(middle_modes(chain, line.seeds(chain)))
        middle = middle[e[middle - 1] > floor[middle - 1]]
        printed = np.log10(caption_curve(line, middle / chain.N).y)
        worst.append(float(np.max(np.abs(np.log10(e[middle - 1]) - printed))))
    sizes = ", ".join(
        f"{off:.2g} for N = {chain.N}" for off, chain in zip(worst, found.chains, strict=True)
    )
    text = f"{line.label}: the line of the caption fits the spectra"
    return Claim(
        _section(line),
        text,
        "",
        f"middle modes off by up to {sizes} decades",
        judged(max(worst) <= SIMILAR, min(worst) <= SIMILAR),
    )


def _growth(found: ProfileInvariance) -> str:
    late = found.late_growth
    sizes = f"N = {found.chains[-2].N} to {found.chains[-1].N}"
    rates = ", ".join(
        f"D_{k} {trend.rate:.2f} +- {trend.error:.2f} ({late[k]:.2f})"
        for k, trend in found.growth.items()
    )
    return f"{rates}; in brackets from {sizes}"


def _same_line(line: PrintedLine, found: ProfileInvariance) -> Claim:
    """Do spectra of all N lie on each other?"""
    decades = math.log10(found.chains[-1].N / found.chains[0].N)
    moved = max(abs(trend.rate - 1) * decades for trend in found.growth.values())
    worst, kappa = found.moved()
    ours = (
        f"middle modes of the groups, at the same kappas: E_q/eps ~ N^c, c = {_growth(found)}. So e_kappa moves by {moved:.2f} decades "
        f"from N = {found.chains[0].N} to {found.chains[-1].N}, at the edges of groups by up to {worst:.1f} (kappa = {kappa:g})"
    )
    text = f"{line.label}: the spectra of all N lie on one line (phases 0)"
    return Claim(_section(line), text, "", ours, judged(worst <= SEEN, moved <= SMALL))


def _law_scaling(line: PrintedLine, found: ProfileInvariance) -> Claim:
    ours = f"E_q/eps ~ N^c, by the laws with c = 0, here with c = {_growth(found)}"
    still = [abs(trend.rate) <= STILL for trend in found.growth.values()]
    text = (
        f"the law's dependence on N, {line.chains[0].model} model, random phases (not in the paper)"
    )
    return Claim(_section(line), text, "", ours, judged(all(still), any(still)))


def _rates(name: str) -> tuple[Trend, float, float]:
    """Rate of the slope with log10 eps for three energies, and slope and law at the highest one."""
    chain, s = Chain(SLOPE_CHAIN, alpha="0.33"), SLOPE_SEEDS
    unit = packet_parameter(chain, s, 1.0)
    energies = [value / unit for value in LAMBDAS[name]]
    spectra = []
    for energy in energies:
        start = fpu_trajectory(chain, packet_amplitudes(chain, range(1, s + 1), energy * chain.N))
        orbit = follow("fig4 slopes", chain, start, SLOPE_TIME, unheard, samples=1)
        assert orbit.averages is not None
        spectra.append(orbit.averages[-1])
    trend = slope_by_energy(chain, s, energies, spectra, floor=0.0)
    return trend, float(trend.y[-1]), math.log10(LAMBDAS[name][-1]) * chain.N / s


def _logarithmic(name: str, found: tuple[Trend, float, float]) -> Claim:
    trend, slope, law = found
    expected = SLOPE_CHAIN / SLOPE_SEEDS
    low, high = LAMBDAS[name][0], LAMBDAS[name][-1]
    ours = (
        f"lambda from {low:g} to {high:g} (N = {SLOPE_CHAIN}, s = {SLOPE_SEEDS}): slope changes by {trend.rate:.2f} +- {trend.error:.2f} "
        f"a decade of energy, by the law {expected:g}; slope {slope:.1f} at lambda = {high:g}, by the law {law:.1f}"
    )
    text = f"the slope goes as log(energy), Eq. eksa2: {name} packets"
    return Claim(
        "6.1.1",
        text,
        "1/M a decade",
        ours,
        judged(abs(trend.rate / expected - 1) <= SAME_RATE, trend.rate > 0),
    )


def _condition(line: PrintedLine) -> Claim:
    """The width at which lambda = 1."""
    chain = line.chains[-1]
    least, eps = least_packet(chain, line.specific_energy), line.specific_energy
    printed = (
        chain.N * float(chain.alpha**2 * eps if chain.alpha else (chain.beta * eps) ** 2) ** 0.25
    )
    formula = "alpha^(1/2) eps^(1/4) N" if chain.alpha else "(beta eps)^(1/2) N"
    ours = f"at N = {chain.N} lambda = 1 at s = {least:.2f}, the formula gives {printed:.2f}, {printed / least:.3f} times as much"
    verdict = judged(abs(printed / least - 1) <= SAME_RATE, 0.1 <= printed / least <= 10)
    return Claim(_section(line), f"lambda < 1 means s > {formula}", "", ours, verdict)
