"""Norms of a frame: what it leaves of the linearised equations, and its approximate inverse.

Coordinates: p = i y makes all coefficients real. Columns of the frame: tangents
E_m = -i dK/dtheta_m, directions W of the actions, normal directions P and their conjugates.
docs/tori-proofs.md has the theorem.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import numpy as np

from symfpu.certified.frame import FRAME_BITS, Direction
from symfpu.certified.rounded_torus import (
    RoundedTorus,
    forces_of,
    stretches_of,
)
from symfpu.certified.series import Series

PLACES = FRAME_BITS + 12
COARSE = 20  # places of the frame where its inverse is bounded
INVERSE_PLACES = 40  # of 1 / <E, W> and 1 / <conj P, P>

Row = list[Fraction]


@dataclass(frozen=True, eq=False)
class Column:
    """x_j and y_j, j = 1 .. N-1, with PLACES places."""

    x: list[Series]
    y: list[Series]

    @property
    def mirrored(self) -> Column:
        """The conjugate: of x exp(i sigma t), at -theta, y with the opposite sign."""
        y = [series.mirrored().scaled(-1) for series in self.y]
        return Column([series.mirrored() for series in self.x], y)


class Frame:
    """Columns of a torus and its directions, and their derivatives by the angles."""

    def __init__(self, torus: RoundedTorus, directions: Sequence[Direction]) -> None:
        self.torus, self.directions = torus, directions
        self.s = len(torus.seeds)
        self.tangents = [self._tangent(m) for m in range(self.s)]
        self.others = [self._column(d) for d in directions]
        self.turned = [[self._column(d, (m,)) for d in directions] for m in range(self.s)]

    def _tangent(self, m: int) -> Column:
        return self._moved([series.by_angle(m) for series in self.torus.particles])

    def _moved(self, particles: Sequence[Series], rate: Fraction = Fraction(0)) -> Column:
        """x and y = (rate + nu.omega) x."""
        omega = self.torus.omega
        y = [x.rounded(max(x.places, PLACES)).turned(omega, rate) for x in particles]
        rounded = [series.rounded(PLACES) for series in y]
        return Column([x.rounded(PLACES) for x in particles], rounded)

    def _column(self, d: Direction, by: tuple[int, ...] = ()) -> Column:
        """A direction, or its derivatives by some angles."""
        found = self._moved(derived(d.particles, by), d.rate)
        y = found.y
        for m, twist in enumerate(d.twist):
            tangent = derived(self.torus.particles, (*by, m))
            apart = [x.rounded(PLACES).scaled(twist) for x in tangent]
            y = [a + b for a, b in zip(y, apart, strict=True)]
        return Column(found.x, y)

    def left(self, d: Direction, slopes: Sequence[Series]) -> Row:
        """Norms of F'(X) x + (rate + nu.omega)^2 x + 2 twist d(omega d)X, by particle."""
        fine = [x.rounded(PLACES) for x in d.particles]
        tensions = [r + g * r for r, g in zip(stretches_of(fine), slopes, strict=True)]
        sums = forces_of(tensions)
        omega = self.torus.omega
        sums = [
            a + x.turned(omega, d.rate, power=2) for a, x in zip(sums, fine, strict=True)
        ]
        for m, twist in enumerate(d.twist):
            tangent = self.tangents[m].y
            sums = [a + x.scaled(2 * twist) for a, x in zip(sums, tangent, strict=True)]
        return [series.norm for series in sums]


def derived(particles: Sequence[Series], by: tuple[int, ...]) -> list[Series]:
    """Derivatives by some angles, without the factors i."""
    found = list(particles)
    for m in by:
        found = [series.by_angle(m) for series in found]
    return found


class Inverse:
    """Rows of an approximate inverse: the frame's own columns, as the flow is symplectic.

    The row of a column c is <c*, .> / <c*, c> with its partner c*: tangents and directions of the
    actions are partners, a normal direction and its conjugate.
    """

    def __init__(self, frame: Frame) -> None:
        s = frame.s
        self.frame = frame
        normal = frame.others[s:]
        self.columns = [*frame.tangents, *frame.others]
        partners = [*frame.others[:s], *frame.tangents, *(c.mirrored for c in normal)]
        pairs = zip(partners, self.columns, strict=True)
        self.factors = [inverse_of(mean_product(a, b)) for a, b in pairs]
        self.partners = [coarse(c) for c in partners]

    def rows(self) -> tuple[list[list[Series]], list[list[Series]]]:
        """What multiplies x, and what multiplies y; 2N-2 - (N-1-s) rows."""
        by_x, by_y = [], []
        for factor, c in zip(self.factors, self.partners, strict=True):
            by_x.append([series.scaled(-factor) for series in c.y])
            by_y.append([series.scaled(factor) for series in c.x])
        return by_x, by_y


def coarse(column: Column) -> Column:
    """With COARSE places, and PLACES again; without what that is off by."""
    parts = []
    for half in (column.x, column.y):
        cut = [series.rounded(COARSE) for series in half]
        exact = [Series(series.values, COARSE) for series in cut]
        parts.append([series.rounded(PLACES) for series in exact])
    return Column(*parts)


