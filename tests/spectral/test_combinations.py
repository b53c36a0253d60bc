"""Whole combinations are found; accidents are not taken for them."""

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symfpu.spectral.combinations import FURTHER, Basis, nothing
from tests.tolerances import EXACT_LINE

OMEGA = (1.0, math.sqrt(2), math.pi / 2)
COARSE = 0.01
RATE = 4 * math.pi


@cache
def basis():
    found = Basis(RATE)
    for omega in OMEGA:
        found.add(omega, EXACT_LINE)
    return found


def within(weights, reach):
    """All but the empty sum."""
    found = nothing(reach)
    for weight in weights:
        found = found.extended(reach, weight, 0.0, 0.0)
    return found.table[1:]


@pytest.mark.parametrize(("s", "order"), [(1, 5), (2, 4), (3, 3), (5, 2)])
def test_all_combinations_are_there_once(s, order):
    table = within(np.ones(s), order)
    sizes = np.abs(table).sum(axis=1)
    assert len({tuple(row) for row in table.tolist()}) == len(table)
    assert (np.diff(sizes) >= 0).all()
    cube = np.array(np.meshgrid(*[range(-order, order + 1)] * s)).reshape(s, -1).T
    inside = np.abs(cube).sum(axis=1)
    assert len(table) == ((inside > 0) & (inside <= order)).sum()


@pytest.mark.parametrize("most", [10, 100, 1000])
def test_the_widest_has_no_more_than_asked_for(most):
    found = nothing()
    for weight in (1.0, 1.5, 2.5):
        foreseen = found.number_within(2.0, weight)
        assert foreseen == len(found.extended(2.0, weight, 0.0, 0.0).table)
        found = found.widest(weight, most, 0.0, 0.0)
        assert 0 < len(found.table) - 1 <= most
    assert len(within((1.0, 1.5, 2.5), FURTHER * found.reach)) > most


def test_sums_and_doubts_are_those_of_the_table():
    known = basis().known
    errors = np.full(len(OMEGA), EXACT_LINE)
    assert np.allclose(known.sums, known.table @ np.array(OMEGA), rtol=0, atol=EXACT_LINE)
    assert np.allclose(known.doubts, np.abs(known.table) @ errors, rtol=EXACT_LINE, atol=0)
    assert (np.diff(known.sizes) >= 0).all()


@settings(max_examples=20, deadline=None)
@given(st.tuples(*[st.integers(-3, 3)] * 3).filter(any))
def test_a_combination_is_found(nu):
    assert basis().combination(float(np.dot(nu, OMEGA)), EXACT_LINE) == nu


def test_weak_frequencies_take_part_in_low_sums_alone():
    table = within([1.0, 3.0], 6.0)
    assert sorted({tuple(row) for row in np.abs(table).tolist()}) == [
        *((0, 1), (0, 2)),
        *((n, m) for n in range(1, 7) for m in (0, 1, 2) if n + 3 * m <= 6),
    ]


def test_an_image_of_a_high_one_is_known():
    assert basis().combination(RATE - 9.0, EXACT_LINE) == (-9, 0, 0)


def test_an_unknown_frequency_is_none_and_a_coarse_one_cannot_be_told():
    known = basis()
    assert known.combination(math.e, EXACT_LINE) is None
    assert known.can_tell(EXACT_LINE)
    assert not known.can_tell(COARSE)
    assert known.combination(sum(OMEGA), COARSE) is None, "would be met by accident"
