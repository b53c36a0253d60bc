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
from symfpu.algebra.grading import Ints
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.several_primes import (
    Portions,
    SeveralPrimesRing,
    residue_basis,
)
from symfpu.algebra.words import LIMB_BITS, IntegerTable, divided


class Precision(NamedTuple):
    """bits : binary places, as `words.whole_places` gives them; for growths a multiple of 20.

    Headroom : bits of the largest sum above 2^(2 bits). unit : scale of a degree.
    """

    bits: int
    headroom: int
    unit: Fraction


class Modes(NamedTuple):
    """Coefficients of one degree: residues (primes, canonical, N-1), and the integers as words.

    Residues are singles where there are many of them.
    """

    residues: Floats
    table: IntegerTable


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
        self.basis = residue_basis(space.grading, precision.bits + bits)
        self._rounded_basis = self.basis.beginning(bits + 1)
        self._image = SeveralPrimesRing(space, self.basis)
        self._threads = threads_of_a_computation()
        self._pool = ThreadPoolExecutor(self._threads)
        self._to_bonds = self._cosines(np.ones(space.half))
        self._back: dict[Fraction, Floats] = {}
        self._stored: set[tuple[int, int]] = set()  # powers of the bonds, and their degrees
        rows = len(space.grading.canonical(space.grading.degree))
        size = len(self.basis) * rows * (space.N - 1)
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
            for j, weight in enumerate(weights):
                column = _weighted(table, Fraction(weight))
                whole[:, j] = column[angles[:, j]]
        return self.basis.of_integers(whole)

    def _to_modes(self, coefficient: Fraction) -> Floats:
        """The way back, times a coefficient.

        Weights 4/N, and half of it for a bond that is its own mirror image.
        """
        if coefficient not in self._back:
            N, half = self.space.N, self.space.half
            weights = [coefficient * Fraction(4, N)] * half
            if N % 2:
                weights[-1] = coefficient * Fraction(2, N)
            self._back[coefficient] = self._cosines(np.array(weights, dtype=object))
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

    def _rounded_words(
        self, residues: Floats, wanted: NDArray[np.bool_]
    ) -> NDArray[np.int64]:
        """The wanted entries of (primes, rows, columns), rounded; the others are exactly zero.

        residues : overwritten. Returns the words of the wanted ones.
        """
        flat, bits = residues.reshape(len(self.basis), -1), self.precision.bits
        return self.basis.rounded_words(flat, wanted.ravel(), bits, self._rounded_basis)

    def _modes_of(self, degree: int, wanted: NDArray[np.bool_], values: Portions) -> Modes:
        """The wanted entries of portions (primes, some, N-1), rounded.

        Their residues lie where those of the last call lay, whose portions may be read until they
        are replaced: fresh memory of that size takes longer than the work.
        """
        shape = (len(self.basis), *wanted.shape)
        residues = self._room[: math.prod(shape)].reshape(shape)

        def convert(some: slice) -> NDArray[np.int64]:
            own = values(some)
            words = self._rounded_words(own, wanted[some])
            residues[:, some] = own
            return words

        words = _joined(list(self._pool.map(convert, self._image.pieces(degree))))
        return Modes(residues, _table(words, wanted))

    def seed_terms(self) -> Modes:
        seeds, one = self.space.seeds, 1 << self.precision.bits
        whole = np.zeros((len(seeds), self.space.N - 1), dtype=object)
        for row, power in enumerate(self.grading.powers(1)):
            seed = seeds[int(np.argmax(power))]
            whole[row, seed - 1] = one
        return Modes(self.basis.of_integers(whole), IntegerTable.of(whole))

    def put(self, degree: int, modes: Modes) -> None:
        self._modes.append(modes.table)
        self._image.store(degree, modes.residues)
        parity = self.space.parity(degree)

        def values(some: slice) -> Floats:
            own = modes.residues[:, some].astype(np.float64)
            bonds = np.zeros((*own.shape[:2], self.space.half))
            for rows, columns in _parts(parity[some]):
                left, right = own[:, rows, columns], self._to_bonds[:, columns]
                bonds[:, rows] = self._image.add_matrix_product(bonds[:, rows], left, right)
            return self._rounded(bonds)

        self._image.store_bonds(degree, values)

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

    def project(self, degree: int, parts: Sequence[tuple[Fraction, Bonds]]) -> Modes:
        parity = self.space.parity(degree)
        sources = []
        for coefficient, bonds in parts:
            scale = bonds.factor / self.precision.unit**bonds.power
            back = np.moveaxis(self._to_modes(coefficient * scale), 1, 2)
            sources.append((bonds.values, back))

        def values(some: slice) -> Floats:
            modes = np.zeros((len(self.basis), len(parity[some]), self.space.N - 1))
            for on_bonds, back in sources:
                own = on_bonds(some)
                for rows, columns in _parts(parity[some]):
                    before, right = modes[:, rows, columns], back[:, :, columns]
                    product = self._image.add_matrix_product(before, own[:, rows], right)
                    modes[:, rows, columns] = product
            return modes

        return self._modes_of(degree, self.space.mask(degree), values)

    def secular(self, degree: int, modes: Modes) -> Modes:
        # the image only picks entries
        residues = self._image.secular(degree, np.moveaxis(modes.residues, 0, 2))
        words = self._image.secular(degree, modes.table.words)
        return Modes(np.moveaxis(residues, 2, 0), IntegerTable(words))

    def correct(self, degree: int, corrections: Modes) -> None:
        self._corrections.append(corrections.table)
        self._image.correct_by(degree, corrections.residues)

    def corrected(self, degree: int) -> Modes:
        residues = np.ascontiguousarray(self._image.corrected_residues(degree))
        every = np.ones(residues.shape[1:], dtype=np.bool_)
        words = self._rounded_words(residues, every)
        return Modes(residues, _table(words, every))

    def solve(
        self, degree: int, corrected: Modes, force: Modes, multipliers: NDArray[np.object_]
    ) -> Modes:
        _, index = self.grading.harmonics(degree)
        seeds = np.array(self.space.seeds) - 1
        sizes = np.abs((multipliers / 2**self.precision.bits).astype(float))
        carried = multipliers != 0
        places = np.cumsum(carried).reshape(carried.shape) - 1
        factors = self.basis.of_integers(multipliers[carried])

        def values(some: slice) -> Floats:
            own = index[some]
            self._check_range(corrected.table, force.table, sizes[own], some)
            bracket = -force.residues[:, some].astype(np.float64)
            bracket[:, :, seeds] += corrected.residues[:, some]
            flat = bracket.reshape(len(bracket), -1)
            self.basis.multiply_places(flat, carried[own], factors, places[own])
            return bracket

        return self._modes_of(degree, carried[index], values)

    def _check_range(
        self, corrected: IntegerTable, force: IntegerTable, factors: Floats, some: slice
    ) -> None:
        """Refuse the last products beyond the range of the residues: they have no bound before."""
        below, seeds = -self.precision.bits, np.array(self.space.seeds) - 1
        sizes = np.abs(IntegerTable(force.words[some]).floats(below))
        sizes[:, seeds] += np.abs(IntegerTable(corrected.words[some]).floats(below))
        if np.any(sizes * factors > 2.0**self.precision.headroom):
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


def _parts(parity: Ints) -> list[tuple[Ints, slice]]:
    """Monomials of each parity with the modes of that parity."""
    even, odd = (np.flatnonzero(parity == p) for p in (0, 1))
    return [(even, slice(1, None, 2)), (odd, slice(0, None, 2))]


def _joined(words: Sequence[NDArray[np.int64]]) -> NDArray[np.int64]:
    """Words (count, n) of several parts as one array, of as many words as the longest."""
    longest = max(part.shape[1] for part in words)
    padded = [np.pad(part, ((0, 0), (0, longest - part.shape[1]))) for part in words]
    return np.concatenate(padded)


def _table(words: NDArray[np.int64], wanted: NDArray[np.bool_]) -> IntegerTable:
    """Words (count, n) in their places of a table; the other entries are zero."""
    table = np.zeros((*wanted.shape, words.shape[1]), dtype=np.int64)
    table[wanted] = words
    return IntegerTable(table)


def _weighted(table: Sequence[Any], weight: Fraction) -> NDArray[np.object_]:
    """Every entry times the weight, as integers, rounded to nearest."""
    products = [x * weight.numerator / weight.denominator for x in table]
    return np.array([int(mpmath.nint(x)) for x in products], dtype=object)
