"""Harmonics as products of a leading and a trailing part, so that matrix products do the work.

With nu = (a, b), sum c[nu] e^(i nu.theta) = sum_a e^(i a.theta) (sum_b c[a, b] e^(i b.theta)):
the inner sums are slices of one table, when the trailing parts are sorted by their parity and
size. Where a slice has no coefficient it holds a zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from symfpu.algebra.grading import Ints
from symfpu.codegen.torus_program import Block
from symfpu.numbers.arithmetic import Numbers


@dataclass(frozen=True, eq=False)
class Slice:
    """The inner sum of one leading part.

    start : the first trailing part. coefficients : (n, M), of it and those that follow.
    """

    leading: int
    start: int
    coefficients: Numbers


@dataclass(frozen=True, eq=False)
class Nested:
    """leading : (A, min(1, s-1)). trailing : (B, the other seeds). slices : of every block."""

    leading: Ints
    trailing: Ints
    slices: tuple[tuple[Slice, ...], ...]


def nest(blocks: Sequence[Block], seeds: tuple[int, ...]) -> Nested:
    """Arrange the blocks of a torus, one at least.

    Few leading parts and long inner sums are what matrix products are fastest at.
    """
    split = min(1, len(seeds) - 1)
    harmonics = [block.harmonics for block in blocks]
    first, others = np.hsplit(np.concatenate(harmonics), [split])
    leading = np.unique(first, axis=0)
    trailing = np.unique(others, axis=0)
    order = _by_parity(trailing, seeds[split:])
    trailing = trailing[order]
    slices = [_slices(block, leading, trailing) for block in blocks]
    return Nested(leading, trailing, tuple(slices))


def _by_parity(trailing: Ints, seeds: tuple[int, ...]) -> Ints:
    """The order by parity, then by size."""
    parity = trailing @ np.array(seeds) % 2
    size = np.abs(trailing).sum(axis=1)
    return np.lexsort((*trailing.T[::-1], size, parity))


def _slices(block: Block, leading: Ints, trailing: Ints) -> tuple[Slice, ...]:
    names = _places(leading)
    places = _places(trailing)
    split = leading.shape[1]
    groups: dict[
        int, dict[int, int]
    ] = {}  # leading part -> {trailing part: row of the block}
    for row, numbers in enumerate(block.harmonics.tolist()):
        harmonic = tuple(numbers)
        name = names[harmonic[:split]]
        place = places[harmonic[split:]]
        group = groups.setdefault(name, {})
        group[place] = row
    members = sorted(groups.items())
    return tuple(_slice(block, name, rows) for name, rows in members)


def _places(parts: Ints) -> dict[tuple[int, ...], int]:
    return {tuple(part): n for n, part in enumerate(parts.tolist())}


def _slice(block: Block, leading: int, rows: dict[int, int]) -> Slice:
    """rows : of the block, by trailing part."""
    start, end = min(rows), max(rows) + 1
    shape = end - start, len(block.modes)
    coefficients = np.zeros(shape, dtype=block.coefficients.dtype)
    for place, row in rows.items():
        at = place - start
        coefficients[at] = block.coefficients[row]
    return Slice(leading, start, coefficients)
