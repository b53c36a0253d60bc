"""The equations of motion linearised about a torus, in harmonics of its angles.

A solution exp(i sigma t) p(theta) with p_q(theta) = sum over nu of p_q[nu] exp(i nu.theta) has

    (Omega_q^2 - (sigma + nu.omega)^2) p_q[nu] + (K p)_q[nu] = 0,

K the products with V''(r) - 1 on the bonds: L(sigma) p = 0. The torus is even in its angles, so
that K is real and symmetric, and so are the coefficients p for real sigma. Reflection of the
chain splits the unknowns as it does those of the torus, and where V is even only nu of even
length occur.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from copy import copy
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.refinement.equation import Floats, Ints, TorusEquation
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import WORKERS, Lattice
from symfpu.refinement.tori import shifts_of
from symfpu.tori.quasiperiodic import QuasiPeriodic

Values = NDArray[Any]  # doubles or complex doubles
Mask = NDArray[np.bool_]


class Linearised(ABC):
    """K and the frequencies of one torus, whatever the ends: coefficients are tables (F, C).

    harmonics : those chosen and their negatives, shape (F, s), the first one 0.
    rates : nu.omega in long doubles, shape (F,). linear : Omega of the unknowns in long doubles,
    (C,) or (F, C). slopes : V'' - 1 at the points, (bonds, points).
    """

    chain: Chain
    seeds: tuple[int, ...]
    harmonics: Ints
    rates: Floats
    linear: Floats
    slopes: Floats
    means: Floats  # the diagonal of K, (C,) or (F, C)
    equation: TorusEquation  # of the torus, at the harmonics chosen
    _grid: Lattice
    _place: Ints

    def scaled(self, factor: float) -> Self:
        """With K times a factor: what a solution is continued in, from 0 to 1."""
        result = copy(self)
        result.slopes = factor * self.slopes
        for name in ("_spectrum", "means"):
            result.__dict__.pop(name, None)
        return result

    def moved(self, coefficients: Floats, shifts: Floats) -> Self:
        """About another torus nearby, by its coefficients at the harmonics chosen and shifts."""
        result = copy(self)
        result.rates = self.harmonics @ (self.equation.seed_frequencies + shifts)
        result.slopes = self.equation.slopes(coefficients)
        for name in ("_spectrum", "means"):
            result.__dict__.pop(name, None)
        return result

    @abstractmethod
    def of(self, q: int) -> Self:
        """With the unknowns of the mode q."""

    @abstractmethod
    def column(self, q: int) -> int:
        """Where the mode q without any angle is, in the first row."""

    @abstractmethod
    def frequency(self, q: int) -> float:
        """Omega_q."""

    @abstractmethod
    def mode_at(self, row: int, column: int) -> int:
        """The mode of an unknown."""

    @abstractmethod
    def allowed(self, q: int) -> Mask:
        """The unknowns of the normal mode that starts in the mode q; shape (F, C)."""

    @abstractmethod
    def by_mode(self, p: Values) -> Values:
        """Coefficients of all modes, (F, N-1), of a table."""

    @abstractmethod
    def table(self, p: Values) -> Values:
        """The table of coefficients of all modes, (F, N-1)."""

    @abstractmethod
    def block(self, rows: Ints, columns: Ints) -> Floats:
        """K between chosen unknowns, given by harmonic and column; shape (m, m)."""

    @abstractmethod
    def _stretched(self, p: Floats) -> Floats:
        """What a table stretches, by bond and harmonic; shape (bonds, F)."""

    @abstractmethod
    def _images(self) -> Floats:
        """How many bonds each of those held stands for; shape (bonds, 1)."""

    @abstractmethod
    def _driven(self, sums: Floats) -> Floats:
        """What tensions (bonds, F) drive, as a table."""

    @abstractmethod
    def _norm(self, sums: Floats) -> float:
        """Of what tensions of all places of the lattice drive, (bonds, M), at most."""

    def coupling(self, p: Values) -> Values:
        """K p of a table, real or complex."""
        if np.iscomplexobj(p):
            return self.coupling(p.real) + 1j * self.coupling(p.imag)
        return self._driven(self._products(p)[:, self._place])

    def squares(self, p: Floats) -> Floats:
        """What slopes are multiplied by to make p^T K p, in the mean; (bonds, points)."""
        return np.asarray(self._images() * np.abs(self._values(p)) ** 2)

    def left_out(self, p: Values) -> float:
        """The norm of K p at all harmonics of the lattice that are not chosen."""
        if np.iscomplexobj(p):
            return float(np.hypot(self.left_out(p.real), self.left_out(p.imag)))
        sums = self._products(p)
        sums[:, self._place] = 0
        return self._norm(sums)

    def _products(self, p: Floats) -> Floats:
        """Of slopes and stretches by the bond, as coefficients by place; shape (bonds, M).

        With real coefficients the values at opposite angles are conjugate: half are enough.
        """
        from scipy import fft

        values = self._values(p)
        values *= self.slopes
        sums = fft.irfft(values, n=self._grid.period, workers=WORKERS, overwrite_x=True)
        return np.asarray(sums)

    def _values(self, p: Floats) -> Values:
        """Stretches at half of the points; shape (bonds, points)."""
        from scipy import fft

        stretched = self._stretched(p)
        spectrum = np.zeros((len(stretched), self._grid.period))
        spectrum[:, self._place] = stretched
        return np.asarray(fft.rfft(spectrum, workers=WORKERS))

    @cached_property
    def _spectrum(self) -> Floats:
        """Coefficients of exp(i nu.theta) in the slopes, by place; shape (points, bonds)."""
        return np.ascontiguousarray(self._grid.spectrum(self.slopes).T)

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


class LinearisedFlow(Linearised):
    """K and the frequencies of one torus of fixed ends, for all of its normal modes.

    Coefficients have a column for every mode.
    """

    def __init__(self, torus: QuasiPeriodic, harmonics: Ints) -> None:
        self.chain, self.seeds = torus.chain, torus.seeds
        equation = InvarianceEquation(torus.chain, torus.seeds, harmonics)
        self.equation, self._grid = equation, equation.grid
        self.harmonics = of_both_signs(harmonics)
        self.linear = equation.linear
        self.rates = self.harmonics @ (equation.seed_frequencies + shifts_of(torus))
        self._stretch, self._back = equation.stretches_of_half()
        self.slopes = equation.slopes(_coefficients(torus, harmonics))
        self._place = self.harmonics @ self._grid.generator % self._grid.period

    def of(self, q: int) -> LinearisedFlow:
        return self

    def column(self, q: int) -> int:
        return q - 1

    def mode_at(self, row: int, column: int) -> int:
        return column + 1

    def frequency(self, q: int) -> float:
        return float(self.linear[q - 1])

    def by_mode(self, p: Values) -> Values:
        return p

    def table(self, p: Values) -> Values:
        return p

    def allowed(self, q: int) -> Mask:
        return self.allowed_at(q, self.harmonics)

    def allowed_at(self, q: int, harmonics: Ints) -> Mask:
        """Where the selection rules let it have other harmonics (M, s); shape (M, N-1)."""
        modes = np.arange(1, self.chain.N)
        parity = (harmonics @ np.array(self.seeds) + q) % 2
        mask = parity[:, None] == modes % 2
        if self.chain.potential.even:
            even = harmonics.sum(axis=1) % 2 == 0
            mask &= even[:, None]
        return np.asarray(mask)

    def _stretched(self, p: Floats) -> Floats:
        return np.asarray((p @ self._stretch).T)

    def _images(self) -> Floats:
        bonds = np.arange((self.chain.N + 1) // 2)
        return np.where(2 * bonds + 1 == self.chain.N, 1.0, 2.0)[:, None]

    def _driven(self, sums: Floats) -> Floats:
        return np.asarray(sums.T @ self._back.T)

    def _norm(self, sums: Floats) -> float:
        return float(np.linalg.norm(self._back @ sums))

    @cached_property
    def means(self) -> Floats:  # type: ignore[override]
        """The diagonal of K, by mode; shape (N-1,)."""
        return np.asarray((self._stretch * self._back) @ self._spectrum[0])

    def block(self, rows: Ints, columns: Ints) -> Floats:
        along = self._place[rows]
        there, back = self._stretch[columns], self._back[columns]
        matrix = np.empty((len(rows), len(rows)))
        for a in range(len(rows)):
            slope = self._spectrum[self._grid.folded(along[a] - along)]
            matrix[a] = (slope * there) @ back[a]
        return matrix


def _coefficients(torus: QuasiPeriodic, harmonics: Ints) -> Floats:
    """Those of the torus at chosen harmonics, 0 where it has none; shape (H, N-1)."""
    nothing = np.zeros(torus.chain.N - 1)
    rows = coefficients_by_harmonic(torus)
    return np.array([rows.get(tuple(nu), nothing) for nu in harmonics.tolist()])


def coefficients_by_harmonic(torus: QuasiPeriodic) -> dict[tuple[int, ...], Floats]:
    """The rows of a torus, the first number of every harmonic that is not 0 positive."""
    rows: dict[tuple[int, ...], Floats] = {}
    cosines = torus.cosines.astype(float)
    for nu, row in zip(torus.harmonics.tolist(), cosines, strict=True):
        sign = -1 if next((n for n in nu if n), 1) < 0 else 1
        rows[tuple(sign * n for n in nu)] = row
    return rows
