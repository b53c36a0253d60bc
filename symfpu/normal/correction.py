"""Newton's method for one normal mode in doubles, for residuals that were taken in more digits.

A step solves, for the changes of the eigenfunction p and of sigma,

    L(sigma) dp + L'(sigma) p dsigma = -residual,    p^T dp = 0,

by Krylov solutions, preconditioned by the exact inverse within a block: the unknowns with the
smallest divisors, bordered likewise. The matrix of doubles is as good as it was, whatever the
size of the residual.
"""

from __future__ import annotations

import numpy as np

from symfpu.normal.linearised import Linearised, Values
from symfpu.normal.reduction import KRYLOV, RESTARTS, Block

BLOCK = 1200  # unknowns that are solved for directly, if there are so many
ACCURACY = 1e-13  # of a Krylov solution, relative to the residual


class NormalCorrection:
    """The bordered matrix of a normal mode that continues q, near sigma and p (F, N-1)."""

    def __init__(self, flow: Linearised, q: int, sigma: complex, p: Values) -> None:
        near = float(complex(sigma).real)
        self.flow, self.block = flow, Block(flow, q, near, (BLOCK, BLOCK))
        self.mask = self.block.mask
        self.n = int(self.mask.sum())
        self._means = np.broadcast_to(flow.means, self.mask.shape)[self.mask]
        rates = flow.rates.astype(float)[:, None]
        self._rates = np.broadcast_to(rates, self.mask.shape)[self.mask]
        self._outside = np.setdiff1d(np.arange(self.n), self.block.inside)
        self.take(sigma, p)
        self._factor(sigma)

    def take(self, sigma: complex, p: Values) -> None:
        """From now on the matrix is that of these, the preconditioner as it was."""
        vector = p[self.mask]
        self._divisors = self.flow.divisors(sigma)[self.mask]
        self._by_sigma = -2 * (sigma + self._rates) * vector
        self._like = vector
        self.kind = np.result_type(self._divisors, vector)

    def _factor(self, sigma: complex) -> None:
        from scipy import linalg

        inside = self.block.inside
        m = len(inside)
        matrix = np.zeros((m + 1, m + 1), dtype=self.kind)
        matrix[:m, :m] = self.block.matrix(sigma)
        matrix[:m, m] = self._by_sigma[inside]
        matrix[m, :m] = self._like[inside]
        self._factors = linalg.lu_factor(matrix, overwrite_a=True, check_finite=False)
        diagonal = self._divisors + self._means
        diagonal[diagonal == 0] = self.block.size
        self._inverse = 1 / diagonal[self._outside]

    def _product(self, vector: Values) -> Values:
        change, by_sigma = vector[:-1], vector[-1]
        coupled = self.flow.coupling(self._table(change))[self.mask]
        moved = self._divisors * change + coupled + self._by_sigma * by_sigma
        return np.append(moved, self._like @ change)

    def _table(self, vector: Values) -> Values:
        """The unknowns as coefficients (F, N-1)."""
        table = np.zeros(self.mask.shape, dtype=vector.dtype)
        table[self.mask] = vector
        return table

    def _preconditioned(self, vector: Values) -> Values:
        from scipy import linalg

        inside = self.block.inside
        right = np.append(vector[inside], vector[-1])
        near = linalg.lu_solve(self._factors, right, check_finite=False)
        result = np.empty(self.n + 1, dtype=self.kind)
        result[inside] = near[:-1]
        result[self._outside] = self._inverse * vector[self._outside]
        result[-1] = near[-1]
        return result

    def __call__(self, residual: Values) -> tuple[Values, complex]:
        """Changes of p (F, N-1) and of sigma that take a residual (F, N-1) away."""
        from scipy.sparse.linalg import LinearOperator, gmres

        def product(vector: Values) -> Values:
            return self._product(self._preconditioned(vector))

        right = np.append(-residual[self.mask], 0).astype(self.kind)
        shape = (self.n + 1, self.n + 1)
        operator = LinearOperator(shape, matvec=product, dtype=self.kind)
        limits = {"rtol": ACCURACY, "atol": 0.0, "restart": KRYLOV, "maxiter": RESTARTS}
        found, _ = gmres(operator, right, **limits)
        change = self._preconditioned(found)
        return self._table(change[:-1]), change[-1].item()

    def torus_share(self) -> float:
        """Above |dsigma| by a relative error of the torus, over that error; an estimate.

        A change of the torus by a part e of itself changes the slopes by about twice e of the
        largest, as if V were quartic.
        """
        slope = 2 * float(np.abs(self.flow.slopes).max())
        weights = np.abs(self._like) ** 2
        linear = self.flow.linear.astype(float) ** 2
        stretch = np.broadcast_to(linear, self.mask.shape)[self.mask] @ weights
        return float(slope * stretch / abs(self._by_sigma @ self._like))
