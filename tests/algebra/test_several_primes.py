"""Sums that are reduced now and then are those modulo every prime, however many products they have."""

import numpy as np
import pytest

from symfpu.algebra import kernels
from symfpu.algebra.grading import Grading
from symfpu.algebra.several_primes import EXACT, largest_prime, products_between_reductions
from symfpu.algebra.words import ResidueBasis

WIDTH = 8


def factors(grading, basis):
    """The largest residues, of one sign: nothing cancels, so sums are as large as they can be."""
    lanes = np.resize(basis.moduli, WIDTH)
    rows = int(grading.first_row[-1])
    return np.floor(np.tile(lanes / 2, (rows, 1))).astype(np.float32), lanes


@pytest.mark.parametrize("degree", [1, 30, 251, 2000])
def test_as_many_products_as_said_are_exact(degree):
    p = largest_prime(degree)
    assert (p // 2 + 1) ** 2 * products_between_reductions(degree) <= EXACT


@pytest.mark.parametrize(("seeds", "top"), [(1, 301), (2, 25), (4, 7)])
@pytest.mark.parametrize("symmetric", [True, False])
def test_the_largest_sums_stay_exact(seeds, top, symmetric):
    grading = Grading(seeds=seeds, degree=top)
    basis = ResidueBasis(100, largest_prime(top))
    values, moduli = factors(grading, basis)
    splits = [(d, top - d) for d in range(1, top) if not symmetric or 2 * d <= top]
    start = int(grading.first_row[top])
    out = np.zeros((int(grading.first_row[-1]) - start, WIDTH))
    limit = products_between_reductions(top)
    blocks, none = grading.wanted_blocks(top), np.zeros(0, dtype=bool)
    table = np.array(splits)
    kernels.multiply((0.0,) * WIDTH, values, values, out, top, start, table, symmetric, none, blocks, grading.tables, None, moduli, limit)
    ones = np.ones(values.shape)
    counts = np.zeros_like(out)
    kernels.multiply((0.0,) * WIDTH, ones, ones, counts, top, start, table, symmetric, none, blocks, grading.tables, None)
    canonical = grading.canonical(top)
    assert counts[canonical].max() > limit or seeds == 4
    for found, count in zip(out[canonical], counts[canonical], strict=True):
        for lane, p in enumerate(moduli):
            exact = int(count[lane]) * int(values[0, lane]) ** 2
            assert (int(found[lane]) - exact) % int(p) == 0
            assert abs(found[lane]) <= p // 2


@pytest.mark.parametrize(("seeds", "top"), [(1, 12), (2, 9), (3, 6), (4, 6)])
@pytest.mark.parametrize("modular", [True, False])
def test_products_with_a_diagonal_series_are_those_of_all_its_rows(seeds, top, modular):
    """Whole numbers, so that the order of sums does not matter."""
    grading = Grading(seeds=seeds, degree=top)
    generator = np.random.default_rng(top)
    rows, first = int(grading.first_row[-1]), int(grading.first_row[top])
    active = np.zeros(rows, dtype=bool)
    for n in range(2, top, 2):
        active[grading.first_row[n] + grading.rows(np.repeat(grading.diagonal(n), 2, axis=1))] = True
    left, right = generator.integers(-1000, 1000, (2, 2, rows, WIDTH)).astype(float)
    left[:, ~active] = 0
    splits = np.array([(n, top - n) for n in range(2, top, 2)])
    has = np.zeros((2, top + 1), dtype=bool)
    has[0, splits[:, 0]] = has[1, splits[:, 1]] = True
    lanes, blocks, prime = (0.0,) * WIDTH, grading.wanted_blocks(top), 10007.0
    moduli = np.full((2, WIDTH), prime) if modular else None
    ours, theirs = np.zeros((2, 2, rows - first, WIDTH))
    kernels.multiply_diagonal(lanes, left, right, ours, top, *has, blocks, grading.tables, grading.diagonal_tables, moduli, 5)
    for part in range(2):
        pair = (left[part], right[part], theirs[part])
        kernels.multiply(lanes, *pair, top, first, splits, False, active, blocks, grading.tables, None)
    canonical = grading.canonical(top)
    difference = (ours - theirs)[:, canonical]
    assert theirs.any()
    assert not (difference % prime if modular else difference).any()
    assert not modular or np.abs(ours).max() <= prime / 2
