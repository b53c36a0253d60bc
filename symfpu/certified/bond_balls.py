"""Cosine series of bonds in balls (python-flint's arb): powers, norms, the residual, the energy.

The norm of sum_n a_n cos(n theta) is sum |a_n| nu^n, nu > 1; that of a product is at most the
product of the norms. A series is held as the palindromic polynomial sum_n d_|n| z^n with d_0 = a_0
and d_n = a_n / 2; every coefficient is a ball that holds the true one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any

import flint
import numpy as np

from symfpu.certified.force_series import ball as ball
from symfpu.certified.force_series import force_series
from symfpu.certified.rounded_orbit import RoundedOrbit

SPARE_BITS = 64  # beyond those of the orbit

Rows = Sequence[Sequence[int]]
Series = list[Any]  # cosine coefficients a_0, a_1, ..., balls


class BondBalls:
    """The stretches of all bonds along an orbit, at the working precision of python-flint."""

    def __init__(self, orbit: RoundedOrbit, nu: Fraction) -> None:
        self.orbit, self.layout = orbit, orbit.layout
        self.strip, self.nu = nu, ball(nu)
        self.table = self.layout.table()
        unit = flint.arb(2) ** -orbit.bits
        self.stretches = self.on_bonds([[unit * x for x in row] for row in orbit.rows])
        self.norms = [self.norm(bond) for bond in self.stretches]
        largest = max(float(size.upper()) for size in self.norms)
        self.force = force_series(orbit.chain, largest, orbit.bits + SPARE_BITS // 2)
        self.squared = ball(orbit.omega) ** 2
        self.linear = self.layout.squares()

    def on_bonds(self, rows: list[list[Any]]) -> list[Series]:
        """sum_q c_q cos(q theta_j) of every bond; rows are harmonics, columns modes."""
        by_harmonic = (flint.arb_mat(rows) * self.table).tolist()
        return [list(bond) for bond in zip(*by_harmonic, strict=True)]

    def of_modes(self, bonds: list[Series]) -> list[list[Any]]:
        """share sum_j cos(q theta_j) f_j; rows are harmonics, columns modes."""
        harmonics = max(map(len, bonds))
        padded = [bond + [flint.arb(0)] * (harmonics - len(bond)) for bond in bonds]
        scaled = self.table * flint.arb_mat(padded) * ball(self.layout.share)
        rows: list[list[Any]] = scaled.transpose().tolist()
        for n, q in np.argwhere(~self.layout.allowed(harmonics - 1)).tolist():
            rows[n][q] = flint.arb(0)  # by symmetry, or where a wave has no equation
        return rows

    def norm(self, series: Series) -> Any:
        """sum |a_n| nu^n."""
        total = flint.arb(0)
        for a in reversed(series):
            total = total * self.nu + abs(a)
        return total

    def polynomials(self, couplings: dict[int, Fraction]) -> list[Series]:
        """sum couplings[k] r_j^k of every bond."""
        first = self.stretches[: self.layout.independent]
        return self.layout.all_bonds([_polynomial(bond, couplings) for bond in first])

    def forces(self) -> list[Series]:
        """phi(r_j) of every bond, without what `force` leaves out."""
        return self.polynomials(self.force.powers)

    def forces_left_out(self) -> Any:
        """Above the sum over bonds of the norms of what `force` leaves out."""
        return sum((self.force.left_out(x, 0) for x in self.norms), flint.arb(0))

    @cached_property
    def slopes(self) -> list[Series]:
        """phi'(r_j) of every bond, without what `force` leaves out."""
        terms = {k - 1: k * coupling for k, coupling in self.force.powers.items()}
        return self.polynomials(terms)

    def slopes_left_out(self) -> Any:
        """Above the sum over bonds of the norms of what `force` leaves out."""
        return sum((self.force.left_out(x, 1) for x in self.norms), flint.arb(0))

    def residual(self) -> list[list[Any]]:
        """F_q[n], rows n from 0 to the highest harmonic that is not zero, columns q."""
        rows = self.of_modes(self.forces())
        self.add_linear(rows, self.orbit.rows)
        return rows

    def add_linear(self, rows: list[list[Any]], integers: Rows) -> None:
        """lambda_q[n] c_q[n], c in units 2^-bits, added to rows."""
        unit = flint.arb(2) ** -self.orbit.bits
        for n, row in enumerate(integers):
            for place, x in enumerate(row):
                divisor = 1 - n**2 * self.squared / self.linear[place]
                rows[n][place] += divisor * x * unit

    def virial_gradients(self) -> tuple[list[Series], Any]:
        """The derivative of V + r V'/2 along every bond, and the norm of what is left out."""
        terms = self.force.virial_terms()
        lost = sum((self.force.virial_left_out(x) for x in self.norms), flint.arb(0))
        return self.polynomials(terms), lost

    def mean_energy(self) -> Any:
        """The mean of sum_j (V + r V'/2): H on a periodic orbit."""
        powers = self.force.powers.items()
        terms = {k: c * (Fraction(1, k + 1) + Fraction(1, 2)) for k, c in powers}
        series = self.polynomials({1: Fraction(1), **terms})
        total = flint.arb(0)
        for bond, size, other in zip(self.stretches, self.norms, series, strict=True):
            lost = flint.arb(0, 2 * size * self.force.left_out(size, 0))
            total += mean_of_product(bond, other) + lost
        return total * self.layout.copies

    def at_rest(self) -> list[Any]:
        """The stretches at t = 0."""
        return [sum(bond, flint.arb(0)) for bond in self.stretches]

    def energy_within(self, radii: list[Any]) -> Any:
        """H at t = 0 of fixed ends, every stretch within its radius of that of the orbit."""
        total = flint.arb(0)
        for r, size, radius in zip(self.at_rest(), self.norms, radii, strict=True):
            x = size + radius
            lost = flint.arb(0, x * self.force.left_out(x, 0))
            total += self.force.potential(r + flint.arb(0, radius)) + lost
        return total

    def mean_energy_within(self, radius: Any) -> Any:
        """The mean of sum_j (V + r V'/2), every series within the radius of that of the orbit.

        The derivative of V + r V'/2 is 0 at r = 0, so at most r times a bound of its derivative.
        """
        reached = [size + radius for size in self.norms]
        slopes = (x * self.force.virial_slope_bound(x) for x in reached)
        off = radius * self.layout.copies * sum(slopes, flint.arb(0))
        return self.mean_energy() + flint.arb(0, off)

    def unit_of_amplitude(self) -> Any:
        """c_s[1] of A = 1."""
        return (self.linear[self.layout.place] * ball(self.layout.of_amplitude)).sqrt()

    def amplitude(self, radius: Any) -> Any:
        """A with c_s[1] within the radius."""
        c = flint.arb(2) ** -self.orbit.bits * self.orbit.rows[1][self.layout.place]
        return (c + flint.arb(0, radius)) / self.unit_of_amplitude()


