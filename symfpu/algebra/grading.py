"""The monomials of one degree in z_1, conj z_1, ..., z_s, conj z_s: their order, ranks and product
tables.

A monomial is a row of exponents (p_1, n_1, ..., p_s, n_s): p of z, n of conj z. Its harmonic is
nu = p - n, its power of the amplitudes is p + n. Rows are grouped in blocks: the first seeds (the
outer monomial) name the block, the last ceil(s/2) seeds (the inner monomial) the place in it, so
that a product needs one small table for blocks and one for places.

Within a degree both groups are ordered by (nu, p + n), lexicographically. Adding a monomial keeps
that order, and conjugation reverses it up to ties; so the rows with nu >= 0, one of each
conjugate pair, are a suffix of every group. They are called canonical.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from math import comb
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Keys = NDArray[Any]  # integers: int64, or Python's own where int64 is too short


def monomial_count(seeds: int, degree: int) -> int:
    """Number of monomials of one degree in z and conj z of each seed: C(degree + 2 seeds - 1, 2
    seeds - 1).
    """
    return comb(degree + 2 * seeds - 1, 2 * seeds - 1)


def canonical_count(seeds: int, degree: int) -> int:
    """Number of canonical monomials (harmonic zero or lexicographically positive) of one degree."""
    own = comb(degree // 2 + seeds - 1, seeds - 1) if degree % 2 == 0 else 0
    return (monomial_count(seeds, degree) + own) // 2


def compositions(total: int, parts: int) -> Ints:
    """All rows of `parts` non-negative integers with sum `total`; shape (count, parts)."""
    if parts <= 1:
        return np.full((int(parts == 1 or total == 0), parts), total, dtype=np.int64)
    bars = np.array(
        list(combinations(range(total + parts - 1), parts - 1)), dtype=np.int64
    ).reshape(-1, parts - 1)
    edges = np.pad(bars, ((0, 0), (1, 1)), constant_values=((0, 0), (-1, total + parts - 1)))
    return np.asarray(np.diff(edges, axis=1) - 1)


class Group:
    """The monomials of some seeds, for every degree up to `degree`, sorted by additive keys."""

    def __init__(self, seeds: int, degree: int) -> None:
        self.seeds, self.degree = seeds, degree
        base = 4 * degree + 1
        wide = base ** (2 * seeds) * (degree + 1) >= 2**62
        weights = [base**i for i in reversed(range(2 * seeds))]
        self._weights = np.array(weights, dtype=object if wide else np.int64)
        self.exponents: list[Ints] = []
        self._keys: list[Keys] = []
        for d in range(degree + 1):
            rows = compositions(d, 2 * seeds)
            keys = self.keys(rows)
            order = np.argsort(keys, kind="stable")
            self.exponents.append(rows[order])
            self._keys.append(keys[order])
        self.counts = np.array([len(rows) for rows in self.exponents], dtype=np.int64)
        self.first_canonical = np.array([np.searchsorted(k, 0) for k in self._keys], dtype=np.int64)

    def keys(self, exponents: Ints) -> Keys:
        """Integers that add when monomials multiply, sort by (nu, p + n), and are negative just
        for nu < 0.
        """
        p, n = exponents[..., 0::2], exponents[..., 1::2]
        return np.asarray(np.concatenate([p - n, p + n], axis=-1) @ self._weights)

    def ranks(self, degree: int, keys: Keys) -> Ints:
        """Places of the monomials with these keys among those of `degree`."""
        return np.searchsorted(self._keys[degree], keys)

    def products(self, left: int, right: int) -> Ints:
        """Ranks of all products of a monomial of degree `left` with one of degree `right`.

        Shape (left, right).
        """
        return self.ranks(left + right, self._keys[left][:, None] + self._keys[right][None, :])

    def conjugates(self, degree: int) -> Ints:
        """Rank of the conjugate of each monomial of `degree`."""
        rows = self.exponents[degree]
        swapped = rows.reshape(len(rows), self.seeds, 2)[:, :, ::-1].reshape(rows.shape)
        return self.ranks(degree, self.keys(swapped))


class ProductTables(NamedTuple):
    """Plain arrays for the compiled product.

    X numbers the outer monomials of all degrees, sorted by degree.
    """

    outer_degree: Ints  # (X,)
    # (X, degree + 2): where the factor pairs with a left factor of that degree begin
    pair_start: Ints
    pair_left: NDArray[np.int32]  # outer monomials l, r with l r = X, sorted by l within X
    pair_right: NDArray[np.int32]
    block: Ints  # (degree + 1, X): first row of the block, over all degrees
    inner_count: Ints  # (degree + 1,)
    inner_start: Ints  # (X,) 1 where X is its own conjugate: only canonical inner rows are wanted
    first_canonical: Ints  # (degree + 1,)
    inner_table: NDArray[np.int32]  # flat: rank of the product of inner monomials
    table_offset: Ints  # (degree + 1, degree + 1)
    table_stride: Ints  # (degree + 1, degree + 1)


@dataclass(frozen=True, eq=False)
class Grading:
    """All monomials in z_i, conj z_i of `seeds` seeds up to `degree`, as rows of one long list.

    Rows of degree d are first_row[d] ... first_row[d + 1] - 1. Example:

    >>> g = Grading(seeds=1, degree=3)
    >>> g.exponents(3).tolist()
    [[0, 3], [1, 2], [2, 1], [3, 0]]
    >>> g.canonical(3).tolist()
    [2, 3]
    """

    seeds: int
    degree: int

    @cached_property
    def inner(self) -> Group:
        return Group((self.seeds + 1) // 2, self.degree)

    @cached_property
    def outer(self) -> Group:
        return Group(self.seeds // 2, self.degree)

    @cached_property
    def _outer_first(self) -> Ints:
        return np.concatenate([[0], np.cumsum(self.outer.counts)])

    @cached_property
    def _outer_sign(self) -> Ints:
        """-1, 0 or 1 for each outer monomial: below, at or above harmonic zero."""
        signs = []
        for rows in self.outer.exponents:
            nu = rows[:, 0::2] - rows[:, 1::2]
            lead = np.array([next((n for n in row if n), 0) for row in nu], dtype=np.int64)
            signs.append(np.sign(lead))
        return np.concatenate(signs)

    @cached_property
    def first_row(self) -> Ints:
        """First row of each degree; one more entry for the end. Shape (degree + 2,)."""
        sizes = [monomial_count(self.seeds, d) for d in range(self.degree + 1)]
        return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)

    def exponents(self, degree: int) -> Ints:
        """Exponents (p_1, n_1, ..., p_s, n_s) of every monomial of `degree`, in row order.

        Shape (count, 2 seeds).
        """
        return self._layout[degree][0]

    def canonical(self, degree: int) -> Ints:
        """Rows (counted from first_row[degree]) of the canonical monomials."""
        return self._layout[degree][1]

    def conjugate(self, degree: int) -> Ints:
        """For each canonical monomial, the row of its conjugate (counted from first_row[degree])."""
        return self._layout[degree][2]

    def powers(self, degree: int) -> Ints:
        """p + n of the canonical monomials; shape (canonical, seeds)."""
        rows = self.exponents(degree)[self.canonical(degree)]
        return np.asarray(rows[:, 0::2] + rows[:, 1::2])

    def harmonics(self, degree: int) -> tuple[Ints, Ints]:
        """The distinct harmonics nu of the canonical monomials, and which of them each monomial
        has.
        """
        return self._harmonics[degree]

    def diagonal(self, degree: int) -> Ints:
        """Exponents e of the monomials |z|^(2e) of an even `degree`.

        Shape (count, seeds). Empty where odd.
        """
        if degree % 2:
            return np.zeros((0, self.seeds), dtype=np.int64)
        return compositions(degree // 2, self.seeds)

    def rows(self, exponents: Ints) -> Ints:
        """Rows (counted from the first of their degree) of monomials of one common degree.

        Shape (count,).
        """
        if len(exponents) == 0:
            return np.zeros(0, dtype=np.int64)
        split = 2 * self.outer.seeds
        degree = int(exponents[0].sum())
        outer, inner = exponents[:, :split], exponents[:, split:]
        result = np.empty(len(exponents), dtype=np.int64)
        outer_degrees = outer.sum(axis=1)
        for x in np.unique(outer_degrees):
            at = np.flatnonzero(outer_degrees == x)
            block = self._outer_first[x] + self.outer.ranks(x, self.outer.keys(outer[at]))
            place = self.inner.ranks(degree - x, self.inner.keys(inner[at]))
            result[at] = self.tables.block[degree, block] + place - self.first_row[degree]
        return result

    @cached_property
    def _layout(self) -> list[tuple[Ints, Ints, Ints]]:
        layout = []
        for d in range(self.degree + 1):
            rows = np.concatenate(
                [
                    np.hstack([np.tile(o, (len(i), 1)), i])
                    for x in range(d + 1)
                    for i in [self.inner.exponents[d - x]]
                    for o in self.outer.exponents[x]
                ]
            )
            nu = rows[:, 0::2] - rows[:, 1::2]
            lead = nu[np.arange(len(nu)), np.argmax(nu != 0, axis=1)]
            canonical = np.flatnonzero(lead >= 0)
            swapped = (
                rows[canonical].reshape(-1, self.seeds, 2)[:, :, ::-1].reshape(-1, 2 * self.seeds)
            )
            layout.append((rows, canonical, self.rows(swapped)))
        return layout

    def harmonic_keys(self, harmonics: Ints) -> Keys:
        """A number for each harmonic (count, s), the same for no two, in lexicographic order."""
        return np.asarray(harmonics @ self._harmonic_weights)

    @cached_property
    def _harmonic_weights(self) -> Keys:
        base = 2 * self.degree + 1
        weights = [base**i for i in reversed(range(self.seeds))]
        return np.array(weights, dtype=object if base**self.seeds >= 2**62 else np.int64)

    @cached_property
    def _harmonics(self) -> list[tuple[Ints, Ints]]:
        result = []
        for d in range(self.degree + 1):
            rows = self.exponents(d)[self.canonical(d)]
            nu = rows[:, 0::2] - rows[:, 1::2]
            _, first, index = np.unique(
                self.harmonic_keys(nu), return_index=True, return_inverse=True
            )
            result.append((nu[first], index.reshape(-1)))
        return result

    @cached_property
    def tables(self) -> ProductTables:
        """The tables that the compiled product runs on."""
        pair_start, left, right = self._outer_pairs()
        flat, offset, stride = self._inner_table()
        return ProductTables(
            outer_degree=self._outer_degree,
            pair_start=pair_start,
            pair_left=left,
            pair_right=right,
            block=self._blocks(),
            inner_count=self.inner.counts,
            inner_start=(self._outer_sign == 0).astype(np.int64),
            first_canonical=self.inner.first_canonical,
            inner_table=flat,
            table_offset=offset,
            table_stride=stride,
        )

    @cached_property
    def _outer_degree(self) -> Ints:
        return np.repeat(np.arange(self.degree + 1), self.outer.counts)

    def wanted_blocks(self, degree: int) -> Ints:
        """Outer monomials whose blocks hold canonical rows of `degree`."""
        return np.flatnonzero((self._outer_sign >= 0) & (self._outer_degree <= degree))

    def _blocks(self) -> Ints:
        sizes = np.where(
            self._outer_degree[None, :] <= np.arange(self.degree + 1)[:, None],
            self.inner.counts[
                np.maximum(np.arange(self.degree + 1)[:, None] - self._outer_degree[None, :], 0)
            ],
            0,
        )
        return (np.cumsum(sizes.ravel()) - sizes.ravel()).reshape(sizes.shape).astype(np.int64)

    def _outer_pairs(self) -> tuple[Ints, NDArray[np.int32], NDArray[np.int32]]:
        lefts, rights, products = [], [], []
        for x in range(self.degree + 1):
            for y in range(self.degree + 1 - x):
                if self.outer.counts[x] == 0 or self.outer.counts[y] == 0:
                    continue
                table = self.outer.products(x, y) + self._outer_first[x + y]
                l, r = np.indices(table.shape)
                lefts.append(l.ravel() + self._outer_first[x])
                rights.append(r.ravel() + self._outer_first[y])
                products.append(table.ravel())
        left, right, product = (np.concatenate(a) for a in (lefts, rights, products))
        order = np.lexsort((left, product))
        left, right, product = left[order], right[order], product[order]
        top = self.degree + 2
        key = product * top + self._outer_degree[left]
        wanted = np.arange(len(self._outer_degree))[:, None] * top + np.arange(top)[None, :]
        return np.searchsorted(key, wanted), left.astype(np.int32), right.astype(np.int32)

    def _inner_table(self) -> tuple[NDArray[np.int32], Ints, Ints]:
        size = self.degree + 1
        if self.inner.seeds == 1:  # ranks are the powers of z, and add
            one, zero = (
                np.ones((size, size), dtype=np.int64),
                np.zeros((size, size), dtype=np.int64),
            )
            return np.arange(size, dtype=np.int32), zero, one
        offset, stride = np.zeros((2, size, size), dtype=np.int64)
        parts: list[NDArray[np.int32]] = []
        position = 0
        for x in range(size):
            for y in range(size - x):
                table = self.inner.products(x, y).astype(np.int32)
                offset[x, y], stride[x, y] = position, table.shape[1]
                position += table.size
                parts.append(table.ravel())
        return np.concatenate(parts), offset, stride
