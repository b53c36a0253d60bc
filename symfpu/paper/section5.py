"""Section 5: what the paper says of the sequence of mode excitations, decided exactly."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from pathlib import Path

from symfpu.chain.propagation import excitation_sequence, reachable_modes
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.judgements import runs
from symfpu.paper.printed import APPENDIX_F, EXCITATIONS, TWO_TORUS, PrintedExcitation
from symfpu.proofs.certificates import prove_propagation

Modes = tuple[int, ...]

# to which the rule is proved for the paper's seeds, where their series are longer
PROVED_ORDER = 5
SEARCH_CHAIN, SEARCH_ORDER = 8, 2  # of the search for exceptions in the beta model
SINGLE_ORDERS = 12  # of the single seeds of Eq. qbre
# a prime, half an odd number of bonds, commensurable frequencies, the paper's
SIZES = (7, 10, 12, 32)
SIZES_TEXT = "N = 7, 10, 12, 32, both models"
LONG_CHAIN, PACKET_WIDTHS = 200, range(1, 7)  # "N large"; numbers s of seeds
PACKET_ORDERS = {"alpha": 8, "beta": 4}  # of example iii
HIGH_CHAIN, HIGH_WIDTH = 200, 4  # N and s of example iv
SYMMETRIC_CHAINS = (6, 12, 30)  # of example v
TOLERATED_EXCEPTIONS = 3  # that leave a statement right in the main
SHOWN_EXCEPTIONS = 3
TWO_SEEDS, PRINTED_M1 = (3, 5), (2, 3, 5, 6, 8, 10)
PRINTED_D1, PRINTED_D2 = (2, 6, 8, 10), (1, 7, 9, 11, 13, 15)
PRINTED_M2 = (1, 3, 5, 7, 9, 11, 13, 15)
# where symfpu/paper/printed.py has the sets corrected
PRINTED_GROUPS = {("Example 4", 3): (*range(5, 9), *range(56, 73), *range(120, 128))}
MODELS = ("alpha", "beta")


def section5(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """Claims on the sets D_k; no panels."""
    progress("section5: proofs", NO_FRACTION)
    claims = (
        alpha_rule_claim(),
        beta_rule_claim(),
        breathers_claim(),
        parities_claim(),
        *two_seeds_claims(),
        *map(low_packets_claim, MODELS),
        *map(high_packets_claim, MODELS),
        symmetric_claim(),
        reachable_sets_claim(),
        *_doubled_orders_claims(),
        *map(printed_sets_claim, EXCITATIONS),
    )
    remark = "Decided by integer arithmetic and certificates (docs/propagation.md); "
    remark += "where the rule fails, the corrected one is there too."
    title = "Section 5: sequences of mode excitations"
    return PaperFigure("section5", title, (), claims, (remark,))


def alpha_rule_claim() -> Claim:
    """The Proposition for the seeds of the paper's examples."""
    rows = (TWO_TORUS, *APPENDIX_F)
    proved = []
    for row in rows:
        order = min(row.order, PROVED_ORDER)
        proof = prove_propagation(row.chain.N, row.seeds, order)
        if proof.verdict == "proved":
            proved.append(row.label)
    labels = ", ".join(proved) or "none"
    ours = f"proved to order {PROVED_ORDER} for the seeds of {labels}; "
    ours += "all seed sets of short chains: docs/propagation.md"
    text = "Proposition, alpha model: D_k are the folded signed sums"
    return Claim("5", text, "", ours, judged(len(proved) == len(rows), bool(proved)))


def beta_rule_claim() -> Claim:
    """The Proposition for all small seed sets of a short chain."""
    N, order = SEARCH_CHAIN, SEARCH_ORDER
    sets = _seed_sets(N)
    proofs = [prove_propagation(N, seeds, order, model="beta") for seeds in sets]
    broken = [proof for proof in proofs if proof.verdict == "refuted"]
    ours = f"refuted for {len(broken)} of the {len(sets)} sets of up to three seeds of N = {N} "
    ours += f"(order {order})"
    if broken:
        seeds = runs(broken[0].seeds)
        first = broken[0].exceptions[0]
        ours += f"; {{{seeds}}} excites mode {first.mode} at order {first.actual}, "
        ours += f"not {first.predicted}: couplings cancel"
    text = "Proposition, beta model: D_k are the folded signed sums"
    return Claim("5", text, "", ours, judged(not broken, len(broken) < len(sets)))


def _seed_sets(N: int) -> list[Modes]:
    """All sets of up to three seeds."""
    sets: list[Modes] = []
    for s in (1, 2, 3):
        sets += itertools.combinations(range(1, N), s)
    return sets


def breathers_claim() -> Claim:
    """Eq. qbre for every seed of a few chains."""
    wrong = []
    for N, model, q in _single_seeds():
        found = excitation_sequence(N, (q,), SINGLE_ORDERS, model=model)
        if found != list(_formula(N, q, model)):
            wrong.append((N, q, model))
    word = f"fails for {wrong[0]}" if wrong else "exact"
    ours = f"{word} for every seed of {SIZES_TEXT}, to order {SINGLE_ORDERS}"
    text = "example i: one seed excites |2 [(r q + N - 1)/2N] N - r q|, Eq. qbre"
    return Claim("5", text, "", ours, judged(not wrong))


