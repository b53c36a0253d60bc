"""The torus that a theorem is about: displacements of the particles, rounded to integers.

In them the equations of motion hold no root,

    x_j'' = V'(r_j) - V'(r_(j-1)),    r_j = x_(j+1) - x_j,    j = 1 .. N-1,   x_0 = x_N = 0,

so that a torus of integers x_j[nu] 2^-bits, of exact frequencies and of a polynomial V with exact
coefficients leaves something that integers bound.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np

from symfpu.certified.series import Integers, Series, trimmed
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.arithmetic import Numbers
from symfpu.refinement.lattice import Ints
from symfpu.tori.torus import Torus, require_solution

DOUBLE_DIGITS = 16
SPARE_BITS = 20  # of the integers beyond the digits of the torus
GUARD_BITS = 40  # of the forces beyond those
FORBIDDEN = 1e-9  # of the largest coefficient: rounding, where no mode is allowed
WORK_DIGITS = 15  # beyond those of the torus, while modes become particles


@dataclass(frozen=True, eq=False)
class RoundedTorus:
    """particles : x_j as series with error 0, j = 1 .. N-1. digits : of what was rounded."""

    chain: Chain
    seeds: tuple[int, ...]
    omega: tuple[Fraction, ...]
    bits: int
    particles: tuple[Series, ...]
    digits: int

    @cached_property
    def couplings(self) -> dict[int, Fraction]:
        """Of V'(r) - r, by power of r."""
        potential = self.chain.potential
        assert potential.degree is not None
        found = {k: potential.coefficient(k + 1) for k in range(2, potential.degree)}
        return {k: c for k, c in found.items() if c}

    @cached_property
    def highest(self) -> tuple[int, ...]:
        """The largest |nu_i| of each angle."""
        every = [series.highest for series in self.particles]
        return tuple(max(m) for m in zip(*every, strict=True))

    def stretches(self, places: int) -> list[Series]:
        """r_0 .. r_(N-1) of the bonds."""
        return stretches_of([series.rounded(places) for series in self.particles])


def stretches_of(particles: Sequence[Series]) -> list[Series]:
    """Of the N bonds, from what the N-1 particles have."""
    inner = [b - a for a, b in pairwise(particles)]
    return [particles[0], *inner, particles[-1].scaled(-1)]


def forces_of(tensions: Sequence[Series]) -> list[Series]:
    """On the N-1 particles, from what the N bonds have."""
    return [b - a for a, b in pairwise(tensions)]


def polynomial_of(r: Series, terms: dict[int, Fraction]) -> Series:
    """sum terms[k] r^k by the powers of r; k >= 0."""
    power = Series(np.full((1,) * r.values.ndim, 1 << r.places, dtype=object), r.places)
    total = power.scaled(terms.get(0, 0))
    for k in range(1, max(terms) + 1):
        power = r if k == 1 else power * r
        if terms.get(k):
            total = total + power.scaled(terms[k])
    return total


def residual_of(torus: RoundedTorus, tell: Progress = unheard) -> list[Series]:
    """x_j'' - force of every particle, j = 1 .. N-1; shape of the harmonics of the force."""
    places = torus.bits + GUARD_BITS
    terms = {1: Fraction(1), **torus.couplings}
    tensions = []
    for j, r in enumerate(torus.stretches(places)):
        tell(f"residual, bond {j}", j / torus.chain.N)
        tensions.append(polynomial_of(r, terms))
    still = Fraction(0)
    moved = [
        series.rounded(places).turned(torus.omega, still, power=2)
        for series in torus.particles
    ]
    forces = forces_of(tensions)
    return [a.scaled(-1) - b for a, b in zip(moved, forces, strict=True)]


def rounded_torus(solution: object) -> RoundedTorus:
    """The integers nearest to a torus; InputError for what the theorems are not about."""
    torus = checked_torus(solution)
    digits = torus.digits or DOUBLE_DIGITS
    with mpmath.workdps(digits + WORK_DIGITS):
        table = particles_of(torus.chain, torus.cosines)
        largest = max(abs(x) for x in table.flat)
        if not largest:
            allowed, advice = "a torus that moves", "take one from refine"
            raise InputError("torus", "the chain at rest", allowed, advice)
        bits = SPARE_BITS + int(
            mpmath.ceil(mpmath.log(mpmath.mpf(10) ** digits / largest, 2))
        )
        parities = torus.harmonics @ np.array(torus.seeds)
        require_symmetric(table, parities)
        series = rounded_series(torus.harmonics, table, bits, parities)
    frequencies = torus.frequencies
    return RoundedTorus(torus.chain, torus.seeds, frequencies, bits, series, digits)


