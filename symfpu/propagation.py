"""Which mode is excited at which order: the propagation rule of the paper's proposition (Eqs. app, dk)."""

from __future__ import annotations

from collections.abc import Iterable

from symfpu.algebra.selection import fold
from symfpu.errors import InputError
from symfpu.exact import integer, seed_modes

MODELS = ("alpha", "beta", "alpha+beta")


def reachable_modes(N: int, seeds: Iterable[int], order: int, *, model: str = "alpha") -> list[tuple[int, ...]]:
    """The sets M_0 .. M_order of Eq. app as ascending tuples, with the values 0 and N, which are no modes, left out.

    M_k holds the folded sums of r signed seeds, r = k + 1 (alpha; alpha and beta together), 2k + 1 (beta).
    Raises InputError.

    >>> reachable_modes(32, (3, 5), 1)
    [(3, 5), (2, 6, 8, 10)]
    """
    N = integer(N, "N", 2)
    modes = seed_modes(seeds, N)
    order = integer(order, "order", 0)
    if model not in MODELS:
        raise InputError("model", model, "'alpha', 'beta' or 'alpha+beta'", "pass one of these")
    sums = {fold(q, N) for q in modes}
    reached = []
    for _k in range(order + 1):
        reached.append(tuple(sorted(sums - {0, N})))
        for _ in range(2 if model == "beta" else 1):
            # folding is a map of the sums modulo 2N and sign, so it may be done at every step
            sums = {fold(total + sign * q, N) for total in sums for q in modes for sign in (1, -1)}
    return reached


def excitation_sequence(N: int, seeds: Iterable[int], order: int, *, model: str = "alpha") -> list[tuple[int, ...]]:
    """The sets D_0 .. D_order of Eq. dk: the modes that the rule excites at each order, as ascending tuples.

    This is the rule of the proposition; which modes are excited in fact is a question for exact arithmetic.
    Raises InputError for N below 2, seeds outside 1..N-1 or repeated, a negative order, an unknown model.

    >>> excitation_sequence(32, (1, 2, 3, 4), 2)
    [(1, 2, 3, 4), (5, 6, 7, 8), (9, 10, 11, 12)]
    """
    seen: set[int] = set()
    sequence = []
    for reached in reachable_modes(N, seeds, order, model=model):
        sequence.append(tuple(q for q in reached if q not in seen))
        seen.update(reached)
    return sequence
