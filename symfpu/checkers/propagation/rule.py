"""The propagation rule D_0 .. D_K (Eqs. app, dk), and the modes that couplings leave something."""

from itertools import combinations_with_replacement, product

from symfpu.checkers.propagation.case import Case
from symfpu.checkers.propagation.couplings import Budget, coupling_steps, couplings


def propagation_rule(case: Case, budget: Budget) -> list[list[int]]:
    """D_0 .. D_K of the paper's proposition (Eqs. app, dk), folded at every order.

    Of other potentials none at an order which no powers of the force make.
    """
    signed = [*case.seeds, *(-q for q in case.seeds)]
    shifts = {sum(chosen) for chosen in product(signed, repeat=case.step)}
    reached, rule, seen = set(case.seeds), [], {0, case.N}
    made = orders_made(case)
    for k in range(case.order + 1):
        if k:
            pairs = budget.counted(product(reached, shifts))
            reached = {folded(q + shift, case.N) for q, shift in pairs}
        new = reached - seen if k in made else set()
        rule.append(sorted(new))
        seen |= new
    return rule


def orders_made(case: Case) -> set[int]:
    """The orders that are sums of what the powers of the force add to the order."""
    made = {0}
    for k in range(1, case.order + 1):
        if any(k - case.added(n) in made for n in case.force):
            made.add(k)
    return made


def folded(total: int, N: int) -> int:
    """The wave number from 0 to N that is the same as total on the chain."""
    return min(total % (2 * N), -total % (2 * N))


def coupled_sets(case: Case, last: int, budget: Budget) -> list[set[int]]:
    """M_0 .. M_last: what B, C or another power of the force couples to the sets before.

    And seeds reached before, kept by frequency corrections.
    """
    sets = [set(case.seeds)]
    for k in range(1, last + 1):
        reached = {q for q in case.seeds if any(q in modes for modes in sets[1:])}
        for n in case.force:
            before = k - case.added(n)  # the sum of the orders of the factors
            orders = combinations_with_replacement(range(before + 1), n)
            for chosen in budget.counted(orders):
                if sum(chosen) == before:
                    reached |= coupled_modes(case, [sets[j] for j in chosen], budget)
        sets.append(reached)
    return sets


def coupled_modes(case: Case, factors: list[set[int]], budget: Budget) -> set[int]:
    """The modes that products of one mode of each set drive."""
    found = set()
    steps = 1 + coupling_steps(case.N, len(factors))
    for modes in product(*factors):
        budget.spend(steps)
        found |= {q for q, _ in couplings(case.N, *modes)}
    return found
