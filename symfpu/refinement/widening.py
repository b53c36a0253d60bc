"""Which harmonics a torus of several angles needs: those that its own drive the most.

A polytope of harmonics grows as the power s of its reach, and holds mostly what is too small to
matter. Here the choice follows sizes: the forces of a torus on the harmonics beside its own
(`symfpu.refinement.lattice.neighbours`) say which to take next, and which of its own to leave out.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from symfpu.refinement.equation import Floats, Ints, TorusEquation
from symfpu.refinement.lattice import Lattice, beside, without_opposites

# of the number of harmonics from one choice to the next, at most: with more, those of large
# forces beyond the candidates would be left out for candidates of small ones. And at least
GROWTH, LEAST_GROWTH = 1.5, 1.25
APART = 3  # times as many harmonics of the largest forces are told apart
# of divisors, in squares of linear frequencies, above which force / divisor is a guess
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


@np.errstate(divide="ignore", invalid="ignore")
def widened(
    equation: TorusEquation,
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
    squares = equation.linear_at(candidates) ** 2
    rates = candidates @ (equation.seed_frequencies + shifts)
    divisors = rates[:, None] ** 2 - squares
    guess = np.where(np.abs(divisors) > RESONANT * squares, forces / divisors, 0)
    guess[own] = cosines
    weights = _weights(equation, cosines, shifts, forces, squares * np.abs(guess))
    weights[own[equation.seed_rows]] = np.inf
    order = np.argsort(-weights, kind="stable")
    wanted = _count(weights[order], len(equation.harmonics), tolerance)
    count = min(wanted, most)
    chosen, apart = np.sort(order[:count]), candidates[order[: APART * count]]
    both = np.concatenate([apart, -apart[(apart != 0).any(axis=1)]])
    return Widened(candidates[chosen], guess[chosen], wanted > most, both)


def _candidates(equation: TorusEquation, cosines: Floats) -> Lattice:
    """The harmonics of an equation and those that its slopes couple to them, told apart."""
    units = np.eye(equation.harmonics.shape[1], dtype=np.int64)
    steps = equation.steps(equation.slopes(cosines))
    reached = beside(equation.harmonics, np.concatenate([units, -units, steps]))
    return Lattice(without_opposites(reached), reached)


def _weights(
    equation: TorusEquation,
    cosines: Floats,
    shifts: Floats,
    forces: Floats,
    moved: Floats,
) -> Floats:
    """What leaving out a harmonic costs, relative to the largest acceleration; shape (M,).

    Its own equations miss the force on it, those of others what its motion adds to theirs: near a
    resonance a small force moves much. moved : Omega^2 |c|.
    """
    accelerations = equation.rates(shifts).astype(float) ** 2 @ np.abs(cosines)
    coupling = float(np.abs(equation.slopes(cosines)).max())
    missed = np.maximum(np.abs(forces), coupling * moved).max(axis=1)
    return np.asarray((missed / accelerations.max()).astype(float))


def _count(falling: Floats, before: int, tolerance: float) -> int:
    """How many of falling weights to take, so that the others add up to the tolerance."""
    left = np.cumsum(falling[::-1])[::-1]
    needed = int((left > tolerance).sum())
    least = int(np.ceil(LEAST_GROWTH * before))
    return min(max(needed, least), int(GROWTH * before), len(falling))


def places_of(rows: Ints, among: Ints) -> Ints:
    """Where rows stand among others, which hold them all; shape (len(rows),)."""
    places = {nu: i for i, nu in enumerate(map(tuple, among.tolist()))}
    return np.array([places[nu] for nu in map(tuple, rows.tolist())], dtype=np.int64)
