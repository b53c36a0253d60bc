"""Rounding errors of a fixed-point series, bounded: the same recursion over moduli and radii.

The coefficients of a finished series are replaced by their moduli, the couplings and multipliers
by theirs, and every coefficient carries a radius: how far it can be off, in units of its last
place, through all roundings before it. Replacing the folded cosine T_(2N-q) = -T_q by |.| gives
cosines on the points j pi / N, j = 0 .. N, so radii of products are again pointwise products
between two cosine transforms. Radii are doubles; each step is enlarged by more than doubles can
lose.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from symfpu.algebra.dense import Floats
from symfpu.algebra.float64 import DoublesRing
from symfpu.algebra.grading import Ints
from symfpu.algebra.residue import longest_sum
from symfpu.algebra.selection import CosineModes

NEAREST_ROUNDING = 0.51  # units: nearest, by balanced limbs
COSINE = 0.51  # units: cosines, times weights and couplings, are rounded to the nearest
MULTIPLIER = 1.01  # units: rounded down
SLACK = 1 + 1e-9


class Bounds(NamedTuple):
    """radii : (canonical, points) of values on bonds.

    Sizes : (canonical,) sums of moduli; unit^-power is still to come.
    """

    radii: Floats
    sizes: Floats
    power: int


class MajorantRing(DoublesRing[Bounds]):
    """Radii in units of the last place.

    tables, corrections : moduli of the series, by degree, scaled by unit^-(d - 1). epsilon : the
    unit of the last place, for products of two radii; zero leaves them out. largest : the largest
    sum of moduli met on the way.
    """

    name = "majorant"

    def __init__(
        self,
        space: CosineModes,
        tables: dict[int, Floats],
        corrections: dict[int, Floats],
        unit: Fraction,
        epsilon: float = 0.0,
    ) -> None:
        super().__init__(space, points=(space.N + 2) // 2)
        self._tables, self._known = tables, corrections
        self._unit, self._epsilon = float(unit), epsilon
        self._radii = np.zeros_like(self._bonds)
        self._sums = np.zeros_like(self._bonds)  # 2 |u| + epsilon r
        self._power_radii: dict[int, Floats] = {}
        self._seed_radii = np.zeros_like(self._seed_modes)
        self._correction_radii = np.zeros_like(self._corrections)
        self.largest = 1.0
        factor_pairs = longest_sum(len(space.seeds), space.grading.degree)
        sums = 4 * space.N + 2 * factor_pairs + 64
        # what sums of doubles can lose, relative to the sum of moduli
        self._lost = sums * float(np.finfo(float).eps)
        # a function bounded by one on the bonds: modes of its parity up to two
        self._noise = np.zeros((2, self._slices * self._lanes))
        for parity in (0, 1):
            table = self._table(np.arange(parity, space.N, 2))
            self._noise[parity, : self._points] = 2 * table.sum(axis=0)

    def coupling(self, power: int, value: Fraction) -> float:
        return abs(float(value))

    def _table(self, modes: Ints) -> Floats:
        """cos(q j pi / N) on half of the points j = 0 .. N, from exactly reduced angles."""
        turn = 4 * self.space.N
        angles = 2 * np.outer(modes, np.arange(self._points)) % turn
        return self._cosines(np.minimum(angles, turn - angles))

    def _transforms(self) -> tuple[Floats, Floats]:
        N, points = self.space.N, np.arange(self._points)
        there = np.zeros((N - 1, self._slices * self._lanes))
        there[:, : self._points] = self._table(np.arange(1, N))
        ends = (points == 0) | (2 * points == N)
        weights = np.where(ends, 2 / N, 4 / N)
        back = there.copy()
        back[:, : self._points] *= weights
        return there, back

    def _keep_in_range(self, degree: int, modes: Floats) -> None:
        """Tables come scaled."""

    def _note(self, sizes: Floats) -> None:
        size = float(sizes.max(initial=0.0))
        self.largest = max(self.largest, size * SLACK)

    def seed_terms(self) -> Floats:
        return np.zeros_like(super().seed_terms())

    def put(self, degree: int, modes: Floats) -> None:
        self._degrees.append(degree)
        self._modes.append(modes)
        known = self._tables[degree]
        sizes = known.sum(axis=1)
        self._note(sizes)
        for parity, (rows, columns) in enumerate(self._parts(degree)):
            to_bonds = self._to_bonds[columns]
            values = known[rows, columns] @ to_bonds
            fresh = np.outer(COSINE * sizes[rows] + NEAREST_ROUNDING, self._noise[parity])
            radii = modes[rows, columns] @ to_bonds + fresh
            self._store(self._bonds, degree, rows, values)
            self._store(self._radii, degree, rows, radii)
            self._store(self._sums, degree, rows, 2 * values + self._epsilon * radii)
        self._store_seed_modes(degree, known)
        self._store_seed_radii(degree, modes)

    def _store_seed_radii(self, degree: int, modes: Floats) -> None:
        base = int(self.grading.first_row[degree])
        canonical, conjugate = (
            self.grading.canonical(degree),
            self.grading.conjugate(degree),
        )
        for i, q in enumerate(self.space.seeds):
            slice_, lane = divmod(i, 8)
            for rows in (canonical, conjugate):
                self._seed_radii[slice_, base + rows, lane] = modes[:, q - 1]

    def _bounds(self, degree: int, radii: Floats, sizes: Floats, power: int) -> Bounds:
        """What the kernel gave, f o g = 2 f g, with the rounding on the bonds added."""
        fresh = NEAREST_ROUNDING * self._noise[self.space.parity(degree)]
        sums = 2 * self._canonical_points(degree, sizes)[:, 0]
        self._note(sums)
        doubled = 2 * self._canonical_points(degree, radii)
        return Bounds(doubled + fresh, sums, power)

    def power(self, power: int, degree: int) -> Bounds:
        if power == 2:
            splits = [(d, degree - d) for d in self._degrees]
            ordered = [(d, e) for d, e in splits if e in self._degrees]
            radii = self._product(self._sums, self._radii, degree, ordered)
            return self._bounds(degree, radii, self._sizes(power, degree), 1)
        splits = self._power_splits(power, degree)
        lower, lower_radii = self._powers[power - 1], self._power_radii[power - 1]
        single = self._bonds + self._epsilon * self._radii
        radii = self._product(lower, self._radii, degree, splits)
        radii += self._product(lower_radii, single, degree, splits)
        return self._bounds(degree, radii, self._sizes(power, degree), power - 1)

    def _sizes(self, power: int, degree: int) -> Floats:
        """Moduli of a power, half of it."""
        if power == 2:
            splits = self._square_splits(degree)
            return self._product(self._bonds, self._bonds, degree, splits, symmetric=True)
        splits = self._power_splits(power, degree)
        return self._product(self._powers[power - 1], self._bonds, degree, splits)

    def _put_power(self, power: int, degree: int) -> None:
        radii = self.power(power, degree).radii
        sizes = self._canonical_points(degree, self._sizes(power, degree))
        self._store_power(power, degree, 2 * sizes)
        if power not in self._power_radii:
            self._power_radii[power] = np.zeros_like(self._bonds)
        self._store(self._power_radii[power], degree, np.arange(len(radii)), radii)

    def project(self, degree: int, parts: Sequence[tuple[float, Bounds]]) -> Floats:
        mask = self.space.mask(degree)
        modes = np.full(mask.shape, NEAREST_ROUNDING)
        for coefficient, bounds in parts:
            scale = coefficient / self._unit**bounds.power
            self._note(2 * scale * bounds.sizes)
            largest = bounds.radii[:, 0]
            reached = bounds.sizes + self._epsilon * largest
            fresh = COSINE * self.space.half * reached + self._lost * scale * largest
            modes += fresh[:, None]
            for rows, columns in self._parts(degree):
                back = self._to_modes[columns].T
                modes[rows, columns] += scale * bounds.radii[rows] @ back
        return np.asarray(np.where(mask, modes * SLACK, 0.0))

    def correct(self, degree: int, corrections: Floats) -> None:
        super().correct(degree, self._known[degree])
        self._diagonal[-1] = corrections
        rows = self._diagonal_rows(degree)
        for i in range(len(self.space.seeds)):
            slice_, lane = divmod(i, 8)
            self._correction_radii[slice_, rows, lane] = corrections[:, i]

    def corrected(self, degree: int) -> Floats:
        shifted = self._seed_modes + self._epsilon * self._seed_radii
        first = self._seed_product(degree, self._corrections, self._seed_radii)
        second = self._seed_product(degree, self._correction_radii, shifted)
        sizes = self._seed_product(degree, self._corrections, self._seed_modes)
        self._note(sizes)
        return (first + second) * SLACK + NEAREST_ROUNDING

    def solve(
        self, degree: int, corrected: Floats, force: Floats, multipliers: Floats
    ) -> Floats:
        index: Ints = self.grading.harmonics(degree)[1]
        radii, seeds = force, np.array(self.space.seeds) - 1
        radii[:, seeds] += corrected
        factors = np.abs(multipliers)[index]
        carried = factors != 0
        zeros = np.zeros_like(radii)
        bracket = np.divide(self._tables[degree], factors, out=zeros, where=carried)
        radii = (
            factors * radii
            + MULTIPLIER * (bracket + self._epsilon * radii)
            + NEAREST_ROUNDING
        )
        return np.asarray(np.where(carried, radii * SLACK, 0.0))
