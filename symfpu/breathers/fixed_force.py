"""Forces of cosine series in fixed point: integer polynomials multiplied exactly by FLINT.

For polynomial potentials: their forces have finitely many harmonics, so that the whole residual
of an orbit is known.

A series sum_n c_n cos(n theta), times two, is the palindromic Laurent polynomial sum_n d_|n| z^n
with d_0 = 2 c_0, d_n = c_n. Every number is an integer times 2^-bits; a product is rounded down
once.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint
import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain

Integers = NDArray[np.object_]

SPARE_BITS = 64  # in the cosines before they are rounded


def highest_product(chain: Chain) -> int:
    """The power of r in the force, 3 or more: H harmonics have forces up to so many times H."""
    return max(3, (chain.potential.degree or 0) - 1)


class FixedForce:
    """The terms of n^2 omega^2 c + force = 0 with so many bits after the point."""

    def __init__(self, chain: Chain, bits: int) -> None:
        self.chain, self.bits = chain, bits
        N = chain.N
        with mpmath.workprec(bits + SPARE_BITS):
            root = mpmath.sqrt(mpmath.mpf(2) / N)
            linear = [chain.linear_frequency(q) for q in range(1, N)]
            cosines = [root * mpmath.cospi(mpmath.mpf(k) / (2 * N)) for k in range(4 * N)]
            rows = []
            for q, Omega in enumerate(linear, 1):
                places = [q * (2 * j + 1) % (4 * N) for j in range(N)]
                rows.append([self.fixed(Omega * cosines[k]) for k in places])
            squares = [self.fixed(Omega**2) for Omega in linear]
        self.squares: Integers = np.array(squares, dtype=object)
        self.stretch = flint.fmpz_mat(rows)  # of every bond by a unit of each mode
        self.modes = self.stretch.transpose()

    def fixed(self, value: Any) -> int:
        """A number of mpmath or a fraction as an integer, rounded to nearest."""
        if isinstance(value, Fraction):
            doubled = (2 * value.numerator << self.bits) // value.denominator
            return int(doubled + 1) // 2
        return int(mpmath.nint(mpmath.ldexp(value, self.bits)))

    def equations(self, c: Integers, squared: int, harmonics: int) -> Integers:
        """n^2 omega^2 c + force for all modes, shape (H+1, N-1) to (harmonics+1, N-1).

        squared : omega^2.
        """
        total = self._nonlinear(c, harmonics)
        n = np.arange(len(c)).astype(object)[:, None]
        diagonal = n**2 * squared - self.squares
        total[: len(c)] += (diagonal * c) >> self.bits
        return total

    def _nonlinear(self, c: Integers, harmonics: int) -> Integers:
        """Cosine coefficients of -S (c_3 r^2 + c_4 r^3 + ...)."""
        r = self._product(c, self.stretch)
        tension = np.zeros((harmonics + 1, self.chain.N), dtype=object)
        for j in range(self.chain.N):
            tension[:, j] = self._tension(r[:, j].tolist(), harmonics)
        return np.negative(self._product(tension, self.modes))

    def _tension(self, r: Sequence[int], harmonics: int) -> list[int]:
        """Cosine coefficients of the anharmonic tension of one bond, c_3 r^2 and so on.

        They are those of d d / 4, d d d / 8, ... with d = 2 r, and twice that for n > 0.
        """
        degree = len(r) - 1
        total = np.zeros(harmonics + 1, dtype=object)
        twice = flint.fmpz_poly([*r[:0:-1], 2 * r[0], *r[1:]])
        power = twice
        for k in range(2, highest_product(self.chain) + 1):
            coupling = self.chain.potential.coefficient(k + 1)
            power = self._lowered(power * twice)
            if coupling:
                middle = k * degree
                part = power.coeffs()[middle : middle + harmonics + 1]
                above, below = 2 * coupling.numerator, 2**k * coupling.denominator
                total[: len(part)] += [int(x) * above // below for x in part]
        total[0] //= 2
        return list(total)

    def _product(self, left: Integers, right: Any) -> Integers:
        rows = (flint.fmpz_mat(left.tolist()) * right).tolist()
        return np.array([[int(x) >> self.bits for x in row] for row in rows], dtype=object)

    def _lowered(self, polynomial: Any) -> Any:
        return flint.fmpz_poly([int(x) >> self.bits for x in polynomial.coeffs()])
