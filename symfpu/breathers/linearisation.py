"""The second variation of the action at an orbit, with the action's gradient as a border, factored.

The equations of harmonic balance are symmetric once the mean counts twice: M = W J. Bordered by the
gradient of the action the matrix is K = [[M, g], [g^T, 0]]. A small one is factored whole. Of a
large one only the coefficients near a resonance are: those whose divisor n^2 omega^2 - Omega_q^2 is
at most NEAR_RESONANCE times what the bonds' slopes can be of Omega_q^2. The others are eliminated
with their diagonal, which is nearly all of their block, since that factor bounds what the diagonal
leaves of it. Solutions are then corrected by residuals of the whole matrix, whose products take a
synthesis and an analysis of one orbit.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.equations import LARGEST_SYSTEM, Balance

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
WHOLE = 1500  # unknowns, up to which the matrix is factored whole
NEAR_RESONANCE = 5.0
MOST_NEAR = (
    0.5  # of the unknowns near a resonance: with more, the whole matrix costs no more
)
MOST_UNKNOWNS = 40_000
MOST_CORRECTIONS = 40
SHRINKS = 0.5  # a correction leaves less of the residual than this


class Factors:
    """A symmetric matrix by blocks of one and two on a diagonal (Bunch and Kaufman).

    negative : its negative eigenvalues.
    """

    def __init__(self, matrix: Floats) -> None:
        from scipy.linalg import lapack

        work, _ = lapack.dsytrf_lwork(len(matrix), lower=1)
        self._factors, self._pivots, info = lapack.dsytrf(
            matrix, lower=1, lwork=int(work), overwrite_a=1
        )
        if info > 0:
            raise np.linalg.LinAlgError("the tangent is not determined")
        self.negative = self._negative()

    def solve(self, right: Floats) -> Floats:
        """The solution for one right-hand side or several, in columns."""
        from scipy.linalg import lapack

        solution, _ = lapack.dsytrs(self._factors, self._pivots, right, lower=1)
        return np.asarray(solution)

    def _negative(self) -> int:
        """By the signs of the blocks on the diagonal (Sylvester)."""
        diagonal = self._factors.diagonal()
        single = self._pivots > 0
        firsts = np.flatnonzero(~single)[::2]
        a, c = diagonal[firsts], diagonal[firsts + 1]
        beside = self._factors[firsts + 1, firsts]
        of_pairs = np.where(a * c < beside**2, 1, np.where(a < 0, 2, 0))
        return int((diagonal[single] < 0).sum() + of_pairs.sum())


class SecondVariation:
    """K with the coefficients near a resonance factored, the others eliminated by their diagonal.

    near : which they are, or all of a small matrix. index : the negative eigenvalues of K, by
    Haynsworth's rule: those of the eliminated diagonal and of what is left (the Schur complement),
    which is off by 1 / NEAR_RESONANCE^2 of the slopes at most.
    """

    def __init__(self, balance: Balance, slopes: Floats, z: Floats, near: Mask) -> None:
        self.balance, self.z, self._slopes = balance, z, slopes
        self._gradient = balance.gradient(z)
        self._near, self._far = np.flatnonzero(near), np.flatnonzero(~near)
        self._diagonal = np.zeros(0)
        if len(self._far):
            own = balance.weights * balance.own_divisors(slopes, z)
            self._diagonal = own[self._far]
        self._kept = np.append(self._near, len(z) - 1)
        self._factors = Factors(self._complement())
        self.index = self._factors.negative + int((self._diagonal < 0).sum())

    def _complement(self) -> Floats:
        """What elimination leaves of K, below its diagonal; the border is among what is kept."""
        from scipy.linalg import blas

        balance, near = self.balance, self._near
        n, q, last = balance.n, balance.q, len(near)
        kept = np.zeros((last + 1, last + 1), order="F")
        own = balance.equation.block(self._slopes, n[near], q[near])
        np.multiply(own, -balance.weights[near, None], out=kept[:last, :last])
        divisors = balance.weights * balance.divisors(self.z)
        kept[np.arange(last), np.arange(last)] += divisors[near]
        kept[last, :last] = self._gradient[near]
        for sign in np.unique(np.sign(self._diagonal)):
            chosen = self._diagonal * sign > 0
            far, roots = self._far[chosen], np.sqrt(np.abs(self._diagonal[chosen]))
            beside = np.empty((len(far), last + 1))
            coupling = balance.equation.block(
                self._slopes, n[far], q[far], (n[near], q[near])
            )
            scale = -balance.weights[far] / roots
            np.multiply(coupling, scale[:, None], out=beside[:, :last])
            beside[:, last] = self._gradient[far] / roots
            kept = blas.dsyrk(-sign, beside.T, 1.0, kept, lower=1, overwrite_c=1)
        return np.asarray(kept)

    def solve(self, right: Floats, accuracy: float) -> Floats:
        """The solution for one right-hand side or several, in columns.

        accuracy : what may be left of the right-hand side, relative.
        """
        if not len(self._far):
            return self._factors.solve(right)
        if right.ndim == 2:
            return np.column_stack([self.solve(column, accuracy) for column in right.T])
        solution, left = np.zeros(len(right)), right
        size = before = float(np.abs(right).max())
        for _ in range(MOST_CORRECTIONS):
            solution = solution + self._nearly(left)
            left = right - self._times(solution)
            now = float(np.abs(left).max())
            if now <= accuracy * size or now > SHRINKS * before:
                break
            before = now
        return solution

    def _nearly(self, right: Floats) -> Floats:
        """The solution with nothing but the diagonal of the eliminated block."""
        solution = np.zeros(len(right))
        solution[self._far] = right[self._far] / self._diagonal
        left = right - self._times(solution)
        driven = np.zeros(len(right))
        driven[self._kept] = self._factors.solve(left[self._kept])
        solution[self._far] -= self._times(driven)[self._far] / self._diagonal
        return solution + driven

    def _times(self, x: Floats) -> Floats:
        """K x."""
        balance = self.balance
        image = balance.weights * balance.image(self._slopes, self.z, x[:-1])
        return np.append(image + x[-1] * self._gradient, self._gradient @ x[:-1])


def linear_system(balance: Balance, z: Floats) -> SecondVariation:
    """K at the orbit z; LinAlgError where it is singular, or too large to be factored."""
    slopes, near = balance.slopes(z), np.ones(len(balance.n), dtype=bool)
    if len(z) > WHOLE:
        resonant = balance.near_resonance(slopes, z, NEAR_RESONANCE)
        count = int(resonant.sum())
        if count * len(z) <= min(MOST_NEAR * len(z) ** 2, LARGEST_SYSTEM**2):
            near = resonant
        elif len(z) > LARGEST_SYSTEM:
            size = f"{len(z)} unknowns with {count} near a resonance"
            raise np.linalg.LinAlgError(f"the matrix of {size} is too large")
    return SecondVariation(balance, slopes, z, near)