def _formula(N: int, q: int, model: str) -> Iterator[Modes]:
    """The modes q_k of one seed as printed (Eq. qbre), each at its first order: D_0, D_1, ..."""
    seen = {0, N}
    for k in range(SINGLE_ORDERS + 1):
        r = k + 1 if model == "alpha" else 2 * k + 1
        half_turns = (r * q + N - 1) // (2 * N)
        mode = abs(2 * half_turns * N - r * q)
        yield () if mode in seen else (mode,)
        seen.add(mode)


def parities_claim() -> Claim:
    """Which parities a breather excites: exceptions among all seeds of a few chains."""
    wrong = []
    for N, model, q in _single_seeds():
        sequence = excitation_sequence(N, (q,), SINGLE_ORDERS, model=model)
        found = {mode % 2 for mode in itertools.chain.from_iterable(sequence)}
        if found != _stated_parities(model, q):
            wrong.append(f"N = {N}, {model}, q = {q}")
    ours = f"for all seeds of {SIZES_TEXT}"
    if wrong:
        ours += f" but {'; '.join(wrong)}"
    text = (
        "example i: even seeds excite even modes, odd ones in beta odd modes, in alpha both"
    )
    return Claim("5", text, "", ours, judged(not wrong, len(wrong) <= TOLERATED_EXCEPTIONS))


def _stated_parities(model: str, q: int) -> set[int]:
    if q % 2 == 0:
        return {0}
    return {0, 1} if model == "alpha" else {1}


def _single_seeds() -> Iterator[tuple[int, str, int]]:
    for N, model in itertools.product(SIZES, MODELS):
        for q in range(1, N):
            yield N, model, q


def two_seeds_claims() -> Iterator[Claim]:
    """Example ii: the set M_1, and what follows from it."""
    reached = reachable_modes(LONG_CHAIN, TWO_SEEDS, 2)
    sets = excitation_sequence(LONG_CHAIN, TWO_SEEDS, 2)
    first = tuple(reached[1])
    same = first == PRINTED_M1
    ours = f"M_1 = {{{runs(first)}}}"
    if not same:
        ours += ": sums and differences of two odd modes are even"
    text = f"example ii: M_1 = {{{runs(PRINTED_M1)}}} for the seeds 3, 5"
    verdict = judged(same, set(first) < set(PRINTED_M1))
    yield Claim("5", text, "", ours, verdict)
    right = [sets[1] == PRINTED_D1, sets[2] == PRINTED_D2, tuple(reached[2]) == PRINTED_M2]
    ours = f"D_1 = {{{runs(sets[1])}}}, D_2 = {{{runs(sets[2])}}}"
    text = "example ii: M_2, D_1 = {2, 6, 8, 10} and D_2 = {1, 7, 9, 11, 13, 15}"
    yield Claim("5", text, "", ours, judged(all(right), any(right)))


def low_packets_claim(model: str) -> Claim:
    """Example iii. Exceptions by the number of seeds."""
    order = PACKET_ORDERS[model]
    wrong = []
    for s in PACKET_WIDTHS:
        found = excitation_sequence(LONG_CHAIN, range(1, s + 1), order, model=model)
        stated = [_low_packet(model, s, k) for k in range(1, order + 1)]
        if found[1:] != stated:
            wrong.append(s)
    ours = f"for s = {PACKET_WIDTHS[0]} .. {PACKET_WIDTHS[-1]} to order {order}"
    if wrong:
        ours += f", but for s = {runs(tuple(wrong))}"
    only_one_seed = wrong == [1]
    if only_one_seed:
        ours += ": one seed excites one mode an order"
    formula = "{ks+1 .. (k+1)s}" if model == "alpha" else "{(2k-1)s+1 .. (2k+1)s}"
    text = f"example iii: packets 1 .. s excite D_k = {formula} in {model}"
    return Claim("5", text, "", ours, judged(not wrong, only_one_seed))


def _low_packet(model: str, s: int, k: int) -> Modes:
    """D_k of the packet 1 .. s as stated."""
    if model == "alpha":
        return tuple(range(k * s + 1, (k + 1) * s + 1))
    return tuple(range((2 * k - 1) * s + 1, (2 * k + 1) * s + 1))


def high_packets_claim(model: str) -> Claim:
    """Example iv."""
    N, s = HIGH_CHAIN, HIGH_WIDTH
    seeds = range(N - s, N)
    found = excitation_sequence(N, seeds, 3, model=model)[1:]
    printed = [_high_packet(model, k) for k in (1, 2, 3)]
    of_alpha = excitation_sequence(N, seeds, 6)[2::2]
    same = found == printed
    doubled = of_alpha == found
    sets = [f"D_{k} = {runs(modes)}" for k, modes in enumerate(found, 1)]
    ours = f"{'; '.join(sets)} (N = {N}, s = {s})"
    if not same:
        ours += f"; the formula gives {'; '.join(map(runs, printed))}"
    if model == "alpha":
        text = "example iv: packets N-s .. N-1 excite in alpha D_k = {(k-1)s+1 .. (k+1)s}, "
        text += "k odd, {N-(k+1)s .. N-(k-1)s-1}, k even"
        return Claim("5", text, "", ours, judged(same))
    ours += f"; the D_2k of alpha are {'the same' if doubled else 'others'}"
    text = "example iv: packets N-s .. N-1 excite in beta D_k = {N-(k+1)s .. N-(k-1)s-1}, "
    text += "the D_2k of alpha"
    return Claim("5", text, "", ours, judged(same, doubled))


