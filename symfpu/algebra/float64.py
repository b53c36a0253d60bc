"""The ring of doubles: coefficients rounded to 53 bits, scaled by powers of two.

All arrays of degree d carry the factor 2^(-x (d - 1)) with one exponent x for the whole series.
Whenever a degree leaves 2^-200 .. 2^200, x is moved to where that degree is nearest to one, and
everything stored is rescaled; scaling by powers of two is exact, so order 1000 neither overflows
nor loses a digit. A step of x moves degree d by d - 1 powers, which from degree 400 on may be too
many.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from symfpu.algebra.dense import Bonds, DenseRing, Floats, ValuesRing
from symfpu.algebra.grading import Ints

SAFE_EXPONENT = 200
SMALLEST_NORMAL = np.finfo(np.float64).tiny


class DoublesRing(DenseRing[Bonds]):
    """The arithmetic of doubles, whatever stands on the bonds."""

    def _cosines(self, angles: Ints) -> Floats:
        # cos x = sin(pi/2 - x): the sine of an exactly reduced argument has full relative
        # accuracy, also at zero
        quarter = self.space.N - angles
        unit = np.pi / (2 * self.space.N)
        return np.asarray(np.sin(quarter * unit))

    def _reciprocal(self, number: int) -> float:
        return 1 / number

    def _matrix_product(self, left: Floats, right: Floats) -> Floats:
        return np.asarray(left @ right)

    def _times(self, values: Floats, factor: Floats | float) -> Floats:
        values *= factor
        return values

    def _reduced(self, values: Floats) -> Floats:
        return values


class Float64Ring(DoublesRing[Floats], ValuesRing):
    """Coefficients as doubles."""

    name = "float64"

    def number(self, value: Fraction) -> float:
        return float(value)

    def _keep_in_range(self, degree: int, modes: Floats) -> None:
        largest = max(float(modes.max()), -float(modes.min()))
        size = int(np.frexp(largest)[1])
        if degree == 1 or largest == 0.0 or abs(size) <= SAFE_EXPONENT:
            return
        shift = round(size / (degree - 1))
        if shift:  # else one step of the exponent would lead further away
            self.exponent += shift
            self._rescale(degree, shift)

    def _store(self, target: Floats, degree: int, rows: Ints, values: Floats) -> None:
        """Subnormal numbers, which have lost digits and take a hundred products' time, as zero."""
        kept = np.abs(values) >= SMALLEST_NORMAL
        super()._store(target, degree, rows, np.where(kept, values, 0.0))

    def _rescale(self, degree: int, shift: int) -> None:
        """Multiply everything stored of degree d by 2^(-shift (d - 1))."""
        for d, values in zip(self._degrees, self._modes, strict=True):
            np.ldexp(values, -shift * (d - 1), out=values)
        for n, corrections in zip(self._correction_degrees, self._diagonal, strict=True):
            np.ldexp(corrections, -shift * n, out=corrections)
        for d in range(1, degree + 1):
            rows = self._rows(d)
            for array in (self._bonds, self._seed_modes, *self._powers.values()):
                array[:, rows] = np.ldexp(array[:, rows], -shift * (d - 1))
            corrections = self._corrections[:, rows]
            self._corrections[:, rows] = np.ldexp(corrections, -shift * d)
