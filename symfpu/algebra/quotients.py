"""Rational functions of several variables with rational coefficients, in lowest terms.

Quotients of FLINT's polynomials over the integers. Sums and products divide by greatest common
divisors of the parts, which are small, instead of those of the results (Henrici 1956).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import flint
import symengine as se


def quotient_field(names: Sequence[str]) -> tuple[Quotient, ...]:
    """The variables, as quotients.

    >>> x, y = quotient_field(("x", "y"))
    >>> (x * x - y * y) / (2 * x + 2 * y) * 6, bool(x - x), 1 / x == 2 / (x + x)
    (3*x - 3*y, False, True)
    >>> 1 / (x - y) + 1 / (x + y)
    (2*x)/(x^2 - y^2)
    """
    context = flint.fmpz_mpoly_ctx.get(tuple(names), "lex")
    one = context.constant(1)
    return tuple(Quotient(x, one) for x in context.gens())


class Quotient:
    """top / bottom, without a common divisor; the leading coefficient of bottom is positive.

    Integers may stand on the other side of an operator.
    """

    __slots__ = ("bottom", "top")

    def __init__(self, top: Any, bottom: Any) -> None:
        self.top, self.bottom = top, bottom

    def __repr__(self) -> str:
        return str(self.top) if self.bottom == 1 else f"({self.top})/({self.bottom})"

    def __bool__(self) -> bool:
        return bool(self.top != 0)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, (int, Quotient)):
            return NotImplemented
        return not self - other

    __hash__ = None  # type: ignore[assignment]

    def _of(self, other: int | Quotient) -> Quotient:
        """A number as a quotient."""
        if isinstance(other, Quotient):
            return other
        context = self.top.context()
        return Quotient(context.constant(other), context.constant(1))

    def __add__(self, other: int | Quotient) -> Quotient:
        other = self._of(other)
        common = self.bottom.gcd(other.bottom)
        first, second = self.bottom // common, other.bottom // common
        top = self.top * second + other.top * first
        # what top and first second common share divides common
        shared = top.gcd(common)
        return Quotient(top // shared, first * (other.bottom // shared))

    __radd__ = __add__

    def __neg__(self) -> Quotient:
        return Quotient(-self.top, self.bottom)

    def __sub__(self, other: int | Quotient) -> Quotient:
        return self + -other

    def __rsub__(self, other: int) -> Quotient:
        return -self + other

    def __mul__(self, other: int | Quotient) -> Quotient:
        other = self._of(other)
        first = self.top.gcd(other.bottom)
        second = other.top.gcd(self.bottom)
        top = (self.top // first) * (other.top // second)
        bottom = (self.bottom // second) * (other.bottom // first)
        return Quotient(top, bottom)

    __rmul__ = __mul__

    def _inverse(self) -> Quotient:
        if not self:
            raise ZeroDivisionError("a rational function that is zero has no inverse")
        if self.top.leading_coefficient() < 0:
            return Quotient(-self.bottom, -self.top)
        return Quotient(self.bottom, self.top)

    def __truediv__(self, other: int | Quotient) -> Quotient:
        return self * self._of(other)._inverse()

    def __rtruediv__(self, other: int) -> Quotient:
        return self._inverse() * other


def monomials_of(polynomial: Any) -> Iterator[tuple[tuple[int, ...], int]]:
    """Of the top or the bottom of a quotient: exponents of the variables, and coefficient."""
    for exponents, coefficient in polynomial.to_dict().items():
        yield tuple(map(int, exponents)), int(coefficient)


def expression_of(polynomial: Any, symbols: Sequence[Any]) -> Any:
    """A polynomial of a quotient as a SymEngine expression in other symbols."""
    terms = []
    for powers, number in monomials_of(polynomial):
        factors = [x**e for x, e in zip(symbols, powers, strict=True)]
        terms.append(se.Mul(se.Integer(number), *factors))
    return se.Add(*terms)
