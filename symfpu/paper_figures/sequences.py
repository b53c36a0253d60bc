"""Section 5 and Fig. 6: what the paper says of the sequence of mode excitations, decided exactly."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

from symfpu.certificates import prove_propagation
from symfpu.panels import Claim, PaperFigure, judged
from symfpu.paper import APPENDIX_F, EXCITATIONS, TWO_TORUS
from symfpu.paper_figures.judgements import runs
from symfpu.paper_figures.starts import Step
from symfpu.propagation import excitation_sequence, reachable_modes
from symfpu.reproduction import Figure6

PROVED_ORDER = 5  # to which the rule is proved for the paper's seeds, where their series are longer
SMALL = (8, 2)  # N and order of the search for exceptions in the beta model
LINES = 12  # orders of the single seeds of Eq. qbre


def section5(folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """Claims on the sets D_k; no panels."""
    step("section5: proofs")
    claims = (_alpha_rule(), _beta_rule(), _breathers(), _packets(), _double_orders(), *_printed_sets())
    remark = "Decided by integer arithmetic and certificates (docs/propagation.md); where the rule fails, the corrected one is there too."
    return PaperFigure("section5", "Section 5: sequences of mode excitations", (), claims, (remark,))


def _alpha_rule() -> Claim:
    rows = {row.label: prove_propagation(row.chain.N, row.seeds, min(row.order, PROVED_ORDER)) for row in (TWO_TORUS, *APPENDIX_F)}
    found = [label for label, proof in rows.items() if proof.verdict == "proved"]
    ours = f"proved for the seeds of {', '.join(found)} to order {PROVED_ORDER}; in the sweep of all seed sets of N <= 12 without exception"
    return Claim("5", "Proposition, alpha model: D_k are the folded signed sums", "", ours, judged(len(found) == len(rows)))


def _beta_rule() -> Claim:
    N, order = SMALL
    sets = [seeds for s in (1, 2, 3) for seeds in itertools.combinations(range(1, N), s)]
    proofs = [prove_propagation(N, seeds, order, model="beta") for seeds in sets]
    broken = [proof for proof in proofs if proof.verdict == "refuted"]
    first = broken[0].exceptions[0] if broken else None
    ours = f"refuted for {len(broken)} of the {len(sets)} sets of up to three seeds of N = {N} (order {order})"
    if first is not None:
        ours += f"; {{{runs(broken[0].seeds)}}} excites mode {first.mode} at order {first.actual}, not {first.predicted}: couplings cancel"
    return Claim("5", "Proposition, beta model: D_k are the folded signed sums", "", ours, judged(not broken, len(broken) < len(sets)))


def _breathers() -> Claim:
    wrong = [
        (N, q, model)
        for N, model in itertools.product((7, 12, 32), ("alpha", "beta"))
        for q in range(1, N)
        if excitation_sequence(N, (q,), LINES, model=model) != list(_formula(N, q, model))
    ]
    ours = f"{'exact' if not wrong else f'fails for {wrong[0]}'} for every seed of N = 7, 12, 32, both models, to order {LINES}"
    return Claim("5", "example i: one seed excites |2 [(r q + N - 1)/2N] N - r q|, Eq. qbre", "", ours, judged(not wrong))


def _formula(N: int, q: int, model: str) -> Iterator[tuple[int, ...]]:
    seen = {0, N}
    for k in range(LINES + 1):
        r = k + 1 if model == "alpha" else 2 * k + 1
        mode = abs(2 * ((r * q + N - 1) // (2 * N)) * N - r * q)
        yield () if mode in seen else (mode,)
        seen.add(mode)


def _packets() -> Claim:
    widths = range(2, 7)
    right = [
        excitation_sequence(200, range(1, s + 1), 8)[k] == tuple(range(k * s + 1, (k + 1) * s + 1)) for s in widths for k in range(1, 9)
    ]
    single = excitation_sequence(200, (1,), 1, model="beta")[1]
    exact = "exact" if all(right) else "not exact"
    ours = f"{exact} for s = 2 .. 6 to order 8; not for s = 1 in the beta model, where D_1 = {{{runs(single)}}} and not {{2, 3}}"
    text = "example iii: packets 1 .. s excite D_k = {ks+1 .. (k+1)s} and, in beta, two such groups"
    return Claim("5", text, "", ours, judged(False, all(right)))


def _double_orders() -> Claim:
    N, s = 32, 4
    beta, alpha = excitation_sequence(N, range(N - s, N), 2, model="beta"), excitation_sequence(N, range(N - s, N), 4)
    printed = tuple(range(N - 2 * s, N))[:s]
    ours = f"D_1 of beta is {runs(beta[1])} (N = {N}, s = {s}), which is D_2 of alpha; the formula gives {runs(printed)}"
    text = "example iv: high packets in beta excite D_k = {N-(k+1)s .. N-(k-1)s-1}, the D_2k of alpha"
    return Claim("5", text, "", ours, judged(beta[1] == printed, beta[1] == alpha[2]))


def _printed_sets() -> Iterator[Claim]:
    for printed in EXCITATIONS:
        found = excitation_sequence(printed.N, printed.seeds, len(printed.sets))[1:]
        same = sum(tuple(a) == tuple(b) for a, b in zip(found, printed.sets, strict=True))
        ours = f"{same} of {len(printed.sets)} sets are the rule's"
        slip = printed.label == "Example 4"
        if slip:
            ours += "; D_3 is printed as 56..72, with 60..68 that are in D_1 already"
        section = "6.4.2" if printed.label.startswith("q") else "6.2"
        text = f"{printed.label}: the sets D_1 .. D_{len(printed.sets)} of seeds {runs(printed.seeds)}, N = {printed.N}"
        yield Claim(section, text, "", ours, judged(same == len(printed.sets) and not slip, same == len(printed.sets)))


def figure6_claims(data: Figure6) -> PaperFigure:
    """The intervals M_k of section 6.3 against the rule."""
    claims = tuple(_intervals(data, panel) for panel in data.panels)
    return PaperFigure("fig6", "Fig. 6: what section 6.3 says of it", (), claims)


def _intervals(data: Figure6, panel: str) -> Claim:
    N, seeds = data.N, data.panels[panel][0]
    center, width = (seeds[0] + seeds[-1]) // 2, (seeds[-1] - seeds[0]) // 2
    last = N // (4 * width) - 1  # before the intervals meet
    sets = reachable_modes(N, seeds, last)
    wrong = [k for k in range(1, last + 1) if set(sets[k]) != _interval_modes(N, center, width * (k + 1), k)]
    ours = f"N = {N}, packets of {len(seeds)} modes: M_k as stated for {'all' if not wrong else f'all but {wrong} of'} k = 1 .. {last}"
    text = f"kappa_0 = {center / N:g}: M_k are intervals of half-width epsilon (k+1) around the places listed"
    return Claim("6.3", text, "", ours, judged(not wrong))


def _interval_modes(N: int, center: int, half: int, k: int) -> set[int]:
    """Modes of the printed intervals of M_k."""
    if k % 2 == 0:
        places = [center] if 2 * center == N else [N // 4, 3 * N // 4]
    elif 2 * center == N:
        places = [0, N]
    else:
        places = [0, N // 2] + ([N] if k > 1 else [])
    return {q for place in places for q in range(place - half, place + half + 1) if 1 <= q <= N - 1}
