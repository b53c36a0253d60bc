"""Section 5 and Fig. 6: what the paper says of the sequence of mode excitations, decided exactly."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

from symfpu.chain.propagation import excitation_sequence, reachable_modes
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.judgements import runs
from symfpu.paper.printed import APPENDIX_F, EXCITATIONS, TWO_TORUS
from symfpu.paper.steps import Step
from symfpu.proofs.certificates import prove_propagation

# to which the rule is proved for the paper's seeds, where their series are longer
PROVED_ORDER = 5
SMALL = (8, 2)  # N and order of the search for exceptions in the beta model
LINES = 12  # orders of the single seeds of Eq. qbre
SIZES = (7, 12, 32)  # a prime, one with commensurable frequencies, the paper's
SIZES_TEXT = "N = 7, 12, 32, both models"
LARGE, WIDTHS, HIGH = (
    200,
    range(1, 7),
    (200, 4),
)  # "N large"; numbers s of seeds; N and s of example iv
FEW = 3  # exceptions that leave a statement right in the main
PRINTED_M1 = (2, 3, 5, 6, 8, 10)
# where symfpu/paper/printed.py has the sets corrected
AS_PRINTED = {("Example 4", 3): (*range(5, 9), *range(56, 73), *range(120, 128))}


def section5(folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """Claims on the sets D_k; no panels."""
    step("section5: proofs")
    claims = (
        _alpha_rule(),
        _beta_rule(),
        _breathers(),
        _parities(),
        *_two_seeds(),
        *map(_low_packets, ("alpha", "beta")),
        *map(_high_packets, ("alpha", "beta")),
        _symmetric(),
        *_between_models(),
        *_printed_sets(),
    )
    remark = "Decided by integer arithmetic and certificates (docs/propagation.md); where the rule fails, the corrected one is there too."
    return PaperFigure(
        "section5", "Section 5: sequences of mode excitations", (), claims, (remark,)
    )


def _alpha_rule() -> Claim:
    """The Proposition for the seeds of the paper's examples."""
    rows = {
        row.label: prove_propagation(row.chain.N, row.seeds, min(row.order, PROVED_ORDER))
        for row in (TWO_TORUS, *APPENDIX_F)
    }
    found = [label for label, proof in rows.items() if proof.verdict == "proved"]
    ours = f"proved to order {PROVED_ORDER} for the seeds of {', '.join(found) or 'none'}; all seed sets of short chains: docs/propagation.md"
    return Claim(
        "5",
        "Proposition, alpha model: D_k are the folded signed sums",
        "",
        ours,
        judged(len(found) == len(rows), bool(found)),
    )


def _beta_rule() -> Claim:
    """The Proposition for all small seed sets of a short chain."""
    N, order = SMALL
    sets = [seeds for s in (1, 2, 3) for seeds in itertools.combinations(range(1, N), s)]
    proofs = [prove_propagation(N, seeds, order, model="beta") for seeds in sets]
    broken = [proof for proof in proofs if proof.verdict == "refuted"]
    first = broken[0].exceptions[0] if broken else None
    ours = f"refuted for {len(broken)} of the {len(sets)} sets of up to three seeds of N = {N} (order {order})"
    if first is not None:
        ours += f"; {{{runs(broken[0].seeds)}}} excites mode {first.mode} at order {first.actual}, not {first.predicted}: couplings cancel"
    return Claim(
        "5",
        "Proposition, beta model: D_k are the folded signed sums",
        "",
        ours,
        judged(not broken, len(broken) < len(sets)),
    )


def _breathers() -> Claim:
    wrong = [
        (N, q, model)
        for N, model, q in _single_seeds()
        if excitation_sequence(N, (q,), LINES, model=model) != list(_formula(N, q, model))
    ]
    ours = f"{'exact' if not wrong else f'fails for {wrong[0]}'} for every seed of {SIZES_TEXT}, to order {LINES}"
    return Claim(
        "5",
        "example i: one seed excites |2 [(r q + N - 1)/2N] N - r q|, Eq. qbre",
        "",
        ours,
        judged(not wrong),
    )


