"""What the energy of a torus is: its mean, and how far from it at any angle.

dH/dt = sum_j x_j' R_j along the torus, so that a harmonic of H is one of that sum over i nu.omega.
"""

import itertools
import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from symfpu.checkers.reading import MOST_BITS, dyadic, need, whole
from symfpu.checkers.rounding import scientific
from symfpu.checkers.torus.budget import Budget, fraction_steps
from symfpu.checkers.torus.claim import Claim
from symfpu.checkers.torus.residual import GUARD, stretches
from symfpu.checkers.torus.series import Row, Series, dot, product, shifted, turned

MOST_HARMONICS = 10_000_000

Ball = tuple[Fraction, Fraction]  # a middle, and how far from it at most


def check_energy(claim: Claim, residual: Row, entry: Any) -> list[str]:
    """H is within the stated radius of the stated middle at all angles; [] states nothing."""
    if not entry:
        return []
    middle, radius = read_energy(entry)
    mean, error = mean_energy(claim)
    slow = slowest(claim.omega, highest_of_energy(claim), claim.budget)
    need(slow, "a harmonic of the energy does not turn")
    off = abs(mean - middle) + error + dot(speeds(claim), residual) / slow
    need(off <= radius, f"the energy may be {scientific(off)} from the stated one")
    digits = scientific(middle, 30)
    apart = radius + abs(Fraction(digits) - middle)
    return [
        f"theorem: H of that torus is within {scientific(apart)} of {digits} at all angles"
    ]


def read_energy(entry: Any) -> Ball:
    """[middle, radius]; the energy may have any sign."""
    (mantissa, places), radius = entry
    whole(mantissa, -(2**MOST_BITS), 2**MOST_BITS, "the energy")
    whole(places, 0, MOST_BITS, "places of the energy")
    return Fraction(mantissa, 1 << places), dyadic(radius, "the radius of the energy")


def fine(claim: Claim) -> list[Series]:
    """x_1 .. x_(N-1) with the places of the residual."""
    return [shifted(x, x.places + GUARD) for x in claim.torus]


def speeds(claim: Claim) -> Row:
    """Norms of the velocities."""
    return [turned(x, claim.omega, Fraction(0), 1, claim.budget).norm for x in fine(claim)]


def mean_energy(claim: Claim) -> Ball:
    """sum_j <x_j'^2> / 2 + sum_j <V(r_j)>.

    A particle or bond and its mirror image move alike, half a turn of some angles apart.
    """
    particles, bonds = fine(claim), stretches(fine(claim))
    balls = [(2 * w, kinetic(x, claim)) for x, w in halves(particles)]
    balls += [(2 * w, potential(r, claim)) for r, w in halves(bonds)]
    return weighted(balls)


def halves(every: list[Series]) -> list[tuple[Series, Fraction]]:
    """Those of the first half with the weight 1; with 1/2 the one that is its own image."""
    count, odd = divmod(len(every), 2)
    weights = [Fraction(1)] * count + [Fraction(1, 2)] * odd
    return list(zip(every[: count + odd], weights, strict=True))


def kinetic(x: Series, claim: Claim) -> Ball:
    """<x'^2> / 2."""
    y = turned(x, claim.omega, Fraction(0), 1, claim.budget)
    return weighted([(Fraction(1, 2), mean_product(y, y))])


def potential(r: Series, claim: Claim) -> Ball:
    """<V(r)>, r even in the angles; r^(k+1) from two lower powers."""
    powers = [r]
    while 2 * len(powers) < max(claim.couplings) + 1:
        powers.append(product(powers[-1], r, claim.budget))
    balls = []
    for k, coupling in ({1: Fraction(1)} | claim.couplings).items():
        lower = (k + 1) // 2
        mean = mean_product(powers[lower - 1], powers[k - lower])
        balls.append((coupling / (k + 1), mean))
    return weighted(balls)


def weighted(balls: list[tuple[Fraction, Ball]]) -> Ball:
    """sum factor ball."""
    middle = sum((c * ball[0] for c, ball in balls), Fraction(0))
    return middle, sum((abs(c) * ball[1] for c, ball in balls), Fraction(0))


def mean_product(a: Series, b: Series) -> Ball:
    """<a conj(b)>."""
    total = sum(x * b.values.get(nu, 0) for nu, x in a.values.items())
    error = a.size * b.error + (b.size - b.error) * a.error
    unit = Fraction(1, 1 << (a.places + b.places))
    return total * unit, error * unit


def highest_of_energy(claim: Claim) -> list[int]:
    """By angle the highest harmonic that H can have."""
    degree = max(claim.couplings) + 1
    harmonics = [nu for x in claim.torus for nu in x.values]
    return [degree * max(map(abs, column)) for column in zip(*harmonics, strict=True)]


def slowest(omega: Row, highest: Sequence[int], budget: Budget) -> Fraction:
    """The least |nu.omega| of the box without nu = 0; the last of nu is one of two neighbours."""
    ranges = [range(-m, m + 1) for m in highest[:-1]]
    count = math.prod(map(len, ranges))
    need(count <= MOST_HARMONICS, "too many harmonics of the energy")
    budget.spend(count * sum(fraction_steps(w, 0) for w in omega))
    unit = math.lcm(*(w.denominator for w in omega))
    rates, last = [int(w * unit) for w in omega[:-1]], int(omega[-1] * unit)
    least = last
    for nu in itertools.product(*ranges):
        if any(nu):
            rest = sum(n * w for n, w in zip(nu, rates, strict=True))
            for n in (-rest // last, -rest // last + 1):
                inside = max(-highest[-1], min(highest[-1], n))
                least = min(least, abs(rest + inside * last))
    return Fraction(least, unit)