def checked_torus(solution: object) -> Torus:
    """A torus of two angles or more of fixed ends and a polynomial V, or InputError."""
    torus = require_solution(solution, "torus")
    chain = torus.chain
    if chain.periodic:
        advice = (
            "leave ends= out: what is proved of N bonds holds, unfolded, on a ring of 2N"
        )
        raise InputError("torus", repr(chain), "of a chain with fixed ends", advice)
    if len(torus.seeds) < 2:
        advice = "take prove_existence: of one angle more can be proved"
        raise InputError("torus", "a breather", "a torus of two or more angles", advice)
    potential = torus.chain.potential
    if potential.degree is None or not potential.exact:
        allowed = "of a polynomial potential with exact coefficients"
        raise InputError("torus", repr(torus.chain), allowed, "take poly: instead")
    return torus


def particles_of(chain: Chain, cosines: Numbers) -> Numbers:
    """x_j = sqrt(2/N) sum_q sin(pi q j / N) Q_q of each harmonic; (H, N-1) of (H, N-1).

    In mpmath, at its precision.
    """
    N = chain.N
    root = mpmath.sqrt(mpmath.mpf(2) / N)
    rows = [
        [root * mpmath.sinpi(mpmath.mpf(q * j) / N) for j in range(1, N)]
        for q in range(1, N)
    ]
    numbers = np.array([[mpmath.mpf(c) for c in row] for row in cosines], dtype=object)
    return np.asarray(numbers @ np.array(rows, dtype=object))


def rounded_series(
    harmonics: Ints, table: Numbers, bits: int, parities: Ints
) -> tuple[Series, ...]:
    """Even functions: half of a cosine to nu and half to -nu; one series a column.

    parities : of the modes at every harmonic; reflection of the chain leaves those apart.
    """
    pairs = np.concatenate([harmonics, -harmonics])
    return exponentials(
        pairs, np.concatenate([table, table]) / 2, bits, np.tile(parities, 2)
    )


def exponentials(
    harmonics: Ints, table: Numbers, bits: int, parities: Ints
) -> tuple[Series, ...]:
    """sum table[nu] exp(i nu.theta), rounded; one series a column."""
    highest = np.abs(harmonics).max(axis=0)
    values: Integers = np.zeros((table.shape[1], *(2 * highest + 1)), dtype=object)
    for nu, row, parity in zip(harmonics, table, parities, strict=True):
        place = (slice(None), *(highest + nu))
        values[place] += np.array(reflected(row, bits, int(parity)), dtype=object)
    return tuple(Series(trimmed(column), bits) for column in values)


def reflected(row: Numbers, bits: int, parity: int) -> list[int]:
    """Particles 1 .. N-1 of a harmonic whose modes are all odd or all even: x_(N-j) = +-x_j."""
    N = len(row) + 1
    half = [nearest(x, bits) for x in row[: N // 2]]
    sign = 1 if parity % 2 else -1
    if N % 2 == 0 and sign < 0:
        half[-1] = 0
    return [*half, *(sign * x for x in reversed(half[: (N - 1) // 2]))]


def nearest(x: Any, bits: int) -> int:
    """x 2^bits, of a double or of mpmath."""
    if isinstance(x, float):
        return round(math.ldexp(x, bits))
    return int(mpmath.nint(mpmath.ldexp(x, bits)))


def require_symmetric(table: Numbers, parities: Ints) -> None:
    """InputError for a torus with modes where the selection rules allow none."""
    signs = np.where(parities % 2, 1, -1)[:, None]
    off = np.abs(table[:, ::-1] - signs * table).max()
    if off > FORBIDDEN * np.abs(table).max():
        given = "one with modes where the reflection of the chain allows none"
        allowed = "a torus with the symmetry of its seeds"
        raise InputError("torus", given, allowed, "take one from refine")
