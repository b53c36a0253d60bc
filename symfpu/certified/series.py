"""Trigonometric polynomials of many angles in fixed point, with a bound of what they are off by.

sum a[nu] exp(i nu.theta) with real a[nu] = integer times 2^-places: an array with an axis of odd
length for each angle, nu = 0 in the middle. The norm is sum |a[nu]|: no value at real angles is
larger, and the norm of a product is at most the product of the norms. Products are exact in
FLINT's integers, by Kronecker's substitution, and rounded once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import numpy as np
from numpy.typing import NDArray

from symfpu.errors import InputError

Integers = NDArray[np.object_]
Shape = tuple[int, ...]

MOST_PLACES = 4_000_000  # of the box of a product


def above(x: Fraction | int) -> int:
    """The least integer not below."""
    return -((-x.numerator) // x.denominator)


@dataclass(frozen=True, eq=False)
class Series:
    """values : integers in units of 2^-places. error : above the norm of what is off, in units."""

    values: Integers
    places: int
    error: int = 0

    @property
    def highest(self) -> Shape:
        """The largest |nu_i| of each angle."""
        return tuple(length // 2 for length in self.values.shape)

    @property
    def size(self) -> int:
        """Above the norm, in units."""
        return int(np.abs(self.values).sum()) + self.error

    @property
    def norm(self) -> Fraction:
        """Above the norm."""
        return Fraction(self.size, 1 << self.places)

    def __add__(self, other: Series) -> Series:
        highest = tuple(map(max, self.highest, other.highest))
        values = padded(self.values, highest) + padded(other.values, highest)
        return Series(values, self.places, self.error + other.error)

    def __sub__(self, other: Series) -> Series:
        return self + other.scaled(-1)

    def scaled(self, factor: Fraction | int) -> Series:
        """Times an exact number."""
        top, bottom = factor.numerator, factor.denominator
        values = self.values * top
        if bottom == 1:
            return Series(values, self.places, self.error * abs(top))
        count = int(np.count_nonzero(values))
        error = above(self.error * abs(Fraction(factor))) + count
        return Series(values // bottom, self.places, error)

    def __mul__(self, other: Series) -> Series:
        values = product(self.values, other.values)
        crossed = self.size * other.error + (other.size - other.error) * self.error
        return Series(values, self.places + other.places, crossed).rounded(self.places)

    def rounded(self, places: int) -> Series:
        """With so many places, without harmonics that are zero then."""
        shift = self.places - places
        if shift <= 0:
            return Series(trimmed(self.values << -shift), places, self.error << -shift)
        half = 1 << (shift - 1)
        values = (self.values + half) >> shift
        lost = int(np.abs(self.values - (values << shift)).sum())
        error = above(Fraction(lost + self.error, 1 << shift))
        return Series(trimmed(values), places, error)

    def turned(
        self, omega: tuple[Fraction, ...], shift: Fraction, power: int = 1
    ) -> Series:
        """Every coefficient times (shift + nu.omega)^power. The error has to be 0."""
        if self.error:
            raise ValueError("a derivative of an error has no bound")
        bottom = math.lcm(*(w.denominator for w in (*omega, shift)))
        rates = np.array(int(shift * bottom), dtype=object)
        for axis, (w, m) in enumerate(zip(omega, self.highest, strict=True)):
            along = np.array([n * int(w * bottom) for n in range(-m, m + 1)], dtype=object)
            lengths = [-1 if i == axis else 1 for i in range(len(omega))]
            rates = rates + along.reshape(lengths)
        values = (self.values * rates**power) // bottom**power
        return Series(values, self.places, int(np.count_nonzero(values)))

    def by_angle(self, axis: int) -> Series:
        """Every coefficient times nu_axis."""
        m = self.highest[axis]
        lengths = [-1 if i == axis else 1 for i in range(self.values.ndim)]
        numbers = np.arange(-m, m + 1).astype(object).reshape(lengths)
        return Series(self.values * numbers, self.places, self.error * m)

    def mirrored(self) -> Series:
        """At the opposite angles."""
        return Series(np.flip(self.values), self.places, self.error)


def padded(values: Integers, highest: Shape) -> Integers:
    """In a larger box."""
    room = np.zeros([2 * m + 1 for m in highest], dtype=object)
    pairs = zip(highest, values.shape, strict=True)
    room[tuple(slice(m - n // 2, m + n // 2 + 1) for m, n in pairs)] = values
    return room


def trimmed(values: Integers) -> Integers:
    """In the smallest box around nu = 0 that holds all that is not zero."""
    inside = []
    for axis, length in enumerate(values.shape):
        others = tuple(i for i in range(values.ndim) if i != axis)
        used = np.flatnonzero((values != 0).any(axis=others))
        reach = max((abs(int(n) - length // 2) for n in used), default=0)
        inside.append(slice(length // 2 - reach, length // 2 + reach + 1))
    return values[tuple(inside)]


def product(one: Integers, other: Integers) -> Integers:
    """All harmonics of a product, exact. Raises InputError for too many."""
    shape = tuple(m + n - 1 for m, n in zip(one.shape, other.shape, strict=True))
    count = math.prod(shape)
    if count > MOST_PLACES:
        given = f"one whose forces have {count} harmonics in a box"
        raise InputError(
            "torus", given, f"at most {MOST_PLACES}", "take fewer digits or angles"
        )
    found = (packed(one, shape) * packed(other, shape)).coeffs()
    values = np.zeros(count, dtype=object)
    values[: len(found)] = [int(x) for x in found]
    return values.reshape(shape)


def packed(values: Integers, shape: Shape) -> Any:
    """The polynomial of one variable by Kronecker's substitution, nu = -highest first."""
    room = np.zeros(shape, dtype=object)
    room[tuple(slice(0, n) for n in values.shape)] = values
    return flint.fmpz_poly(room.ravel().tolist())
