"""The equation G = 0 that fixes the amplitude, the energy or the frequency of an orbit.

amplitude: G = c_s[1] - A sqrt(2/N) Omega_s; frequency: G = m - 2^f omega^2, the unknown m being
2^f omega^2; energy: G = 2^-e (the mean of sum_j (V(r_j) + r_j V'(r_j)/2) - H), which on periodic
orbits is the energy, as their mean kinetic energy is that of r V'/2. Along a segment the value is
value + s half_width, s in -1 .. 1, of the frequency as far as its square goes at least.
"""

from fractions import Fraction
from math import isqrt
from typing import NamedTuple

from symfpu.checkers.existence.bonds import COARSE, Bonds
from symfpu.checkers.existence.claim import AMPLITUDE, ENERGY, FREQUENCY, Claim
from symfpu.checkers.existence.fixed_point import (
    COSINE_UNITS,
    POWER_PLACES,
    Series,
)
from symfpu.checkers.rounding import up

Interval = tuple[Fraction, Fraction]
NOTHING = Fraction(0), Fraction(0)


class Condition(NamedTuple):
    """G at the orbit and its derivatives.

    residual : above |G|. change : ends of -dG/ds. of_seed : of G by c_s[1] alone. corner : by the
    unknown. slopes : of an energy the derivatives of its bonds, f_j, times 2^-e; then those of G by
    c_q[n] are half of sum_j cos(q theta_j) f_j[n], or all of it for n = 0.
    """

    residual: Fraction
    change: Interval
    of_seed: int
    corner: int
    slopes: list[Series]
    scale: Fraction

    def by(self, n: int, q: int, claim: Claim, bonds: Bonds) -> tuple[int, int]:
        """Ends of the derivative of G by c_q[n], COARSE places."""
        if claim.fixed != ENERGY:
            own = self.of_seed << COARSE if (n, q) == claim.shape.place else 0
            return own, own
        values = [f.values[n] if n < len(f.values) else 0 for f in self.slopes]
        total = sum(
            bonds.shape.on_bond(bonds.cosines, q, j) * f for j, f in enumerate(values)
        )
        error = sum(map(abs, values)) * COSINE_UNITS
        off = (error >> bonds.places) + 1 + self.errors(n, bonds)
        drop = bonds.places - COARSE + (1 if n else 0)
        middle = total >> bonds.places
        return (middle - off) >> drop, ((middle + off + 1) >> drop) + 1

    def errors(self, n: int, bonds: Bonds) -> int:
        """Above the sum over bonds of what f_j[n] is off, in units of the bonds."""
        total = sum(f.error for f in self.slopes)
        return (total << POWER_PLACES) // bonds.norm.below[n] + 1

    def farthest(self, first: int, bonds: Bonds) -> Fraction:
        """Above |dG/dc_q[n]| nu^-n for every n from the first on."""
        if not self.slopes:
            return Fraction(0)
        longest = max(len(f.values) for f in self.slopes)
        least = bonds.norm.below[first]
        worst = self.errors(first, bonds)
        for n in range(first, longest):
            values = (abs(f.values[n]) for f in self.slopes if n < len(f.values))
            worst = max(worst, sum(values) + self.errors(n, bonds))
        return Fraction(worst << POWER_PLACES, least << bonds.places)

    def along(self, claim: Claim, bonds: Bonds) -> Fraction:
        """Above |DG t + dG/ds|, t the direction of a segment."""
        unit = 1 << claim.bits
        of_seed = self.of_seed * Fraction(claim.direction[claim.shape.place], unit)
        constant = of_seed + self.corner * Fraction(claim.of_frequency, unit)
        ends = [constant - x for x in self.change]
        if claim.fixed == ENERGY:
            low, high = energy_along(self.slopes, claim, bonds)
            ends = [low - self.change[1], high - self.change[0]]
        return max(map(abs, ends))

    def curvature(self, claim: Claim, bonds: Bonds, radius: Fraction) -> Fraction:
        """Above |D^2 G| within the radius."""
        if claim.fixed != ENERGY:
            return Fraction(0)
        slopes = (claim.force.virial_slope_bound(x + radius) for x in bonds.sizes)
        return self.scale * claim.shape.copies * sum(slopes, Fraction(0))


