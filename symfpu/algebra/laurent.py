"""Laurent series in one variable with rational coefficients, cut."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from symfpu.algebra.truncated import in_one_variable


class Laurent:
    """x^low (c_0 + c_1 x^step + c_2 x^2step + ... ), known for so many coefficients.

    >>> series = Laurent(0, [Fraction(0), Fraction(2), Fraction(1)], 1)
    >>> series.inverse()
    Laurent(-1, [Fraction(1, 2), Fraction(-1, 4)], 1)
    """

    __slots__ = ("low", "series", "step")

    def __init__(self, low: int, coefficients: Sequence[Fraction], step: int) -> None:
        self.low, self.series, self.step = low, in_one_variable(coefficients), step

    def __repr__(self) -> str:
        return f"Laurent({self.low}, {self.coefficients}, {self.step})"

    @property
    def coefficients(self) -> list[Fraction]:
        """c_0, c_1, ..."""
        return self.series.coefficients()

    @property
    def end(self) -> int:
        """The first power that is not known."""
        return self.low + self.step * len(self.series.parts)

    @property
    def first(self) -> int | None:
        """The power of the first coefficient that is not zero, none if all known ones are."""
        for n, c in enumerate(self.coefficients):
            if c:
                return self.low + self.step * n
        return None

    def leads_below_zero(self) -> bool:
        """Whether the first coefficient that is not zero is negative."""
        return next((c < 0 for c in self.coefficients if c), False)

    def from_power(self, low: int, end: int) -> list[Fraction]:
        """Coefficients of x^low .. x^(end-step); both are powers of this series."""
        before, count = (low - self.low) // self.step, max(0, end - low) // self.step
        padded = [Fraction(0)] * max(0, -before) + self.coefficients
        return padded[max(0, before) :][:count]

    def __add__(self, other: Any) -> Laurent:
        if not isinstance(other, Laurent):
            if not other:
                return self
            length = max(1, self.end // self.step)
            other = Laurent(0, [Fraction(other), *[Fraction(0)] * (length - 1)], self.step)
        low, end = min(self.low, other.low), min(self.end, other.end)
        pairs = zip(self.from_power(low, end), other.from_power(low, end), strict=True)
        return Laurent(low, [a + b for a, b in pairs], self.step)

    __radd__ = __add__

    def __mul__(self, other: Any) -> Laurent:
        if isinstance(other, Laurent):
            coefficients = (self.series * other.series).coefficients()
            return Laurent(self.low + other.low, coefficients, self.step)
        return Laurent(self.low, [c * other for c in self.coefficients], self.step)

    __rmul__ = __mul__

    def inverse(self) -> Laurent:
        """1 / series; ZeroDivisionError where no known coefficient differs from zero."""
        first = self.first
        if first is None:
            raise ZeroDivisionError("a series without a known term")
        known = in_one_variable(self.from_power(first, self.end))
        return Laurent(-first, known.inverse().coefficients(), self.step)
