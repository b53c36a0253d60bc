"""Truncated power series over any coefficients that add, multiply and divide."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


class PowerSeries:
    """c_0 + c_1 x + ... + c_(n-1) x^(n-1) + O(x^n).

    coefficients : c_0 .. c_(n-1), in any field; zeros may be the integer 0.

    Numbers may stand on the other side of + and *.

    >>> from fractions import Fraction
    >>> geometric = PowerSeries([Fraction(1), -1, 0]).inverse()
    >>> geometric * geometric
    PowerSeries([Fraction(1, 1), Fraction(2, 1), Fraction(3, 1)])
    """

    __slots__ = ("coefficients",)

    def __init__(self, coefficients: Sequence[Any]) -> None:
        self.coefficients = list(coefficients)

    def __repr__(self) -> str:
        return f"PowerSeries({self.coefficients})"

    def __len__(self) -> int:
        return len(self.coefficients)

    def __add__(self, other: Any) -> PowerSeries:
        if isinstance(other, PowerSeries):
            pairs = zip(self.coefficients, other.coefficients, strict=False)
            return PowerSeries([a + b for a, b in pairs])
        first, *rest = self.coefficients
        return PowerSeries([first + other, *rest])

    __radd__ = __add__

    def __neg__(self) -> PowerSeries:
        return PowerSeries([-a for a in self.coefficients])

    def __sub__(self, other: Any) -> PowerSeries:
        return self.__add__(-other)

    def __mul__(self, other: Any) -> PowerSeries:
        if not isinstance(other, PowerSeries):
            return PowerSeries([a * other for a in self.coefficients])
        length = min(len(self), len(other))
        products: list[Any] = [0] * length
        for i, a in enumerate(self.coefficients[:length]):
            if a:
                for j, b in enumerate(other.coefficients[: length - i]):
                    if b:
                        products[i + j] = products[i + j] + a * b
        return PowerSeries(products)

    __rmul__ = __mul__

    def inverse(self) -> PowerSeries:
        """1 / series; ZeroDivisionError where c_0 is zero."""
        first, *rest = self.coefficients
        head = 1 / first
        found = [head]
        for n in range(1, len(self)):
            total: Any = 0
            for j, a in enumerate(rest[:n]):
                if a:
                    total = total + a * found[n - 1 - j]
            found.append(-total * head)
        return PowerSeries(found)

    def root(self) -> PowerSeries:
        """The square root that begins with 1, of a series that begins with 1."""
        found: list[Any] = [self.coefficients[0]]
        for n in range(1, len(self)):
            total = self.coefficients[n]
            for j in range(1, n):
                total = total - found[j] * found[n - j]
            found.append(total / 2)
        return PowerSeries(found)

    def cut(self, length: int) -> PowerSeries:
        """The first so many coefficients."""
        return PowerSeries(self.coefficients[:length])
