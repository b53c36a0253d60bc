"""What is known of a flat decides every mode."""

from symfpu.checkers.every_length.claim import Row, Theorem
from symfpu.checkers.every_length.evidence import Evidence
from symfpu.checkers.every_length.signs import Powers, Signs, one_sign
from symfpu.checkers.every_length.sums import odd_sum, shown_by_sums
from symfpu.checkers.propagation.case import Case
from symfpu.checkers.propagation.couplings import Budget
from symfpu.checkers.propagation.recursion import Point, Recursion
from symfpu.checkers.propagation.residues import check_point
from symfpu.checkers.propagation.rule import coupled_sets, propagation_rule
from symfpu.checkers.reading import need


def check_flat(claim: Theorem, flat: Row, evidence: Evidence, points: list[Row]) -> None:
    """Every mode is excited at its order and at none before, or named as undecided."""
    if not any(evidence) and not odd_sum(claim, flat):
        return  # Theorem 7
    case = claim.case(flat)
    actual = actual_orders(claim, case, evidence)
    shown = shown_by_sums(claim, case, actual, evidence)
    signs, left = Signs(case), dict(evidence.witnesses)
    unsure = []
    for q, k in sorted(actual.items()):
        if q in shown or one_sign(signs, claim, q, k):
            continue
        if (q, k) in left:
            check_residue(case, q, *left.pop((q, k)), points)
        else:
            unsure.append(q)
    need(unsure == evidence.undecided, f"{flat}: undecided modes {unsure}")
    need(not left, f"{flat}: a witness that nothing asks for")


def actual_orders(claim: Theorem, case: Case, evidence: Evidence) -> dict[int, int]:
    """Those of the rule, with the exceptions; before them the couplings leave a mode nothing."""
    rule = propagation_rule(case, Budget())
    orders = {q: k for k, modes in enumerate(rule) for q in modes}
    need(set(orders) >= set(case.seeds), "the rule lost a seed")
    actual = dict(orders)
    for mode, predicted, found in evidence.exceptions:
        need(
            orders.get(mode) == predicted, f"mode {mode}: the rule does not say {predicted}"
        )
        need(
            predicted and (found is None or predicted < found), f"mode {mode}: no exception"
        )
        del actual[mode]
        if found is not None:
            need(found <= claim.order, f"mode {mode}: order {found}")
            actual[mode] = found
    if evidence.exceptions:
        check_zeros(claim, case, evidence)
    return actual


def check_zeros(claim: Theorem, case: Case, evidence: Evidence) -> None:
    """The couplings leave an exceptional mode nothing at the orders before its own."""
    sets = coupled_sets(case, claim.order, Budget())
    for mode, predicted, found in evidence.exceptions:
        last = claim.order if found is None else found - 1
        for k in range(predicted, last + 1):
            need(mode not in sets[k], f"{case.seeds}: mode {mode} may be excited at {k}")


def check_residue(
    case: Case, q: int, point: int, residue: int, powers: Powers, points: list[Row]
) -> None:
    """The coefficient of these powers is the stated residue, which is not zero."""
    prime, root, *frequencies = points[point]
    at = Point(prime, root, frequencies)
    check_point(case, at)
    monomial = tuple(e for n in powers for e in (n, 0))
    computed = Recursion(case, at, Budget()).coefficients(monomial).get(q, {}).get(())
    need(0 < residue == computed, f"mode {q}: the residue is not {residue}")
