"""V(r) of a bond for printers of source code, accurate at any stretch.

A polynomial is itself. Of others the closed form loses digits where r is small, as e^r - 1 - r
does: up to some reach there is a Taylor polynomial in its place. Its remainder is bounded by the
differential equations of the potential: of (1 + slope r) g' = rate g the coefficients obey
g_(k+1) = g_k (rate - k slope)/(k + 1), so from the K-th on each is at most q times the one before,
q the larger of |slope| and (|rate| + K |slope|)/(K + 1), and what is cut off at K is less than
|g_K| |r|^K/(1 - q |r|). Potentials without such equations are measured against their closed form
at the reach, where the remainder is largest.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import mpmath
import sympy

from symfpu.chain.chain import Chain
from symfpu.chain.potentials.potential import Growth, Potential

STRETCH = sympy.Symbol("r", real=True)
HIGHEST_POWER = 30  # of r in the Taylor polynomial
REMAINDER = Fraction(1, 2**56)  # relative to r^2/2
SMALLEST_REACH, LARGEST_REACH = -240, 240  # powers of two
MEASURED_DIGITS = 60


@dataclass(frozen=True)
class BondPotential:
    """coefficients : of r^3, r^4, ... in V, which is r^2/2 + ... for |r| up to 2^reach.

    closed : V beyond, an expression in STRETCH; None for a polynomial, which has no reach.
    """

    coefficients: tuple[Fraction, ...]
    closed: Any = None
    reach: int | None = None

    def taylor(self) -> Any:
        """The Taylor polynomial in Horner's form, its coefficients the nearest doubles."""
        numbers = [sympy.Float(float(c), 17) for c in self.coefficients]
        return _horner(numbers)

    def exactly(self) -> Any:
        """V itself, with exact numbers."""
        if self.closed is not None:
            return self.closed
        numbers = [sympy.Rational(c.numerator, c.denominator) for c in self.coefficients]
        return _horner(numbers)


def _horner(numbers: list[Any]) -> Any:
    value = sympy.Integer(0)
    for number in reversed(numbers):
        value = number + STRETCH * value
    return STRETCH**2 * (sympy.Rational(1, 2) + STRETCH * value)


def bond_potential(chain: Chain) -> BondPotential | None:
    """That of a chain; None for an FPU chain, whose couplings the templates hold."""
    potential = chain.potential
    if chain.fpu:
        return None
    if potential.degree is not None:
        return BondPotential(_coefficients(potential, potential.degree))
    reach = _reach(potential)
    coefficients = _coefficients(potential, HIGHEST_POWER)
    return BondPotential(coefficients, potential.expression(STRETCH), reach)


def _coefficients(potential: Potential, highest: int) -> tuple[Fraction, ...]:
    return tuple(potential.coefficient(n) / n for n in range(3, highest + 1))


def _reach(potential: Potential) -> int:
    """The largest power of two up to which the Taylor polynomial is as good as V."""
    growths = potential.growths()
    good = _bounded(growths) if growths else _measured(potential)
    powers = range(LARGEST_REACH, SMALLEST_REACH, -1)
    return next(k for k in powers if good(Fraction(2) ** k))


def _bounded(growths: tuple[Growth, ...]) -> Any:
    """Whether the remainder of V is small up to a stretch, by its bound."""
    K = HIGHEST_POWER
    last = [(abs(g.weight * _coefficient(g, K)), _ratio(g, K)) for g in growths]

    def good(r: Fraction) -> bool:
        if any(q * r >= 1 for _, q in last):
            return False
        # the tension is cut off at r^K, V at r^(K+1), and r^2/2 is divided out
        tail = sum(size / (1 - q * r) for size, q in last)
        return 2 * tail * r ** (K - 1) / (K + 1) <= REMAINDER

    return good


def _coefficient(growth: Growth, n: int) -> Fraction:
    """g_n."""
    value = Fraction(1)
    for k in range(n):
        value *= (growth.rate - k * growth.slope) / (k + 1)
    return value


def _ratio(growth: Growth, n: int) -> Fraction:
    """What |g_(k+1)/g_k| does not exceed for k from n on."""
    slope = abs(growth.slope)
    return max(slope, (abs(growth.rate) + n * slope) / (n + 1))


def _measured(potential: Potential) -> Any:
    """Whether the remainder of V is small at a stretch and its opposite, against V itself."""
    V = sympy.lambdify(STRETCH, potential.expression(STRETCH), "mpmath")
    coefficients = [Fraction(1, 2), *_coefficients(potential, HIGHEST_POWER)]

    def small_at(r: Fraction) -> bool:
        lost = 2 * abs(r.numerator.bit_length() - r.denominator.bit_length())
        with mpmath.workprec(lost + int(MEASURED_DIGITS * 3.33)):
            x = mpmath.mpf(r.numerator) / r.denominator
            taylor = sum(
                mpmath.mpf(c.numerator) / c.denominator * x**n
                for n, c in enumerate(coefficients, 2)
            )
            difference = mpmath.mpc(V(x) - taylor)
            return bool(abs(difference) <= x**2 / 2 * mpmath.mpf(float(REMAINDER)))

    def good(r: Fraction) -> bool:
        try:
            return small_at(r) and small_at(-r)
        except (ArithmeticError, ValueError):
            return False

    return good
