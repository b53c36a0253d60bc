"""The search for the harmonics of a torus: Newton's method with as many as its tolerance needs.

First those of a polytope that the fall-off of the coefficients asks for. Where that is too large,
a small polytope, and then choices that follow the forces (`symfpu.refinement.widening`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.projections.by_ends import count_points
from symfpu.errors import TorusTooLarge
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.numbers.arithmetic import mpf, text
from symfpu.numbers.long_doubles import DIGITS, rational
from symfpu.refinement.conditions import Condition
from symfpu.refinement.harmonics import chosen_harmonics, coefficients_at, known_rows
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Floats, Ints
from symfpu.refinement.memory import least_sizes, require_memory, sizes_of
from symfpu.refinement.newton import GROWTH, SETTLED, Aim, Iterate, newton
from symfpu.refinement.widening import (
    MOST_COEFFICIENTS,
    MOST_STEPS,
    Widened,
    widened,
)

MARGIN = 1e-3  # of the tolerance, to which coefficients are kept
ROUNDS = 8  # choices of a polytope
FREQUENCY_DIGITS = 25  # of those that are found, which long doubles do not fill
# harmonics of the largest polytope, and of the one that choices by forces begin with
LARGEST_POLYTOPE, FIRST_POLYTOPE = 10_000, 1500
# choices by forces, those in turn that may gain nothing, and the residual in that of the best
# before below which one gains: what is driven over a resonance comes late
WIDENINGS, PATIENCE, GAIN = 20, 3, 0.8
# on the way: accuracy of a Krylov solution, and of coefficients in the residual of the choice
# before; that of a guess is taken for so much
ROUGH_KRYLOV, ROUGH, OF_A_GUESS = 1e-7, 1e-3, 1e-3


# reasons to stop
NO_GAIN, ALL_THAT_FIT = "more harmonics change nothing and", "as many harmonics as fit"


@dataclass(frozen=True, eq=False)
class Solved:
    """The equations of some harmonics, solved.

    torus : what came of it. residual : between the points of the lattice, relative to the largest
    acceleration. doubt : why it may be no torus, empty if it is settled. failure : why there is
    none. reached : the torus of fewer harmonics, if there is one.
    """

    equation: InvarianceEquation
    found: Iterate
    torus: Any
    residual: float
    doubt: str = ""
    reached: Any = None

    @property
    def failure(self) -> str:
        return self.found.failure


class Search:
    """What a torus of one guess, its conditions and its tolerance is searched with.

    result : makes the torus of an iterate, from guess, equation, iterate and frequencies.
    """

    def __init__(
        self,
        result: Callable[..., Any],
        torus: Any,
        conditions: Sequence[Condition],
        *,
        tolerance: float,
        most: int,
        tell: Progress,
        growth: float = GROWTH,
    ) -> None:
        self.result, self.torus, self.conditions = result, torus, conditions
        self.growth = growth
        self.tolerance, self.most, self.tell = tolerance, most, tell
        self.functions = count_points(torus.chain)

    def __call__(self, known: dict[tuple[int, ...], Floats], shifts: Floats) -> Solved:
        """The torus near known coefficients by harmonic, and shifts (s,) of its frequencies."""
        allowed = min(self.most, LARGEST_POLYTOPE)
        harmonics, full = self._polytope(known, self.tolerance * MARGIN, allowed)
        if full and self.most > FIRST_POLYTOPE:
            return self._by_forces(known, shifts)
        before, reached = np.inf, None
        for attempt in range(ROUNDS):
            if attempt:
                least = self.tolerance * MARGIN / 10**attempt
                harmonics, full = self._polytope(known, least, self.most)
            choice = Widened(harmonics, _guess(known, harmonics), full)
            solved = self._solved(choice, shifts, SETTLED)
            if solved.failure or solved.residual <= self.tolerance:
                return replace(solved, reached=reached)
            if full:
                return self._doubtful(solved, self._all_that_fit)
            if solved.residual > before / 2:
                return self._doubtful(solved, NO_GAIN)
            before, shifts, reached = solved.residual, solved.found.shifts, solved.torus
            known = known_rows(harmonics, np.asarray(solved.found.cosines))
        doubt = f"the residual is {solved.residual:.2g} after {ROUNDS} choices of harmonics"
        return replace(solved, doubt=doubt)

    def _polytope(
        self, known: dict[tuple[int, ...], Floats], least: float, most: int
    ) -> tuple[Ints, bool]:
        s = len(self.torus.seeds)
        return chosen_harmonics(known, self.functions, s, least, most)

    def _by_forces(self, known: dict[tuple[int, ...], Floats], shifts: Floats) -> Solved:
        """The same from a small polytope on, or from a large one where that is too small."""
        for first in FIRST_POLYTOPE, LARGEST_POLYTOPE:
            harmonics, _ = self._polytope(known, self.tolerance * MARGIN, first)
            choice = Widened(harmonics, _guess(known, harmonics), full=False)
            solved = self._widening(choice, shifts)
            if not solved.failure or solved.reached or self.most < LARGEST_POLYTOPE:
                break
        return solved

    def _widening(self, choice: Widened, shifts: Floats) -> Solved:
        """Choices by forces from a first one on; the best met where none is enough."""
        best: Solved | None = None
        idle = 0
        for _ in range(WIDENINGS):
            before = OF_A_GUESS if best is None else best.residual
            aim = Aim(ROUGH * before, ROUGH_KRYLOV)
            try:
                solved = self._solved(choice, shifts, aim)
            except TorusTooLarge as too_large:
                if best is None:
                    raise
                return self._settled(
                    best, f"{too_large}; these {len(best.torus.harmonics)}"
                )
            if solved.failure:
                return replace(solved, reached=best and best.torus)
            if choice.full:
                return self._settled(solved, self._all_that_fit)
            if best is None or solved.residual < GAIN * best.residual:
                best, idle = solved, 0
            else:
                idle += 1
            if solved.residual <= self.tolerance or idle == PATIENCE:
                break
            choice, shifts = self._wider(solved), solved.found.shifts
        return self._settled(solved, NO_GAIN)

    def _wider(self, solved: Solved) -> Widened:
        found = solved.found
        return widened(
            solved.equation, found.cosines, found.shifts, self.tolerance, self.most
        )

    def _settled(self, solved: Solved, reason: str) -> Solved:
        """The same solved to rounding, with a doubt where the tolerance is not reached."""
        again = self._newton(solved.equation, solved.found.cosines, solved.found.shifts)
        settled = self._judged(solved.equation, again)
        if again.failure:
            return replace(settled, reached=solved.torus)
        if settled.residual <= self.tolerance:
            return settled
        return self._doubtful(settled, reason)

    def _solved(self, choice: Widened, shifts: Floats, aim: Aim) -> Solved:
        chain, harmonics = self.torus.chain, choice.harmonics
        least = least_sizes(
            chain, choice.cosines.shape[1], self.functions, harmonics, choice.apart
        )
        require_memory(least, chain)
        equation = InvarianceEquation(chain, self.torus.seeds, harmonics, choice.apart)
        self.tell(f"{len(harmonics)} harmonics, {equation.points} points", NO_FRACTION)
        start = np.where(equation.mask, choice.cosines, 0)
        sizes = sizes_of(chain, equation, start, shifts)
        if aim is not SETTLED:
            reached = (2 * MOST_STEPS + 1) * choice.cosines.size
            sizes = replace(sizes, candidates=min(reached, 2 * MOST_COEFFICIENTS))
        require_memory(sizes, chain)
        return self._judged(equation, self._newton(equation, start, shifts, aim))

    def _newton(
        self,
        equation: InvarianceEquation,
        cosines: Floats,
        shifts: Floats,
        aim: Aim = SETTLED,
    ) -> Iterate:
        return newton(
            equation,
            self.conditions,
            cosines,
            shifts,
            self.tell,
            aim=aim,
            growth=self.growth,
        )

    def _judged(self, equation: InvarianceEquation, found: Iterate) -> Solved:
        frequencies = _frequencies(self.torus.chain, self.torus.seeds, found.shifts)
        torus = self.result(self.torus, equation, found, frequencies)
        residual = float(torus.residual())
        if not found.failure:
            self.tell(f"residual {residual:.1e} between the grid points", NO_FRACTION)
        return Solved(equation, found, torus, residual)

    @property
    def _all_that_fit(self) -> str:
        return f"{ALL_THAT_FIT} (most_harmonics={self.most})"

    def _doubtful(self, solved: Solved, reason: str) -> Solved:
        """With the reason why its residual stays above the tolerance."""
        left = f"leave a residual of {solved.residual:.2g}"
        doubt = f"{reason} {left}, above the tolerance {self.tolerance:.0e}"
        return replace(solved, doubt=doubt)


def _guess(known: dict[tuple[int, ...], Floats], harmonics: Ints) -> Floats:
    """Coefficients of harmonics, 0 where none is known; (H, C) in long doubles."""
    return coefficients_at(harmonics, known).astype(np.longdouble)


def _frequencies(
    chain: Chain, seeds: Sequence[int], shifts: Floats
) -> tuple[Fraction, ...]:
    with mpmath.workdps(2 * DIGITS):
        linear = [chain.linear_frequency(q) for q in seeds]
        pairs = zip(linear, shifts, strict=True)
        found = [w + mpf(rational(shift)) for w, shift in pairs]
        return tuple(Fraction(text(omega, FREQUENCY_DIGITS)) for omega in found)
