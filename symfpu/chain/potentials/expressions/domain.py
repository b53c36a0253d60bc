"""Where on the real line an expression is regular: walls of a potential on both sides of rest."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

import numpy as np

from symfpu.chain.potentials.expressions.text import parsed, stretch

FARTHEST = 64.0  # zeros of what is no polynomial are looked for so far out
POINTS = 1 << 14
STEPS = 60  # halvings of an interval that holds a zero
AT_REST = 1e-12


@lru_cache(maxsize=64)
def domain(formula: str) -> tuple[float, float]:
    """The nearest singularities below and above r = 0, infinite where there are none.

    Zeros of denominators, of what a logarithm is taken of, and of the cosine in a tangent.
    Polynomials have all their zeros found, other functions those where they change sign.
    """
    zeros: list[float] = []
    for vanishing in _denominators(parsed(formula)):
        zeros += _zeros(vanishing)
    below = [x for x in zeros if x < -AT_REST]
    above = [x for x in zeros if x > AT_REST]
    return max(below, default=-math.inf), min(above, default=math.inf)


def _denominators(node: Any) -> Iterator[Any]:
    """Expressions in r at whose zeros the expression is singular."""
    import sympy

    for part in sympy.preorder_traversal(node):
        if not part.has(stretch()):
            continue
        if part.is_Pow and part.exp.is_number and part.exp.is_negative:
            yield part.base
        elif isinstance(part, sympy.log):
            yield part.args[0]
        elif isinstance(part, sympy.tan):
            yield sympy.cos(part.args[0])
        elif isinstance(part, sympy.atanh):
            yield 1 - part.args[0] ** 2


def _zeros(expression: Any) -> list[float]:
    """Its real zeros."""
    import sympy

    r = stretch()
    if expression.is_polynomial(r):
        zeros = sympy.Poly(expression, r).sqf_part().nroots()
        return [float(x) for x in zeros if x.is_real]
    function = sympy.lambdify(r, expression, modules="numpy")
    grid = np.linspace(-FARTHEST, FARTHEST, POINTS)
    with np.errstate(all="ignore"):
        values = np.broadcast_to(function(grid), grid.shape)
        changes = np.flatnonzero(values[:-1] * values[1:] < 0)
        return [_bisected(function, grid[i], grid[i + 1]) for i in changes]


def _bisected(function: Any, low: float, high: float) -> float:
    sign = np.sign(function(low))
    for _ in range(STEPS):
        middle = (low + high) / 2
        if np.sign(function(middle)) == sign:
            low = middle
        else:
            high = middle
    return float((low + high) / 2)
