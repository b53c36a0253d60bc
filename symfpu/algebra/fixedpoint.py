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
from symfpu.algebra.several_primes import SeveralPrimesRing, largest_prime
from symfpu.algebra.words import LIMB_BITS, IntegerTable, ResidueBasis, divided, words_of

BLOCK = 1 << 15  # integers converted at once, so that they stay in the cache


class Precision(NamedTuple):
    """bits : binary places, a multiple of 20.

    Headroom : bits of the largest sum above 2^(2 bits). unit : scale of a degree.
    """

    bits: int
    headroom: int
    unit: Fraction


class Modes(NamedTuple):
    """Coefficients of one degree: residues (primes, canonical, N-1), and the integers as words."""

    residues: Floats
    table: IntegerTable


class Bonds(NamedTuple):
    """Values on bonds: residues (primes, canonical, points), still to be multiplied by
    factor unit^-power.
    """

    residues: Floats
    power: int
    factor: Fraction = Fraction(1)


class FixedPointRing:
    """Coefficients as integers times 2^-bits."""

    name = "fixedpoint"
    grows = True

    def __init__(self, space: CosineModes, precision: Precision) -> None:
        self.space, self.grading, self.precision = space, space.grading, precision
        self._drop = precision.bits // LIMB_BITS
        largest = largest_prime(space.grading.degree)
        self.basis = ResidueBasis(2 * precision.bits + precision.headroom, largest)
        self._image = SeveralPrimesRing(space, self.basis)
        self._threads = threads_of_a_computation()
        self._pool = ThreadPoolExecutor(self._threads)
        self._to_bonds = self._cosines(np.ones(space.half))
        self._back: dict[Fraction, Floats] = {}
        self._stored: set[tuple[int, int]] = set()  # powers of the bonds, and their degrees
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

    def _rounded(
        self, residues: Floats, divisor: int = 1
    ) -> tuple[Floats, NDArray[np.int64]]:
        """Integers / (2^bits divisor), rounded: residues (primes, count) and words (count, n)."""
        if divisor == 1:
            every = np.ones(residues.shape[1], dtype=np.bool_)
            return residues, self._round(residues, every)
        starts = range(0, residues.shape[1], BLOCK)

        def convert(start: int) -> tuple[Floats, NDArray[np.int64]]:
            block = residues[:, start : start + BLOCK].copy()
            limbs = divided(self.basis.limbs(block, self._drop - 1), divisor)
            return self.basis.residues(limbs), words_of(limbs)

        parts = list(self._pool.map(convert, starts))
        if not parts:
            return np.zeros((len(self.basis), 0)), np.zeros((0, 1), dtype=np.int64)
        rounded, words = zip(*parts, strict=True)
        return np.concatenate(rounded, axis=1), _joined(words)

    def _round(self, residues: Floats, wanted: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Integers / 2^bits in their place, zero where not wanted; words of the wanted ones."""
        step = max(BLOCK, -(-len(wanted) // (8 * self._threads)))

        def convert(start: int) -> NDArray[np.int64]:
            some = slice(start, start + step)
            return self.basis.round_in_place(residues[:, some], wanted[some], self._drop)

        parts = list(self._pool.map(convert, range(0, len(wanted), step)))
        return _joined(parts) if parts else np.zeros((0, 1), dtype=np.int64)

    def _rounded_where(self, residues: Floats, wanted: NDArray[np.bool_]) -> Modes:
        """Round the wanted entries of (primes, rows, columns); the others are exactly zero."""
        flat = residues.reshape(len(self.basis), -1)
        words = self._round(flat, wanted.ravel())
        table = np.zeros((*wanted.shape, words.shape[1]), dtype=np.int64)
        table[wanted] = words
        return Modes(flat.reshape(residues.shape), IntegerTable(table))

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
        for rows, columns in self._image._parts(degree):
            self._put_part(degree, rows, columns, modes.residues)

    def _put_part(self, degree: int, rows: Ints, columns: slice, residues: Floats) -> None:
        products = np.zeros((len(self.basis), len(rows), self.space.half))
        right = self._to_bonds[:, columns]
        everywhere = (slice(None), slice(None))
        self._image.matrix_products(residues, rows, columns, right, products, everywhere)
        values, _ = self._rounded(products.reshape(len(self.basis), -1))
        self._image.store_bonds(degree, rows, values.reshape(products.shape))

    def _bonds(self, products: Floats, power: int) -> Bonds:
        values, _ = self._rounded(products.reshape(len(self.basis), -1))
        return Bonds(values.reshape(products.shape), power)

    def power(self, power: int, degree: int) -> Bonds:
        lower = power - 1
        for d in range(lower, degree if power > 2 else 0):
            if (lower, d) not in self._stored:
                self._put_power(lower, d)
        return self._bonds(self._image.canonical_power(power, degree), lower)

    def _put_power(self, power: int, degree: int) -> None:
        values = self.power(power, degree).residues
        self._stored.add((power, degree))
        self._image.store_power(power, degree, values)

    def number(self, value: Fraction) -> Fraction:
        return value

    def growth(self, number: int, slope: Fraction, rate: Fraction, degree: int) -> Bonds:
        """As of `GrowingRing`: h, with the factor 2 rate."""
        name = -1 - number
        whole, share = whole_growth(slope, rate, degree, self.precision.unit)
        sums = self._image.canonical_growth(name, *whole, degree)
        numerator = self.basis.of_integers(np.array([share.numerator], dtype=object))
        products = sums.reshape(len(self.basis), -1)
        self.basis.scale(products, numerator[:, 0])
        values, _ = self._rounded(products, share.denominator)
        shaped = values.reshape(sums.shape)
        self._image.store_power(name, degree, shaped)
        return Bonds(shaped, 0, 2 * rate)

    def project(self, degree: int, parts: Sequence[tuple[Fraction, Bonds]]) -> Modes:
        rows = len(self.grading.canonical(degree))
        total = np.zeros((len(self.basis), rows, self.space.N - 1))
        for coefficient, bonds in parts:
            scale = bonds.factor / self.precision.unit**bonds.power
            back = self._to_modes(coefficient * scale)
            self._add_projection(degree, total, bonds.residues, back)
        return self._rounded_where(total, self.space.mask(degree))

    def _add_projection(
        self, degree: int, total: Floats, values: Floats, back: Floats
    ) -> None:
        for rows, columns in self._image._parts(degree):
            right = np.moveaxis(back[:, columns], 1, 2)
            at = (rows, columns)
            self._image.matrix_products(values, rows, slice(None), right, total, at)

    def secular(self, degree: int, modes: Modes) -> Modes:
        # the image only picks entries
        residues = self._image.secular(degree, np.moveaxis(modes.residues, 0, 2))
        words = self._image.secular(degree, modes.table.words)
        return Modes(np.moveaxis(residues, 2, 0), IntegerTable(words))

    def correct(self, degree: int, corrections: Modes) -> None:
        self._corrections.append(corrections.table)
        self._image.correct_by(degree, corrections.residues)

    def corrected(self, degree: int) -> Modes:
        residues = self._image.corrected_residues(degree)
        every = np.ones(residues.shape[1:], dtype=np.bool_)
        return self._rounded_where(residues, every)

    def solve(
        self, degree: int, corrected: Modes, force: Modes, multipliers: NDArray[np.object_]
    ) -> Modes:
        _, index = self.grading.harmonics(degree)
        seeds = np.array(self.space.seeds) - 1
        sizes = (multipliers / 2**self.precision.bits).astype(float)
        self._check_range(corrected, force, sizes[index], seeds)
        carried = multipliers != 0
        wanted = carried[index]
        bracket = np.negative(force.residues, out=force.residues)
        bracket[:, :, seeds] += corrected.residues
        places = np.cumsum(carried).reshape(carried.shape) - 1
        factors = self.basis.of_integers(multipliers[carried])
        self._image.multiply_at(bracket, wanted, factors, places[index])
        return self._rounded_where(bracket, wanted)

    def _check_range(
        self, corrected: Modes, force: Modes, factors: Floats, seeds: Ints
    ) -> None:
        """Refuse the last products beyond the range of the residues: they have no bound before."""
        below = -self.precision.bits
        sizes = np.abs(force.table.floats(below))
        sizes[:, seeds] += np.abs(corrected.table.floats(below))
        products = sizes * np.abs(factors)
        if np.any(products > 2.0**self.precision.headroom):
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


def _joined(words: Sequence[NDArray[np.int64]]) -> NDArray[np.int64]:
    """Words (count, n) of several parts as one array, of as many words as the longest."""
    longest = max(part.shape[1] for part in words)
    padded = [np.pad(part, ((0, 0), (0, longest - part.shape[1]))) for part in words]
    return np.concatenate(padded)


def _weighted(table: Sequence[Any], weight: Fraction) -> NDArray[np.object_]:
    """Every entry times the weight, as integers, rounded to nearest."""
    products = [x * weight.numerator / weight.denominator for x in table]
    return np.array([int(mpmath.nint(x)) for x in products], dtype=object)
