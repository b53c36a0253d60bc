"""Newton's method on the invariance equation with conditions: one Krylov solution a step, preconditioned by the exact linear part.

A step solves for the changes of all coefficients and shifts at once. The preconditioner is exact on a block, the unknowns with the
smallest divisors (seeds and near resonances) with shifts and conditions, and divides by the divisors elsewhere. Small systems fit
into the block as a whole: they are solved directly.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from symfpu.refinement.conditions import Condition
from symfpu.refinement.invariance import Floats, InvarianceEquation

Report = Callable[[str], None]

LARGEST_BLOCK, SMALLEST_BLOCK = 4000, 300  # unknowns that are solved for directly
NEAR = 3.0  # divisors up to so many times what the coupling adds to them belong to the block
KRYLOV, RESTARTS = 60, 4
ACCURACY = 1e-8  # of a Krylov solution
STEP, ROUNDING_STEP = 1e-16, 1e-9  # relative change to come that ends the iteration, and the one that does when it no longer shrinks
ITERATIONS = 15
GROWTH = 30.0  # factor by which iterates may leave the size of the guess


class NewtonStep(NamedTuple):
    """residual : of the equations before the step, relative to the largest acceleration. change : of the coefficients, relative to
    the largest. conditions : largest relative violation. krylov : products with the derivative."""

    residual: float
    change: float
    conditions: float
    krylov: int


@dataclass(frozen=True, eq=False)
class Iterate:
    """cosines (H, N-1) and shifts (s,) in long doubles, the way there, and why it ended early (empty if it converged)."""

    cosines: Floats
    shifts: Floats
    steps: tuple[NewtonStep, ...]
    failure: str = ""

    @property
    def residual(self) -> float:
        """Of the equations at the chosen harmonics, before the last step."""
        return self.steps[-1].residual if self.steps else np.inf


class _System:
    """One linear system of Newton's method. Vectors hold the masked coefficients, then the shifts."""

    def __init__(self, equation: InvarianceEquation, conditions: Sequence[Condition], cosines: Floats, shifts: Floats) -> None:
        self.equation, self.mask = equation, equation.mask
        self.divisors = equation.divisors(shifts)
        self.imbalance = np.where(self.mask, self.divisors * cosines - equation.force(cosines), 0)
        self.values = np.array([c.value(equation, cosines, shifts) for c in conditions], dtype=np.longdouble)
        self.slopes = equation.slopes(cosines)
        rates = equation.rates(shifts)
        self.by_shift = [
            np.where(self.mask, (2 * rates * nu)[:, None] * cosines, 0).astype(float)[self.mask] for nu in equation.harmonics.T
        ]
        gradients = [c.gradient(equation, cosines, shifts) for c in conditions]
        self.by_cosine = np.array([g[self.mask] for g, _ in gradients])
        self.corner = np.array([g for _, g in gradients])
        self.diagonal = self.divisors.astype(float)
        self.acceleration = float(np.abs((rates**2)[:, None] * cosines).sum(axis=0).max())

    def product(self, vector: Floats) -> Floats:
        s = len(self.by_shift)
        change = np.zeros(self.mask.shape)
        change[self.mask] = vector[:-s]
        moved = (self.diagonal * change - self.equation.force_change(self.slopes, change))[self.mask]
        for column, x in zip(self.by_shift, vector[-s:], strict=True):
            moved += column * x
        return np.concatenate([moved, self.by_cosine @ vector[:-s] + self.corner @ vector[-s:]])

    @property
    def right(self) -> Floats:
        return -np.concatenate([self.imbalance[self.mask], self.values]).astype(float)


