"""Which cosine can appear in which monomial: selection rules of products of cosines.

On the points theta_j = (j + 1/2) pi / N the cosines T_q = cos(q theta), q = 0 .. N-1, are a
basis, and 2 T_l T_m = T_(l+m) + T_(l-m) with T_N = 0, T_(2N-q) = -T_q. A monomial with powers e_i
of the seeds q_i can therefore carry the modes q = +-q_1 ... +-q_1 +-q_2 ... (e_i signs for each
seed), folded into 0 .. N, and no other.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Grading, Ints, compositions


def fold(number: int, N: int) -> int:
    """The wave number in 0 .. N that equals +-number modulo 2N.

    This is |2 [(|n| + N - 1) / 2N] N - |n|| of Eqs. app, lmn.

    >>> fold(33, 32), fold(-5, 32), fold(96, 32)
    (31, 5, 32)
    """
    size = abs(number)
    turns = (size + N - 1) // (2 * N)
    return abs(2 * turns * N - size)


class PowerTable:
    """For each degree, every split of it into powers of the seeds, and the modes it carries."""

    def __init__(self, N: int, seeds: Sequence[int], degree: int) -> None:
        self.N, self.seeds = N, seeds
        kind = object if len(seeds) > 12 else np.int64
        weights = [(degree + 1) ** i for i in reversed(range(len(seeds)))]
        self._weights = np.array(weights, dtype=kind)
        self._keys = []
        self._residues = []
        for d in range(degree + 1):
            powers = compositions(d, len(seeds))
            self._keys.append(powers @ self._weights)
            self._residues.append(self._wave_numbers(powers))

    def _wave_numbers(self, powers: Ints) -> NDArray[np.bool_]:
        """Whether signed sums of the seeds reach each residue modulo 2N, lower degrees known."""
        residues, turn = np.arange(2 * self.N), 2 * self.N
        degree = len(self._residues)
        if degree == 0:
            return np.asarray(residues[None, :] == 0)
        lower_keys, lower = self._keys[degree - 1], self._residues[degree - 1]
        first = np.argmax(powers > 0, axis=1)
        reached = np.empty((len(powers), turn), dtype=np.bool_)
        for i, q in enumerate(self.seeds):
            # one more factor of the first seed present: its wave number with either sign
            rows = np.flatnonzero(first == i)
            without = self._keys[degree][rows] - self._weights[i]
            before = lower[np.searchsorted(lower_keys, without)]
            down, up = before[:, (residues - q) % turn], before[:, (residues + q) % turn]
            reached[rows] = down | up
        return reached

    def carried(self, degree: int, powers: Ints) -> NDArray[np.bool_]:
        """Whether a monomial with these powers can carry a mode; shape (count, N-1)."""
        keys = powers @ self._weights
        places = np.searchsorted(self._keys[degree], keys)
        return np.asarray(self._residues[degree][places, 1 : self.N])


def product_modes_of_seeds(N: int, seeds: Sequence[int], powers: Ints) -> NDArray[np.bool_]:
    """Whether the plain product of the seeds' cosines with these powers contains a cosine, exactly.

    powers : (count, s), small. Returns (count, N-1). Counts the signed sums: q and 2N +- q enter
    with opposite signs and can cancel, as for l + m = N in a triple product.
    """
    turn = 4 * N
    result = np.empty((len(powers), N - 1), dtype=np.bool_)
    q = np.arange(1, N)
    for row, power in enumerate(powers):
        counts = _signed_sums(turn, seeds, power)
        plus = counts[q] + counts[turn - q]
        minus = counts[2 * N - q] + counts[2 * N + q]
        result[row] = plus != minus
    return result


def _signed_sums(turn: int, seeds: Sequence[int], power: Ints) -> Ints:
    """How often each residue modulo `turn` is a sum of the seeds, each with either sign."""
    angles = np.arange(turn)
    counts = (angles == 0).astype(np.int64)
    for seed, e in zip(seeds, power, strict=True):
        for _ in range(int(e)):
            down, up = counts[(angles - seed) % turn], counts[(angles + seed) % turn]
            counts = down + up
    return np.asarray(counts)


NO_SEED = -1


class Transform(NamedTuple):
    """What modes are on the bonds that are kept, and the way back.

    The stored function is c_j = share sum_q u_q cos(angle_qj pi / 2N), and u_q of values is the sum
    of weight_j cos(angle_qj pi / 2N) times them. angles : (C, points), in 0 .. 2N.
    weights : one a point.
    """

    angles: Ints
    share: Fraction
    weights: tuple[Fraction, ...]


class Modes(ABC):
    """The modes that monomials have coefficients in: all that a ring asks about a chain's ends.

    N, seeds, grading : as given. columns : how many there are, C. points : values kept for a
    monomial. seed_columns : that of each seed, (s,).
    """

    columns: int
    points: int
    seed_columns: Ints

    def __init__(self, N: int, seeds: Sequence[int], grading: Grading) -> None:
        self.N, self.seeds, self.grading = N, tuple(seeds), grading

    @abstractmethod
    def transform(self) -> Transform:
        """Between columns and points."""

    @abstractmethod
    def parts(self, degree: int) -> list[tuple[Ints, slice]]:
        """Canonical monomials of a degree with the columns that they can have."""

    @abstractmethod
    def mask(self, degree: int) -> NDArray[np.bool_]:
        """Whether a canonical monomial of this degree can carry a mode; (canonical, C)."""

    @abstractmethod
    def mask_by_harmonic(self, degree: int) -> NDArray[np.bool_]:
        """Whether a harmonic can appear in a mode at this degree; shape (harmonics, C)."""

    @abstractmethod
    def wave_numbers(self, harmonics: Ints) -> Ints:
        """Of the modes in which harmonics (H, s) live, in 0 .. N-1; (H | 1, C)."""

    @abstractmethod
    def seeds_met(self, harmonics: Ints) -> Ints:
        """The number of the seed whose mode that is, NO_SEED where there is none; (H | 1, C)."""

    @abstractmethod
    def named(self, harmonic: Ints, wave: int) -> tuple[tuple[int, ...], int]:
        """A harmonic and its mode by the wave number, as they are named to a reader."""

    @abstractmethod
    def column(self, q: int, degree: int) -> tuple[int, NDArray[np.bool_] | None]:
        """Where the mode q stands, and which canonical monomials it has there; None for all."""

    @abstractmethod
    def in_mode(self, q: int, harmonics: Ints) -> tuple[Any, int]:
        """Entries of (H, C) in the mode q, whatever the direction of a wave."""

    @abstractmethod
    def of_seeds(self, degree: int) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
        """Entries of (canonical, C) in the mode of a seed, and those of (canonical, s) with it."""

    def gauge(self, harmonics: Ints) -> NDArray[np.bool_]:
        """Where a harmonic is +-e_q in the seed mode q itself, which the gauge leaves no term.

        harmonics : (H, s). Returns (H, C).
        """
        moduli = np.abs(harmonics)
        rows = np.flatnonzero(moduli.sum(axis=1) == 1)
        seeds = moduli[rows].argmax(axis=1)
        found = np.zeros((len(harmonics), self.columns), dtype=np.bool_)
        found[rows] = self.seeds_met(harmonics[rows]) == seeds[:, None]
        return found


class CosineModes(Modes):
    """Modes q = 1 .. N-1 on N bonds with the monomials of a grading: parities and masks.

    A monomial is even or odd with sum_i e_i q_i. It carries modes of that parity only, and its
    value on bond N-1-j is that on bond j times the parity: half of the bonds are enough.
    """

    def __init__(
        self,
        N: int,
        seeds: Sequence[int],
        grading: Grading,
        product_degree: int | None = None,
    ) -> None:
        """product_degree : a degree whose terms are plain products of the seeds.

        Cancelling couplings are exact zeros there.
        """
        super().__init__(N, seeds, grading)
        self.product_degree = product_degree
        self.half = self.points = (N + 1) // 2
        self.columns = N - 1
        self.seed_columns = np.array(self.seeds) - 1
        self._orders: dict[int, tuple[Ints, int]] = {}

    @cached_property
    def _table(self) -> PowerTable:
        return PowerTable(self.N, self.seeds, self.grading.degree)

    def transform(self) -> Transform:
        """The cosines cos(q (j + 1/2) pi / N) on the first half of the bonds.

        The way back has the weights 4/N, and half of it for a bond that is its own mirror image.
        """
        N = self.N
        angles = np.outer(np.arange(1, N), 2 * np.arange(self.half) + 1) % (4 * N)
        weights = [Fraction(4, N)] * self.half
        if N % 2:
            weights[-1] = Fraction(2, N)
        return Transform(np.minimum(angles, 4 * N - angles), Fraction(1), tuple(weights))

    def parts(self, degree: int) -> list[tuple[Ints, slice]]:
        """Canonical monomials of each parity with the modes of that parity."""
        parity = self.parity(degree)
        return [(np.flatnonzero(parity == p), self.modes(p)) for p in (0, 1)]

    def wave_numbers(self, harmonics: Ints) -> Ints:
        return np.arange(1, self.N)[None]

    def seeds_met(self, harmonics: Ints) -> Ints:
        met = np.full((1, self.columns), NO_SEED)
        met[0, self.seed_columns] = np.arange(len(self.seeds))
        return met

    def named(self, harmonic: Ints, wave: int) -> tuple[tuple[int, ...], int]:
        return tuple(map(int, harmonic)), int(wave)

    def column(self, q: int, degree: int) -> tuple[int, NDArray[np.bool_] | None]:
        return q - 1, None

    def in_mode(self, q: int, harmonics: Ints) -> tuple[Any, int]:
        return slice(None), q - 1

    def of_seeds(self, degree: int) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
        every = slice(None)
        return (every, self.seed_columns), (every, every)

    def parity(self, degree: int) -> Ints:
        """0 or 1 for each canonical monomial of a degree."""
        sums = self.grading.powers(degree) @ np.array(self.seeds)
        return np.asarray(sums % 2)

    def even_first(self, degree: int) -> tuple[Ints, int]:
        """The canonical monomials of a degree, even ones first, and how many these are."""
        if degree not in self._orders:
            parity = self.parity(degree)
            order = np.argsort(parity, kind="stable")
            self._orders[degree] = order, int(np.count_nonzero(parity == 0))
        return self._orders[degree]

    def modes(self, parity: int) -> slice:
        """The columns of the modes of a parity, among N - 1."""
        return slice(1 - parity, None, 2)

    def mask(self, degree: int) -> NDArray[np.bool_]:
        powers = self.grading.powers(degree)
        if degree == self.product_degree:
            return product_modes_of_seeds(self.N, self.seeds, powers)
        return self._table.carried(degree, powers)

    def mask_by_harmonic(self, degree: int) -> NDArray[np.bool_]:
        nu, index = self.grading.harmonics(degree)
        order = np.argsort(index, kind="stable")
        starts = np.searchsorted(index[order], np.arange(len(nu)))
        mask = self.mask(degree)[order]
        return np.asarray(np.logical_or.reduceat(mask, starts, axis=0))
