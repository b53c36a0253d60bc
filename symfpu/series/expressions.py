"""Tables of SymEngine expressions as a list of nodes, each after its parts and each once.

And back without executing anything.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.errors import InputError
from symfpu.numbers.typed import fraction, fraction_text, rational

Array = NDArray[Any]
COMPOUND = {"sum": se.Add, "product": se.Mul, "power": se.Pow}


class ExpressionNodes:
    """The list, and the place in it of every expression met so far."""

    def __init__(self) -> None:
        self.nodes: list[list[Any]] = []
        self._place: dict[Any, int] = {}

    def places(self, table: Array) -> Array:
        """The place of every entry of a table, row after row."""
        entries = map(se.sympify, table.ravel())
        return np.array([self._placed(entry) for entry in entries], dtype=np.int64)

    def _placed(self, expression: Any) -> int:
        stack = [expression]
        while stack:
            missing = [part for part in stack[-1].args if part not in self._place]
            if missing:
                stack += missing
                continue
            done = stack.pop()
            if done not in self._place:
                self._place[done] = len(self.nodes)
                self.nodes.append(self._node(done))
        return self._place[expression]

    def _node(self, expression: Any) -> list[Any]:
        if isinstance(expression, se.Symbol):
            return ["symbol", expression.name]
        if isinstance(expression, se.Rational):
            return ["number", fraction_text(Fraction(int(expression.p), int(expression.q)))]
        for name, kind in COMPOUND.items():
            if isinstance(expression, kind):
                return [name, *(self._place[part] for part in expression.args)]
        allowed = "sums, products and powers of symbols and rational numbers"
        raise InputError("result", f"{expression!s:.40}", allowed, "compute it again")


def expressions_of(nodes: Iterable[Sequence[Any]]) -> Array:
    """The expressions of a list of nodes, rebuilt by SymEngine's constructors."""
    made: list[Any] = []
    for kind, *parts in nodes:
        made.append(_made(kind, parts, made))
    array = np.empty(len(made), dtype=object)
    array[:] = made
    return array


def _made(kind: str, parts: Sequence[Any], made: Sequence[Any]) -> Any:
    """One expression, of parts made before."""
    if kind == "symbol":
        return se.Symbol(str(parts[0]))
    if kind == "number":
        return rational(fraction(parts[0]))
    if not all(type(part) is int and 0 <= part < len(made) for part in parts):
        raise ValueError("an expression comes before its parts")
    return COMPOUND[kind](*(made[part] for part in parts))
