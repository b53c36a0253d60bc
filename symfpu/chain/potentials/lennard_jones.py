"""The potentials of Lennard-Jones and Mie: two powers of the length of a bond."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple

from symfpu.chain.bonds import Law
from symfpu.chain.potentials.potential import Growth, Potential, checked_coupling
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Arithmetic
from symfpu.numbers.functions import expm1, expm2, log1p
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, decimal

OTHER_NAMES = ("lj",)


class LennardJonesLaw(NamedTuple):
    """The functions of a bond; m > n. All goes by the logarithm l of the length 1 + r."""

    m: Any
    n: Any

    @staticmethod
    def takes_lanes() -> bool:
        return True  # its functions take lanes of numbers

    def potential(self, r: Any) -> Any:
        m, n, l = self.m, self.n, log1p(r)
        return (expm2(-m * l) / m - expm2(-n * l) / n) / (m - n)

    def tension(self, r: Any) -> Any:
        m, n, l = self.m, self.n, log1p(r)
        return -(1 + expm1(-(n + 1) * l)) * expm1(-(m - n) * l) / (m - n)

    def stiffness(self, r: Any) -> Any:
        m, n, l = self.m, self.n, log1p(r)
        steep, flat = (m + 1) * expm1(-(m + 2) * l), (n + 1) * expm1(-(n + 2) * l)
        return 1 + (steep - flat) / (m - n)

    def anharmonic_tension(self, r: Any) -> Any:
        m, n, l = self.m, self.n, log1p(r)
        powers = expm2(-(n + 1) * l) - expm2(-(m + 1) * l)
        return powers / (m - n) - expm2(l)

    def anharmonic_stiffness(self, r: Any) -> Any:
        m, n, l = self.m, self.n, log1p(r)
        steep, flat = (m + 1) * expm1(-(m + 2) * l), (n + 1) * expm1(-(n + 2) * l)
        return (steep - flat) / (m - n)


@dataclass(frozen=True, repr=False)
class LennardJones(Potential):
    """V = [((1+r)^-m - 1)/m - ((1+r)^-n - 1)/n]/(m - n), m > n."""

    kind = "lennard_jones"
    wall = -1.0

    m: Fraction
    n: Fraction

    @property
    def parameters(self) -> tuple[Fraction, ...]:
        return self.m, self.n

    def coefficient(self, n: int) -> Fraction:
        steep, flat = (_binomial(-p - 1, n - 1) for p in (self.m, self.n))
        return (flat - steep) / (self.m - self.n)

    def growths(self) -> tuple[Growth, ...]:
        weight, one = 1 / (self.m - self.n), Fraction(1)
        steep = Growth(-weight, one, -self.m - 1)
        return Growth(weight, one, -self.n - 1), steep

    def law(self, numbers: Arithmetic) -> Law:
        return LennardJonesLaw(numbers.number(self.m), numbers.number(self.n))

    def expression(self, r: Any) -> Any:
        import sympy

        m, n = (sympy.Rational(p.numerator, p.denominator) for p in (self.m, self.n))
        steep, flat = (((1 + r) ** -p - 1) / p for p in (m, n))
        return (steep - flat) / (m - n)


def _binomial(power: Fraction, k: int) -> Fraction:
    """The coefficient of r^k in (1 + r)^power, power < 0."""
    if power.denominator == 1:
        return Fraction((-1) ** k * math.comb(k - 1 - power.numerator, k))
    factors = (power.numerator - i * power.denominator for i in range(k))
    return Fraction(math.prod(factors), power.denominator**k * math.factorial(k))


@public
def lennard_jones(m: Number = 12, n: Number = 6) -> LennardJones:
    """The potential of Mie, m = 12 and n = 6 that of Lennard-Jones, of a bond.

    V = [((1+r)^-m - 1)/m - ((1+r)^-n - 1)/n]/(m - n): the unit of length is the bond at rest, and
    the stiffness there is one. c_3 = -(m + n + 3)/2; V is infinite at r = -1.

    m, n : exact numbers, m > n > 0; dimensionless.

    Ours. Raises InputError for others.

    >>> from symfpu import Chain
    >>> Chain(N=8, potential=lennard_jones(12, 6))
    Chain(N=8, potential=lennard_jones(12, 6))
    """
    powers = [checked_coupling(p, name) for p, name in ((m, "m"), (n, "n"))]
    if not powers[0] > powers[1] > 0:
        typed = ", ".join(map(decimal, powers))
        raise InputError("m, n", typed, "numbers m > n > 0", "write lennard_jones(12, 6)")
    return LennardJones(*powers)
