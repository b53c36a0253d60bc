"""Newton's method on the invariance equation with conditions.

One Krylov solution a step, preconditioned by the exact linear part.

A step solves for the changes of all coefficients and shifts at once
(`symfpu.refinement.linear_system`). Forces are taken in doubles where what those round shows in no
coefficient, else in long doubles.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.refinement.conditions import Condition
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Floats
from symfpu.refinement.linear_system import LinearSystem, Preconditioner

KRYLOV, RESTARTS = 60, 4
ACCURACY = 1e-8  # of a Krylov solution
# of the right-hand side, up to which what a Krylov solution leaves makes a step like any other
INEXACT = 0.5
FALL = 0.9  # of the error, at least, by a step that leaves more
# errors by rounding up to which a force is taken in doubles: of an amplitude, relative, and of
# other coefficients, relative to the largest
AMPLITUDES, COEFFICIENTS = 1e-14, 1e-13
# relative change to come that ends the iteration, and the one that does when it no longer shrinks
STEP, ROUNDING_STEP = 1e-16, 1e-9
ITERATIONS = 15
CORRECTIONS = 5  # of the solution for a derivative
GROWTH = 30.0  # factor by which iterates may leave the size of the guess


class Aim(NamedTuple):
    """How far Newton's method goes.

    change : to come, relative, that ends it. krylov : accuracy of a Krylov solution.
    """

    change: float
    krylov: float


SETTLED = Aim(STEP, ACCURACY)  # to rounding


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

    failure : why it ended early, empty if it converged. settled : whether it ended early because
    no further step could be solved for, when the next one was expected to change less than what
    ends a search that no longer gains.
    """

    cosines: Floats
    shifts: Floats
    steps: tuple[NewtonStep, ...]
    failure: str = ""
    settled: bool = False

    @property
    def residual(self) -> float:
        """Of the equations at the chosen harmonics, before the last step."""
        return self.steps[-1].residual if self.steps else np.inf


