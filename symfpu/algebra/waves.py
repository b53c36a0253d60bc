"""Travelling waves: one number for each monomial, and no transform.

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

from symfpu.algebra.grading import Grading, Ints
from symfpu.algebra.selection import NO_SEED, Modes, Transform


class WaveModes(Modes):
    """Waves of signed wave numbers on N bonds with the monomials of a grading: one column."""

    columns = points = 1

    def __init__(self, N: int, seeds: Sequence[int], grading: Grading) -> None:
        super().__init__(N, seeds, grading)
        self.seed_columns = np.zeros(len(self.seeds), dtype=np.int64)

    def transform(self) -> Transform:
        """Half of the one number, and twice the one value."""
        return Transform(np.zeros((1, 1), dtype=np.int64), Fraction(1, 2), (Fraction(2),))

    def parts(self, degree: int) -> list[tuple[Ints, slice]]:
        """All together."""
        return [(np.arange(len(self.grading.canonical(degree))), slice(None))]

    def mask(self, degree: int) -> NDArray[np.bool_]:
        """Mode 0 does not move."""
        _, index = self.grading.harmonics(degree)
        return self.mask_by_harmonic(degree)[index]

    def mask_by_harmonic(self, degree: int) -> NDArray[np.bool_]:
        harmonics, _ = self.grading.harmonics(degree)
        return np.asarray(self.wave_numbers(harmonics) != 0)

    def wave_numbers(self, harmonics: Ints) -> Ints:
        """nu.q modulo N."""
        return np.asarray(harmonics @ np.array(self.seeds) % self.N)[:, None]

    def seeds_met(self, harmonics: Ints) -> Ints:
        """In either direction; of two opposite seeds the one whose wave number it is."""
        waves = self.wave_numbers(harmonics)
        met = np.full(waves.shape, NO_SEED)
        for i, q in enumerate(self.seeds):
            met[(waves + q) % self.N == 0] = i
        for i, q in enumerate(self.seeds):
            met[(waves - q) % self.N == 0] = i
        return met

    def named(self, harmonic: Ints, wave: int) -> tuple[tuple[int, ...], int]:
        """The signed mode; of the two conjugates the one in the mode of a seed."""
        mode, nu = signed(int(wave), self.N), tuple(map(int, harmonic))
        if mode not in self.seeds and -mode in self.seeds:
            return tuple(-n for n in nu), -mode
        return nu, mode

    def column(self, q: int, degree: int) -> tuple[int, NDArray[np.bool_] | None]:
        """The monomials of that wave number, conjugates apart."""
        harmonics, index = self.grading.harmonics(degree)
        return 0, (self.wave_numbers(harmonics)[:, 0] == q % self.N)[index]

    def in_mode(self, q: int, harmonics: Ints) -> tuple[Any, int]:
        waves = self.wave_numbers(harmonics)[:, 0]
        return ((waves - q) % self.N == 0) | ((waves + q) % self.N == 0), 0

    def of_seeds(self, degree: int) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
        harmonics, index = self.grading.harmonics(degree)
        met = self.seeds_met(harmonics)[index, 0]
        rows = np.flatnonzero(met != NO_SEED)
        return (rows, 0), (rows, met[rows])


def signed(wave: int, N: int) -> int:
    """The mode of a wave number, in -(N-1)/2 .. N/2."""
    inside = wave % N
    return inside if 2 * inside <= N else inside - N
