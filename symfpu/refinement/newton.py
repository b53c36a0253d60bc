"""Newton's method on the invariance equation with conditions.

One Krylov solution a step, preconditioned by the exact linear part.

A step solves for the changes of all coefficients and shifts at once. The preconditioner is exact
on a block, the unknowns with the smallest divisors (seeds and near resonances) with shifts and
conditions, and divides by the divisors elsewhere. Small systems fit into the block as a whole:
they are solved directly.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.refinement.conditions import Condition
from symfpu.refinement.equation import Floats, Ints, TorusEquation

LARGEST_BLOCK, SMALLEST_BLOCK = 4000, 300  # unknowns that are solved for directly
NEARNESS = (
    3.0  # divisors up to so many times what the coupling adds to them belong to the block
)
KRYLOV, RESTARTS = 60, 4
ACCURACY = 1e-8  # of a Krylov solution
# errors by rounding up to which a force is taken in doubles: of an amplitude, relative, and of
# other coefficients, relative to the largest
AMPLITUDES, COEFFICIENTS = 1e-14, 1e-13
# relative change to come that ends the iteration, and the one that does when it no longer shrinks
STEP, ROUNDING_STEP = 1e-16, 1e-9
ITERATIONS = 15
CORRECTIONS = 5  # of the solution for a derivative
GROWTH = 30.0  # factor by which iterates may leave the size of the guess


class NewtonStep(NamedTuple):
    """One step of Newton's method.

    residual : of the equations before the step, relative to the largest acceleration. change : of
    the coefficients, relative to the largest. conditions : largest relative violation. krylov :
    products with the derivative.
    """

    residual: float
    change: float
    conditions: float
    krylov: int


@dataclass(frozen=True, eq=False)
class Iterate:
    """cosines (H, C) and shifts (s,) in long doubles, and the way there.

    failure : why it ended early, empty if it converged.
    """

    cosines: Floats
    shifts: Floats
    steps: tuple[NewtonStep, ...]
    failure: str = ""

    @property
    def residual(self) -> float:
        """Of the equations at the chosen harmonics, before the last step."""
        return self.steps[-1].residual if self.steps else np.inf


class _System:
    """One linear system of Newton's method.

    Vectors hold the masked coefficients, then the shifts.
    """

    def __init__(
        self,
        equation: TorusEquation,
        conditions: Sequence[Condition],
        cosines: Floats,
        shifts: Floats,
    ) -> None:
        self.equation, self.mask, self.s = equation, equation.mask, len(shifts)
        self.diagonal = equation.divisors(shifts).astype(float)
        self.slopes = equation.slopes(cosines)
        self.cosines = cosines.astype(float)
        self.rates = equation.rates(shifts).astype(float)
        self._set_conditions(conditions, cosines, shifts)

    def _set_conditions(
        self, conditions: Sequence[Condition], cosines: Floats, shifts: Floats
    ) -> None:
        from scipy import sparse

        by_cosine, by_shift = [], []
        for condition in conditions:
            of_cosines, of_shifts = condition.gradient(self.equation, cosines, shifts)
            by_cosine.append(sparse.csr_matrix(of_cosines[self.mask]))
            by_shift.append(of_shifts)
        self.by_cosine = sparse.vstack(by_cosine, format="csr")
        self.corner = np.array(by_shift)

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


class _Preconditioner:
    """The inverse of the system with divisors alone outside its block.

    The largest couplings to and from the block are kept.
    """

    def __init__(self, system: _System) -> None:
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

    def _block(self, system: _System, total: int) -> Ints:
        """Places of the unknowns with the smallest divisors, those of the seeds first of all."""
        equation = system.equation
        linear = equation.linear.astype(float)
        weights = np.full(system.mask.shape, np.inf)
        np.divide(np.abs(system.diagonal), linear**2, out=weights, where=system.mask)
        weights[equation.seed_rows, equation.seed_columns] = 0
        resonant = weights < NEARNESS * np.abs(system.slopes).max()
        count = min(max(int(resonant.sum()), SMALLEST_BLOCK), LARGEST_BLOCK, total)
        smallest = np.argpartition(weights, count - 1, axis=None)[:count]
        return np.sort(smallest)

    @staticmethod
    def _matrix(system: _System, rows: Ints, columns: Ints, inside: Ints) -> Floats:
        """The system within the block, with shifts and conditions."""
        count, s = len(rows), system.s
        matrix = np.zeros((count + s, count + s))
        matrix[:count, :count] = -system.equation.block(system.slopes, rows, columns)
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
        added = (self.into @ far).tocoo()
        matrix[added.row, added.col] -= added.data
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


@np.errstate(divide="ignore", invalid="ignore")
def force_precision(equation: TorusEquation, cosines: Floats, shifts: Floats) -> type:
    """Doubles for the force where what they round shows in no coefficient, else long doubles.

    A rounded force is divided by the divisor: that of a seed is its shift, which falls with the
    square of the amplitude, and with it how much of alpha's force it is.
    """
    divisors = np.abs(equation.divisors(shifts)).astype(float)
    errors = equation.rounding(cosines, np.float64) / divisors
    seeds = equation.seed_rows, equation.seed_columns
    allowed = np.full(cosines.shape, COEFFICIENTS * float(np.abs(cosines).max()))
    allowed[seeds] = AMPLITUDES * np.abs(cosines[seeds])
    enough = (errors <= allowed)[equation.mask].all()
    return np.float64 if enough else np.longdouble


def _imbalance(
    equation: TorusEquation, cosines: Floats, shifts: Floats, precision: type
) -> tuple[Floats, float]:
    """Of the equations of all unknowns, (U,), and the same relative to the largest acceleration.

    Divisors times coefficients in long doubles: near a torus the force cancels them.
    """
    force = equation.force(cosines.astype(precision))
    left = (equation.divisors(shifts) * cosines - force)[equation.mask].astype(float)
    rates = equation.rates(shifts).astype(float)
    accelerations = rates**2 @ np.abs(cosines).astype(float)
    return left, float(np.abs(left).max() / accelerations.max())


# iterates that run away are refused by their size
@np.errstate(over="ignore", invalid="ignore", divide="ignore")
def newton(
    equation: TorusEquation,
    conditions: Sequence[Condition],
    cosines: Floats,
    shifts: Floats,
    progress: Progress = unheard,
) -> Iterate:
    """The torus near a guess that meets the conditions.

    An iterate with `failure` where there is none, the best one met.
    """
    steps: list[NewtonStep] = []
    best = (np.inf, cosines, shifts)
    sizes = _sizes(equation, cosines)
    precision = force_precision(equation, cosines, shifts)

    def failed(reason: str) -> Iterate:
        return Iterate(best[1], best[2], tuple(steps), reason)

    for _ in range(ITERATIONS):
        imbalance, residual = _imbalance(equation, cosines, shifts, precision)
        given = [condition.value(equation, cosines, shifts) for condition in conditions]
        values = np.array(given).astype(float)
        violation = float(np.abs(values).max())
        if not np.isfinite(residual + violation):
            return failed("the equations or conditions leave the range of numbers")
        error = residual + violation
        if error < best[0]:
            best = (error, cosines, shifts)
        system = _System(equation, conditions, cosines, shifts)
        right = -np.concatenate([imbalance, values])
        try:
            change, products = _solved(system, _Preconditioner(system), right)
        except (np.linalg.LinAlgError, ValueError) as failure:
            return failed(f"the matrix of Newton's method is singular ({failure})")
        moved = np.zeros(cosines.shape)
        moved[equation.mask] = change[: -len(shifts)]
        cosines = cosines + moved
        shifts = shifts + change[-len(shifts) :]
        relative = float(np.abs(moved).max() / np.abs(cosines).max())
        steps.append(NewtonStep(residual, relative, violation, products))
        line = f"step {len(steps)}: residual {residual:.1e}, change {relative:.1e}"
        progress(line, NO_FRACTION)
        reached = zip(_names(equation), sizes, _sizes(equation, cosines), strict=True)
        for name, old, new in reached:
            if not old / GROWTH < new < old * GROWTH:
                return failed(f"{name} goes from {old:.3g} to {new:.3g}")
        before = steps[-2].change if len(steps) > 1 else 1.0
        to_come = relative * max(ACCURACY, relative / before)
        if to_come < STEP or before / 2 < relative < ROUNDING_STEP:
            return Iterate(cosines, shifts, tuple(steps))
    return failed(f"no convergence in {ITERATIONS} steps")


def _sizes(equation: TorusEquation, cosines: Floats) -> list[float]:
    """What must not run away or vanish: the largest coefficient, and every seed's amplitude."""
    amplitudes = cosines[equation.seed_rows, equation.seed_columns]
    largest = float(np.abs(cosines).max())
    return [largest, *(float(abs(a)) for a in amplitudes)]


