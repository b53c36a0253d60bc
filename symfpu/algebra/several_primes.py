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
from functools import lru_cache
from math import isqrt
from typing import Any

import numpy as np

from symfpu.algebra.at_points import AtPoints
from symfpu.algebra.dense import Floats, ValuesRing, aligned_zeros, degrees_of
from symfpu.algebra.grading import Grading, Ints
from symfpu.algebra.rooms import Rooms
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.words import ResidueBasis, TooFewPrimes

PRODUCTS = 128  # that sums may have between two reductions, at least
EXACT = 2**52  # integers below it are exact in doubles, and so are their remainders
# why the ring has no cosines, reciprocals or matrix products of its own
_OWNER = (
    "integers are transformed and rounded by the fixed-point ring that owns these residues"
)
AHEAD = 8  # degrees whose squares are begun at once
PORTION = 4096  # integers on all bonds or modes of the monomials that are converted at once
LANES = 32  # of a row: four registers of AVX-512, eight of AVX2
# residues on bonds of some canonical monomials, (primes, some, half)
Portions = Callable[[slice], Floats]


def products_between_reductions(degree: int) -> int:
    """How many products are summed before they are reduced; a split in one seed has fewer."""
    return max(PRODUCTS, degree + 4)


@lru_cache(maxsize=4)
def at_points(grading: Grading) -> AtPoints | None:
    """How series are kept at points; None where they are kept by their coefficients."""
    return AtPoints(grading) if AtPoints.fits(grading) else None


def residue_basis(grading: Grading, bits: int) -> ResidueBasis:
    """Primes for integers of so many bits, at whose roots of unity there are points, if they are
    enough of them; there are fewer at high orders.
    """
    largest, points = largest_prime(grading.degree), at_points(grading)
    if points is not None:
        try:
            return ResidueBasis(bits, largest, points.divisor)
        except TooFewPrimes:
            pass
    return ResidueBasis(bits, largest)


