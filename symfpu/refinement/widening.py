"""Which harmonics a torus of several angles needs: those that its own drive the most.

A polytope of harmonics grows as the power s of its reach, and holds mostly what is too small to
matter. Here the choice follows sizes: the forces of a torus on the harmonics beside its own
(`symfpu.refinement.lattice.neighbours`) say which to take next, and which of its own to leave out.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import (
    Floats,
    Ints,
    Lattice,
    beside,
    places_of,
    without_opposites,
)

# of the number of harmonics from one choice to the next, at most: with more, those of large
# forces beyond the candidates would be left out for candidates of small ones. And at least
GROWTH, LEAST_GROWTH = 1.5, 1.25
APART = 3  # times as many harmonics of the largest forces are told apart
# harmonics of the slopes that lead to candidates, at most; coefficients of all candidates, about;
# and candidates that are weighed at once
MOST_STEPS, MOST_COEFFICIENTS, PORTION = 40, 10_000_000, 1000
# of divisors, in squares of linear frequencies, above which force / divisor is a guess of a
# coefficient. Nearer to a resonance a harmonic weighs its force alone: taken for what it might
# move it comes into choices that are too coarse to hold it, and carries the torus away
RESONANT = 1e-3


class Widened(NamedTuple):
    """A choice of harmonics with a guess of their coefficients.

    harmonics : the nu, (H, s). cosines : (H, C), long doubles. full : whether more were wanted than
    allowed. apart : harmonics of both signs that the lattice is to tell apart, where they are not
    those of `told_apart`.
    """

    harmonics: Ints
    cosines: Floats
    full: bool
    apart: Ints | None = None


def widened(
    equation: InvarianceEquation,
    cosines: Floats,
    shifts: Floats,
    tolerance: float,
    most: int,
) -> Widened:
    """The harmonics that matter most to a torus among its own and those beside them.

    cosines, shifts : a solution of the equation, (H, C) and (s,). tolerance : of the residual,
    relative to the largest acceleration, which is the sum of what is left out. most : of harmonics.
    """
    grid = _candidates(equation, cosines)
    candidates = grid.harmonics
    own = places_of(equation.harmonics, candidates)
    known = np.zeros((len(candidates), cosines.shape[1]))
    known[own] = cosines
    forces = equation.force_on(grid, known)
    del known
    omega = equation.seed_frequencies + shifts
    weights = _weights(equation, cosines, omega, candidates, forces)
    weights[own[equation.seed_rows]] = np.inf
    order = np.argsort(-weights, kind="stable")
    wanted = _count(weights[order], len(equation.harmonics), tolerance)
    count = min(wanted, most)
    chosen, apart = np.sort(order[:count]), candidates[order[: APART * count]]
    guess = _driven(equation, candidates[chosen], forces[chosen], omega)
    _, at, kept = np.intersect1d(chosen, own, return_indices=True)
    guess[at] = cosines[kept]
    both = np.concatenate([apart, -apart[(apart != 0).any(axis=1)]])
    return Widened(candidates[chosen], guess, wanted > most, both)


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
