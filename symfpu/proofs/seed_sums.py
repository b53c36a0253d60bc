"""What signed sums of seeds show of a mode without its terms: one parity of folds, or a chain.

A mode of D_k is a folded sum a.q = +-q + 2wN of d seeds. Where all sums of the same seeds that
fold to it have w of one parity, all products of its term have one sign, and there is one. Where
a coupling leads to it from a mode of order k - 1 and from seeds, the coefficient of one L_m is
not zero (docs/propagation.md, Theorems 7 and 8).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import combinations_with_replacement, product

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.propagation import product_modes
from symfpu.proofs.flats import Ints, degree_of
from symfpu.proofs.plus_terms import BOTH, MINUS, PLUS, Powers, powers_of_degree

# the last orders at which a chain shows a mode for generic frequencies of every N
CHAINS = {"alpha": 3, "beta": 2}


def without_odd_sums(model: str, order: int, seeds: Ints, N: Ints) -> NDArray[np.bool_]:
    """Which seed sets have no sum of fewer than d signed seeds that is an odd multiple of N.

    On those every sum that folds to a mode of D_k does so with one parity. seeds : a row for
    each set. N : one number for each.
    """
    most = degree_of(model, order) - 1
    found = np.ones(len(N), dtype=np.bool_)
    for m in product(range(-most, most + 1), repeat=seeds.shape[1]):
        if sum(map(abs, m)) <= most:
            found &= (seeds @ np.array(m) - N) % (2 * N) != 0
    return found


def parities(N: int, seeds: Sequence[int], p: Powers) -> dict[int, int]:
    """By mode: PLUS, MINUS or BOTH, the signs (-1)^w of the sums of p_1 + ... + p_s seeds."""
    sums = {0}
    for q, n in zip(seeds, p, strict=True):
        sums = {(total + a * q) % (4 * N) for total in sums for a in range(-n, n + 1, 2)}
    found: dict[int, int] = {}
    for total in sums:
        wave = total % (2 * N)
        mode = min(wave, 2 * N - wave)
        sign = PLUS if mode in (total, 4 * N - total) else MINUS
        found[mode] = found.get(mode, 0) | sign
    return found


def modes_of_one_parity(
    N: int, model: str, seeds: Sequence[int], orders: Mapping[int, int]
) -> set[int]:
    """Modes that some powers of their order reach with one sign alone."""
    found: set[int] = set()
    for k in sorted(set(orders.values()) - {0}):
        members = {q for q, order in orders.items() if order == k}
        for p in powers_of_degree(len(seeds), degree_of(model, k)):
            signs = parities(N, seeds, p)
            found |= {q for q in members if signs.get(q, BOTH) != BOTH}
            if members <= found:
                break
    return found


def chained_modes(
    N: int,
    model: str,
    seeds: Sequence[int],
    orders: Mapping[int, int],
    known: Collection[int],
) -> set[int]:
    """Modes to which couplings lead from known or chained ones of the order before."""
    found: set[int] = set()
    last = set(seeds)
    for k in range(1, CHAINS[model] + 1):
        members = {q for q, order in orders.items() if order == k}
        reached = members & _coupled(N, model, last, seeds)
        found |= reached
        last = reached | (members & set(known))
    return found


def _coupled(N: int, model: str, modes: Iterable[int], seeds: Sequence[int]) -> set[int]:
    """What one of the modes and one seed (two, in beta) are coupled to."""
    found: set[int] = set()
    for others in combinations_with_replacement(seeds, 1 if model == "alpha" else 2):
        for m in modes:
            found |= product_modes(N, tuple(sorted((m, *others))))
    return found
