"""The linear system of a step of Newton's method on a torus: Krylov solutions, preconditioned.

The preconditioner is exact on a block, the unknowns with the smallest divisors (seeds and near
resonances) with shifts and conditions, and divides by the divisors elsewhere. Small systems fit
into the block as a whole: they are solved directly.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from symfpu.refinement.conditions import Condition
from symfpu.refinement.invariance import InvarianceEquation, Slopes
from symfpu.refinement.lattice import Floats, Ints

LARGEST_BLOCK, SMALLEST_BLOCK = 4000, 300  # unknowns that are solved for directly
# divisors up to so many times what the coupling adds to them belong to the block
NEARNESS = 3.0
KRYLOV, RESTARTS = 60, 4
ACCURACY = 1e-8  # of a Krylov solution
# of the right-hand side, up to which what a Krylov solution leaves makes a step like any other
INEXACT = 0.5
CORRECTIONS = 5  # of the solution for a derivative
ROWS = 256  # of the block, to which what is outside is added at once


class NewtonState(NamedTuple):
    """Where Newton's matrix is taken: cosines (H, C) and shifts (s,) in long doubles."""

    equation: InvarianceEquation
    conditions: Sequence[Condition]
    cosines: Floats
    shifts: Floats


class LinearSystem:
    """One linear system of Newton's method.

    Vectors hold the masked coefficients, then the shifts.
    """

    def __init__(self, state: NewtonState) -> None:
        equation, conditions, cosines, shifts = state
        self.equation, self.mask, self.s = equation, equation.mask, len(shifts)
        self.diagonal = equation.divisors(shifts).astype(float)
        self.slopes = equation.slopes(cosines)
        self.cosines = cosines.astype(float)
        self.rates = equation.rates(shifts).astype(float)
        gradients = [x.gradient(equation, cosines, shifts) for x in conditions]
        self._set_conditions(gradients)

    def _set_conditions(self, gradients: Sequence[Slopes]) -> None:
        from scipy import sparse

        by_cosine = [sparse.csr_matrix(slope[self.mask]) for slope, _ in gradients]
        self.by_cosine = sparse.vstack(by_cosine, format="csr")
        self.corner = np.array([by_shift for _, by_shift in gradients])

    def along_shifts(self, change: Floats) -> Floats:
        """What a change of the shifts adds to the equations; shape (unknowns,)."""
        moved = 2 * self.rates * (self.equation.harmonics @ change)
        return np.asarray((moved[:, None] * self.cosines)[self.mask])

    def product(self, vector: Floats) -> Floats:
        coefficients, shifts = vector[: -self.s], vector[-self.s :]
        change = np.zeros(self.mask.shape)
        change[self.mask] = coefficients
        moved = self.diagonal * change
        moved -= self.equation.force_change(self.slopes, change)
        equations = moved[self.mask] + self.along_shifts(shifts)
        conditions = self.by_cosine @ coefficients + self.corner @ shifts
        return np.concatenate([equations, conditions])


