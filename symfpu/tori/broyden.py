"""Broyden's method for a few equations that cost much to evaluate.

And the walk along a family in growing steps of it.

Variables of size one are expected, and equations whose matrix is near -1 or whose inverse is
carried over from a neighbour. Arrays of doubles or of mpf.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from symfpu.numbers.arithmetic import Numbers

Value = TypeVar("Value")
State = TypeVar("State")

STEPS, STEPS_DIGITS = 15, 100  # with doubles, with mpf
# an iteration that has not come down so far after so many steps is given up
TRIAL_STEPS, PROGRESS = 5, 0.1
DIFFERENCE = 1e-6  # of the largest variable
RUNAWAY = 1e3  # growth of the residual at which an iteration is given up
SMALLEST_PART = 1 / 64  # of the way gone already, in one step
FIRST_PART = 1e-36  # of the whole way, in the first step


class NotFound(Exception):
    """A search ended without a solution.

    Carries its last iterate, residual and the reason. For our own floors above.
    """

    def __init__(self, iterate: Numbers, residual: float, reason: str) -> None:
        self.iterate = iterate
        self.residual = residual
        self.reason = reason
        super().__init__(reason)


@dataclass(frozen=True, eq=False)
class Found(Generic[Value]):
    """A solution x (s,), what was computed on the way to it, and its residual.

    inverse : the approximate inverse of its matrix, (s, s).
    """

    x: Numbers
    inverse: Numbers
    value: Value
    residual: float


Equations = Callable[[Numbers], tuple[Numbers, float, Value]]


def solve(
    equations: Equations[Value],
    start: Numbers,
    inverse: Numbers,
    least: float,
    enough: float,
) -> Found[Value]:
    """The x with equations(x) = 0 near a start, with the given matrix or one from differences.

    The given one is tried first.

    equations : x to (left sides (s,), their relative size, anything else).
    least : size that ends the iteration at once; enough : size that ends it when it no longer
        shrinks.
    Raises NotFound.
    """
    known = equations(start)
    try:
        return _iterated(equations, start, known, inverse, least, enough)
    except NotFound:
        if start.dtype == object:
            raise
        measured = _by_differences(equations, start, known)
        return _iterated(equations, start, known, measured, least, enough)


def _by_differences(
    equations: Equations[Value], x: Numbers, known: tuple[Numbers, float, Value]
) -> Numbers:
    """The inverse of the matrix of the equations in doubles; raises NotFound."""
    step = DIFFERENCE * float(np.max(np.abs(x)))
    left, size, _ = known
    if step == 0:
        raise NotFound(x, size, "the iteration runs away")
    columns = []
    for unit in np.eye(len(x)):
        moved, *_ = equations(x + step * unit)
        columns.append((moved - left) / step)
    matrix = np.stack(columns, axis=1)
    largest_condition = 1 / np.finfo(float).eps
    if not np.isfinite(matrix).all() or np.linalg.cond(matrix) > largest_condition:
        raise NotFound(x, size, "the equations are degenerate")
    return np.asarray(np.linalg.inv(matrix))


def _iterated(
    equations: Equations[Value],
    start: Numbers,
    known: tuple[Numbers, float, Value],
    inverse: Numbers,
    least: float,
    enough: float,
) -> Found[Value]:
    x, H = start, inverse
    left, size, value = known
    best, first = Found(x, H, value, size), size
    for iteration in range(STEPS if start.dtype != object else STEPS_DIGITS):
        if best.residual <= least or (
            best.residual <= enough and size > best.residual / 4 and x is not start
        ):
            return best
        if not size <= RUNAWAY * max(first, enough) or (
            iteration == TRIAL_STEPS and best.residual > PROGRESS * first
        ):
            raise NotFound(best.x, best.residual, "the iteration does not converge")
        step = -(H @ left)
        x, before = x + step, left
        left, size, value = equations(x)
        with np.errstate(all="ignore"):
            gone = H @ (left - before)
            scale = step @ gone
            if scale != 0:
                H = H + np.outer(step - gone, step @ H) / scale
        if size < best.residual:
            best = Found(x, H, value, size)
    raise NotFound(best.x, best.residual, "the iteration does not converge")


def walk(
    start: State, reach: Callable[[State, float], State]
) -> tuple[State, NotFound | None]:
    """Follow a family to the end of a way: the last state, and why it is not the end, if it is not.

    reach : the last state and the part of the way to go to, up to 1; it raises NotFound where the
    step was too long.
    """
    state, gone, step, growth = start, 0.0, 1.0, 1
    while gone < 1:
        part = min(1.0, gone + step)
        try:
            state, gone, step, growth = reach(state, part), part, growth * step, 2
        except NotFound as failure:
            step, growth = step / (2 if gone else 8), 1
            if step < (SMALLEST_PART * gone or FIRST_PART):
                return state, failure
    return state, None
