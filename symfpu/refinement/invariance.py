"""The invariance equation of a torus in Fourier space: linear part exact, products pseudo-spectral.

Q(theta) = sum over nu of c[nu] cos(nu.theta) is a torus of the chain if for every harmonic and
column ((nu.omega)^2 - Omega^2) c[nu] = N[nu], N the transform of V'(r) - r, which is
alpha r^2 + beta r^3 in an FPU chain, with the stretches r of the bonds on points of all angles.
What the columns are, which bonds are enough and where c are unknowns is said by the projection
of the chain (`symfpu.chain.projections`): of fixed ends a column for every mode, of travelling
waves on a ring one. All sums of one kind run in one precision, doubles or long doubles.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mpmath
import numpy as np

from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.chain.projections.by_ends import projection
from symfpu.chain.projections.modes import ModeProjection
from symfpu.chain.projections.projection import Projection
from symfpu.numbers.long_doubles import DIGITS, LONG_DOUBLES, in_halves
from symfpu.refinement.lattice import (
    Floats,
    Ints,
    Lattice,
    halves_of_pairs,
    places_of,
    shifted,
)

Slopes = tuple[Floats, Floats]  # derivatives by coefficients (H, C) and by shifts (s,)

PORTION = 4_000_000  # values of all bonds transformed at once
ROWS = 16  # of a block, made at once
APART = 1e-5  # of stretches, for a derivative by differences
# harmonics of the slopes that sparse rows hold, their least height, relative, and the least
# coupling of two columns by one of them
MOST_SLOPES, SHARE, LEAST_COUPLING = 12, 0.1, 1e-3
LEAST_STEP = 1e-3  # height of those by which further harmonics are reached, relative


def curvature(law: bonds.Law, r: Floats) -> Floats:
    """The third derivative of V by central differences of the second."""
    above, below = (bonds.anharmonic_stiffness(law, r + h) for h in (APART, -APART))
    return np.asarray((above - below) / (2 * APART))


class InvarianceEquation:
    """The equations of one torus: divisors and forces of coefficients, all (H, C).

    projection : of the harmonics. mask : which coefficients are unknown, (H, C). linear : Omega of
    every coefficient in long doubles, (H | 1, C). seed_rows, seed_columns : where the amplitudes of
    the seeds are, (s,).
    """

    def __init__(
        self,
        chain: Chain,
        seeds: Sequence[int],
        harmonics: Ints,
        separated: Ints | None = None,
    ) -> None:
        self.chain, self.seeds, self.harmonics = chain, tuple(seeds), harmonics
        self.grid = Lattice(harmonics, separated)
        self.projection = projection(chain, seeds, harmonics)
        self.mask, self.linear = self.projection.mask, self.projection.omega
        self.seed_rows = places_of(np.eye(len(seeds), dtype=np.int64), harmonics)
        self.seed_columns = np.array([self.projection.column(q) for q in seeds])
        self._weights = 0.5 * halves_of_pairs(harmonics)  # of c^2 in the mean of a square
        self._law = chain.law(LONG_DOUBLES)
        self._set_divisors()

    def _set_divisors(self) -> None:
        """nu.Omega - Omega_q and nu.Omega + Omega_q from twice as many digits as they keep."""
        with mpmath.workdps(2 * DIGITS):
            of_seeds = [self.chain.linear_frequency(q) for q in self.seeds]
            exact = [mpmath.fdot(nu, of_seeds) for nu in self.harmonics.tolist()]
        high, low = self.projection.omega_in_halves()
        rate_high, rate_low = (part[:, None] for part in in_halves(exact))
        self._below = (rate_high - high) + (rate_low - low)
        self._above = (rate_high + high) + (rate_low + low)

    def divisors(self, shifts: Floats) -> Floats:
        """(nu.omega)^2 - Omega_q^2 for omega = Omega + shifts of the seeds; shape (H, C).

        All in long doubles.

        nu.Omega - Omega_q, where digits cancel, is taken from twice as many.
        """
        moved = (self.harmonics @ shifts)[:, None]
        return np.asarray((self._below + moved) * (self._above + moved))

    @property
    def points(self) -> int:
        """Of the lattice."""
        return self.grid.points

    @property
    def seed_frequencies(self) -> Floats:
        """Omega of the seeds in long doubles; shape (s,)."""
        linear = np.broadcast_to(self.linear, self.mask.shape)
        return np.asarray(linear[self.seed_rows, self.seed_columns])

    def rates(self, shifts: Floats) -> Floats:
        """nu.omega in long doubles; shape (H,)."""
        return np.asarray(self.harmonics @ (self.seed_frequencies + shifts))

    def linear_at(self, harmonics: Ints) -> Floats:
        """Omega of every coefficient at other harmonics (M, s); (M | 1, C)."""
        return self.projection.at(harmonics).omega

    def _portions(self, grid: Lattice) -> list[slice]:
        """Bonds whose values on the points of a lattice fit into a portion."""
        step = max(1, PORTION // grid.points)
        return [slice(j, j + step) for j in range(0, self.projection.points, step)]

    def force(self, cosines: Floats) -> Floats:
        """N[nu] of coefficients (H, C), in their precision; 0 where the mask does not hold."""
        return self._force(self.grid, self.projection, cosines)

    def force_on(self, grid: Lattice, cosines: Floats) -> Floats:
        """The same of coefficients at the harmonics of another lattice, (M, C), at all of it."""
        return self._force(grid, self.projection.at(grid.harmonics), cosines)

    def _force(self, grid: Lattice, there: Projection, cosines: Floats) -> Floats:
        law = bonds.cast(self._law, cosines.dtype)
        total = np.zeros(cosines.shape, dtype=cosines.dtype)
        for part in self._portions(grid):
            r = grid.values(there.to_points(cosines, part))
            tension = bonds.anharmonic_tension(law, r)
            total += there.from_points(grid.coefficients(tension), part)
        return np.asarray(total * there.mask)

    def force_at(self, cosines: Floats, harmonics: Ints) -> Floats:
        """The same at other harmonics (M, s) that the lattice tells apart; shape (M, C)."""
        there = self.projection.at(harmonics)
        total = np.zeros((len(harmonics), cosines.shape[1]), dtype=np.longdouble)
        for part in self._portions(self.grid):
            r = self.grid.values(self.projection.to_points(cosines, part))
            tension = bonds.anharmonic_tension(self._law, r)
            total += there.from_points(self.grid.coefficients_at(tension, harmonics), part)
        return np.asarray(total * there.mask)

    def rounding(self, cosines: Floats, kind: type) -> Floats:
        """What rounding in numbers of a kind makes of the force, about; (H | 1, C).

        Every bond rounds at random at every point, and a force is a sum over bonds and points.
        """
        law, variances = self.chain.law(), np.zeros(self.projection.points)
        for part, r in self._stretches(cosines):
            variances[part] = np.mean(bonds.anharmonic_tension(law, r) ** 2, axis=1)
        sizes = self.projection.from_variances(variances)
        return np.asarray(np.finfo(kind).eps * self.grid.averaged_rounding * sizes)

    def _stretches(self, cosines: Floats) -> Any:
        """Portions of the bonds, and their stretches on the lattice in doubles, (b, points)."""
        c = cosines.astype(float)
        for part in self._portions(self.grid):
            yield part, self.grid.values(self.projection.to_points(c, part))

    def energy(
        self, cosines: Floats, shifts: Floats, *, harmonic: bool
    ) -> tuple[np.longdouble, Slopes]:
        """H, or the harmonic energy sum E_q, and its derivatives.

        At the start where waves stand, as in the paper; where they travel, and are nowhere at rest,
        the mean over the angles. On a torus H is the same everywhere, the harmonic energy is not.
        """
        if self.projection.standing:
            start = self.harmonic_energy_at_start if harmonic else self.energy_at_start
            return start(cosines)
        mean = self.mean_harmonic_energy if harmonic else self.mean_energy
        return mean(cosines, shifts)

    def energy_at_start(self, cosines: Floats) -> tuple[np.longdouble, Slopes]:
        """H at the angles zero, where standing waves have no momenta."""
        Q = cosines.sum(axis=0)
        return self.potential(Q), self._slopes_at_start(self.potential_slope(Q))

    def harmonic_energy_at_start(self, cosines: Floats) -> tuple[np.longdouble, Slopes]:
        """sum E_q at the angles zero, likewise."""
        Q, squares = cosines.sum(axis=0), self.linear[0] ** 2
        energy = np.longdouble((squares * Q**2).sum() / 2)
        return energy, self._slopes_at_start(squares * Q)

    def _slopes_at_start(self, slope: Floats) -> Slopes:
        by_cosine = np.broadcast_to(slope, self.mask.shape) * self.mask
        return by_cosine, np.zeros(len(self.seeds))

    def potential(self, Q: Floats) -> np.longdouble:
        """The potential energy of the modes of fixed ends, (N-1,), by all bonds."""
        each = bonds.potential(self._law, Q @ self._every_bond)
        return np.longdouble(each.sum())

    def potential_slope(self, Q: Floats) -> Floats:
        """Its gradient; shape (N-1,)."""
        tension = bonds.tension(self._law, Q @ self._every_bond)
        return np.asarray(self._every_bond @ tension)

    @property
    def _every_bond(self) -> Floats:
        assert isinstance(self.projection, ModeProjection)
        return np.asarray(self.projection.every_bond)

    def mean_energy(self, cosines: Floats, shifts: Floats) -> tuple[np.longdouble, Slopes]:
        """H averaged over the angles."""
        kinetic = self._mean_kinetic_energy(cosines, shifts)
        potential: Any = np.longdouble(0)
        for part in self._portions(self.grid):
            r = self.grid.values(self.projection.to_points(cosines, part))
            means = self.grid.spectrum(bonds.potential(self._law, r))[:, 0]
            potential += self.projection.images[part] @ means
        _, (by_cosine, by_shift) = self.mean_harmonic_energy(cosines, shifts)
        driven = 2 * self._weights[:, None] * self.force(cosines)
        return np.longdouble(kinetic + potential), (by_cosine + driven, by_shift)

    def _mean_kinetic_energy(self, cosines: Floats, shifts: Floats) -> np.longdouble:
        momenta = self.rates(shifts)[:, None] * cosines
        return np.longdouble((self._weights[:, None] * momenta**2).sum())

    def mean_harmonic_energy(
        self, cosines: Floats, shifts: Floats
    ) -> tuple[np.longdouble, Slopes]:
        """sum E_q averaged over the angles."""
        rates = self.rates(shifts)
        sizes = self._weights[:, None] * (rates[:, None] ** 2 + self.linear**2)
        by_rate = 2 * self._weights * rates * (cosines**2).sum(axis=1)
        energy = np.longdouble((sizes * cosines**2).sum())
        return energy, (2 * sizes * cosines, by_rate @ self.harmonics)

    def seed_energy(
        self, place: int, cosines: Floats, shifts: Floats
    ) -> tuple[np.longdouble, Slopes]:
        """E_q of a seed averaged over the angles, and its derivatives."""
        column = self.seed_columns[place]
        c, rates = cosines[:, column], self.rates(shifts)
        weights = self._weights * self.projection.energy_share(self.seeds[place])
        sizes = weights * (rates**2 + self.linear[:, column] ** 2)
        by_cosine = np.zeros(cosines.shape, dtype=cosines.dtype)
        by_cosine[:, column] = 2 * sizes * c
        by_shift = (2 * weights * rates * c**2) @ self.harmonics
        return np.longdouble((sizes * c**2).sum()), (by_cosine, by_shift)

    def slopes(self, cosines: Floats) -> Floats:
        """V''(r) - 1 on the lattice, in doubles; shape (B, points)."""
        law = self.chain.law()
        result = np.empty((self.projection.points, self.grid.points))
        for part, r in self._stretches(cosines):
            result[part] = bonds.anharmonic_stiffness(law, r)
        return result

    def steps(self, slopes: Floats, most: int) -> Ints:
        """The largest harmonics of the slopes, so many at most, with both signs; (k, s)."""
        return self.grid.tallest(self._spectrum(slopes), most, LEAST_STEP)

    def slope_changes(self, cosines: Floats, weights: Floats) -> Floats:
        """Derivatives of the mean of weights times slopes, (H, C); weights (B, points).

        By differences, good to some ten digits: for Newton's matrix.
        """
        r = self.grid.values(self.projection.to_points(cosines.astype(float)))
        bent = weights * curvature(self.chain.law(), r)
        spectrum = self.grid.spectrum(bent)[:, self.grid.entries(self.harmonics)]
        return np.asarray(self.projection.transposed(spectrum.T) * self.mask)

    def force_change(self, slopes: Floats, change: Floats) -> Floats:
        """The derivative of the force along a change of the coefficients, in doubles; (H, C)."""
        total = np.zeros(change.shape)
        for part in self._portions(self.grid):
            d = self.grid.values(self.projection.to_points(change, part))
            driven = self.grid.coefficients(slopes[part] * d)
            total += self.projection.from_points(driven, part)
        return np.asarray(total * self.mask)

    def block(self, slopes: Floats, rows: Ints, columns: Ints) -> Floats:
        """The derivative of the force between chosen unknowns; shape (m, m).

        rows, columns : of harmonic and column. Of a unit of cos(nu'.theta) the coefficient at nu is
        slope[nu - nu'] + slope[nu + nu'], half of it for nu = 0, coupled as the columns are.
        """
        there = self.projection
        table = there.coupling_table(self._spectrum(slopes))
        nu, scale = self.harmonics[rows], there.scales(rows, columns)
        along = nu @ self.grid.generator
        matrix = np.empty((len(rows), len(rows)))
        for first in range(0, len(rows), ROWS):
            own, rest = slice(first, first + ROWS), slice(first, None)
            both = (along[own, None] - along[rest], along[own, None] + along[rest])
            places = [self.grid.folded(turned) for turned in both]
            found = there.between(table, places, columns[own, None], columns[rest])
            matrix[own, rest] = scale[own, None] * scale[rest] * found
            matrix[rest, own] = matrix[own, rest].T
        matrix[(nu == 0).all(axis=1)] /= 2
        return matrix

    def _spectrum(self, slopes: Floats) -> Floats:
        """Coefficients of the slopes of all points, by place; shape (B, points)."""
        spectrum = np.empty_like(slopes)
        for part in self._portions(self.grid):
            spectrum[part] = self.grid.spectrum(slopes[part])
        return spectrum

    def sparse_rows(self, slopes: Floats, rows: Ints, columns: Ints) -> Any:
        """The derivative of the force on chosen unknowns, by the largest harmonics of the slopes.

        rows, columns : of harmonic and column. A sparse matrix (m, unknowns), those in the order of
        the mask.
        """
        from scipy import sparse

        spectrum, weights = self._spectrum(slopes), self._weights
        unknowns = int(self.mask.sum())
        number = np.full(self.mask.shape, -1, dtype=np.int32)
        number[self.mask] = np.arange(unknowns, dtype=np.int32)
        parts = []
        for kappa in self.grid.tallest(spectrum, MOST_SLOPES, SHARE):
            slope = spectrum[:, self.grid.entries(kappa)]
            at, to = shifted(self.harmonics, rows, kappa)
            own = rows[at], columns[at]
            coupling = self.projection.couplings(slope, *own, to, LEAST_COUPLING)
            values = (weights[to] / weights[rows[at]])[:, None] * coupling
            places = number[to]
            k, c = np.nonzero((values != 0) & (places >= 0))
            parts.append((values[k, c], at[k], places[k, c]))
        values, i, j = (np.concatenate(x) for x in zip(*parts, strict=True))
        return sparse.csr_matrix((values, (i, j)), shape=(len(rows), unknowns))
