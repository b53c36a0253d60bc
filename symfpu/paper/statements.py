"""Statements of sections 2 to 7 that no figure shows: each decided by a computation of its own."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import symengine as se

from symfpu.chain.chain import Chain
from symfpu.chain.commensurability import frequency_rank
from symfpu.chain.propagation import excitation_sequence, reachable_modes
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.localization.laws import ProfileLine, profile_law
from symfpu.paper.appendix_a_claims import algorithm_claim
from symfpu.paper.breather_claims import breather_claims
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.conclusion_claims import conclusion_claims
from symfpu.paper.judgements import runs
from symfpu.paper.natural_slopes import natural_slopes, natural_slopes_claim
from symfpu.series.lindstedt import lindstedt

Modes = tuple[int, ...]

RANKED_CHAINS = range(3, 33)  # whose relations are found exactly
SECULAR_CHAIN, SECULAR_SEEDS = 9, (1, 2)
SECULAR_ORDERS = {"alpha": 4, "beta": 2}
LOW_CHAIN, LOW_WIDTHS, LOW_ORDER = 200, range(1, 7), 4  # packets of section 5
CONDITION_CHAIN, CONDITION_ORDER = 8, 3  # of all sets of up to three seeds
SLOPE_WIDTHS = ("1/8", "1/16")  # M of the slopes
SLOPE_CHAIN = 64
# the first two have the same alpha^2 eps
SLOPE_PAIRS = (("0.5", 1e-7), ("0.25", 4e-7), ("0.33", 1e-8), ("0.1", 1e-8))
SLOPE_TOLERANCE = 1e-9  # relative: a formula in doubles


def statements(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """Claims that belong to no figure; no panels."""
    progress("statements: exact ones", NO_FRACTION)
    claims = [
        commensurability_claim(),
        *secular_claims(),
        united_groups_claim(),
        condition_claim(),
        thirds_claim(),
        slopes_claim(),
    ]
    progress("statements: Appendix A", NO_FRACTION)
    claims.append(algorithm_claim())
    progress("statements: natural packets", NO_FRACTION)
    claims.append(natural_slopes_claim(*natural_slopes()))
    progress("statements: breathers", NO_FRACTION)
    claims += breather_claims()
    progress("statements: conclusions", NO_FRACTION)
    claims += conclusion_claims()
    title = "Statements of sections 2 to 7 that no figure shows"
    return PaperFigure("statements", title, (), tuple(claims))


def commensurability_claim(
    lengths: Sequence[int] = RANKED_CHAINS, rank: Callable[[int], int] = frequency_rank
) -> Claim:
    """The condition of section 2 under which no relation holds. rank : of the frequencies."""
    promised, related, free = [], [], []
    for N in lengths:
        independent = rank(N) == N - 1
        if _prime(N - 1) or N & (N - 1) == 0:
            promised.append(N)
            if not independent:
                related.append(N)
        elif independent:
            free.append(N)
    text = "the linear frequencies satisfy no commensurability relation if N-1 is prime, "
    text += "or N a power of two"
    ours = f"exact ranks for N to {lengths[-1]}: of the {len(promised)} chains promised "
    ours += f"{len(related)} have relations, N = {runs(tuple(related))}"
    ours += f"; not promised and without relations: N = {runs(tuple(free))}"
    powers = not any(N & (N - 1) == 0 for N in related)
    if related and powers:
        ours += "; powers of two are right, and it is N that has to be prime, not N-1"
    return Claim("2", text, "", ours, judged(not related, powers))


def _prime(n: int) -> bool:
    return n > 1 and all(n % d for d in range(2, math.isqrt(n) + 1))


def secular_claims() -> Iterator[Claim]:
    """Where secular terms appear, and the degree of frequency corrections."""
    by_model = {}
    for model, last in SECULAR_ORDERS.items():
        chain = Chain(SECULAR_CHAIN, alpha=int(model == "alpha"), beta=int(model == "beta"))
        series = lindstedt(chain, SECULAR_SEEDS, order=last)
        found = {}
        for k in range(1, last + 1):
            found[k] = [series.frequency_correction(q, k) for q in SECULAR_SEEDS]
        by_model[model] = found
    yield secular_claim(by_model)
    yield degree_claim(by_model)


def secular_claim(corrections: dict[str, dict[int, list[Any]]]) -> Claim:
    """corrections : omega_q^(k) of each seed, by model and order."""
    right = {}
    parts = []
    for model, found in corrections.items():
        excited = [k for k, values in found.items() if any(v != 0 for v in values)]
        step = 2 if model == "alpha" else 1
        right[model] = excited == [k for k in found if k % step == 0]
        parts.append(f"{model}: corrections at orders {runs(tuple(excited))}")
    ours = (
        f"exactly, N = {SECULAR_CHAIN}, seeds {runs(SECULAR_SEEDS)} - {'; '.join(parts)}, "
    )
    ours += f"of orders to {', '.join(str(max(found)) for found in corrections.values())}"
    text = "secular terms appear at even orders in alpha, and at all orders in beta"
    verdict = judged(all(right.values()), any(right.values()))
    return Claim("3.1", text, "", ours, verdict)


def degree_claim(corrections: dict[str, dict[int, list[Any]]]) -> Claim:
    """The degree of omega_q^(k) in the amplitudes."""
    degrees = {}
    right = []
    for model, found in corrections.items():
        for k, values in found.items():
            for value in values:
                if value != 0:
                    degree = _degree(value)
                    degrees[f"{model}, k = {k}"] = degree
                    right.append(degree == (k + 1 if model == "alpha" else 2 * k + 1))
    shown = "; ".join(f"{name}: {degree}" for name, degree in degrees.items())
    ours = f"degrees {shown}: k in alpha and 2k in beta"
    text = "omega^(k) is a polynomial of order k+1 (alpha), 2k+1 (beta) in the amplitudes"
    return Claim("3.1", text, "k+1, 2k+1", ours, judged(all(right), any(right)))


def _degree(value: Any) -> int:
    """Of a homogeneous polynomial in A_q: the power of 2 by which doubled amplitudes change it."""
    doubled = {se.Symbol(f"A{q}"): 2 * se.Symbol(f"A{q}") for q in SECULAR_SEEDS}
    scaled = se.expand(value.subs(doubled))
    degree = 0
    while se.expand(2**degree * value - scaled) != 0:
        degree += 1
    return degree


def united_groups_claim(widths: Sequence[int] = LOW_WIDTHS) -> Claim:
    """D_k of beta is two groups of alpha, for low packets of these widths."""
    wrong = []
    for s in widths:
        seeds = range(1, s + 1)
        alpha = excitation_sequence(LOW_CHAIN, seeds, 2 * LOW_ORDER)
        beta = excitation_sequence(LOW_CHAIN, seeds, LOW_ORDER, model="beta")
        united = [
            tuple(sorted(alpha[2 * k - 1] + alpha[2 * k])) for k in range(1, LOW_ORDER + 1)
        ]
        if beta[1:] != united:
            wrong.append(s)
    ours = f"for s = {widths[0]} .. {widths[-1]}, k to {LOW_ORDER}"
    if wrong:
        ours += f", but for s = {runs(tuple(wrong))}"
    if wrong == [1]:
        ours += ": the breather of beta skips the even modes"
    text = "example iii: D_k of beta is the union of D_(2k-1) and D_2k of alpha"
    return Claim("5", text, "", ours, judged(not wrong, len(wrong) < len(widths)))


def condition_claim(
    reachable: Callable[[int, Modes, int], list[Modes]] = reachable_modes,
) -> Claim:
    """The condition at the end of section 5, for all small seed sets of a short chain.

    reachable : the sets M_k of alpha.
    """
    N, order = CONDITION_CHAIN, CONDITION_ORDER
    counts = {(met, same): 0 for met in (True, False) for same in (True, False)}
    first: Modes = ()
    for seeds in _seed_sets(N):
        reached = reachable(N, seeds, 2 * order)
        met = not any(
            set(reached[2 * k - 1]) & set(reached[2 * k]) for k in range(1, order + 1)
        )
        alpha = excitation_sequence(N, seeds, 2 * order)[::2]
        same = alpha == excitation_sequence(N, seeds, order, model="beta")
        counts[met, same] += 1
        if met and not same and not first:
            first = seeds
    held, failed = counts[True, True], counts[True, False]
    ours = (
        f"all sets of up to three seeds of N = {N}, k to {order}: the condition holds for "
    )
    ours += f"{held + failed}, the equality then for {held}"
    if first:
        ours += f" (not for {runs(first)}: an earlier odd set has met a mode of M_2k)"
    ours += f"; without the condition it holds for {counts[False, True]} of "
    ours += f"{counts[False, True] + counts[False, False]}, so it is not necessary"
    text = "D_k of beta is D_2k of alpha provided that M_(2k-1) and M_2k of alpha "
    text += "have no mode in common"
    necessary = counts[False, True] == 0
    verdict = judged(not failed and necessary, held > failed)
    return Claim("5", text, "", ours, verdict)


def _seed_sets(N: int) -> Iterator[Modes]:
    for s in (1, 2, 3):
        yield from itertools.combinations(range(1, N), s)


def thirds_claim(thirds: int = 3) -> Claim:
    """'One fourth, half and three thirds of the spectrum'."""
    place = thirds / 3
    is_a_mode = place < 1
    text = "packets around one fourth, half and three thirds of the spectrum"
    ours = f"three thirds is kappa = {place:g}, which no mode has: "
    ours += "the list below it and Fig. 6(c) are of 3/4"
    return Claim("6.3", text, "three thirds", ours, judged(is_a_mode))


def slopes_claim(law: Callable[[Chain, int, float], ProfileLine] = profile_law) -> Claim:
    """The slope of tori goes with log [alpha^(-1/2) eps^(-1/4)]^-4, not with the number itself."""
    worst = 0.0
    rates = []
    for width in SLOPE_WIDTHS:
        x, slopes = _slopes(width, law)
        rate = -4 / _value(width)
        off = slopes - slopes[0] - rate * np.log10(x / x[0])
        worst = max(worst, float(np.abs(off / slopes).max()))
        rates.append(f"M = {width}: {rate:g} a decade of alpha^(-1/2) eps^(-1/4)")
    text = "the slope of q-tori depends logarithmically on [alpha^(-1/2) eps^(-1/4)]^-4; "
    text += "other fractions M give other laws"
    ours = f"Eq. eksa2 for {len(SLOPE_PAIRS)} pairs of alpha and eps - {'; '.join(rates)}, "
    ours += "which is -4/M, and nothing else of them enters"
    return Claim("6.1.1", text, "", ours, judged(worst <= SLOPE_TOLERANCE))


def _slopes(width: str, law: Callable[[Chain, int, float], ProfileLine]) -> tuple[Any, Any]:
    """alpha^(-1/2) eps^(-1/4) and the slopes of the law."""
    x, slopes = [], []
    s = round(SLOPE_CHAIN * _value(width))
    for alpha, epsilon in SLOPE_PAIRS:
        chain = Chain(SLOPE_CHAIN, alpha=alpha)
        x.append(float(chain.alpha) ** -0.5 * epsilon**-0.25)
        slopes.append(law(chain, s, epsilon).slope)
    return np.array(x), np.array(slopes)


def _value(width: str) -> float:
    numerator, denominator = width.split("/")
    return int(numerator) / int(denominator)
