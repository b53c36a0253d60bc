"""Which harmonics a torus needs: the fall-off of its coefficients, and what fits into memory."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from symfpu.numbers.arithmetic import Numbers
from symfpu.refinement.lattice import OVERSAMPLING, Floats, Ints, canonical_signs

Harmonic = tuple[int, ...]

SMALLEST_KEPT = 1e-18  # of the largest coefficient: smaller ones of a guess are left out
LARGEST_GRID = 60_000_000  # values of the functions; arrays of 480 MB
MOST_HARMONICS = 40_000


def unit_harmonics(s: int) -> list[tuple[int, ...]]:
    """e_1 .. e_s."""
    return [tuple(row) for row in np.eye(s, dtype=np.int64).tolist()]


def by_harmonic(harmonics: Ints, coefficients: Numbers) -> dict[Harmonic, Numbers]:
    """Coefficients (C,) by harmonic, the first number that is not 0 positive."""
    rows = map(tuple, canonical_signs(harmonics).tolist())
    return dict(zip(rows, coefficients, strict=True))


def coefficients_at(harmonics: Ints, known: Mapping[Harmonic, Numbers]) -> Numbers:
    """Those that are known by harmonic, 0 of others; (H, C)."""
    nothing = 0 * next(iter(known.values()))
    rows = map(tuple, canonical_signs(harmonics).tolist())
    return np.array([known.get(nu, nothing) for nu in rows])


def known_rows(harmonics: Ints, cosines: Floats) -> dict[Harmonic, Floats]:
    """Coefficients in doubles by harmonic, a small part left out."""
    least = SMALLEST_KEPT * np.abs(cosines).max()
    kept = np.abs(cosines).max(axis=1) > least
    return by_harmonic(harmonics[kept], cosines[kept])


def chosen_harmonics(
    known: Mapping[tuple[int, ...], Floats],
    functions: int,
    s: int,
    tolerance: float,
    most: int = MOST_HARMONICS,
) -> tuple[Ints, bool]:
    """Harmonics whose coefficients are expected above the tolerance.

    The second result says whether more would not fit.

    functions : of the angles, those of half of the bonds, or the one of a ring's waves. most : of
    the harmonics.
    """
    size = {nu: float(np.abs(row).max()) for nu, row in known.items()}
    largest = max(size.values())
    heights = {
        nu: float(np.log(x / largest)) for nu, x in size.items() if x > 1e-16 * largest
    }
    return within_reach(heights, functions, s, float(-np.log(tolerance)), most)


def within_reach(
    heights: Mapping[tuple[int, ...], float],
    functions: int,
    s: int,
    depth: float,
    most: int = MOST_HARMONICS,
) -> tuple[Ints, bool]:
    """Harmonics whose heights are expected above -depth, and whether more would not fit.

    heights : ln |c[nu]| relative to the largest. They are fitted by a - sum w_i |nu_i|; all
    harmonics within the reach of the fit are taken, one of each pair +-nu. most : of them.
    """
    table = np.array([[1, *(-abs(n) for n in nu)] for nu in heights], dtype=float)
    logarithms = np.array(list(heights.values()))
    determined = len(heights) > s + 1
    solution = np.full(s + 1, 3.0)
    if determined:
        solution = np.linalg.lstsq(table, logarithms, rcond=None)[0]
    weights = np.clip(solution[1:], 0.2, 12.0)
    above = logarithms - table[:, 1:] @ weights
    offset = float(np.quantile(above, 0.98)) if determined else 0.0
    reach = max(depth + max(offset, 0.0), 3.5 * weights.max())
    full = False
    while not _fits(weights, reach, functions, most):
        reach, full = 0.95 * reach, True
    inside = _inside(tuple(weights.tolist()), reach)
    chosen = sorted({*inside, *unit_harmonics(s)})
    return np.array(chosen, dtype=np.int64), full


def _fits(weights: Floats, reach: float, functions: int, most: int) -> bool:
    """Whether the harmonics fit, and so many functions on the points of their lattice.

    The lattice has about twice as many points as the cross-polytope of harmonics.
    """
    s = len(weights)
    polytope = float(np.prod(2 * reach / weights + 1)) / math.factorial(s)
    points = 1.2 * OVERSAMPLING**s / 2**s * polytope
    return bool(points * functions <= LARGEST_GRID and polytope / 2 <= most)


def _inside(
    weights: tuple[float, ...], reach: float, *, positive: bool = True
) -> Iterator[tuple[int, ...]]:
    """All harmonics with sum w_i |nu_i| <= reach, the first number that is not 0 positive."""
    top = int(reach / weights[0])
    lowest = 0 if positive else -top
    for n in range(lowest, top + 1):
        if len(weights) == 1:
            yield (n,)
            continue
        rest = reach - weights[0] * abs(n)
        for others in _inside(weights[1:], rest, positive=positive and n == 0):
            yield n, *others
