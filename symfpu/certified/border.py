"""One more unknown, the square of the frequency, and one more equation that fixes an orbit.

The unknown is m with omega^2 = 2^-unknown_places m. The equation G = 0 gives the amplitude, the
energy or the frequency:

    amplitude: c_s[1] = A sqrt(2/N) Omega_s,   frequency: m = 2^unknown_places omega^2,
    energy: 2^-equation_places (mean of sum_j (V(r_j) + r_j V'(r_j)/2) - H) = 0.

The mean of the kinetic energy is that of r V'/2 on every periodic orbit, the virial theorem; so
the last equation has no derivatives, and its row falls with the harmonics as the orbit does.
Along a segment the value moves with s in -1 .. 1 by `change` s. Ours; docs/existence.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint

from symfpu.certified.bond_balls import BondBalls
from symfpu.certified.force_series import ball

FREQUENCY, AMPLITUDE, ENERGY = "frequency", "amplitude", "energy"


@dataclass(frozen=True)
class Fixed:
    """What an orbit has exactly, or along a segment: value - half_width .. value + half_width."""

    kind: str
    value: Fraction
    half_width: Fraction = Fraction(0)

    @property
    def bordered(self) -> bool:
        """Whether the frequency is an unknown."""
        return self.kind != FREQUENCY or self.half_width > 0


@dataclass(frozen=True, eq=False)
class Border:
    """The row and the column, at an orbit, in balls.

    residual : G. change : its derivative by s, negated. of_seed : of G by c_s[1] alone. rows : of G
        by every c_q[n], by harmonic; beyond : above nu^n times any later one. corner : of G by m.
    """

    fixed: Fixed
    unknown_places: int
    equation_places: int
    residual: Any
    change: Any
    of_seed: int
    rows: list[list[Any]]
    beyond: Any
    corner: int

    @property
    def unit(self) -> Any:
        """omega^2 of m = 1."""
        return power_of_two(-self.unknown_places)

    def curvature(self, balls: BondBalls, radius: Any) -> Any:
        """Above |DG(c + b) h - DG(c) h| / (|b| |h|) for |b| up to the radius."""
        if self.fixed.kind != ENERGY:
            return flint.arb(0)
        bounds = (balls.force.virial_slope_bound(x + radius) for x in balls.norms)
        total = sum(bounds, flint.arb(0)) * balls.layout.copies
        return total * power_of_two(-self.equation_places)


def residual_of(balls: BondBalls, fixed: Fixed, equation_places: int) -> Any:
    """G at an orbit."""
    orbit = balls.orbit
    if fixed.kind == FREQUENCY:
        return flint.arb(0)
    if fixed.kind == AMPLITUDE:
        c = power_of_two(-orbit.bits) * orbit.rows[1][orbit.layout.place]
        return c - ball(fixed.value) * balls.unit_of_amplitude()
    return (balls.mean_energy() - ball(fixed.value)) * power_of_two(-equation_places)


def power_of_two(exponent: int) -> Any:
    """2^exponent as a ball."""
    return flint.arb(2) ** exponent


def border_of(balls: BondBalls, fixed: Fixed) -> Border:
    """The row and the column at an orbit; scaled so that their largest entries are about 1."""
    orbit = balls.orbit
    rows, linear = orbit.floats, [float(x) for x in balls.linear]
    column = [
        n**2 * abs(x) / linear[q] for n, row in enumerate(rows) for q, x in enumerate(row)
    ]
    unknown_places = round(math.log2(max(column)))
    none, zero = [[flint.arb(0)] * orbit.layout.modes], flint.arb(0)
    if fixed.kind == FREQUENCY:
        width = 2 * orbit.omega * fixed.half_width + fixed.half_width**2
        change = ball(width) * power_of_two(unknown_places)
        return Border(fixed, unknown_places, 0, zero, change, 0, none, zero, 1)
    if fixed.kind == AMPLITUDE:
        residual = residual_of(balls, fixed, 0)
        change = ball(fixed.half_width) * balls.unit_of_amplitude()
        return Border(fixed, unknown_places, 0, residual, change, 1, none, zero, 0)
    return energy_border(balls, fixed, unknown_places)


def energy_border(balls: BondBalls, fixed: Fixed, unknown_places: int) -> Border:
    """That of a given energy."""
    series, lost = balls.virial_gradients()
    rows = balls.of_modes(series)
    lost *= balls.layout.copies
    half = ball(balls.layout.copies / balls.layout.share / 2)
    for n, row in enumerate(rows):
        rows[n] = [x * half * (1 if n else 2) for x in row]
    size = max(abs(float(x)) for row in rows for x in row)
    places = round(math.log2(size))
    unit = power_of_two(-places)
    power = unit
    for n, row in enumerate(rows):
        rows[n] = [x * unit + flint.arb(0, lost * power) for x in row]
        power /= balls.nu
    return Border(
        fixed=fixed,
        unknown_places=unknown_places,
        equation_places=places,
        residual=residual_of(balls, fixed, places),
        change=ball(fixed.half_width) * unit,
        of_seed=0,
        rows=rows,
        beyond=lost * unit,
        corner=0,
    )
