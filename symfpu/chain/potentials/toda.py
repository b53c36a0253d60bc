"""Toda's potential, whose chain is integrable."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import factorial
from typing import Any, NamedTuple

from symfpu.chain.bonds import Law
from symfpu.chain.potentials.potential import Growth, Potential, checked_coupling
from symfpu.numbers.arithmetic import Arithmetic
from symfpu.numbers.functions import expm1, expm2
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number


class TodaLaw(NamedTuple):
    """The functions of a bond; rate is 2a."""

    rate: Any

    @staticmethod
    def takes_lanes() -> bool:
        return True  # its functions take lanes of numbers

    def potential(self, r: Any) -> Any:
        return expm2(self.rate * r) / (self.rate * self.rate)

    def tension(self, r: Any) -> Any:
        return expm1(self.rate * r) / self.rate

    def stiffness(self, r: Any) -> Any:
        return 1 + expm1(self.rate * r)

    def anharmonic_tension(self, r: Any) -> Any:
        return expm2(self.rate * r) / self.rate

    def anharmonic_stiffness(self, r: Any) -> Any:
        return expm1(self.rate * r)


@dataclass(frozen=True, repr=False)
class Toda(Potential):
    """V = (e^(2ar) - 1 - 2ar)/(4a^2)."""

    kind = "toda"

    a: Fraction

    @property
    def parameters(self) -> tuple[Fraction, ...]:
        return (self.a,)

    def coefficient(self, n: int) -> Fraction:
        return (2 * self.a) ** (n - 2) / factorial(n - 1)

    def growths(self) -> tuple[Growth, ...]:
        rate = 2 * self.a
        return (Growth(1 / rate, Fraction(0), rate),)

    def law(self, numbers: Arithmetic) -> Law:
        return TodaLaw(numbers.number(2 * self.a))

    def expression(self, r: Any) -> Any:
        import sympy

        rate = sympy.Rational(2 * self.a.numerator, self.a.denominator)
        return (sympy.exp(rate * r) - 1 - rate * r) / rate**2


@public
def toda(a: Number) -> Toda:
    """Toda's potential V = (e^(2ar) - 1 - 2ar)/(4a^2) of a bond; c_3 = a, c_4 = 2a^2/3.

    a : an exact number, not zero; dimensionless. With alpha = a the FPU chain agrees to third
        order in the amplitudes, with beta = 2a^2/3 too to fourth.

    Ours. Raises InputError where a is zero or no number of size 1e-50 to 1e50.

    >>> from symfpu import Chain
    >>> Chain(N=8, potential=toda("1/2"))
    Chain(N=8, potential=toda(0.5))
    """
    return Toda(checked_coupling(a, "a", zero=False))
