"""The product of series in one seed, which sums tiles of rows, against the general product and against sums of integers."""

import numpy as np
import pytest

from symfpu import compiled as compiled_loops
from symfpu.algebra import kernels, one_seed, uncompiled
from symfpu.algebra.grading import Grading
from symfpu.chain.chain import Chain
from symfpu.compiled import compiled
from symfpu.series.lindstedt import lindstedt
from tests.tolerances import HIGH_ORDER


def integers(rows, width, seed):
    """Small whole numbers: their sums of products have no rounding, in any order."""
    return np.random.default_rng(seed).integers(-99, 100, (rows, width)).astype(float)


@pytest.mark.parametrize("width", [4, 8, 16])
@pytest.mark.parametrize("top", [2, 3, 4, 5, 9, 22, 61])
def test_it_is_the_general_product(top, width):
    grading = Grading(seeds=1, degree=top)
    left, right = (integers(int(grading.first_row[-1]), width, seed) for seed in (1, 2))
    splits = np.array([(d, top - d) for d in range(1, top)])
    lanes = (0.0,) * width
    ours, general = np.zeros((2, top + 1, width))
    first = int(grading.canonical(top)[0])
    tiles = np.arange(first, top + 1, one_seed.TILE)
    count = one_seed.convolve(lanes, left, right, ours, splits, grading.first_row, tiles)
    blocks, none = grading.wanted_blocks(top), np.zeros(0, dtype=bool)
    start = int(grading.first_row[top])
    same = kernels.multiply(lanes, left, right, general, top, start, splits, False, none, blocks, grading.tables, None)
    assert np.array_equal(ours[first:], general[first:])
    assert general[first:].any()
    assert count == same > 0


def test_a_tile_is_its_definition():
    left, right = integers(20, 8, 3), integers(20, 8, 4)
    expected, ours, interpreted = np.ones((3, 12, 8))
    for t in range(one_seed.TILE):
        for n in range(7):
            expected[2 + t] += left[1 + n] * right[9 + t - n]
    one_tile(left, right, ours)
    uncompiled.convolution(one_seed.TILE)((0.0,) * 8, left, 1, right, 9, 7, interpreted, 2)
    assert np.array_equal(ours, expected)
    assert np.array_equal(interpreted, expected)


@pytest.mark.parametrize("zeros", [0, 3, 8])
def test_rows_of_zeros_at_both_ends_cost_nothing_and_change_nothing(zeros):
    """Degrees whose highest harmonics are zero: the general product, with fewer multiply-adds."""
    top, width = 40, 8
    grading = Grading(seeds=1, degree=top)
    values = integers(int(grading.first_row[-1]), width, 1)
    for d in range(1, top):
        rows = values[grading.first_row[d] : grading.first_row[d + 1]]
        kept = np.abs(2 * np.arange(d + 1) - d) <= d - 2 * zeros
        rows[:] = np.where(kept[:, None], rows + rows[::-1], 0.0)
    splits = np.array([(d, top - d) for d in range(1, top)])
    lanes, first = (0.0,) * width, int(grading.canonical(top)[0])
    ours, general = np.zeros((2, top + 1, width))
    tiles = np.arange(first, top + 1, one_seed.TILE)
    count = one_seed.convolve(lanes, values, values, ours, splits, grading.first_row, tiles)
    blocks, none = grading.wanted_blocks(top), np.zeros(0, dtype=bool)
    start = int(grading.first_row[top])
    whole = kernels.multiply(lanes, values, values, general, top, start, splits, False, none, blocks, grading.tables, None)
    assert np.array_equal(ours[first:], general[first:])
    assert general[first:].any()
    assert count < whole if zeros else count == whole


@pytest.mark.skipif(not (compiled_loops.JIT and one_seed.X86), reason="only there the processor is told")
def test_subnormal_sums_are_zero_and_the_processor_is_left_as_it_was():
    grading, lanes = Grading(seeds=1, degree=2), (0.0,) * 8
    values = np.full((int(grading.first_row[-1]), 8), 2.0**-520)
    out = np.zeros((3, 8))
    one_seed.convolve(lanes, values, values, out, np.array([(1, 1)]), grading.first_row, np.array([1]))
    assert not out.any()
    assert (values * values).all()


@compiled(keep=False)
def one_tile(left, right, out):
    one_seed.add_tile((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), left, 1, right, 9, 7, out, 2)


@pytest.mark.parametrize("model", [{"alpha": "0.33"}, {"beta": "1"}, {"alpha": "0.2", "beta": "0.7"}, {"potential": "toda:1/2"}], ids=str)
def test_high_orders_agree_with_fixed_point_numbers(model):
    """A frequency next to a resonance: small harmonics are amplified, and keep their own last digits."""
    chain, omega = Chain(N=32, **model), "0.0990"
    doubles = lindstedt(chain, (1,), (omega,), 60)
    digits = lindstedt(chain, (1,), (omega,), 60, digits=20)
    for k in range(61):
        units = float(digits.unit / doubles.unit) ** (digits.degree(k) - 1)
        expected = digits.coordinates[k].floats(-digits.bits) * units
        difference = np.abs(doubles.coordinates[k] - expected)
        assert difference.max() <= HIGH_ORDER * np.abs(expected).max()
