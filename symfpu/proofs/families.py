"""Flats and their modes in words: "2 q_2 = N", "N - q_1"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

from symfpu.proofs.flats import Flat, Row, rank

TURNS = 2  # multiples of N in the name of a mode
WIDEST = 4  # seeds, counted with multiplicity, in the name of a mode


def equation_text(row: Row) -> str:
    """m.q = c N, the terms with a minus sign on the right."""
    *normal, value = row
    left = [(c, _seed(i)) for i, c in enumerate(normal) if c > 0]
    right = [(-c, _seed(i)) for i, c in enumerate(normal) if c < 0]
    (right if value > 0 else left).append((abs(value), "N"))
    return f"{_sum(left)} = {_sum(right)}"


def mode_text(mode: int, flat: Flat, equations: Sequence[Row], degree: int) -> str:
    """The mode as the shortest sum of N and seeds that equals it on the whole flat."""
    wave = next(_sums_of(mode, flat, degree, even=True))
    for width in range(WIDEST + 1):
        for row in _sums_of(mode, flat, width, even=False):
            difference = tuple(a - b for a, b in zip(wave, row, strict=True))
            if rank([*equations, difference]) == rank(equations):
                terms = [(c, _seed(i)) for i, c in enumerate(row[:-1])]
                return _sum([(row[-1], "N"), *terms])
    return str(mode)


def _sums_of(mode: int, flat: Flat, widest: int, even: bool) -> Iterator[Row]:
    """a, c with a.q + c N = mode, |a| up to the widest; c even where asked for."""
    turns = 2 * widest if even else TURNS
    for a in product(range(-widest, widest + 1), repeat=len(flat.seeds)):
        if sum(map(abs, a)) > widest:
            continue
        rest = mode - sum(n * q for n, q in zip(a, flat.seeds, strict=True))
        c, missing = divmod(rest, flat.N)
        if not missing and abs(c) <= turns and not (even and c % 2):
            yield (*a, c)


def _seed(i: int) -> str:
    return f"q_{i + 1}"


def _sum(terms: Sequence[tuple[int, str]]) -> str:
    """The terms with their signs, a positive one first; 0 where there is none."""
    text = ""
    for c, name in sorted(terms, key=lambda term: -term[0]):
        if c:
            sign = (" + " if c > 0 else " - ") if text else "-" * (c < 0)
            size = "" if abs(c) == 1 else f"{abs(c)} "
            text += sign + size + name
    return text or "0"
