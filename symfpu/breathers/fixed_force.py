"""Forces of cosine series in fixed point: integer polynomials multiplied exactly by FLINT.

Of a polynomial potential all powers of the stretch; of one whose tension is made of exponentials
and powers, so many that a bound of all others, on stretches up to a reach, is below the last place.
So the whole residual of an orbit is known.

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
from symfpu.chain.tension_terms import terms

Integers = NDArray[np.object_]

SPARE_BITS = 64  # in the cosines before they are rounded


class FixedForce:
    """The terms of n^2 omega^2 c + force = 0 with so many bits after the point.

    reach : no stretch of a bond is larger; it does not matter to polynomials.
    """

    def __init__(self, chain: Chain, bits: int, reach: Any = 0) -> None:
        self.chain, self.bits = chain, bits
        self.terms = terms(chain, bits, reach)
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

    def reach(self, c: Integers) -> Any:
        """A number that no stretch exceeds."""
        sums = np.abs(self._product(c, self.stretch)).sum(axis=0) + len(c)
        return mpmath.ldexp(max(sums), -self.bits)

    def equations(
        self, c: Integers, squared: int, harmonics: int | None = None
    ) -> Integers:
        """n^2 omega^2 c + force for all modes, shape (H+1, N-1) to (harmonics+1, N-1).

        squared : omega^2. harmonics : all that are not zero where it is None.
        """
        total = self._nonlinear(c, harmonics)
        n = np.arange(len(c)).astype(object)[:, None]
        diagonal = n**2 * squared - self.squares
        total[: len(c)] += (diagonal * c) >> self.bits
        return total

    def _nonlinear(self, c: Integers, harmonics: int | None) -> Integers:
        """Cosine coefficients of -S (c_3 r^2 + c_4 r^3 + ...)."""
        r = self._product(c, self.stretch)
        of_bonds = [self._tension(r[:, j].tolist()) for j in range(self.chain.N)]
        last = max(len(c), *map(len, of_bonds)) - 1 if harmonics is None else harmonics
        tension = np.zeros((last + 1, self.chain.N), dtype=object)
        for j, values in enumerate(of_bonds):
            kept = values[: last + 1]
            tension[: len(kept), j] = kept
        return np.negative(self._product(tension, self.modes))

    def _tension(self, r: Sequence[int]) -> list[int]:
        """Cosine coefficients of the anharmonic tension of one bond, c_3 r^2 and so on.

        They are those of d d / 4, d d d / 8, ... with d = 2 r, and twice that for n > 0.
        """
        total: list[int] = []
        twice = flint.fmpz_poly([*r[:0:-1], 2 * r[0], *r[1:]])
        degree = len(r) - 1
        power, middle = (
            twice,
            degree,
        )  # FLINT leaves out zeros at the end, not those at the start
        for k in range(2, max(self.terms.couplings, default=1) + 1):
            power, middle = self._lowered(power * twice, middle + degree)
            coupling = self.terms.couplings.get(k)
            if coupling:
                part = power.coeffs()[middle:]
                above, below = 2 * coupling.numerator, 2**k * coupling.denominator
                total += [0] * (len(part) - len(total))
                for n, x in enumerate(part):
                    total[n] += int(x) * above // below
        return [total[0] // 2, *total[1:]] if total else [0]

    def _product(self, left: Integers, right: Any) -> Integers:
        rows = (flint.fmpz_mat(left.tolist()) * right).tolist()
        return np.array([[int(x) >> self.bits for x in row] for row in rows], dtype=object)

    def _lowered(self, polynomial: Any, middle: int) -> tuple[Any, int]:
        """Rounded to the nearest; high harmonics that are zero then are left out."""
        half = 1 << (self.bits - 1)
        values = [(int(x) + half) >> self.bits for x in polynomial.coeffs()]
        above = values[middle:]
        last = max((n for n, value in enumerate(above) if value), default=0)
        return flint.fmpz_poly(values[middle - last : middle + last + 1]), last
