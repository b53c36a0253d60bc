"""Claims of section 7, of section 6.4's opening and of Appendix E that stand in no figure.

How far FPU-trajectories are from breathers, how many frequencies they have, how tori compare with
breathers in slope and in number of terms, and how many products Appendix E sums.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import breather_of_energy
from symfpu.chain.chain import Chain
from symfpu.localization.laws import profile_law
from symfpu.localization.profiles import fpu_trajectory
from symfpu.paper.claims import Claim, judged
from symfpu.series.lindstedt import lindstedt
from symfpu.spectral.mapping import FrequencyMap, frequency_map
from symfpu.tori.energy import Energy
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]

LENGTH, COUPLING = 32, "0.33"  # of Figs. 2, 7 and 9
ENERGIES = ("0.00001", "0.0001", "0.001", "0.01")
MAP_LENGTH, MAP_ENERGIES = (
    16,
    ("0.0001", "0.003", "0.1"),
)  # half the length is told apart sooner
MAP_TIME = 1e5  # half of it is a hundred turns of 2 omega_1 - omega_2
MAP_LINES = 16
LEVEL = 1e-3  # of the strongest f A
SLOPE_LENGTH, SLOPE_ENERGY = 64, 1e-8  # eps
SLOPE_SEEDS = (4, 8)  # M = 1/16, 1/8
SLOPE_GROUPS = 3
SAME_SLOPE = 0.02  # relative
TERM_ORDER = 6
TERM_SEEDS = ((1,), (1, 2), (1, 2, 3, 4))
FEWER_TERMS = 5.0  # times: "substantially smaller"
PACKETS = range(2, 6)  # s of the products of Appendix E
PRODUCT_LENGTH = 60  # so long that nothing folds


def conclusion_claims() -> list[Claim]:
    """All of them, in some ten seconds."""
    return [
        distance_claim(*distances()),
        number_claim(numbers_of_frequencies()),
        similar_slope_claim(*slopes()),
        terms_claim(numbers_of_terms()),
        products_claim(*products()),
    ]


def distances() -> tuple[tuple[str, ...], list[float]]:
    """Of the states at t = 0, in the energy norm, relative to the breather's; by energy."""
    chain = Chain(LENGTH, alpha=COUPLING)
    return ENERGIES, [_distance(chain, energy) for energy in ENERGIES]


def _distance(chain: Chain, energy: str) -> float:
    breather: Torus = breather_of_energy(chain, 1, Energy(energy))
    Q, P = breather.state()
    amplitude = repr(float(breather.amplitudes[1]))
    start, momenta = fpu_trajectory(chain, {1: amplitude})
    linear = chain.frequencies()
    off = np.sum((linear * (start - Q)) ** 2 + (momenta - P) ** 2)
    return float(np.sqrt(off / np.sum((linear * Q) ** 2 + P**2)))


def distance_claim(energies: Sequence[str], found: Sequence[float]) -> Claim:
    """Growing from each energy to the next."""
    text = "as the energy increases, the distance between q-breathers and FPU-trajectories "
    text += "of the same initial excitation grows"
    shown = ", ".join(f"{d:.3f} at H = {E}" for E, d in zip(energies, found, strict=True))
    ours = (
        f"N = {LENGTH}, seed 1, of the states at t = 0 relative to the breather's: {shown}"
    )
    rising = [b > a for a, b in itertools.pairwise(found)]
    return Claim("7", text, "", ours, judged(all(rising), any(rising)))


def numbers_of_frequencies() -> FrequencyMap:
    """FPU-trajectories of mode 1 over three decades of energy."""
    chain = Chain(MAP_LENGTH, alpha=COUPLING)
    return frequency_map(chain, MAP_ENERGIES, T=MAP_TIME, lines=MAP_LINES, level=LEVEL)


def number_claim(found: FrequencyMap) -> Claim:
    """More independent frequencies above a level at the higher energies."""
    text = "FPU-trajectories exhibit a dynamics consistent with an increasing number of "
    text += "incommensurable frequencies"
    pairs = zip(found.counts, found.energies, strict=True)
    shown = ", ".join(f"{count} at H = {energy:g}" for count, energy in pairs)
    ours = f"by frequency analysis, those stronger than {found.level:g} of the strongest: "
    ours += f"{shown} (N = {found.chain.N}, seed 1, T = {found.T:g})"
    never_fewer = bool((np.diff(found.counts) >= 0).all())
    more = bool(found.counts[-1] > found.counts[0])
    return Claim("7", text, "", ours, judged(never_fewer and more, more))


