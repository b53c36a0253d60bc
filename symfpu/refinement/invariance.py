"""The invariance equation of a torus in Fourier space: linear part exact, products pseudo-spectral.

Q_q(theta) = sum over nu of c_q[nu] cos(nu.theta) is a torus of the chain if for every mode and
harmonic ((nu.omega)^2 - Omega_q^2) c_q[nu] = N_q[nu], N the transform of V'(r) - r, which is
alpha r^2 + beta r^3 in an FPU chain, with the stretches r of the bonds on points of all angles.
Reflection of the chain shifts the angles by half turns: only c with q = nu.seeds (mod 2) are
unknowns (where V is even also nu of odd length), and half of the bonds are enough. All sums of
one kind run in one precision, doubles or the machine's long doubles.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.numbers.arithmetic import Arithmetic, mpf
from symfpu.refinement.couplings import (
    largest_slopes,
    shifted,
    sparse_rows,
    steps_by_slopes,
)
from symfpu.refinement.equation import Floats, Ints, Slopes
from symfpu.refinement.lattice import Lattice, halves_of_pairs, places_of

PORTION = 4_000_000  # values of all bonds transformed at once
LEAST_COUPLING = (
    1e-3  # of two modes by one harmonic of the slopes, relative, in sparse rows
)
APART = 1e-5  # of stretches, for a derivative by differences
DIGITS = 30  # of the numbers that long doubles are made of


def long(value: Any) -> np.longdouble:
    """A rational or an mpf as a long double."""
    with mpmath.workdps(DIGITS):
        exact = mpf(value)
        return np.longdouble(mpmath.nstr(exact, DIGITS))


class LongDoubles(Arithmetic):
    """Numbers as long doubles."""

    def number(self, value: Fraction) -> np.longdouble:
        return long(value)


LONG_DOUBLES = LongDoubles()


def rational(value: np.longdouble) -> Fraction:
    """A long double as the number it is."""
    high = float(value)
    low = float(value - np.longdouble(high))
    return Fraction(high) + Fraction(low)


def halves(value: Any) -> tuple[np.longdouble, np.longdouble]:
    """An mpf as the sum of two long doubles."""
    high = long(value)
    with mpmath.workdps(2 * DIGITS):
        return high, long(value - mpf(rational(high)))


def curvature(law: bonds.Law, r: Floats) -> Floats:
    """The third derivative of V by central differences of the second."""
    above, below = (bonds.anharmonic_stiffness(law, r + h) for h in (APART, -APART))
    return np.asarray((above - below) / (2 * APART))


class InvarianceEquation:
    """The equations of one torus: divisors and forces of coefficients, all (H, N-1).

    Coefficients are unknown where `mask` holds.
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
        self.mask = self.allowed(harmonics)
        self.seed_rows = places_of(np.eye(len(seeds), dtype=np.int64), harmonics)
        self.seed_columns = np.array(seeds) - 1
        with mpmath.workdps(2 * DIGITS):
            linear = [chain.linear_frequency(q) for q in range(1, chain.N)]
        self.linear = np.array([long(w) for w in linear])
        self._set_bonds()
        self._set_divisors(linear)

    def allowed(self, harmonics: Ints) -> NDArray[np.bool_]:
        """Where the selection rules let a mode carry a harmonic (H, s); shape (H, N-1)."""
        modes = np.arange(1, self.chain.N)
        of_harmonic = harmonics @ np.array(self.seeds) % 2
        parity = of_harmonic[:, None] == modes % 2
        if not self.chain.potential.even:
            return np.asarray(parity)
        odd = harmonics.sum(axis=1) % 2 == 1
        return np.asarray(parity & odd[:, None])

    def _set_bonds(self) -> None:
        """Stretches by a unit of each mode, and the way back from half of the bonds."""
        N, modes = self.chain.N, np.arange(1, self.chain.N)
        with mpmath.workdps(2 * DIGITS):
            exact = [mpmath.cospi(mpmath.mpf(k) / (2 * N)) for k in range(4 * N)]
            cosines = np.array([long(x) for x in exact])
            norm = long(mpmath.sqrt(mpmath.mpf(2) / N))
        angles = np.outer(modes, 2 * np.arange(N) + 1) % (4 * N)
        self._all_bonds = norm * self.linear[:, None] * cosines[angles]
        half = np.arange((N + 1) // 2)
        self._stretch = self._all_bonds[:, : len(half)]
        own_image = 2 * half + 1 == N
        self._back = self._stretch * np.where(own_image, 1, 2)
        self._law = self.chain.law(LONG_DOUBLES)

    def stretches_of_half(self) -> tuple[Floats, Floats]:
        """Stretches of half of the bonds by a unit of each mode, and the way back, in doubles.

        Both (N-1, bonds).
        """
        return self._stretch.astype(float), self._back.astype(float)

    def _set_divisors(self, linear: Sequence[Any]) -> None:
        """nu.Omega - Omega_q and nu.Omega + Omega_q from twice as many digits as they keep."""
        of_seeds = [linear[q - 1] for q in self.seeds]
        with mpmath.workdps(2 * DIGITS):
            exact = [mpmath.fdot(nu, of_seeds) for nu in self.harmonics.tolist()]
        high, low = (np.array(part) for part in zip(*map(halves, linear), strict=True))
        rates = zip(*map(halves, exact), strict=True)
        rate_high, rate_low = (np.array(part)[:, None] for part in rates)
        self._below = (rate_high - high) + (rate_low - low)
        self._above = (rate_high + high) + (rate_low + low)

    def divisors(self, shifts: Floats) -> Floats:
        """(nu.omega)^2 - Omega_q^2 for omega = Omega + shifts of the seeds; shape (H, N-1).

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
        return np.asarray(self.linear[self.seed_columns])

    def rates(self, shifts: Floats) -> Floats:
        """nu.omega in long doubles; shape (H,)."""
        omega = self.seed_frequencies + shifts
        return np.asarray(self.harmonics @ omega)

    def _portions(self, grid: Lattice) -> list[slice]:
        """Bonds whose values on the points of a lattice fit into a portion."""
        step = max(1, PORTION // grid.points)
        count = self._stretch.shape[1]
        return [slice(j, j + step) for j in range(0, count, step)]

    def force(self, cosines: Floats) -> Floats:
        """N_q[nu] of coefficients (H, N-1), in their precision.

        Zero where the mask does not hold.
        """
        return np.asarray(self._force(self.grid, cosines) * self.mask)

    def force_on(self, grid: Lattice, cosines: Floats) -> Floats:
        """The same of coefficients at the harmonics of another lattice, (M, N-1), at all of it."""
        return np.asarray(self._force(grid, cosines) * self.allowed(grid.harmonics))

    def _force(self, grid: Lattice, cosines: Floats) -> Floats:
        kind = cosines.dtype
        law = bonds.cast(self._law, kind)
        total = np.zeros(cosines.shape, dtype=kind)
        for part in self._portions(grid):
            there = self._stretch[:, part].astype(kind)
            back = self._back[:, part].T.astype(kind)
            r = grid.values(cosines @ there)
            tension = bonds.anharmonic_tension(law, r)
            total += grid.coefficients(tension) @ back
        return total

    def force_at(self, cosines: Floats, harmonics: Ints) -> Floats:
        """The same at other harmonics (M, s) that the lattice tells apart; shape (M, N-1)."""
        total = np.zeros((len(harmonics), cosines.shape[1]), dtype=np.longdouble)
        for part in self._portions(self.grid):
            r = self.grid.values(cosines @ self._stretch[:, part])
            tension = bonds.anharmonic_tension(self._law, r)
            total += self.grid.coefficients_at(tension, harmonics) @ self._back[:, part].T
        return np.asarray(total * self.allowed(harmonics))

    def linear_at(self, harmonics: Ints) -> Floats:
        """Omega of all modes, (N-1,): the same at every harmonic."""
        return self.linear

    def rounding(self, cosines: Floats, kind: type) -> Floats:
        """What rounding in numbers of a kind makes of the force of each mode, about; (N-1,).

        Every bond rounds at random at every point, and a force is a sum over bonds and points.
        """
        law, (stretch, back) = self.chain.law(), self.stretches_of_half()
        c, tension = cosines.astype(float), np.zeros(stretch.shape[1])
        for part in self._portions(self.grid):
            r = self.grid.values(c @ stretch[:, part])
            tension[part] = np.mean(bonds.anharmonic_tension(law, r) ** 2, axis=1)
        sizes = np.sqrt(back**2 @ tension)
        return np.asarray(np.finfo(kind).eps * self.grid.averaged_rounding * sizes)

    def potential(self, Q: Floats) -> np.longdouble:
        """The potential energy of mode coordinates (N-1,), by all bonds."""
        each = bonds.potential(self._law, Q @ self._all_bonds)
        return np.longdouble(each.sum())

    def potential_slope(self, Q: Floats) -> Floats:
        """Its gradient; shape (N-1,)."""
        tension = bonds.tension(self._law, Q @ self._all_bonds)
        return np.asarray(self._all_bonds @ tension)

    def energy(
        self, cosines: Floats, shifts: Floats, *, harmonic: bool
    ) -> tuple[np.longdouble, Slopes]:
        """H, or the harmonic energy, at the angles zero, where the momenta vanish."""
        Q = cosines.sum(axis=0)
        if harmonic:
            energy, slope = (self.linear**2 * Q**2).sum() / 2, self.linear**2 * Q
        else:
            energy, slope = self.potential(Q), self.potential_slope(Q)
        by_cosine = np.broadcast_to(slope, cosines.shape) * self.mask
        return np.longdouble(energy), (by_cosine, np.zeros(len(shifts)))

    def seed_energy(
        self, place: int, cosines: Floats, shifts: Floats
    ) -> tuple[np.longdouble, Slopes]:
        """E_q of a seed averaged over the angles."""
        column = self.seed_columns[place]
        c, rates = cosines[:, column], self.rates(shifts)
        weights = np.where((self.harmonics != 0).any(axis=1), 0.25, 0.5)
        sizes = weights * (rates**2 + self.linear[column] ** 2)
        by_cosine = np.zeros(cosines.shape, dtype=cosines.dtype)
        by_cosine[:, column] = 2 * sizes * c
        by_shift = (2 * weights * rates * c**2) @ self.harmonics
        return np.longdouble((sizes * c**2).sum()), (by_cosine, by_shift)

    def slopes(self, cosines: Floats) -> Floats:
        """V''(r) - 1 on the lattice, in doubles; shape (bonds, points)."""
        law, (stretch, _) = self.chain.law(), self.stretches_of_half()
        c, result = cosines.astype(float), np.empty((stretch.shape[1], self.grid.points))
        for part in self._portions(self.grid):
            r = self.grid.values(c @ stretch[:, part])
            result[part] = bonds.anharmonic_stiffness(law, r)
        return result

    def steps(self, slopes: Floats, most: int) -> Ints:
        """The largest harmonics of the slopes, so many at most, with both signs; (k, s)."""
        return steps_by_slopes(self.grid, self._spectrum(slopes), most)

    def slope_changes(self, cosines: Floats, weights: Floats) -> Floats:
        """Derivatives of the mean of weights times slopes, (H, N-1); weights (bonds, points)."""
        there = self._stretch.astype(float)
        r = self.grid.values(np.asarray(cosines.astype(float) @ there))
        bent = weights * curvature(self.chain.law(), r)
        spectrum = self.grid.spectrum(bent)[:, self.grid.entries(self.harmonics)]
        return np.asarray((spectrum.T @ there.T) * self.mask)

    def force_change(self, slopes: Floats, change: Floats) -> Floats:
        """The derivative of the force along a change of the coefficients, in doubles.

        Shapes (H, N-1).
        """
        total = np.zeros(change.shape)
        for part in self._portions(self.grid):
            there = self._stretch[:, part].astype(float)
            back = self._back[:, part].T.astype(float)
            d = self.grid.values(change @ there)
            total += self.grid.coefficients(slopes[part] * d) @ back
        return np.asarray(total * self.mask)

    def block(self, slopes: Floats, rows: Ints, columns: Ints) -> Floats:
        """The derivative of the force between chosen unknowns; shape (m, m).

        rows, columns : of harmonic and mode. Of a unit of cos(nu'.theta) the coefficient at nu is
        slope[nu - nu'] + slope[nu + nu'], half of it for nu = 0; of the modes q and q' a slope of
        the bonds makes Omega_q Omega_q' times what it has of the modes |q - q'| and q + q'.
        """
        N, modes = self.chain.N, columns + 1
        table = self._spectrum(slopes).T @ self._products_of_modes()
        flat, width = table.ravel(), table.shape[1]
        nu, linear = self.harmonics[rows], self.linear[columns].astype(float)
        along = nu @ self.grid.generator
        matrix = np.empty((len(rows), len(rows)))
        for a, mode in enumerate(modes):
            apart, total = np.abs(mode - modes[a:]), mode + modes[a:]
            nearer = np.minimum(total, 2 * N - total)
            sign = np.where(total > N, -1.0, 1.0)
            found = np.zeros(len(rows) - a)
            for turned in (-along[a:], along[a:]):
                place = self.grid.folded(along[a] + turned) * width
                found += flat[place + apart] + sign * flat[place + nearer]
            matrix[a, a:] = linear[a] * linear[a:] * found
            matrix[a:, a] = matrix[a, a:]
        matrix[(nu == 0).all(axis=1)] /= 2
        return matrix

    def _products_of_modes(self) -> Floats:
        """cos(pi m (j + 1/2)/N) / N of half of the bonds with their images; (bonds, N + 1)."""
        N, bonds_of_half = self.chain.N, np.arange(self._stretch.shape[1])
        images = np.where(2 * bonds_of_half + 1 == N, 1, 2)
        angles = np.outer(2 * bonds_of_half + 1, np.arange(N + 1)) % (4 * N)
        cosines = np.cos(np.pi / (2 * N) * angles)
        return np.asarray(cosines * images[:, None] / N)

    def _between_modes(self, row: Floats) -> Floats:
        """A slope of the bonds between all modes, (N-1, N-1), by what it has of the modes 0 .. N.

        Windows of rows of numbers: of |q - q'|, and of q + q' beyond N, where the sign turns.
        """
        count, linear = self.chain.N - 1, self.linear.astype(float)
        apart = np.concatenate([row[count - 1 : 0 : -1], row[:count]])
        total = np.concatenate([row[2:], -row[count:1:-1]])
        both = sliding_window_view(apart, count)[::-1] + sliding_window_view(total, count)
        both *= linear
        both *= linear[:, None]
        return np.asarray(both)

    def _spectrum(self, slopes: Floats) -> Floats:
        """Coefficients of the slopes of all bonds, by place; shape (bonds, points)."""
        spectrum = np.empty_like(slopes)
        for part in self._portions(self.grid):
            spectrum[part] = self.grid.spectrum(slopes[part])
        return spectrum

    def sparse_rows(self, slopes: Floats, rows: Ints, columns: Ints) -> Any:
        """The derivative of the force on chosen unknowns, by the largest harmonics of the slopes.

        rows, columns : of harmonic and mode. A sparse matrix (m, unknowns), those in the order of
        the mask.
        """
        spectrum = self._spectrum(slopes)
        kappas = largest_slopes(self.grid, spectrum)
        products = self._products_of_modes()
        weights = halves_of_pairs(self.harmonics)

        def coupled(kappa: Ints) -> tuple[Floats, Ints, Ints]:
            slope = spectrum[:, self.grid.entries(kappa)]
            coupling = self._between_modes(slope @ products)
            sizes = np.abs(coupling)
            coupling[sizes <= LEAST_COUPLING * sizes.max()] = 0
            at, to = shifted(self.harmonics, rows, kappa)
            weight = weights[to] / weights[rows[at]]
            return weight[:, None] * coupling[columns[at]], at, to

        return sparse_rows(self.mask, kappas, coupled, len(rows))
