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
Ints = NDArray[np.intp]
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


class WholeMatrix:
    """K factored whole. index : its negative eigenvalues."""

    def __init__(self, balance: Balance, z: Floats) -> None:
        _, jacobian = balance.system(z)
        last = len(balance.n)
        matrix = np.zeros((last + 1, last + 1), order="F")
        matrix[:last, :last] = weights(balance)[:, None] * jacobian[:, :-1]
        matrix[last, :last] = balance.n**2 * z[:-1]
        self._factors = Factors(matrix)
        self.index = self._factors.negative

    def solve(self, right: Floats, accuracy: float) -> Floats:
        """The solution for one right-hand side or several, in columns; to rounding."""
        return self._factors.solve(right)


class NearResonances:
    """K with the coefficients near a resonance factored, the others eliminated by their diagonal.

    places : of those coefficients. index : the negative eigenvalues of K, by Haynsworth's rule:
    those of the eliminated diagonal and of what is left (the Schur complement), which is off by
    1 / NEAR_RESONANCE^2 of the slopes at most.
    """

    def __init__(self, balance: Balance, z: Floats, places: Ints) -> None:
        self.balance, self.z, self.places = balance, z, places
        self._slopes = balance.slopes(z)
        self._weights = weights(balance)
        self._gradient = balance.n**2 * z[:-1]
        rows, diagonal = balance.rows(self._slopes, z, places)
        rows *= self._weights[places, None]
        far = np.ones(len(balance.n), dtype=bool)
        far[places] = False
        self._far, self._diagonal = np.flatnonzero(far), (self._weights * diagonal)[far]
        # the border counts among the coefficients that are kept
        beside = np.empty((len(places) + 1, len(self._far)))
        np.compress(far, rows, axis=1, out=beside[:-1])
        beside[-1] = self._gradient[far]
        self._beside = beside.T
        kept = np.zeros((len(places) + 1, len(places) + 1), order="F")
        kept[:-1, :-1] = rows[:, places]
        kept[-1, :-1] = kept[:-1, -1] = self._gradient[places]
        kept -= (beside / self._diagonal) @ self._beside
        self._factors = Factors(kept)
        self.index = self._factors.negative + int((self._diagonal < 0).sum())

    def solve(self, right: Floats, accuracy: float) -> Floats:
        """The solution for one right-hand side or several, in columns.

        accuracy : what may be left of the right-hand side, relative.
        """
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
        near = np.append(right[self.places], right[-1])
        far = right[self._far] / self._diagonal
        kept = self._factors.solve(near - self._beside.T @ (self._diagonal * far))
        solution = np.empty(len(right))
        solution[self.places], solution[-1] = kept[:-1], kept[-1]
        solution[self._far] = far - self._beside @ kept / self._diagonal
        return solution

    def _times(self, x: Floats) -> Floats:
        """K x."""
        image = self._weights * self.balance.image(self._slopes, self.z, x[:-1])
        return np.append(image + x[-1] * self._gradient, self._gradient @ x[:-1])


def weights(balance: Balance) -> Floats:
    """Norms of the cosines: the mean counts twice."""
    return np.where(balance.n == 0, 2.0, 1.0)


def linear_system(balance: Balance, z: Floats) -> WholeMatrix | NearResonances:
    """K at the orbit z; LinAlgError where it is singular, or too large to be factored."""
    if len(z) > WHOLE:
        places = balance.near_resonance(z, NEAR_RESONANCE)
        rows = len(places) * len(z)
        if rows <= min(MOST_NEAR * len(z) ** 2, LARGEST_SYSTEM**2):
            return NearResonances(balance, z, places)
    if len(z) > LARGEST_SYSTEM:
        size = f"{len(z)} unknowns with {len(places)} near a resonance"
        raise np.linalg.LinAlgError(f"the matrix of {size} is too large")
    return WholeMatrix(balance, z)
