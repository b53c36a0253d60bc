"""Decimals of bounds are on the side on which the bound stays true."""

import random
from fractions import Fraction

import mpmath
import pytest

from symfpu.certified.existence import interval_text
from symfpu.numbers.one_sided import above, below, rational

NUMBERS = [1.21e-30, 0.0428, 1.0, 9.99e-5, 99999.0, 123456.7, 5e-324, Fraction(1, 3), mpmath.mpf(2) ** -5000]


@pytest.mark.parametrize("digits", [1, 2, 3])
@pytest.mark.parametrize("x", NUMBERS)
def test_decimals_enclose_the_number_within_a_unit_of_the_last(x, digits):
    low, high, exact = Fraction(below(x, digits)), Fraction(above(x, digits)), rational(x)
    assert low <= exact <= high
    assert high - low <= low * Fraction(10) ** (1 - digits)


def test_nothing_is_nothing():
    assert above(0.0, 2) == below(0.0, 2) == "0"


def test_intervals_in_words_hold_those_that_are_proved():
    rng = random.Random(5)
    for _ in range(300):
        middle, radius = mpmath.mpf(rng.uniform(-2, 2)), 10.0 ** rng.uniform(-14, -1)
        text, width = map(Fraction, interval_text(middle, radius).split(" +- "))
        assert abs(rational(middle) - text) + rational(radius) <= width
