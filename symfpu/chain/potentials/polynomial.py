"""Polynomials: V = r^2/2 + sum c_n r^n/n; the FPU chains are those of degree 3 and 4."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from symfpu.chain.bonds import Law
from symfpu.chain.potentials.potential import Potential, checked_coupling
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Arithmetic
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number

OTHER_NAMES = ("poly",)
HIGHEST_DEGREE = 40


@dataclass(frozen=True, repr=False)
class Polynomial(Potential):
    """V = r^2/2 + c_3 r^3/3 + ... + c_n r^n/n."""

    kind = "polynomial"

    coefficients: tuple[Fraction, ...]

    @property
    def parameters(self) -> tuple[Fraction, ...]:
        return self.coefficients

    @property
    def degree(self) -> int:
        return len(self.coefficients) + 2

    @property
    def even(self) -> bool:
        return not any(self.coefficients[::2])

    def coefficient(self, n: int) -> Fraction:
        return self.coefficients[n - 3] if n <= self.degree else Fraction(0)

    def law(self, numbers: Arithmetic) -> Law:
        return tuple(numbers.number(c) for c in self.coefficients)

    def expression(self, r: Any) -> Any:
        import sympy

        total = r**2 / sympy.Integer(2)
        for n, c in enumerate(self.coefficients, 3):
            total += sympy.Rational(c.numerator, n * c.denominator) * r**n
        return total


@public
def polynomial(*coefficients: Number) -> Polynomial:
    """The potential V = r^2/2 + c_3 r^3/3 + c_4 r^4/4 + ... + c_n r^n/n of a bond.

    coefficients : c_3, c_4, ..., c_n, exact numbers, one at least not zero; dimensionless. So
        polynomial(alpha) and polynomial(alpha, beta) are the FPU chains (Eq. fpuham).

    Ours. Raises InputError where all are zero, one is no number of size 1e-50 to 1e50, or n is
    above 40.

    >>> from symfpu import Chain
    >>> Chain(N=8, potential=polynomial("1/3", 0, "1/5"))
    Chain(N=8, potential=polynomial(1/3, 0, 0.2))
    >>> Chain(N=8, potential=polynomial("1/3"))
    Chain(N=8, alpha=1/3)
    """
    values = [checked_coupling(c, f"c_{n}") for n, c in enumerate(coefficients, 3)]
    while values and not values[-1]:
        values.pop()
    if not 0 < len(values) <= HIGHEST_DEGREE - 2:
        allowed = f"numbers c_3, c_4, ... up to c_{HIGHEST_DEGREE}, one at least not zero"
        raise InputError("coefficients", coefficients, allowed, "write polynomial('1/3')")
    if len(values) == 1:
        values.append(Fraction(0))  # c_3 and c_4 are alpha and beta
    return Polynomial(tuple(values))
