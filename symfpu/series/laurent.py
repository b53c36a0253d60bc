"""Truncated Laurent series with rational coefficients, and the frequencies of a long chain.

With x = pi/2N a mode from the start of the spectrum has Omega_q = 2 sin qx, and one from its end
Omega_(N-b) = 2 cos bx. Products of frequencies of one end have even powers of x only, or odd ones
only; so every second power is left out where all seeds are at one end.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce
from math import factorial
from operator import add
from typing import Any

from symfpu.chain.length import HighMode
from symfpu.series.power_series import PowerSeries

BOTH_ENDS, ONE_END = 1, 2  # powers of x from one coefficient to the next


class Laurent:
    """x^low (c_0 + c_1 x^step + c_2 x^2step + ... ), known for so many coefficients.

    >>> series = Laurent(0, [Fraction(0), Fraction(2), Fraction(1)], 1)
    >>> series.inverse()
    Laurent(-1, [Fraction(1, 2), Fraction(-1, 4)], 1)
    """

    __slots__ = ("low", "series", "step")

    def __init__(self, low: int, coefficients: Sequence[Fraction], step: int) -> None:
        self.low, self.series, self.step = low, PowerSeries(coefficients), step

    def __repr__(self) -> str:
        return f"Laurent({self.low}, {self.coefficients}, {self.step})"

    @property
    def coefficients(self) -> list[Fraction]:
        """c_0, c_1, ..."""
        return self.series.coefficients

    @property
    def end(self) -> int:
        """The first power that is not known."""
        return self.low + self.step * len(self.series)

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
            coefficients = (self.series * other.series).coefficients
            return Laurent(self.low + other.low, coefficients, self.step)
        return Laurent(self.low, [c * other for c in self.coefficients], self.step)

    __rmul__ = __mul__

    def inverse(self) -> Laurent:
        """1 / series; ZeroDivisionError where no known coefficient differs from zero."""
        first = self.first
        if first is None:
            raise ZeroDivisionError("a series without a known term")
        known = PowerSeries(self.from_power(first, self.end))
        return Laurent(-first, known.inverse().coefficients, self.step)


class LongChain:
    """Series from so many coefficients: the numbers and the frequencies of a long chain.

    length : how many. step : ONE_END if all seeds are at one end of the spectrum, else BOTH_ENDS.

    >>> powers = LongChain(2, ONE_END)
    >>> powers.frequency(1), powers.frequency(HighMode(-1)).coefficients
    (Laurent(1, [Fraction(2, 1), Fraction(-1, 3)], 2), [Fraction(2, 1), Fraction(-1, 1)])
    """

    __slots__ = ("length", "step")

    def __init__(self, length: int, step: int) -> None:
        self.length, self.step = length, step

    def number(self, value: int | Fraction) -> Laurent:
        """A number."""
        zeros = [Fraction(0)] * (self.length - 1)
        return Laurent(0, [Fraction(value), *zeros], self.step)

    def frequency(self, q: int) -> Laurent:
        """Omega_q of a label: 2 sin qx, or 2 cos bx for N - b."""
        odd = 0 if isinstance(q, HighMode) else 1
        coefficients = [Fraction(0)] * self.length
        for n in range(0, self.length, 2 // self.step):
            power = self.step * n
            size = Fraction(2 * abs(int(q)) ** (power + odd), factorial(power + odd))
            coefficients[n] = -size if power % 4 else size
        return Laurent(odd, coefficients, self.step)

    def drive(self, seeds: Sequence[int], nu: Sequence[int]) -> Laurent:
        """nu.Omega."""
        pairs = [(n, q) for n, q in zip(nu, seeds, strict=True) if n]
        if not pairs:
            return self.number(0)
        return reduce(add, (self.frequency(q) * n for n, q in pairs))