def _high_packet(model: str, k: int) -> Modes:
    """D_k of the packet N-s .. N-1 as stated."""
    N, s = HIGH_CHAIN, HIGH_WIDTH
    if model == "alpha" and k % 2:
        return tuple(range((k - 1) * s + 1, (k + 1) * s + 1))
    return tuple(range(N - (k + 1) * s, N - (k - 1) * s))


def symmetric_claim() -> Claim:
    """Example v: nothing but the seed."""
    as_printed = []
    others = False
    for N, model, q in _symmetric_seeds():
        sequence = excitation_sequence(N, (q,), SINGLE_ORDERS, model=model)
        as_printed.append(sequence[1] == (q,))
        others = others or any(sequence[1:])
    ours = "other modes are excited" if others else "no other mode is ever excited"
    if not all(as_printed):
        ours += "; by Eq. dk the later D_k are empty, not D_0"
    text = "example v: D_k = D_0 for D_0 = {N/2}, {2N/3} and, in beta, {N/3}"
    return Claim("5", text, "", ours, judged(all(as_printed), not others))


def _symmetric_seeds() -> Iterator[tuple[int, str, int]]:
    for N in SYMMETRIC_CHAINS:
        yield N, "alpha", N // 2
        yield N, "alpha", 2 * N // 3
        yield N, "beta", N // 2
        yield N, "beta", N // 3


def reachable_sets_claim() -> Claim:
    """M_2k of alpha is M_k of beta."""
    N = SEARCH_CHAIN
    sets = _seed_sets(N)
    wrong = 0
    for seeds in sets:
        of_alpha = reachable_modes(N, seeds, 6)[::2]
        wrong += of_alpha != reachable_modes(N, seeds, 3, model="beta")
    ours = (
        f"for {len(sets) - wrong} of the {len(sets)} sets of up to three seeds of N = {N}, "
    )
    ours += "k to 3"
    text = "M_2k of alpha is M_k of beta for every excitation"
    return Claim("5", text, "", ours, judged(not wrong, wrong <= TOLERATED_EXCEPTIONS))


def _doubled_orders_claims() -> tuple[Claim, Claim]:
    """For breathers, and for packets around quarters."""
    single = [(N, (q,)) for N in SIZES for q in range(1, N)]
    around = []
    for quarter in (1, 2, 3):
        center = quarter * LONG_CHAIN // 4
        around.append((LONG_CHAIN, tuple(range(center - 2, center + 3))))
    return (
        doubled_orders_claim("q-breathers", single),
        doubled_orders_claim("small packets around N/4, N/2, 3N/4", around),
    )


def doubled_orders_claim(name: str, cases: Iterable[tuple[int, Modes]]) -> Claim:
    """D_k of beta is D_2k of alpha; cases : chains with their seeds."""
    total = 0
    wrong = []
    for N, seeds in cases:
        total += 1
        of_alpha = excitation_sequence(N, seeds, 6)[::2]
        if of_alpha != excitation_sequence(N, seeds, 3, model="beta"):
            wrong.append(f"N = {N}, seed {runs(seeds)}")
    ours = f"{total - len(wrong)} of {total} cases, k to 3"
    if wrong:
        ours += f"; not for {'; '.join(wrong[:SHOWN_EXCEPTIONS])}"
    text = f"D_k of beta is D_2k of alpha for {name}"
    return Claim("5", text, "", ours, judged(not wrong, len(wrong) <= total // 2))


def printed_sets_claim(example: PrintedExcitation) -> Claim:
    """The sets of an example of sections 6.2 and 6.4.2 against the rule."""
    total = len(example.sets)
    found = excitation_sequence(example.N, example.seeds, total)[1:]
    differing = []
    for k, (corrected, modes) in enumerate(zip(example.sets, found, strict=True), 1):
        printed = PRINTED_GROUPS.get((example.label, k), corrected)
        if tuple(printed) != tuple(modes):
            off = runs(tuple(sorted(set(printed) ^ set(modes))))
            differing.append(f"; D_{k} differs in {off}, which are in earlier sets")
    right = total - len(differing)
    ours = f"{right} of {total} sets are the rule's{''.join(differing)}"
    section = "6.4.2" if example.label.startswith("q") else "6.2"
    text = f"{example.label}: the sets D_1 .. D_{total} of seeds {runs(example.seeds)}, "
    text += f"N = {example.N}"
    return Claim(section, text, "", ours, judged(not differing, right > 0))
