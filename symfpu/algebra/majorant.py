"""Rounding errors of a fixed-point series, bounded: the same recursion over moduli and radii.

The coefficients of a finished series are replaced by their moduli, the couplings and multipliers
by theirs, and every coefficient carries a radius: how far it can be off, in units of its last
place, through all roundings before it. Replacing the folded cosine T_(2N-q) = -T_q by |.| gives
cosines on the points j pi / N, j = 0 .. N, so radii of products are again pointwise products
between two cosine transforms. Radii are doubles; each step is enlarged by more than doubles can
lose.

Of a function h that is grown by a differential equation (`FixedPointRing.growth`) two radii are
kept: what the errors of the stretch make of it, and what is lost in its own sums. The first ones
of all functions in a force may cancel as the functions do.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from symfpu.algebra.dense import Floats, aligned_zeros
from symfpu.algebra.fixedpoint import whole_growth
from symfpu.algebra.float64 import DoublesRing
from symfpu.algebra.grading import Ints
from symfpu.algebra.residue import longest_sum
from symfpu.algebra.selection import CosineModes

NEAREST_ROUNDING = 0.51  # units: nearest, by balanced limbs
COSINE = 0.51  # units: cosines, times weights and couplings, are rounded to the nearest
MULTIPLIER = 1.01  # units: rounded down
SLACK = 1 + 1e-9
LANES = 8


class Bounds(NamedTuple):
    """radii : (canonical, points) of values on bonds.

    Sizes : (canonical,) sums of moduli; factor unit^-power is still to come. lost : radii that
    never cancel.
    """

    radii: Floats
    sizes: Floats
    power: int
    factor: float = 1.0
    lost: Floats | None = None


class Growth(NamedTuple):
    """A function that is grown, and its radii, by the kernel's rows.

    values : moduli. radii : what comes from the stretch. lost : what comes from its own sums.
    """

    values: Floats
    radii: Floats
    lost: Floats


class MajorantRing(DoublesRing[Bounds]):
    """Radii in units of the last place.

    tables, corrections : moduli of the series, by degree, scaled by unit^-(d - 1). epsilon : the
    unit of the last place, for products of two radii; zero leaves them out. positive : whether
    the Taylor coefficients of the force, and of the functions it is grown from, are positive:
    then those of the force, and not sums of moduli over its functions, act on errors of the
    stretch. largest : the largest sum of moduli met on the way.
    """

    name = "majorant"
    space: CosineModes
    grows = True

    def __init__(
        self,
        space: CosineModes,
        tables: dict[int, Floats],
        corrections: dict[int, Floats],
        unit: Fraction,
        epsilon: float = 0.0,
        *,
        positive: bool = False,
    ) -> None:
        # one lane more: in it, where radii are multiplied, moduli at the first point are
        self._of_sizes = (space.N + 2) // 2
        super().__init__(space, points=self._of_sizes + 1)
        self._tables, self._known = tables, corrections
        self._exact_unit = unit
        self._unit, self._epsilon = float(unit), epsilon
        self._radii = aligned_zeros(self._bonds.shape)
        self._sums = aligned_zeros(self._bonds.shape)  # 2 |u| + epsilon r
        self._power_radii: dict[int, Floats] = {}
        self._positive = positive
        self._growths: dict[int, Growth] = {}
        self._seed_radii = aligned_zeros(self._seed_modes.shape)
        self._correction_radii = aligned_zeros(self._corrections.shape)
        self.largest = 1.0
        factor_pairs = longest_sum(len(space.seeds), space.grading.degree)
        sums = 4 * space.N + 2 * factor_pairs + 64
        # what sums of doubles can lose, relative to the sum of moduli
        self._lost = sums * float(np.finfo(float).eps)
        # a function bounded by one on the bonds: modes of its parity up to two
        self._noise = np.zeros((2, self._slices * self._lanes))
        for parity in (0, 1):
            table = self._table(np.arange(parity, space.N, 2))
            self._noise[parity, : self._of_sizes] = 2 * table.sum(axis=0)

    def _lane_width(self) -> int:
        """A register, or two where they are not less full: the largest rows are shorter here."""
        registers = -(-self._points // LANES)
        return LANES if registers % 2 else 2 * LANES

    def coupling(self, power: int, value: Fraction) -> float:
        return abs(float(value))

    def _table(self, modes: Ints) -> Floats:
        """cos(q j pi / N) on half of the points j = 0 .. N, from exactly reduced angles."""
        turn = 4 * self.space.N
        angles = 2 * np.outer(modes, np.arange(self._of_sizes)) % turn
        return self._cosines(np.minimum(angles, turn - angles))

    def _transforms(self) -> tuple[Floats, Floats]:
        N, points = self.space.N, np.arange(self._of_sizes)
        there = np.zeros((N - 1, self._slices * self._lanes))
        there[:, : len(points)] = self._table(np.arange(1, N))
        ends = (points == 0) | (2 * points == N)
        weights = np.where(ends, 2 / N, 4 / N)
        back = there.copy()
        back[:, : len(points)] *= weights
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
        if degree == self.grading.degree:
            return  # it is a factor of nothing
        self._store_bonds(degree, modes, sizes)
        self._store_of_seeds(self._seed_modes, degree, known)
        self._store_of_seeds(self._seed_radii, degree, modes)

    def _store_bonds(self, degree: int, modes: Floats, sizes: Floats) -> None:
        """Moduli and radii on the bonds, and what products take of both."""
        known = self._tables[degree]
        for parity, (rows, columns) in enumerate(self.space.parts(degree)):
            to_bonds = self._to_bonds[columns]
            values = known[rows, columns] @ to_bonds
            fresh = np.outer(COSINE * sizes[rows] + NEAREST_ROUNDING, self._noise[parity])
            radii = modes[rows, columns] @ to_bonds + fresh
            reached = 2 * values + self._epsilon * radii
            for table in (values, radii, reached):
                table[:, self._of_sizes] = values[:, 0]
            self._store(self._bonds, degree, rows, values)
            self._store(self._radii, degree, rows, radii)
            self._store(self._sums, degree, rows, reached)

    def _store(self, target: Floats, degree: int, rows: Ints, values: Floats) -> None:
        first = int(self.grading.first_row[degree])
        canonical = first + self.grading.canonical(degree)[rows]
        conjugate = first + self.grading.conjugate(degree)[rows]
        self._kernels.to_lanes(values[None], target, canonical, conjugate)

    def _store_of_seeds(self, target: Floats, degree: int, modes: Floats) -> None:
        columns = modes[:, np.array(self.space.seeds) - 1]
        self._store(target, degree, np.arange(len(modes)), columns)

    def _bounds(self, degree: int, radii: Floats, power: int) -> Bounds:
        """What the kernel gave, f o g = 2 f g, with the rounding on the bonds added."""
        fresh = NEAREST_ROUNDING * self._noise[self.space.parity(degree)]
        doubled = 2 * self._canonical_points(degree, radii)
        sizes = doubled[:, self._of_sizes].copy()
        self._note(sizes)
        doubled[:, self._of_sizes] = 0.0
        return Bounds(doubled + fresh, sizes, power)

    def power(self, power: int, degree: int) -> Bounds:
        if power == 2:
            splits = [(d, degree - d) for d in self._degrees]
            ordered = [(d, e) for d, e in splits if e in self._degrees]
            radii = self._product(self._sums, self._radii, degree, ordered)
            return self._bounds(degree, radii, 1)
        splits = self._power_splits(power, degree)
        lower, lower_radii = self._powers[power - 1], self._power_radii[power - 1]
        single = self._bonds + self._epsilon * self._radii
        radii = self._product(lower, self._radii, degree, splits)
        radii += self._product(lower_radii, single, degree, splits)
        return self._bounds(degree, radii, power - 1)

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
            self._power_radii[power] = aligned_zeros(self._bonds.shape)
        self._store(self._power_radii[power], degree, np.arange(len(radii)), radii)

    def number(self, value: Fraction) -> float:
        return float(value) if self._positive else abs(float(value))

    def growth(self, number: int, slope: Fraction, rate: Fraction, degree: int) -> Bounds:
        """As of `FixedPointRing`."""
        grown = self._growth(number)
        sizes, radii, lost = self._grown_sums(grown, slope, rate, degree)
        factor = 2 / (degree * self._unit)
        parity = self.space.parity(degree)
        fresh = NEAREST_ROUNDING * self._noise[parity]
        sizes, radii, lost = factor * sizes, factor * radii, factor * lost + fresh
        every = np.arange(len(sizes))
        for target, values in zip(grown, (sizes, radii, lost), strict=True):
            self._store(target, degree, every, values)
        _, share = whole_growth(slope, rate, degree, self._exact_unit)
        # the sum before it is divided
        self._note(share.denominator * sizes[:, 0])
        # radii of several functions may cancel, but not what doubles lose of them
        lost = lost + degree * self._lost * radii[:, :1] * self._noise[parity]
        return Bounds(radii, sizes[:, 0], 0, self.number(2 * rate), lost)

    def _growth(self, number: int) -> Growth:
        """A function complete to the degrees that are stored: h_d has c_d among its terms."""
        if number not in self._growths:
            shape = self._bonds.shape
            self._growths[number] = Growth(*(aligned_zeros(shape) for _ in range(3)))
        grown, name = self._growths[number], -1 - number
        done = self._completed.setdefault(name, set())
        for degree in set(self._degrees) - done:
            rows = self._rows(degree)
            grown.values[:, rows] += self._bonds[:, rows]
            grown.radii[:, rows] += self._radii[:, rows]
            done.add(degree)
        return grown

    def _grown_sums(
        self, grown: Growth, slope: Fraction, rate: Fraction, degree: int
    ) -> list[Floats]:
        """Sums over lower degrees for moduli, radii and what is lost; (canonical, points)."""
        lower = [d for d in self._degrees if degree - d in set(self._degrees)]
        weights = np.zeros(degree)
        for d in lower:
            weights[d] = abs(float(rate * d - slope * (degree - d)))
        counts = np.diff(self.grading.first_row[: degree + 1])
        of_rows = np.repeat(weights, counts)[:, None]
        end = len(of_rows)
        splits = [(d, degree - d) for d in lower]

        def product(left: Floats, right: Floats) -> Floats:
            weighted = left[:, :end] * of_rows
            return self._product(weighted, right, degree, splits)

        reached = grown.values + self._epsilon * grown.radii
        shifted = self._bonds + self._epsilon * self._radii
        sums = (
            product(self._bonds, grown.values),
            product(self._bonds, grown.radii) + product(self._radii, reached),
            product(shifted, grown.lost),
        )
        return [self._canonical_points(degree, values) for values in sums]

    def project(self, degree: int, parts: Sequence[tuple[float, Bounds]]) -> Floats:
        mask = self.space.mask(degree)
        modes = np.full(mask.shape, NEAREST_ROUNDING)
        passed = np.zeros(mask.shape)
        for coefficient, bounds in parts:
            scale = coefficient * bounds.factor / self._unit**bounds.power
            modes += self._fresh(bounds, abs(scale))[:, None]
            for rows, columns in self.space.parts(degree):
                back = self._to_modes[columns].T
                passed[rows, columns] += scale * bounds.radii[rows] @ back
                if bounds.lost is not None:
                    modes[rows, columns] += abs(scale) * bounds.lost[rows] @ back
        modes += np.abs(passed)
        return np.asarray(np.where(mask, modes * SLACK, 0.0))

    def _fresh(self, bounds: Bounds, scale: float) -> Floats:
        """What the way back to modes loses, by monomial."""
        self._note(2 * scale * bounds.sizes)
        largest = bounds.radii[:, 0]
        if bounds.lost is not None:
            largest = largest + bounds.lost[:, 0]
        reached = bounds.sizes + self._epsilon * largest
        lost = self._lost * scale * largest
        return np.asarray(COSINE * self.space.half * reached + lost)

    def _seed_product(self, degree: int, corrections: Floats, seed_modes: Floats) -> Floats:
        lanes = self._diagonal_product(degree, corrections, seed_modes, None, 0)
        return self._of_seeds(degree, lanes)

    def correct(self, degree: int, corrections: Floats) -> None:
        super().correct(degree, self._known[degree])
        self._diagonal[-1] = corrections
        rows = self._diagonal_rows(degree)
        for i in range(len(self.space.seeds)):
            slice_, lane = divmod(i, 8)
            self._correction_radii[slice_, rows, lane] = corrections[:, i]

    def corrected(self, degree: int) -> Floats:
        lower = slice(int(self.grading.first_row[degree]))
        shifted = self._seed_radii[:, lower] * self._epsilon
        shifted += self._seed_modes[:, lower]
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
