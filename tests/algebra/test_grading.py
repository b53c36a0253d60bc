"""The monomials: their number, order, conjugates, ranks and product tables, against definitions and dictionaries."""

from collections import Counter
from itertools import product
from math import comb

import numpy as np
import pytest

from symfpu.algebra.grading import Grading, canonical_count, monomial_count

SMALL = [(1, 7), (2, 6), (3, 5), (4, 4), (5, 3)]
# Keys of the last two exceed 64 bits: 9^20 for the monomials of half of 20 seeds, 5^32 for the harmonics of 32.
WIDE = [(14, 3), (20, 2), (32, 2)]


def all_monomials(seeds, degree):
    """Every row of 2s exponents with this sum, by brute force."""
    return {row for row in product(range(degree + 1), repeat=2 * seeds) if sum(row) == degree}


def harmonic(row):
    return tuple(int(p - n) for p, n in zip(row[0::2], row[1::2], strict=True))


def conjugate(row):
    return tuple(int(row[i ^ 1]) for i in range(len(row)))


@pytest.mark.parametrize(("seeds", "degree"), [(1, 7), (2, 6), (3, 4), (4, 3), (5, 2)])
def test_every_monomial_stands_in_exactly_one_row(seeds, degree):
    grading = Grading(seeds, degree)
    for d in range(degree + 1):
        rows = [tuple(row) for row in grading.exponents(d).tolist()]
        assert len(set(rows)) == len(rows)
        assert set(rows) == all_monomials(seeds, d)


@pytest.mark.parametrize(("seeds", "degree"), SMALL + WIDE)
def test_counts_are_binomials(seeds, degree):
    grading = Grading(seeds, degree)
    for d in range(degree + 1):
        count = comb(d + 2 * seeds - 1, 2 * seeds - 1)
        assert count == monomial_count(seeds, d) == len(grading.exponents(d))
        assert canonical_count(seeds, d) == len(grading.canonical(d))
        assert grading.first_row[d + 1] - grading.first_row[d] == count
        assert len(np.unique(grading.exponents(d), axis=0)) == count


@pytest.mark.parametrize(("seeds", "degree"), SMALL + WIDE)
def test_canonical_rows_have_a_harmonic_from_zero_up(seeds, degree):
    grading = Grading(seeds, degree)
    for d in range(degree + 1):
        canonical = set(grading.canonical(d).tolist())
        for row, exponents in enumerate(grading.exponents(d)):
            assert (row in canonical) == (harmonic(exponents) >= (0,) * seeds)


@pytest.mark.parametrize(("seeds", "degree"), SMALL + WIDE)
def test_conjugates_are_the_other_half(seeds, degree):
    grading = Grading(seeds, degree)
    for d in range(degree + 1):
        rows = grading.exponents(d)
        canonical, conjugates = grading.canonical(d), grading.conjugate(d)
        assert [tuple(r) for r in rows[conjugates].tolist()] == [conjugate(r) for r in rows[canonical]]
        fixed = canonical == conjugates
        assert {tuple(r) for r in rows[canonical[fixed]].tolist()} == {conjugate(r) for r in rows[canonical[fixed]]}
        moved = set(conjugates[~fixed].tolist())
        # a harmonic of zero is conjugate to itself: all others lie outside the canonical half
        assert moved.isdisjoint(canonical.tolist())
        assert moved | set(canonical.tolist()) == set(range(len(rows)))


@pytest.mark.parametrize(("seeds", "degree"), SMALL + WIDE)
def test_rows_are_the_inverse_of_exponents(seeds, degree):
    grading = Grading(seeds, degree)
    rng = np.random.default_rng(seeds)
    for d in range(degree + 1):
        shuffled = rng.permutation(len(grading.exponents(d)))
        assert (grading.rows(grading.exponents(d)[shuffled]) == shuffled).all()
    assert len(grading.rows(np.zeros((0, 2 * seeds), dtype=np.int64))) == 0


