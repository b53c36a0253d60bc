"""The orbit that a proof of existence is about: a finite list of integers.

c_q = sqrt(2/N) Omega_q Q_q has no roots in its equations,

    F_q[n] = (1 - n^2 omega^2 / Omega_q^2) c_q[n] + (2/N) sum_j cos(q theta_j) phi(r_j)[n],

with r_j = sum_q c_q cos(q theta_j), theta_j = (j + 1/2) pi / N and phi(r) = V'(r) - r. Integers
times 2^-bits are the c_q[n] that the symmetry of a q-breather allows. Ours.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import unknowns
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Numbers
from symfpu.tori.quasiperiodic import QuasiPeriodic

DOUBLE_DIGITS = 16
SPARE_DIGITS = 6  # of the integers beyond those of the orbit
FORBIDDEN = (
    1e-9  # of the largest coefficient: what the symmetry forbids is rounding below it
)
ADVICE = "take one from periodic_orbit, breather_at_amplitude or periodic_orbit_digits"


@dataclass(frozen=True)
class RoundedOrbit:
    """A periodic orbit as integers; rows are harmonics 0 .. H, columns modes 1 .. N-1.

    omega : the frequency, exact. rows : c_q[n] 2^bits. digits : of the orbit that was rounded.
    """

    chain: Chain
    seed: int
    omega: Fraction
    bits: int
    rows: tuple[tuple[int, ...], ...]
    digits: int

    @property
    def harmonics(self) -> int:
        """The last one, H."""
        return len(self.rows) - 1

    @cached_property
    def floats(self) -> NDArray[np.float64]:
        """c in doubles, shape (H+1, N-1)."""
        scaled = [[math.ldexp(x, -self.bits) for x in row] for row in self.rows]
        return np.array(scaled)

    @cached_property
    def powers(self) -> dict[int, Fraction]:
        """The coefficients of phi by power of r, of a polynomial potential."""
        potential = self.chain.potential
        degree = potential.degree or 2
        found = {k: potential.coefficient(k + 1) for k in range(2, degree)}
        return {k: coupling for k, coupling in found.items() if coupling}


def rounded_orbit(orbit: QuasiPeriodic) -> RoundedOrbit:
    """The integers nearest to an orbit; what is below their last place is left out."""
    chain, (seed,) = orbit.chain, orbit.seeds
    digits = orbit.digits or DOUBLE_DIGITS
    cosines = orbit.by_harmonic()
    with mpmath.workdps(digits + 2 * SPARE_DIGITS):
        stretches = _scaled(chain, cosines)
        largest = max(abs(x) for x in stretches.flat)
        if not largest:
            raise InputError("orbit", "the chain at rest", "an orbit that moves", ADVICE)
        _, exponent = math.frexp(float(largest))
        bits = math.ceil((digits + SPARE_DIGITS) * math.log2(10)) - exponent
        rows = _allowed(chain, seed, stretches, bits, FORBIDDEN * largest)
    return RoundedOrbit(chain, seed, orbit.frequency, bits, rows, digits)


def _scaled(chain: Chain, cosines: Numbers) -> Numbers:
    """sqrt(2/N) Omega_q Q_q at the working precision of mpmath."""
    root = mpmath.sqrt(mpmath.mpf(2) / chain.N)
    units = [root * chain.linear_frequency(q) for q in chain.mode_numbers]
    as_mpf = np.frompyfunc(mpmath.mpf, 1, 1)(cosines)
    return np.asarray(as_mpf * np.array(units, dtype=object))


def _allowed(
    chain: Chain, seed: int, stretches: Numbers, bits: int, tolerance: mpmath.mpf
) -> tuple[tuple[int, ...], ...]:
    """Integers at the places that the symmetry allows, without the last rows of zeros."""
    table = np.zeros(stretches.shape, dtype=object)
    places = unknowns(chain, seed, len(stretches) - 1)
    kept = np.zeros(stretches.shape, dtype=bool)
    kept[places] = True
    outside = max((abs(x) for x in stretches[~kept]), default=0)
    if outside > tolerance:
        allowed = (
            "an orbit with the symmetry of a q-breather, c_q[n] = 0 for odd q - n seed"
        )
        raise InputError("orbit", f"{float(outside):.3g} outside", allowed, ADVICE)
    for place in zip(*places, strict=True):
        table[place] = int(mpmath.nint(mpmath.ldexp(stretches[place], bits)))
    last = max(n for n, row in enumerate(table) if any(row))
    return tuple(tuple(row) for row in table[: last + 1].tolist())


def smallest_harmonics(rows: Sequence[Sequence[int]]) -> int:
    """Of the last row in bits: how much of the integers the last harmonic still has."""
    return max(abs(x) for x in rows[-1]).bit_length()
