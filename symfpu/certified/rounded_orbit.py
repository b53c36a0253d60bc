"""The orbit that a proof of existence is about: a finite list of integers.

c_q = sqrt(2/N) Omega_q Q_q has no roots in its equations,

    F_q[n] = (1 - n^2 omega^2 / Omega_q^2) c_q[n] + (2/N) sum_j cos(q theta_j) phi(r_j)[n],

with r_j = sum_q c_q cos(q theta_j), theta_j = (j + 1/2) pi / N and phi(r) = V'(r) - r. Integers
times 2^-bits are the c_q[n] that the symmetry of a q-breather allows. Of a wave on a ring they are
the harmonics of its one function r, each in the column of its mode. Ours.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.certified.layout import Layout, layout_of
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Numbers
from symfpu.tori.torus import Torus

DOUBLE_DIGITS = 16
SPARE_DIGITS = 6  # of the integers beyond those of the orbit
FORBIDDEN = (
    1e-9  # of the largest coefficient: what the symmetry forbids is rounding below it
)
ADVICE = "take one from torus or refine"


@dataclass(frozen=True)
class RoundedOrbit:
    """A periodic orbit as integers; rows are harmonics 0 .. H, columns the modes of its layout.

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
    def layout(self) -> Layout:
        """Which unknowns it has."""
        return layout_of(self.chain, self.seed)

    @cached_property
    def floats(self) -> NDArray[np.float64]:
        """c in doubles, shape (H+1, modes)."""
        scaled = [[math.ldexp(x, -self.bits) for x in row] for row in self.rows]
        return np.array(scaled)


def rounded_orbit(orbit: Torus, digits: int | None = None) -> RoundedOrbit:
    """The integers nearest to an orbit; what is below their last place is left out.

    digits : of the integers, the orbit's own unless more are asked for.
    """
    digits = max(orbit.digits or DOUBLE_DIGITS, digits or 0)
    with mpmath.workdps(digits + 2 * SPARE_DIGITS):
        stretches = _of_wave(orbit) if orbit.travels else _of_modes(orbit)
        largest = max(abs(x) for x in stretches.flat)
        if not largest:
            raise InputError("orbit", "the chain at rest", "an orbit that moves", ADVICE)
        _, exponent = math.frexp(float(largest))
        bits = math.ceil((digits + SPARE_DIGITS) * math.log2(10)) - exponent
        layout = layout_of(orbit.chain, orbit.seed)
        rows = _allowed(layout, stretches, bits, FORBIDDEN * largest)
    return RoundedOrbit(orbit.chain, orbit.seed, orbit.frequency, bits, rows, digits)


def _of_modes(orbit: Torus) -> Numbers:
    """sqrt(2/N) Omega_q Q_q at the working precision of mpmath."""
    chain, cosines = orbit.chain, orbit.by_harmonic()
    root = mpmath.sqrt(mpmath.mpf(2) / chain.N)
    units = [root * chain.linear_frequency(q) for q in chain.mode_numbers]
    as_mpf = np.frompyfunc(mpmath.mpf, 1, 1)(cosines)
    return np.asarray(as_mpf * np.array(units, dtype=object))


def _of_wave(torus: Torus) -> Numbers:
    """N^(-1/2) Omega_m c[n] of a wave at harmonic n, in the column of its folded mode m."""
    N, layout = torus.chain.N, layout_of(torus.chain, torus.seed)
    coefficients = torus.by_harmonic()[:, 0].tolist()
    table = np.full((len(coefficients), layout.modes), mpmath.mpf(0))
    for n, c in enumerate(coefficients):
        m = n * torus.seed % N
        if m:
            unit = torus.chain.linear_frequency(m) / mpmath.sqrt(N)
            table[n, min(m, N - m) - 1] = unit * c
    return table


def _allowed(
    layout: Layout, stretches: Numbers, bits: int, tolerance: mpmath.mpf
) -> tuple[tuple[int, ...], ...]:
    """Integers at the places that the symmetry allows, without the last rows of zeros."""
    table = np.zeros(stretches.shape, dtype=object)
    kept = layout.allowed(len(stretches) - 1)
    outside = max((abs(x) for x in stretches[~kept]), default=0)
    if outside > tolerance:
        allowed = (
            "an orbit with the symmetry of a q-breather, c_q[n] = 0 for odd q - n seed"
        )
        raise InputError("orbit", f"{float(outside):.3g} outside", allowed, ADVICE)
    for n, q in np.argwhere(kept).tolist():
        table[n, q] = int(mpmath.nint(mpmath.ldexp(stretches[n, q], bits)))
    last = max(n for n, row in enumerate(table) if any(row))
    return tuple(tuple(row) for row in table[: last + 1].tolist())
