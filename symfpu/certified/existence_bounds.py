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

from symfpu.certified.bond_balls import BondBalls
from symfpu.certified.border import Border, Fixed, border_of
from symfpu.certified.contraction import (
    BorderLine,
    Contraction,
    LinearPart,
    contraction,
)
from symfpu.certified.force_series import ball
from symfpu.certified.layout import ROUNDOFF
from symfpu.certified.rounded_orbit import RoundedOrbit

Floats = NDArray[np.float64]

FIRST_CUT = 1e-4  # norm of the slopes that may be cut
CUT_SHARE = 0.02  # of Z1 that may come from that
CUTS = 6  # attempts at a cut: rounding of the slopes to doubles may not allow it
SLACK = 1.01  # of Z1 and Z2, and RADIUS_SLACK of r, so that coarser bounds suffice
RADIUS_SLACK = 1.25
SHRINK = 0.9
MOST_RATE = 0.99  # Z1 + Z2 R that uniqueness is claimed for
LEAST_STEP = 1e-300  # of Y, a double
MANTISSA = 20  # bits of the radii


@dataclass(frozen=True, eq=False)
class ProofBounds:
    """What the theorem asks for.

    newton : |A F| at the orbit, a ball; beyond : the part of it from harmonics beyond the last of
        the orbit. linear : Z0 + Z1. length, drift : of the line of a segment, else 0.
    """

    newton: Any
    beyond: Any
    linear: float
    found: Contraction
    balls: BondBalls
    border: Border | None
    length: Any = 0
    drift: Any = 0

    @property
    def residual(self) -> Any:
        """Y, at every orbit of the line."""
        bend = self.curvature(self.length) * self.length**2 / 2 if self.length else 0
        return self.newton + self.drift + bend

    def curvature(self, radius: Any) -> Any:
        """Z2 for points within the radius of the middle."""
        bounds = (self.balls.force.curvature_bound(x + radius) for x in self.balls.norms)
        total = sum(bounds, flint.arb(0))
        of_bonds = total * ball(self.balls.layout.share) * flint.arb(self.found.spread)
        if self.border is None:
            return of_bonds
        condition = flint.arb(float(self.found.columns_of_inverse[0]))
        of_condition = condition * self.border.curvature(self.balls, radius)
        return of_bonds + of_condition + flint.arb(self.found.of_frequency)

    def rate(self, radius: Any) -> Any:
        """The contraction within the radius of every orbit of the line."""
        reach = radius + self.length
        return SLACK * (self.linear + self.curvature(reach) * reach)


def strip(orbit: RoundedOrbit) -> Fraction:
    """nu = 1 + 2^-j such that its power of the last harmonic is about e^2 at most."""
    places = math.ceil(math.log2(max(orbit.harmonics / 2, 2)))
    return 1 + Fraction(1, 2**places)


def proof_bounds(orbit: RoundedOrbit, fixed: Fixed) -> tuple[ProofBounds | None, float]:
    """The bounds, and Z0 + Z1 or what is nearest to it; None where that is not below 1.

    At the working precision of python-flint.
    """
    balls = BondBalls(orbit, strip(orbit))
    border = border_of(balls, fixed) if fixed.bordered else None
    found, linear, share = None, math.inf, 0.0
    cut = FIRST_CUT
    for _ in range(CUTS):
        found, linear = contraction(linear_part(balls, cut, border))
        if found is None:
            return None, linear
        share = float(orbit.layout.share) * found.spread * found.part.rest
        if share <= CUT_SHARE:
            break
        cut *= CUT_SHARE / (2 * share)
    if found is None or SLACK * (linear + share) >= 1:
        return None, linear + share
    residual, beyond = newton_step(balls, found, border)
    bounds = ProofBounds(residual, beyond, linear + share, found, balls, border)
    return bounds, linear + share