@np.errstate(divide="ignore", invalid="ignore")
def force_precision(equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> type:
    """Doubles for the force where what they round shows in no coefficient, else long doubles.

    An error of the force is divided by the divisor. At small amplitudes those of the seeds, their
    shifts, fall with the square of the amplitude, the force of alpha relative to it as the first.
    """
    divisors = np.abs(equation.divisors(shifts)).astype(float)
    errors = equation.rounding(cosines, np.float64) / divisors
    seeds = equation.seed_rows, equation.seed_columns
    allowed = np.full(cosines.shape, COEFFICIENTS * float(np.abs(cosines).max()))
    allowed[seeds] = AMPLITUDES * np.abs(cosines[seeds])
    enough = (errors <= allowed)[equation.mask].all()
    return np.float64 if enough else np.longdouble


def _imbalance(
    equation: InvarianceEquation, cosines: Floats, shifts: Floats, precision: type
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
    equation: InvarianceEquation,
    conditions: Sequence[Condition],
    cosines: Floats,
    shifts: Floats,
    progress: Progress = unheard,
    *,
    aim: Aim = SETTLED,
    growth: float = GROWTH,
) -> Iterate:
    """The torus near a guess that meets the conditions.

    growth : factor by which amplitudes may change from those of the guess. An iterate with
    `failure` where there is none, the best one met.
    """
    steps: list[NewtonStep] = []
    best = (np.inf, cosines, shifts)
    sizes = _sizes(equation, cosines)
    precision = force_precision(equation, cosines, shifts)
    to_come, left, products = np.inf, 0.0, 0

    def failed(reason: str, *, unsolved: bool = False) -> Iterate:
        settled = unsolved and to_come < ROUNDING_STEP
        return Iterate(best[1], best[2], tuple(steps), reason, settled)

    for _ in range(ITERATIONS):
        imbalance, residual = _imbalance(equation, cosines, shifts, precision)
        given = [condition.value(equation, cosines, shifts) for condition in conditions]
        values = np.array(given).astype(float)
        violation = float(np.abs(values).max())
        if not np.isfinite(residual + violation):
            return failed("the equations or conditions leave the range of numbers")
        error = residual + violation
        gained = error < FALL * best[0]
        if error < best[0]:
            best = (error, cosines, shifts)
        if left > INEXACT and not gained:
            return failed(_unsolved(products, left), unsolved=True)
        system = LinearSystem(equation, conditions, cosines, shifts)
        right = -np.concatenate([imbalance, values])
        try:
            change, products, left = _change(system, right, aim.krylov)
        except np.linalg.LinAlgError as failure:
            return failed(str(failure), unsolved=True)
        moved = np.zeros(cosines.shape)
        moved[equation.mask] = change[: -len(shifts)]
        cosines = cosines + moved
        shifts = shifts + change[-len(shifts) :]
        relative = float(np.abs(moved).max() / np.abs(cosines).max())
        steps.append(NewtonStep(residual, relative, violation, products))
        line = f"step {len(steps)}: residual {residual:.1e}, change {relative:.1e}"
        progress(line, NO_FRACTION)
        if runs_away := _runs_away(sizes, _sizes(equation, cosines), growth):
            return failed(runs_away)
        if left > INEXACT:
            continue
        before = steps[-2].change if len(steps) > 1 else 1.0
        to_come = relative * max(aim.krylov, left, relative / before)
        if to_come < aim.change or before / 2 < relative < ROUNDING_STEP:
            return Iterate(cosines, shifts, tuple(steps))
    return failed(f"no convergence in {ITERATIONS} steps")


def _unsolved(products: int, left: float) -> str:
    return f"{products} products leave {left:.2g} of the right-hand side of Newton's method"


def _sizes(equation: InvarianceEquation, cosines: Floats) -> dict[str, float]:
    """What must not run away or vanish: the largest coefficient, and every seed's amplitude."""
    amplitudes = np.abs(cosines[equation.seed_rows, equation.seed_columns])
    by_seed = zip(equation.seeds, amplitudes, strict=True)
    largest = float(np.abs(cosines).max())
    return {"the largest coefficient": largest} | {f"A_{q}": float(a) for q, a in by_seed}


def _runs_away(sizes: dict[str, float], reached: dict[str, float], growth: float) -> str:
    """The first size that has left that of the guess, in words; empty where there is none."""
    for name, old in sizes.items():
        new = reached[name]
        if not old / growth < new < old * growth:
            return f"{name} goes from {old:.3g} to {new:.3g}"
    return ""


class Solution(NamedTuple):
    """Of the linear system: the changes, how many products they took, and what they leave.

    left : of the right-hand side, at most about, relative.
    """

    change: Floats
    products: int
    left: float


def _solved(
    system: LinearSystem,
    preconditioner: Preconditioner,
    right: Floats,
    accuracy: float,
) -> Solution:
    """The solution of the system for a right-hand side, as far as it is found."""
    from scipy.sparse.linalg import LinearOperator, gmres

    count = 0
    if preconditioner.whole:
        return Solution(preconditioner(right), 0, 0.0)

    def preconditioned(vector: Floats) -> Floats:
        nonlocal count
        count += 1
        return system.product(preconditioner(vector))

    operator = LinearOperator((len(right), len(right)), matvec=preconditioned, dtype=float)
    limits = {"rtol": accuracy, "atol": 0.0, "restart": KRYLOV, "maxiter": RESTARTS}
    solution, info = gmres(operator, right, **limits)
    left = accuracy
    if info:
        missed = operator @ solution - right
        left = float(np.linalg.norm(missed) / np.linalg.norm(right))
    return Solution(preconditioner(solution), count, left)


def _change(system: LinearSystem, right: Floats, accuracy: float) -> Solution:
    """A step, as far as it is found; LinAlgError with the reason where there is none."""
    try:
        found = _solved(system, Preconditioner(system), right, accuracy)
    except (np.linalg.LinAlgError, ValueError) as failure:
        reason = f"the matrix of Newton's method is singular ({failure})"
        raise np.linalg.LinAlgError(reason) from failure
    if not found.left < 1:
        raise np.linalg.LinAlgError(_unsolved(found.products, found.left))
    return found


def _solution(
    system: LinearSystem,
    preconditioner: Preconditioner,
    right: Floats,
    accuracy: float = ACCURACY,
) -> Solution:
    """The same; LinAlgError where more than half of the right-hand side is left."""
    found = _solved(system, preconditioner, right, accuracy)
    if not found.left <= INEXACT:
        raise np.linalg.LinAlgError(_unsolved(found.products, found.left))
    return found


def responses(
    equation: InvarianceEquation,
    conditions: Sequence[Condition],
    cosines: Floats,
    shifts: Floats,
    *,
    first: int | None = None,
) -> tuple[Floats, Floats]:
    """Derivatives of a torus by the values of its conditions: of cosines, and of shifts.

    Shapes (s, H, N-1) and (s, s), the condition first: Newton's matrix solved for each of them,
    with corrections until they no longer shrink. Raises LinAlgError where it is singular.

    first : how many of the conditions are asked for, from the first on; default all.
    """
    system = LinearSystem(equation, conditions, cosines, shifts)
    preconditioner = Preconditioner(system)
    count, s = int(system.mask.sum()), len(shifts)
    asked = s if first is None else first
    by_cosine, by_shift = np.zeros((asked, *system.mask.shape)), np.zeros((asked, s))
    for place in range(asked):
        right = np.zeros(count + s)
        right[count + place] = 1.0
        change = _corrected(system, preconditioner, right)
        by_cosine[place][system.mask] = change[:count]
        by_shift[place] = change[count:]
    return by_cosine, by_shift


def _corrected(
    system: LinearSystem, preconditioner: Preconditioner, right: Floats
) -> Floats:
    """The solution to rounding."""
    total, left, before = np.zeros(len(right)), right, np.inf
    for _ in range(CORRECTIONS):
        total = total + _solution(system, preconditioner, left).change
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
        equation: InvarianceEquation,
        conditions: Sequence[Condition],
        cosines: Floats,
        shifts: Floats,
    ) -> None:
        self._system = LinearSystem(equation, conditions, cosines, shifts)
        self._preconditioner = Preconditioner(self._system)

    def __call__(
        self, imbalance: Floats, accuracy: float, conditions: Floats
    ) -> tuple[Floats, Floats, int]:
        """Changes of coefficients (H, C) and shifts (s,) that take an imbalance (H, C) away.

        conditions : what they leave, taken away too; (s,). The last result: products with the
        derivative.
        """
        mask, s = self._system.mask, self._system.s
        right = -np.concatenate([imbalance[mask], conditions])
        found = _solution(self._system, self._preconditioner, right, accuracy)
        change, products = found.change, found.products
        by_cosine = np.zeros(mask.shape)
        by_cosine[mask] = change[:-s]
        return by_cosine, change[-s:], products