def _names(equation: TorusEquation) -> list[str]:
    return ["the largest coefficient", *(f"A_{q}" for q in equation.seeds)]


def _solved(
    system: _System,
    preconditioner: _Preconditioner,
    right: Floats,
    accuracy: float = ACCURACY,
) -> tuple[Floats, int]:
    """The solution of the system for a right-hand side, and the number of products it took."""
    from scipy.sparse.linalg import LinearOperator, gmres

    count = 0
    if preconditioner.whole:
        return preconditioner(right), 0

    def preconditioned(vector: Floats) -> Floats:
        nonlocal count
        count += 1
        return system.product(preconditioner(vector))

    operator = LinearOperator((len(right), len(right)), matvec=preconditioned, dtype=float)
    limits = {"rtol": accuracy, "atol": 0.0, "restart": KRYLOV, "maxiter": RESTARTS}
    solution, info = gmres(operator, right, **limits)
    if info:
        left = float(np.linalg.norm(operator @ solution - right))
        if left > 0.5 * float(np.linalg.norm(right)):
            what = f"{count} products leave more than half of the right-hand side"
            raise np.linalg.LinAlgError(what)
    return preconditioner(solution), count


def responses(
    equation: TorusEquation,
    conditions: Sequence[Condition],
    cosines: Floats,
    shifts: Floats,
) -> tuple[Floats, Floats]:
    """Derivatives of a torus by the values of its conditions: of cosines, and of shifts.

    Shapes (s, H, N-1) and (s, s), the condition first: Newton's matrix solved for each of them,
    with corrections until they no longer shrink. Raises LinAlgError where it is singular.
    """
    system = _System(equation, conditions, cosines, shifts)
    preconditioner = _Preconditioner(system)
    count, s = int(system.mask.sum()), len(shifts)
    by_cosine, by_shift = np.zeros((s, *system.mask.shape)), np.zeros((s, s))
    for place in range(s):
        right = np.zeros(count + s)
        right[count + place] = 1.0
        change = _corrected(system, preconditioner, right)
        by_cosine[place][system.mask] = change[:count]
        by_shift[place] = change[count:]
    return by_cosine, by_shift


