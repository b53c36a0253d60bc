"""All flats: every intersection of hyperplanes m.x = c that meets 0 < x_1 < .. < x_s < 1."""

from itertools import combinations, islice, product
from math import gcd
from operator import mul
from typing import NamedTuple

from symfpu.checkers.every_length.claim import Row, Theorem
from symfpu.checkers.every_length.lines import (
    Line,
    line_mask,
    lines,
    lowest,
    points_on_line,
)
from symfpu.checkers.reading import CertificateError

TRIALS = 400  # pairs of places between which a general point is looked for
LARGEST_TRIAL = 64  # bonds among which it is looked for else


def hyperplanes(claim: Theorem) -> list[Row]:
    """m_1 .. m_s, c of every m.x = c between the corners of 0 < x_1 < .. < x_s < 1.

    c is even, and |m| at most twice the last degree; even in beta.
    """
    most = 2 * claim.degree(claim.order)
    found = set()
    for m in product(range(-most, most + 1), repeat=claim.s):
        size = sum(map(abs, m))
        if 0 < size <= most and (claim.model == "alpha" or size % 2 == 0):
            corners = [sum(m[claim.s - i :]) for i in range(claim.s + 1)]
            for c in range(-most, most + 1):
                if c % 2 == 0 and min(corners) < c < max(corners):
                    found.add(lowest((*m, c)))
    return sorted(found)


class Arrangement(NamedTuple):
    """All flats: the lines and other wide ones by the hyperplanes that hold them, the points.

    wide : one point on each, N and seeds, on no further hyperplane.
    """

    rows: list[Row]
    lines: dict[int, Line]
    wide: dict[int, Row]
    points: set[Row]


def arrangement(claim: Theorem) -> Arrangement:
    """Every intersection of hyperplanes that meets the open simplex, each once.

    That is the whole simplex, each hyperplane, where s = 3 each line, and the points in which
    hyperplanes meet the lines.
    """
    rows = hyperplanes(claim)
    found = Arrangement(rows, {}, {}, set())
    for line in lines(claim, rows):
        mask = line_mask(rows, line)
        places = points_on_line(rows, line)
        found.points.update(places[1:-1])
        found.lines[mask] = line
        found.wide[mask] = between(places[0], places[1])
    if claim.s == 3:
        add_planes(found)
    if claim.s > 1:
        found.wide[0] = general_point(rows, 0, list(found.wide.values()))
    return found


def add_planes(found: Arrangement) -> None:
    """Each plane, from the lines on it."""
    on_plane: dict[int, list[Row]] = {1 << i: [] for i in range(len(found.rows))}
    for mask, place in found.wide.items():
        for i in range(len(found.rows)):
            if mask >> i & 1:
                on_plane[1 << i].append(place)
    for mask, places in on_plane.items():
        found.wide[mask] = general_point(found.rows, mask, places)


def general_point(rows: list[Row], mask: int, places: list[Row]) -> Row:
    """A point on these hyperplanes and no others: between two places on them, or by trial."""
    for first, second in islice(combinations(places, 2), TRIALS):
        place = between(first, second)
        if held(rows, place) == mask:
            return place
    for N in range(2, LARGEST_TRIAL):
        for seeds in combinations(range(1, N), len(rows[0]) - 1):
            if on_all(rows, mask, (N, *seeds)) and held(rows, (N, *seeds)) == mask:
                return N, *seeds
    raise CertificateError("this checker finds no seed set in general position")


def held(rows: list[Row], flat: Row) -> int:
    """Which hyperplanes hold seeds / N, as bits."""
    N, *seeds = flat
    bits = 0
    for i, row in enumerate(rows):
        if sum(map(mul, row, seeds)) == row[-1] * N:
            bits |= 1 << i
    return bits


def on_all(rows: list[Row], mask: int, flat: Row) -> bool:
    """Whether the hyperplanes of a mask hold a point."""
    N, *seeds = flat
    return all(
        sum(map(mul, row, seeds)) == row[-1] * N
        for i, row in enumerate(rows)
        if mask >> i & 1
    )


def between(first: Row, second: Row) -> Row:
    """A point strictly between two, in lowest terms."""
    place = [a + b for a, b in zip(first, second, strict=True)]
    shared = gcd(*place)
    return tuple(c // shared for c in place)