def _polynomial(series: Series, couplings: dict[int, Fraction]) -> Series:
    """sum couplings[k] series^k as a cosine series; k from 1 up.

    By Paterson's and Stockmeyer's rule: Horner's with a power of the series, whose coefficients
    are polynomials of lower powers.
    """
    if not couplings:
        return [flint.arb(0)]
    last, degree = len(series) - 1, max(couplings)
    width = math.isqrt(degree)
    powers = _powers(series, width)
    total, middle = flint.arb_poly([]), (width - 1) * last
    for first in range(degree - degree % width, -1, -width):
        if first + width <= degree:
            total *= powers[width]
            middle += width * last
        for i in range(width):
            if first + i in couplings:
                term = powers[i] * ball(couplings[first + i])
                total += term.left_shift(middle - i * last)
    return [total[middle], *(2 * total[middle + n] for n in range(1, middle + 1))]


def _powers(series: Series, highest: int) -> list[Any]:
    """The palindromes of series^0 .. series^highest, series^k in the middle at k times the last."""
    factor = _palindrome(series)
    powers = [flint.arb_poly([1]), factor]
    while len(powers) <= highest:
        powers.append(powers[-1] * factor)
    return powers


def product(a: Series, b: Series) -> Series:
    """Of two cosine series."""
    both = _palindrome(a) * _palindrome(b)
    middle = len(a) + len(b) - 2
    return [both[middle], *(2 * both[middle + n] for n in range(1, middle + 1))]


def _palindrome(series: Series) -> Any:
    """sum d_|n| z^n times z^last, d_0 = a_0 and d_n = a_n / 2."""
    halves = [a / 2 for a in series[:0:-1]]
    return flint.arb_poly([*halves, series[0], *reversed(halves)])


def mean_of_product(a: Series, b: Series) -> Any:
    """Over a period."""
    pairs = zip(a[1:], b[1:], strict=False)
    return a[0] * b[0] + sum((x * y for x, y in pairs), flint.arb(0)) / 2