class Preconditioner:
    """The inverse of the system with divisors alone outside its block.

    The largest couplings to and from the block are kept.
    """

    def __init__(self, system: LinearSystem) -> None:
        mask, s = system.mask, system.s
        total = int(mask.sum())
        chosen = self._block(system, total)
        inside = (np.cumsum(mask, axis=None) - 1)[chosen]
        rows, columns = np.unravel_index(chosen, mask.shape)
        self.system, self.whole = system, len(inside) == total
        self.inside = np.append(inside, np.arange(total, total + s))
        matrix = self._matrix(system, rows, columns, inside)
        if not self.whole:
            divisors = system.diagonal[mask]
            self.inverse = 1 / np.where(divisors == 0, 1, divisors)
            self.inverse[inside] = 0
            self._set_couplings(rows, columns)
            self._subtract_outside(matrix)
        self.factors = _factors(matrix)

    def _block(self, system: LinearSystem, total: int) -> Ints:
        """Places of the unknowns with the smallest divisors, those of the seeds first of all."""
        weights = _weights(system.equation, system.diagonal)
        count = _count(weights, system.slopes, total)
        smallest = np.argpartition(weights, count - 1, axis=None)[:count]
        return np.sort(smallest)

    @staticmethod
    def _matrix(system: LinearSystem, rows: Ints, columns: Ints, inside: Ints) -> Floats:
        """The system within the block, with shifts and conditions."""
        count, s = len(rows), system.s
        matrix = np.zeros((count + s, count + s))
        coupling = system.equation.block(system.slopes, rows, columns)
        np.negative(coupling, out=matrix[:count, :count])
        matrix[np.arange(count), np.arange(count)] += system.diagonal[rows, columns]
        for k, unit in enumerate(np.eye(s)):
            matrix[:count, count + k] = system.along_shifts(unit)[inside]
        matrix[count:, :count] = system.by_cosine[:, inside].toarray()
        matrix[count:, count:] = system.corner
        return matrix

    def _set_couplings(self, rows: Ints, columns: Ints) -> None:
        """The largest couplings into the block and out of it, sparse.

        The force derives from a potential: its derivative is symmetric with the norms of the
        cosines as weights, 1 of a constant and 1/2 of the others.
        """
        from scipy import sparse

        system = self.system
        self.into = -system.equation.sparse_rows(system.slopes, rows, columns)
        still = (system.equation.harmonics == 0).all(axis=1)
        norms = np.where(still, 1.0, 0.5)
        of_all = np.broadcast_to(norms[:, None], system.mask.shape)[system.mask]
        scaled = sparse.diags(norms[rows]) @ self.into @ sparse.diags(1 / of_all)
        self.out = scaled.T.tocsr()

    def _subtract_outside(self, matrix: Floats) -> None:
        """What the unknowns outside add to the block."""
        from scipy import sparse

        system, count = self.system, self.into.shape[0]
        far = sparse.diags(self.inverse) @ self.out
        for first in range(0, count, ROWS):
            added = (self.into[first : first + ROWS] @ far).tocoo()
            matrix[first + added.row, added.col] -= added.data
        matrix[count:, :count] -= (system.by_cosine @ far).toarray()
        for k, unit in enumerate(np.eye(system.s)):
            moved = self.inverse * system.along_shifts(unit)
            matrix[:count, count + k] -= self.into @ moved
            matrix[count:, count + k] -= system.by_cosine @ moved

    def __call__(self, vector: Floats) -> Floats:
        from scipy import linalg

        result = np.empty_like(vector)
        right, s = vector[self.inside], self.system.s
        if self.whole:
            result[self.inside] = linalg.lu_solve(self.factors, right, check_finite=False)
            return result
        far = self.inverse * vector[:-s]
        right[:-s] -= self.into @ far
        right[-s:] -= self.system.by_cosine @ far
        near = linalg.lu_solve(self.factors, right, check_finite=False)
        driven = self.out @ near[:-s] + self.system.along_shifts(near[-s:])
        result[:-s] = far - self.inverse * driven
        result[self.inside] = near
        return result


class Solution(NamedTuple):
    """Of the linear system: the changes, how many products they took, and what they leave.

    left : of the right-hand side, at most about, relative.
    """

    change: Floats
    products: int
    left: float


