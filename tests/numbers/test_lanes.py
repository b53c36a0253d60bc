"""Lanes inside compiled loops: the same bits as of numbers one by one, with the compiler and without."""

import numpy as np
import pytest

from symfpu.compiled import compiled
from symfpu.numbers.lanes import LANES, entry, lane, put, total, with_lane, within, zeros

ROWS = np.random.default_rng(1).normal(size=(3, LANES))


def combined(out, rows):
    a, b = entry(rows, 0), entry(rows, 1)
    value = a
    for j in range(1, len(rows)):
        value = 1 + 0.3 * value * (b - 2.5) + entry(rows, j)
    put(out, 0, value)
    put(out, 1, 3.0 - value)
    put(out, 2, value)


def from_number(out, rows, number):
    """A number that becomes lanes in a loop, as a coefficient does."""
    value = number
    for j in range(len(rows)):
        value = number + entry(rows, j) * value
    put(out, 0, value)


def counted(rows, least, most):
    return within(entry(rows, 0), entry(least, 0), entry(most, 0)) + within(entry(rows, 1), -9.0, 9.0)


def summed(rows):
    return total(entry(rows, 1))


def turned(rows):
    for place in range(LANES):
        value = entry(rows, 0)
        put(rows, 0, with_lane(value, place, 2.0 * lane(value, LANES - 1 - place)))


def made(function):
    return compiled(error_model="numpy", keep=False)(function)


@pytest.mark.parametrize(("function", "more"), [(combined, ()), (from_number, (0.7,))])
def test_each_lane_has_the_bits_of_a_number_alone(function, more):
    """Nothing is fused: a product and a sum are rounded twice."""
    lanes, interpreted, alone = zeros((3, LANES)), zeros((3, LANES)), np.zeros((3, LANES))
    made(function)(lanes, ROWS, *more)
    function(interpreted, ROWS, *more)
    for place in range(LANES):
        out = np.zeros(3)
        made(function)(out, ROWS[:, place].copy(), *more)
        alone[:, place] = out
    assert np.array_equal(lanes, alone)
    assert np.array_equal(interpreted, alone)
    assert np.any(lanes[0] != ROWS[0])


def test_lanes_are_within_bounds_if_all_are():
    least, most = np.full((1, LANES), -5.0), np.full((1, LANES), 5.0)
    count = made(counted)
    assert count(ROWS, least, most) == counted(ROWS, least, most) == 2
    for place in range(LANES):
        for outside in (-6.0, 6.0, np.nan, np.inf):
            rows = ROWS.copy()
            rows[0, place] = outside
            assert count(rows, least, most) == counted(rows, least, most) == 1
        narrow = most.copy()
        narrow[0, place] = -4.0
        assert count(ROWS, least, narrow) == counted(ROWS, least, narrow) == 1


def test_a_sum_runs_from_the_first_lane_to_the_last():
    value = 0.0
    for number in ROWS[1]:
        value += float(number)
    assert made(summed)(ROWS) == value == summed(ROWS)


def test_lanes_are_taken_and_set_one_by_one():
    rows, value = ROWS.copy(), ROWS[0].copy()
    made(turned)(rows)
    for place in range(LANES):
        value[place] = 2 * value[LANES - 1 - place]
    assert np.array_equal(rows[0], value)


def test_an_entry_is_a_copy_without_the_compiler():
    """The kernels put a value where they have just read one."""
    rows = ROWS.copy()
    before = entry(rows, 0)
    put(rows, 0, before + 1.0)
    assert np.array_equal(before, ROWS[0])
