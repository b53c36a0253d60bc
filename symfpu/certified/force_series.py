"""The anharmonic tension of a bond as a polynomial and a bound of what is left out.

phi(r) = V'(r) - r. A polynomial potential leaves nothing out. Toda's, Morse's and Lennard-Jones's
tensions are sums of weight (g - 1) with (1 + slope r) g' = rate g, g(0) = 1, whose coefficients
obey g_(k+1) = g_k (rate - slope k)/(k+1): below those of a geometric series from any k on. Ours.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import flint

from symfpu.chain.chain import Chain
from symfpu.chain.potentials.potential import Growth

HIGHEST_DEGREE = 160  # of the polynomial that stands for a series


def power(x: Any, k: int) -> Any:
    """x^k by products, k from 1 up: arb's own of a ball about zero is no number."""
    result = x
    for _ in range(k - 1):
        result = result * x
    return result


def ball(value: Fraction | int) -> Any:
    """A ball that holds an exact number."""
    return flint.arb(flint.fmpq(value.numerator, value.denominator))


@dataclass(frozen=True)
class ForceSeries:
    """phi by power of r, and the functions whose powers beyond `degree` are left out."""

    powers: dict[int, Fraction]
    growths: tuple[Growth, ...]
    degree: int

    def potential(self, r: Any) -> Any:
        """The integral of phi from 0 to a ball, without what is left out."""
        terms = (ball(c) * power(r, k + 1) / (k + 1) for k, c in self.powers.items())
        return r * r / 2 + sum(terms, flint.arb(0))

    def slope_bound(self, x: Any) -> Any:
        """Above |phi'(r)|_nu where |r|_nu is at most x."""
        terms = (ball(abs(c)) * k * x ** (k - 1) for k, c in self.powers.items())
        return sum(terms, self.left_out(x, 1))

    def curvature_bound(self, x: Any) -> Any:
        """Above |phi''(r)|_nu where |r|_nu is at most x."""
        terms = (ball(abs(c)) * k * (k - 1) * x ** (k - 2) for k, c in self.powers.items())
        return sum(terms, self.left_out(x, 2))

    def virial_terms(self) -> dict[int, Fraction]:
        """The derivative of V + r V'/2 by power of r."""
        terms = {k: c * Fraction(k + 3, 2) for k, c in self.powers.items()}
        return {1: Fraction(2), **terms}

    def virial_left_out(self, x: Any) -> Any:
        """Above the norm of what that leaves out."""
        return (3 * self.left_out(x, 0) + x * self.left_out(x, 1)) / 2

    def virial_slope_bound(self, x: Any) -> Any:
        """Above the norm of its derivative, 2 + 2 phi' + r phi''/2, where |r|_nu is at most x."""
        return 2 + 2 * self.slope_bound(x) + x * self.curvature_bound(x) / 2

    def left_out(self, x: Any, derivative: int) -> Any:
        """Above the norm of a derivative of phi minus its polynomial, where |r|_nu <= x."""
        parts = (of_growth(g, self.degree + 1, x, derivative) for g in self.growths)
        return sum(parts, flint.arb(0))


def of_growth(growth: Growth, first: int, x: Any, derivative: int) -> Any:
    """Above the sum of |weight g_k| k (k-1) .. x^(k - derivative) over k from `first` on."""
    size = growth_size(growth, first, derivative)
    ratio = growth_ratio(growth, first, derivative) * x
    if not ratio < 1:
        return flint.arb("inf")
    return ball(size) * x ** (first - derivative) / (1 - ratio)


@cache
def growth_size(growth: Growth, first: int, derivative: int) -> Fraction:
    """|weight g_k| k (k-1) .. of the first k."""
    size = abs(growth.weight)
    for k in range(first):
        size *= abs(growth.rate - growth.slope * k) / (k + 1)
    for i in range(derivative):
        size *= first - i
    return size


def growth_ratio(growth: Growth, first: int, derivative: int) -> Any:
    """Above the ratio of neighbours of that sum over x."""
    slope, rate = abs(growth.slope), abs(growth.rate)
    largest = max(slope, (rate + slope * first) / (first + 1))
    return ball(largest * Fraction(first + 1, first + 1 - derivative))


def force_series(chain: Chain, largest: float, bits: int) -> ForceSeries:
    """The polynomial whose rest is below 2^-bits for stretches of norm up to `largest`.

    As far as HIGHEST_DEGREE goes.
    """
    potential = chain.potential
    if potential.degree is not None:
        return ForceSeries(powers_of(chain, potential.degree - 1), (), potential.degree - 1)
    x, degree = flint.arb(largest), 2
    while degree < HIGHEST_DEGREE:
        rest = ForceSeries({}, potential.growths(), degree).left_out(x, 0)
        if rest < flint.arb(2) ** -bits:
            break
        degree += 1
    return ForceSeries(powers_of(chain, degree), potential.growths(), degree)


def powers_of(chain: Chain, degree: int) -> dict[int, Fraction]:
    """The coefficients of phi that are not zero, up to a degree."""
    found = {k: chain.potential.coefficient(k + 1) for k in range(2, degree + 1)}
    return {k: c for k, c in found.items() if c}
