"""Rings whose coefficients are doubles: values on half of the bonds, multiplied by the compiled
kernels.

What the ring of doubles and the residues modulo a prime share: storage, transforms, products,
selection masks. A ring says what its cosines are, how it multiplies and reduces arrays, and
whether it rescales.
"""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from math import comb, prod
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Ints, canonical_count, monomial_count
from symfpu.algebra.selection import Modes

Floats = NDArray[np.float64]
Bonds = TypeVar("Bonds")

CACHE_LINE = 64  # bytes
EULER = 0  # the name of d c_d among the powers
PARALLEL_FROM = 500_000  # multiply-adds below which threads cost more than they give


def lane_width(columns: int) -> int:
    """Lanes in a row of the kernel: one vector register of doubles, or two where there are enough
    columns.
    """
    return 8 if columns <= 8 else 16


def available_cores() -> int:
    """Processor cores that this process may use."""
    return len(
        os.sched_getaffinity(0)
        if hasattr(os, "sched_getaffinity")
        else range(os.cpu_count() or 1)
    )


def threads_of_a_computation() -> int:
    """The available cores, or fewer where the environment says so, as in a worker of a pool.

    OMP_NUM_THREADS, which schedulers set and other libraries heed too; a list counts by its first.
    """
    first = os.environ.get("OMP_NUM_THREADS", "").split(",")[0].strip()
    cores = available_cores()
    return min(cores, int(first)) if first.isdecimal() and int(first) else cores


