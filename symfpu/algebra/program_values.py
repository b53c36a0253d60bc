"""Values and derivatives of the nodes of a program: in doubles, or in any arithmetic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.program import Ints, Program

Floats = NDArray[np.float64]


def ancestors(program: Program, wanted: Ints) -> Ints:
    """The wanted nodes and all that they are made of, ascending; ZERO among them is left out."""
    from symfpu.algebra.program_loops import mark_parts  # lazy: numba takes long to import

    marked = np.zeros(program.size, dtype=np.bool_)
    marked[wanted[wanted >= 0]] = True
    terms = program.terms
    mark_parts(program.start, terms.left, terms.right, marked)
    return np.flatnonzero(marked)


def values_in_doubles(program: Program, leaves: Floats) -> Floats:
    """Values of all nodes; leaves : (symbols, points) to (nodes, points)."""
    from symfpu.algebra.program_loops import evaluate_doubles

    values = np.ones((program.size, leaves.shape[1]))
    values[program.leaves] = leaves
    terms = program.terms
    factor = terms.factor.astype(np.float64)
    evaluate_doubles(program.start, terms.left, terms.right, factor, values)
    return values


def values_in(program: Program, leaves: Sequence[Any], nodes: Ints) -> NDArray[np.object_]:
    """Values of nodes in any arithmetic that adds and multiplies, by integers too.

    leaves : (symbols,), None for those that are not needed. Returns objects in the shape of
    nodes, the integer 0 where there is no node.
    """
    values: dict[int, Any] = dict(zip(program.leaves, leaves, strict=True))
    values[0] = 1
    for node in ancestors(program, nodes).tolist():
        if node not in values:
            values[node] = _sum(program, node, values)
    found = np.zeros(nodes.size, dtype=object)
    for place, node in enumerate(nodes.ravel().tolist()):
        if node >= 0:
            found[place] = values[node]
    return found.reshape(nodes.shape)


def _sum(program: Program, node: int, values: dict[int, Any]) -> Any:
    total: Any = 0
    for left, right, factor in terms_of(program, node):
        product = values[right] if left == 0 else values[left] * values[right]
        total = total + (product if factor == 1 else factor * product)
    return total


def terms_of(program: Program, node: int) -> list[tuple[int, int, int]]:
    """Left, right and factor of the terms of a node."""
    first, end = program.start[node : node + 2].tolist()
    columns = [part.tolist() for part in program.terms.at(slice(first, end))]
    return list(zip(*columns, strict=True))


def tabled(values: Floats, nodes: Ints) -> Floats:
    """Values (nodes, points) at a table of nodes, (..., points); zero where there is no node."""
    zeros = np.zeros((1, values.shape[1]))  # the last row, which ZERO = -1 points to
    padded = np.concatenate([values, zeros])
    return np.asarray(padded[nodes])


def tangents_in_doubles(program: Program, values: Floats, leaves: Floats) -> Floats:
    """Derivatives of all nodes along one direction at each point.

    values : of all nodes, (nodes, points). leaves : the direction, (symbols, points).
    """
    from symfpu.algebra.program_loops import carry_tangents

    tangents = np.zeros_like(values)
    tangents[program.leaves] = leaves
    terms = program.terms
    factor = terms.factor.astype(np.float64)
    carry_tangents(program.start, terms.left, terms.right, factor, values, tangents)
    return tangents