def _formula(N: int, q: int, model: str) -> Iterator[tuple[int, ...]]:
    """The modes q_k of one seed as printed (Eq. qbre), each at the first order that it is there for."""
    seen = {0, N}
    for k in range(LINES + 1):
        r = k + 1 if model == "alpha" else 2 * k + 1
        mode = abs(2 * ((r * q + N - 1) // (2 * N)) * N - r * q)
        yield () if mode in seen else (mode,)
        seen.add(mode)


def _parities() -> Claim:
    """Which parities a breather excites: exceptions among all seeds of a few chains."""
    wrong = []
    for N, model, q in _single_seeds():
        found = {
            mode % 2 for modes in excitation_sequence(N, (q,), LINES, model=model) for mode in modes
        }
        expected = {0} if q % 2 == 0 else {0, 1} if model == "alpha" else {1}
        if found != expected:
            wrong.append(f"N = {N}, {model}, q = {q}")
    ours = f"for all seeds of {SIZES_TEXT}" + (f" but {'; '.join(wrong)}" if wrong else "")
    text = "example i: even seeds excite even modes, odd ones in beta odd modes, in alpha both"
    return Claim("5", text, "", ours, judged(not wrong, len(wrong) <= FEW))


def _single_seeds() -> Iterator[tuple[int, str, int]]:
    for N, model in itertools.product(SIZES, ("alpha", "beta")):
        yield from ((N, model, q) for q in range(1, N))


def _two_seeds() -> Iterator[Claim]:
    """Example ii: the set M_1, and what follows from it."""
    N, seeds = LARGE, (3, 5)
    reached, sets = reachable_modes(N, seeds, 2), excitation_sequence(N, seeds, 2)
    same = tuple(reached[1]) == PRINTED_M1
    ours = f"M_1 = {{{runs(reached[1])}}}" + (
        "" if same else ": sums and differences of two odd modes are even"
    )
    yield Claim(
        "5",
        f"example ii: M_1 = {{{runs(PRINTED_M1)}}} for the seeds 3, 5",
        "",
        ours,
        judged(same, set(reached[1]) < set(PRINTED_M1)),
    )
    right = [
        sets[1] == (2, 6, 8, 10),
        sets[2] == (1, 7, 9, 11, 13, 15),
        tuple(reached[2]) == (1, 3, 5, 7, 9, 11, 13, 15),
    ]
    ours = f"D_1 = {{{runs(sets[1])}}}, D_2 = {{{runs(sets[2])}}}"
    text = "example ii: M_2, D_1 = {2, 6, 8, 10} and D_2 = {1, 7, 9, 11, 13, 15}"
    yield Claim("5", text, "", ours, judged(all(right), any(right)))


def _low_packets(model: str) -> Claim:
    """Example iii. Exceptions by the number of seeds."""
    orders = range(1, 9 if model == "alpha" else 5)
    wrong = []
    for s in WIDTHS:
        found = excitation_sequence(LARGE, range(1, s + 1), orders[-1], model=model)
        first = {k: k * s + 1 if model == "alpha" else (2 * k - 1) * s + 1 for k in orders}
        last = {k: (k + 1) * s if model == "alpha" else (2 * k + 1) * s for k in orders}
        if any(found[k] != tuple(range(first[k], last[k] + 1)) for k in orders):
            wrong.append(s)
    ours = f"for s = {WIDTHS[0]} .. {WIDTHS[-1]} to order {orders[-1]}" + (
        f", but for s = {runs(tuple(wrong))}" if wrong else ""
    )
    ours += ": one seed excites one mode an order" if wrong == [1] else ""
    formula = "{ks+1 .. (k+1)s}" if model == "alpha" else "{(2k-1)s+1 .. (2k+1)s}"
    return Claim(
        "5",
        f"example iii: packets 1 .. s excite D_k = {formula} in {model}",
        "",
        ours,
        judged(not wrong, wrong == [1]),
    )


def _high_packets(model: str) -> Claim:
    """Example iv."""
    N, s = HIGH
    found = excitation_sequence(N, range(N - s, N), 3, model=model)[1:]
    low = {k: tuple(range((k - 1) * s + 1, (k + 1) * s + 1)) for k in (1, 2, 3)}
    high = {k: tuple(range(N - (k + 1) * s, N - (k - 1) * s)) for k in (1, 2, 3)}
    printed = [low[k] if model == "alpha" and k % 2 else high[k] for k in (1, 2, 3)]
    ours = (
        "; ".join(f"D_{k} = {runs(modes)}" for k, modes in enumerate(found, 1))
        + f" (N = {N}, s = {s})"
    )
    same = list(found) == printed
    ours += "" if same else "; the formula gives " + "; ".join(map(runs, printed))
    of_alpha = excitation_sequence(N, range(N - s, N), 6)[2::2]
    ours += (
        ""
        if model == "alpha"
        else f"; the D_2k of alpha are {'the same' if of_alpha == list(found) else 'others'}"
    )
    text = "example iv: packets N-s .. N-1 excite in alpha D_k = {(k-1)s+1 .. (k+1)s}, k odd, {N-(k+1)s .. N-(k-1)s-1}, k even"
    if model == "beta":
        text = "example iv: packets N-s .. N-1 excite in beta D_k = {N-(k+1)s .. N-(k-1)s-1}, the D_2k of alpha"
    return Claim("5", text, "", ours, judged(same, model == "beta" and of_alpha == list(found)))


def _symmetric() -> Claim:
    """Example v: nothing but the seed."""
    seeds = [
        (N, model, q)
        for N in (6, 12, 30)
        for model, q in (
            ("alpha", N // 2),
            ("alpha", 2 * N // 3),
            ("beta", N // 2),
            ("beta", N // 3),
        )
    ]
    later = [
        {mode for modes in excitation_sequence(N, (q,), LINES, model=model)[1:] for mode in modes}
        for N, model, q in seeds
    ]
    printed = [excitation_sequence(N, (q,), 1, model=model)[1] == (q,) for N, model, q in seeds]
    ours = "no other mode is ever excited" if not any(later) else "other modes are excited"
    ours += "" if all(printed) else "; by Eq. dk the later D_k are empty, not D_0"
    text = "example v: D_k = D_0 for D_0 = {N/2}, {2N/3} and, in beta, {N/3}"
    return Claim("5", text, "", ours, judged(all(printed), not any(later)))


def _between_models() -> Iterator[Claim]:
    """M_2k of alpha is M_k of beta.

    D_k of beta is D_2k of alpha for breathers, and for packets around quarters.
    """
    N = 8
    sets = [seeds for s in (1, 2, 3) for seeds in itertools.combinations(range(1, N), s)]
    wrong = [
        seeds
        for seeds in sets
        if reachable_modes(N, seeds, 6)[::2] != reachable_modes(N, seeds, 3, model="beta")
    ]
    ours = f"for {len(sets) - len(wrong)} of the {len(sets)} sets of up to three seeds of N = {N}, k to 3"
    yield Claim(
        "5",
        "M_2k of alpha is M_k of beta for every excitation",
        "",
        ours,
        judged(not wrong, len(wrong) <= FEW),
    )
    single = [(n, (q,)) for n in SIZES for q in range(1, n)]
    around = [(LARGE, tuple(range(c - 2, c + 3))) for c in (LARGE // 4, LARGE // 2, 3 * LARGE // 4)]
    for name, cases in (("q-breathers", single), ("small packets around N/4, N/2, 3N/4", around)):
        off = [
            (n, seeds)
            for n, seeds in cases
            if excitation_sequence(n, seeds, 6)[::2]
            != excitation_sequence(n, seeds, 3, model="beta")
        ]
        ours = f"{len(cases) - len(off)} of {len(cases)} cases, k to 3"
        ours += (
            f"; not for {'; '.join(f'N = {n}, seed {runs(seeds)}' for n, seeds in off[:FEW])}"
            if off
            else ""
        )
        yield Claim(
            "5",
            f"D_k of beta is D_2k of alpha for {name}",
            "",
            ours,
            judged(not off, len(off) <= len(cases) // 2),
        )


def _printed_sets() -> Iterator[Claim]:
    for example in EXCITATIONS:
        printed = [
            AS_PRINTED.get((example.label, k), modes) for k, modes in enumerate(example.sets, 1)
        ]
        found = excitation_sequence(example.N, example.seeds, len(printed))[1:]
        wrong = {
            k: set(modes) ^ set(ours)
            for k, (modes, ours) in enumerate(zip(printed, found, strict=True), 1)
            if tuple(modes) != tuple(ours)
        }
        same = f"{len(printed) - len(wrong)} of {len(printed)} sets are the rule's"
        ours = same + "".join(
            f"; D_{k} differs in {runs(tuple(sorted(modes)))}, which are in earlier sets"
            for k, modes in wrong.items()
        )
        section = "6.4.2" if example.label.startswith("q") else "6.2"
        text = f"{example.label}: the sets D_1 .. D_{len(printed)} of seeds {runs(example.seeds)}, N = {example.N}"
        yield Claim(section, text, "", ours, judged(not wrong, len(wrong) < len(printed)))
