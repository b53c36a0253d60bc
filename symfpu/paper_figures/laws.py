"""Fig. 4: packets of a fixed fraction of the modes at fixed energy a particle, in longer and longer chains; the laws on trial."""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.chain import Chain
from symfpu.localization import least_packet, packet_parameter
from symfpu.panels import Claim, Curve, Panel, PaperFigure, judged
from symfpu.paper import PrintedLine
from symfpu.paper_figures.captions import caption_claim, caption_curve, law_of, printed_line
from symfpu.paper_figures.starts import MODE_STEP, SCHEME, Step, follow
from symfpu.profile_trials import ProfileInvariance, Trend, profile_invariance, slope_by_energy
from symfpu.spectra import fpu_trajectory, packet_amplitudes

Floats = NDArray[np.float64]

TIME, RANDOM_TIME = 1e6, 1e5  # the paper's with phases 0; ours with random phases
REALISATIONS = 4  # of random phases
STILL = 0.15  # an exponent of N that is 0 within what edges of groups and few chains leave
SEEN = 0.2  # decades, over all chains: what a picture of thirty decades does not show
SLOPE_CHAIN, SLOPE_SEEDS, SLOPE_TIME = 32, 4, 3e4  # packets whose slope is followed in energy
LAMBDAS = {"weak": (5e-10, 5e-9, 5e-8), "strong": (5e-4, 5e-3, 5e-2)}
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
    claims = [_captions(lines[0], lines[1])[0], _captions(lines[0], lines[1])[1], _unaltered(lines)]
    claims += [_same_line(line, found) for line, found in zip(lines, equal, strict=True)]
    claims += [_law_scaling(line, found) for line, found in zip(lines, random, strict=True)]
    step("fig4: slopes by energy")
    claims += [_logarithmic(name, _rates(name)) for name in LAMBDAS]
    claims += [_condition(line) for line in lines]
    remarks = (
        f"Phases 0 to t = {TIME:.0e}; random phases, {REALISATIONS} realisations, to {RANDOM_TIME:.0e}. Seeds share the energy equally. "
        "Modes below the rounding noise of the integration are not shown.",
    )
    return PaperFigure("fig4", "Fig. 4: packets in longer chains", tuple(panels), tuple(claims), remarks)


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
    return Panel(name, title, r"$\kappa = q/N$", r"$e_\kappa$", (*curves, caption_curve(line, kappa)), axes, bottom=least / 10)


def _captions(alpha: PrintedLine, beta: PrintedLine) -> tuple[Claim, Claim]:
    first, third = alpha.chains[0], beta.chains[2]
    readings = {f"N = {first.N} and kappa = q/(N-1)": law_of(alpha, first, denominator=first.N - 1)}
    return caption_claim(alpha, "6.1.1", readings), caption_claim(beta, "6.1.2", {f"N = {third.N} alone": law_of(beta, third)})


def _unaltered(lines: Sequence[PrintedLine]) -> Claim:
    """What the laws themselves say of longer chains."""
    parts = []
    for line in lines:
        laws = [law_of(line, chain) for chain in line.chains]
        parts.append(
            f"{line.chains[0].model}: slope {laws[0].slope:.2f} for all N, intercept {laws[0].intercept:.2f} for N = {line.chains[0].N}, "
            f"{laws[-1].intercept:.2f} for N = {line.chains[-1].N}"
        )
    text = "by Eqs. eksa2 and eksp2 the normalised profiles remain unaltered as N increases at fixed couplings, eps and M"
    ours = "; ".join(parts) + ". The slope stays, e_kappa falls as 1/N: what stays is N e_kappa = E_q/eps"
    return Claim("6.1", text, "", ours, judged(False, True))


def _growth(found: ProfileInvariance) -> str:
    return ", ".join(f"D_{k} {trend.rate:.2f} +- {trend.error:.2f}" for k, trend in found.growth.items())


def _same_line(line: PrintedLine, found: ProfileInvariance) -> Claim:
    """Do spectra of all N lie on each other?"""
    decades = math.log10(found.chains[-1].N / found.chains[0].N)
    moved = max(abs(trend.rate - 1) * decades for trend in found.growth.values())
    worst, kappa = found.moved()
    ours = (
        f"middle modes of the groups: E_q/eps ~ N^c, c = {_growth(found)}, so that e_kappa moves by {moved:.2f} decades from N = "
        f"{found.chains[0].N} to {found.chains[-1].N}; at the edges of groups by up to {worst:.1f} (kappa = {kappa:g})"
    )
    text = f"{line.label}: the same line fits the spectra for all N (phases 0)"
    return Claim("6.1.1" if line.chains[0].alpha else "6.1.2", text, "", ours, judged(worst <= SEEN, moved <= SEEN))


def _law_scaling(line: PrintedLine, found: ProfileInvariance) -> Claim:
    ours = f"E_q/eps ~ N^c with c = {_growth(found)}: by the laws 0"
    off = max(abs(trend.rate) for trend in found.growth.values())
    text = f"the law's dependence on N, {line.chains[0].model} model, random phases (not in the paper)"
    return Claim("6.1", text, "", ours, judged(off <= STILL, off <= 1 / 2))


def _rates(name: str) -> tuple[Trend, float, float]:
    """Rate of the slope with log10 eps for three energies, and slope and law at the highest one."""
    chain, s = Chain(SLOPE_CHAIN, alpha="0.33"), SLOPE_SEEDS
    unit = packet_parameter(chain, s, 1.0)
    energies = [value / unit for value in LAMBDAS[name]]
    spectra = []
    for energy in energies:
        start = fpu_trajectory(chain, packet_amplitudes(chain, range(1, s + 1), energy * chain.N))
        orbit = follow("fig4 slopes", chain, start, SLOPE_TIME, lambda label: None, samples=1, scheme=SCHEME, step=MODE_STEP)
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
    return Claim("6.1.1", text, "1/M a decade", ours, judged(abs(trend.rate / expected - 1) <= SAME_RATE, trend.rate > 0))


def _condition(line: PrintedLine) -> Claim:
    """The width at which lambda = 1."""
    chain = line.chains[-1]
    least = least_packet(chain, line.specific_energy)
    formula = "alpha^(1/2) eps^(1/4) N" if chain.alpha else "(beta eps)^(1/2) N"
    sizes = f"{math.pi * least:.1f} for {least:.1f} at N = {chain.N}"
    ours = f"lambda = 1 at s = {formula} / pi: the printed width is pi times too large ({sizes})"
    return Claim("6.1.1" if chain.alpha else "6.1.2", f"lambda < 1 means s > {formula}", "", ours, judged(False, True))
