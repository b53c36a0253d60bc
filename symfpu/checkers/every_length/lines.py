"""Lines in which hyperplanes m.x = c meet, and the points on them."""

from collections.abc import Iterator
from fractions import Fraction
from itertools import combinations
from math import gcd
from operator import mul
from typing import NamedTuple

from symfpu.checkers.every_length.claim import Row, Theorem
from symfpu.checkers.reading import need


class Line(NamedTuple):
    """The points (start + t direction) / scale."""

    start: Row
    scale: int
    direction: Row


def lines(claim: Theorem, rows: list[Row]) -> Iterator[Line]:
    """The flats of dimension one."""
    if claim.s == 1:
        yield Line((0,), 1, (1,))
    if claim.s == 2:
        for a, b, c in rows:
            yield Line((c, 0), a, (-b, a)) if a else Line((0, c), b, (1, 0))
    if claim.s == 3:
        for line in sorted(common_lines(rows)):
            if meets_simplex(line):
                yield line


def common_lines(rows: list[Row]) -> set[Line]:
    """In which two planes meet, each once: one point on it is in lowest terms, as its direction."""
    found = set()
    for first, second in combinations(rows, 2):
        direction = cross(first, second)
        if any(direction):
            start, scale = common_point(first, second, direction)
            shared = gcd(scale, *start)
            point = tuple(c // shared for c in start)
            found.add(Line(point, scale // shared, lowest(direction)))
    return found


def cross(a: Row, b: Row) -> Row:
    """Of two normals."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def common_point(a: Row, b: Row, direction: Row) -> tuple[Row, int]:
    """A point of both planes, as integers over a scale: one coordinate is zero."""
    zero = next(i for i in range(3) if direction[i])
    i, j = (zero + 1) % 3, (zero + 2) % 3
    point = [0, 0, 0]
    point[i] = a[3] * b[j] - b[3] * a[j]
    point[j] = a[i] * b[3] - b[i] * a[3]
    scale = direction[zero]
    if scale < 0:
        return tuple(-c for c in point), -scale
    return tuple(point), scale


def meets_simplex(line: Line) -> bool:
    """Whether a line meets 0 < x_1 < .. < x_s < 1: all gaps are positive at some t."""
    bounds = room(line)
    return bounds is not None and bounds[0] < bounds[1]


def room(line: Line) -> tuple[Fraction, Fraction] | None:
    """Between which t all gaps of 0 < x_1 < .. < x_s < 1 are open; None where one never is."""
    ends, slopes = (0, *line.start, line.scale), (0, *line.direction, 0)
    low: list[Fraction] = []
    high: list[Fraction] = []
    for i in range(len(ends) - 1):
        gap, slope = ends[i + 1] - ends[i], slopes[i + 1] - slopes[i]
        if slope == 0 and gap <= 0:
            return None
        if slope:
            (low if slope > 0 else high).append(Fraction(-gap, slope))
    return max(low), min(high)


def line_mask(rows: list[Row], line: Line) -> int:
    """Which hyperplanes hold a line, as bits."""
    bits = 0
    for i, row in enumerate(rows):
        if dot(row, line.direction) == 0 and dot(row, line.start) == row[-1] * line.scale:
            bits |= 1 << i
    return bits


def points_on_line(rows: list[Row], line: Line) -> list[Row]:
    """Where it enters the simplex, meets hyperplanes that do not hold it, and leaves: N, seeds."""
    bounds = room(line)
    need(bounds, "a hyperplane beside the simplex")
    assert bounds is not None
    low, high = bounds
    met = {low, high}
    start, scale, direction = line
    for row in rows:
        slope = sum(map(mul, row, direction))
        if slope:
            rise = row[-1] * scale - sum(map(mul, row, start))
            if slope < 0:
                slope, rise = -slope, -rise
            after = low.numerator * slope < rise * low.denominator
            if after and rise * high.denominator < high.numerator * slope:
                met.add(Fraction(rise, slope))
    return [place_at(line, t) for t in sorted(met)]


def place_at(line: Line, t: Fraction) -> Row:
    """The point of a parameter as N and seeds, in lowest terms."""
    rise, slope = t.as_integer_ratio()
    place = [q * slope + v * rise for q, v in zip(line.start, line.direction, strict=True)]
    shared = gcd(line.scale * slope, *place)
    return (line.scale * slope // shared, *(c // shared for c in place))


def lowest(row: Row) -> Row:
    """In lowest terms, the first number that is not zero positive."""
    shared = gcd(*row)
    if next(filter(None, row)) < 0:
        shared = -shared
    return tuple(c // shared for c in row)


def dot(m: Row, v: Row) -> int:
    """Of the normal of a row with a vector: a value at the end of the row is left out."""
    return sum(map(mul, m, v))