def slopes() -> tuple[list[float], list[float]]:
    """Of breathers of seed M N, over the modes that they excite, and of Eq. eksa2."""
    chain = Chain(SLOPE_LENGTH, alpha=COUPLING)
    breathers, laws = [], []
    for seed in SLOPE_SEEDS:
        energy = repr(SLOPE_ENERGY * chain.N)
        breather = breather_of_energy(chain, seed, Energy(energy))
        modes = seed * np.arange(1, SLOPE_GROUPS + 1)
        kappa = modes / chain.N
        spectrum = np.asarray(breather.average_spectrum(), dtype=float)[modes - 1]
        levels = np.log10(spectrum) - 2 * np.log10(kappa)
        breathers.append(float(np.polyfit(kappa, levels, 1)[0]))
        laws.append(float(profile_law(chain, seed, SLOPE_ENERGY).slope))
    return breathers, laws


def similar_slope_claim(breathers: Sequence[float], laws: Sequence[float]) -> Claim:
    """The law of packets beside breathers whose seed grows with N."""
    text = (
        "the law of the slope of tori is similar to that of q-breathers whose seed varies "
    )
    text += "proportionally to N"
    parts = []
    for seed, own, law in zip(SLOPE_SEEDS, breathers, laws, strict=True):
        parts.append(f"seed {seed}: {own:.2f}, by Eq. eksa2 {law:.2f}")
    ours = f"N = {SLOPE_LENGTH}, eps = {SLOPE_ENERGY:g}, slopes without 2 log kappa - "
    ours += "; ".join(parts)
    same = [abs(a / b - 1) <= SAME_SLOPE for a, b in zip(breathers, laws, strict=True)]
    return Claim("7", text, "", ours, judged(all(same), any(same)))


def numbers_of_terms() -> list[int]:
    """Coefficients of the coordinates to an order, for 1, 2 and 4 seeds."""
    chain = Chain(LENGTH, alpha=COUPLING)
    return [lindstedt(chain, s, order=TERM_ORDER).coefficient_count for s in TERM_SEEDS]


def terms_claim(counts: Sequence[int]) -> Claim:
    """The first count is that of the breather."""
    text = (
        "at any fixed order the number of terms is substantially smaller for q-breathers "
    )
    text += "than for q-tori of any other dimension"
    pairs = zip(TERM_SEEDS, counts, strict=True)
    shown = ", ".join(f"{count} for {len(seeds)}" for seeds, count in pairs)
    ours = f"coefficients to order {TERM_ORDER}, N = {LENGTH}, by seeds: {shown}"
    fewer = min(counts[1:]) / counts[0]
    return Claim("6.4", text, "", ours, judged(fewer >= FEWER_TERMS, fewer > 1))


def products() -> tuple[list[int], list[int], list[int]]:
    """Largest sums of products of C over the seeds 1 .. s, by s.

    Of one C; of two with the mode between them held where they are largest; and summed over it.
    """
    chain = Chain(PRODUCT_LENGTH, beta=1)
    once, held, summed = [], [], []
    for s in PACKETS:
        seeds = range(1, s + 1)
        first, second = range(s + 1, 3 * s + 1), range(3 * s + 1, 5 * s + 1)
        triples = list(itertools.product(seeds, repeat=3))
        pairs = list(itertools.product(seeds, repeat=2))
        inner = {m: sum(chain.C(m, *n) for n in triples) for m in first}
        through = {
            q: [sum(chain.C(q, m, *n) for n in pairs) * inner[m] for m in first]
            for q in second
        }
        once.append(max(inner.values()))
        held.append(max(map(max, through.values())))
        summed.append(max(map(sum, through.values())))
    return once, held, summed


def products_claim(
    once: Sequence[int], held: Sequence[int], summed: Sequence[int]
) -> Claim:
    """2s(s-1) and 4s^2(s-1), the footnote of Appendix E."""
    text = "the sums over products of C give 2s(s-1) for k = 1 and 4s^2(s-1) for k = 2"
    first = [2 * s * (s - 1) for s in PACKETS]
    second = [4 * s**2 * (s - 1) for s in PACKETS]
    ours = f"largest sums for s = {PACKETS[0]} .. {PACKETS[-1]} - k = 1: {_listed(once)}; "
    ours += f"k = 2: {_listed(held)} with the mode between held, {_listed(summed)} summed "
    ours += f"over it; the footnote gives {_listed(first)} and {_listed(second)}"
    same = list(once) == first
    both = same and second in (list(held), list(summed))
    return Claim("Appendix E", text, "", ours, judged(both, same))


def _listed(values: Sequence[int]) -> str:
    return ", ".join(map(str, values))
