"""The energy of a computed torus: its mean, and how far it is from that at any angle. A proof.

Along the torus dH/dt = sum_j x_j' R_j, R the residual: the harmonic nu of H is that of this sum
over i nu.omega. So H is constant as far as the residual is small, and its series is not needed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import product
from typing import NamedTuple

import numpy as np

from symfpu.certified.rounded_torus import GUARD_BITS, RoundedTorus
from symfpu.certified.series import Series


class EnergyBall(NamedTuple):
    """|H - middle| <= radius at all angles."""

    middle: Fraction
    radius: Fraction


def energy_of(torus: RoundedTorus, residual: Sequence[Fraction]) -> EnergyBall | None:
    """H of the torus; None where a harmonic of it does not turn, nu.omega = 0.

    residual : norms of what every particle leaves of the equations of motion.
    """
    least = slowest(torus.omega, [(max(torus.couplings) + 1) * m for m in torus.highest])
    if not least:
        return None
    speeds = [moved.norm for moved in velocities(torus)]
    work = sum((v * r for v, r in zip(speeds, residual, strict=True)), Fraction(0))
    mean = mean_energy(torus)
    return EnergyBall(mean.middle, mean.radius + work / least)


def velocities(torus: RoundedTorus) -> list[Series]:
    """x_j' of every particle, over i."""
    fine = [series.rounded(torus.bits + GUARD_BITS) for series in torus.particles]
    return [series.turned(torus.omega, Fraction(0)) for series in fine]


def mean_energy(torus: RoundedTorus) -> EnergyBall:
    """The mean of H over the angles: sum_j <x_j'^2> / 2 + sum_j <V(r_j)>.

    The mirror image of a bond or particle moves as it does, half a turn of some angles later.
    """
    moving = first_half(velocities(torus))
    speed = by_reflection(list(map(kinetic, moving)), torus.chain.N - 1)
    terms = {1: Fraction(1), **torus.couplings}
    bonds = first_half(torus.stretches(torus.bits + GUARD_BITS))
    stretch = by_reflection([mean_potential(r, terms) for r in bonds], torus.chain.N)
    return EnergyBall(speed.middle + stretch.middle, speed.radius + stretch.radius)


def first_half(every: list[Series]) -> list[Series]:
    """Those whose mirror images are the others, the middle one among them."""
    return every[: (len(every) + 1) // 2]


def by_reflection(half: list[EnergyBall], count: int) -> EnergyBall:
    """The sum of all so many from those of the first half."""
    every = [*half, *half[: count // 2]]
    middle, radius = (sum(column, Fraction(0)) for column in zip(*every, strict=True))
    return EnergyBall(middle, radius)


def kinetic(moved: Series) -> EnergyBall:
    """<x'^2> / 2."""
    mean = mean_product(moved, moved)
    return EnergyBall(mean.middle / 2, mean.radius / 2)


def mean_potential(r: Series, terms: dict[int, Fraction]) -> EnergyBall:
    """<V(r)> from V' = sum terms[k] r^k: r^(k+1) is a product of two lower powers."""
    powers = [r]
    while 2 * len(powers) < max(terms) + 1:
        powers.append(powers[-1] * r)
    middle = radius = Fraction(0)
    for k, coupling in terms.items():
        lower = (k + 1) // 2
        mean = mean_product(powers[lower - 1], powers[k - lower])
        middle += coupling / (k + 1) * mean.middle
        radius += abs(coupling) / (k + 1) * mean.radius
    return EnergyBall(middle, radius)


def mean_product(one: Series, other: Series) -> EnergyBall:
    """<one conj(other)>; of even functions that of their product."""
    inner = tuple(map(min, one.highest, other.highest))
    total = int((centred(one, inner) * centred(other, inner)).sum())
    error = one.size * other.error + (other.size - other.error) * one.error
    unit = Fraction(1, 1 << (one.places + other.places))
    return EnergyBall(total * unit, error * unit)


def centred(series: Series, highest: tuple[int, ...]) -> np.ndarray:
    """Its coefficients in a smaller box."""
    pairs = zip(series.highest, highest, strict=True)
    return series.values[tuple(slice(m - n, m + n + 1) for m, n in pairs)]


def slowest(omega: Sequence[Fraction], highest: Sequence[int]) -> Fraction:
    """The least |nu.omega|, nu not zero, |nu_m| at most highest[m]."""
    bottom = math.lcm(*(w.denominator for w in omega))
    *others, last = [int(w * bottom) for w in omega]
    ranges = [range(-m, m + 1) for m in highest[:-1]]
    least = last
    for nu in product(*ranges):
        if any(nu):
            turn = sum(n * w for n, w in zip(nu, others, strict=True))
            least = min(least, *nearby(turn, last, highest[-1]))
    return Fraction(least, bottom)


def nearby(turn: int, rate: int, highest: int) -> Iterator[int]:
    """|turn + n rate| of the two n, |n| at most highest, where it is least."""
    down = -turn // rate
    for n in (down, down + 1):
        yield abs(turn + max(-highest, min(highest, n)) * rate)