def _corrected(system: _System, preconditioner: _Preconditioner, right: Floats) -> Floats:
    """The solution to rounding."""
    total, left, before = np.zeros(len(right)), right, np.inf
    for _ in range(CORRECTIONS):
        change, _ = _solved(system, preconditioner, left)
        total = total + change
        left = right - system.product(total)
        size = float(np.abs(left).max())
        if size > before / 2:
            break
        before = size
    return total


class Correction:
    """Newton's matrix at one iterate, factored once and solved for many right-hand sides.

    What corrects residuals that were taken in more digits: the matrix of doubles is as good as it
    was, whatever the size of the residual.
    """

    def __init__(
        self,
        equation: TorusEquation,
        conditions: Sequence[Condition],
        cosines: Floats,
        shifts: Floats,
    ) -> None:
        self._system = _System(equation, conditions, cosines, shifts)
        self._preconditioner = _Preconditioner(self._system)

    def __call__(self, imbalance: Floats, accuracy: float) -> tuple[Floats, Floats, int]:
        """Changes of coefficients (H, C) and shifts (s,) that take an imbalance (H, C) away.

        The conditions stay met. The last result: products with the derivative.
        """
        mask, s = self._system.mask, self._system.s
        right = np.concatenate([-imbalance[mask], np.zeros(s)])
        change, products = _solved(self._system, self._preconditioner, right, accuracy)
        by_cosine = np.zeros(mask.shape)
        by_cosine[mask] = change[:-s]
        return by_cosine, change[-s:], products
