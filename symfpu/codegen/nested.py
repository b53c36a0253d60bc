"""Harmonics as products of a leading and a trailing part, so that dense matrix products do the work.

With nu = (a, b), sum c[nu] e^(i nu.theta) = sum_a e^(i a.theta) (sum_b c[a, b] e^(i b.theta)): the inner sums are slices of one table,
when the trailing parts are sorted by their parity and size. Where a slice has no coefficient it holds a zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from symfpu.algebra.grading import Ints
from symfpu.codegen.torus_program import Block, TorusProgram
from symfpu.numbers.arithmetic import Numbers


@dataclass(frozen=True, eq=False)
class Slice:
    """The inner sum of one leading part: trailing parts start .. start + len(coefficients) - 1. coefficients : (n, M)."""

    leading: int
    start: int
    coefficients: Numbers


@dataclass(frozen=True, eq=False)
class Nested:
    """leading : (A, s // 2). trailing : (B, s - s // 2). slices : for every block of the program."""

    leading: Ints
    trailing: Ints
    slices: tuple[tuple[Slice, ...], ...]


def nest(program: TorusProgram) -> Nested:
    """Arrange the blocks of a program; few leading parts and long inner sums are what matrix products are fastest at."""
    split = min(1, len(program.seeds) - 1)
    everything = np.concatenate([block.harmonics for block in program.blocks])
    leading = np.unique(everything[:, :split], axis=0)
    trailing = np.unique(everything[:, split:], axis=0)
    parity = trailing @ np.array(program.seeds[split:]) % 2
    trailing = trailing[np.lexsort((*trailing.T[::-1], np.abs(trailing).sum(axis=1), parity))]
    places = {tuple(row): n for n, row in enumerate(trailing.tolist())}
    names = {tuple(row): n for n, row in enumerate(leading.tolist())}
    return Nested(leading, trailing, tuple(tuple(_slices(block, split, names, places)) for block in program.blocks))


def _slices(block: Block, split: int, names: dict[tuple[int, ...], int], places: dict[tuple[int, ...], int]) -> list[Slice]:
    groups: dict[int, list[tuple[int, int]]] = {}
    for row, harmonic in enumerate(block.harmonics.tolist()):
        groups.setdefault(names[tuple(harmonic[:split])], []).append((places[tuple(harmonic[split:])], row))
    slices = []
    for leading, members in sorted(groups.items()):
        start, end = min(members)[0], max(members)[0] + 1
        coefficients = np.zeros((end - start, len(block.modes)), dtype=block.coefficients.dtype)
        for place, row in members:
            coefficients[place - start] = block.coefficients[row]
        slices.append(Slice(leading, start, coefficients))
    return slices
