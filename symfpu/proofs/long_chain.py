"""The frequencies of a long chain as series in x = pi/2N.

A mode from the start of the spectrum has Omega_q = 2 sin qx, and one from its end
Omega_(N-b) = 2 cos bx. Products of frequencies of one end have even powers of x only, or odd ones
only; so every second power is left out where all seeds are at one end.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce
from math import factorial
from operator import add

from symfpu.algebra.laurent import Laurent
from symfpu.chain.length import HighMode

BOTH_ENDS, ONE_END = 1, 2  # powers of x from one coefficient to the next


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
