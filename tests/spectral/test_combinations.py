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
    assert known.is_independent(math.e, EXACT_LINE)
    assert not known.is_independent(math.e, COARSE)
    assert known.combination(sum(OMEGA), COARSE) is None, "would be met by accident"


@pytest.mark.parametrize(("frequency", "independent"), [(2.3, True), (2.235758, False)])
def test_a_line_that_may_be_a_light_combination_adds_no_frequency(frequency, independent):
    """2.2357 was a fourth frequency of an orbit of T = 300, where omega_1 + omega_3 = 2.2356."""
    known = Basis(2 * math.pi / 0.4)
    for omega, spread, strength in ((0.619023, 6e-8, 1.0), (1.174567, 5e-6, 0.12), (1.616623, 2e-5, 2.7e-3)):
        known.add(omega, spread, strength)
    assert known.combination(frequency, 1e-3) is None, "would be met by accident too often"
    assert known.is_independent(frequency, 1e-3) == independent


@pytest.mark.parametrize("most", [10, 100, 1000])
def test_the_widest_has_no_more_than_asked_for(most):
    found = nothing()
    for weight in (1.0, 1.5, 2.5):
        foreseen = found.number_within(2.0, weight)
        assert foreseen == len(found.extended(2.0, weight, 0.0, 0.0).table)
        found = found.widest(weight, most, 0.0, 0.0)
        assert 0 < len(found.table) - 1 <= most
    assert len(within((1.0, 1.5, 2.5), FURTHER * found.reach)) > most
