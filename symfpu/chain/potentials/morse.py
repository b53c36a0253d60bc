"""Morse's potential: a bond that breaks."""

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


class MorseLaw(NamedTuple):
    """The functions of a bond."""

    a: Any

    @staticmethod
    def takes_lanes() -> bool:
        return True  # its functions take lanes of numbers

    def potential(self, r: Any) -> Any:
        below = expm1(-self.a * r) / self.a
        return below * below / 2

    def tension(self, r: Any) -> Any:
        below = expm1(-self.a * r)
        return -(1 + below) * below / self.a

    def stiffness(self, r: Any) -> Any:
        return 1 + (2 * expm1(-2 * self.a * r) - expm1(-self.a * r))

    def anharmonic_tension(self, r: Any) -> Any:
        return (expm2(-self.a * r) - expm2(-2 * self.a * r)) / self.a

    def anharmonic_stiffness(self, r: Any) -> Any:
        return 2 * expm1(-2 * self.a * r) - expm1(-self.a * r)


@dataclass(frozen=True, repr=False)
class Morse(Potential):
    """V = (1 - e^(-ar))^2/(2a^2)."""

    kind = "morse"

    a: Fraction

    @property
    def parameters(self) -> tuple[Fraction, ...]:
        return (self.a,)

    def coefficient(self, n: int) -> Fraction:
        powers = (-self.a) ** (n - 1), (-2 * self.a) ** (n - 1)
        return (powers[0] - powers[1]) / (self.a * factorial(n - 1))

    def growths(self) -> tuple[Growth, ...]:
        weight, flat = 1 / self.a, Fraction(0)
        return Growth(weight, flat, -self.a), Growth(-weight, flat, -2 * self.a)

    def law(self, numbers: Arithmetic) -> Law:
        return MorseLaw(numbers.number(self.a))

    def expression(self, r: Any) -> Any:
        import sympy

        a = sympy.Rational(self.a.numerator, self.a.denominator)
        return (1 - sympy.exp(-a * r)) ** 2 / (2 * a**2)


@public
def morse(a: Number) -> Morse:
    """Morse's potential V = (1 - e^(-ar))^2/(2a^2) of a bond; c_3 = -3a/2, c_4 = 7a^2/6.

    a : an exact number, not zero; dimensionless. The bond breaks at the energy 1/(2a^2).

    Ours. Raises InputError where a is zero or no number of size 1e-50 to 1e50.

    >>> from symfpu import Chain
    >>> Chain(N=8, potential=morse("1/2"))
    Chain(N=8, potential=morse(0.5))
    """
    return Morse(checked_coupling(a, "a", zero=False))