def linear_part(balls: BondBalls, cut: float, border: Border | None = None) -> LinearPart:
    """DF with so many harmonics of the slopes that the norm of the rest is below the cut."""
    orbit, nu = balls.orbit, float(balls.nu)
    slopes = balls.slopes
    halves = np.array([[float(a.mid()) for a in bond] for bond in slopes]).T
    halves[1:] /= 2
    sizes = np.abs(halves).sum(axis=1) * nu ** np.arange(len(halves))
    tails = np.cumsum(sizes[::-1])[::-1]
    small = np.flatnonzero(tails < cut / 4)
    length = max(int(small[0]) if len(small) else len(halves), 2)
    kept = halves[:length]
    rest = balls.slopes_left_out()
    for j, bond in enumerate(slopes):
        left = list(bond)
        for k in range(min(length, len(bond))):
            left[k] = bond[k] - flint.arb(float(kept[k, j])) * (2 if k else 1)
        rest += balls.norm(left)
    omega = float(orbit.omega)
    line = None if border is None else border_line(balls, border)
    return LinearPart(orbit.layout, omega, nu, kept, double_above(rest), line)


def border_line(balls: BondBalls, border: Border) -> BorderLine:
    """The row and the column of an unknown frequency in doubles."""
    rows, linear = balls.orbit.floats, balls.layout.frequencies()
    unit = float(border.unit)
    n = np.arange(len(rows))[:, None]
    middles = np.array([[float(x.mid()) for x in row] for row in border.rows])
    errors = np.array([[double_above(x.rad()) for x in row] for row in border.rows])
    return BorderLine(
        seed=balls.layout.place + 1,
        unit=unit,
        of_seed=border.of_seed,
        rows=middles,
        row_errors=errors + ROUNDOFF * np.abs(middles),
        beyond=double_above(border.beyond),
        corner=border.corner,
        column=-(n**2) * rows / linear**2 * unit,
    )


def newton_step(
    balls: BondBalls, found: Contraction, border: Border | None
) -> tuple[Any, Any]:
    """Y, above the norm of A F, and its part from harmonics that the orbit does not have."""
    total, beyond = norm_of_image(balls, found, balls.residual())
    lost = balls.forces_left_out() * ball(balls.layout.share) * flint.arb(found.spread)
    if border is not None:
        lost += abs(border.residual) * float(found.columns_of_inverse[0])
    return total + lost, beyond


def norm_of_image(
    balls: BondBalls, found: Contraction, image: list[list[Any]]
) -> tuple[Any, Any]:
    """Above |A f| of rows by harmonic, and the part of harmonics beyond those of the orbit."""
    places = zip(found.places.n.tolist(), found.places.q.tolist(), strict=True)
    norms = dict(zip(places, found.columns_of_inverse.tolist(), strict=True))
    last, harmonics = int(found.places.n.max()), balls.orbit.harmonics
    total = beyond = flint.arb(0)
    power = flint.arb(1)
    for n, row in enumerate(image):
        of_harmonic = flint.arb(0)
        for q, value in enumerate(row, 1):
            norm = float(found.beyond[q - 1]) if n > last else norms.get((n, q), 0.0)
            of_harmonic += abs(value) * norm  # places without a norm are not allowed
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
    Y, least = bounds.residual, bounds.rate(flint.arb(0))
    unique = largest_unique(bounds, Y)
    if unique is None:
        return None
    unique_pair = dyadic(unique, above=False)
    unique, radius = ball(of_dyadic(unique_pair)), Y * RADIUS_SLACK / (1 - least)
    while radius <= unique:
        pair = dyadic(radius, above=True)
        rounded = ball(of_dyadic(pair))
        reached = SLACK * Y + bounds.rate(rounded) * rounded
        if reached <= rounded and rounded <= unique:
            return Radii(pair, unique_pair)
        radius *= RADIUS_SLACK
    return None


def largest_unique(bounds: ProofBounds, Y: Any) -> Any | None:
    """The largest SHRINK^k within which the map contracts, by halving; None if not above Y.

    The rate grows with the radius.
    """

    def contracts(k: int) -> bool:
        return bool(bounds.rate(flint.arb(SHRINK) ** k) < MOST_RATE)

    if contracts(0):
        return flint.arb(1)
    if not Y < 1:
        return None
    fails = 0
    holds = math.floor(math.log(max(double_above(Y), LEAST_STEP)) / math.log(SHRINK))
    if not contracts(holds):
        return None
    while holds - fails > 1:
        middle = (holds + fails) // 2
        if contracts(middle):
            holds = middle
        else:
            fails = middle
    return flint.arb(SHRINK) ** holds


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
