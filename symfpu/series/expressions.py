"""Expressions out of a list of nodes, each after its parts: how files of version 0.1 keep them.

Nothing is executed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.numbers.typed import fraction, rational

Array = NDArray[Any]
COMPOUND = {"sum": se.Add, "product": se.Mul, "power": se.Pow}


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
