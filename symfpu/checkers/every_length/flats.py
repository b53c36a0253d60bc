"""The flats of a certificate are those there are, each named by its first seed set."""

from fractions import Fraction
from itertools import combinations, pairwise

from symfpu.checkers.every_length.arrangement import Arrangement, held, on_all
from symfpu.checkers.every_length.claim import LARGEST_N, Row
from symfpu.checkers.every_length.lines import place_at
from symfpu.checkers.reading import CertificateError, need


def check_flats(found: Arrangement, listed: list[Row], count: int) -> list[int]:
    """There are so many flats, and those listed are among them; returns their dimensions.

    A wide one is listed by its first seed set, of the fewest bonds.
    """
    there_are = len(found.wide) + len(found.points)
    need(count == there_are, f"there are {there_are} flats")
    dimensions = []
    for flat in listed:
        if flat in found.points:
            dimensions.append(0)
            continue
        mask = held(found.rows, flat)
        need(mask in found.wide, f"a representative of no flat: {flat}")
        first = first_on(found, mask)
        need(flat == first, f"the first seed set of its flat is {first}, not {flat}")
        dimensions.append(dimension(found, mask))
    return dimensions


def dimension(found: Arrangement, mask: int) -> int:
    """Of a flat that is no point."""
    if mask in found.lines:
        return 1
    s = len(found.rows[0]) - 1
    return s if mask == 0 else s - 1


def first_on(found: Arrangement, mask: int) -> Row:
    """The seed set of fewest bonds, and of those the least, on these hyperplanes alone."""
    for N in range(2, LARGEST_N):
        for flat in seed_sets_on(found, mask, N):
            if held(found.rows, flat) == mask:
                return flat
    raise CertificateError("a flat without a seed set")


def seed_sets_on(found: Arrangement, mask: int, N: int) -> list[Row]:
    """Those of N bonds, ascending: on a line one coordinate gives the others."""
    if mask not in found.lines:
        every = combinations(range(1, N), len(found.rows[0]) - 1)
        return [(N, *seeds) for seeds in every if on_all(found.rows, mask, (N, *seeds))]
    line = found.lines[mask]
    i = next(i for i, v in enumerate(line.direction) if v)
    flats = []
    for q in range(1, N):
        t = Fraction(q * line.scale - line.start[i] * N, line.direction[i] * N)
        M, *seeds = place_at(line, t)
        if N % M == 0 and seeds[0] > 0 and all(a < b for a, b in pairwise([*seeds, M])):
            flats.append((N, *(c * N // M for c in seeds)))
    return sorted(flats)


def unlisted(found: Arrangement, listed: list[Row]) -> list[Row]:
    """A seed set of each flat of which the certificate says nothing."""
    named = {held(found.rows, flat) for flat in listed if flat not in found.points}
    wide = [place for mask, place in found.wide.items() if mask not in named]
    return wide + sorted(found.points.difference(listed))
