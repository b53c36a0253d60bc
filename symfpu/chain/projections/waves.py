"""The projection of travelling waves on a ring: one column, and one point for all bonds.

A harmonic nu lives in the wave m = nu.q of the seeds q alone, so that the stretch of bond j is
r(theta - 2 pi q (j + 1/2)/N) with one even function of the s angles

    r(psi) = N^(-1/2) sum over nu of Omega_m c[nu] cos(nu.psi),

and all particles move by (omega.d/dpsi)^2 r = V'(r) forward - 2 V'(r) + V'(r) backward, the shift
being 2 pi q/N: ((nu.omega)^2 - Omega_m^2) c = N^(1/2) Omega_m (V'(r) - r)[nu]. There is no lattice
of modes. Ours.

To go on by one site while theta_i goes on by 2 pi q_i/N leaves such a torus as it is. So a
deviation keeps its own wave k, beside the harmonics of the torus: with m = k + nu.q,

    x_j = N^(-1/2) exp(i sigma t) sum over nu of p[nu] exp(i nu.theta - 2 pi i m j/N),

and Omega_m has the sign of sin(pi m/N).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.projections.projection import (
    Floats,
    Ints,
    Mask,
    Projection,
    linear_halves,
)
from symfpu.numbers.long_doubles import DIGITS, long

LARGEST = 2.0  # of linear frequencies


class WaveProjection(Projection):
    """Travelling waves: coefficients of the one function of the angles for all bonds."""

    standing = False

    def __init__(self, chain: Chain, seeds: Sequence[int], harmonics: Ints) -> None:
        self.chain, self.seeds = chain, tuple(seeds)
        with mpmath.workdps(2 * DIGITS):
            self._root = long(mpmath.sqrt(chain.N))
        self._linear, self._low = linear_halves(chain)
        self.images = np.array([float(chain.N)])
        self._start: int | None = None  # the mode of a deviation
        self._choose(harmonics)

    def _choose(self, harmonics: Ints) -> None:
        N = self.chain.N
        waves = harmonics @ np.array(self.seeds) + (self._start or 0)
        self.harmonics, self._waves = harmonics, waves % N
        self.modes = np.where(2 * self._waves > N, self._waves - N, self._waves)[:, None]
        signed = self.omega = self._linear[self._waves][:, None]
        if self._start is not None:
            signed = np.where(waves // N % 2 == 0, 1, -1)[:, None] * self.omega
        self.scale = signed.astype(float)
        self.stretch = (signed / self._root)[:, :, None]
        self._kinds = {}

    @staticmethod
    def points_of(chain: Chain) -> int:
        return 1

    @staticmethod
    def columns_of(chain: Chain) -> int:
        return 1

    @cached_property
    def mask(self) -> Mask:
        """Waves that move; where V is even only those of odd harmonics."""
        return self._moving(odd=1)

    def _moving(self, odd: int) -> Mask:
        moving = self._waves != 0
        if self.chain.potential.even:
            moving &= self.harmonics.sum(axis=1) % 2 == odd
        return np.asarray(moving[:, None])

    @property
    def entries(self) -> Ints:
        second = self.chain.N * (self.scale < 0)
        return np.asarray(self._waves[:, None] + second)

    def exact_rows(self) -> tuple[list[Any], list[list[Any]]]:
        """Of every wave, and again with the other sign."""
        N = self.chain.N
        linear, root = [self.chain.linear_frequency(m) for m in range(N)], mpmath.sqrt(N)
        rows = [Omega / root for Omega in linear]
        return 2 * linear, [[x] for x in rows] + [[-x] for x in rows]

    def omega_in_halves(self) -> tuple[Floats, Floats]:
        return self.omega, self._low[self._waves][:, None]

    def column(self, q: int) -> int:
        return 0

    def energy_share(self, q: int) -> Floats:
        """Half of the waves of a mode are in -q, but for N/2."""
        own = np.abs(self.modes[:, 0]) == abs(q)
        part = 1.0 if 2 * q == self.chain.N else 0.5
        return np.asarray(part * (own & self.mask[:, 0]))

    def deviating(self, q: int) -> WaveProjection:
        found = self._copied()
        found._start = q
        found._choose(self.harmonics)
        return found

    def mask_of_deviation(self, q: int) -> Mask:
        """All but m = 0, the whole ring in uniform motion, which nothing couples to."""
        return self._moving(odd=0)

    def largest_norm(self, t: Floats) -> float:
        return LARGEST * float(self._root) * float(np.linalg.norm(t))

    def coupling_table(self, spectrum: Floats) -> Floats:
        """The slopes of the one point."""
        return spectrum.T

    def between(
        self, table: Floats, places: Sequence[Ints], columns: Ints, others: Ints
    ) -> Floats:
        slopes = table[:, 0]
        return np.asarray(sum(slopes[place] for place in places))

    def couplings(
        self, slope: Floats, rows: Ints, columns: Ints, others: Ints, least: float
    ) -> Floats:
        return np.asarray(self.scale[rows] * self.scale[others] * slope)

    def from_modes(self, p: Floats) -> Floats:
        """Each harmonic is in one wave."""
        return np.asarray(p.sum(axis=1, keepdims=True))
