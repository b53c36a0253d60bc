"""Rational functions: the arithmetic of their values at points, in lowest terms."""

import operator
import random
from fractions import Fraction

import flint
import pytest

from symfpu.algebra.quotients import Quotient, monomials_of, quotient_field

OPERATIONS = (operator.add, operator.sub, operator.mul, operator.truediv)


def at(quotient, point):
    """The value at rational numbers."""
    top, bottom = (sum(c * point[0] ** i * point[1] ** j for (i, j), c in monomials_of(part)) for part in (quotient.top, quotient.bottom))
    return Fraction(top) / bottom


def made(source, steps, point):
    """A quotient of so many random operations, and its value by fractions."""
    quotients = [*quotient_field(("x", "y"))]
    pairs = list(zip(quotients, point, strict=True))
    for _ in range(steps):
        first, second = source.choice(pairs), source.choice([*pairs, (3, Fraction(3))])
        operation = source.choice(OPERATIONS)
        if operation is operator.truediv and not second[0]:
            continue
        pairs.append((operation(first[0], second[0]), operation(first[1], second[1])))
    return pairs


@pytest.mark.parametrize("seed", range(20))
def test_values_are_those_of_fractions(seed):
    source = random.Random(seed)
    point = (Fraction(2**61 - 1, 7), Fraction(3**40, 11))  # on no small curve
    for quotient, value in made(source, 14, point):
        assert at(quotient, point) == value
        assert bool(quotient) == (value != 0)
        assert quotient.top.gcd(quotient.bottom) == 1
        assert quotient.bottom.leading_coefficient() > 0


def test_numbers_stand_on_both_sides():
    x, y = quotient_field(("x", "y"))
    assert 2 - x == -(x - 2)
    assert 1 / (x - y) == -1 / (y - x)
    assert 6 / (2 * x) == 3 / x
    assert x - x == 0 != x
    assert x != "x"


def test_zero_has_no_inverse():
    x, _ = quotient_field(("x", "y"))
    with pytest.raises(ZeroDivisionError, match="rational function"):
        1 / (x - x)


def test_equal_quotients_are_written_alike():
    """So that formulas do not depend on the way to them."""
    x, y = quotient_field(("x", "y"))
    assert repr((x * x - y * y) / (y - x)) == repr(-x - y) == "-x - y"
    assert repr(x / (-2 * y)) == "(-x)/(2*y)"
    context = flint.fmpz_mpoly_ctx.get(("x", "y"), "lex")
    assert repr(Quotient(context.constant(0), context.constant(1)) * x) == "0"
