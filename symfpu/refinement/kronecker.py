"""Forces of even functions of many angles in fixed point: Kronecker products by FLINT.

A function sum c[nu] cos(nu.theta), times two, is the palindromic Laurent polynomial of several
variables sum d[nu] z^nu with d[0] = 2 c[0] and d[+-nu] = c[nu]. Kronecker's substitution
z_i = x^(stride_i) makes it one polynomial of one variable, whose products FLINT takes exactly in
integers. Every number is an integer times 2^-bits; a product is rounded once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

import flint
import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.projections.projection import Projection
from symfpu.chain.tension_terms import Terms, terms
from symfpu.refinement.lattice import Ints

Integers = NDArray[np.object_]

SPARE_BITS = 64  # in the cosines before they are rounded


class Box:
    """Harmonics |nu_i| <= highest_i, and the places of one variable they are packed into.

    whole : products keep all of their harmonics apart. Otherwise a product folds those outside the
    box onto each other, never onto one inside, which takes three quarters of the places an angle.
    """

    def __init__(self, highest: Sequence[int], *, whole: bool) -> None:
        self.highest = tuple(int(m) for m in highest)
        self.whole = whole
        widths = [(4 if whole else 3) * m + 1 for m in self.highest]
        strides = [math.prod(widths[:i]) for i in range(len(widths))]
        self.strides = np.array(strides, dtype=np.int64)
        self.middle = int(self.strides @ np.array(self.highest))

    def places(self, harmonics: Ints) -> Ints:
        """Of harmonics (M, s) in the box, or of their opposites, from the middle on; shape (M,)."""
        return np.asarray(np.abs(harmonics @ self.strides))

    @cached_property
    def harmonics(self) -> Ints:
        """All harmonics of the box, one of each pair +-nu, by place; shape (B, s)."""
        axes = [np.arange(-m, m + 1) for m in self.highest]
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        rows = grid.reshape(-1, len(axes))
        places = rows @ self.strides
        order = np.argsort(places, kind="stable")
        return np.asarray(rows[order[len(rows) // 2 :]])

    @cached_property
    def _inside(self) -> Ints:
        return self.places(self.harmonics)

    def rows(self, harmonics: Ints) -> Ints:
        """Where harmonics (M, s), or their opposites, stand among those of the box; shape (M,)."""
        return np.searchsorted(self._inside, self.places(harmonics))

    def packed(self, values: Integers) -> Any:
        """The polynomial of d at the harmonics of the box."""
        upper = np.zeros(self.middle + 1, dtype=object)
        upper[self._inside] = values
        half = upper.tolist()
        return flint.fmpz_poly([*half[:0:-1], *half])

    def product(self, one: Any, other: Any, shift: int) -> tuple[Integers, int]:
        """d of a product times 2^-shift within the box, from the lower half of its places.

        The second result: above the largest value of what was cut off or rounded, if `whole`.
        """
        count = 2 * self.middle + 1
        lower = np.zeros(count, dtype=object)
        low = one.mul_low(other, count).coeffs()
        lower[: len(low)] = low
        kept = lower[2 * self.middle - self._inside]
        lost = 0
        if self.whole:
            cut_off = int(abs(lower).sum() - abs(kept).sum())
            lost = (cut_off >> shift) + 1 + len(kept)
        return np.asarray((kept + (1 << (shift - 1))) >> shift), lost


class Series(NamedTuple):
    """A function in a box: twice it at the harmonics of the box, and what it is off by at most.

    size : above the largest value. Integers times 2^-bits; size and error are of `whole` boxes.
    """

    values: Integers
    size: int = 0
    error: int = 0


class KroneckerForce:
    """The anharmonic force of a chain on functions in a box, with so many bits after the point.

    projection : of the chain, at any harmonics. reach : no stretch of a bond is larger.
    """

    def __init__(self, projection: Projection, box: Box, bits: int, reach: Any) -> None:
        self.projection, self.chain = projection, projection.chain
        self.box, self.bits = box, bits
        _, self._scale = math.frexp(float(reach))  # stretches in units of 2^scale
        self.terms = self._terms(reach)
        self.highest = max(self.terms.couplings, default=1)
        self._set_rows()

    def _terms(self, reach: Any) -> Terms:
        """Of what is summed: V'(r) - r."""
        return terms(self.chain, self.bits, reach)

    def _set_rows(self) -> None:
        """Stretches of the points by a unit of each kind of coefficient, and squares of Omega."""
        with mpmath.workprec(self.bits + SPARE_BITS):
            linear, rows = self.projection.exact_rows()
            fixed = [[self.fixed(x) for x in row] for row in rows]
            squares = [self.fixed(Omega**2) for Omega in linear]
        self._rows: Integers = np.array(fixed, dtype=object)
        self._squares: Integers = np.array(squares, dtype=object)
        images = self.projection.images.astype(int).tolist()
        self._images: Integers = np.array(images, dtype=object)

    def squares(self, harmonics: Ints) -> Integers:
        """Omega^2 of coefficients at harmonics (M, s); (M | 1, C)."""
        return np.asarray(self._squares[self.projection.at(harmonics).entries])

    def fixed(self, value: Any) -> int:
        """A number of mpmath or a fraction as an integer, rounded to nearest."""
        if isinstance(value, Fraction):
            doubled = (2 * value.numerator << self.bits) // value.denominator
            return int(doubled + 1) // 2
        return int(mpmath.nint(mpmath.ldexp(value, self.bits)))

    def fixed_values(self, values: Any) -> Integers:
        """An array of doubles or mpf, exact, as integers."""
        return np.asarray(np.frompyfunc(lambda x: self.fixed(mpmath.mpf(x)), 1, 1)(values))

    def stretches(self, harmonics: Ints, c: Integers) -> Integers:
        """Coefficients (H, B) of the stretches of the points, of those (H, C) at harmonics."""
        return self._times(c, self._rows[self.projection.at(harmonics).entries])

    def driven(self, harmonics: Ints, tension: Integers) -> Integers:
        """What tensions of the points, (M, B) at harmonics, drive; (M, C)."""
        return self._times(tension, np.swapaxes(self._back(harmonics), 1, 2))

    def _back(self, harmonics: Ints) -> Integers:
        rows = self._rows[self.projection.at(harmonics).entries]
        return np.asarray(rows * self._images)

    def _times(self, left: Integers, tables: Integers) -> Integers:
        """Rows (H, K) times tables (H | 1, K, L), each with its own or all with the one."""
        if len(tables) > 1:
            return np.asarray((left[:, :, None] * tables).sum(axis=1) >> self.bits)
        product = flint.fmpz_mat(left.tolist()) * flint.fmpz_mat(tables[0].tolist())
        found = np.array(product.entries(), dtype=object)
        return np.asarray(found.reshape(len(left), -1) >> self.bits)

    def force(
        self, harmonics: Ints, c: Integers, wanted: Ints
    ) -> tuple[Integers, Integers]:
        """Coefficients (M, C) of the force at wanted harmonics, of those (H, C) of a torus.

        They hold where the selection rules let a mode carry a harmonic; the others mean nothing.

        The second result, of `whole` boxes: above what the force of each column is off by, with
        harmonics that are not wanted left out as if they were none, (C,).
        """
        rows, to = self.box.rows(harmonics), self.box.rows(wanted)
        stretches = self.stretches(harmonics, c)
        tension = np.zeros((len(wanted), stretches.shape[1]), dtype=object)
        errors = np.zeros(stretches.shape[1], dtype=object)
        rounding = len(c) + int(
            (abs(c).sum() >> (self.bits + 1)) + 1
        )  # of S c, and S's own
        for j, r in enumerate(stretches.T):
            found = self._sum_of_powers(rows, r, rounding)
            tension[:, j], errors[j] = found.values[to], found.error
        still = to == 0
        tension[still] = tension[still] // 2
        back = abs(self._back(wanted)).max(axis=0) + self._images
        off = (back @ errors + abs(tension).sum(axis=0) @ self._images) >> self.bits
        return self.driven(wanted, tension), off + len(wanted) + 1

    def _sum_of_powers(self, rows: Ints, r: Integers, error: int) -> Series:
        """The terms of one bond, V'(r) - r, by powers in blocks, blocks by Horner's rule.

        error : of r, at most.
        About twice the root of the degree as many products (Paterson and Stockmeyer).
        """
        powers = self._powers(rows, r, error)
        width, last = len(powers) - 1, self.highest + 1
        if self.highest <= width:
            total = self._block(powers, range(last))
        else:
            starts = range(0, last, width)
            ranges = [range(n, min(n + width, last)) for n in starts]
            total, *others = [self._block(powers, block) for block in reversed(ranges)]
            for block in others:
                total = _sum(self._product(total, powers[width]), block)
        rest = self.fixed(self.terms.rest) + 1
        return total._replace(error=total.error + rest)

    def _powers(self, rows: Ints, r: Integers, error: int) -> list[Series]:
        """1, g, g^2, .. of g = r / 2^scale, as many as a block has."""
        g = np.zeros(len(self.box.harmonics), dtype=object)
        g[rows] = _shifted(np.where(rows == 0, 2 * r, r), -self._scale)
        one = np.zeros(len(g), dtype=object)
        one[0] = 2 << self.bits
        off = int(_shifted(np.array([error], dtype=object), -self._scale)[0]) + 1
        first = Series(g, int(abs(g).sum()), off + len(r) + 1)
        width = min(self.highest, max(3, math.isqrt(self.highest)))
        powers = [Series(one, 1 << self.bits), first]
        while len(powers) <= width:
            powers.append(self._product(powers[-1], first))
        return powers

    def _block(self, powers: Sequence[Series], block: range) -> Series:
        """sum of c_k 2^(scale k) g^k of one block of powers k, over g to its first."""
        values, size, error = 0 * powers[0].values, 0, 0
        for power, n in zip(powers, block, strict=False):
            coupling = self.terms.couplings.get(n)
            if coupling:
                factor = self.fixed(coupling * Fraction(2) ** (self._scale * n))
                values = values + power.values * factor
                size += power.size * abs(factor)
                error += power.error * abs(factor) + power.size
        rounding = len(values)
        size, error = (size >> self.bits) + 1, (error >> self.bits) + 1 + rounding
        return Series(values >> self.bits, size, error)

    def _product(self, left: Series, right: Series) -> Series:
        one = self.box.packed(left.values)
        other = one if right is left else self.box.packed(right.values)
        values, lost = self.box.product(one, other, self.bits + 1)
        off = left.size * right.error + right.size * left.error + left.error * right.error
        size = (left.size * right.size) >> self.bits
        return Series(values, size + 1, (off >> self.bits) + 1 + lost)


def _sum(left: Series, right: Series) -> Series:
    return Series(
        left.values + right.values,
        left.size + right.size,
        left.error + right.error,
    )


def _shifted(values: Integers, bits: int) -> Integers:
    return np.asarray(values << bits if bits >= 0 else values >> -bits)
