"""Rings of travelling waves: one number for each monomial, and no transform.

On a ring of bonds a wave w_i carries the phase of its wave number q_i from bond to bond, and a
monomial that of nu.q: it lives in this one mode, and products of values at one bond are products
of the whole. With u = sum over monomials, real coefficients, the stored function is c = u/2, so
that f o g = 2 f g means what it means for standing waves.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.dense import Floats, ValuesRing
from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.grading import Grading, Ints

NO_SEED = -1


class TravellingModes:
    """Waves of signed wave numbers on N bonds with the monomials of a grading.

    half : values kept for a monomial.
    """

    half = 1

    def __init__(self, N: int, seeds: Sequence[int], grading: Grading) -> None:
        self.N, self.seeds, self.grading = N, tuple(seeds), grading

    def wave_numbers(self, harmonics: Ints) -> Ints:
        """nu.q modulo N of harmonics (H, s), in 0 .. N-1."""
        return np.asarray(harmonics @ np.array(self.seeds) % self.N)

    def seeds_met(self, harmonics: Ints) -> Ints:
        """The number of the seed in whose mode a harmonic lives, in either direction.

        NO_SEED where there is none. Of two opposite seeds the one whose wave number it is.
        """
        waves = self.wave_numbers(harmonics)
        met = np.full(len(waves), NO_SEED)
        for i, q in enumerate(self.seeds):
            met[(waves + q) % self.N == 0] = i
        for i, q in enumerate(self.seeds):
            met[(waves - q) % self.N == 0] = i
        return met

    def mask_by_harmonic(self, degree: int) -> NDArray[np.bool_]:
        """Whether a harmonic can appear; shape (harmonics, 1). Mode 0 does not move."""
        harmonics, _ = self.grading.harmonics(degree)
        return np.asarray(self.wave_numbers(harmonics) != 0)[:, None]


class TravellingRing(ValuesRing):
    """What the rings of travelling waves share; modes are arrays (canonical monomials, 1)."""

    space: Any

    def _transforms(self) -> tuple[Floats, Floats]:
        """None."""
        return np.zeros((0, 0)), np.zeros((0, 0))

    def seed_terms(self) -> Floats:
        return np.ones((len(self.space.seeds), 1))

    def put(self, degree: int, modes: Floats) -> None:
        self._degrees.append(degree)
        self._modes.append(modes)
        values = np.zeros((len(modes), self._slices * self._lanes))
        values[:, :1] = self._times(modes.copy(), self.number(Fraction(1, 2)))
        self._store(self._bonds, degree, np.arange(len(modes)), values)
        self._store_seed_modes(degree, modes)
        self._keep_in_range(degree, modes)

    def _store_seed_modes(self, degree: int, modes: Floats) -> None:
        """A correction meets every wave: which of them counts is known in the end."""
        base = int(self.grading.first_row[degree])
        canonical = self.grading.canonical(degree)
        conjugate = self.grading.conjugate(degree)
        for i in range(len(self.space.seeds)):
            slice_, lane = divmod(i, 8)
            for rows in (canonical, conjugate):
                self._seed_modes[slice_, base + rows, lane] = modes[:, 0]

    def project(self, degree: int, parts: Sequence[tuple[float, Floats]]) -> Floats:
        canonical = self.grading.canonical(degree)
        modes = np.zeros((len(canonical), 1))
        two = self.number(Fraction(2))
        for coefficient, values in parts:
            wave = self._times(values[0, canonical, :1].copy(), coefficient)
            modes += self._times(wave, two)
        _, index = self.grading.harmonics(degree)
        modes *= self.space.mask_by_harmonic(degree)[index]
        return self._reduced(modes)

    def secular(self, degree: int, modes: NDArray[Any]) -> NDArray[Any]:
        canonical = self.grading.canonical(degree)
        diagonal = self.grading.diagonal(degree - 1)
        columns = []
        for i in range(len(self.space.seeds)):
            exponents = np.repeat(diagonal, 2, axis=1)
            exponents[:, 2 * i] += 1
            at = np.searchsorted(canonical, self.grading.rows(exponents))
            columns.append(modes[at, 0])
        return np.stack(columns, axis=1)

    def solve(
        self, degree: int, corrected: Floats, force: Floats, multipliers: Floats
    ) -> Floats:
        harmonics, index = self.grading.harmonics(degree)
        met = self.space.seeds_met(harmonics)[index]
        rows = np.flatnonzero(met != NO_SEED)
        bracket = np.negative(force, out=force)
        bracket[rows, 0] += corrected[rows, met[rows]]
        return self._times(self._reduced(bracket), multipliers[index])


class TravellingDoubles(TravellingRing, Float64Ring):
    """In doubles."""
