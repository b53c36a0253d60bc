"""Section 6.1 without estimates: energies of tori on low packets, by the leading terms, exactly.

The seeds 1 .. s excite a mode q of D_k by sums n_1 + ... + n_r = q, or with one seed subtracted
where V is even and q < 2ks: other sums of r seeds end in earlier groups, and none folds while
q + r s < 2N. So a term of Q_q^(k) is a product of r seeds z_n or their conjugates with given n,
and its coefficient is the recursion on the subsets of these r factors (Eqs. moda, modb): with
u_q = Omega_q Q_q and true divisors,

  U(S) = -L(S) sum_p g_p sum of U(S_1) ... U(S_p),   g_p = c_(p+1) / (2N)^((p-1)/2),

over all ordered ways to part S, L(S) = Omega_m^2 / (Omega_m^2 - nu^2), m the sum of the seeds in S
and nu of their frequencies with the signs of z. Nothing is drawn: a torus has fixed amplitudes, and
the mean over time is the sum of squares over harmonics.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import islice
from math import factorial

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.localization.laws import middle_modes, packet_width, positive
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, seed_modes

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Parts = tuple[int, ...]  # subsets, as bits, that make up another one

LAST_GROUP = 3  # whose middle mode is given unless others are asked for
ROWS = 2**14  # products of seeds at a time
MOST_WORK = 10**13  # multiplications: ten minutes to half an hour
MOST_WAITING = 2**22  # products whose harmonics others have, that are held one by one
# of Omega^2: a divisor below it cannot be told from zero in doubles
LEAST_DIVISOR = 1e-12


@dataclass(frozen=True)
class Recursion:
    """The ways to part every subset of r factors, with their couplings; s and linear frequencies.

    splits : by subset, in the order of its size, pairs of the parts and g_p p!.
    """

    width: int
    degree: int
    frequencies: Floats  # Omega_0 = 0, Omega_1, ...
    splits: dict[int, list[tuple[Parts, float]]]

    @property
    def work(self) -> int:
        """Multiplications for one product of seeds with all signs."""
        products = sum(len(parts) for ways in self.splits.values() for parts, _ in ways)
        return products << (self.degree - 1)

    def ways(self) -> tuple[Integers, Integers, Floats, Integers]:
        """As `squares_of_products` takes them; parts of one factor, U = 1, are left out."""
        places = {subset: place for place, subset in enumerate(self.splits)}
        kept = [
            ([places[part] for part in parts if part.bit_count() > 1], g)
            for ways in self.splits.values()
            for parts, g in ways
        ]
        parts = np.full((len(kept), max(2, *(len(row) for row, _ in kept))), -1)
        for filled, (row, _) in zip(parts, kept, strict=True):
            filled[: len(row)] = row
        first = np.cumsum([0, *map(len, self.splits.values())])
        return np.array(list(places)), first, np.array([g for _, g in kept]), parts


@public
def packet_energies(
    chain: Chain,
    s: int,
    specific_energy: float,
    modes: Sequence[int] | None = None,
    *,
    workers: int = 1,
    progress: Progress | None = None,
) -> Floats:
    """Mean energies E_q on the torus with seeds 1 .. s of equal energies, by the leading terms.

    The sum that Eqs. eksa and eksp estimate, over all products of seeds, with the divisors of the
    chain as it is: E_q = mu^2k (1/2) <(dQ_q^(k)/dt)^2 + Omega_q^2 (Q_q^(k))^2>, k the order at
    which q is excited, frequencies linear and without relations. Ours; nothing is random.

    chain : of any potential with c_3, or with c_4 where it is even; N up to thousands.
    s : how many seeds, 1 .. N-1. specific_energy : eps = E/N, each seed has E/s. modes : beyond the
        seeds, default the middle ones of D_1, D_2, D_3. All is dimensionless.
    workers : threads; sums to rounding the same. progress : called as (label, fraction).

    Returns energies (n,), in the order of the modes; 0.0 for a mode that is not excited. Exact to
    rounding; the true torus differs by terms of higher order in lambda, of `packet_parameter`.
    Raises InputError for arguments out of range, for sums that fold (q + r s >= 2N), for a divisor
    that cannot be told from zero, and for sums too long to wait for.

    >>> chain = Chain(N=256, beta="0.3")
    >>> packet_energies(chain, 16, 1.5625e-6)
    array([9.40714185e-15, 3.38596661e-25, 5.34187447e-36])
    """
    chain, s = _chain(chain), packet_width(chain, s)
    share = chain.N * positive(specific_energy, "specific_energy") / s
    chosen = _modes(chain, s, modes)
    heard, workers = progress or unheard, integer(workers, "workers", 1)
    energies = np.zeros(len(chosen))
    for place, q in enumerate(chosen):

        def tell(done: float, label: str = f"mode {q}", before: int = place) -> None:
            heard(label, (before + done) / len(chosen))

        energies[place] = _energy(chain, s, share, q, workers, tell)
    return energies


def _energy(
    chain: Chain,
    s: int,
    share: float,
    q: int,
    workers: int,
    tell: Callable[[float], None],
) -> float:
    """E_q with the energy E/s in each seed: w_n^2 = E_n/2."""
    from symfpu.localization.packet_loops import rows_that_meet, squares_of_products

    degree = _degree(chain, s, q)
    recursion = _recursion(chain, s, degree)
    _check_work(recursion, q)
    # a seed that is subtracted can take the place of one that another product has twice
    least_pairs = 1 if q < (degree - 1) * s else 2
    check_keys(s, degree - 2 * least_pairs, q)
    ways = recursion.ways()

    def summed(batch: tuple[Integers, bool]) -> tuple[float, Integers, Floats]:
        seeds, turned = np.ascontiguousarray(batch[0]), batch[1]
        room = rows_that_meet(seeds, least_pairs) << (degree - 1)
        keys, meeting = np.empty(room, dtype=np.int64), np.empty((room, 3))
        rules = s, recursion.frequencies, ways, least_pairs, LEAST_DIVISOR
        own, written, near = squares_of_products(seeds, turned, *rules, keys, meeting)
        if near:
            raise _resonant(recursion)
        return own, keys[:written], meeting[:written]

    count, done, total = max(product_count(s, degree, q), 1), 0, 0.0
    meetings, batches = Meetings(), packet_products(s, degree, q)
    with ThreadPoolExecutor(workers) as pool:
        while some := list(islice(batches, workers)):
            tell(done / count)
            for own, keys, meeting in pool.map(summed, some):
                total += own
                meetings.add(keys, meeting)
            done += sum(len(seeds) for seeds, _ in some)
    return float((total + meetings.total()) / 2 * (share / 2) ** degree)


def packet_products(s: int, degree: int, q: int) -> Iterator[tuple[Integers, bool]]:
    """All sets of r seeds in 1 .. s that make up a mode, many rows (rows, r) at a time.

    False : their sum is q. True : it is with the last column subtracted.
    """
    for rows in _batches([_partitions_of(s, degree, q)]):
        yield rows, False
    most = min(s, (degree - 1) * s - q)
    turned = (_with_last(s, degree, q, last) for last in range(1, most + 1))
    for rows in _batches(turned):
        yield rows, True


def _with_last(s: int, degree: int, q: int, last: int) -> Iterator[Integers]:
    for rows in _partitions_of(s, degree - 1, q + last):
        yield np.column_stack([rows, np.full(len(rows), last)])


def _partitions_of(s: int, degree: int, q: int) -> Iterator[Integers]:
    """All n_1 <= ... <= n_r in 1 .. s with the sum q."""
    lacking = degree * s - q
    for first in range(-(-lacking // degree), min(lacking, s - 1) + 1):
        rows = np.array([[first]])
        for left in range(degree - 1, 0, -1):
            rows = _extended(rows, lacking - rows.sum(axis=1), left)
        yield s - rows


def _batches(parts: Iterable[Iterable[Integers]]) -> Iterator[Integers]:
    """The same rows, ROWS at a time."""
    held: list[Integers] = []
    for rows in (rows for part in parts for rows in part):
        held.append(rows)
        if sum(map(len, held)) >= ROWS:
            yield from _cut(np.concatenate(held))
            held = []
    if held:
        yield from _cut(np.concatenate(held))


def _cut(rows: Integers) -> Iterator[Integers]:
    for start in range(0, len(rows), ROWS):
        yield rows[start : start + ROWS]


def _extended(rows: Integers, lacking: Integers, left: int) -> Integers:
    """Every row with each next part, no greater than its last; `left` parts make up the rest."""
    low = -(-lacking // left)
    high = np.minimum(lacking, rows[:, -1])
    counts = np.maximum(high - low + 1, 0)
    starts = np.cumsum(counts) - counts
    place = np.arange(counts.sum()) - np.repeat(starts, counts)
    following = np.repeat(low, counts) + place
    return np.column_stack([np.repeat(rows, counts, axis=0), following])


class Meetings:
    """What products with the same harmonic add to the sum of their squares.

    Held by harmonic, each with its opposite: sums of c, of the shares of c^2, and the weight.
    """

    def __init__(self) -> None:
        self.keys = np.zeros(0, dtype=np.int64)
        self.columns = np.zeros((0, 3))
        self._later: list[tuple[Integers, Floats]] = []
        self._waiting = 0

    def add(self, keys: Integers, columns: Floats) -> None:
        """More of them; summed up where many wait."""
        self._later.append((keys, columns))
        self._waiting += len(keys)
        if self._waiting > max(MOST_WAITING, len(self.keys)):
            self._sum_up()

    def _sum_up(self) -> None:
        keys = np.concatenate([self.keys, *(keys for keys, _ in self._later)])
        columns = np.concatenate([self.columns, *(found for _, found in self._later)])
        self._later, self._waiting = [], 0
        if not len(keys):
            return
        order = np.argsort(keys, kind="stable")
        keys, columns = keys[order], columns[order]
        first = np.flatnonzero(np.diff(keys, prepend=-1))
        self.keys = keys[first]
        sums = np.add.reduceat(columns[:, :2], first, axis=0)
        self.columns = np.column_stack([sums, columns[first, 2]])

    def total(self) -> float:
        """Over all harmonics and their opposites; key 0 is its own opposite."""
        self._sum_up()
        sums, squares, weights = self.columns.T
        times = np.where(self.keys == 0, 2.0, 1.0)
        return float(np.sum(2 * weights * (times * sums**2 - squares)))


def _recursion(chain: Chain, s: int, degree: int) -> Recursion:
    everything = range(1, 2**degree)
    ordered = sorted(everything, key=lambda subset: (subset.bit_count(), subset))
    splits = {}
    for subset in ordered:
        if (subset.bit_count() - 1) % chain.degree_step == 0:
            splits[subset] = list(_ways(chain, subset))
    frequencies = np.concatenate([[0.0], chain.frequencies()])
    return Recursion(s, degree, frequencies, splits)


def _ways(chain: Chain, subset: int) -> Iterator[tuple[Parts, float]]:
    """Two or more parts of a subset whose sizes have terms, with g_p p!."""
    for parts in _partitions(subset, chain.degree_step):
        p = len(parts)
        coupling = float(chain.potential.coefficient(p + 1))
        if p > 1 and coupling:
            yield parts, coupling / (2 * chain.N) ** ((p - 1) / 2) * factorial(p)


def _partitions(subset: int, step: int) -> Iterator[Parts]:
    """All partitions of a subset, as bits, into sets of sizes 1, 1 + step, ...

    >>> sorted(_partitions(0b111, 2))
    [(1, 2, 4), (7,)]
    """
    if not subset:
        yield ()
        return
    first = subset & -subset
    others = subset ^ first
    chosen = others
    while True:
        if chosen.bit_count() % step == 0:
            for rest in _partitions(others ^ chosen, step):
                yield (first | chosen, *rest)
        if not chosen:
            return
        chosen = (chosen - 1) & others


def _degree(chain: Chain, s: int, q: int) -> int:
    """r(k) of the group D_k that a mode is in."""
    step = chain.degree_step
    order = -(-(q - s) // (s * step))
    return order * step + 1


def _chain(chain: Chain) -> Chain:
    """InputError for a chain whose packets have other leading terms."""
    require_chain(chain)
    if not chain.potential.coefficient(2 + chain.degree_step):
        allowed = "a chain with c_3, or with c_4 where V is even"
        advice = "its packets are excited by higher forces: take lindstedt"
        raise InputError("chain", chain, allowed, advice)
    return chain


def _modes(chain: Chain, s: int, modes: Sequence[int] | None) -> tuple[int, ...]:
    if modes is None:
        single = s == 1 and chain.potential.even
        middle = range(3, chain.N, 2) if single else middle_modes(chain, s)
        return tuple(q for q in middle[:LAST_GROUP] if not _folds(chain, s, q))
    chosen = seed_modes(modes, chain.N)
    for q in chosen:
        if q <= s or _folds(chain, s, q):
            allowed = (
                f"modes beyond the seeds 1..{s} with q + r s < 2N, r the seeds in a term"
            )
            raise InputError("modes", q, allowed, "leave it out, or take a longer chain")
    return chosen


def _folds(chain: Chain, s: int, q: int) -> bool:
    """Whether sums of seeds beyond N reach a mode, too."""
    return q + _degree(chain, s, q) * s >= 2 * chain.N


def product_count(s: int, degree: int, q: int) -> int:
    """How many sets of r seeds make up a mode: partitions of r s - q into r parts below s."""
    lacking = degree * s - q
    ways = np.zeros((degree + 1, lacking + 1), dtype=np.int64)
    ways[0, 0] = 1
    for part in range(min(s, lacking + 1)):
        for count in range(1, degree + 1):
            ways[count, part:] += ways[count - 1, : lacking + 1 - part]
    # with a seed 1, 2, ... subtracted the others lack less and less
    most = max(0, min(s, lacking - s))
    turned = ways[degree - 1, lacking - s - most : lacking - s].sum() if most else 0
    return int(ways[degree, lacking] + turned)


def _check_work(recursion: Recursion, q: int) -> None:
    """InputError for sums that would take more than half an hour."""
    count = product_count(recursion.width, recursion.degree, q)
    work = count * recursion.work
    if work > MOST_WORK:
        needed = f"mode {q}: {count:.3g} products of {recursion.degree} seeds"
        allowed = f"what takes {MOST_WORK:.0e} multiplications ({work:.1e} here)"
        raise InputError("modes", needed, allowed, "take fewer seeds, or an earlier group")


def check_keys(s: int, factors: int, q: int) -> None:
    """InputError where a harmonic that products share has no 64-bit number."""
    if (2 * s + 2) ** max(factors, 0) >= 2**63:
        allowed = f"what has harmonics of at most {factors} factors in 64 bits"
        raise InputError("modes", q, allowed, "take fewer seeds, or an earlier group")


def _resonant(recursion: Recursion) -> InputError:
    value = f"a product of {recursion.degree} seeds"
    allowed = "modes none of whose divisors is zero"
    advice = "linear frequencies are commensurable there: take another N or fewer seeds"
    return InputError("modes", value, allowed, advice)
