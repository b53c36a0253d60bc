"""The ring of fixed-point numbers: integers times 2^-bits, of any number of digits, multiplied
modulo many primes.

Every product of the recursion (on bonds, with cosines, with multipliers) is exact, modulo primes
so small that it costs one multiply-add each (`SeveralPrimesRing`). Between two products the
integers are recombined and rounded to the nearest at `bits` binary places. All arrays of degree d
carry the factor unit^-(d - 1), which keeps the degrees of one series near one.

A function g with (1 + slope r) g' = rate g is kept as h = (g - 1)/(2 rate), which begins as c:
    h_d = c_d + 2/d sum (rate j - slope (d - j)) c_j h_(d-j),
an exact sum that is rounded once, when it is divided.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from typing import Any, NamedTuple

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.dense import Floats, threads_of_a_computation
from symfpu.algebra.fixedpoint_tables import CollectedWords, Factors
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.several_primes import Portions, SeveralPrimesRing, largest_prime
from symfpu.algebra.words import (
    LIMB_BITS,
    SIZE_ERROR,
    IntegerTable,
    ResidueBasis,
    divided,
    words_of,
)


class Precision(NamedTuple):
    """bits : binary places, as `words.whole_places` gives them; for growths a multiple of 20.

    Headroom : bits of the largest sum above 2^(2 bits). unit : scale of a degree.
    """

    bits: int
    headroom: int
    unit: Fraction


class Modes(NamedTuple):
    """Integers: residues (primes, rows, columns), and the same as words."""

    residues: Floats
    table: IntegerTable


# of the even monomials of a degree and of the odd ones, with the modes of their parity
ByParity = tuple[Any, Any]


class Coordinates(NamedTuple):
    """Coefficients of one degree: residues (primes, monomials, modes), and the integers as words.

    Residues are singles where there are many of them. table : (canonical, N-1).
    """

    residues: ByParity
    table: IntegerTable


class Force(NamedTuple):
    """Residues of one degree, (primes, monomials, modes), and sizes (monomials, modes).

    sizes : of the integers before they were rounded, as `ResidueBasis.round_in_place` gives them.
    """

    residues: ByParity
    sizes: ByParity


class Corrected(NamedTuple):
    """The same of sum W u: residues (primes, monomials, s), even monomials first."""

    residues: Floats
    sizes: Floats


class Piece(NamedTuple):
    """Neighbouring monomials of one parity: their places among all of a degree, even ones first,
    and among those of that parity.
    """

    parity: int
    some: slice
    own: slice


class Bonds(NamedTuple):
    """Values on bonds, of portions of the canonical monomials, still to be multiplied by
    factor unit^-power.
    """

    values: Portions
    power: int
    factor: Fraction = Fraction(1)


class FixedPointRing:
    """Coefficients as integers times 2^-bits."""

    name = "fixedpoint"
    grows = True

    def __init__(self, space: CosineModes, precision: Precision) -> None:
        self.space, self.grading, self.precision = space, space.grading, precision
        bits = precision.bits + precision.headroom
        largest = largest_prime(space.grading.degree)
        self.basis = ResidueBasis(precision.bits + bits, largest)
        self._rounded_basis = self.basis.beginning(bits + 1)
        self._image = SeveralPrimesRing(space, self.basis)
        self._threads = threads_of_a_computation()
        self._pool = ThreadPoolExecutor(self._threads)
        to_bonds = self._cosines(np.ones(space.half))
        self._to_bonds = self._by_parity(to_bonds, axis=1)
        self._back: dict[Fraction, ByParity] = {}
        self._factors = Factors(self.basis, precision.bits, space.N - 1, self._image.kind)
        self._stored: set[tuple[int, int]] = set()  # powers of the bonds, and their degrees
        rows = len(space.grading.canonical(space.grading.degree))
        size = len(self.basis) * rows * space.half
        self._room = np.empty(size, dtype=np.float32)  # of the residues of one degree
        self._modes: list[IntegerTable] = []
        self._corrections: list[IntegerTable] = []

    @property
    def multiply_adds(self) -> int:
        """Multiply-adds of the kernels, over all primes."""
        return self._image.multiply_adds

    def coupling(self, power: int, value: Fraction) -> Fraction:
        return value

    def _cosines(self, weights: NDArray[Any]) -> Floats:
        """Residues of weight_j cos(q (j + 1/2) pi / N) on half of the bonds.

        Shape (primes, N-1, points).
        """
        N, half, bits = self.space.N, self.space.half, self.precision.bits
        odd = 2 * np.arange(half) + 1
        angles = np.outer(np.arange(1, N), odd) % (4 * N)
        angles = np.minimum(angles, 4 * N - angles)
        whole = np.zeros((N - 1, half), dtype=object)
        largest = max(1, *(abs(w) for w in weights))
        with mpmath.workprec(bits + math.ceil(math.log2(largest)) + 32):
            cosines = [mpmath.cospi(mpmath.mpf(n) / (2 * N)) for n in range(2 * N + 1)]
            table = [mpmath.ldexp(cosine, bits) for cosine in cosines]
            own = {weight: _weighted(table, Fraction(weight)) for weight in set(weights)}
            for j, weight in enumerate(weights):
                whole[:, j] = own[weight][angles[:, j]]
        return self.basis.of_integers(whole)

    def _by_parity(self, of_modes: Floats, axis: int) -> ByParity:
        """What is given for all modes, on an axis, for the even and for the odd ones."""
        before = (slice(None),) * axis
        even, odd = (of_modes[*before, self.space.modes(parity)] for parity in (0, 1))
        return np.ascontiguousarray(even), np.ascontiguousarray(odd)

    def _to_modes(self, coefficient: Fraction) -> ByParity:
        """The way back, times a coefficient; (primes, points, modes).

        Weights 4/N, and half of it for a bond that is its own mirror image.
        """
        if coefficient not in self._back:
            N, half = self.space.N, self.space.half
            weights = [coefficient * Fraction(4, N)] * half
            if N % 2:
                weights[-1] = coefficient * Fraction(2, N)
            cosines = self._cosines(np.array(weights, dtype=object))
            self._back[coefficient] = self._by_parity(np.moveaxis(cosines, 1, 2), axis=2)
        return self._back[coefficient]

    def _rounded(self, residues: Floats, divisor: int = 1) -> Floats:
        """Integers / (2^bits divisor), rounded; residues (primes, ...), overwritten."""
        flat, bits = residues.reshape(len(self.basis), -1), self.precision.bits
        if divisor == 1:
            every = np.ones(flat.shape[1], dtype=np.bool_)
            self.basis.round_in_place(flat, every, bits)
        else:
            limbs = self.basis.limbs(flat, bits // LIMB_BITS - 1)
            flat[:] = self.basis.residues(divided(limbs, divisor))
        return residues

    def _pieces(self, degree: int) -> list[Piece]:
        return [self._piece(degree, some) for some in self._image.pieces(degree)]

    def _piece(self, degree: int, some: slice) -> Piece:
        _, even = self.space.even_first(degree)
        parity = int(some.start >= even)
        first = even * parity
        return Piece(parity, some, slice(some.start - first, some.stop - first))

    def _of_monomials(self, degree: int, of_canonical: NDArray[Any]) -> ByParity:
        """What is given for each canonical monomial and mode, for those of one parity."""
        order, even = self.space.even_first(degree)
        parts = order[:even], order[even:]
        even_part, odd_part = (
            np.ascontiguousarray(of_canonical[rows, self.space.modes(parity)])
            for parity, rows in enumerate(parts)
        )
        return even_part, odd_part

    def _room_for(self, degree: int) -> ByParity:
        """Place for the residues of a degree, where those of the last one lay.

        They may be read, portion by portion, until they are replaced: fresh memory of that size
        takes longer than the work.
        """
        order, even = self.space.even_first(degree)
        counts, primes, parts = (even, len(order) - even), len(self.basis), []
        start = 0
        for parity, count in enumerate(counts):
            shape = (primes, count, self._to_bonds[parity].shape[1])
            end = start + math.prod(shape)
            parts.append(self._room[start:end].reshape(shape))
            start = end
        return parts[0], parts[1]

    def seed_terms(self) -> Coordinates:
        seeds, one = self.space.seeds, 1 << self.precision.bits
        whole = np.zeros((len(seeds), self.space.N - 1), dtype=object)
        for row, power in enumerate(self.grading.powers(1)):
            seed = seeds[int(np.argmax(power))]
            whole[row, seed - 1] = one
        even, odd = (self.basis.of_integers(part) for part in self._of_monomials(1, whole))
        return Coordinates((even, odd), IntegerTable.of(whole))

    def put(self, degree: int, modes: Coordinates) -> None:
        self._modes.append(modes.table)
        self._image.store_seeds(degree, self._of_seeds(degree, modes.residues))

        def values(some: slice) -> Floats:
            parity, _, own = self._piece(degree, some)
            residues = modes.residues[parity][:, own].astype(np.float64)
            cosines = self._to_bonds[parity]
            return self._rounded(self._image.matrix_product(residues, cosines))

        self._image.store_bonds(degree, values)

    def _of_seeds(self, degree: int, residues: ByParity) -> Floats:
        """Residues of the modes of the seeds; (primes, monomials, s), even ones first."""
        order, even = self.space.even_first(degree)
        columns = np.zeros((len(self.basis), len(order), len(self.space.seeds)))
        for i, q in enumerate(self.space.seeds):
            rows = slice(even, None) if q % 2 else slice(even)
            columns[:, rows, i] = residues[q % 2][:, :, place(q)]
        return columns

    def _bonds(self, rows: Floats, power: int, degree: int) -> Bonds:
        """A power of the bonds, from half of it by the kernel's rows."""

        def values(some: slice) -> Floats:
            return self._rounded(self._image.residues(degree, rows, some, 2.0))

        return Bonds(values, power - 1)

    def power(self, power: int, degree: int) -> Bonds:
        lower = power - 1
        for d in range(lower, degree if power > 2 else 0):
            if (lower, d) not in self._stored:
                self._put_power(lower, d)
        return self._bonds(self._image.power_rows(power, degree), power, degree)

    def _put_power(self, power: int, degree: int) -> None:
        bonds = self.power(power, degree)
        self._stored.add((power, degree))
        self._image.store_power(power, degree, bonds.values)

    def number(self, value: Fraction) -> Fraction:
        return value

    def growth(self, number: int, slope: Fraction, rate: Fraction, degree: int) -> Bonds:
        """As of `GrowingRing`: h, with the factor 2 rate."""
        name = -1 - number
        whole, share = whole_growth(slope, rate, degree, self.precision.unit)
        sums = self._image.canonical_growth(name, *whole, degree)
        numerator = self.basis.of_integers(np.array([share.numerator], dtype=object))
        self.basis.scale(sums.reshape(len(self.basis), -1), numerator[:, 0])
        grown = self._rounded(sums, share.denominator)

        def values(some: slice) -> Floats:
            return grown[:, some]

        self._image.store_power(name, degree, values)
        return Bonds(values, 0, 2 * rate)

    def project(self, degree: int, parts: Sequence[tuple[Fraction, Bonds]]) -> Force:
        sources = []
        for coefficient, bonds in parts:
            scale = bonds.factor / self.precision.unit**bonds.power
            sources.append((bonds.values, self._to_modes(coefficient * scale)))
        residues = self._room_for(degree)
        wanted = self._of_monomials(degree, self.space.mask(degree))
        sizes = np.empty(wanted[0].shape), np.empty(wanted[1].shape)

        def convert(piece: Piece) -> None:
            parity, some, own = piece
            products = [
                self._image.matrix_product(values(some), back[parity])
                for values, back in sources
            ]
            nothing = np.zeros((len(self.basis), *wanted[parity][own].shape))
            total, *others = products or [nothing]  # there are orders without a force
            for other in others:
                total += other
                self.basis.reduce(total)
            flat, sizes_of = total.reshape(len(total), -1), sizes[parity][own]
            some_wanted = wanted[parity][own].ravel()
            self.basis.round_in_place(
                flat, some_wanted, self.precision.bits, sizes_of.reshape(-1)
            )
            residues[parity][:, own] = total

        list(self._pool.map(convert, self._pieces(degree)))
        return Force(residues, sizes)

    def secular(self, degree: int, modes: Force) -> Modes:
        order, even = self.space.even_first(degree)
        places = np.argsort(order)
        columns = []
        for q, at in zip(self.space.seeds, self._image.secular_rows(degree), strict=True):
            first = even if q % 2 else 0
            columns.append(modes.residues[q % 2][:, places[at] - first, place(q)])
        residues = np.stack(columns, axis=2)
        return Modes(residues, self._table(residues))

    def _table(self, residues: Floats) -> IntegerTable:
        """Words of rounded integers, (primes, rows, columns)."""
        first = self._rounded_basis
        flat = residues[: len(first)].reshape(len(first), -1).astype(np.float64)
        words = words_of(first.limbs(flat))
        return IntegerTable(words.reshape(*residues.shape[1:], words.shape[1]))

    def correct(self, degree: int, corrections: Modes) -> None:
        self._corrections.append(corrections.table)
        self._image.correct_by(degree, corrections.residues)

    def corrected(self, degree: int) -> Corrected:
        residues = self._image.corrected_residues(degree)
        sizes = np.empty(residues.shape[1:])
        every = np.ones(sizes.size, dtype=np.bool_)
        flat = residues.reshape(len(residues), -1)
        self.basis.round_in_place(flat, every, self.precision.bits, sizes.reshape(-1))
        return Corrected(residues, sizes)

    def solve(
        self,
        degree: int,
        corrected: Corrected,
        force: Force,
        multipliers: NDArray[np.object_],
    ) -> Coordinates:
        residues, factors = self._room_for(degree), self._factors
        numbers = factors.numbers(self.grading.harmonics(degree)[0], multipliers)
        carried, sizes_of = numbers > 0, factors.sizes[numbers]
        _, index = self.grading.harmonics(degree)
        order, _ = self.space.even_first(degree)
        integers = CollectedWords(order, self.space.N, self._rounded_basis)

        def convert(piece: Piece) -> None:
            parity, some, own = piece
            modes, harmonics = self.space.modes(parity), index[order[some]]
            bracket, sizes = self._bracket(corrected, force, piece)
            self._check_range(bracket, sizes, sizes_of[harmonics, modes])
            flat, wanted = bracket.reshape(len(bracket), -1), carried[harmonics, modes]
            self.basis.multiply_places(
                flat, wanted, factors.residues, numbers[harmonics, modes]
            )
            words = self.basis.rounded_words(
                flat, wanted.ravel(), self.precision.bits, self._rounded_basis
            )
            integers.put(some, modes, wanted, words)
            residues[parity][:, own] = bracket

        list(self._pool.map(convert, self._pieces(degree)))
        return Coordinates(residues, integers.table())

    def _bracket(
        self, corrected: Corrected, force: Force, piece: Piece
    ) -> tuple[Floats, Floats]:
        """Residues of sum W u - force, (primes, monomials, modes), and sizes above its own."""
        parity, some, own = piece
        bracket = -force.residues[parity][:, own].astype(np.float64)
        sizes = force.sizes[parity][own].copy()
        for i, q in enumerate(self.space.seeds):
            if q % 2 == parity:
                bracket[:, :, place(q)] += corrected.residues[:, some, i]
                sizes[:, place(q)] += corrected.sizes[some, i]
        return bracket, sizes

    def _check_range(self, bracket: Floats, sizes: Floats, factors: Floats) -> None:
        """Refuse the last products beyond the range of the residues: they have no bound before.

        bracket : residues. sizes : of it before it was rounded. factors : moduli of multipliers.
        """
        bits, headroom = self.precision.bits, self.precision.headroom
        unit = float(Fraction(self.basis.modulus, 2 ** (2 * bits + headroom)))
        if np.all((sizes + 2 * SIZE_ERROR) * unit * factors <= 1):
            return
        exact = np.abs(self._table(bracket).floats(-bits))
        if np.any(exact * factors > 2.0**headroom):
            what = "a product of a force with its multiplier"
            raise OverflowError(f"{what} exceeds the range of the residues")

    def results(self) -> tuple[list[IntegerTable], list[IntegerTable], Fraction]:
        return self._modes, self._corrections, self.precision.unit


def whole_growth(
    slope: Fraction, rate: Fraction, degree: int, unit: Fraction
) -> tuple[tuple[Fraction, Fraction], Fraction]:
    """Whole slope and rate for the sum of a growth, and the number that the sum is then times.

    Where slope is 0 the sum leaves the rate to that number.
    """
    share = Fraction(2, degree) / unit
    if not slope:
        return (slope, rate), rate * share
    common = math.lcm(slope.denominator, rate.denominator)
    return (slope * common, rate * common), share / common


def place(mode: int) -> int:
    """Where a mode stands among those of its parity."""
    return (mode - 1) // 2


def _weighted(table: Sequence[Any], weight: Fraction) -> NDArray[np.object_]:
    """Every entry times the weight, as integers, rounded to nearest."""
    products = [x * weight.numerator / weight.denominator for x in table]
    return np.array([int(mpmath.nint(x)) for x in products], dtype=object)
