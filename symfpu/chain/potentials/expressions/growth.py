"""Tensions that are sums of exponentials and powers of linear functions, found in expressions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

from symfpu.chain.potentials.expressions import sizes
from symfpu.chain.potentials.expressions.text import parsed, stretch

DEEPEST = (
    3  # functions within each other: nested ones are no such sum, and long in exponentials
)
MOST = 4  # more of them cost more than powers do at common orders


class Part(NamedTuple):
    """weight g with (1 + slope r) g' = rate g, g(0) = 1."""

    weight: Fraction
    slope: Fraction
    rate: Fraction


def parts_of_tension(formula: str) -> tuple[Part, ...]:
    """V' but for a constant; empty where it is no such sum, or one of too many.

    Numbers have to be rational.
    """
    import sympy

    if sizes.depth(parsed(formula)) > DEEPEST:
        return ()
    tension = sympy.diff(parsed(formula), stretch())
    # expanded before the brackets of powers are
    terms = sympy.expand_mul(tension.rewrite(sympy.exp))
    found: dict[tuple[Fraction, Fraction], Fraction] = {}
    for term in sympy.Add.make_args(terms):
        if not term.has(stretch()):
            continue
        part = _part(term)
        if part is None:
            return ()
        key = part.slope, part.rate
        found[key] = found.get(key, Fraction(0)) + part.weight
    parts = [Part(weight, *key) for key, weight in found.items() if weight]
    return tuple(parts) if len(parts) <= MOST else ()


def _part(term: Any) -> Part | None:
    """One term; None for any other function."""
    import sympy

    number, function = term.as_independent(stretch())
    base, exponent = function.as_base_exp()
    if base == sympy.E:
        values = _of_exponential(number, exponent)
    else:
        values = _of_power(number, base, exponent)
    if not values or not all(x.is_Rational for x in values):
        return None
    return Part(*(Fraction(int(x.p), int(x.q)) for x in values))


def _of_exponential(number: Any, exponent: Any) -> tuple[Any, ...]:
    """Weight, slope and rate of number e^(a + b r); nothing where the exponent is another."""
    import sympy

    a, b = _linear(exponent)
    return (number * sympy.exp(a), sympy.Integer(0), b) if b else ()


def _of_power(number: Any, base: Any, exponent: Any) -> tuple[Any, ...]:
    """Those of number (a + b r)^p; nothing for polynomials and other functions."""
    a, b = _linear(base)
    polynomial = exponent.is_Integer and exponent > 0
    if not (a and b) or polynomial or not exponent.is_Rational:
        return ()
    return number * a**exponent, b / a, exponent * b / a


def _linear(expression: Any) -> tuple[Any, Any]:
    """(a, b) of a + b r; zeros for what is not."""
    import sympy

    r = stretch()
    if expression.is_polynomial(r) and sympy.degree(expression, r) == 1:
        polynomial = sympy.Poly(expression, r)
        return polynomial.coeff_monomial(1), polynomial.coeff_monomial(r)
    return sympy.Integer(0), sympy.Integer(0)
