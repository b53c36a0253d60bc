"""The equation G = 0 that fixes the amplitude, the energy or the frequency of an orbit.

amplitude: G = c_s[1] - A sqrt(2/N) Omega_s; energy: G = 2^-e (sum_j V(r_j(0)) - H);
frequency: G = m - 2^f omega^2, the unknown m being 2^f omega^2. Along a segment the value is
value + s half_width, s in -1 .. 1, of the frequency as far as its square goes at least.
"""

from fractions import Fraction
from math import isqrt
from typing import NamedTuple

from symfpu.proofs.check_existence.bonds import COARSE, Bonds
from symfpu.proofs.check_existence.claim import AMPLITUDE, ENERGY, FREQUENCY, Claim
from symfpu.proofs.check_existence.fixed_point import COSINE_UNITS, Cosines, up

Interval = tuple[Fraction, Fraction]
NOTHING = Fraction(0), Fraction(0)


class Condition(NamedTuple):
    """G at the orbit and its derivatives.

    residual : above |G|. change : ends of -dG/ds. of_seed : of G by c_s[1] alone. corner : by the
    unknown. of_modes : ends of it by every harmonic of a mode, COARSE places. scale : 2^-e.
    """

    residual: Fraction
    change: Interval
    of_seed: int
    corner: int
    of_modes: dict[int, tuple[int, int]]
    scale: Fraction

    def by(self, n: int, q: int, seed: int) -> tuple[int, int]:
        """Ends of the derivative of G by c_q[n], COARSE places."""
        low, high = self.of_modes.get(q, (0, 0))
        own = self.of_seed << COARSE if (n, q) == (1, seed) else 0
        return low + own, high + own

    def largest(self) -> int:
        """Above all derivatives of G by harmonics beyond the first, COARSE places."""
        return max(
            (max(abs(low), abs(high)) for low, high in self.of_modes.values()), default=0
        )

    def along(self, claim: Claim, bonds: Bonds) -> Fraction:
        """Above |DG t + dG/ds|, t the direction of a segment."""
        unit = 1 << claim.bits
        of_seed = self.of_seed * Fraction(claim.direction[1, claim.seed], unit)
        constant = of_seed + self.corner * Fraction(claim.of_frequency, unit)
        ends = [constant - x for x in self.change]
        if claim.fixed == ENERGY:
            low, high = energy_along(claim, bonds)
            ends = [low * self.scale - self.change[1], high * self.scale - self.change[0]]
        return max(map(abs, ends))

    def curvature(self, claim: Claim, bonds: Bonds, radius: Fraction) -> Fraction:
        """Above |D^2 G| within the radius."""
        if claim.fixed != ENERGY:
            return Fraction(0)
        slopes = (1 + claim.force.slope_bound(x + radius) for x in bonds.sizes)
        return self.scale * sum(slopes, Fraction(0))


def condition_of(claim: Claim, bonds: Bonds) -> Condition:
    """That of the claim."""
    scale = Fraction(2) ** -claim.equation_places
    if claim.fixed == AMPLITUDE:
        low, high = scaled_root(claim, bonds)
        c = Fraction(claim.orbit[1, claim.seed], 1 << claim.bits)
        residual = max(abs(c - claim.value * x) for x in (low, high))
        change = claim.half_width * low, claim.half_width * high
        return Condition(residual, change, 1, 0, {}, scale)
    if claim.fixed == FREQUENCY:
        width = 2 * claim.omega * claim.half_width + claim.half_width**2
        return Condition(Fraction(0), (width / claim.unit,) * 2, 0, 1, {}, scale)
    energy = energy_between(claim, bonds, [Fraction(0)] * claim.N)
    residual = scale * max(abs(x - claim.value) for x in energy)
    change = (scale * claim.half_width,) * 2
    return Condition(residual, change, 0, 0, gradient(claim, bonds, scale), scale)


def scaled_root(claim: Claim, bonds: Bonds) -> Interval:
    """Ends of sqrt(2/N) Omega_s."""
    places = bonds.places
    low, high = (x * Fraction(2, claim.N) for x in bonds.linear(claim.seed))
    least = isqrt((low * 4**places).__floor__())
    most = isqrt(up(high * 4**places)) + 1
    return Fraction(least, 1 << places), Fraction(most, 1 << places)


def energy_between(claim: Claim, bonds: Bonds, radii: list[Fraction]) -> Interval:
    """Ends of sum_j V(r_j) at t = 0, every stretch within its radius of that of the orbit."""
    least = most = Fraction(0)
    terms = {k + 1: c / (k + 1) for k, c in claim.force.couplings.items()}
    terms[2] = Fraction(1, 2)
    for stretch, size, radius in zip(bonds.stretches, bonds.sizes, radii, strict=True):
        r, error = bonds.at_rest(stretch)
        low, high = polynomial_between(terms, r - radius - error, r + radius + error)
        x = size + radius
        lost = x * claim.force.left_out(x, 0)
        least, most = least + low - lost, most + high + lost
    return least, most


def polynomial_between(
    terms: dict[int, Fraction], low: Fraction, high: Fraction
) -> Interval:
    """Ends of an interval that holds sum terms[k] r^k for r between low and high."""
    least = most = Fraction(0)
    for k, c in terms.items():
        ends = [low**k, high**k]
        crosses = low < 0 < high and k % 2 == 0
        powers = (Fraction(0) if crosses else min(ends), max(ends))
        parts = [c * x for x in powers]
        least, most = least + min(parts), most + max(parts)
    return least, most


def tensions(claim: Claim, bonds: Bonds) -> list[Interval]:
    """Ends of V'(r_j) at t = 0."""
    found = []
    terms = {1: Fraction(1), **claim.force.couplings}
    for stretch, size in zip(bonds.stretches, bonds.sizes, strict=True):
        r, error = bonds.at_rest(stretch)
        low, high = polynomial_between(terms, r - error, r + error)
        lost = claim.force.left_out(size, 0)
        found.append((low - lost, high + lost))
    return found


def gradient(claim: Claim, bonds: Bonds, scale: Fraction) -> dict[int, tuple[int, int]]:
    """Ends of scale sum_j cos(q theta_j) V'(r_j), COARSE places."""
    cosines = Cosines(claim.N, COARSE)
    unit = scale * (1 << COARSE)
    ends = [
        ((low * unit).__floor__(), up(high * unit)) for low, high in tensions(claim, bonds)
    ]
    lost = sum(high - low for low, high in ends)
    units = COSINE_UNITS * sum(max(abs(low), abs(high)) for low, high in ends)
    off = lost + (units >> COARSE) + 2
    found = {}
    for q in range(1, claim.N):
        total = sum(cosines.bond(q, j) * low for j, (low, _) in enumerate(ends)) >> COARSE
        found[q] = total - off, total + off
    return found


def energy_along(claim: Claim, bonds: Bonds) -> Interval:
    """Ends of sum_j V'(r_j) t_j at t = 0, t the direction of a segment."""
    least = most = Fraction(0)
    stretches = bonds.on_bonds(claim.direction)
    for ends, stretch in zip(tensions(claim, bonds), stretches, strict=True):
        t, error = bonds.at_rest(stretch)
        products = [x * y for x in ends for y in (t - error, t + error)]
        least, most = least + min(products), most + max(products)
    return least, most