class Jacobian:
    """Newton's matrix at one iterate, factored once and solved for many right-hand sides.

    It also corrects residuals that were taken in more digits: the matrix of doubles is as good as
    it was, whatever the size of the residual.
    """

    def __init__(self, state: NewtonState) -> None:
        self._system = LinearSystem(state)
        self._preconditioner = Preconditioner(self._system)
        self.size = int(self._system.mask.sum()) + self._system.s

    def approximate(self, right: Floats, accuracy: float) -> Solution:
        """The solution for a right-hand side, as far as it is found."""
        from scipy.sparse.linalg import LinearOperator, gmres

        count, preconditioner = 0, self._preconditioner
        if preconditioner.whole:
            return Solution(preconditioner(right), 0, 0.0)

        def preconditioned(vector: Floats) -> Floats:
            nonlocal count
            count += 1
            return self._system.product(preconditioner(vector))

        operator = LinearOperator((len(right), len(right)), preconditioned, dtype=float)
        limits = {"rtol": accuracy, "atol": 0.0, "restart": KRYLOV, "maxiter": RESTARTS}
        solution, info = gmres(operator, right, **limits)
        left = accuracy
        if info:
            missed = operator @ solution - right
            left = float(np.linalg.norm(missed) / np.linalg.norm(right))
        return Solution(preconditioner(solution), count, left)

    def solve(self, right: Floats, accuracy: float = ACCURACY) -> Floats:
        """The same; LinAlgError where more than half of the right-hand side is left."""
        found = self.approximate(right, accuracy)
        if not found.left <= INEXACT:
            raise np.linalg.LinAlgError(unsolved_words(found.products, found.left))
        return found.change

    def to_rounding(self, right: Floats) -> Floats:
        """The same with corrections until they no longer shrink."""
        total, left, before = np.zeros(len(right)), right, np.inf
        for _ in range(CORRECTIONS):
            total = total + self.solve(left)
            left = right - self._system.product(total)
            size = float(np.abs(left).max())
            if size > before / 2:
                break
            before = size
        return total

    def responses(self, asked: int) -> tuple[Floats, Floats]:
        """Derivatives of a torus by the values of its first conditions: of cosines, and of shifts.

        Shapes (asked, H, C) and (asked, s), to rounding. Raises LinAlgError where it is singular.
        """
        changes = []
        for place in range(asked):
            right = np.zeros(self.size)
            right[self.size - self._system.s + place] = 1.0
            changes.append(self.parts(self.to_rounding(right)))
        by_cosine, by_shift = zip(*changes, strict=True)
        return np.array(by_cosine), np.array(by_shift)

    def correction(
        self, residual: Floats, conditions: Floats, accuracy: float
    ) -> tuple[Floats, Floats]:
        """Changes of coefficients (H, C) and shifts (s,) that take a residual (H, C) away.

        conditions : what they leave, taken away too; (s,).
        """
        right = -np.concatenate([residual[self._system.mask], conditions])
        return self.parts(self.solve(right, accuracy))

    def parts(self, change: Floats) -> tuple[Floats, Floats]:
        """Of a solution: coefficients (H, C), 0 where none is unknown, and shifts (s,)."""
        mask, s = self._system.mask, self._system.s
        by_cosine = np.zeros(mask.shape)
        by_cosine[mask] = change[:-s]
        return by_cosine, change[-s:]


def unsolved_words(products: int, left: float) -> str:
    """Why a step is none."""
    return f"{products} products leave {left:.2g} of the right-hand side of Newton's method"


def _weights(equation: InvarianceEquation, divisors: Floats) -> Floats:
    """Of all coefficients (H, C): the divisor over Omega^2, infinite of those not unknown."""
    linear = equation.linear.astype(float)
    weights = np.full(equation.mask.shape, np.inf)
    np.divide(np.abs(divisors), linear**2, out=weights, where=equation.mask)
    weights[equation.seed_rows, equation.seed_columns] = 0
    return weights


def _count(weights: Floats, slopes: Floats, total: int) -> int:
    """How many unknowns belong to the block, of so many."""
    resonant = weights < NEARNESS * np.abs(slopes).max()
    return min(max(int(resonant.sum()), SMALLEST_BLOCK), LARGEST_BLOCK, total)


def block_size(equation: InvarianceEquation, divisors: Floats, slopes: Floats) -> int:
    """How many unknowns a preconditioner solves for directly, by divisors (H, C) and slopes."""
    return _count(_weights(equation, divisors), slopes, int(equation.mask.sum()))


def _factors(matrix: Floats) -> tuple[Floats, Ints]:
    """L and U of a matrix, overwritten; LinAlgError for an exact zero among the pivots."""
    from scipy import linalg

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", linalg.LinAlgWarning)
        factors = linalg.lu_factor(matrix, overwrite_a=True, check_finite=False)
    if not factors[0].diagonal().all():
        raise np.linalg.LinAlgError("a pivot is zero")
    lower_and_upper, pivots = factors
    return lower_and_upper, pivots
