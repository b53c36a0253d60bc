"""The series modulo several primes at once, for integers that one prime does not hold.

Primes are so small (about 2^23) that a hundred products of two residues are summed exactly in one
double: a product costs one fused multiply-add, as of plain doubles, and sums are reduced now and
then. The lanes of the kernels are the pairs of a prime and a bond, primes first, so one pass over
the product tables serves several primes, and short rows of few bonds fill whole registers.

Arrays of residues are (primes, ...), in -p/2 .. p/2. Those of the canonical monomials of a degree
are in the order of `CosineModes.even_first`: monomials of one parity, which have the same
transforms, are neighbours.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import isqrt
from typing import Any

import numpy as np

from symfpu.algebra.dense import Floats, ValuesRing, aligned_zeros
from symfpu.algebra.grading import Ints
from symfpu.algebra.rooms import Rooms
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.words import ResidueBasis

PRODUCTS = 128  # that sums may have between two reductions, at least
EXACT = 2**52  # integers below it are exact in doubles, and so are their remainders
# why the ring has no cosines, reciprocals or matrix products of its own
_OWNER = (
    "integers are transformed and rounded by the fixed-point ring that owns these residues"
)
PORTION = 4096  # integers on all bonds or modes of the monomials that are converted at once
LANES = 32  # of a row: four registers of AVX-512, eight of AVX2
# residues on bonds of some canonical monomials, (primes, some, half)
Portions = Callable[[slice], Floats]


def products_between_reductions(degree: int) -> int:
    """How many products are summed before they are reduced; a split in one seed has fewer."""
    return max(PRODUCTS, degree + 4)


def largest_prime(degree: int) -> int:
    """Primes below this keep so many products of residues exact: p^2/4 each, and a little more."""
    return isqrt(4 * EXACT // (products_between_reductions(degree) + 1))


class SeveralPrimesRing(ValuesRing):
    """Coefficients modulo the primes of a basis; what it stores was rounded by its owner."""

    name = "several primes"
    space: CosineModes
    reduces = True
    kind = np.float32  # holds residues of such primes: half of the memory that kernels read

    def __init__(self, space: CosineModes, basis: ResidueBasis) -> None:
        self.basis = basis
        self._limit = products_between_reductions(space.grading.degree)
        count, seeds = len(basis), len(space.seeds)
        super().__init__(space, points=count * space.half)
        self._moduli = self._by_slice(np.repeat(basis.moduli, space.half), self._lanes)
        columns = np.repeat(basis.moduli, seeds)
        self._seed_moduli = self._by_slice(columns, 8)
        last = self._rows(space.grading.degree)
        of_factors = (len(self._seed_moduli), last.start, 8)
        self._seed_modes = aligned_zeros(of_factors, self.kind)
        self._corrections = aligned_zeros(of_factors, self.kind)
        widest = max(self._moduli.size, self._seed_moduli.size)
        self._rooms = Rooms((last.stop - last.start) * widest)

    def _by_slice(self, moduli: Floats, width: int) -> Floats:
        """Moduli of all lanes, (slices, width); lanes without a residue are zero, modulo 1."""
        slices = -(-len(moduli) // width)
        padded = np.ones(slices * width)
        padded[: len(moduli)] = moduli
        return padded.reshape(slices, width)

    def _lane_width(self) -> int:
        return LANES

    def _place(self, shape: tuple[int, ...]) -> Floats:
        return self._rooms.take(shape)

    def _reductions(self, slice_: int, *, sparse: bool = False) -> tuple[Any, ...]:
        moduli = self._seed_moduli if sparse else self._moduli
        return moduli[slice_], self._limit

    def _transforms(self) -> tuple[Floats, Floats]:
        """Cosines are of its owner, who rounds them."""
        return np.zeros((0, 0)), np.zeros((0, 0))

    def _cosines(self, angles: Ints) -> Floats:
        raise NotImplementedError(_OWNER)

    def _reciprocal(self, number: int) -> float:
        raise NotImplementedError(_OWNER)

    def _matrix_product(self, left: Floats, right: Floats) -> Floats:
        raise NotImplementedError(_OWNER)

    def _keep_in_range(self, degree: int, modes: Floats) -> None:
        """Residues do not grow."""

    def number(self, value: Fraction) -> Any:
        """The residues of a number for every lane, (slices, 1, lanes)."""
        residues = []
        for p in self.basis.primes:
            residue = value.numerator * pow(value.denominator, -1, p) % p
            residues.append(residue - p if residue > p // 2 else residue)
        lanes = np.zeros(self._moduli.size)
        points = np.repeat(np.array(residues, dtype=float), self.space.half)
        lanes[: len(points)] = points
        return lanes.reshape(self._moduli.shape)[:, None, :]

    def _times(self, values: Floats, factor: Any) -> Floats:
        """Products of residues are exact; may overwrite values."""
        values *= factor
        return self._reduced(values)

    def _reduced(self, values: Floats) -> Floats:
        """Rows of bonds or of seeds (slices, rows, lanes), overwritten."""
        of_bonds = values.shape[2] == self._lanes and len(values) == len(self._moduli)
        moduli = self._moduli if of_bonds else self._seed_moduli
        for part, own in zip(values, moduli, strict=True):
            self._kernels.reduce_lanes(part, 0, len(part), own, 1.0 / own)
        return values

    # what the kernels take and give, as residues (primes, ...)

    def store_seeds(self, degree: int, modes: Floats) -> None:
        """Register a degree by the modes of the seeds, (primes, monomials, s)."""
        self._degrees.append(degree)
        if degree == self.grading.degree:
            return  # it is a factor of nothing
        first = int(self.grading.first_row[degree])
        rows, conjugates = self._ordered(degree, slice(None))
        values = np.ascontiguousarray(modes)
        self._kernels.to_lanes(values, self._seed_modes, first + rows, first + conjugates)

    def _ordered(self, degree: int, some: slice) -> tuple[Ints, Ints]:
        """Rows of some monomials and of their conjugates, from the first of the degree on."""
        order, _ = self.space.even_first(degree)
        own = order[some]
        return self.grading.canonical(degree)[own], self.grading.conjugate(degree)[own]

    def pieces(self, degree: int) -> list[slice]:
        """Monomials of one parity in portions that stay in the cache of one core."""
        order, even = self.space.even_first(degree)
        step = max(1, PORTION // self.space.N)
        return [
            slice(start, min(start + step, end))
            for first, end in ((0, even), (even, len(order)))
            for start in range(first, end, step)
        ]

    def store_bonds(self, degree: int, values: Portions) -> None:
        """Values on bonds of all monomials."""
        self._keep(self._bonds, degree, values)

    def _keep(self, target: Floats, degree: int, values: Portions) -> None:
        """Values of all monomials and their conjugates.

        Not of the last degree, which is a factor of nothing.
        """
        if degree == self.grading.degree:
            return
        first = int(self.grading.first_row[degree])

        def work(some: slice) -> None:
            rows, conjugates = self._ordered(degree, some)
            self._kernels.to_lanes(values(some), target, first + rows, first + conjugates)

        list(self._pool.map(work, self.pieces(degree)))

    def store_power(self, power: int, degree: int, values: Portions) -> None:
        """Of all monomials."""
        if power not in self._powers:
            self._powers[power] = aligned_zeros(self._bonds.shape, self.kind)
            self._power_degrees[power] = []
        if degree not in self._power_degrees[power]:
            self._power_degrees[power].append(degree)
        self._keep(self._powers[power], degree, values)

    def power_rows(self, power: int, degree: int) -> Floats:
        """Half of a power of the bonds, as the kernel leaves it: (slices, rows, lanes)."""
        if power == 2:
            splits = self._square_splits(degree)
            return self._product(self._bonds, self._bonds, degree, splits, symmetric=True)
        splits = self._power_splits(power, degree)
        return self._product(self._powers[power - 1], self._bonds, degree, splits)

    def canonical_growth(
        self, name: int, slope: Fraction, rate: Fraction, degree: int
    ) -> Floats:
        """The sum of a growth over lower degrees; slope and rate are whole numbers but for a
        rate beside slope 0, which is left out.
        """
        self._complete(name, Fraction(1))
        values, _ = self._grown(name, slope, rate, degree)
        return self.residues(degree, values, slice(None), 1.0)

    def residues(self, degree: int, out: Floats, some: slice, factor: float) -> Floats:
        """Some monomials of the kernel's rows times a factor; (primes, some, half)."""
        return self._from_lanes(degree, out, some, self.space.half, factor)

    def _from_lanes(
        self, degree: int, out: Floats, some: slice, columns: int, factor: float
    ) -> Floats:
        rows, _ = self._ordered(degree, some)
        values = np.empty((len(self.basis), len(rows), columns))
        self._kernels.from_lanes(out, values, rows, factor)
        return values

    def _weighted_bonds(self, slope: Fraction, rate: Fraction, degree: int) -> Floats:
        if self._weighted is None:
            self._weighted = aligned_zeros(self._bonds.shape)
        for j in range(1, degree):
            weight = self.number(rate * j - slope * (degree - j))
            rows = self._rows(j)
            self._weighted[:, rows] = self._reduced(self._bonds[:, rows] * weight)
        return self._weighted

    def correct_by(self, degree: int, corrections: Floats) -> None:
        """Register corrections, (primes, diagonal, s)."""
        self._correction_degrees.append(degree)
        rows = self._diagonal_rows(degree)
        values = np.ascontiguousarray(corrections)
        self._kernels.to_lanes(values, self._corrections, rows, rows)
        self._active[rows] = True

    def corrected_residues(self, degree: int) -> Floats:
        """Sum W_q u_q over all stored pairs of degrees; (primes, monomials, s)."""
        reductions = (self._seed_moduli, self._limit)
        out = self._diagonal_product(
            degree, self._corrections, self._seed_modes, *reductions
        )
        return self._from_lanes(degree, out, slice(None), len(self.space.seeds), 1.0)

    def matrix_product(self, left: Floats, right: Floats) -> Floats:
        """left right modulo every prime; (primes, ., .), sums of any length."""
        step = self._limit - 1
        total: Floats = np.matmul(left[:, :, :step], right[:, :step])
        self.basis.reduce(total)
        for start in range(step, right.shape[1], step):
            some = slice(start, start + step)
            total += np.matmul(left[:, :, some], right[:, some])
            self.basis.reduce(total)
        return total
