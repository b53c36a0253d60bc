"""Series of polynomials in exact arithmetic: the root squares back, derivatives are those of the polynomials."""

from fractions import Fraction

import flint
import mpmath
import symengine as se
from hypothesis import given
from hypothesis import strategies as st

from symfpu.algebra.polynomials import evaluate, powers_of, rescaled, square_root

rationals = st.fractions(-3, 3, max_denominator=20)
exponents = st.tuples(st.integers(0, 3), st.integers(0, 3))
polynomials = st.dictionaries(exponents, rationals, max_size=4)
points = st.tuples(rationals, rationals)
linear = st.fractions(Fraction(1, 10), 3, max_denominator=20)


def product(f, g):
    result = {}
    for e, a in f.items():
        for d, b in g.items():
            key = tuple(x + y for x, y in zip(e, d, strict=True))
            result[key] = result.get(key, 0) + a * b
    return result


def added(parts):
    total = {}
    for part in parts:
        for e, a in part.items():
            total[e] = total.get(e, 0) + a
    return {e: a for e, a in total.items() if a != 0}


@given(linear, st.lists(polynomials, max_size=4))
def test_the_root_squares_back(omega, corrections):
    """sum_j omega^(j) omega^(k-j) = [omega^2]^(k), exactly, at every order."""
    squares = [{(0, 0): omega**2}, *corrections]
    roots = square_root(squares, omega)
    assert roots[0] == {(0, 0): omega}
    for k, square in enumerate(squares):
        assert added(product(roots[j], roots[k - j]) for j in range(k + 1)) == added([square])


@given(linear, st.lists(polynomials, min_size=1, max_size=3), st.data())
def test_higher_orders_do_not_touch_lower_ones(omega, corrections, data):
    squares = [{(0, 0): omega**2}, *corrections]
    cut = data.draw(st.integers(1, len(squares)))
    assert square_root(squares[:cut], omega) == square_root(squares, omega)[:cut]
    assert squares == [{(0, 0): omega**2}, *corrections]  # arguments are left alone


@given(polynomials, points)
def test_value_and_gradient_are_exact(polynomial, point):
    """Also where a coordinate is zero."""
    value, gradient = evaluate(polynomial, powers_of(point, 3, Fraction(1)))
    x, y = point
    assert value == sum(c * x**i * y**j for (i, j), c in polynomial.items())
    assert gradient[0] == sum(c * i * x ** (i - 1) * y**j for (i, j), c in polynomial.items() if i)
    assert gradient[1] == sum(c * j * x**i * y ** (j - 1) for (i, j), c in polynomial.items() if j)


@given(polynomials, st.tuples(linear, linear), points, st.sampled_from([1.0, -1.0]))
def test_rescaling_is_a_change_of_variables(polynomial, slopes, point, sign):
    scaled = rescaled(polynomial, list(slopes), sign)
    here, _ = evaluate(scaled, powers_of(point, 3, Fraction(1)))
    there, _ = evaluate(polynomial, powers_of([s * x for s, x in zip(slopes, point, strict=True)], 3, Fraction(1)))
    assert here == int(sign) * there


def test_the_binomial_series_in_every_kind_of_number():
    """sqrt(1 + x) = 1 + x/2 - x^2/8 + x^3/16 - 5 x^4/128."""
    expected = [Fraction(1), Fraction(1, 2), Fraction(-1, 8), Fraction(1, 16), Fraction(-5, 128)]
    kinds = (float, mpmath.mpf, flint.arb, se.Integer, Fraction, flint.fmpq)
    for kind in kinds:
        squares = [{(0,): kind(1)}, {(1,): kind(1)}, {}, {}, {}]
        roots = square_root(squares, kind(1))
        for k, (root, value) in enumerate(zip(roots, expected, strict=True)):
            assert root[(k,)] == kind(value.numerator) / kind(value.denominator)
