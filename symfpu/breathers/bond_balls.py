"""Cosine series of bonds in balls (python-flint's arb): powers, norms, the residual, the energy.

The norm of sum_n a_n cos(n theta) is sum |a_n| nu^n, nu > 1; that of a product is at most the
product of the norms. A series is held as the palindromic polynomial sum_n d_|n| z^n with d_0 = a_0
and d_n = a_n / 2; every coefficient is a ball that holds the true one.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import flint

from symfpu.breathers.rounded_orbit import RoundedOrbit

Series = list[Any]  # cosine coefficients a_0, a_1, ..., balls


def ball(value: Fraction | int) -> Any:
    """A ball that holds an exact number."""
    return flint.arb(flint.fmpq(value.numerator, value.denominator))


class BondBalls:
    """The stretches of all bonds along an orbit, at the working precision of python-flint."""

    def __init__(self, orbit: RoundedOrbit, nu: Fraction) -> None:
        self.orbit, N = orbit, orbit.chain.N
        self.strip, self.nu = nu, ball(nu)
        cosines = [flint.arb.cos_pi_fmpq(flint.fmpq(k, 2 * N)) for k in range(4 * N)]
        self.table = flint.arb_mat(
            [[cosines[q * (2 * j + 1) % (4 * N)] for j in range(N)] for q in range(1, N)]
        )
        unit = flint.arb(2) ** -orbit.bits
        rows = [[unit * x for x in row] for row in orbit.rows]
        stretches = (flint.arb_mat(rows) * self.table).tolist()
        self.stretches: list[Series] = [list(bond) for bond in zip(*stretches, strict=True)]
        self.squared = ball(orbit.omega) ** 2
        half = [flint.fmpq(q, 2 * N) for q in range(1, N)]
        self.linear = [4 * flint.arb.sin_pi_fmpq(x) ** 2 for x in half]

    def norm(self, series: Series) -> Any:
        """sum |a_n| nu^n."""
        total = flint.arb(0)
        for a in reversed(series):
            total = total * self.nu + abs(a)
        return total

    def forces(self) -> list[Series]:
        """phi(r_j) of every bond."""
        terms = {k: ball(coupling) for k, coupling in self.orbit.powers.items()}
        return [_polynomial(bond, terms) for bond in self.stretches]

    def slopes(self) -> list[Series]:
        """phi'(r_j) of every bond."""
        powers = self.orbit.powers.items()
        terms = {k - 1: ball(k * coupling) for k, coupling in powers}
        return [_polynomial(bond, terms) for bond in self.stretches]

    def residual(self) -> list[list[Any]]:
        """F_q[n], rows n from 0 to the highest harmonic that is not zero, columns q."""
        N, forces = self.orbit.chain.N, self.forces()
        harmonics = max(map(len, forces))
        padded = [force + [flint.arb(0)] * (harmonics - len(force)) for force in forces]
        of_modes = (self.table * flint.arb_mat(padded) * (flint.arb(2) / N)).transpose()
        rows: list[list[Any]] = of_modes.tolist()
        unit = flint.arb(2) ** -self.orbit.bits
        for n, row in enumerate(self.orbit.rows):
            for place, x in enumerate(row):
                divisor = 1 - n**2 * self.squared / self.linear[place]
                rows[n][place] += divisor * x * unit
        return rows

    def energy(self, radius: Any) -> Any:
        """H at t = 0, where no stretch is further than the radius from that of the orbit."""
        around = flint.arb(0, radius)
        total = flint.arb(0)
        for bond in self.stretches:
            r = sum(bond, flint.arb(0)) + around
            total += r**2 / 2
            for k, coupling in self.orbit.powers.items():
                total += ball(coupling) * r ** (k + 1) / (k + 1)
        return total

    def amplitude(self, radius: Any) -> Any:
        """A = sqrt(N/2) c_seed[1] / Omega_seed with c within the radius."""
        seed = self.orbit.seed
        c = flint.arb(2) ** -self.orbit.bits * self.orbit.rows[1][seed - 1]
        around = flint.arb(0, radius)
        half = ball(Fraction(self.orbit.chain.N, 2))
        return (c + around) * (half / self.linear[seed - 1]).sqrt()


def _polynomial(series: Series, terms: dict[int, Any]) -> Series:
    """sum terms[k] series^k as a cosine series; k from 1 up."""
    last = len(series) - 1
    halves = [a / 2 for a in series[:0:-1]]
    first = flint.arb_poly([*halves, series[0], *reversed(halves)])
    power, middle = first, last
    total = [flint.arb(0)] * (max(terms, default=0) * last + 1)
    for k in range(1, max(terms, default=0) + 1):
        if k > 1:
            power, middle = power * first, middle + last
        if k in terms:
            total[0] += terms[k] * power[middle]
            for n in range(1, middle + 1):
                total[n] += 2 * terms[k] * power[middle + n]
    return total
