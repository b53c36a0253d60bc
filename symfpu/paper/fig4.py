"""Fig. 4: packets in longer and longer chains, and the laws on trial.

A fixed fraction of the modes at fixed energy a particle. The claims are those of section 6.1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.figures.panels import Curve, Panel
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.localization.laws import least_packet, middle_modes, packet_parameter
from symfpu.localization.profiles import fpu_trajectory, packet_amplitudes
from symfpu.localization.trials import (
    ProfileInvariance,
    Trend,
    profile_invariance,
    slope_by_energy,
)
from symfpu.paper.captions import caption_claim, caption_curve, law_of, printed_line
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.judgements import SIMILAR_DECADES
from symfpu.paper.printed import PrintedLine
from symfpu.paper.starts import integrated_orbit
from symfpu.paper.torus_laws import (
    TorusLaw,
    exponents_table,
    factor_claim,
    factors_table,
    invariance_claim,
    torus_law,
)

Floats = NDArray[np.float64]
TIME, RANDOM_TIME = 1e6, 1e5  # the paper's with phases 0; ours with random phases
REALISATIONS = 4  # of random phases
# of the orbits: averages are those of a step and a look of 1/4 to 1e-5 decades by the median, and
# to the noise in the last modes above it
SCHEME, STEP, LOOK = "blanes_moan6", 1.25, 5.0
# decades, over all chains: what a picture of thirty decades does not show; a fiftieth of its
# height
UNSEEN_DECADES, SHIFT_DECADES = 0.2, 0.6
SLOPE_CHAIN, SLOPE_SEEDS, SLOPE_TIME = (
    32,
    4,
    3e4,
)  # packets whose slope is followed in energy
LAMBDAS = {"weak": (5e-10, 5e-9, 5e-8), "strong": (5e-4, 5e-3, 5e-2)}
# of slopes and intercepts of a law: half a unit of the last printed digit
LAW_TOLERANCE = 0.005
RATE_TOLERANCE = 0.05  # relative
LEFT_LAW = 0.1  # relative: a slope that has left the law
CURVE_START, CURVE_POINTS = 0.01, 200  # kappa of the line of the caption
BOTTOM_SHARE = 10  # of the least energy shown, the bottom of the picture


def figure4(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """Spectra of FPU-trajectories for N = 64 .. 512, both models, phases 0 and random."""
    lines = [printed_line("Fig. 4a"), printed_line("Fig. 4b")]
    progress("fig4: phases 0", NO_FRACTION)
    with ThreadPoolExecutor(2) as pool:
        equal = list(pool.map(partial(_trial, T=TIME), lines))
        progress("fig4: random phases", NO_FRACTION)
        random = list(pool.map(partial(_trial, T=RANDOM_TIME, random=True), lines))
    panels = [spectra_panel(line, found) for line, found in zip(lines, equal, strict=True)]
    for line, found in zip(lines, random, strict=True):
        panels.append(spectra_panel(line, found, random=True))
    claims = [*_captions(*lines), *map(unaltered_claim, lines)]
    claims += map(line_claim, lines, equal)
    claims += map(same_line_claim, lines, equal)
    progress("fig4: tori", NO_FRACTION)
    laws = [torus_law(line) for line in lines]
    claims += map(invariance_claim, laws, random)
    claims += map(factor_claim, laws)
    progress("fig4: slopes by energy", NO_FRACTION)
    rates = {name: _rates(name) for name in LAMBDAS}
    claims += [logarithm_claim(name, found) for name, found in rates.items()]
    claims.append(validity_claim({name: found[0] for name, found in rates.items()}))
    claims += map(condition_claim, lines)
    remark = f"Phases 0 to t = {TIME:.0e}; random phases, {REALISATIONS} realisations, "
    remark += f"to {RANDOM_TIME:.0e}. Seeds share the energy equally. "
    remark += "Modes below the rounding noise of the integration are not shown."
    title = "Fig. 4: packets in longer chains"
    text = laws_text(laws, equal, random)
    return PaperFigure("fig4", title, tuple(panels), tuple(claims), (remark,), text)


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
        scheme=SCHEME,
        step=STEP,
        look=LOOK,
    )


def spectra_panel(
    line: PrintedLine, found: ProfileInvariance, *, random: bool = False
) -> Panel:
    """Spectra of all chains above the noise, and the line of the caption."""
    curves = []
    for chain, rows, floor in zip(found.chains, found.spectra, found.floors, strict=True):
        kappa = np.arange(1.0, chain.N) / chain.N
        e = rows.mean(axis=0)
        above = e > floor
        curves.append(Curve(f"$N = {chain.N}$", kappa[above], e[above], "points"))
    least = min(float(curve.y.min()) for curve in curves)
    last = max(float(curve.x.max()) for curve in curves)
    law = caption_curve(line, np.linspace(CURVE_START, last, CURVE_POINTS))
    letter = line.label[-1]
    phases = "random phases" if random else "phases 0"
    name = f"fig4{letter}-random" if random else f"fig4{letter}"
    title = f"Fig. 4({letter}): {line.chains[0].model} model, {phases}"
    labels = (r"$\kappa = q/N$", r"$e_\kappa$")
    axes = ("kappa", "average_energy_over_E")
    return Panel(name, title, *labels, (*curves, law), axes, bottom=least / BOTTOM_SHARE)


def _captions(alpha: PrintedLine, beta: PrintedLine) -> tuple[Claim, Claim]:
    first = alpha.chains[0]
    third = beta.chains[2]
    reading = f"N = {first.N} and kappa = q/(N-1)"
    of_alpha = {reading: law_of(alpha, first, denominator=first.N - 1)}
    of_beta = {f"N = {third.N} alone": law_of(beta, third)}
    return (caption_claim(alpha, "6.1.1", of_alpha), caption_claim(beta, "6.1.2", of_beta))


def unaltered_claim(line: PrintedLine) -> Claim:
    """What the law itself says of longer chains."""
    shortest, longest = line.chains[0], line.chains[-1]
    laws = [law_of(line, chain) for chain in line.chains]
    slopes = [float(law.slope) for law in laws]
    intercepts = [float(law.intercept) for law in laws]
    same_slope = max(slopes) - min(slopes) <= LAW_TOLERANCE
    same_intercept = max(intercepts) - min(intercepts) <= LAW_TOLERANCE
    ours = f"slope {slopes[0]:.2f} for N = {shortest.N}, "
    ours += f"{slopes[-1]:.2f} for N = {longest.N}; "
    ours += f"intercept {intercepts[0]:.2f}, {intercepts[-1]:.2f}"
    if not same_intercept:
        ours += ": e_kappa is a share of the whole energy and falls as 1/N; "
        ours += "what stays is N e_kappa = E_q/eps"
    equation = "eksa2" if shortest.alpha else "eksp2"
    text = f"by Eq. {equation} the normalised profile remains unaltered "
    text += "as N increases at fixed M and eps"
    verdict = judged(same_slope and same_intercept, same_slope)
    return Claim(_section(line), text, "", ours, verdict)


def _section(line: PrintedLine) -> str:
    return "6.1.1" if line.chains[0].alpha else "6.1.2"


def line_claim(line: PrintedLine, found: ProfileInvariance) -> Claim:
    """How far middle modes of the groups are from the line of the caption.

    The laws are made for them.
    """
    worst = []
    sizes = []
    for chain, rows, floor in zip(found.chains, found.spectra, found.floors, strict=True):
        e = rows.mean(axis=0)
        middle = np.array(middle_modes(chain, line.seeds(chain)))
        middle = middle[e[middle - 1] > floor[middle - 1]]
        printed = np.log10(caption_curve(line, middle / chain.N).y)
        levels = np.log10(e[middle - 1])
        off = float(np.max(np.abs(levels - printed)))
        worst.append(off)
        sizes.append(f"{off:.2g} for N = {chain.N}")
    text = f"{line.label}: the line of the caption fits the spectra"
    ours = f"middle modes off by up to {', '.join(sizes)} decades"
    verdict = judged(max(worst) <= SIMILAR_DECADES, min(worst) <= SIMILAR_DECADES)
    return Claim(_section(line), text, "", ours, verdict)


def _growth(found: ProfileInvariance) -> str:
    """Exponents of N by group, of all chains and of the last two."""
    late = found.late_growth
    rates = []
    for k, trend in found.growth.items():
        rates.append(f"D_{k} {trend.rate:.2f} +- {trend.error:.2f} ({late[k]:.2f})")
    sizes = f"N = {found.chains[-2].N} to {found.chains[-1].N}"
    return f"{', '.join(rates)}; in brackets from {sizes}"


def same_line_claim(line: PrintedLine, found: ProfileInvariance) -> Claim:
    """Do spectra of all N lie on each other?"""
    first, last = found.chains[0].N, found.chains[-1].N
    decades = math.log10(last / first)
    moved = max(abs(trend.rate - 1) * decades for trend in found.growth.values())
    worst, kappa = found.moved()
    ours = "middle modes of the groups, at the same kappas: E_q/eps ~ N^c, "
    ours += f"c = {_growth(found)}. So e_kappa moves by {moved:.2f} decades "
    ours += f"from N = {first} to {last}, "
    ours += f"at the edges of groups by up to {worst:.1f} (kappa = {kappa:g})"
    text = f"{line.label}: the spectra of all N lie on one line (phases 0)"
    verdict = judged(worst <= UNSEEN_DECADES, moved <= SHIFT_DECADES)
    return Claim(_section(line), text, "", ours, verdict)


def laws_text(
    laws: Sequence[TorusLaw],
    equal: Sequence[ProfileInvariance],
    random: Sequence[ProfileInvariance],
) -> tuple[str, ...]:
    """The one table of exponents, and that of factors."""
    models = [law.line.chains[0].model for law in laws]
    by_model = [dict(zip(models, found, strict=True)) for found in (equal, random)]
    tori = dict(zip(models, laws, strict=True))
    exponents = (
        "Exponents c of E_q/eps ~ N^c in the middle halves of the groups, by the laws 0. "
    )
    exponents += "On tori: leading order, no draws. Errors are of the spread over draws."
    factors = "Factors of middle modes on tori, E^(k) = C_k (eps/M) lambda^k, or lambda^2k in beta."
    return (
        exponents,
        exponents_table(tori, *by_model),
        factors,
        factors_table(tori),
    )


def _rates(name: str) -> tuple[Trend, float, float]:
    """Rate of the slope with log10 eps for three energies, and slope and law at the highest one."""
    chain = Chain(SLOPE_CHAIN, alpha="0.33")
    s = SLOPE_SEEDS
    unit = packet_parameter(chain, s, 1.0)
    energies = [value / unit for value in LAMBDAS[name]]
    spectra = []
    for energy in energies:
        amplitudes = packet_amplitudes(chain, range(1, s + 1), energy * chain.N)
        start = fpu_trajectory(chain, amplitudes)
        orbit = integrated_orbit(
            "fig4 slopes", chain, start, SLOPE_TIME, unheard, samples=1
        )
        assert orbit.averages is not None
        spectra.append(orbit.averages[-1])
    trend = slope_by_energy(chain, s, energies, spectra, floor=0.0)
    law = math.log10(LAMBDAS[name][-1]) * chain.N / s
    return trend, float(trend.y[-1]), law


def logarithm_claim(name: str, found: tuple[Trend, float, float]) -> Claim:
    """The change of the slope a decade of energy, and the slope itself."""
    trend, slope, law = found
    expected = SLOPE_CHAIN / SLOPE_SEEDS
    low, high = LAMBDAS[name][0], LAMBDAS[name][-1]
    ours = f"lambda from {low:g} to {high:g} (N = {SLOPE_CHAIN}, s = {SLOPE_SEEDS}): "
    ours += f"slope changes by {trend.rate:.2f} +- {trend.error:.2f} a decade of energy, "
    ours += f"by the law {expected:g}; "
    ours += f"slope {slope:.1f} at lambda = {high:g}, by the law {law:.1f}"
    text = f"the slope goes as log(energy), Eq. eksa2: {name} packets"
    as_expected = abs(trend.rate / expected - 1) <= RATE_TOLERANCE
    return Claim("6.1.1", text, "1/M a decade", ours, judged(as_expected, trend.rate > 0))


def validity_claim(trends: Mapping[str, Trend]) -> Claim:
    """From which lambda on the slope leaves the law by more than a tenth."""
    factor = SLOPE_CHAIN / SLOPE_SEEDS
    off = {}
    for name, trend in trends.items():
        for value, slope in zip(LAMBDAS[name], trend.y, strict=True):
            law = math.log10(value) * factor
            off[value] = abs(float(slope) / law - 1)
    left = [value for value in sorted(off) if off[value] > LEFT_LAW]
    shown = ", ".join(f"{value:g}: {off[value]:.0%}" for value in sorted(off))
    text = "the analysis of leading terms ceases to be valid as lambda approaches 1"
    ours = f"slope beside its law by lambda - {shown}"
    if left:
        ours += f"; off by more than {LEFT_LAW:.0%} from lambda = {left[0]:g} on"
    kept = [value for value in off if value not in left]
    ends = bool(left) and bool(kept) and max(kept) < min(left)
    return Claim("6.1.1", text, "", ours, judged(ends, bool(left)))


def condition_claim(
    line: PrintedLine, width: Callable[[Chain, float], float] = least_packet
) -> Claim:
    """The width at which lambda = 1."""
    chain, eps = line.chains[-1], line.specific_energy
    least = width(chain, eps)
    if chain.alpha:
        formula = "alpha^(1/2) eps^(1/4) N"
        fourth_power = float(chain.alpha**2 * eps)
    else:
        formula = "(beta eps)^(1/2) N"
        fourth_power = float((chain.beta * eps) ** 2)
    printed = chain.N * fourth_power**0.25
    ratio = printed / least
    ours = f"at N = {chain.N} lambda = 1 at s = {least:.2f}, "
    ours += f"the formula gives {printed:.2f}, {ratio:.3f} times as much"
    verdict = judged(abs(ratio - 1) <= RATE_TOLERANCE, 0.1 <= ratio <= 10)
    return Claim(_section(line), f"lambda < 1 means s > {formula}", "", ours, verdict)
