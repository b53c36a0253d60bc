"""Programs over symbols: sums of products, each made once, in flat arrays.

A node is a leaf (a symbol), or an integer combination of products of two earlier nodes; a product
with node ONE is the other node itself. Whole tables of nodes are made at once. Equal products of a
sum are collected, a sum left without a term is zero, and equal sums are one node: found by a hash,
then compared term by term. A zero that only an identity between different products makes shows in
residues: values at POINTS random points modulo PRIME. A polynomial of degree D that is not zero
vanishes at all of them with a probability below (D / PRIME)^POINTS (Schwartz and Zippel), 1e-29
for degree 100.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Hashable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Residues = NDArray[np.uint64]

ONE = 0  # the node of the number one
ZERO = -1  # stands in tables where there is no node
PRIME = 2**31 - 1
POINTS = 4
DRAW = 20110914  # of the random points
MIXING = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)  # odd numbers


class Terms(NamedTuple):
    """Terms of sums, sum after sum: factor left right; shapes (terms,)."""

    left: Ints
    right: Ints
    factor: Ints

    def at(self, places: Any) -> Terms:
        """Some of them."""
        return Terms(self.left[places], self.right[places], self.factor[places])


class Program:
    """The nodes, and what the leaves stand for.

    symbols : what each leaf stands for, in the order in which they were made. leaves : their
    nodes. start : the terms of node i are start[i] to start[i + 1] of `terms`, none for a leaf.
    """

    def __init__(self) -> None:
        self.symbols: list[Hashable] = []
        self.leaves: list[int] = []
        self._node_of: dict[Hashable, int] = {}
        self._random = np.random.default_rng(DRAW)
        self._start = _Growing(np.zeros(2, dtype=np.int64))
        empty = np.zeros(0, dtype=np.int64)
        self._terms = tuple(_Growing(empty) for _ in Terms._fields)
        first = np.ones((1, POINTS), dtype=np.uint64)
        none = np.zeros(1, dtype=np.uint64)
        self._fingerprints: Fingerprints | None = Fingerprints(
            _Growing(first), _Growing(none)
        )

    @classmethod
    def of_arrays(cls, symbols: Sequence[Hashable], start: Ints, terms: Terms) -> Program:
        """The program of such arrays, as `start` and `terms` give them.

        Raises ValueError where they are those of no program.
        """
        counts = np.diff(start)
        ends = start[:1].tolist() == [0] and start[-1:].tolist() == [len(terms.left)]
        leaves = np.flatnonzero(counts == 0)
        if not ends or (counts < 0).any() or leaves[:1].tolist() != [ONE]:
            raise ValueError("the terms of a program are in no order")
        if len(leaves) != 1 + len(symbols) or len(set(symbols)) != len(symbols):
            raise ValueError("a program has other leaves than symbols")
        own = np.repeat(np.arange(len(counts)), counts)
        known = (terms.left >= 0) & (terms.left <= terms.right) & (terms.right < own)
        if not known.all():
            raise ValueError("a node of a program comes before its parts")
        program = cls()
        program.symbols, program.leaves = list(symbols), leaves[1:].tolist()
        program._node_of = dict(zip(symbols, program.leaves, strict=True))
        program._start = _Growing(start)
        program._terms = tuple(map(_Growing, terms))
        program._fingerprints = None
        return program

    def _found_fingerprints(self) -> Fingerprints:
        """Residues and hashes of all nodes; of a program out of arrays as they were made once."""
        if self._fingerprints is None:
            self._fingerprints = self._made_again()
        return self._fingerprints

    def _made_again(self) -> Fingerprints:
        counts = np.diff(self.start)
        residues = np.ones((len(counts), POINTS), dtype=np.uint64)
        for leaf in self.leaves:
            residues[leaf] = self._draw()
        _add_residues(residues, self.start, self.terms, residues)
        hashes = np.zeros(len(counts), dtype=np.uint64)
        sums = np.flatnonzero(counts)
        if len(sums):
            hashes[sums] = np.add.reduceat(_mixed(self.terms), self.start[sums])
        return Fingerprints(_Growing(residues), _Growing(hashes))

    def _draw(self) -> Residues:
        return self._random.integers(1, PRIME, size=POINTS, dtype=np.uint64)

    @property
    def size(self) -> int:
        """Nodes."""
        return self._start.used - 1

    @property
    def start(self) -> Ints:
        """Where the terms of each node begin; (size + 1,)."""
        return self._start.values

    @property
    def terms(self) -> Terms:
        """The terms of all nodes."""
        return Terms(*(part.values for part in self._terms))

    @property
    def hashes(self) -> Residues:
        """A hash of the terms of each node; 0 for leaves."""
        return self._found_fingerprints().hashes.values

    @property
    def residues(self) -> Residues:
        """Values of all nodes modulo PRIME at the random points; (size, POINTS)."""
        return self._found_fingerprints().residues.values

    def _extend(self, ends: Ints, residues: Residues, hashes: Residues) -> None:
        found = self._found_fingerprints()
        found.residues.extend(residues)
        found.hashes.extend(hashes)
        self._start.extend(ends)

    def vanishing(self, nodes: Ints) -> NDArray[np.bool_]:
        """Which nodes are zero at all random points; false for ZERO itself."""
        zero = ~self.residues[nodes].any(axis=-1)
        return np.asarray(zero & (nodes != ZERO))

    def leaf_number(self, node: int) -> int:
        """The place of a leaf among `leaves` and `symbols`."""
        return bisect_left(self.leaves, node)

    def leaf(self, symbol: Hashable) -> int:
        """The node of a symbol."""
        if symbol not in self._node_of:
            self._node_of[symbol] = self.size
            self.leaves.append(self.size)
            self.symbols.append(symbol)
            self._found_fingerprints()  # those of older leaves are drawn first
            self._extend(self.start[-1:], self._draw()[None], np.zeros(1, dtype=np.uint64))
        return self._node_of[symbol]

    def sums(self, count: int, out: Ints, terms: Terms) -> Ints:
        """The nodes of `count` sums.

        out : which sum a term belongs to; a plain summand is one with left or right ONE; shapes
        (terms,). Returns (count,), ZERO where a sum vanishes.
        """
        out, terms = collected(self.size, out, terms)
        nodes = np.full(count, ZERO, dtype=np.int64)
        alone = np.bincount(out, minlength=count)[out] == 1
        same = alone & (terms.factor == 1) & (terms.left == ONE)
        nodes[out[same]] = terms.right[same]
        places, counts = np.unique(out[~same], return_counts=True)
        if len(places):
            nodes[places] = self._found_or_made(counts, terms.at(~same))
        return nodes

    def _found_or_made(self, counts: Ints, terms: Terms) -> Ints:
        """The nodes of sums of so many terms each, the same for the same terms."""
        start = np.concatenate([[0], np.cumsum(counts)])
        hashes = np.add.reduceat(_mixed(terms), start[:-1])
        _, first, inverse = np.unique(hashes, return_index=True, return_inverse=True)
        original = first[inverse.reshape(-1)]
        every = np.arange(len(counts))
        apart = ~_equal((start, terms, original), (start, terms, every))
        original[apart] = every[apart]
        fresh = np.flatnonzero(original == every)
        nodes = np.full(len(counts), ZERO, dtype=np.int64)
        nodes[fresh] = self._known(hashes[fresh], start, terms, fresh)
        fresh = fresh[nodes[fresh] == ZERO]
        if len(fresh):
            nodes[fresh] = self._made(
                hashes[fresh], counts[fresh], terms.at(ranges(start, fresh))
            )
        return np.asarray(nodes[original])

    def _known(self, hashes: Residues, start: Ints, terms: Terms, chosen: Ints) -> Ints:
        """Nodes that are there already with the terms of the chosen sums, ZERO for none."""
        order = np.argsort(self.hashes, kind="stable")
        sorted_hashes = self.hashes[order]
        place = np.searchsorted(sorted_hashes, hashes)
        there = place < self.size
        there[there] = sorted_hashes[place[there]] == hashes[there]
        nodes = np.full(len(hashes), ZERO, dtype=np.int64)
        nodes[there] = order[place[there]]
        same = _equal((self.start, self.terms, nodes[there]), (start, terms, chosen[there]))
        nodes[np.flatnonzero(there)[~same]] = ZERO
        return nodes

    def _made(self, hashes: Residues, counts: Ints, terms: Terms) -> Ints:
        """New nodes of sums of so many terms each."""
        start = np.concatenate([[0], np.cumsum(counts)])
        residues = np.zeros((len(counts), POINTS), dtype=np.uint64)
        _add_residues(self.residues, start, terms, residues)
        nodes = self.size + np.arange(len(counts))
        self._extend(self.start[-1] + start[1:], residues, hashes)
        for part, values in zip(self._terms, terms, strict=True):
            part.extend(values)
        return nodes


class _Growing:
    """An array that rows are appended to; its room doubles."""

    def __init__(self, values: NDArray[Any]) -> None:
        self._room, self.used = values, len(values)

    @property
    def values(self) -> NDArray[Any]:
        return self._room[: self.used]

    def extend(self, rows: NDArray[Any]) -> None:
        """Appends."""
        before, self.used = self.used, self.used + len(rows)
        if self.used > len(self._room):
            larger = np.empty(
                (2 * self.used, *self._room.shape[1:]), dtype=self._room.dtype
            )
            larger[:before] = self._room[:before]
            self._room = larger
        self._room[before : self.used] = rows


class Fingerprints(NamedTuple):
    """Residues (nodes, POINTS) and hashes (nodes,)."""

    residues: _Growing
    hashes: _Growing


def collected(size: int, out: Ints, terms: Terms) -> tuple[Ints, Terms]:
    """The terms sorted by sum and product, equal products of a sum added, zeros left out.

    size : of the program; all nodes are below it.
    """
    low = np.minimum(terms.left, terms.right)
    high = np.maximum(terms.left, terms.right)
    order, first = _sorted(size, out, low, high)
    if not len(order):
        return out[order], terms.at(order)
    factor = np.add.reduceat(terms.factor[order], first)
    kept = order[first[factor != 0]]
    return out[kept], Terms(low[kept], high[kept], factor[factor != 0])


def _sorted(size: int, out: Ints, low: Ints, high: Ints) -> tuple[Ints, Ints]:
    """An order by (out, low, high), and where each distinct triple begins in it."""
    largest = int(out.max(initial=0)) + 1
    if largest * size * size < 2**63:
        keys = (out * size + low) * size + high
        order = np.argsort(keys)
        keys = keys[order]
        return order, np.flatnonzero(np.diff(keys, prepend=-1))
    order = np.lexsort((high, low, out))
    columns = np.stack([out[order], low[order], high[order]])
    changes = np.diff(columns, axis=1, prepend=-1).any(axis=0)
    return order, np.flatnonzero(changes)


def _mixed(terms: Terms) -> Residues:
    """A random looking number for each term."""
    mixed = np.zeros(len(terms.left), dtype=np.uint64)
    with np.errstate(over="ignore"):
        for part, odd in zip(terms, MIXING, strict=True):
            mixed = (mixed ^ part.astype(np.uint64)) * np.uint64(odd)
            mixed ^= mixed >> np.uint64(29)
    return mixed


def ranges(start: Ints, chosen: Ints) -> Ints:
    """The places of the terms of the chosen sums, sum after sum."""
    counts = start[chosen + 1] - start[chosen]
    before = np.cumsum(counts) - counts
    return np.repeat(start[chosen] - before, counts) + np.arange(int(counts.sum()))


def _equal(a: tuple[Ints, Terms, Ints], b: tuple[Ints, Terms, Ints]) -> NDArray[np.bool_]:
    """Whether chosen sums of one list have the same terms as those of another, one by one."""
    lengths = [start[chosen + 1] - start[chosen] for start, _, chosen in (a, b)]
    same = lengths[0] == lengths[1]
    places = [ranges(start, chosen[same]) for start, _, chosen in (a, b)]
    differs = np.zeros(len(places[0]), dtype=np.bool_)
    for left, right in zip(a[1], b[1], strict=True):
        differs |= left[places[0]] != right[places[1]]
    row = np.repeat(np.flatnonzero(same), lengths[0][same])
    same[row[differs]] = False
    return np.asarray(same)


def _add_residues(values: Residues, start: Ints, terms: Terms, sums: Residues) -> None:
    """Values of sums modulo PRIME, from those of all nodes before; sums without terms stay."""
    from symfpu.algebra.program_loops import (
        sum_residues,
    )  # lazy: numba takes long to import

    factor = (terms.factor % PRIME).astype(np.uint64)
    sum_residues(start, terms.left, terms.right, factor, np.uint64(PRIME), values, sums)
