"""Truncated power series against those of SymPy."""

from fractions import Fraction

import pytest
import sympy

from symfpu.series.power_series import PowerSeries

x = sympy.Symbol("x")


def coefficients(function, length):
    expansion = sympy.series(function, x, 0, length).removeO()
    return [Fraction(int(c.p), int(c.q)) for c in (expansion.coeff(x, n) for n in range(length))]


def test_quotient_and_root_are_those_of_sympy():
    f, g = (PowerSeries(coefficients(h, 7)) for h in (sympy.exp(x), sympy.cos(x)))
    assert (f * g.inverse()).coefficients == coefficients(sympy.exp(x) / sympy.cos(x), 7)
    assert g.root().coefficients == coefficients(sympy.sqrt(sympy.cos(x)), 7)
    assert (2 * f - g + 1).coefficients == coefficients(2 * sympy.exp(x) - sympy.cos(x) + 1, 7)


def test_a_product_is_as_long_as_its_shorter_factor():
    short, long = PowerSeries([Fraction(1)] * 2), PowerSeries([Fraction(1)] * 5)
    assert len(short * long) == len(long + short) == 2
    assert (long * long).cut(3).coefficients == [1, 2, 3]


def test_nothing_is_divided_by_zero():
    with pytest.raises(ZeroDivisionError):
        PowerSeries([Fraction(0), Fraction(1)]).inverse()
