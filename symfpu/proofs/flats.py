"""The flats that decide the propagation rule for every N: enumerated, each with one seed set.

In x = q/N, whether a signed sum of seeds meets a multiple of 2N is whether x lies on a hyperplane
m.x = 2w. Order k asks this of sums of up to 2d seeds, d = k + 1 (alpha) or 2k + 1 (beta), of even
sums alone in beta. A flat is an intersection of such hyperplanes with 0 < x_1 < ... < x_s < 1
(docs/propagation.md). Its representative is the point of smallest N that lies on no hyperplane
but those that hold the whole flat.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, product
from math import gcd, lcm
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.errors import SymfpuError
from symfpu.files.progress import Progress, unheard

Ints = NDArray[np.int64]
Row = tuple[int, ...]  # m_1, ..., m_s, c of m.x = c
MOST_SEEDS = 3  # of which the flats can be enumerated
LONGEST = 400  # bonds among which representatives are sought
CANDIDATES = 1 << 20  # points looked at together
DIGIT = 1 << 12  # above every denominator of a point


@dataclass(frozen=True, slots=True)
class Flat:
    """A flat by its representative: N, the seeds, and the dimension."""

    N: int
    seeds: tuple[int, ...]
    dimension: int


def degree_of(model: str, order: int) -> int:
    """The number of leaves of a term of this order: k + 1 (alpha), 2k + 1 (beta)."""
    return order + 1 if model == "alpha" else 2 * order + 1


def hyperplanes(model: str, s: int, order: int) -> list[Row]:
    """All m.x = 2w that meet the simplex, |m| up to 2d, in lowest terms, ascending."""
    most = 2 * degree_of(model, order)
    step = 1 if model == "alpha" else 2
    found = set()
    for m in product(range(-most, most + 1), repeat=s):
        size = sum(map(abs, m))
        if size % step or not 0 < size <= most:
            continue
        # at the corners (0, .., 0, 1, .., 1) of the simplex
        corners = [sum(m[i:]) for i in range(s + 1)]
        for w in range(-most, most + 1):
            if min(corners) < 2 * w < max(corners):
                found.add(lowest_terms((*m, 2 * w)))
    return sorted(found)


def lowest_terms(row: Sequence[int]) -> Row:
    """The same equation, divided by what its numbers share, the first of them positive."""
    shared = gcd(*row)
    sign = 1 if next(c for c in row if c) > 0 else -1
    return tuple(sign * c // shared for c in row)


class Arrangement:
    """The hyperplanes of a model, a number of seeds and an order, as arrays."""

    def __init__(self, model: str, s: int, order: int) -> None:
        self.s = s
        self.rows = hyperplanes(model, s, order)
        table = np.array(self.rows, dtype=np.int64).reshape(-1, s + 1)
        self.normals, self.values = table[:, :s], table[:, s]

    def through(self, N: int, seeds: Ints) -> NDArray[np.bool_]:
        """Which hyperplanes hold the points seeds / N: a row for each point."""
        met: NDArray[np.bool_] = seeds @ self.normals.T == N * self.values
        return met

    def equations(self, N: int, seeds: Sequence[int]) -> list[Row]:
        """Independent equations of the flat of seeds / N, the simplest first."""
        met = self.through(N, np.array([seeds]))[0]
        rows = [row for row, holds in zip(self.rows, met, strict=True) if holds]
        chosen: list[Row] = []
        for row in sorted(rows, key=_simplicity):
            if rank([*chosen, row]) > len(chosen):
                chosen.append(row)
        return chosen


def _simplicity(row: Row) -> tuple[int, Any]:
    return sum(map(abs, row)), row


def rank(rows: Sequence[Row]) -> int:
    """Of the normals of these equations."""
    left = [[Fraction(c) for c in row[:-1]] for row in rows]
    count = 0
    while left:
        pivot = left.pop()
        column = next((i for i, c in enumerate(pivot) if c), None)
        if column is None:
            continue
        count += 1
        for row in left:
            factor = row[column] / pivot[column]
            row[:] = [a - factor * b for a, b in zip(row, pivot, strict=True)]
    return count


@dataclass(frozen=True)
class Line:
    """The points (start + t direction) / scale."""

    start: Row
    direction: Row
    scale: int


def line_of(rows: Sequence[Row], s: int) -> Line | None:
    """The line of s - 1 equations; None where they are not independent."""
    left = [[Fraction(c) for c in row] for row in rows]
    solved: dict[int, list[Fraction]] = {}
    for row in left:
        for column, known in solved.items():
            factor = row[column]
            row[:] = [a - factor * b for a, b in zip(row, known, strict=True)]
        pivot = next((i for i in range(s) if row[i]), None)
        if pivot is None:
            return None
        row[:] = [c / row[pivot] for c in row]
        for known in solved.values():
            factor = known[pivot]
            known[:] = [a - factor * b for a, b in zip(known, row, strict=True)]
        solved[pivot] = row
    free = next(i for i in range(s) if i not in solved)
    start = [solved[i][s] if i in solved else Fraction(0) for i in range(s)]
    slope = [-solved[i][free] if i in solved else Fraction(1) for i in range(s)]
    scale = lcm(*(c.denominator for c in (*start, *slope)))
    return Line(
        tuple(int(c * scale) for c in start), tuple(int(c * scale) for c in slope), scale
    )


def crosses(line: Line) -> bool:
    """Whether the line meets the open simplex 0 < x_1 < ... < x_s < 1."""
    starts = (0, *line.start, line.scale)
    slopes = (0, *line.direction, 0)
    lowest: Fraction | None = None
    highest: Fraction | None = None
    for i in range(len(starts) - 1):
        gap, slope = starts[i + 1] - starts[i], slopes[i + 1] - slopes[i]
        if slope == 0:
            if gap <= 0:
                return False
            continue
        bound = Fraction(-gap, slope)
        if slope > 0:
            lowest = bound if lowest is None else max(lowest, bound)
        else:
            highest = bound if highest is None else min(highest, bound)
    return lowest is None or highest is None or lowest < highest


def wide_flats(arrangement: Arrangement) -> dict[bytes, tuple[int, Line | None]]:
    """Flats of dimension one and more, by the hyperplanes that hold them.

    With their dimension, and the line where that is one.
    """
    s = arrangement.s
    none = np.zeros(len(arrangement.rows), dtype=np.bool_)
    found: dict[bytes, tuple[int, Line | None]] = {}
    for dimension in range(s, 1, -1):
        for chosen in combinations(range(len(none)), s - dimension):
            holds = none.copy()
            holds[list(chosen)] = True
            found[_key(holds)] = dimension, None
    for rows in combinations(arrangement.rows, s - 1):
        line = line_of(rows, s)
        if line is None or not crosses(line):
            continue
        start, direction = np.array(line.start), np.array(line.direction)
        holds = arrangement.normals @ start == line.scale * arrangement.values
        holds &= arrangement.normals @ direction == 0
        found.setdefault(_key(holds), (1, line))
    return found


def _key(holds: NDArray[np.bool_]) -> bytes:
    return np.packbits(holds).tobytes()


def points_on(arrangement: Arrangement, line: Line) -> Ints:
    """The points of the simplex in which hyperplanes meet a line, as rows q_1 .. q_s, N."""
    start, direction = np.array(line.start), np.array(line.direction)
    slope = arrangement.normals @ direction
    crossing = slope != 0
    slope = slope[crossing]
    normals, values = arrangement.normals[crossing], arrangement.values[crossing]
    rise = line.scale * values - normals @ start
    sign = np.sign(slope)[:, None]
    places = (start * slope[:, None] + direction * rise[:, None]) * sign
    return reduced_points(places, np.abs(slope) * line.scale)


def reduced_points(places: Ints, N: Ints) -> Ints:
    """Those of the points places / N that lie in the simplex, as rows q_1 .. q_s, N."""
    table = np.concatenate([places, N[:, None]], axis=1)
    grows = np.diff(table, axis=1).min(axis=1) > 0
    table = table[grows & (table[:, 0] > 0)]
    reduced: Ints = table // np.gcd.reduce(table, axis=1)[:, None]
    return reduced


def keys_of(table: Ints) -> Ints:
    """Rows q_1 .. q_s, N as single numbers: ascending by N, then by seeds."""
    if table.size and table.max() >= DIGIT:
        raise SymfpuError(f"a point of denominator {table.max()}; take a lower order")
    keys: Ints = table @ _weights(table.shape[1])
    return keys


def rows_of(keys: Ints, width: int) -> Ints:
    """What `keys_of` was given."""
    rows: Ints = keys[:, None] // _weights(width) % DIGIT
    return rows


def _weights(width: int) -> Ints:
    seeds = DIGIT ** np.arange(width - 2, -1, -1)
    return np.append(seeds, DIGIT ** (width - 1))


def points(arrangement: Arrangement, found_lines: Sequence[Line], told: Progress) -> Ints:
    """All flats of dimension zero as keys, each once, ascending."""
    keys = np.zeros(0, dtype=np.int64)
    fresh: list[Ints] = []
    for i, line in enumerate(found_lines):
        fresh.append(np.unique(keys_of(points_on(arrangement, line))))
        if i % 1000 == 999:
            keys, fresh = np.unique(np.concatenate([keys, *fresh])), []
            told("points of the arrangement", i / len(found_lines))
    found: Ints = np.unique(np.concatenate([keys, *fresh]))
    return found


def points_between(found_lines: Sequence[Line], vertices: Ints, told: Progress) -> Ints:
    """For each line the key of the first point in it that is no vertex of the arrangement.

    Such a point lies on no hyperplane but those that hold the line.
    """
    table = np.array([(*line.start, *line.direction, line.scale) for line in found_lines])
    chosen = np.zeros(len(table), dtype=np.int64)
    for N in range(2, LONGEST):
        left = np.flatnonzero(chosen == 0)
        if not left.size:
            return chosen
        for block in np.array_split(left, 1 + left.size * N // CANDIDATES):
            chosen[block] = _first_of_length(N, table[block], vertices)
        told("seed sets in general position", 1 - left.size / len(table))
    raise SymfpuError(f"no seed sets for {np.sum(chosen == 0)} lines below N = {LONGEST}")


def _first_of_length(N: int, table: Ints, vertices: Ints) -> Ints:
    """The least key of a point with these N bonds that is no vertex, line by line; 0 for none."""
    s = table.shape[1] // 2
    starts, directions, scale = table[:, :s], table[:, s : 2 * s], table[:, 2 * s]
    # the one coordinate that is free is that of the parameter
    numbers = np.arange(1, N)
    places = N * starts[:, None] + numbers[:, None] * directions[:, None]
    whole = (places % scale[:, None, None] == 0).all(axis=2)
    lines, rows = np.nonzero(whole)
    seeds = places[lines, rows] // scale[lines, None]
    ends = np.zeros(len(seeds), dtype=np.int64)
    chain = np.column_stack([ends, seeds, ends + N])
    inside = (np.diff(chain, axis=1) > 0).all(axis=1)
    lines, chain = lines[inside], chain[inside, 1:]
    chain //= np.gcd.reduce(chain, axis=1)[:, None]
    keys = keys_of(chain)
    general = ~_among(keys, vertices)
    none = np.iinfo(np.int64).max
    least = np.full(len(table), none)
    np.minimum.at(least, lines[general], keys[general])
    found: Ints = np.where(least == none, 0, least)
    return found


def _among(keys: Ints, ascending: Ints) -> NDArray[np.bool_]:
    """Which keys stand in an ascending list."""
    if not ascending.size:
        return np.zeros(len(keys), dtype=np.bool_)
    place = np.searchsorted(ascending, keys)
    known: NDArray[np.bool_] = ascending[np.minimum(place, len(ascending) - 1)] == keys
    return known


def representatives(
    arrangement: Arrangement, wide: Mapping[bytes, int], told: Progress
) -> list[Flat]:
    """The seed set of smallest N in each flat of dimension two and more."""
    s, found = arrangement.s, dict[bytes, Flat]()
    width = len(arrangement.rows)
    for N in range(s + 1, LONGEST):
        if len(found) == len(wide):
            return list(found.values())
        seeds = np.array(list(combinations(range(1, N), s)), dtype=np.int64)
        for block in np.array_split(seeds, 1 + seeds.size * width // CANDIDATES):
            packed = np.packbits(arrangement.through(N, block), axis=1)
            for row, holds in zip(block.tolist(), packed, strict=True):
                key = holds.tobytes()
                if key in wide and key not in found:
                    found[key] = Flat(N, tuple(row), wide[key])
        told("seed sets in general position", len(found) / len(wide))
    raise SymfpuError(
        f"no seed sets for {len(wide) - len(found)} flats below N = {LONGEST}"
    )


def flats(model: str, s: int, order: int, progress: Progress | None = None) -> list[Flat]:
    """All flats, by falling dimension, then N and seeds; the first is the whole simplex.

    >>> len(flats("alpha", 2, 1)), flats("alpha", 1, 1)[:2]
    (28, [Flat(N=3, seeds=(1,), dimension=1), Flat(N=2, seeds=(1,), dimension=0)])
    """
    told = progress or unheard
    arrangement = Arrangement(model, s, order)
    wide = wide_flats(arrangement)
    lines = [line for _, line in wide.values() if line]
    wider = {key: dimension for key, (dimension, line) in wide.items() if not line}
    vertices = points(arrangement, lines, told)
    found = representatives(arrangement, wider, told)
    found.sort(key=lambda flat: (-flat.dimension, flat.N, flat.seeds))
    between = np.sort(points_between(lines, vertices, told))
    return [*found, *_flats_at(between, s, 1), *_flats_at(vertices, s, 0)]


def _flats_at(keys: Ints, s: int, dimension: int) -> list[Flat]:
    rows = rows_of(keys, s + 1).tolist()
    return [Flat(row[-1], tuple(row[:-1]), dimension) for row in rows]
