"""The bounds Y, Z0 + Z1 and Z2 of a proof of existence, and the radii that follow.

Y in balls with more digits than the orbit, the rest in doubles whose rounding is bounded. Ours;
docs/existence.md has the theorem.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.bond_balls import BondBalls, ball
from symfpu.breathers.contraction import Contraction, LinearPart, contraction
from symfpu.breathers.rounded_orbit import RoundedOrbit

Floats = NDArray[np.float64]

FIRST_CUT = 1e-4  # norm of the slopes that may be cut
CUT_SHARE = 0.02  # of Z1 that may come from that
CUTS = 6  # attempts at a cut: rounding of the slopes to doubles may not allow it
SLACK = 1.01  # of Z1 and Z2, and RADIUS_SLACK of r, so that coarser bounds suffice
RADIUS_SLACK = 1.25
SHRINK = 0.9
MOST_RATE = 0.99  # Z1 + Z2 R that uniqueness is claimed for
SPARE_BITS = 64
MANTISSA = 20  # bits of the radii


@dataclass(frozen=True, eq=False)
class ProofBounds:
    """What the theorem asks for.

    residual : Y, a ball; beyond : the part of it from harmonics beyond the last of the orbit.
    linear : Z0 + Z1. curvature : Z2 without the radius, at 0.
    """

    residual: Any
    beyond: Any
    linear: float
    found: Contraction
    balls: BondBalls

    def curvature(self, radius: Any) -> Any:
        """Z2 for points within the radius."""
        orbit = self.balls.orbit
        total = flint.arb(0)
        for bond in self.balls.stretches:
            size = self.balls.norm(bond) + radius
            for k, c in orbit.powers.items():
                total += ball(abs(c)) * k * (k - 1) * size ** (k - 2)
        return total * 2 / orbit.chain.N * flint.arb(self.found.spread)

    def rate(self, radius: Any) -> Any:
        """The contraction within the radius."""
        return SLACK * (self.linear + self.curvature(radius) * radius)


def strip(orbit: RoundedOrbit) -> Fraction:
    """nu = 1 + 2^-j such that its power of the last harmonic is about e^2 at most."""
    places = math.ceil(math.log2(max(orbit.harmonics / 2, 2)))
    return 1 + Fraction(1, 2**places)


def proof_bounds(orbit: RoundedOrbit) -> tuple[ProofBounds | None, float]:
    """The bounds, and Z0 + Z1 or what is nearest to it; None where that is not below 1.

    At the working precision of python-flint.
    """
    balls = BondBalls(orbit, strip(orbit))
    found, linear, share = None, math.inf, 0.0
    cut = FIRST_CUT
    for _ in range(CUTS):
        found, linear = contraction(linear_part(balls, cut))
        if found is None:
            return None, linear
        share = 2 / orbit.chain.N * found.spread * found.part.rest
        if share <= CUT_SHARE:
            break
        cut *= CUT_SHARE / (2 * share)
    if found is None or SLACK * (linear + share) >= 1:
        return None, linear + share
    residual, beyond = newton_step(balls, found)
    return ProofBounds(residual, beyond, linear + share, found, balls), linear + share


def linear_part(balls: BondBalls, cut: float) -> LinearPart:
    """DF with so many harmonics of the slopes that the norm of the rest is below the cut."""
    orbit, nu = balls.orbit, float(balls.nu)
    slopes = balls.slopes()
    halves = np.array([[float(a.mid()) for a in bond] for bond in slopes]).T
    halves[1:] /= 2
    sizes = np.abs(halves).sum(axis=1) * nu ** np.arange(len(halves))
    tails = np.cumsum(sizes[::-1])[::-1]
    small = np.flatnonzero(tails < cut / 4)
    length = max(int(small[0]) if len(small) else len(halves), 2)
    kept = halves[:length]
    rest = flint.arb(0)
    for j, bond in enumerate(slopes):
        left = list(bond)
        for k in range(min(length, len(bond))):
            left[k] = bond[k] - flint.arb(float(kept[k, j])) * (2 if k else 1)
        rest += balls.norm(left)
    omega = float(orbit.omega)
    return LinearPart(orbit.chain, orbit.seed, omega, nu, kept, double_above(rest))


def newton_step(balls: BondBalls, found: Contraction) -> tuple[Any, Any]:
    """Y, above the norm of A F, and its part from harmonics that the orbit does not have."""
    places = zip(found.places.n.tolist(), found.places.q.tolist(), strict=True)
    norms = dict(zip(places, found.columns_of_inverse.tolist(), strict=True))
    last, harmonics = int(found.places.n.max()), balls.orbit.harmonics
    total = beyond = flint.arb(0)
    power = flint.arb(1)
    for n, row in enumerate(balls.residual()):
        of_harmonic = flint.arb(0)
        for q, value in enumerate(row, 1):
            norm = float(found.beyond[q - 1]) if n > last else norms.get((n, q), 0.0)
            of_harmonic += abs(value) * norm  # places without a norm are zero by symmetry
        total += of_harmonic * power
        if n > harmonics:
            beyond += of_harmonic * power
        power *= balls.nu
    return total, beyond


@dataclass(frozen=True)
class Radii:
    """r of existence and R of uniqueness as [mantissa, places], m 2^-places; R at most 1."""

    existence: tuple[int, int]
    uniqueness: tuple[int, int]


def radii(bounds: ProofBounds) -> Radii | None:
    """The radii that the bounds allow; None where there are none."""
    unique = flint.arb(1)
    while not bounds.rate(unique) < MOST_RATE:
        unique *= SHRINK
        if unique < bounds.residual:
            return None
    unique_pair = dyadic(unique, above=False)
    radius = bounds.residual * RADIUS_SLACK / (1 - SLACK * bounds.linear)
    pair = dyadic(radius, above=True)
    radius, unique = ball(of_dyadic(pair)), ball(of_dyadic(unique_pair))
    reached = SLACK * bounds.residual + bounds.rate(radius) * radius
    if reached <= radius and radius <= unique:
        return Radii(pair, unique_pair)
    return None


def dyadic(x: Any, *, above: bool) -> tuple[int, int]:
    """A positive ball rounded up or down to a mantissa of few bits."""
    end = x.upper() if above else x.lower()
    mantissa, exponent = end.man_exp()
    mantissa, exponent = int(mantissa), int(exponent)
    drop = mantissa.bit_length() - MANTISSA
    if drop > 0:
        mantissa = (mantissa >> drop) + int(above)
        exponent += drop
    if exponent > 0:
        mantissa, exponent = mantissa << exponent, 0
    return mantissa, -exponent


def of_dyadic(pair: tuple[int, int]) -> Fraction:
    """m 2^-places."""
    mantissa, places = pair
    return Fraction(mantissa, 2**places)


def double_above(x: Any) -> float:
    """A double above a ball."""
    return math.nextafter(float(x.upper()), math.inf)
