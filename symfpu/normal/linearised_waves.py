"""The equations of motion of a ring linearised about travelling waves: one sector for each wave.

To go on by one site while theta_i goes on by 2 pi q_i/N leaves a torus of travelling waves as it
is. So a solution keeps its own wave k, beside the harmonics of the torus: with m = k + nu.q,

    x_j = N^(-1/2) exp(i sigma t) sum over nu of p[nu] exp(i nu.theta - 2 pi i m j/N),

    (lambda_m^2 - (sigma + nu.omega)^2) p[nu] + lambda_m sum S[nu - nu'] lambda_m' p[nu'] = 0

with lambda_m = 2 sin(pi m/N) and S the function of the angles, even in them, that V''(r) - 1 is on
every bond in turn. One unknown a harmonic, real and symmetric. The wave m = 0 has lambda = 0: the
whole ring in uniform motion, which nothing couples to; it is left out. Ours.
"""

from __future__ import annotations

from copy import copy
from functools import cached_property

import mpmath
import numpy as np

from symfpu.normal.linearised import Linearised, Mask, Values, of_both_signs
from symfpu.refinement.equation import Floats, Ints
from symfpu.refinement.invariance import DIGITS, long
from symfpu.refinement.tori import shifts_of
from symfpu.refinement.waves import WaveEquation
from symfpu.tori.ring_torus import RingTorus
from symfpu.tori.travelling import wave_coefficients

LARGEST = 2.0  # of |lambda|


class LinearisedWaves(Linearised):
    """K and the frequencies of travelling waves, for the solutions of one wave k.

    Coefficients have one column: a harmonic lives in one wave. `of(k)` chooses another k.
    """

    def __init__(self, torus: RingTorus, harmonics: Ints) -> None:
        self.chain, self.seeds = torus.chain, torus.seeds
        equation = WaveEquation(torus.chain, torus.seeds, harmonics)
        self.equation, self._grid = equation, equation.grid
        self.harmonics = of_both_signs(harmonics)
        self.rates = self.harmonics @ (equation.seed_frequencies + shifts_of(torus))
        self.slopes = equation.slopes(_coefficients(torus, harmonics))
        self._place = self.harmonics @ self._grid.generator % self._grid.period
        self._choose(0)

    def _choose(self, k: int) -> None:
        N = self.chain.N
        self.waves = k + self.harmonics @ np.array(self.seeds)
        with mpmath.workdps(2 * DIGITS):
            sizes = [long(self.chain.linear_frequency(m)) for m in range(N)]
        self.linear = np.array(sizes)[self.waves % N][:, None]
        signs = np.where(self.waves // N % 2 == 0, 1, -1)
        self._stretch = signs * self.linear[:, 0].astype(float)

    def of(self, q: int) -> LinearisedWaves:
        found = copy(self)
        found._choose(q)
        for name in ("means", "_columns"):
            found.__dict__.pop(name, None)
        return found

    def column(self, q: int) -> int:
        return 0

    def frequency(self, q: int) -> float:
        return float(self.chain.linear_frequency(q % self.chain.N))

    def mode_at(self, row: int, column: int) -> int:
        return int(self.chain.mode_numbers[self._columns[row]])

    def allowed(self, q: int) -> Mask:
        mask = self.waves % self.chain.N != 0
        if self.chain.potential.even:
            mask &= self.harmonics.sum(axis=1) % 2 == 0
        return np.asarray(mask[:, None])

    @cached_property
    def _columns(self) -> Ints:
        """Place of the mode of every harmonic among the modes of the ring; -1 for m = 0."""
        place = np.full(self.chain.N, -1)
        numbers = np.array(self.chain.mode_numbers)
        place[numbers % self.chain.N] = np.arange(len(numbers))
        return np.asarray(place[self.waves % self.chain.N])

    def by_mode(self, p: Values) -> Values:
        every = np.zeros((len(p), self.chain.N - 1), dtype=p.dtype)
        moving = np.flatnonzero(self._columns >= 0)
        every[moving, self._columns[moving]] = p[moving, 0]
        return every

    def table(self, p: Values) -> Values:
        return np.asarray(p.sum(axis=1, keepdims=True))

    def _stretched(self, p: Floats) -> Floats:
        return np.asarray((p[:, 0] * self._stretch)[None, :])

    def _images(self) -> Floats:
        return np.ones((1, 1))

    def _driven(self, sums: Floats) -> Floats:
        return np.asarray((sums[0] * self._stretch)[:, None])

    def _norm(self, sums: Floats) -> float:
        return LARGEST * float(np.linalg.norm(sums))

    @cached_property
    def means(self) -> Floats:  # type: ignore[override]
        """The diagonal of K; shape (F, 1)."""
        return np.asarray((self._stretch**2 * self._spectrum[0, 0])[:, None])

    def block(self, rows: Ints, columns: Ints) -> Floats:
        along, there = self._place[rows], self._stretch[rows]
        slopes = self._spectrum[:, 0]
        matrix = np.empty((len(rows), len(rows)))
        for a in range(len(rows)):
            slope = slopes[self._grid.folded(along[a] - along)]
            matrix[a] = there[a] * slope * there
        return matrix


def _coefficients(torus: RingTorus, harmonics: Ints) -> Floats:
    """Those of `WaveEquation` at chosen harmonics, 0 where the torus has none; shape (H, 1)."""
    rows = wave_rows(torus)
    nothing = np.zeros(1)
    return np.array([rows.get(tuple(nu), nothing) for nu in harmonics.tolist()])


def wave_rows(torus: RingTorus) -> dict[tuple[int, ...], Floats]:
    """The coefficients of a torus by harmonic, as `wave_coefficients` has them."""
    harmonics, cosines = wave_coefficients(torus)
    return dict(zip(map(tuple, harmonics.tolist()), cosines, strict=True))
