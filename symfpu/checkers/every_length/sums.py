"""Modes that are excited since sums of seeds fold with one parity, or by a chain of couplings."""

from functools import cache
from itertools import combinations_with_replacement, product
from operator import mul

from symfpu.checkers.every_length.claim import Row, Theorem
from symfpu.checkers.every_length.evidence import Evidence
from symfpu.checkers.every_length.signs import powers_of_degree
from symfpu.checkers.propagation.case import Case
from symfpu.checkers.propagation.couplings import couplings
from symfpu.checkers.propagation.rule import folded

# the last orders at which a chain of couplings holds for the frequencies of every N
CHAINS = {"alpha": 3, "beta": 2}


def odd_sum(claim: Theorem, flat: Row) -> bool:
    """Whether fewer than d(K) signed seeds make an odd multiple of N."""
    N, *seeds = flat
    for m in short_sums(claim.s, claim.degree(claim.order) - 1):
        if sum(map(mul, m, seeds)) % (2 * N) == N:
            return True
    return False


@cache
def short_sums(s: int, most: int) -> list[Row]:
    """All m with |m| from 1 up to the most, one of m and -m."""
    found = product(range(-most, most + 1), repeat=s)
    return [m for m in found if 0 < sum(map(abs, m)) <= most and m == lowest_sign(m)]


def lowest_sign(m: Row) -> Row:
    """That of m and -m whose first number which is not zero is positive."""
    return max(m, tuple(-c for c in m))


def shown_by_sums(
    claim: Theorem, case: Case, actual: dict[int, int], evidence: Evidence
) -> set[int]:
    """Modes of D_k of one parity (Theorem 7), and those to which a chain leads (Theorem 8).

    And the seeds, of order 0.
    """
    exceptional = {mode for mode, _, _ in evidence.exceptions}
    shown = last = set(case.seeds)
    for k in range(1, claim.order + 1):
        members = {q for q in actual if actual[q] == k}
        known = (members - exceptional) & one_parity(case, claim.degree(k))
        if k <= CHAINS[claim.model]:
            known |= {q for q in members - known if coupled_to(case, q, last)}
        shown, last = shown | known, known
    return shown


def one_parity(case: Case, degree: int) -> set[int]:
    """Modes that sums with some powers p of the seeds reach, all with w of one parity.

    A sum a.q = +-q + 2wN with |a_i| up to p_i and as odd as p_i.
    """
    found = set()
    for p in powers_of_degree(len(case.seeds), degree):
        parities: dict[int, set[int]] = {}
        for a in product(*(range(-n, n + 1, 2) for n in p)):
            total = sum(map(mul, a, case.seeds))
            w = (total + case.N) // (2 * case.N)
            mode = abs(total - 2 * w * case.N)
            parities.setdefault(mode, set()).add(w % 2)
        found |= {q for q in parities if len(parities[q]) == 1}
    return found


def coupled_to(case: Case, q: int, last: set[int]) -> bool:
    """Whether one of these modes and as many seeds as a product takes are coupled to q."""
    for seeds in combinations_with_replacement(case.seeds, case.step):
        for signs in product((1, -1), repeat=case.step):
            m = folded(q + sum(map(mul, signs, seeds)), case.N)
            if m in last and q in dict(couplings(case.N, m, *seeds)):
                return True
    return False
