"""The universal ring: coefficients as nodes of one shared program over the symbols L_q(nu).

Products are those of cosines, 2 T_l T_m = T_(l+m) + T_(l-m) with T_N = 0 and T_(2N-q) = -T_q, so
that every factor is an integer. Nothing is expanded.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
import psutil
from numpy.typing import NDArray

from symfpu.algebra.expansion import Expansion
from symfpu.algebra.formulas import Coupling, Multiplier, NodeTable
from symfpu.algebra.grading import monomial_count
from symfpu.algebra.program import ONE, ZERO, Ints, Program, Terms
from symfpu.algebra.selection import CosineModes
from symfpu.errors import TooLarge

TERM_BYTES = (
    400  # of a pair of cosines while its two terms are sorted and collected, at most
)


STORED_BYTES, SORTED_BYTES = 20, 100  # of a pair of cosines, fitted to what programs take


def predicted_bytes(N: int, seeds: int, top: int, step: int, highest: int) -> int:
    """Memory of a program up to degree `top`, by the pairs of cosines that it multiplies.

    step : from one degree of the series to the next. highest : power of the force. A monomial of
    degree d is taken to carry as many modes as it has signed sums, at most half of all. Nothing is
    allocated but vectors of degrees; between one and six times what was measured.
    """
    degrees = np.arange(top + 1)
    monomials = np.array([float(monomial_count(seeds, d)) for d in degrees.tolist()])
    carried = np.minimum(N // 2 + 1, (degrees / seeds + 1.0) ** seeds)
    sizes = monomials * carried
    series = np.where((degrees % step == 1 % step) & (degrees > 0), sizes, 0.0)
    pairs = np.convolve(series, series)[: top + 1] / 4  # canonical products, each pair once
    added = pairs
    for _ in range(2, highest):
        lower = np.where(added > 0, sizes, 0.0)
        added = np.convolve(lower, series)[: top + 1] / 2
        pairs = pairs + added
    return int(STORED_BYTES * pairs.sum() + SORTED_BYTES * pairs.max())


class _Cosines(NamedTuple):
    """Cosines that are not zero in all monomials of a degree, conjugates too.

    start : (monomials + 1,), where those of a monomial begin. mode, node : wave numbers 0 .. N-1
    and coefficients.
    """

    start: Ints
    mode: Ints
    node: Ints


class _Product(NamedTuple):
    """A product f o g: pairs of monomials a, b with a canonical product, its row in the table,
    how many pairs of cosines each has, and the factor of all.
    """

    f: _Cosines
    g: _Cosines
    a: Ints
    b: Ints
    row: Ints
    counts: Ints
    weight: int


class ProgramRing:
    """Coefficients as nodes of `program`; ZERO is the zero of a table.

    expanded : how they are read: as expanded polynomials, and then every zero is decided exactly;
    or as the recursion has them, and zeros that residues show are believed. guessed : how many
    were.
    """

    grows = False

    def __init__(self, space: CosineModes, *, expanded: bool) -> None:
        self.name = "symbolic" if expanded else "nested"
        self.space, self.grading, self.expanded = space, space.grading, expanded
        self.program, self.guessed = Program(), 0
        self._couplings: dict[int, int] = {}
        self._modes: dict[int, Ints] = {}
        self._cosines: dict[int, _Cosines] = {}
        # powers of the bonds, by degree
        self._powers: dict[int, dict[int, _Cosines]] = {}
        self._corrections: dict[int, Ints] = {}

    @property
    def multiply_adds(self) -> int:
        """Terms of the program."""
        return len(self.program.terms.left)

    def _sums(self, count: int, out: Ints, terms: Terms) -> Ints:
        """The nodes of `count` sums; ZERO where a polynomial vanishes identically."""
        nodes = self.program.sums(count, out, terms)
        suspects = np.flatnonzero(self.program.vanishing(nodes))
        if self.expanded and len(suspects):
            expansion = Expansion(self.program, nodes[suspects])
            zero = [expansion.is_zero(node) for node in nodes[suspects].tolist()]
            suspects = suspects[zero]
        else:
            self.guessed += len(suspects)
        nodes[suspects] = ZERO
        return nodes

    def coupling(self, power: int, value: Fraction) -> int:
        """The first coupling, in whose units all are, is one."""
        if not self._couplings and value == 1:
            self._couplings[power] = ONE
        known = self._couplings.get(power)
        return self.program.leaf(Coupling(power, value)) if known is None else known

    def seed_terms(self) -> Ints:
        powers = self.grading.powers(1)
        modes = np.full((len(powers), self.space.N - 1), ZERO, dtype=np.int64)
        for row, power in enumerate(powers):
            modes[row, self.space.seeds[int(np.argmax(power))] - 1] = ONE
        return modes

    def put(self, degree: int, modes: Ints) -> None:
        self._modes[degree] = modes
        constant = np.full((len(modes), 1), ZERO, dtype=np.int64)
        self._cosines[degree] = self._of_all(degree, np.hstack([constant, modes]))

    def _of_all(self, degree: int, table: Ints) -> _Cosines:
        """Of canonical monomials, (canonical, N), and of their conjugates."""
        count = len(self.grading.exponents(degree))
        whole = np.full((count, self.space.N), ZERO, dtype=np.int64)
        whole[self.grading.canonical(degree)] = table
        whole[self.grading.conjugate(degree)] = table
        row, mode = np.nonzero(whole != ZERO)
        start = np.searchsorted(row, np.arange(count + 1))
        return _Cosines(start, mode, whole[row, mode])

    def power(self, power: int, degree: int) -> Ints:
        """Nodes of the canonical monomials, (canonical, N): wave numbers 0 .. N-1.

        Raises TooLarge before the terms of the products are made.
        """
        lower = self._cosines if power == 2 else self._lower(power - 1, degree)
        products = []
        for d in sorted(lower):
            e = degree - d
            if e in self._cosines and (power > 2 or d <= e):
                weight = 1 if power > 2 or d == e else 2
                products.append(self._product(lower[d], self._cosines[e], d, e, weight))
        self._require_room(degree, products)
        shape = len(self.grading.canonical(degree)), self.space.N
        if not products:
            return np.full(shape, ZERO, dtype=np.int64)
        parts = [self._terms(product) for product in products]
        out, left, right, factor = map(np.concatenate, zip(*parts, strict=True))
        nodes = self._sums(shape[0] * shape[1], out, Terms(left, right, factor))
        return nodes.reshape(shape)

    def _require_room(self, degree: int, products: list[_Product]) -> None:
        needed = TERM_BYTES * sum(int(product.counts.sum()) for product in products)
        free = psutil.virtual_memory().available
        if needed > free:
            step = (self.space.product_degree or 2) - 1
            order = (degree - 1) // step
            raise TooLarge(order, needed, free, order - 1)

    def _lower(self, power: int, degree: int) -> dict[int, _Cosines]:
        known = self._powers.setdefault(power, {})
        for d in range(power, degree):
            if d not in known:
                known[d] = self._of_all(d, self.power(power, d))
        return known

    def _product(self, f: _Cosines, g: _Cosines, d: int, e: int, weight: int) -> _Product:
        a, b, row = self._monomial_pairs(d, e)
        counts = np.diff(f.start)[a] * np.diff(g.start)[b]
        return _Product(f, g, a, b, row, counts, weight)

    def _terms(self, product: _Product) -> tuple[Ints, Ints, Ints, Ints]:
        """Terms of f o g in the canonical monomials: place in the table, left, right, factor."""
        f, g, a, b, row, counts, weight = product
        per_right = np.diff(g.start)[b]
        pair = np.repeat(np.arange(len(a)), counts)
        within = np.arange(len(pair)) - np.repeat(np.cumsum(counts) - counts, counts)
        i = f.start[a][pair] + within // per_right[pair]
        j = g.start[b][pair] + within % per_right[pair]
        l, m = f.mode[i], g.mode[j]
        sums, differences = l + m, np.abs(l - m)
        N = self.space.N
        there = sums != N
        folded = np.where(sums > N, 2 * N - sums, sums)
        sign = np.where(sums > N, -weight, weight)
        place = row[pair] * N
        out = np.concatenate([(place + folded)[there], place + differences])
        left = np.concatenate([f.node[i][there], f.node[i]])
        right = np.concatenate([g.node[j][there], g.node[j]])
        factor = np.concatenate([sign[there], np.full(len(pair), weight)])
        return out, left, right, factor

    def _monomial_pairs(self, d: int, e: int) -> tuple[Ints, Ints, Ints]:
        """Pairs of monomials of two degrees with a canonical product, and its canonical row."""
        left, right = self.grading.exponents(d), self.grading.exponents(e)
        a, b = (part.ravel() for part in np.indices((len(left), len(right))))
        kept = self.grading.kept(left[a] + right[b])
        a, b = a[kept], b[kept]
        rows = self.grading.rows(left[a] + right[b])
        canonical = self.grading.canonical(d + e)
        place = np.searchsorted(canonical, rows)
        wanted = place < len(canonical)
        wanted[wanted] = canonical[place[wanted]] == rows[wanted]
        return a[wanted], b[wanted], place[wanted]

    def project(self, degree: int, parts: Sequence[tuple[int, Ints]]) -> Ints:
        mask = self.space.mask(degree)
        tables = [np.where(mask, bonds[:, 1:], ZERO) for _, bonds in parts]
        if not parts:
            return np.full(mask.shape, ZERO, dtype=np.int64)
        if len(parts) == 1 and parts[0][0] == ONE:
            return tables[0]
        out, left, right = [], [], []
        for (coupling, _), table in zip(parts, tables, strict=True):
            places = np.flatnonzero(table != ZERO)
            out.append(places)
            left.append(np.full(len(places), coupling))
            right.append(table.ravel()[places])
        factor = np.ones(sum(map(len, out)), dtype=np.int64)
        terms = Terms(np.concatenate(left), np.concatenate(right), factor)
        return self._sums(mask.size, np.concatenate(out), terms).reshape(mask.shape)

    def secular(self, degree: int, modes: Ints) -> Ints:
        diagonal = self.grading.diagonal(degree - 1)
        columns = []
        for i, q in enumerate(self.space.seeds):
            exponents = np.repeat(diagonal, 2, axis=1)
            exponents[:, 2 * i] += 1
            at = np.searchsorted(
                self.grading.canonical(degree), self.grading.rows(exponents)
            )
            columns.append(modes[at, q - 1])
        return np.stack(columns, axis=1)

    def correct(self, degree: int, corrections: Ints) -> None:
        self._corrections[degree] = corrections

    def corrected(self, degree: int) -> tuple[Ints, Terms]:
        """The terms W_q u_q, and the places in a table of seeds that they belong to."""
        seeds = np.array(self.space.seeds) - 1
        parts = []
        for n, corrections in self._corrections.items():
            if degree - n not in self._modes or not len(corrections):
                continue
            modes = self._modes[degree - n][:, seeds]
            rows = self._raised_rows(n, degree - n)
            places = rows[:, :, None] * len(seeds) + np.arange(len(seeds))
            left = np.broadcast_to(corrections[:, None, :], places.shape)
            right = np.broadcast_to(modes[None], places.shape)
            there = (left != ZERO) & (right != ZERO)
            parts.append((places[there], left[there], right[there]))
        empty = (np.zeros(0, dtype=np.int64),) * 3
        out, left, right = map(np.concatenate, zip(empty, *parts, strict=True))
        return out, Terms(left, right, np.ones(len(out), dtype=np.int64))

    def _raised_rows(self, n: int, degree: int) -> Ints:
        """Canonical rows of |z|^(2e) times each canonical monomial; (diagonal, canonical)."""
        diagonal = np.repeat(self.grading.diagonal(n), 2, axis=1)
        rows = self.grading.exponents(degree)[self.grading.canonical(degree)]
        products = (diagonal[:, None] + rows).reshape(-1, rows.shape[1])
        at = np.searchsorted(
            self.grading.canonical(n + degree), self.grading.rows(products)
        )
        return np.asarray(at.reshape(len(diagonal), len(rows)))

    def solve(
        self,
        degree: int,
        corrected: tuple[Ints, Terms],
        force: Ints,
        multipliers: NDArray[Any],
    ) -> Ints:
        symbols = self._multipliers(degree, multipliers)
        seeds = np.array(self.space.seeds) - 1
        bracket, sign = force.copy(), np.full(force.shape, -1)
        bracket[:, seeds] = self._brackets(corrected, force[:, seeds])
        sign[:, seeds] = 1
        places = np.flatnonzero((bracket != ZERO) & (symbols != ZERO))
        terms = Terms(
            symbols.ravel()[places], bracket.ravel()[places], sign.ravel()[places]
        )
        return self._sums(force.size, places, terms).reshape(force.shape)

    def _brackets(self, corrected: tuple[Ints, Terms], force: Ints) -> Ints:
        """Nodes of corrected - force of the seeds."""
        out, terms = corrected
        places = np.flatnonzero(force != ZERO)
        left = np.concatenate([terms.left, np.full(len(places), ONE)])
        right = np.concatenate([terms.right, force.ravel()[places]])
        factor = np.concatenate([terms.factor, np.full(len(places), -1)])
        every = np.concatenate([out, places])
        nodes = self._sums(force.size, every, Terms(left, right, factor))
        return nodes.reshape(force.shape)

    def _multipliers(self, degree: int, multipliers: NDArray[Any]) -> Ints:
        """Leaves L_q(nu) where there are multipliers; a row a monomial."""
        harmonics, index = self.grading.harmonics(degree)
        leaves = np.full(multipliers.shape, ZERO, dtype=np.int64)
        for row, column in np.argwhere(multipliers != 0):
            nu = tuple(map(int, harmonics[row]))
            leaves[row, column] = self.program.leaf(Multiplier(int(column) + 1, nu))
        return np.asarray(leaves[index])

    def results(self) -> tuple[list[NodeTable], list[NodeTable], Fraction]:
        modes = list(map(self._table, self._modes.values()))
        corrections = list(map(self._table, self._corrections.values()))
        return modes, corrections, Fraction(1)

    def _table(self, nodes: Ints) -> NodeTable:
        return NodeTable(self.program, nodes, expanded=self.expanded)
