"""The projection of fixed ends: a column for every mode, one table for all harmonics."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, lru_cache
from typing import Any

import mpmath
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from symfpu.chain.chain import Chain
from symfpu.chain.projections.projection import (
    Floats,
    Ints,
    Mask,
    Projection,
    linear_halves,
)
from symfpu.chain.propagation import carried_modes
from symfpu.numbers.long_doubles import DIGITS, long


class ModeProjection(Projection):
    """Fixed ends: standing waves, whose torus stands still at the angles zero.

    every_bond : S of all bonds, (N-1, N), long doubles.
    """

    standing = True
    fold = 1.0  # the sign of the mode q + q' in a product of the columns q and q'

    def __init__(self, chain: Chain, seeds: Sequence[int], harmonics: Ints) -> None:
        self.chain, self.seeds = chain, tuple(seeds)
        self._set_tables()
        self._choose(harmonics)

    def _set_tables(self) -> None:
        self._set_columns(self.chain.N - 1, 0)

    def _set_columns(self, last: int, turn: int) -> None:
        """Cosines of the modes 1 .. last on the bonds, turned back by so many angles pi/2N."""
        N, modes, self._turn = self.chain.N, np.arange(1, last + 1), turn
        high, low = linear_halves(self.chain)
        self.omega, self._low = high[None, 1 : last + 1], low[None, 1 : last + 1]
        with mpmath.workdps(2 * DIGITS):
            norm, root = (
                long(mpmath.sqrt(mpmath.mpf(x))) for x in (2 / mpmath.mpf(N), 0.5)
            )
        normed = np.where(modes < N, 1, root) * self.omega
        self.modes, self.scale = modes[None], normed.astype(float)
        angles = (np.outer(modes, 2 * np.arange(N) + 1) - turn) % (4 * N)
        self.every_bond = norm * normed.T * _cosines(N)[angles]
        half = np.arange(self.points_of(self.chain))
        self.stretch = self.every_bond[None, :, : len(half)]
        self.images = np.where(2 * half + 1 == N, 1.0, 2.0)
        self._kinds = {}

    def _choose(self, harmonics: Ints) -> None:
        self.harmonics = harmonics

    @staticmethod
    def points_of(chain: Chain) -> int:
        return (chain.N + 1) // 2

    @staticmethod
    def columns_of(chain: Chain) -> int:
        return chain.N - 1

    @cached_property
    def mask(self) -> Mask:
        even = self.chain.potential.even
        return carried_modes(self.chain.N, self.seeds, self.harmonics, even=even)

    @property
    def entries(self) -> Ints:
        return np.arange(self.columns)[None]

    def exact_rows(self) -> tuple[list[Any], list[list[Any]]]:
        N, bonds = self.chain.N, range(self.points)
        root, half = mpmath.sqrt(mpmath.mpf(2) / N), mpmath.sqrt(mpmath.mpf(1) / 2)
        linear = [self.chain.linear_frequency(q) for q in range(1, self.columns + 1)]
        rows = []
        for q, Omega in enumerate(linear, 1):
            places = [(q * (2 * j + 1) - self._turn) % (4 * N) for j in bonds]
            size = root * Omega * (1 if q < N else half)
            rows.append([size * mpmath.cospi(mpmath.mpf(k) / (2 * N)) for k in places])
        return linear, rows

    def omega_in_halves(self) -> tuple[Floats, Floats]:
        return self.omega, self._low

    def column(self, q: int) -> int:
        return q - 1

    def deviating(self, q: int) -> Projection:
        return self

    def mask_of_deviation(self, q: int) -> Mask:
        parity = (self.harmonics @ np.array(self.seeds) + q) % 2
        mask = parity[:, None] == self.modes % 2
        if self.chain.potential.even:
            mask &= (self.harmonics.sum(axis=1) % 2 == 0)[:, None]
        return np.asarray(mask)

    def coupling_table(self, spectrum: Floats) -> Floats:
        """By what slopes have of the modes 0 .. N."""
        return np.asarray(spectrum.T @ self._products_of_modes)

    @cached_property
    def _products_of_modes(self) -> Floats:
        """cos(pi m (j + 1/2)/N) / N of half of the bonds with their images; (B, N + 1)."""
        N = self.chain.N
        angles = np.outer(2 * np.arange(self.points) + 1, np.arange(N + 1)) % (4 * N)
        cosines = np.cos(np.pi / (2 * N) * angles)
        return np.asarray(cosines * self.images[:, None] / N)

    def between(
        self, table: Floats, places: Sequence[Ints], columns: Ints, others: Ints
    ) -> Floats:
        """What slopes have of the modes |q - q'| and q + q', which beyond N changes its sign."""
        N, flat, width = self.chain.N, table.ravel(), table.shape[1]
        apart, total = np.abs(others - columns), others + (columns + 2)
        nearer = N - np.abs(total - N)
        sign = np.where(total > N, -self.fold, self.fold)
        found: Any = 0.0
        for place in places:
            row = place * width
            found = found + (flat.take(row + apart) + sign * flat.take(row + nearer))
        return np.asarray(found)

    def couplings(
        self, slope: Floats, rows: Ints, columns: Ints, others: Ints, least: float
    ) -> Floats:
        coupling = self._between_modes(slope @ self._products_of_modes)
        sizes = np.abs(coupling)
        coupling[sizes <= least * sizes.max()] = 0
        return np.asarray(coupling[columns])

    def _between_modes(self, row: Floats) -> Floats:
        """A slope of the bonds between all columns, (C, C), by what it has of the modes 0 .. N.

        Windows of rows of numbers: of |q - q'|, and of q + q' beyond N, where the sign turns.
        """
        N, count, scale = self.chain.N, self.columns, self.scale[0]
        apart = np.concatenate([row[count - 1 : 0 : -1], row[:count]])
        beyond = row[2 * (N - count) : N]
        total = self.fold * np.concatenate([row[2:], -beyond[::-1]])
        both = sliding_window_view(apart, count)[::-1] + sliding_window_view(total, count)
        both *= scale
        both *= scale[:, None]
        return np.asarray(both)


@lru_cache(maxsize=16)
def _cosines(N: int) -> Floats:
    """cos(pi k / 2N) of k = 0 .. 4N - 1 in long doubles."""
    with mpmath.workdps(2 * DIGITS):
        exact = [mpmath.cospi(mpmath.mpf(k) / (2 * N)) for k in range(4 * N)]
    return np.array([long(x) for x in exact])
