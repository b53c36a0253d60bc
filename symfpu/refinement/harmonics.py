"""Which harmonics a torus needs: by the fall-off of its coefficients, or by its forces.

The fall-off asks for a polytope of harmonics. It grows as the power s of its reach, and of several
angles holds mostly what is too small to matter. Then the choice follows sizes: the forces of a
torus on the harmonics beside its own (`symfpu.refinement.lattice.neighbours`) say which to take
next, and which of its own to leave out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from symfpu.numbers.arithmetic import Numbers
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import (
    OVERSAMPLING,
    Floats,
    Ints,
    Lattice,
    beside,
    canonical_signs,
    places_of,
    without_opposites,
)

Harmonic = tuple[int, ...]

SMALLEST_KEPT = 1e-18  # of the largest coefficient: smaller ones of a guess are left out
LARGEST_GRID = 60_000_000  # values of the functions; arrays of 480 MB
MOST_HARMONICS = 40_000
# of the number of harmonics from one choice to the next, at most: with more, those of large
# forces beyond the candidates would be left out for candidates of small ones. And at least
GROWTH, LEAST_GROWTH = 1.5, 1.25
SEPARATED = 3  # times as many harmonics of the largest forces are told apart
# harmonics of the slopes that lead to candidates, at most; coefficients of all candidates, about;
# and candidates that are weighed at once
MOST_STEPS, MOST_COEFFICIENTS, PORTION = 40, 10_000_000, 1000
# of divisors, in squares of linear frequencies, above which force / divisor is a guess of a
# coefficient. Nearer to a resonance a harmonic weighs its force alone: taken for what it might
# move it comes into choices that are too coarse to hold it, and carries the torus away
RESONANT = 1e-3


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


class Choice(NamedTuple):
    """A choice of harmonics with a guess of their coefficients.

    harmonics : the nu, (H, s). cosines : (H, C), long doubles. full : whether more were wanted than
    allowed. separated : harmonics of both signs that the lattice is to tell apart, where they are
    not those of `alias_free_set`.
    """

    harmonics: Ints
    cosines: Floats
    full: bool
    separated: Ints | None = None


def adaptive_harmonics(
    equation: InvarianceEquation,
    cosines: Floats,
    shifts: Floats,
    tolerance: float,
    most: int,
) -> Choice:
    """The harmonics that matter most to a torus among its own and those beside them.

    cosines, shifts : a solution of the equation, (H, C) and (s,). tolerance : of the residual,
    relative to the largest acceleration, which is the sum of what is left out. most : of harmonics.
    """
    grid = _candidates(equation, cosines)
    candidates = grid.harmonics
    own = places_of(equation.harmonics, candidates)
    known = np.zeros((len(candidates), cosines.shape[1]))
    known[own] = cosines
    forces = equation.force(known, grid=grid)
    del known
    omega = equation.seed_frequencies + shifts
    weights = _weights(equation, cosines, omega, candidates, forces)
    weights[own[equation.seed_rows]] = np.inf
    order = np.argsort(-weights, kind="stable")
    wanted = _count(weights[order], len(equation.harmonics), tolerance)
    count = min(wanted, most)
    chosen, separated = np.sort(order[:count]), candidates[order[: SEPARATED * count]]
    guess = _driven(equation, candidates[chosen], forces[chosen], omega)
    _, at, kept = np.intersect1d(chosen, own, return_indices=True)
    guess[at] = cosines[kept]
    both = np.concatenate([separated, -separated[separated.any(axis=1)]])
    return Choice(candidates[chosen], guess, wanted > most, both)


@np.errstate(divide="ignore", invalid="ignore")
def _driven(
    equation: InvarianceEquation, harmonics: Ints, forces: Floats, omega: Floats
) -> Floats:
    """Coefficients that forces drive, (M, C); 0 next to a resonance."""
    squares = equation.linear_at(harmonics) ** 2
    divisors = (harmonics @ omega)[:, None] ** 2 - squares
    return np.where(np.abs(divisors) > RESONANT * squares, forces / divisors, 0)


def _candidates(equation: InvarianceEquation, cosines: Floats) -> Lattice:
    """The harmonics of an equation and those that its slopes couple to them, told apart.

    By as many harmonics of the slopes as the tables of all candidates have room for.
    """
    units = np.eye(equation.harmonics.shape[1], dtype=np.int64)
    most = max(1, MOST_COEFFICIENTS // cosines.size)
    steps = equation.steps(equation.slopes(cosines), min(most, MOST_STEPS))
    reached = beside(equation.harmonics, np.concatenate([units, -units, steps]))
    return Lattice(without_opposites(reached), reached)


def _weights(
    equation: InvarianceEquation,
    cosines: Floats,
    omega: Floats,
    candidates: Ints,
    forces: Floats,
) -> Floats:
    """What leaving out a harmonic costs, relative to the largest acceleration; shape (M,).

    Its own equations miss the force on it, those of others what its motion adds to theirs: near a
    resonance a small force moves much.
    """
    rates = (equation.harmonics @ omega).astype(float)
    largest = float((rates**2 @ np.abs(cosines)).max())
    coupling = float(np.abs(equation.slopes(cosines)).max())
    weights = np.empty(len(candidates))
    for first in range(0, len(candidates), PORTION):
        part = slice(first, first + PORTION)
        squares = equation.linear_at(candidates[part]).astype(float) ** 2
        moved = squares * np.abs(_driven(equation, candidates[part], forces[part], omega))
        missed = np.maximum(np.abs(forces[part]), coupling * moved.astype(float))
        weights[part] = missed.max(axis=1) / largest
    return weights


def _count(falling: Floats, before: int, tolerance: float) -> int:
    """How many of falling weights to take, so that the others add up to the tolerance."""
    left = np.cumsum(falling[::-1])[::-1]
    needed = int((left > tolerance).sum())
    least = int(np.ceil(LEAST_GROWTH * before))
    return min(max(needed, least), int(GROWTH * before), len(falling))