def mean_product(a: Column, b: Column) -> Fraction:
    """The mean of <a, b> = sum_j x_j^a y_j^b - y_j^a x_j^b, nearly."""
    total = 0
    for x, y, u, v in zip(a.x, a.y, b.x, b.y, strict=True):
        total += mean(x, v) - mean(y, u)
    return Fraction(total, 1 << (2 * PLACES))


def mean(one: Series, other: Series) -> int:
    """sum a[nu] b[-nu] of the values."""
    highest = tuple(map(min, one.highest, other.highest))
    left, right = within(one, highest), within(other, highest)
    return int((left * np.flip(right)).sum())


def within(series: Series, highest: tuple[int, ...]) -> Any:
    """The values of a smaller box."""
    pairs = zip(series.highest, highest, strict=True)
    return series.values[tuple(slice(m - k, m + k + 1) for m, k in pairs)]


def inverse_of(x: Fraction) -> Fraction:
    """1/x with INVERSE_PLACES places."""
    return Fraction(round(2**INVERSE_PLACES / x), 2**INVERSE_PLACES)


def identity_norms(inverse: Inverse) -> list[Row]:
    """Norms of the entries of 1 - L M; columns: tangents, directions, conjugates of normal ones."""
    s, known = inverse.frame.s, inverse.columns
    columns = [*known, *(c.mirrored for c in known[2 * s :])]
    rounded = [halves(c) for c in columns]
    left = [[*cut_exactly(c.x), *cut_exactly(c.y, -1)] for c in inverse.partners]
    entries = Packing([*left, *rounded]).products(left, rounded)
    off = [[series.error for series in column] for column in rounded]
    norms = []
    for row, (factor, of_partner) in enumerate(zip(inverse.factors, left, strict=True)):
        sizes = [series.size for series in of_partner]
        norms.append(
            [
                entry_norm(entries[row][column], factor, row == column)
                + abs(factor) * Fraction(dot(sizes, off[column]), 1 << (2 * COARSE))
                for column in range(len(columns))
            ]
        )
    return norms


def entry_norm(entry: Any, factor: Fraction, diagonal: bool) -> Fraction:
    """The norm of 1 - factor <c*, c>, or of the product alone."""
    unit = 1 << (2 * COARSE)
    middle = tuple(n // 2 for n in entry.shape)
    at_zero = Fraction(int(entry[middle]), unit) * factor
    others = int(np.abs(entry).sum()) - abs(int(entry[middle]))
    return abs(diagonal - at_zero) + abs(factor) * Fraction(others, unit)


def halves(column: Column) -> list[Series]:
    """y, then x, with COARSE places."""
    return [series.rounded(COARSE) for series in (*column.y, *column.x)]


def cut_exactly(parts: Sequence[Series], sign: int = 1) -> list[Series]:
    """What `coarse` left, in its own places."""
    return [Series(sign * (p.values >> (PLACES - COARSE)), COARSE) for p in parts]


def dot(one: Sequence[int], other: Sequence[int]) -> int:
    """sum a b."""
    return sum(map(int.__mul__, one, other))


class Packing:
    """Matrices of series as matrices of single integers: x = 2^(8 width), Kronecker's way twice."""

    def __init__(self, rows: Sequence[Sequence[Series]]) -> None:
        every = [series for row in rows for series in row]
        axes = zip(*(series.highest for series in every), strict=True)
        self.highest = tuple(max(axis) for axis in axes)
        self.shape = tuple(4 * m + 1 for m in self.highest)
        largest = max(series.size for series in every)
        bits = 2 * largest.bit_length() + len(rows[0]).bit_length() + 2
        self.width = -(-bits // 8)

    def integer(self, series: Series) -> Any:
        """The polynomial at x; its lowest harmonic is that of the box."""
        room = np.zeros(self.shape, dtype=object)
        pairs = zip(self.highest, series.highest, strict=True)
        room[tuple(slice(m - k, m + k + 1) for m, k in pairs)] = series.values
        plus, minus = bytearray(), bytearray()
        for value in room.ravel().tolist():
            plus += max(value, 0).to_bytes(self.width, "little")
            minus += max(-value, 0).to_bytes(self.width, "little")
        return flint.fmpz(int.from_bytes(plus, "little") - int.from_bytes(minus, "little"))

    def products(
        self, left: Sequence[Sequence[Series]], right: Sequence[Sequence[Series]]
    ) -> list[list[Any]]:
        """The series sum_k left[row][k] right[column][k], exact."""
        one = flint.fmpz_mat([[self.integer(x) for x in row] for row in left])
        other = flint.fmpz_mat([[self.integer(x) for x in row] for row in right])
        table = (one * other.transpose()).tolist()
        return [[self._series(int(x)) for x in row] for row in table]

    def _series(self, packed: int) -> Any:
        """The coefficients of an integer."""
        count, width = math.prod(self.shape), self.width
        half = 1 << (8 * width - 1)
        bias = int.from_bytes((b"\0" * (width - 1) + b"\x80") * count, "little")
        digits = (packed + bias).to_bytes(width * (count + 1), "little")
        starts = range(0, width * count, width)
        values = [int.from_bytes(digits[i : i + width], "little") - half for i in starts]
        return np.array(values, dtype=object).reshape(self.shape)
