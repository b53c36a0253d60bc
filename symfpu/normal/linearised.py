"""The equations of motion linearised about a torus, in harmonics of its angles.

A solution exp(i sigma t) p(theta) with p(theta) = sum over nu of p[nu] exp(i nu.theta) has

    (Omega^2 - (sigma + nu.omega)^2) p[nu] + (K p)[nu] = 0,

K the products with V''(r) - 1 on the bonds: L(sigma) p = 0. The torus is even in its angles, so
that K is real and symmetric, and so are the coefficients p for real sigma. What the columns of p
are is said by the projection of the chain: all modes of fixed ends, the one wave of each harmonic
beside travelling waves, sines or cosines about standing ones.
"""

from __future__ import annotations

from copy import copy
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.projections.projection import Mask, Projection, linear_halves
from symfpu.chain.projections.standing import SineProjection
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.invariance import ROWS, InvarianceEquation
from symfpu.refinement.lattice import WORKERS, Floats, Ints, canonical_signs
from symfpu.tori.torus import Torus
from symfpu.tori.unfolding import folded

Values = NDArray[Any]  # doubles or complex doubles


class Linearised:
    """K and the frequencies of one torus: coefficients are tables (F, C).

    equation : of the torus, at the harmonics chosen. harmonics : those and their negatives, shape
    (F, s), the first one 0. projection : of deviations, at all of them. linear : Omega of the
    unknowns in long doubles, (F | 1, C). rates : nu.omega in long doubles, shape (F,). slopes :
    V'' - 1 at the points, (B, points).
    """

    def __init__(self, torus: Torus, harmonics: Ints) -> None:
        both = of_both_signs(harmonics)
        if torus.stands:
            half = folded(torus)
            self.equation = InvarianceEquation(half.chain, half.seeds, harmonics)
            self.projection: Projection = SineProjection(
                torus.chain, half.chain, half.seeds, both
            )
        else:
            self.equation = InvarianceEquation(torus.chain, torus.seeds, harmonics)
            self.projection = self.equation.projection.at(both).deviating(0)
        self.chain, self.seeds = self.equation.chain, self.equation.seeds
        self.harmonics, self._grid = both, self.equation.grid
        self._place = both @ self._grid.generator % self._grid.period
        rows = coefficients_by_harmonic(torus)
        nothing = np.zeros(self.equation.projection.columns)
        coefficients = [rows.get(tuple(nu), nothing) for nu in harmonics.tolist()]
        self._take(np.array(coefficients), shifts_of(torus))

    def _take(self, coefficients: Floats, shifts: Floats) -> None:
        self.rates = self.harmonics @ (self.equation.seed_frequencies + shifts)
        self.slopes = self.equation.slopes(coefficients)

    def _copied(self) -> Self:
        found = copy(self)
        for name in ("_spectrum", "_couplings", "means"):
            found.__dict__.pop(name, None)
        return found

    def scaled(self, factor: float) -> Self:
        """With K times a factor: what a solution is continued in, from 0 to 1."""
        found = self._copied()
        found.slopes = factor * self.slopes
        return found

    def moved(self, coefficients: Floats, shifts: Floats) -> Self:
        """About another torus nearby, by its coefficients at the harmonics chosen and shifts."""
        found = self._copied()
        found._take(coefficients, shifts)
        return found

    def of(self, q: int) -> Self:
        """With the unknowns of the mode q."""
        projection = self.projection.deviating(q)
        if projection is self.projection:
            return self
        found = self._copied()
        found.projection = projection
        return found

    @property
    def linear(self) -> Floats:
        return self.projection.omega

    def column(self, q: int) -> int:
        """Where the mode q without any angle is, in the first row."""
        return self.projection.column(q)

    def frequency(self, q: int) -> float:
        """Omega_q."""
        linear, _ = linear_halves(self.chain)
        return float(linear[abs(q)])

    def mode_at(self, row: int, column: int) -> int:
        """The mode of an unknown."""
        shape = len(self.harmonics), self.projection.columns
        modes = np.broadcast_to(self.projection.modes, shape)
        return int(modes[row, column])

    def allowed(self, q: int) -> Mask:
        """The unknowns of the normal mode that starts in the mode q; shape (F, C)."""
        return self.projection.mask_of_deviation(q)

    def allowed_at(self, q: int, harmonics: Ints) -> Mask:
        """Where the selection rules let it have other harmonics (M, s); shape (M, C)."""
        return self.projection.at(harmonics).mask_of_deviation(q)

    def by_mode(self, p: Values) -> Values:
        """Coefficients of all modes, (F, N-1), of a table."""
        return self.projection.by_mode(p)

    def table(self, p: Values) -> Values:
        """The table of coefficients of all modes, (F, N-1)."""
        return self.projection.from_modes(p)

    @cached_property
    def means(self) -> Floats:
        """The diagonal of K, (F | 1, C)."""
        return self.projection.diagonal(self._spectrum[:, 0])

    def block(self, rows: Ints, columns: Ints) -> Floats:
        """K between chosen unknowns, given by harmonic and column; shape (m, m)."""
        along, scale = self._place[rows], self.projection.scales(rows, columns)
        matrix = np.empty((len(rows), len(rows)))
        for first in range(0, len(rows), ROWS):
            own, rest = slice(first, first + ROWS), slice(first, None)
            places = [self._grid.folded(along[own, None] - along[rest])]
            others = columns[own, None], columns[rest]
            found = self.projection.between(self._couplings, places, *others)
            matrix[own, rest] = scale[own, None] * scale[rest] * found
            matrix[rest, own] = matrix[own, rest].T
        return matrix

    def coupling(self, p: Values) -> Values:
        """K p of a table, real or complex."""
        if np.iscomplexobj(p):
            return self.coupling(p.real) + 1j * self.coupling(p.imag)
        sums = self._products(p)[:, self._place]
        return self.projection.from_points(sums.T)

    def squares(self, p: Floats) -> Floats:
        """What slopes are multiplied by to make p^T K p, in the mean; (B, points)."""
        return np.asarray(self.projection.images[:, None] * np.abs(self._values(p)) ** 2)

    def left_out(self, p: Values) -> float:
        """The norm of K p at all harmonics of the lattice that are not chosen, at most."""
        if np.iscomplexobj(p):
            return float(np.hypot(self.left_out(p.real), self.left_out(p.imag)))
        sums = self._products(p)
        sums[:, self._place] = 0
        return self.projection.largest_norm(sums)

    def _products(self, p: Floats) -> Floats:
        """Of slopes and stretches by the point, as coefficients by place; shape (B, M).

        With real coefficients the values at opposite angles are conjugate: half are enough.
        """
        from scipy import fft

        values = self._values(p)
        values *= self.slopes
        sums = fft.irfft(values, n=self._grid.period, workers=WORKERS, overwrite_x=True)
        return np.asarray(sums)

    def _values(self, p: Floats) -> Values:
        """Stretches at half of the points; shape (B, points)."""
        from scipy import fft

        stretched = self.projection.to_points(p).T
        spectrum = np.zeros((len(stretched), self._grid.period))
        spectrum[:, self._place] = stretched
        return np.asarray(fft.rfft(spectrum, workers=WORKERS))

    @cached_property
    def _spectrum(self) -> Floats:
        """Coefficients of exp(i nu.theta) in the slopes, by place; shape (B, points)."""
        return self._grid.spectrum(self.slopes)

    @cached_property
    def _couplings(self) -> Floats:
        return self.projection.coupling_table(self._spectrum)

    def divisors(self, sigma: complex) -> Values:
        """Omega_q^2 - (sigma + nu.omega)^2 in doubles, from long doubles; shape (F, C)."""
        unreal = isinstance(sigma, complex)
        value: Any = sigma
        long: Any = np.clongdouble(value) if unreal else np.longdouble(value)
        rate = (long + self.rates)[:, None]
        exact = (self.linear - rate) * (self.linear + rate)
        return np.asarray(exact.astype(complex if unreal else float))


def of_both_signs(harmonics: Ints) -> Ints:
    """0, those that are not, and their negatives; shape (F, s)."""
    moving = harmonics[(harmonics != 0).any(axis=1)]
    still = np.zeros((1, harmonics.shape[1]), dtype=np.int64)
    return np.concatenate([still, moving, -moving])


def coefficients_by_harmonic(
    torus: Torus,
) -> dict[tuple[int, ...], Floats]:
    """The rows (C,) of a torus, the first number of every harmonic that is not 0 positive."""
    signed = canonical_signs(np.asarray(torus.harmonics))
    return dict(zip(map(tuple, signed.tolist()), torus.cosines.astype(float), strict=True))