class _Preconditioner:
    """The inverse of the system with divisors alone outside its block, and the largest couplings to and from it."""

    def __init__(self, system: _System) -> None:
        from scipy import linalg, sparse

        mask, linear = system.mask, system.equation.linear.astype(float)
        weights = np.where(mask, np.abs(system.diagonal) / linear**2, np.inf)
        weights[system.equation.seed_rows, system.equation.seed_columns] = 0
        near = int((weights < NEAR * np.abs(system.slopes).max()).sum())
        total, s = int(mask.sum()), len(system.by_shift)
        count = min(max(near, SMALLEST_BLOCK), LARGEST_BLOCK, total)
        chosen = np.sort(np.argpartition(weights, count - 1, axis=None)[:count])
        rows, columns = np.unravel_index(chosen, mask.shape)
        inside = (np.cumsum(mask, axis=None) - 1)[chosen]
        outside = np.setdiff1d(np.arange(total), inside)
        self.inside, self.outside = np.append(inside, np.arange(total, total + s)), outside
        matrix = np.zeros((count + s, count + s))
        matrix[:count, :count] = np.diag(system.diagonal[rows, columns]) - system.equation.block(system.slopes, rows, columns)
        by_shift = np.array(system.by_shift).reshape(s, total).T
        matrix[:count, count:] = by_shift[inside]
        matrix[count:, :count] = system.by_cosine[:, inside]
        matrix[count:, count:] = system.corner
        self.inverse = 1 / np.where(system.diagonal[mask] == 0, 1, system.diagonal[mask])[outside]
        self.whole = len(outside) == 0
        if not self.whole:
            coupling = -system.equation.sparse_derivative(system.slopes)
            self.into = sparse.bmat([[coupling[inside][:, outside]], [sparse.csr_matrix(system.by_cosine[:, outside])]]).tocsr()
            self.out = sparse.bmat([[coupling[outside][:, inside], sparse.csr_matrix(by_shift[outside])]]).tocsr()
            matrix -= (self.into @ sparse.diags(self.inverse) @ self.out).toarray()
        self.factors = linalg.lu_factor(matrix, overwrite_a=True, check_finite=False)

    def __call__(self, vector: Floats) -> Floats:
        from scipy import linalg

        result = np.empty_like(vector)
        if self.whole:
            result[self.inside] = linalg.lu_solve(self.factors, vector[self.inside], check_finite=False)
            return result
        far = self.inverse * vector[self.outside]
        near = linalg.lu_solve(self.factors, vector[self.inside] - self.into @ far, check_finite=False)
        result[self.inside], result[self.outside] = near, far - self.inverse * (self.out @ near)
        return result


@np.errstate(over="ignore", invalid="ignore", divide="ignore")  # iterates that run away are refused by their size
def newton(
    equation: InvarianceEquation, conditions: Sequence[Condition], cosines: Floats, shifts: Floats, report: Report = lambda _: None
) -> Iterate:
    """The torus near a guess that meets the conditions; an iterate with `failure` where there is none, the best one met."""
    steps: list[NewtonStep] = []
    best = (np.inf, cosines, shifts)
    sizes = _sizes(equation, cosines)

    def failed(reason: str) -> Iterate:
        return Iterate(best[1], best[2], tuple(steps), reason)

    for _ in range(ITERATIONS):
        system = _System(equation, conditions, cosines, shifts)
        residual = float(np.abs(system.imbalance).max()) / system.acceleration
        violation = float(np.abs(system.values).max())
        if not np.isfinite(residual + violation):
            return failed("the equations or conditions leave the range of numbers")
        if residual + violation < best[0]:
            best = (residual + violation, cosines, shifts)
        try:
            change, products = _solved(system)
        except (np.linalg.LinAlgError, ValueError) as error:
            return failed(f"the matrix of Newton's method is singular ({error})")
        moved = np.zeros(cosines.shape)
        moved[equation.mask] = change[: -len(shifts)]
        cosines, shifts = cosines + moved, shifts + change[-len(shifts) :]
        relative = float(np.abs(moved).max() / np.abs(cosines).max())
        steps.append(NewtonStep(residual, relative, violation, products))
        report(f"step {len(steps)}: residual {residual:.1e}, change {relative:.1e}")
        for name, old, new in zip(_names(equation), sizes, _sizes(equation, cosines), strict=True):
            if not old / GROWTH < new < old * GROWTH:
                return failed(f"{name} goes from {old:.3g} to {new:.3g}")
        before = steps[-2].change if len(steps) > 1 else 1.0
        to_come = relative * max(ACCURACY, relative / before)
        if to_come < STEP or before / 2 < relative < ROUNDING_STEP:
            return Iterate(cosines, shifts, tuple(steps))
    return failed(f"no convergence in {ITERATIONS} steps")


def _sizes(equation: InvarianceEquation, cosines: Floats) -> list[float]:
    """What must not run away or vanish: the largest coefficient, and the amplitude of every seed."""
    amplitudes = cosines[equation.seed_rows, equation.seed_columns]
    return [float(np.abs(cosines).max()), *(float(abs(a)) for a in amplitudes)]


def _names(equation: InvarianceEquation) -> list[str]:
    return ["the largest coefficient", *(f"A_{q}" for q in equation.seeds)]


def _solved(system: _System) -> tuple[Floats, int]:
    """Newton's step and the number of products it took."""
    from scipy.sparse.linalg import LinearOperator, gmres

    preconditioner, count = _Preconditioner(system), 0
    if preconditioner.whole:
        return preconditioner(system.right), 0

    def preconditioned(vector: Floats) -> Floats:
        nonlocal count
        count += 1
        return system.product(preconditioner(vector))

    operator = LinearOperator((len(system.right),) * 2, matvec=preconditioned, dtype=float)
    solution, info = gmres(operator, system.right, rtol=ACCURACY, atol=0.0, restart=KRYLOV, maxiter=RESTARTS)
    if info and float(np.linalg.norm(operator @ solution - system.right)) > 0.5 * float(np.linalg.norm(system.right)):
        raise np.linalg.LinAlgError(f"{count} products leave more than half of the right-hand side")
    return preconditioner(solution), count