def largest_prime(degree: int) -> int:
    """Primes below this keep so many products of residues exact: p^2/4 each, and a little more."""
    return isqrt(4 * EXACT // (products_between_reductions(degree) + 1))


class SeveralPrimesRing(ValuesRing):
    """Coefficients modulo the primes of a basis; what it stores was rounded by its owner."""

    name = "several primes"
    reduces = True
    kind = np.float32  # holds residues of such primes: half of the memory that kernels read

    def __init__(self, space: CosineModes, basis: ResidueBasis) -> None:
        # lazy: numba takes longer to import than all the rest
        from symfpu.algebra import point_loops

        self.basis = basis
        self._point_loops = point_loops
        points = at_points(space.grading)
        fits = points is not None and points.divide(basis.primes)
        self._at_points = points if fits else None
        self._limit = products_between_reductions(space.grading.degree)
        # the first of the degrees to which lower ones gave their squares already, and these
        self._early: tuple[int, Floats] = (0, np.zeros((0, 0, 0, 0)))
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
        if self._at_points:
            there, back = self._at_points.powers, self._at_points.inverse_powers
            self._there, self._back = (
                self._by_lane(f(basis.primes)) for f in (there, back)
            )

    def _by_slice(self, moduli: Floats, width: int) -> Floats:
        """Moduli of all lanes, (slices, width); lanes without a residue are zero, modulo 1."""
        slices = -(-len(moduli) // width)
        padded = np.ones(slices * width)
        padded[: len(moduli)] = moduli
        return padded.reshape(slices, width)

    def _by_lane(self, table: Floats) -> Floats:
        """Residues (entries, primes) for every lane, (slices, entries, lanes)."""
        lanes = np.zeros((len(table), self._moduli.size))
        lanes[:, : self._points] = np.repeat(table, self.space.half, axis=1)
        return np.ascontiguousarray(
            np.moveaxis(lanes.reshape(len(table), *self._moduli.shape), 1, 0)
        )

    def _lane_width(self) -> int:
        return LANES

    def _place(self, shape: tuple[int, ...]) -> Floats:
        return self._rooms.take(shape)

    def _kept_count(self) -> int:
        points = self._at_points
        return int(points.rows.first[-1]) if points else super()._kept_count()

    def _kept_rows(self, degree: int) -> Any:
        points = self._at_points
        return points.rows_of(degree) if points else super()._kept_rows(degree)

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
        """Register a degree, (primes, monomials, N-1); its bonds are stored apart."""
        seeds = np.array(self.space.seeds) - 1
        self.store_seeds(degree, modes[:, :, seeds])

    def store_seeds(self, degree: int, modes: Floats) -> None:
        """The same by the modes of the seeds alone, (primes, monomials, s)."""
        self._degrees.append(degree)
        if degree == self.grading.degree:
            return  # it is a factor of nothing
        first = int(self.grading.first_row[degree])
        rows, conjugates = self._ordered(degree, slice(None))
        self._kernels.to_lanes(modes, self._seed_modes, first + rows, first + conjugates)

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
        """Values of all monomials and their conjugates, or those at points.

        Not of the last degree, which is a factor of nothing.
        """
        if degree == self.grading.degree:
            return
        if not self._at_points:
            first = int(self.grading.first_row[degree])
            self._put_lanes(target, degree, first, values)
            return
        rows = self._rows(degree)
        own = aligned_zeros((self._slices, rows.stop - rows.start, self._lanes))
        self._put_lanes(own, degree, 0, values)
        self._over_slices(
            self._point_loops.evaluate,
            own,
            degree,
            self._skipped(degree),
            self.grading.tables,
            self._at_points.rows,
            self._there,
            self._at_points.places(degree),
            target,
        )

    def _over_slices(self, loop: Callable[..., int], *arguments: Any) -> None:
        """Run a loop of residues at points over all slices, shared among the threads."""
        every = np.arange(self._slices)
        lanes, common = (0.0,) * self._lanes, (self._moduli, self._limit)

        def work(parts: Ints) -> int:
            return int(loop(lanes, *arguments, *common, parts))

        shares = [every[n :: self._workers] for n in range(self._workers)]
        self.multiply_adds += sum(self._pool.map(work, shares))

    def _skipped(self, degree: int) -> int:
        """Coefficients before the first canonical one, where one seed leaves the others out."""
        alone = len(self.space.seeds) == 1
        return int(self.grading.canonical(degree)[0]) if alone else 0

    def _put_lanes(self, target: Floats, degree: int, first: int, values: Portions) -> None:
        """All monomials and their conjugates, from a row on."""

        def work(some: slice) -> None:
            rows, conjugates = self._ordered(degree, some)
            self._kernels.to_lanes(values(some), target, first + rows, first + conjugates)

        list(self._pool.map(work, self.pieces(degree)))

    def _special(self, *product: Any) -> Floats | None:
        """At points, where there are any."""
        return self._of_points(*product) if self._at_points else super()._special(*product)

    def _of_points(
        self,
        left: Floats,
        right: Floats,
        degree: int,
        splits: list[tuple[int, int]],
        symmetric: bool,
    ) -> Floats:
        assert self._at_points is not None
        rows = self._rows(degree)
        out = self._place((self._slices, rows.stop - rows.start, self._lanes))
        both = [(e, d) for d, e in splits] if symmetric else []
        early = symmetric and self._at_points.alone
        since, sums = self._early_squares(degree) if early else (0, None)
        self._over_slices(
            self._point_loops.multiply,
            left,
            right,
            out,
            degree,
            degrees_of([*splits, *both], degree),
            symmetric,
            since,
            sums,
            self.grading.wanted_blocks(degree),
            self._skipped(degree),
            self.grading.tables,
            self._at_points.rows,
            self._back,
            self._at_points.inverse_places(degree),
        )
        return out

    def _early_squares(self, degree: int) -> tuple[int, Floats]:
        """What degrees below one, which is given, give to the values of a square.

        (slices, points, lanes).
        """
        since, sums = self._early
        if not since <= degree < since + len(sums):
            since = degree
            sums = self._squares_from(degree)
            self._early = since, sums
        return since, sums[degree - since]

    def _squares_from(self, degree: int) -> Floats:
        """The same for a degree and the next ones, (degrees, slices, points, lanes)."""
        assert self._at_points is not None
        several = min(AHEAD, self.grading.degree + 1 - degree)
        points = len(self._at_points.rows.first) - 1
        sums = aligned_zeros((several, self._slices, points, self._lanes))
        has = np.zeros(degree + several, dtype=np.bool_)
        has[[d for d in self._degrees if d < degree]] = True

        self._over_slices(
            self._point_loops.square_early,
            self._bonds,
            sums,
            degree,
            has,
            self.grading.tables,
            self._at_points.rows,
        )
        return sums

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
            rows = self._kept_rows(j)
            self._weighted[:, rows] = self._reduced(self._bonds[:, rows] * weight)
        return self._weighted

    def correct_by(self, degree: int, corrections: Floats) -> None:
        """Register corrections, (primes, diagonal, s)."""
        self._correction_degrees.append(degree)
        rows = self._diagonal_rows(degree)
        self._kernels.to_lanes(corrections, self._corrections, rows, rows)
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