def predicted_bytes(N: int, seeds: int, top: int, *, powers: int) -> int:
    """Upper bound of the memory of a series up to degree `top`, temporaries included.

    powers : how many functions on the bonds it keeps. Closed form, nothing is allocated.
    """
    half = (N + 1) // 2
    width = lane_width(half)
    lanes = -(-half // width) * width
    rows = comb(top + 2 * seeds, 2 * seeds)
    canonical = (rows + comb(top // 2 + seeds, seeds)) // 2
    on_bonds = lanes * powers
    of_seeds = 16 * -(-seeds // 8) + 4 * seeds + 4
    stored = rows * 8 * (on_bonds + of_seeds)
    modes = canonical * (N - 1) * 8
    products = monomial_count(seeds, top) * 8 * 3 * lanes
    last_modes = canonical_count(seeds, top) * (N - 1) * 8 * 5
    cosines, exact_frequencies = N * lanes * 8 * 4, N * 1000
    selection_rules = 2 * N * comb(top + seeds, seeds)
    transforms = cosines + selection_rules + exact_frequencies
    return stored + modes + products + last_modes + transforms


def aligned_zeros(shape: tuple[int, ...], kind: Any = np.float64) -> NDArray[Any]:
    """Zeros that begin at a line of the cache: no row of 64 bytes then lies on two."""
    size = np.dtype(kind).itemsize * prod(shape)
    memory = np.zeros(size + CACHE_LINE, dtype=np.uint8)
    first = -memory.ctypes.data % CACHE_LINE
    return np.asarray(memory[first : first + size].view(kind).reshape(shape))


def degrees_of(splits: list[tuple[int, int]], degree: int) -> NDArray[np.bool_]:
    """Which degrees the left and the right factors have; (2, degree + 1)."""
    there = np.zeros((2, degree + 1), dtype=np.bool_)
    for d, e in splits:
        there[0, d] = there[1, e] = True
    return there


class DenseRing(ABC, Generic[Bonds]):
    """Coefficients as doubles; products on bonds by compiled, threaded kernels.

    Bonds : what powers on the bonds are, for `power` to give and `project` to take.
    multiply_adds counts the multiply-adds that the kernels performed on the bonds so far.
    exponent : degree d of everything stored carries the factor 2^(-exponent (d - 1)).
    """

    modulus: float | None = None
    kind: Any = np.float64  # of what is kept on the bonds
    grows = False
    reduces = False  # whether the kernels leave their sums in normal form

    def __init__(
        self, space: Modes, *, workers: int | None = None, points: int | None = None
    ) -> None:
        """points : values kept for each monomial; default as many as the modes ask for."""
        # lazy: numba takes longer to import than all the rest
        from symfpu.algebra import kernels

        self._kernels = kernels
        self.space, self.grading = space, space.grading
        self.exponent = 0
        self.multiply_adds = 0
        self._workers = workers or threads_of_a_computation()
        self._pool = ThreadPoolExecutor(self._workers)
        self._points = points or space.points
        self._lanes = self._lane_width()
        self._slices = -(-self._points // self._lanes)
        rows, seed_slices = int(self.grading.first_row[-1]), -(-len(space.seeds) // 8)
        kept = (self._slices, rows, self._lanes)
        self._bonds = aligned_zeros(kept, self.kind)
        self._powers: dict[
            int, Floats
        ] = {}  # of the bonds, as far as higher powers need them
        self._seed_modes = aligned_zeros((seed_slices, rows, 8))
        self._corrections = aligned_zeros((seed_slices, rows, 8))
        self._active = np.zeros(rows, dtype=np.bool_)
        self._degrees: list[int] = []
        self._power_degrees: dict[int, list[int]] = {}
        self._completed: dict[int, set[int]] = {}
        self._weighted: Floats | None = None  # place for them, made once
        self._correction_degrees: list[int] = []
        self._modes: list[Floats] = []
        self._diagonal: list[Floats] = []
        self._to_bonds, self._to_modes = self._transforms()

    def _lane_width(self) -> int:
        return lane_width(self._points)

    def _reductions(self, slice_: int, *, sparse: bool = False) -> tuple[Any, ...]:
        """What else the kernels need to reduce the sums of one slice: moduli and a limit."""
        return ()

    @abstractmethod
    def _cosines(self, angles: Ints) -> Floats:
        """cos(angle pi / 2N) for integers in 0 .. 2N, as elements of the ring."""

    @abstractmethod
    def _reciprocal(self, number: int) -> float:
        """1 / number as an element of the ring."""

    @abstractmethod
    def _matrix_product(self, left: Floats, right: Floats) -> Floats:
        """Product of two matrices of ring elements."""

    @abstractmethod
    def _times(self, values: Floats, factor: Floats | float) -> Floats:
        """Element by element product with an array or a number of the ring.

        May overwrite values.
        """

    @abstractmethod
    def _reduced(self, values: Floats) -> Floats:
        """The values in their normal form, after sums; may overwrite them."""

    @abstractmethod
    def _keep_in_range(self, degree: int, modes: Floats) -> None:
        """Called after a degree is stored; a ring that can overflow rescales here."""

    @abstractmethod
    def power(self, power: int, degree: int) -> Bonds:
        """As of `Ring`."""

    @abstractmethod
    def _put_power(self, power: int, degree: int) -> None:
        """Keep a power of the bonds as a factor of higher ones."""

    @abstractmethod
    def project(self, degree: int, parts: Sequence[tuple[float, Bonds]]) -> Floats:
        """As of `Ring`."""

    def _transforms(self) -> tuple[Floats, Floats]:
        """From columns to the points of the bonds that are kept, and the way back.

        Shapes (columns, points), padded with zeros to whole rows.
        """
        angles, share, weights = self.space.transform()
        columns, points = angles.shape
        cosines = self._cosines(angles)
        there, back = np.zeros((2, columns, self._slices * self._lanes))
        there[:, :points] = self._times(cosines.copy(), self._quotient(share))
        of_points = np.array([self._quotient(weight) for weight in weights])
        every = np.broadcast_to(of_points, cosines.shape).copy()
        back[:, :points] = self._times(cosines, every)
        return there, back

    def _quotient(self, value: Fraction) -> float:
        """A quotient as an element of the ring."""
        reciprocal = np.full(1, self._reciprocal(value.denominator))
        return float(self._times(reciprocal, float(value.numerator))[0])

    def _rows(self, degree: int) -> slice:
        first, end = self.grading.first_row[degree : degree + 2]
        return slice(int(first), int(end))

    def seed_terms(self) -> Floats:
        modes = np.zeros((len(self.space.seeds), self.space.columns))
        of_rows = self.grading.powers(1).argmax(axis=1)
        modes[np.arange(len(modes)), self.space.seed_columns[of_rows]] = 1.0
        return modes

    def put(self, degree: int, modes: Floats) -> None:
        self._degrees.append(degree)
        self._modes.append(modes)
        for rows, columns in self.space.parts(degree):
            values = self._matrix_product(modes[rows, columns], self._to_bonds[columns])
            self._store(self._bonds, degree, rows, values)
        self._store_seed_modes(degree, modes)
        self._keep_in_range(degree, modes)

    def _store(self, target: Floats, degree: int, rows: Ints, values: Floats) -> None:
        """Values (rows, points) of canonical monomials and conjugates into the kernel's rows."""
        base = int(self.grading.first_row[degree])
        slices, _, width = target.shape
        lanes = np.moveaxis(values.reshape(len(rows), slices, width), 1, 0)
        canonical = self.grading.canonical(degree)[rows]
        conjugate = self.grading.conjugate(degree)[rows]
        target[:, base + canonical] = lanes
        target[:, base + conjugate] = lanes

    def _store_seed_modes(self, degree: int, modes: Floats) -> None:
        base = int(self.grading.first_row[degree])
        canonical, conjugate = (
            self.grading.canonical(degree),
            self.grading.conjugate(degree),
        )
        for i, column in enumerate(self.space.seed_columns):
            slice_, lane = divmod(i, 8)
            for rows in (canonical, conjugate):
                self._seed_modes[slice_, base + rows, lane] = modes[:, column]

    def _product(
        self,
        left: Floats,
        right: Floats,
        degree: int,
        splits: list[tuple[int, int]],
        *,
        symmetric: bool = False,
        sparse: bool = False,
    ) -> Floats:
        """Sum of the products of all splits, canonical rows only.

        Shape (slices, rows of the degree, lanes).
        """
        rows = self._rows(degree)
        slices, _, width = left.shape
        shape = (slices, rows.stop - rows.start, width)
        if not splits:
            return aligned_zeros(shape)
        out = self._place(shape)
        blocks = self.grading.wanted_blocks(degree)
        lanes = (0.0,) * width
        active = self._active if sparse else self._active[:0]
        table = np.array(splits, dtype=np.int64)

        def task(part: tuple[int, int]) -> int:
            slice_, first = part
            count = self._kernels.multiply(
                lanes,
                left[slice_],
                right[slice_],
                out[slice_],
                degree,
                rows.start,
                table,
                symmetric,
                active,
                np.ascontiguousarray(blocks[first::chunks]),
                self.grading.tables,
                self.modulus,
                *self._reductions(slice_, sparse=sparse),
            )
            return int(count)

        parallel = not sparse and self._pairs(splits) * slices * width >= PARALLEL_FROM
        chunks = min(4 * self._workers, len(blocks)) if parallel else 1
        parts = [(s, c) for s in range(slices) for c in range(chunks)]
        done = self._pool.map(task, parts) if parallel else map(task, parts)
        count = sum(done)
        if not sparse:
            self.multiply_adds += count
        return out if self.reduces else self._reduced(out)

    def _place(self, shape: tuple[int, ...]) -> Floats:
        """Where a product comes; rows of canonical monomials are all that need not be zeros."""
        return aligned_zeros(shape)

    def _pairs(self, splits: list[tuple[int, int]]) -> int:
        """How many pairs of monomials the splits have."""
        seeds = len(self.space.seeds)
        return sum(monomial_count(seeds, d) * monomial_count(seeds, e) for d, e in splits)

    def _canonical_points(self, degree: int, values: Floats) -> Floats:
        """Canonical monomials of the kernel's (slices, rows, lanes); shape (canonical, points)."""
        canonical = self.grading.canonical(degree)
        return np.concatenate([part[canonical] for part in values], axis=1)

    def _square_splits(self, degree: int) -> list[tuple[int, int]]:
        known = set(self._degrees)
        splits = [(d, degree - d) for d in self._degrees]
        return [(d, e) for d, e in splits if d <= e and e in known]

    def _power_splits(self, power: int, degree: int) -> list[tuple[int, int]]:
        """Splits into a lower power and a single.

        Lower powers that are still missing are made first.
        """
        lower = power - 1
        for d in range(lower, degree):
            if d not in self._power_degrees.get(lower, ()):
                self._put_power(lower, d)
        known = set(self._degrees)
        splits = [(d, degree - d) for d in self._power_degrees.get(lower, ())]
        return [(d, e) for d, e in splits if e in known]

    def _store_power(self, power: int, degree: int, values: Floats) -> None:
        """Keep a power of the bonds, (canonical, points), as a factor of higher powers."""
        if power not in self._powers:
            self._powers[power] = aligned_zeros(self._bonds.shape, self.kind)
            self._power_degrees[power] = []
        if degree not in self._power_degrees[power]:
            self._power_degrees[power].append(degree)
        self._store(self._powers[power], degree, np.arange(len(values)), values)

    def secular(self, degree: int, modes: NDArray[Any]) -> NDArray[Any]:
        seeds = zip(self.space.seed_columns, self.secular_rows(degree), strict=True)
        return np.stack([modes[at, column] for column, at in seeds], axis=1)

    def secular_rows(self, degree: int) -> list[Ints]:
        """For each seed which canonical monomials have its harmonic nu = e_q, one a row of
        `grading.diagonal(degree - 1)`.
        """
        canonical = self.grading.canonical(degree)
        diagonal = self.grading.diagonal(degree - 1)
        found = []
        for i in range(len(self.space.seeds)):
            exponents = np.repeat(diagonal, 2, axis=1)
            exponents[:, 2 * i] += 1
            rows = self.grading.rows(exponents)
            found.append(np.searchsorted(canonical, rows))
        return found

    def correct(self, degree: int, corrections: Floats) -> None:
        self._correction_degrees.append(degree)
        self._diagonal.append(corrections)
        rows = self._diagonal_rows(degree)
        for i in range(len(self.space.seeds)):
            slice_, lane = divmod(i, 8)
            self._corrections[slice_, rows, lane] = corrections[:, i]
        self._active[rows] = True

    def _diagonal_rows(self, degree: int) -> Ints:
        """Rows, over all degrees, of the monomials |z|^(2e)."""
        exponents = np.repeat(self.grading.diagonal(degree), 2, axis=1)
        rows = self.grading.rows(exponents)
        return np.asarray(self.grading.first_row[degree] + rows)

    def corrected(self, degree: int) -> Floats:
        return self._seed_product(degree, self._corrections, self._seed_modes)

    def _seed_product(self, degree: int, corrections: Floats, seed_modes: Floats) -> Floats:
        """Sum W_q u_q over all stored pairs of degrees; (canonical, s)."""
        splits = self._correction_splits(degree)
        lanes = self._product(corrections, seed_modes, degree, splits, sparse=True)
        return self._of_seeds(degree, lanes)

    def _correction_splits(self, degree: int) -> list[tuple[int, int]]:
        """Degrees of W and u."""
        known = set(self._degrees)
        return [(n, degree - n) for n in self._correction_degrees if degree - n in known]

    def _diagonal_product(
        self, degree: int, corrections: Floats, seed_modes: Floats, *reductions: Any
    ) -> Floats:
        """The same sum by its few factors, as the kernel leaves it: (slices, rows, 8)."""
        there = degrees_of(self._correction_splits(degree), degree)
        rows = self._rows(degree)
        out = self._place((len(seed_modes), rows.stop - rows.start, 8))
        self._kernels.multiply_diagonal(
            (0.0,) * 8,
            corrections,
            seed_modes,
            out,
            degree,
            *there,
            self.grading.wanted_blocks(degree),
            self.grading.tables,
            self.grading.diagonal_tables,
            *reductions,
        )
        return out

    def _of_seeds(self, degree: int, lanes: Floats) -> Floats:
        """Canonical monomials of the kernel's (slices, rows, 8), a column a seed."""
        canonical = self.grading.canonical(degree)
        places = [divmod(i, 8) for i in range(len(self.space.seeds))]
        columns = [lanes[slice_, canonical, lane] for slice_, lane in places]
        return np.stack(columns, axis=1)

    def solve(
        self, degree: int, corrected: Floats, force: Floats, multipliers: Floats
    ) -> Floats:
        _, index = self.grading.harmonics(degree)
        bracket = np.negative(force, out=force)
        own, theirs = self.space.of_seeds(degree)
        bracket[own] += corrected[theirs]
        return self._times(self._reduced(bracket), multipliers[index])

    def results(self) -> tuple[list[Floats], list[Floats], Fraction]:
        return self._modes, self._diagonal, Fraction(2) ** self.exponent


class ValuesRing(DenseRing[Floats]):
    """Powers on the bonds as their values, as the kernel leaves them: (slices, rows, lanes)."""

    grows = True

    def power(self, power: int, degree: int) -> Floats:
        if power == 2:
            splits = self._square_splits(degree)
            out = self._product(self._bonds, self._bonds, degree, splits, symmetric=True)
        else:
            splits = self._power_splits(power, degree)
            out = self._product(self._powers[power - 1], self._bonds, degree, splits)
        scale = np.ldexp(2.0, -self.exponent)
        return self._times(out, float(scale))

    def _put_power(self, power: int, degree: int) -> None:
        values = self.power(power, degree)
        self._store_power(power, degree, self._canonical_points(degree, values))

    @abstractmethod
    def number(self, value: Fraction) -> float:
        """As of `GrowingRing`."""

    def coupling(self, power: int, value: Fraction) -> float:
        return self.number(value)

    def growth(self, number: int, slope: Fraction, rate: Fraction, degree: int) -> Floats:
        """As of `GrowingRing`; g is kept among the powers, under a name of its own."""
        name = -1 - number
        self._complete(name, 2 * rate)
        out, share = self._grown(name, slope, rate, degree)
        divided = self.number(share) * np.ldexp(2.0, -self.exponent)
        out = self._times(out, float(divided))
        self._store_power(name, degree, self._canonical_points(degree, out))
        return out

    def _grown(
        self, name: int, slope: Fraction, rate: Fraction, degree: int
    ) -> tuple[Floats, Fraction]:
        """What the lower degrees of a function give, and the number it is still to be times.

        As the kernel leaves it. Where slope is 0 the rate is part of that number.
        """
        if slope:
            left = self._weighted_bonds(slope, rate, degree)
            share = Fraction(1, degree)
        else:
            self._complete(EULER)
            left = self._powers[EULER]
            share = rate / degree
        known = set(self._degrees)
        splits = [(d, degree - d) for d in self._degrees if degree - d in known]
        return self._product(left, self._powers[name], degree, splits), share

    def _complete(self, name: int, factor: Fraction | None = None) -> None:
        """Add factor c_d to what is kept under a name, where it is not there yet.

        factor : 2 rate, to what lower degrees gave to g_d; None for d, the derivative of Euler.
        """
        if name not in self._completed:
            self._completed[name] = set()
            self._powers[name] = aligned_zeros(self._bonds.shape, self.kind)
            self._power_degrees[name] = list(self._degrees)
        missing = [d for d in self._degrees if d not in self._completed[name]]
        for degree in missing:
            rows, target = self._rows(degree), self._powers[name]
            weight = self.number(Fraction(degree) if factor is None else factor)
            own = self._times(self._bonds[:, rows].astype(np.float64), weight)
            own += target[:, rows]
            target[:, rows] = self._reduced(own)
            self._completed[name].add(degree)

    def _weighted_bonds(self, slope: Fraction, rate: Fraction, degree: int) -> Floats:
        """(rate j - slope (degree - j)) c_j, all lower degrees j."""
        first_row = self.grading.first_row
        weights = self._times(np.arange(float(degree)), self.number(rate + slope))
        weights -= self.number(slope * degree)
        counts = np.diff(first_row[: degree + 1])
        of_rows = np.repeat(self._reduced(weights), counts)[:, None]
        end = int(first_row[degree])
        if self._weighted is None:
            self._weighted = aligned_zeros(self._bonds.shape)
        lower = self._weighted[:, :end]
        np.copyto(lower, self._bonds[:, :end])
        return self._times(lower, of_rows)

    def project(self, degree: int, parts: Sequence[tuple[float, Floats]]) -> Floats:
        canonical = self.grading.canonical(degree)
        modes = np.zeros((len(canonical), self.space.columns))
        for rows, columns in self.space.parts(degree):
            chosen, back = canonical[rows], self._to_modes[columns].T
            for coefficient, values in parts:
                bonds = np.concatenate([part[chosen] for part in values], axis=1)
                force = self._matrix_product(bonds, back)
                modes[rows, columns] += self._times(force, coefficient)
        np.multiply(modes, self.space.mask(degree), out=modes)
        return self._reduced(modes)
