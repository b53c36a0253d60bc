"""The series modulo several primes at once, for integers that one prime does not hold.

Primes are so small (about 2^23) that a hundred products of two residues are summed exactly in one
double: a product costs one fused multiply-add, as of plain doubles, and sums are reduced now and
then. The lanes of the kernels are the pairs of a prime and a bond, primes first, so one pass over
the product tables serves several primes, and short rows of few bonds fill whole registers.

Arrays of residues are (primes, ...), in -p/2 .. p/2.
"""

from __future__ import annotations

from fractions import Fraction
from math import isqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.dense import Floats, ValuesRing, aligned_zeros
from symfpu.algebra.grading import Ints
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.words import ResidueBasis

PRODUCTS = 128  # that sums may have between two reductions, at least
EXACT = 2**52  # integers below it are exact in doubles, and so are their remainders
# why the ring has no cosines, reciprocals or matrix products of its own
_OWNER = (
    "integers are transformed and rounded by the fixed-point ring that owns these residues"
)
LANES = 32  # of a row: four registers of AVX-512, eight of AVX2


def products_between_reductions(degree: int) -> int:
    """How many products are summed before they are reduced; a split in one seed has fewer."""
    return max(PRODUCTS, degree + 4)


def largest_prime(degree: int) -> int:
    """Primes below this keep so many products of residues exact: p^2/4 each, and a little more."""
    return isqrt(4 * EXACT // (products_between_reductions(degree) + 1))


class SeveralPrimesRing(ValuesRing):
    """Coefficients modulo the primes of a basis; what it stores was rounded by its owner."""

    name = "several primes"
    reduces = True
    kind = np.float32  # holds residues of such primes: half of the memory that kernels read

    def __init__(self, space: CosineModes, basis: ResidueBasis) -> None:
        self.basis = basis
        self._limit = products_between_reductions(space.grading.degree)
        count, seeds = len(basis), len(space.seeds)
        super().__init__(space, points=count * space.half)
        self._moduli = self._by_slice(np.repeat(basis.moduli, space.half), self._lanes)
        columns = np.tile(basis.moduli, seeds)
        self._seed_moduli = self._by_slice(columns, 8)
        rows = self._bonds.shape[1]
        self._seed_modes = aligned_zeros((len(self._seed_moduli), rows, 8))
        self._corrections = aligned_zeros(self._seed_modes.shape)

    def _by_slice(self, moduli: Floats, width: int) -> Floats:
        """Moduli of all lanes, (slices, width); lanes without a residue are zero, modulo 1."""
        slices = -(-len(moduli) // width)
        padded = np.ones(slices * width)
        padded[: len(moduli)] = moduli
        return padded.reshape(slices, width)

    def _lane_width(self) -> int:
        return LANES

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

    def store(self, degree: int, modes: Floats) -> None:
        """Register a degree, (primes, canonical, N-1); its bonds are stored apart."""
        self._degrees.append(degree)
        seeds = np.array(self.space.seeds) - 1
        columns = np.moveaxis(modes[:, :, seeds], 0, 2)
        self._store_columns(self._seed_modes, degree, columns)

    def _store_columns(self, target: Floats, degree: int, columns: Floats) -> None:
        """(canonical, s, primes) for the rows of monomials and of their conjugates."""
        rows = np.arange(len(columns))
        self._store(target, degree, rows, _padded(columns, target))

    def store_bonds(self, degree: int, rows: Ints, values: Floats) -> None:
        """Values on bonds of some monomials, (primes, rows, half)."""
        self._put_lanes(self._bonds, degree, rows, values)

    def _put_lanes(self, target: Floats, degree: int, rows: Ints, values: Floats) -> None:
        """(primes, rows, half) for some monomials and their conjugates."""
        base = int(self.grading.first_row[degree])
        for places in (self.grading.canonical(degree), self.grading.conjugate(degree)):
            self._kernels.to_lanes(values, target, base + places[rows])

    def store_power(self, power: int, degree: int, values: Floats) -> None:
        """Of all monomials, (primes, canonical, half)."""
        if power not in self._powers:
            self._powers[power] = aligned_zeros(self._bonds.shape, self.kind)
            self._power_degrees[power] = []
        if degree not in self._power_degrees[power]:
            self._power_degrees[power].append(degree)
        rows = np.arange(values.shape[1])
        self._put_lanes(self._powers[power], degree, rows, values)

    def canonical_power(self, power: int, degree: int) -> Floats:
        """A power of the bonds, (primes, canonical, half)."""
        if power == 2:
            splits = self._square_splits(degree)
            out = self._product(self._bonds, self._bonds, degree, splits, symmetric=True)
        else:
            splits = self._power_splits(power, degree)
            out = self._product(self._powers[power - 1], self._bonds, degree, splits)
        return self._residues(degree, out, 2.0)

    def canonical_growth(
        self, name: int, slope: Fraction, rate: Fraction, degree: int
    ) -> Floats:
        """The sum of a growth over lower degrees; slope and rate are whole numbers but for a
        rate beside slope 0, which is left out.
        """
        self._complete(name, Fraction(1))
        values, _ = self._grown(name, slope, rate, degree)
        return self._residues(degree, values)

    def _residues(self, degree: int, out: Floats, factor: float = 1.0) -> Floats:
        """Canonical monomials of the kernel's rows times a factor; (primes, canonical, half)."""
        canonical = self.grading.canonical(degree)
        values = np.empty((len(self.basis), len(canonical), self.space.half))
        self._kernels.from_lanes(out, values, canonical, factor)
        return values

    def _weighted_bonds(self, slope: Fraction, rate: Fraction, degree: int) -> Floats:
        end = int(self.grading.first_row[degree])
        if self._weighted is None:
            self._weighted = aligned_zeros(self._bonds.shape)
        lower = self._weighted[:, :end]
        for j in range(degree):
            weight = self.number(rate * j - slope * (degree - j))
            rows = self._rows(j)
            np.multiply(self._bonds[:, rows], weight, out=lower[:, rows])
        return self._reduced(lower)

    def correct_by(self, degree: int, corrections: Floats) -> None:
        """Register corrections, (primes, diagonal, s)."""
        self._correction_degrees.append(degree)
        rows = self._diagonal_rows(degree)
        lanes = _padded(np.moveaxis(corrections, 0, 2), self._corrections)
        slices = lanes.reshape(len(rows), len(self._corrections), 8)
        self._corrections[:, rows] = np.moveaxis(slices, 1, 0)
        self._active[rows] = True

    def corrected_residues(self, degree: int) -> Floats:
        """Sum W_q u_q over all stored pairs of degrees; (primes, canonical, s)."""
        known = set(self._degrees)
        splits = [(n, degree - n) for n in self._correction_degrees if degree - n in known]
        out = self._product(
            self._corrections, self._seed_modes, degree, splits, sparse=True
        )
        count, seeds = len(self.basis), len(self.space.seeds)
        columns = self._canonical_points(degree, out)[:, : seeds * count]
        return np.moveaxis(columns.reshape(len(columns), seeds, count), 2, 0)

    def multiply_at(
        self, values: Floats, wanted: NDArray[np.bool_], factors: Floats, places: Ints
    ) -> None:
        """values[:, wanted] *= factors[:, places]; values (primes, rows, N-1), sums of residues."""
        at, of = np.flatnonzero(wanted), places[wanted]
        flat = values.reshape(len(values), -1)

        def work(i: int) -> None:
            own = self.basis.reduced(flat[i, at], i) * factors[i, of]
            flat[i, at] = self.basis.reduced(own, i)

        list(self._pool.map(work, range(len(self.basis))))

    def matrix_products(
        self,
        left: Floats,
        rows: Any,
        columns: Any,
        right: Floats,
        total: Floats,
        places: tuple[Any, Any],
    ) -> None:
        """total[:, *places] += left[:, rows, columns] right modulo every prime.

        left, right, total : (primes, ., .); sums of any length.
        """
        step = self._limit - 1
        length = right.shape[1]

        def work(i: int) -> None:
            factor = left[i][rows][:, columns]
            for start in range(0, length, step):
                some = slice(start, start + step)
                product = factor[:, some] @ right[i, some]
                product += total[i][places]
                total[i][places] = self.basis.reduced(product, i)

        list(self._pool.map(work, range(len(self.basis))))


def _padded(values: Floats, target: Floats) -> Floats:
    """(rows, a, b) as the lanes of all slices of the target, (rows, slices lanes)."""
    slices, _, width = target.shape
    rows, a, b = values.shape
    lanes = np.zeros((rows, slices * width))
    lanes[:, : a * b] = values.reshape(rows, a * b)
    return lanes
