"""Which mode is excited at which order: the propagation rule (Eqs. app, dk), and the corrected one.

The Proposition counts every folded sum of signed seeds. In the beta model that is too many: where
l + m = N, the sums q - l - m + n = 0 and q + l + m + n = 2N hold together for q = N - n, enter
C_qlmn with opposite signs, and cancel. The corrected rule follows the couplings B and C
themselves.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from itertools import combinations_with_replacement, product

from symfpu.algebra.selection import fold
from symfpu.errors import InputError
from symfpu.numbers.typed import integer, seed_modes

LARGEST_ORDER = 10_000
MODELS = ("alpha", "beta", "alpha+beta")


def reachable_modes(
    N: int, seeds: Iterable[int], order: int, *, model: str = "alpha"
) -> list[tuple[int, ...]]:
    """The sets M_0 .. M_order of Eq. app as ascending tuples.

    The values 0 and N are left out: they are no modes.

    N : number of bonds, at least 2. seeds : distinct modes D_0. order : the last k, from 0 up.
    model : 'alpha', 'beta' or 'alpha+beta'. All are dimensionless integers.

    M_k holds the folded sums of r signed seeds, r = k + 1 (alpha; alpha and beta together),
    2k + 1 (beta).
    Raises InputError for N below 2, seeds outside 1..N-1 or repeated, a negative order, an
    unknown model.

    >>> reachable_modes(32, (3, 5), 1)
    [(3, 5), (2, 6, 8, 10)]
    """
    N = integer(N, "N", 2)
    modes = seed_modes(seeds, N)
    order = integer(order, "order", 0)
    if order > LARGEST_ORDER:
        raise InputError(
            "order", order, f"at most {LARGEST_ORDER}", "the sets repeat long before"
        )
    if model not in MODELS:
        raise InputError(
            "model", model, "'alpha', 'beta' or 'alpha+beta'", "pass one of these"
        )
    sums = {fold(q, N) for q in modes}
    reached = []
    for _k in range(order + 1):
        reached.append(tuple(sorted(sums - {0, N})))
        for _ in range(2 if model == "beta" else 1):
            # folding is a map of the sums modulo 2N and sign, so it may be done at every step
            sums = {
                fold(total + sign * q, N)
                for total in sums
                for q in modes
                for sign in (1, -1)
            }
    return reached


def excitation_sequence(
    N: int, seeds: Iterable[int], order: int, *, model: str = "alpha"
) -> list[tuple[int, ...]]:
    """The sets D_0 .. D_order of Eq. dk, ascending: the modes the rule excites at each order.

    N : number of bonds, at least 2. seeds : distinct modes D_0. order : the last k, from 0 up.
    model : 'alpha', 'beta' or 'alpha+beta'. All are dimensionless integers.

    This is the rule of the Proposition for the sequence of Definition 2; which modes are excited
    in fact is a question for exact arithmetic.
    Raises InputError for N below 2, seeds outside 1..N-1 or repeated, a negative order, an
    unknown model.

    >>> excitation_sequence(32, (1, 2, 3, 4), 2)
    [(1, 2, 3, 4), (5, 6, 7, 8), (9, 10, 11, 12)]
    """
    return first_orders(reachable_modes(N, seeds, order, model=model))


def first_orders(sets: Iterable[Iterable[int]]) -> list[tuple[int, ...]]:
    """Each set without the members of the earlier ones, as ascending tuples.

    Eq. dk, Definition 1.
    """
    seen: set[int] = set()
    sequence = []
    for members in sets:
        sequence.append(tuple(sorted(set(members) - seen)))
        seen.update(members)
    return sequence


def coupled_modes(
    N: int, seeds: Iterable[int], order: int, *, model: str = "alpha"
) -> list[tuple[int, ...]]:
    """The modes that the couplings let into each order 0 .. order.

    Outside these sets a term is identically zero.

    Order k holds the modes q with B_q m1 m2 != 0 (alpha) or C_q m1 m2 m3 != 0 (beta) for some m_i
    in the sets of orders l_i with sum l_i = k - 1, and the seeds, which frequency corrections can
    keep. Raises InputError.

    >>> coupled_modes(6, (2, 3), 2, model="beta")
    [(2, 3), (1, 2, 3, 5), (1, 2, 3, 4, 5)]
    """
    N = integer(N, "N", 2)
    modes = seed_modes(seeds, N)
    order = integer(order, "order", 0)
    if model not in MODELS[:2]:
        raise InputError("model", model, "'alpha' or 'beta'", "pass one of these")
    factors = 2 if model == "alpha" else 3
    sets: list[set[int]] = [set(modes)]
    for k in range(1, order + 1):
        reached = set(modes)
        for orders in combinations_with_replacement(range(k), factors):
            if sum(orders) == k - 1:
                for chosen in {
                    tuple(sorted(c)) for c in product(*(sets[j] for j in orders))
                }:
                    reached |= product_modes(N, chosen)
        sets.append(reached)
    return [tuple(sorted(members)) for members in sets]


def coupling_sequence(
    N: int, seeds: Iterable[int], order: int, *, model: str = "alpha"
) -> list[tuple[int, ...]]:
    """The corrected rule: modes by the first order at which the couplings B, C let them in.

    N : number of bonds, at least 2. seeds : distinct modes D_0. order : the last k, from 0 up.
    model : 'alpha', 'beta' or 'alpha+beta'. All are dimensionless integers.

    The couplings are those of Eq. transa. Differs from the Proposition in the beta model where
    two seeds have the sum N: there opposite terms of C cancel.
    Raises InputError for N below 2, seeds outside 1..N-1 or repeated, a negative order, an
    unknown model.

    >>> excitation_sequence(6, (2, 3), 2, model="beta")
    [(2, 3), (1, 4, 5), ()]
    >>> coupling_sequence(6, (2, 3), 2, model="beta")
    [(2, 3), (1, 5), (4,)]
    """
    return first_orders(coupled_modes(N, seeds, order, model=model))


@lru_cache(maxsize=1 << 18)
def product_modes(N: int, modes: tuple[int, ...]) -> frozenset[int]:
    """The modes q whose coupling B or C with these two or three is not zero.

    For B this is Eq. wg of Appendix B.
    """
    counts: dict[int, int] = {}
    first, *others = modes
    for signs in product((1, -1), repeat=len(others)):
        total = abs(first + sum(s * m for s, m in zip(signs, others, strict=True)))
        q = fold(total, N)
        # cos(2N - q) theta = -cos q theta; total < 3N
        counts[q] = counts.get(q, 0) + (1 if total <= N else -1)
    return frozenset(q for q, count in counts.items() if count and 0 < q < N)
