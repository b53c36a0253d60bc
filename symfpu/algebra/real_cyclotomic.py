"""The field of rational polynomials in x = 2 cos(2 pi / m): sums of cosines, exactly.

An element is a polynomial modulo the minimal polynomial of x, so that it is zero if and only if
the number is.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import flint


class RealCyclotomic:
    """A number of the field; made by `double_cosines`.

    value : a polynomial over the rationals, of less than the field's degree. modulus : the minimal
    polynomial. Rationals and integers may stand on the other side of an operator.

    >>> two, x, *_ = double_cosines(8, 3)  # x = 2 cos(pi / 4), the square root of 2
    >>> x * x == two, 1 / x == x / 2, bool(x * x - 2)
    (True, True, False)
    """

    __slots__ = ("modulus", "value")

    def __init__(self, value: Any, modulus: Any) -> None:
        self.value, self.modulus = value, modulus

    def __repr__(self) -> str:
        return f"RealCyclotomic({self.value})"

    def __bool__(self) -> bool:
        return bool(self.value != 0)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, (int, RealCyclotomic)):
            return NotImplemented
        return not self - other

    __hash__ = None  # type: ignore[assignment]

    def _with(self, value: Any) -> RealCyclotomic:
        return RealCyclotomic(value, self.modulus)

    def __add__(self, other: Any) -> RealCyclotomic:
        return self._with(self.value + _plain(other))

    __radd__ = __add__

    def __neg__(self) -> RealCyclotomic:
        return self._with(-self.value)

    def __sub__(self, other: Any) -> RealCyclotomic:
        return self._with(self.value - _plain(other))

    def __rsub__(self, other: Any) -> RealCyclotomic:
        return self._with(_plain(other) - self.value)

    def __mul__(self, other: Any) -> RealCyclotomic:
        return self._with(self.value * _plain(other) % self.modulus)

    __rmul__ = __mul__

    def inverse(self) -> RealCyclotomic:
        """1 / number; ZeroDivisionError for zero."""
        if not self:
            raise ZeroDivisionError("zero has no inverse")
        _, inverse, _ = self.value.xgcd(self.modulus)
        return self._with(inverse)

    def __truediv__(self, other: Any) -> RealCyclotomic:
        if isinstance(other, RealCyclotomic):
            return self * other.inverse()
        return self._with(self.value / other)

    def __rtruediv__(self, other: Any) -> RealCyclotomic:
        return self.inverse().__mul__(other)

    def by_cosines(self) -> list[tuple[int, int]]:
        """c_0, c_1, ... of c_0 + sum over k of c_k 2 cos(2 pi k / m): numerators, denominators."""
        left, found = self.value, []
        chebyshev = _double_chebyshev(left.degree() + 1)
        for k in range(left.degree(), 0, -1):
            c = left[k]
            left = left - chebyshev[k] * c
            found.append(c)
        return [(int(c.p), int(c.q)) for c in [left[0], *found[::-1]]]


def _plain(other: Any) -> Any:
    return other.value if isinstance(other, RealCyclotomic) else other


def double_cosines(m: int, count: int) -> Sequence[RealCyclotomic]:
    """2 cos(2 pi k / m) for k = 0 .. count - 1, in the field of m >= 3."""
    modulus = flint.fmpq_poly(flint.fmpz_poly.cos_minpoly(m))
    return [RealCyclotomic(value % modulus, modulus) for value in _double_chebyshev(count)]


def _double_chebyshev(count: int) -> list[Any]:
    """2 T_k(x / 2) for k = 0, 1, ...: 2, x, x^2 - 2, ..."""
    x = flint.fmpq_poly([0, 1])
    first: Any = flint.fmpq_poly([2])
    found = [first, x]
    for _ in range(2, count):
        found.append(x * found[-1] - found[-2])
    return found[:count]
