"""The monomials of one degree in z_1, conj z_1, ..., z_s, conj z_s.

Their order, their ranks and the tables of their products.

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
    """Number of monomials of one degree in z and conj z of each seed."""
    variables = 2 * seeds
    return comb(degree + variables - 1, variables - 1)


def canonical_count(seeds: int, degree: int) -> int:
    """Number of canonical monomials (harmonic zero or lexicographically positive) of one degree."""
    whole = monomial_count(seeds, degree)
    half, odd = divmod(degree, 2)
    own = 0 if odd else comb(half + seeds - 1, seeds - 1)  # equal to their conjugates
    return (whole + own) // 2


def compositions(total: int, parts: int) -> Ints:
    """All rows of `parts` non-negative integers with sum `total`; shape (count, parts)."""
    if parts <= 1:
        count = int(parts == 1 or total == 0)
        return np.full((count, parts), total, dtype=np.int64)
    places = total + parts - 1
    chosen = list(combinations(range(places), parts - 1))
    bars = np.array(chosen, dtype=np.int64).reshape(-1, parts - 1)
    ends = (-1, places)
    edges = np.pad(bars, ((0, 0), (1, 1)), constant_values=((0, 0), ends))
    gaps = np.diff(edges, axis=1)
    return np.asarray(gaps - 1)


class HarmonicRows:
    """A row for each harmonic, as they come: the same one whenever it is asked for again."""

    def __init__(self) -> None:
        self._rows: dict[bytes, int] = {}

    def __len__(self) -> int:
        return len(self._rows)

    def of(self, harmonics: Ints) -> Ints:
        """The rows of harmonics (count, s), each of which is there once."""
        rows, whole = self._rows, np.ascontiguousarray(harmonics)
        names = whole.view(f"V{whole.itemsize * whole.shape[1]}").ravel().tolist()
        fresh = [name for name in names if name not in rows]
        rows.update(zip(fresh, range(len(rows), len(rows) + len(fresh)), strict=True))
        return np.array([rows[name] for name in names], dtype=np.int64)


def extended(table: NDArray[Any], rows: int, empty: Any) -> NDArray[Any]:
    """A table of at least so many rows; what is new is empty."""
    more = max(0, rows - len(table))
    new = np.full((more, *table.shape[1:]), empty, dtype=table.dtype)
    return np.concatenate([table, new]) if more else table


class Group:
    """The monomials of some seeds, for every degree up to `degree`, sorted by additive keys."""

    def __init__(self, seeds: int, degree: int, *, phantom: bool = False) -> None:
        self.seeds, self.degree = seeds, degree
        base, variables = 4 * degree + 1, 2 * seeds
        largest = base**variables * (degree + 1)
        kind = object if largest >= 2**62 else np.int64
        weights = [base**i for i in reversed(range(variables))]
        self._weights = np.array(weights, dtype=kind)
        self.exponents: list[Ints] = []
        self._keys: list[Keys] = []
        for d in range(degree + 1):
            rows = compositions(d, 2 * seeds)
            if phantom:
                rows = rows[rows[:, :2].sum(axis=1) <= 1]
            keys = self.keys(rows)
            order = np.argsort(keys, kind="stable")
            self.exponents.append(rows[order])
            self._keys.append(keys[order])
        counts = [len(rows) for rows in self.exponents]
        first = [np.searchsorted(keys, 0) for keys in self._keys]
        self.counts = np.array(counts, dtype=np.int64)
        self.first_canonical = np.array(first, dtype=np.int64)

    def keys(self, exponents: Ints) -> Keys:
        """Integers that add when monomials multiply and sort by (nu, p + n).

        They are negative just for nu < 0.
        """
        p, n = exponents[..., 0::2], exponents[..., 1::2]
        digits = np.concatenate([p - n, p + n], axis=-1)
        return np.asarray(digits @ self._weights)

    def ranks(self, degree: int, keys: Keys) -> Ints:
        """Places of the monomials with these keys among those of `degree`."""
        return np.searchsorted(self._keys[degree], keys)

    def products(self, left: int, right: int) -> Ints:
        """Ranks of all products of a monomial of degree `left` with one of degree `right`.

        Shape (left, right).
        """
        first, second = self._keys[left], self._keys[right]
        keys = first[:, None] + second[None, :]
        return self.ranks(left + right, keys)

    def kept_products(self, left: int, right: int) -> NDArray[np.bool_]:
        """Whether they are monomials of this group; shape (left, right)."""
        keys = self._keys[left][:, None] + self._keys[right][None, :]
        return np.isin(keys, self._keys[left + right])

    def conjugates(self, degree: int) -> Ints:
        """Rank of the conjugate of each monomial of `degree`."""
        swapped = exchanged(self.exponents[degree])
        keys = self.keys(swapped)
        return self.ranks(degree, keys)


def exchanged(exponents: Ints) -> Ints:
    """Exponents (count, 2 seeds) with those of z and conj z exchanged."""
    pairs = exponents.reshape(len(exponents), exponents.shape[1] // 2, 2)
    return pairs[:, :, ::-1].reshape(exponents.shape)


def _self_conjugate(exponents: Ints) -> NDArray[np.bool_]:
    """Which rows of exponents (count, 2 seeds) are those of monomials |z|^(2e)."""
    return np.asarray((harmonic_of(exponents) == 0).all(axis=1))


def harmonic_of(exponents: Ints) -> Ints:
    """nu = p - n of rows of exponents; shape (count, seeds)."""
    return np.asarray(exponents[:, 0::2] - exponents[:, 1::2])


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
    inner_start: (
        Ints  # (X,) 1 where X is its own conjugate: only canonical inner rows are wanted
    )
    first_canonical: Ints  # (degree + 1,)
    inner_table: NDArray[np.int32]  # flat: rank of the product of inner monomials
    table_offset: Ints  # (degree + 1, degree + 1)
    table_stride: Ints  # (degree + 1, degree + 1)


class DiagonalTables(NamedTuple):
    """The monomials |z|^(2e) as factors, for the compiled product with a series of them.

    pair_start : (X + 1,), where the factor pairs of an outer monomial begin. pair_left,
    pair_right : outer monomials, the left one such a monomial. inner_start : (degree + 2,), where
    the inner ones of a degree begin. inner_rank : their ranks.
    """

    pair_start: Ints
    pair_left: NDArray[np.int32]
    pair_right: NDArray[np.int32]
    inner_start: Ints
    inner_rank: Ints


@dataclass(frozen=True, eq=False)
class Grading:
    """All monomials in z_i, conj z_i of `seeds` seeds up to `degree`, as rows of one long list.

    Rows of degree d are first_row[d] ... first_row[d + 1] - 1. phantom : only those of degree 0
    and 1 in the first of two or more seeds; products are cut off there. Example:

    >>> g = Grading(seeds=1, degree=3)
    >>> g.exponents(3).tolist()
    [[0, 3], [1, 2], [2, 1], [3, 0]]
    >>> g.canonical(3).tolist()
    [2, 3]
    """

    seeds: int
    degree: int
    phantom: bool = False

    @cached_property
    def inner(self) -> Group:
        return Group((self.seeds + 1) // 2, self.degree)

    @cached_property
    def outer(self) -> Group:
        return Group(self.seeds // 2, self.degree, phantom=self.phantom)

    @cached_property
    def _outer_first(self) -> Ints:
        return np.concatenate([[0], np.cumsum(self.outer.counts)])

    @cached_property
    def _outer_sign(self) -> Ints:
        """-1, 0 or 1 for each outer monomial: below, at or above harmonic zero."""
        signs = []
        for rows in self.outer.exponents:
            nu = harmonic_of(rows)
            leads = [next((n for n in row if n), 0) for row in nu]
            lead = np.array(leads, dtype=np.int64)
            signs.append(np.sign(lead))
        return np.concatenate(signs)

    @cached_property
    def first_row(self) -> Ints:
        """First row of each degree; one more entry for the end. Shape (degree + 2,)."""
        sizes = np.convolve(self.outer.counts, self.inner.counts)[: self.degree + 1]
        ends = np.cumsum(sizes)
        return np.concatenate([[0], ends]).astype(np.int64)

    def exponents(self, degree: int) -> Ints:
        """Exponents (p_1, n_1, ..., p_s, n_s) of every monomial of `degree`, in row order.

        Shape (count, 2 seeds).
        """
        return self._layout[degree][0]

    def canonical(self, degree: int) -> Ints:
        """Rows (counted from first_row[degree]) of the canonical monomials."""
        return self._layout[degree][1]

    def conjugate(self, degree: int) -> Ints:
        """For each canonical monomial the row of its conjugate, from first_row[degree] on."""
        return self._layout[degree][2]

    def powers(self, degree: int) -> Ints:
        """p + n of the canonical monomials; shape (canonical, seeds)."""
        rows = self.exponents(degree)[self.canonical(degree)]
        return np.asarray(rows[:, 0::2] + rows[:, 1::2])

    def harmonics(self, degree: int) -> tuple[Ints, Ints]:
        """The distinct harmonics nu of the canonical monomials, and which of them each one has."""
        return self._harmonics[degree]

    def diagonal(self, degree: int) -> Ints:
        """Exponents e of the monomials |z|^(2e) of an even `degree`.

        Shape (count, seeds). Empty where odd.
        """
        if degree % 2:
            return np.zeros((0, self.seeds), dtype=np.int64)
        if degree not in self._diagonals:
            exponents = compositions(degree // 2, self.seeds)
            kept = exponents[exponents[:, 0] == 0] if self.phantom else exponents
            self._diagonals[degree] = kept
        return self._diagonals[degree]

    @cached_property
    def _diagonals(self) -> dict[int, Ints]:
        """Those that were asked for: root finding asks for each some dozens of times."""
        return {}

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
        first_rows = self.tables.block[degree] - self.first_row[degree]
        for x in np.unique(outer_degrees):
            at = np.flatnonzero(outer_degrees == x)
            outer_keys, inner_keys = self.outer.keys(outer[at]), self.inner.keys(inner[at])
            block = self._outer_first[x] + self.outer.ranks(x, outer_keys)
            place = self.inner.ranks(degree - x, inner_keys)
            result[at] = first_rows[block] + place
        return result

    def kept(self, exponents: Ints) -> NDArray[np.bool_]:
        """Whether these are monomials of this grading; shape (count,)."""
        if not self.phantom:
            return np.ones(len(exponents), dtype=np.bool_)
        return np.asarray(exponents[:, :2].sum(axis=1) <= 1)

    @cached_property
    def _layout(self) -> list[tuple[Ints, Ints, Ints]]:
        """Exponents, canonical rows and the rows of their conjugates, by degree."""
        layout = []
        for d in range(self.degree + 1):
            rows = self._rows_of_degree(d)
            nu = harmonic_of(rows)
            first_nonzero = np.argmax(nu != 0, axis=1)
            lead = nu[np.arange(len(nu)), first_nonzero]
            canonical = np.flatnonzero(lead >= 0)
            conjugates = self.rows(exchanged(rows[canonical]))
            layout.append((rows, canonical, conjugates))
        return layout

    def _rows_of_degree(self, degree: int) -> Ints:
        """Exponents of all monomials, block after block."""
        blocks = []
        for x in range(degree + 1):
            inner = self.inner.exponents[degree - x]
            for outer in self.outer.exponents[x]:
                repeated = np.tile(outer, (len(inner), 1))
                blocks.append(np.hstack([repeated, inner]))
        return np.concatenate(blocks)

    def harmonic_keys(self, harmonics: Ints) -> Keys:
        """A number for each harmonic (count, s), the same for no two, in lexicographic order."""
        return np.asarray(harmonics @ self._harmonic_weights)

    @cached_property
    def _harmonic_weights(self) -> Keys:
        base = 2 * self.degree + 1
        weights = [base**i for i in reversed(range(self.seeds))]
        kind = object if base**self.seeds >= 2**62 else np.int64
        return np.array(weights, dtype=kind)

    @cached_property
    def _harmonics(self) -> list[tuple[Ints, Ints]]:
        result = []
        for d in range(self.degree + 1):
            rows = self.exponents(d)[self.canonical(d)]
            nu = harmonic_of(rows)
            keys = self.harmonic_keys(nu)
            _, first, index = np.unique(keys, return_index=True, return_inverse=True)
            result.append((nu[first], index.reshape(-1)))
        return result

    @cached_property
    def tables(self) -> ProductTables:
        """The tables that the compiled product runs on."""
        pair_start, left, right = self._outer_pairs()
        flat, offset, stride = self._inner_table()
        own_conjugate = self._outer_sign == 0
        return ProductTables(
            outer_degree=self._outer_degree,
            pair_start=pair_start,
            pair_left=left,
            pair_right=right,
            block=self._blocks(),
            inner_count=self.inner.counts,
            inner_start=own_conjugate.astype(np.int64),
            first_canonical=self.inner.first_canonical,
            inner_table=flat,
            table_offset=offset,
            table_stride=stride,
        )

    @cached_property
    def diagonal_tables(self) -> DiagonalTables:
        """The tables of products whose left factors are monomials |z|^(2e)."""
        tables = self.tables
        outer = np.concatenate([_self_conjugate(rows) for rows in self.outer.exponents])
        pairs = np.flatnonzero(outer[tables.pair_left])
        ranks = [np.flatnonzero(_self_conjugate(rows)) for rows in self.inner.exponents]
        begin = np.append(tables.pair_start[:, 0], len(tables.pair_left))
        return DiagonalTables(
            pair_start=np.searchsorted(pairs, begin),
            pair_left=tables.pair_left[pairs],
            pair_right=tables.pair_right[pairs],
            inner_start=np.cumsum([0, *(len(r) for r in ranks)]),
            inner_rank=np.concatenate(ranks),
        )

    @cached_property
    def _outer_degree(self) -> Ints:
        return np.repeat(np.arange(self.degree + 1), self.outer.counts)

    def wanted_blocks(self, degree: int) -> Ints:
        """Outer monomials whose blocks hold canonical rows of `degree`."""
        canonical = self._outer_sign >= 0
        divides = self._outer_degree <= degree
        return np.flatnonzero(canonical & divides)

    def _blocks(self) -> Ints:
        """The first row of the block of each outer monomial, by degree."""
        degrees = np.arange(self.degree + 1)
        left_over = degrees[:, None] - self._outer_degree[None, :]
        counts = self.inner.counts[np.maximum(left_over, 0)]
        sizes = np.where(left_over >= 0, counts, 0)
        flat = sizes.ravel()
        before = np.cumsum(flat) - flat
        return before.reshape(sizes.shape).astype(np.int64)

    def _outer_pairs(self) -> tuple[Ints, NDArray[np.int32], NDArray[np.int32]]:
        """Where the factor pairs of each outer monomial begin, and the pairs, sorted by product."""
        left, right, product = self._all_outer_pairs()
        order = np.lexsort((left, product))
        left, right, product = left[order], right[order], product[order]
        top = self.degree + 2
        key = product * top + self._outer_degree[left]
        monomials = np.arange(len(self._outer_degree))
        wanted = monomials[:, None] * top + np.arange(top)[None, :]
        start = np.searchsorted(key, wanted)
        return start, left.astype(np.int32), right.astype(np.int32)

    def _all_outer_pairs(self) -> tuple[Ints, Ints, Ints]:
        """Left factor, right factor and product of every pair of outer monomials."""
        lefts, rights, products = [], [], []
        counts, first = self.outer.counts, self._outer_first
        for x in range(self.degree + 1):
            for y in range(self.degree + 1 - x):
                if counts[x] == 0 or counts[y] == 0:
                    continue
                table, kept = self.outer.products(x, y), self.outer.kept_products(x, y)
                l, r = np.nonzero(kept)
                lefts.append(l + first[x])
                rights.append(r + first[y])
                products.append(table[kept] + first[x + y])
        return np.concatenate(lefts), np.concatenate(rights), np.concatenate(products)

    def _inner_table(self) -> tuple[NDArray[np.int32], Ints, Ints]:
        size = self.degree + 1
        if self.inner.seeds == 1:  # ranks are the powers of z, and add
            one = np.ones((size, size), dtype=np.int64)
            ranks = np.arange(size, dtype=np.int32)
            return ranks, np.zeros_like(one), one
        offset, stride = np.zeros((2, size, size), dtype=np.int64)
        parts: list[NDArray[np.int32]] = []
        position = 0
        for x in range(size):
            for y in range(size - x):
                table = self.inner.products(x, y).astype(np.int32)
                offset[x, y] = position
                stride[x, y] = table.shape[1]
                position += table.size
                parts.append(table.ravel())
        return np.concatenate(parts), offset, stride
