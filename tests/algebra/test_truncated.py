"""Power series cut at a degree against those of SymPy, in one variable and in several."""

from fractions import Fraction

import pytest
import sympy

from symfpu.algebra.truncated import Truncated, in_one_variable, inverted, variables

x, y = sympy.symbols("x y")


def coefficients(function, length):
    expansion = sympy.series(function, x, 0, length).removeO()
    return [rational(expansion.coeff(x, n)) for n in range(length)]


def rational(c):
    return Fraction(int(c.p), int(c.q))


def parts(polynomial, top):
    """Of a polynomial of SymPy in x and y, as a series keeps them."""
    found = [{} for _ in range(top + 1)]
    for exponents, c in sympy.Poly(polynomial, x, y).terms():
        if sum(exponents) <= top and c:
            found[sum(exponents)][exponents] = rational(c)
    return found


def test_quotient_and_root_are_those_of_sympy():
    f, g = (in_one_variable(coefficients(h, 7)) for h in (sympy.exp(x), sympy.cos(x)))
    assert (f * g.inverse()).coefficients() == coefficients(sympy.exp(x) / sympy.cos(x), 7)
    assert g.root().coefficients() == coefficients(sympy.sqrt(sympy.cos(x)), 7)
    assert (2 * f - g + 1).coefficients() == coefficients(2 * sympy.exp(x) - sympy.cos(x) + 1, 7)
    assert (1 - f).coefficients() == coefficients(1 - sympy.exp(x), 7)


def test_a_sum_and_a_product_are_known_as_far_as_both_are():
    short, long = in_one_variable([Fraction(1)] * 2), in_one_variable([Fraction(1)] * 5)
    for mixed in (short * long, long * short, long + short, short - long):
        assert mixed.top == 1
    assert (long * long).cut(2).coefficients() == [1, 2, 3]
    assert short.cut(3).coefficients() == [1, 1, 0, 0]


def test_products_of_two_variables_are_those_of_sympy():
    p, q = 1 + 2 * x - 3 * y + x * y, 2 - x + y**2 / 3
    a, b = Truncated(parts(p, 3), 2), Truncated(parts(q, 3), 2)
    assert (a * b).parts == parts(sympy.expand(p * q), 3)
    assert (a - b).parts == parts(p - q, 3)
    whole = b * b.inverse()
    assert list(whole.items()) == [((0, 0), 1)]
    square = (a * a).root()
    assert square.parts == a.parts


@pytest.mark.parametrize("top", [1, 2, 4])
def test_an_inverted_map_undoes_the_map(top):
    first, second = variables([Fraction(0), Fraction(0)], top, Fraction(1))
    found = [first * 2 + first * second, second * -3 + first * first + second * second * second]
    back = inverted(found)
    for place, series in enumerate(found):
        unit = tuple(int(i == place) for i in range(2))
        assert list(series.composed(back).items()) == [(unit, 1)]


def test_nothing_is_divided_by_zero():
    with pytest.raises(ZeroDivisionError):
        in_one_variable([Fraction(0), Fraction(1)]).inverse()