@pytest.mark.parametrize(("seeds", "degree"), SMALL + WIDE)
def test_harmonics_are_distinct_and_indexed(seeds, degree):
    grading = Grading(seeds, degree)
    for d in range(degree + 1):
        nu, index = grading.harmonics(d)
        listed = [tuple(row) for row in nu.tolist()]
        assert len(set(listed)) == len(listed)
        rows = grading.exponents(d)[grading.canonical(d)]
        assert [listed[i] for i in index] == [harmonic(row) for row in rows]
        assert (grading.powers(d) == rows[:, 0::2] + rows[:, 1::2]).all()


@pytest.mark.parametrize(("seeds", "degree"), SMALL)
def test_diagonal_lists_the_moduli(seeds, degree):
    grading = Grading(seeds, degree)
    for d in range(degree + 1):
        zero = (0,) * seeds
        rows = grading.exponents(d)
        expected = {tuple(row[0::2].tolist()) for row in rows if tuple(row[0::2]) == tuple(row[1::2])}
        assert {tuple(e) for e in grading.diagonal(d).tolist()} == expected
        assert all(harmonic(np.repeat(e, 2)) == zero for e in grading.diagonal(d))


def table_products(grading, degree):
    """((left row, right row) -> row) of a degree as the product tables say, in the arithmetic of the kernel."""
    t = grading.tables
    for outer in range(len(t.outer_degree)):
        x = t.outer_degree[outer]
        for x1 in range(x + 1) if x <= degree else ():
            for pair in range(t.pair_start[outer, x1], t.pair_start[outer, x1 + 1]):
                l, r = t.pair_left[pair], t.pair_right[pair]
                for d in range(x1, degree - (x - x1) + 1):
                    y1, y2 = d - x1, degree - d - (x - x1)
                    for i, j in product(range(t.inner_count[y1]), range(t.inner_count[y2])):
                        place = t.inner_table[t.table_offset[y1, y2] + i * t.table_stride[y1, y2] + j]
                        yield t.block[d, l] + i, t.block[degree - d, r] + j, t.block[degree, outer] + place


@pytest.mark.parametrize(("seeds", "degree"), [(1, 6), (2, 5), (3, 4), (4, 3), (5, 2)])
def test_product_tables_are_the_products_of_monomials(seeds, degree):
    """Every pair of monomials whose degrees add to the given one stands in the tables once, with its product."""
    grading = Grading(seeds, degree)
    exponents = np.concatenate([grading.exponents(d) for d in range(degree + 1)])
    triples = np.array(list(table_products(grading, degree)))
    assert (exponents[triples[:, 0]] + exponents[triples[:, 1]] == exponents[triples[:, 2]]).all()
    pairs = {(int(l), int(r)) for l, r, _ in triples}
    assert len(pairs) == len(triples) == sum(monomial_count(seeds, d) * monomial_count(seeds, degree - d) for d in range(degree + 1))


@pytest.mark.parametrize(("seeds", "degree"), [*SMALL, (14, 2), (20, 2)])
def test_wanted_blocks_hold_all_canonical_rows(seeds, degree):
    grading = Grading(seeds, degree)
    t = grading.tables
    for d in range(degree + 1):
        held = Counter()
        for outer in grading.wanted_blocks(d):
            first = int(t.block[d, outer] - grading.first_row[d])
            count = int(t.inner_count[d - t.outer_degree[outer]])
            start = int(t.first_canonical[d - t.outer_degree[outer]]) if t.inner_start[outer] else 0
            held.update(range(first + start, first + count))
        assert held == Counter(grading.canonical(d).tolist())


@pytest.mark.parametrize(("seeds", "degree"), [(2, 6), (3, 5), (5, 3)])
def test_a_phantom_seed_keeps_what_is_linear_in_it(seeds, degree):
    """The monomials of a phantom grading are those with its power 0 or 1, and so are their products."""
    grading = Grading(seeds, degree, phantom=True)
    for d in range(degree + 1):
        wanted = {row for row in all_monomials(seeds, d) if sum(row[:2]) <= 1}
        rows = list(map(tuple, grading.exponents(d).tolist()))
        assert set(rows) == wanted
        assert len(rows) == len(wanted) == grading.first_row[d + 1] - grading.first_row[d]
        assert set(map(tuple, grading.diagonal(d).tolist())) == {
            row for row in map(tuple, Grading(seeds, degree).diagonal(d).tolist()) if not row[0]
        }
