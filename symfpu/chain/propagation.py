"""Which mode is excited at which order: the propagation rule (Eqs. app, dk), and the corrected one.

The Proposition counts every folded sum of signed seeds. In the beta model that is too many: where
l + m = N, the sums q - l - m + n = 0 and q + l + m + n = 2N hold together for q = N - n, enter
C_qlmn with opposite signs, and cancel. The corrected rule follows the couplings B and C
themselves, and for other potentials those of every power of the stretch that acts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import product
from math import gcd

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.algebra.selection import fold
from symfpu.chain.ends import ENDS, checked_ends
from symfpu.chain.potentials.potential import Potential
from symfpu.chain.powers import Powers, powers_of
from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import length_of, order_of, seed_modes

MOST_PRODUCTS = 10**7  # of sets of modes
MOST_LISTED = 10**7  # modes, in all sets that are listed


@public
def reachable_modes(
    N: int,
    seeds: Iterable[int],
    order: int,
    *,
    model: str | None = None,
    potential: Potential | str | None = None,
    ends: str = "fixed",
) -> list[tuple[int, ...]]:
    """The sets M_0 .. M_order of Eq. app as ascending tuples.

    The values 0 and N are left out: they are no modes.

    N : number of bonds, at least 2. seeds : distinct modes D_0. order : the last k, from 0 up.
    model : 'alpha' (default), 'beta' or 'alpha+beta'. potential : in its place, that of any chain,
    such as toda("1/2") or "toda:1/2". ends : "periodic" for a ring, whose seeds are signed.
    All are dimensionless.

    M_k holds the folded sums of r signed seeds, r = k + 1 (alpha; alpha and beta together, and
    potentials that are not even), 2k + 1 (beta, even potentials). It is empty where no powers of
    the force make terms of the order, as at order 1 where c_3 = 0.
    On a ring sums are taken modulo N, not 2N, and q stands for the modes q and -q, since
    Q_(-q) = conj Q_q: those of the harmonics nu with nu.q_seeds = +-q (ours).
    Raises InputError for N below 2, seeds that are no modes or repeated, a negative order, an
    unknown model, potential or ends.

    >>> reachable_modes(32, (3, 5), 1)
    [(3, 5), (2, 6, 8, 10)]
    """
    classes: list[set[int]] = [set(), set()]
    reached: list[tuple[int, ...]] = []
    count = 0
    for parity, there_are_terms, new in _new_sums(N, seeds, order, model, potential, ends):
        classes[parity] |= new
        reached.append(tuple(sorted(classes[parity])) if there_are_terms else ())
        count += len(reached[-1])
        if count > MOST_LISTED:
            allowed = f"an order up to which the sets have {MOST_LISTED:,} members in all"
            advice = f"take order {len(reached) - 2} or less, or excitation_sequence"
            raise InputError("order", order, allowed, advice)
    return reached


def _new_sums(
    N: int,
    seeds: Iterable[int],
    order: int,
    model: str | None,
    potential: Potential | str | None,
    ends: str,
) -> Iterator[tuple[int, bool, set[int]]]:
    """By order: the parity of the number of seeds in a sum, whether there are terms, new modes.

    New are those of sums of that parity which no smaller number of seeds has: q - q adds two to
    any sum, so that sums of one parity stay, and new ones come from new ones alone.
    """
    kind = ENDS[checked_ends(ends)](length_of(N))
    modes = set(map(abs, kind.modes))
    waves = kind.seeds(seeds)
    powers = powers_of(model, potential)
    latest = {_folded(q, kind.turn) for q in waves}
    known = [set(latest), set()]
    added, parity = set(latest), 0
    for there_are_terms in powers.orders_reached(order_of(order)):
        yield parity, there_are_terms, added & modes
        added = set()
        for step in range(powers.step):
            parity ^= 1
            # folding is a map of the sums modulo the turn and sign: it may be done at every step
            latest = {
                _folded(total + sign * q, kind.turn)
                for total in latest
                for q in waves
                for sign in (1, -1)
            } - known[parity]
            known[parity] |= latest
            if step == powers.step - 1:
                added = latest


def _folded(total: int, turn: int) -> int:
    """A wave number up to sign and whole turns."""
    wave = total % turn
    return min(wave, turn - wave)


@public
def excitation_sequence(
    N: int,
    seeds: Iterable[int],
    order: int,
    *,
    model: str | None = None,
    potential: Potential | str | None = None,
    ends: str = "fixed",
) -> list[tuple[int, ...]]:
    """The sets D_0 .. D_order of Eq. dk, ascending: the modes the rule excites at each order.

    N : number of bonds, at least 2. seeds : distinct modes D_0. order : the last k, from 0 up.
    model : 'alpha' (default), 'beta' or 'alpha+beta'. potential : in its place, that of any chain,
    such as toda("1/2") or "toda:1/2". ends : "periodic" for a ring, whose seeds are signed.
    All are dimensionless.

    This is the rule of the Proposition for the sequence of Definition 2, for other potentials as
    `reachable_modes` reads it (ours); which modes are excited in fact is a question for exact
    arithmetic.
    Raises InputError for N below 2, seeds that are no modes or repeated, a negative order, an
    unknown model, potential or ends.

    >>> excitation_sequence(32, (1, 2, 3, 4), 2)
    [(1, 2, 3, 4), (5, 6, 7, 8), (9, 10, 11, 12)]
    >>> excitation_sequence(32, (3,), 3, potential="poly:0,1,1")
    [(3,), (), (9,), (6, 12)]
    >>> excitation_sequence(16, (1, -3), 2, ends="periodic")
    [(1, 3), (2, 4, 6), (5, 7)]
    """
    seen: set[int] = set()
    waiting: list[set[int]] = [set(), set()]  # by parity: of orders without terms
    sequence = []
    for parity, there_are_terms, new in _new_sums(N, seeds, order, model, potential, ends):
        waiting[parity] |= new
        first = waiting[parity] - seen if there_are_terms else set()
        if there_are_terms:
            waiting[parity] = set()
        sequence.append(tuple(sorted(first)))
        seen |= first
    return sequence


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
    N: int,
    seeds: Iterable[int],
    order: int,
    *,
    model: str | None = None,
    potential: Potential | str | None = None,
) -> list[tuple[int, ...]]:
    """The modes that the couplings let into each order 0 .. order.

    Outside these sets a term is identically zero.

    Order k holds the modes q with a coupling to some m_1 .. m_n, one from the set of each of n
    orders with the sum k - (n-1)/step, of a power r^n of the force that acts: B_q m1 m2 != 0 and
    sum k - 1 (alpha), C_q m1 m2 m3 != 0 and sum k - 1 (beta), C and sum k - 2 where both act. And
    the seeds, which frequency corrections can keep. Raises InputError.

    >>> coupled_modes(6, (2, 3), 2, model="beta")
    [(2, 3), (1, 2, 3, 5), (1, 2, 3, 4, 5)]
    """
    N = length_of(N)
    modes = seed_modes(seeds, N)
    order = order_of(order)
    powers = powers_of(model, potential)
    _check_products(powers, order)
    adds = list(powers.acting(order))
    sets: list[set[int]] = [set(modes)]
    for k in range(1, order + 1):
        reached = set(modes)
        for added in adds:
            for orders in _orders(k - added, powers.factors(added)):
                reached |= _products(N, [sets[j] for j in orders], reached)
        sets.append(reached)
    return [tuple(sorted(members)) for members in sets]


def _check_products(powers: Powers, order: int) -> None:
    """InputError where the orders have too many products of sets, with the highest that fits.

    The products that make an order k are the partitions of k - added into as many parts as the
    power has factors, or fewer; they are counted before a set is made.
    """
    acting = powers.acting(order)
    waiting = next(acting, None)
    adds: list[int] = []
    partitions: list[list[int]] = []  # [t][n], of t into at most n parts, n up to t
    count = 0
    for k in range(1, order + 1):
        if waiting == k:
            adds.append(k)
            waiting = next(acting, None)
        most = powers.factors(max(adds, default=0)) if waiting is None else k
        partitions.append(_partitions(k - 1, partitions, most))
        for added in adds:
            row = partitions[k - added]
            count += row[min(powers.factors(added), len(row) - 1)]
        if count > MOST_PRODUCTS:
            allowed = f"an order with at most {MOST_PRODUCTS:,} products of sets of modes"
            raise InputError("order", order, allowed, f"take order {k - 1} or less")


def _partitions(t: int, smaller: list[list[int]], most: int) -> list[int]:
    """Partitions of t into at most n parts, by n; those of smaller numbers are known."""
    row = [int(t == 0)]
    for n in range(1, min(most, t) + 1):
        rest = smaller[t - n]
        row.append(row[-1] + rest[min(n, len(rest) - 1)])
    return row


def _orders(total: int, count: int, most: int | None = None) -> Iterator[tuple[int, ...]]:
    """So many whole numbers with the sum, descending, none above the most."""
    if count == 0:
        if total == 0:
            yield ()
        return
    highest = total if most is None else min(total, most)
    for first in range(highest, -1, -1):
        for rest in _orders(total - first, count - 1, first):
            yield first, *rest


def _products(N: int, sets: list[set[int]], known: set[int]) -> set[int]:
    """The modes, besides the known, to which one mode of each set couples."""
    sums = sets[0]
    for others in sets[1:]:
        signed = {sign * q for q in others for sign in (1, -1)}
        sums = {fold(total + q, N) for total in sums for q in signed}
    # no couplings but these: where all are known, their signs do not matter
    possible = sums - {0, N} - known
    found: set[int] = set()
    for chosen in {tuple(sorted(c)) for c in product(*sets)} if possible else ():
        found |= product_modes(N, chosen) - known
        if found == possible:
            break
    return found


@public
def coupling_sequence(
    N: int,
    seeds: Iterable[int],
    order: int,
    *,
    model: str | None = None,
    potential: Potential | str | None = None,
) -> list[tuple[int, ...]]:
    """The corrected rule: modes by the first order at which the couplings let them in.

    N : number of bonds, at least 2. seeds : distinct modes D_0. order : the last k, from 0 up.
    model : 'alpha' (default), 'beta' or 'alpha+beta'. potential : in its place, that of any chain,
    such as toda("1/2") or "toda:1/2". All are dimensionless.

    The couplings are those of Eq. transa, and for higher powers their like, of every power of the
    stretch that acts in the force. Differs from the Proposition in the beta model where two seeds
    have the sum N: there opposite terms of C cancel.
    Raises InputError for N below 2, seeds outside 1..N-1 or repeated, a negative order, an
    unknown model or potential.

    >>> excitation_sequence(6, (2, 3), 2, model="beta")
    [(2, 3), (1, 4, 5), ()]
    >>> coupling_sequence(6, (2, 3), 2, model="beta")
    [(2, 3), (1, 5), (4,)]
    """
    return first_orders(coupled_modes(N, seeds, order, model=model, potential=potential))


def carried_modes(
    N: int, seeds: Sequence[int], harmonics: ArrayLike, *, even: bool
) -> NDArray[np.bool_]:
    """Which modes can carry which harmonics in a torus of these seeds; shape (H, N-1).

    N : bonds, with fixed ends. harmonics : nu, shape (H, s). even : whether V is.

    A term of a harmonic nu has k_i factors of seed i, k_i - nu_i even, and a wave number
    sum j_i q_i with j_i - k_i even, up to sign and modulo 2N. So q = +- nu.seeds modulo 2g, with g
    the greatest common divisor of N and all seeds; sum k_i is odd where V is even. Elsewhere
    every term is zero, of any potential. Ours: the Proposition harmonic by harmonic.

    >>> carried_modes(9, (3,), [[0], [1], [2]], even=False).nonzero()
    (array([0, 1, 2]), array([5, 2, 5]))
    """
    nu = np.asarray(harmonics, dtype=np.int64)
    waves, modes = nu @ np.array(seeds), np.arange(1, N)
    turn = 2 * gcd(N, *map(int, seeds))
    found = (modes - waves[:, None]) % turn == 0
    found |= (modes + waves[:, None]) % turn == 0
    if even:
        found &= (nu.sum(axis=1) % 2 == 1)[:, None]
    return np.asarray(found)


@lru_cache(maxsize=1 << 18)
def product_modes(N: int, modes: tuple[int, ...]) -> frozenset[int]:
    """The modes q whose coupling B, C, ... with these two, three, ... is not zero.

    For B this is Eq. wg of Appendix B.
    """
    return frozenset(q for q, _ in product_couplings(N, modes))


@lru_cache(maxsize=1 << 18)
def product_couplings(N: int, modes: tuple[int, ...]) -> tuple[tuple[int, int], ...]:
    """The modes q whose coupling with these is not zero, and B_q m1 m2, C_q m1 m2 m3, ...."""
    first, *others = modes
    counts = {first: 1}  # of cosines of the bonds, by wave number
    for m in others:
        longer: dict[int, int] = {}
        for q, count in counts.items():
            for total in (q + m, abs(q - m)):
                # cos (2N - q) theta = -cos q theta on the bonds
                sign = 1 if total <= N else -1
                folded = fold(total, N)
                longer[folded] = longer.get(folded, 0) + sign * count
        counts = longer
    return tuple((q, count) for q, count in counts.items() if count and 0 < q < N)
