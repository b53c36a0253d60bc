"""Modes that vanish: the couplings leave them nothing, or a polynomial in the L_q(nu) is zero."""

from itertools import combinations_with_replacement

from symfpu.checkers.propagation.case import Case
from symfpu.checkers.propagation.couplings import Budget
from symfpu.checkers.propagation.recursion import SYMBOLS, Recursion
from symfpu.checkers.propagation.rule import coupled_sets
from symfpu.checkers.reading import Json, need


def check_zeros_by_couplings(data: Json, case: Case, budget: Budget) -> None:
    """Where a zero is said to follow from the couplings, they leave the mode nothing at that
    order.
    """
    zeros = [e for e in data["vanishing"] if e["by"] == "couplings"]
    last = max((k for e in zeros for k in e["orders"]), default=0)
    sets = coupled_sets(case, last, budget)
    for e in data["vanishing"]:
        q, by = e["mode"], e["by"]
        for k in e["orders"]:
            shown = by == "identity" or (by == "couplings" and q not in sets[k])
            need(shown, f"mode {q} at order {k} does not vanish by {by!r:.40}")


def check_zeros_by_identity(data: Json, case: Case, budget: Budget) -> None:
    """Where a zero is said to be an identity, every coefficient is the zero polynomial in the
    symbols L_q(nu).
    """
    recursion = Recursion(case, SYMBOLS, budget)
    for e in data["vanishing"]:
        if e["by"] == "identity":
            for k in e["orders"]:
                check_identity(recursion, e["mode"], k)


def check_identity(recursion: Recursion, q: int, k: int) -> None:
    """The term of mode q at order k is zero, monomial by monomial."""
    variables = range(2 * len(recursion.case.seeds))
    degree = recursion.case.degree(k)
    monomials = combinations_with_replacement(variables, degree)
    for chosen in recursion.budget.counted(monomials):
        m = tuple(map(chosen.count, variables))
        polynomial = recursion.coefficients(m).get(q, {})
        need(not any(polynomial.values()), f"mode {q} at order {k} is not zero")