def condition_of(claim: Claim, bonds: Bonds) -> Condition:
    """That of the claim."""
    scale = Fraction(2) ** -claim.equation_places
    if claim.fixed == AMPLITUDE:
        low, high = scaled_root(claim, bonds)
        c = Fraction(claim.orbit[claim.shape.place], 1 << claim.bits)
        residual = max(abs(c - claim.value * x) for x in (low, high))
        change = claim.half_width * low, claim.half_width * high
        return Condition(residual, change, 1, 0, [], scale)
    if claim.fixed == FREQUENCY:
        width = 2 * claim.omega * claim.half_width + claim.half_width**2
        return Condition(Fraction(0), (width / claim.unit,) * 2, 0, 1, [], scale)
    residual = scale * max(abs(x - claim.value) for x in mean_energy(claim, bonds))
    change = (scale * claim.half_width,) * 2
    return Condition(residual, change, 0, 0, gradients(claim, bonds, scale), scale)


def gradients(claim: Claim, bonds: Bonds, scale: Fraction) -> list[Series]:
    """scale times the derivative of V + r V'/2 along every bond, for all bonds that move as it."""
    scale *= claim.shape.copies
    terms = {k: scale * c for k, c in claim.force.virial_terms().items()}
    rests = [scale * claim.force.virial_left_out(size) for size in bonds.sizes]
    return bonds.combinations(terms, rests)


def mean_energy(claim: Claim, bonds: Bonds) -> Interval:
    """Ends of the mean of sum_j (V + r V'/2); V + r V'/2 = r w(r)."""
    couplings = claim.force.couplings.items()
    terms = {k: c * (Fraction(1, k + 1) + Fraction(1, 2)) for k, c in couplings}
    rests = [2 * claim.force.left_out(size, 0) for size in bonds.sizes]
    factors = bonds.combinations({1: Fraction(1), **terms}, rests)
    ends = sum_of_means(bonds.stretches, factors, bonds)
    return ends[0] * claim.shape.copies, ends[1] * claim.shape.copies


def sum_of_means(some: list[Series], others: list[Series], bonds: Bonds) -> Interval:
    """Ends of the sum of the means of products; a mean is below the norm."""
    total, error = 0, 0
    for a, b in zip(some, others, strict=True):
        products = [x * y for x, y in zip(a.values, b.values, strict=False)]
        total += products[0] * 2 + sum(products[1:])
        sizes = bonds.norm.of(a.values), bonds.norm.of(b.values)
        error += sizes[0] * b.error + sizes[1] * a.error + a.error * b.error
    unit = 4**bonds.places
    middle, off = Fraction(total, 2 * unit), Fraction(error, unit)
    return middle - off, middle + off


def scaled_root(claim: Claim, bonds: Bonds) -> Interval:
    """Ends of c_s[1] where A is 1."""
    places = bonds.places
    low, high = (x * claim.shape.of_amplitude for x in bonds.linear(claim.shape.place[1]))
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


def mean_energy_between(claim: Claim, bonds: Bonds, radius: Fraction) -> Interval:
    """Ends of the mean of sum_j (V + r V'/2), every series within the radius of that of the orbit.

    The derivative of V + r V'/2 is 0 at r = 0, so at most r times a bound of its own derivative.
    """
    least, most = mean_energy(claim, bonds)
    reached = [size + radius for size in bonds.sizes]
    slopes = (x * claim.force.virial_slope_bound(x) for x in reached)
    off = radius * claim.shape.copies * sum(slopes, Fraction(0))
    return least - off, most + off


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


def energy_along(slopes: list[Series], claim: Claim, bonds: Bonds) -> Interval:
    """Ends of the mean of sum_j f_j t_j, t the direction of a segment."""
    return sum_of_means(slopes, bonds.on_bonds(claim.direction), bonds)
