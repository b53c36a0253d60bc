"""The invariance equation of a torus in Fourier space: linear part exact, products pseudo-spectral.

Q(theta) = sum over nu of c[nu] cos(nu.theta) is a torus of the chain if for every harmonic and
column ((nu.omega)^2 - Omega^2) c[nu] = N[nu], N the transform of V'(r) - r, which is
alpha r^2 + beta r^3 in an FPU chain, with the stretches r of the bonds on points of all angles.
What the columns are, which bonds are enough and where c are unknowns is said by the projection
of the chain (`symfpu.chain.projections`): of fixed ends a column for every mode, of travelling
waves on a ring one. All sums of one kind run in one precision, doubles or long doubles.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from functools import cached_property
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
WithSlopes = tuple[np.longdouble, Slopes]  # a number and its derivatives

PORTION = 4_000_000  # values of all bonds transformed at once
ROWS = 16  # of the matrix of a deviation, made at once
ENTRIES = 8192  # of a block, made at once
APART = 1e-5  # of stretches, for a derivative by differences
# harmonics of the slopes that sparse rows hold, their least height, relative, and the least
# coupling of two columns by one of them
MOST_SLOPES, SHARE, LEAST_COUPLING = 12, 0.1, 1e-3
LEAST_STEP = 1e-3  # height of those by which further harmonics are reached, relative


def curvature(law: bonds.Law, r: Floats) -> Floats:
    """The third derivative of V by central differences of the second."""
    above, below = (bonds.anharmonic_stiffness(law, r + h) for h in (APART, -APART))
    return np.asarray((above - below) / (2 * APART))


def _runs(numbers: Ints) -> tuple[Ints, Ints]:
    """The values of runs of equal numbers, and in which run each of them is."""
    begins = np.ones(len(numbers), dtype=bool)
    np.not_equal(numbers[1:], numbers[:-1], out=begins[1:])
    return numbers[begins], np.cumsum(begins) - 1


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
        self.chain, self.seeds = chain, tuple(seeds)
        self._law = chain.law(LONG_DOUBLES)
        self._law_in_doubles = chain.law()
        self._choose(projection(chain, seeds, harmonics), separated)

    def _choose(self, there: Projection, separated: Ints | None = None) -> None:
        """Takes the harmonics of a projection."""
        self.projection, harmonics = there, there.harmonics
        self.harmonics, self.grid = harmonics, Lattice(harmonics, separated)
        self.mask, self.linear = there.mask, there.omega
        self.seed_rows = places_of(np.eye(len(self.seeds), dtype=np.int64), harmonics)
        self.seed_columns = np.array([there.column(q) for q in self.seeds])
        self._weights = 0.5 * halves_of_pairs(harmonics)  # of c^2 in the mean of a square

    def at(self, harmonics: Ints) -> InvarianceEquation:
        """The same at other harmonics (M, s)."""
        found = copy(self)
        found.__dict__.pop("_factors", None)
        found._choose(self.projection.at(harmonics))
        return found

    @cached_property
    def _factors(self) -> tuple[Floats, Floats]:
        """nu.Omega - Omega_q and nu.Omega + Omega_q from twice as many digits as they keep."""
        with mpmath.workdps(2 * DIGITS):
            of_seeds = [self.chain.linear_frequency(q) for q in self.seeds]
            exact = [mpmath.fdot(nu, of_seeds) for nu in self.harmonics.tolist()]
        high, low = self.projection.omega_in_halves()
        rate_high, rate_low = (part[:, None] for part in in_halves(exact))
        below = (rate_high - high) + (rate_low - low)
        return below, (rate_high + high) + (rate_low + low)

    def divisors(self, shifts: Floats) -> Floats:
        """(nu.omega)^2 - Omega_q^2 for omega = Omega + shifts of the seeds; shape (H, C).

        All in long doubles.

        nu.Omega - Omega_q, where digits cancel, is taken from twice as many.
        """
        moved, (below, above) = (self.harmonics @ shifts)[:, None], self._factors
        return np.asarray((below + moved) * (above + moved))

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

    def _stretches(
        self, cosines: Floats, grid: Lattice | None = None
    ) -> Iterator[tuple[slice, Floats]]:
        """Bonds whose values on a lattice fit into a portion, and these; (b, points)."""
        grid, there = self._lattice(grid)
        step = max(1, PORTION // grid.points)
        for j in range(0, there.points, step):
            part = slice(j, j + step)
            yield part, grid.values(there.to_points(cosines, part))

    def _lattice(self, grid: Lattice | None) -> tuple[Lattice, Projection]:
        """A lattice with the projection of its harmonics; default its own."""
        if grid is None:
            return self.grid, self.projection
        return grid, self.projection.at(grid.harmonics)

    def force(
        self, cosines: Floats, *, grid: Lattice | None = None, at: Ints | None = None
    ) -> Floats:
        """N[nu] of coefficients (H, C), in their precision; 0 where the mask does not hold.

        grid : another lattice, of whose harmonics the coefficients are. at : other harmonics (M, s)
        that the lattice tells apart, of the result (M, C).
        """
        lattice, there = self._lattice(grid)
        if at is not None:
            there = self.projection.at(at)
        law = self._law if cosines.dtype == np.longdouble else self._law_in_doubles
        total = np.zeros(there.mask.shape, dtype=cosines.dtype)
        for part, r in self._stretches(cosines, grid):
            tension = bonds.anharmonic_tension(law, r)
            total += there.from_points(lattice.coefficients(tension, at), part)
        return np.asarray(total * there.mask)

    def rounding(self, cosines: Floats, kind: type) -> Floats:
        """What rounding in numbers of a kind makes of the force, about; (H | 1, C).

        Every bond rounds at random at every point, and a force is a sum over bonds and points.
        """
        law, variances = self._law_in_doubles, np.zeros(self.projection.points)
        for part, r in self._stretches(cosines.astype(float)):
            variances[part] = np.mean(bonds.anharmonic_tension(law, r) ** 2, axis=1)
        sizes = self.projection.from_variances(variances)
        return np.asarray(np.finfo(kind).eps * self.grid.averaged_rounding * sizes)

    def energy(self, cosines: Floats, shifts: Floats, *, harmonic: bool) -> WithSlopes:
        """H, or the harmonic energy sum E_q, and its derivatives.

        At the start where waves stand, as in the paper; where they travel, and are nowhere at rest,
        the mean over the angles. On a torus H is the same everywhere, the harmonic energy is not.
        """
        if self.projection.standing:
            start = self.harmonic_energy_at_start if harmonic else self.energy_at_start
            return start(cosines)
        mean = self.mean_harmonic_energy if harmonic else self.mean_energy
        return mean(cosines, shifts)

    def energy_at_start(self, cosines: Floats) -> WithSlopes:
        """H at the angles zero, where standing waves have no momenta."""
        assert isinstance(self.projection, ModeProjection)
        every_bond = self.projection.every_bond
        r = cosines.sum(axis=0) @ every_bond
        slope = every_bond @ bonds.tension(self._law, r)
        energy = np.longdouble(bonds.potential(self._law, r).sum())
        return energy, self._slopes_at_start(slope)

    def harmonic_energy_at_start(self, cosines: Floats) -> WithSlopes:
        """sum E_q at the angles zero, likewise."""
        Q, squares = cosines.sum(axis=0), self.linear[0] ** 2
        energy = np.longdouble((squares * Q**2).sum() / 2)
        return energy, self._slopes_at_start(squares * Q)

    def _slopes_at_start(self, slope: Floats) -> Slopes:
        by_cosine = np.broadcast_to(slope, self.mask.shape) * self.mask
        return by_cosine, np.zeros(len(self.seeds))

    def mean_energy(self, cosines: Floats, shifts: Floats) -> WithSlopes:
        """H averaged over the angles."""
        weights = self._weights[:, None]
        momenta = self.rates(shifts)[:, None] * cosines
        energy: Any = (weights * momenta**2).sum()
        for part, r in self._stretches(cosines):
            means = self.grid.spectrum(bonds.potential(self._law, r))[:, 0]
            energy += self.projection.images[part] @ means
        _, (by_cosine, by_shift) = self.mean_harmonic_energy(cosines, shifts)
        driven = 2 * weights * self.force(cosines)
        return np.longdouble(energy), (by_cosine + driven, by_shift)

    def mean_harmonic_energy(self, cosines: Floats, shifts: Floats) -> WithSlopes:
        """sum E_q averaged over the angles."""
        return self._mean_of_modes(self._weights[:, None], cosines, shifts)

    def seed_energy(self, place: int, cosines: Floats, shifts: Floats) -> WithSlopes:
        """E_q of a seed averaged over the angles, and its derivatives."""
        weights = np.zeros(self.mask.shape)
        share = self.projection.energy_share(self.seeds[place])
        weights[:, self.seed_columns[place]] = self._weights * share
        return self._mean_of_modes(weights, cosines, shifts)

    def _mean_of_modes(
        self, weights: Floats, cosines: Floats, shifts: Floats
    ) -> WithSlopes:
        """Harmonic energies with weights (H, C) of c^2, averaged over the angles."""
        rates = self.rates(shifts)
        sizes = weights * (rates[:, None] ** 2 + self.linear**2)
        by_rate = 2 * rates * (weights * cosines**2).sum(axis=1)
        energy = np.longdouble((sizes * cosines**2).sum())
        return energy, (2 * sizes * cosines, by_rate @ self.harmonics)

    def slopes(self, cosines: Floats) -> Floats:
        """V''(r) - 1 on the lattice, in doubles; shape (B, points)."""
        law = self._law_in_doubles
        result = np.empty((self.projection.points, self.grid.points))
        for part, r in self._stretches(cosines.astype(float)):
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
        bent = weights * curvature(self._law_in_doubles, r)
        spectrum = self.grid.spectrum(bent)[:, self.grid.entries(self.harmonics)]
        return np.asarray(self.projection.transposed(spectrum.T) * self.mask)

    def force_change(self, slopes: Floats, change: Floats) -> Floats:
        """The derivative of the force along a change of the coefficients, in doubles; (H, C)."""
        total = np.zeros(change.shape)
        for part, d in self._stretches(change):
            driven = self.grid.coefficients(slopes[part] * d)
            total += self.projection.from_points(driven, part)
        return np.asarray(total * self.mask)

    def block(
        self,
        slopes: Floats,
        rows: Ints,
        columns: Ints,
        others: tuple[Ints, Ints] | None = None,
    ) -> Floats:
        """The derivative of the force at m chosen unknowns by others; shape (m, k).

        rows, columns : of harmonic and column. others : the same of the others; default these.
        Of a unit of cos(nu'.theta) the coefficient at nu is slope[nu - nu'] + slope[nu + nu'], half
        of it for nu = 0, coupled as the columns are.
        """
        there, table = self.projection, self._table(slopes)
        to_rows, to_columns = others or (rows, columns)
        matrix = np.empty((len(rows), len(to_rows)))
        scale, along, runs = to_scale, beside, to_runs = self._chosen(rows, columns)
        if others:
            to_scale, beside, to_runs = self._chosen(to_rows, to_columns)
        many = runs * to_runs * table.shape[1] < matrix.size
        last = 0
        while last < len(rows):
            first, begin = last, 0 if others else last
            last = first + max(1, ENTRIES // (len(to_rows) - begin))
            own, rest = slice(first, last), slice(begin, None)
            slope, places = self._slopes_between(table, along[own], beside[rest], many)
            found = there.between(slope, places, columns[own, None], to_columns[rest])
            found *= to_scale[rest]
            found *= scale[own, None]
            matrix[own, rest] = found
            if not others:
                matrix[rest, own] = found.T
        matrix[(self.harmonics[rows] == 0).all(axis=1)] /= 2
        return matrix

    def _chosen(self, rows: Ints, columns: Ints) -> tuple[Floats, Ints, int]:
        """Scales and nu.g of chosen unknowns, and into how many runs of harmonics they fall."""
        along = self.harmonics[rows] @ self.grid.generator
        return self.projection.scales(rows, columns), along, len(_runs(along)[0])

    def _slopes_between(
        self, table: Floats, nu: Ints, kappa: Ints, many: bool
    ) -> tuple[Floats, list[Ints]]:
        """A table, and where slopes of harmonics nu.g of m rows and others (k,) are in it, (m, k).

        many : columns a harmonic, so that the slopes of both signs are added before they are taken.
        """
        if many:
            (nu, at), (kappa, to) = _runs(nu), _runs(kappa)
        turned = nu[:, None] - kappa, nu[:, None] + kappa
        below, above = (self.grid.folded(x) for x in turned)
        if not many:
            return table, [below, above]
        added = table[below.ravel()] + table[above.ravel()]
        return added, [at[:, None] * len(kappa) + to]

    def _table(self, slopes: Floats) -> Floats:
        """Of the slopes by place, for what couples the columns."""
        return self.projection.coupling_table(self._spectrum(slopes))

    def diagonal(self, slopes: Floats, rows: Ints, columns: Ints) -> Floats:
        """The derivative of the force at chosen unknowns by themselves; (m,)."""
        there, nu = self.projection, self.harmonics[rows]
        table = self._table(slopes)
        places = [self.grid.entries(k * nu) for k in (0, 2)]
        found = there.between(table, places, columns, columns)
        half = np.where((nu == 0).all(axis=1), 0.5, 1.0)
        return np.asarray(half * there.scales(rows, columns) ** 2 * found)

    def _spectrum(self, slopes: Floats) -> Floats:
        """Coefficients of the slopes of all points, by place; shape (B, points)."""
        spectrum, step = np.empty_like(slopes), max(1, PORTION // self.grid.points)
        for j in range(0, len(slopes), step):
            spectrum[j : j + step] = self.grid.spectrum(slopes[j : j + step])
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
