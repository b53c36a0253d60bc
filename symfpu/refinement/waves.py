"""The equation of travelling waves on a ring: one function of the angles for all its bonds.

A harmonic nu lives in the wave m = nu.q of the seeds q alone, so that the stretch of bond j is
r(theta - 2 pi q (j + 1/2)/N) with one even function of the s angles

    r(psi) = N^(-1/2) sum over nu of Omega_m c[nu] cos(nu.psi),

and all particles move by (omega.d/dpsi)^2 r = V'(r) forward - 2 V'(r) + V'(r) backward, the shift
being 2 pi q/N: ((nu.omega)^2 - Omega_m^2) c = N^(1/2) Omega_m (V'(r) - r)[nu]. There is no lattice
of modes. Ours. All sums of one kind run in one precision, as in `invariance`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.refinement.couplings import (
    largest_slopes,
    shifted,
    sparse_rows,
    steps_by_slopes,
)
from symfpu.refinement.equation import Floats, Ints, Slopes
from symfpu.refinement.invariance import DIGITS, LONG_DOUBLES, curvature, long
from symfpu.refinement.lattice import Lattice, places_of


class WaveEquation:
    """The equations of one torus of a ring: divisors and forces of coefficients, all (H, 1).

    Those of the seeds are their amplitudes. `mask` leaves out mode 0, which does not move.
    """

    def __init__(
        self,
        chain: Chain,
        seeds: Sequence[int],
        harmonics: Ints,
        apart: Ints | None = None,
    ) -> None:
        self.chain, self.seeds, self.harmonics = chain, tuple(seeds), harmonics
        self.grid = Lattice(harmonics, apart)
        self.waves = self._waves_of(harmonics)
        self.mask = self._allowed()
        self.seed_rows = places_of(np.eye(len(seeds), dtype=np.int64), harmonics)
        self.seed_columns = np.zeros(len(seeds), dtype=np.int64)
        with mpmath.workdps(2 * DIGITS):
            linear = [chain.linear_frequency(m) for m in range(chain.N)]
            self._root = long(mpmath.sqrt(chain.N))
        self._linear = np.array([long(w) for w in linear])
        self.linear = self.linear_at(harmonics)
        self._stretch, self._back = self.linear / self._root, self.linear * self._root
        self._law = chain.law(LONG_DOUBLES)
        self._set_divisors(linear)

    def _waves_of(self, harmonics: Ints) -> Ints:
        """The m that carry harmonics (M, s), of 0 .. N-1; shape (M,)."""
        return np.asarray(harmonics @ np.array(self.seeds) % self.chain.N)

    def _allowed(self) -> NDArray[np.bool_]:
        """Waves that move; where V is even only those of odd harmonics."""
        moving = self.waves != 0
        if self.chain.potential.even:
            moving &= self.harmonics.sum(axis=1) % 2 == 1
        return np.asarray(moving[:, None])

    def _set_divisors(self, linear: Sequence[Any]) -> None:
        """nu.Omega - Omega_m and nu.Omega + Omega_m from twice as many digits as they keep."""
        of_seeds = [linear[q % self.chain.N] for q in self.seeds]
        with mpmath.workdps(2 * DIGITS):
            drives = [mpmath.fdot(nu, of_seeds) for nu in self.harmonics.tolist()]
            pairs = list(zip(drives, self.waves.tolist(), strict=True))
            below = [long(drive - linear[m]) for drive, m in pairs]
            above = [long(drive + linear[m]) for drive, m in pairs]
        self._below, self._above = np.array(below), np.array(above)

    @property
    def points(self) -> int:
        """Of the lattice."""
        return self.grid.points

    @property
    def seed_frequencies(self) -> Floats:
        """Omega of the seeds in long doubles; shape (s,)."""
        return np.asarray(self.linear[self.seed_rows, 0])

    def divisors(self, shifts: Floats) -> Floats:
        """(nu.omega)^2 - Omega_m^2 for omega = Omega + shifts of the seeds; shape (H, 1)."""
        moved = self.harmonics @ shifts
        return np.asarray((self._below + moved) * (self._above + moved))[:, None]

    def rates(self, shifts: Floats) -> Floats:
        """nu.omega in long doubles; shape (H,)."""
        return np.asarray(self.harmonics @ (self.seed_frequencies + shifts))

    def _stretches(self, coefficients: Floats) -> Floats:
        """The function r at the points, (1, points), in the precision of the coefficients."""
        return self.grid.values(coefficients * self._stretch.astype(coefficients.dtype))

    def _projected(self, tension: Floats) -> Floats:
        """What a tension at the points (1, points) drives; shape (H, 1)."""
        found = self.grid.coefficients(tension)
        return np.asarray(found * self._back.astype(tension.dtype) * self.mask)

    def force(self, cosines: Floats) -> Floats:
        """The force of the anharmonic part of V, (H, 1), in the precision of coefficients."""
        law = bonds.cast(self._law, cosines.dtype)
        return self._projected(bonds.anharmonic_tension(law, self._stretches(cosines)))

    def force_on(self, grid: Lattice, cosines: Floats) -> Floats:
        """The same of coefficients at the harmonics of another lattice, (M, 1), at all of it."""
        law, linear = bonds.cast(self._law, cosines.dtype), self.linear_at(grid.harmonics)
        r = grid.values(cosines * (linear / self._root).astype(cosines.dtype))
        found = grid.coefficients(bonds.anharmonic_tension(law, r))
        return np.asarray(found * (linear * self._root).astype(cosines.dtype))

    def linear_at(self, harmonics: Ints) -> Floats:
        """Omega of the wave that carries each harmonic, (M, 1)."""
        return np.asarray(self._linear[self._waves_of(harmonics)][:, None])

    def rounding(self, cosines: Floats, kind: type) -> Floats:
        """What rounding in numbers of a kind makes of the force, about; shape (H, 1)."""
        tension = bonds.anharmonic_tension(
            self.chain.law(), self._stretches(cosines.astype(float))
        )
        size = (
            np.finfo(kind).eps * self.grid.averaged_rounding * np.sqrt(np.mean(tension**2))
        )
        return np.asarray(size * self._back.astype(float))

    def slopes(self, cosines: Floats) -> Floats:
        """V''(r) - 1 at the points, in doubles; shape (1, points)."""
        r = self._stretches(cosines.astype(float))
        return np.asarray(bonds.anharmonic_stiffness(self.chain.law(), r))

    def steps(self, slopes: Floats, most: int) -> Ints:
        """The largest harmonics of the slopes, so many at most, with both signs; (k, s)."""
        return steps_by_slopes(self.grid, self.grid.spectrum(slopes), most)

    def slope_changes(self, cosines: Floats, weights: Floats) -> Floats:
        """Derivatives of the mean of weights times slopes, (H, 1); weights (1, points)."""
        r = self._stretches(cosines.astype(float))
        bent = weights * curvature(self.chain.law(), r)
        spectrum = self.grid.spectrum(bent)[:, self.grid.entries(self.harmonics)]
        return np.asarray(spectrum.T * self._stretch.astype(float) * self.mask)

    def force_change(self, slopes: Floats, change: Floats) -> Floats:
        """The derivative of the force along a change of the coefficients, in doubles; (H, 1)."""
        return self._projected(slopes * self._stretches(change))

    def block(self, slopes: Floats, rows: Ints, columns: Ints) -> Floats:
        """The derivative of the force between chosen unknowns; shape (m, m).

        Of a unit of cos(nu'.psi) the coefficient at nu is slope[nu - nu'] + slope[nu + nu'].
        """
        spectrum = self.grid.spectrum(slopes)[0]
        along = self.harmonics[rows] @ self.grid.generator
        there = self._stretch[rows, 0].astype(float)
        back = self._back[rows, 0].astype(float)
        matrix = np.empty((len(rows), len(rows)))
        for a in range(len(rows)):
            both = spectrum[self.grid.folded(along[a] - along)]
            both += spectrum[self.grid.folded(along[a] + along)]
            matrix[a] = back[a] * both * there
        return matrix

    def sparse_rows(self, slopes: Floats, rows: Ints, columns: Ints) -> Any:
        """The derivative of the force on chosen unknowns, by the largest harmonics of the slopes.

        rows, columns : of harmonic and mode. A sparse matrix (m, unknowns), those in the order of
        the mask.
        """
        spectrum = self.grid.spectrum(slopes)

        def coupled(kappa: Ints) -> tuple[Floats, Ints, Ints]:
            at, to = shifted(self.harmonics, rows, kappa)
            slope = spectrum[0, self.grid.entries(kappa)]
            values = (self._back[rows[at]] * self._stretch[to]).astype(float) * slope
            return values, at, to

        kappas = largest_slopes(self.grid, spectrum)
        return sparse_rows(self.mask, kappas, coupled, len(rows))

    def energy(
        self, cosines: Floats, shifts: Floats, *, harmonic: bool
    ) -> tuple[np.longdouble, Slopes]:
        """H, or the harmonic energy, averaged over the angles, and its derivatives.

        A wave is nowhere at rest; on a torus H is the same everywhere.
        """
        c, rates = cosines[:, 0], self.rates(shifts)
        stiffness = self.linear[:, 0] ** 2
        kinetic, elastic = (rates**2 * c) @ c / 4, (stiffness * c) @ c / 4
        by_cosine = (rates**2 + stiffness) * c / 2
        by_shift = (rates * c**2 / 2) @ self.harmonics
        if harmonic:
            return np.longdouble(kinetic + elastic), (by_cosine[:, None], by_shift)
        r = self._stretches(cosines)
        mean = self.grid.spectrum(bonds.potential(self._law, r))[0, 0]
        driven = by_cosine[:, None] + self.force(cosines) / 2
        return np.longdouble(kinetic + self.chain.N * mean), (driven, by_shift)

    def seed_energy(
        self, place: int, cosines: Floats, shifts: Floats
    ) -> tuple[np.longdouble, Slopes]:
        """E_q of a seed averaged over the angles: half of its waves are in -q, but for N/2."""
        q, N = self.seeds[place], self.chain.N
        own = ((self.waves - q) % N == 0) | ((self.waves + q) % N == 0)
        part = (1 if 2 * q == N else 0.5) * own * self.mask[:, 0]
        c, rates = cosines[:, 0], self.rates(shifts)
        sizes = part * (rates**2 + self.linear[:, 0] ** 2) / 4
        by_shift = (part * rates * c**2 / 2) @ self.harmonics
        return np.longdouble((sizes * c) @ c), ((2 * sizes * c)[:, None], by_shift)
