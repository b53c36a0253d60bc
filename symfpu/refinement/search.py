"""The search for the harmonics of a torus: Newton's method with as many as its tolerance needs.

First those of a polytope that the fall-off of the coefficients asks for. Where that is too large,
a small polytope, and then choices that follow the forces (`symfpu.refinement.harmonics`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import mpmath
import numpy as np

from symfpu.chain.projections.by_ends import count_points
from symfpu.errors import TorusTooLarge
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.numbers.arithmetic import mpf, text
from symfpu.numbers.long_doubles import DIGITS, rational
from symfpu.refinement.conditions import Condition
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.harmonics import (
    MOST_COEFFICIENTS,
    MOST_STEPS,
    Choice,
    Harmonic,
    adaptive_harmonics,
    chosen_harmonics,
    coefficients_at,
    known_rows,
)
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Floats
from symfpu.refinement.memory import least_sizes, require_memory, sizes_of
from symfpu.refinement.newton import (
    GROWTH,
    TIGHT,
    Iterate,
    Newton,
    Tolerances,
    newton,
)
from symfpu.refinement.resonances import near_resonances
from symfpu.tori.torus import Torus

MARGIN = 1e-3  # of the tolerance, to which coefficients are kept
ROUNDS = 8  # choices of a polytope
FREQUENCY_DIGITS = 25  # of those that are found, which long doubles do not fill
# harmonics of the largest polytope, and of the one that choices by forces begin with
LARGEST_POLYTOPE, FIRST_POLYTOPE = 10_000, 1500
# choices by forces, those in turn that may gain nothing, and the residual in that of the best
# before below which one gains: what is driven over a resonance comes late
ADAPTIONS, PATIENCE, GAIN = 20, 3, 0.8
# on the way: accuracy of a Krylov solution, and of coefficients in the residual of the choice
# before; that of a guess is taken for so much
ROUGH_KRYLOV, ROUGH, OF_A_GUESS = 1e-7, 1e-3, 1e-3
# reasons to stop
NO_GAIN, ALL_THAT_FIT = "more harmonics change nothing and", "as many harmonics as fit"


@dataclass(frozen=True, eq=False)
class Solved:
    """The equations of some harmonics, solved.

    iterate : of Newton's method. torus : the same. residual : between the points of the lattice,
    relative to the largest acceleration. warning : why it stays above the tolerance, or empty.
    fallback : the converged torus with fewer harmonics, if there is one.
    """

    equation: InvarianceEquation
    iterate: Iterate
    torus: Torus[Newton]
    residual: float
    warning: str = ""
    fallback: Torus[Newton] | None = None

    @property
    def failure(self) -> str:
        """Why Newton's method stopped, or empty."""
        return self.iterate.failure


class Search:
    """What a torus near a guess is searched with: its conditions, and the tolerance.

    most : harmonics. growth : factor by which amplitudes may change from those of the guess.
    """

    def __init__(
        self,
        guess: Torus,
        conditions: Sequence[Condition],
        *,
        tolerance: float,
        most: int,
        report: Progress,
        growth: float = GROWTH,
    ) -> None:
        self.guess, self.conditions, self.growth = guess, conditions, growth
        self.tolerance, self.most, self.report = tolerance, most, report
        self.functions = count_points(guess.chain)

    def __call__(self) -> Solved:
        """The torus near the guess."""
        known = known_rows(self.guess.harmonics, self.guess.cosines.astype(float))
        shifts, least = shifts_of(self.guess), self.tolerance * MARGIN
        choice = self._polytope(known, least, min(self.most, LARGEST_POLYTOPE))
        if choice.full and self.most > FIRST_POLYTOPE:
            return self._by_forces(known, shifts)
        before, fallback = np.inf, None
        for k in range(1, ROUNDS + 1):
            solved = self._solved(choice, shifts, TIGHT)
            if solved.failure or solved.residual <= self.tolerance:
                return replace(solved, fallback=fallback)
            if choice.full:
                return self._above_tolerance(solved, self._all_that_fit)
            if solved.residual > before / 2:
                return self._above_tolerance(solved, NO_GAIN)
            before, fallback = solved.residual, solved.torus
            shifts = solved.iterate.shifts
            known = known_rows(choice.harmonics, solved.iterate.cosines)
            choice = self._polytope(known, least / 10**k, self.most)
        left = f"the residual is {solved.residual:.2g}"
        return replace(solved, warning=f"{left} after {ROUNDS} choices of harmonics")

    def _polytope(self, known: dict[Harmonic, Floats], least: float, most: int) -> Choice:
        s = len(self.guess.seeds)
        harmonics, full = chosen_harmonics(known, self.functions, s, least, most)
        cosines = coefficients_at(harmonics, known).astype(np.longdouble)
        return Choice(harmonics, cosines, full)

    def _by_forces(self, known: dict[Harmonic, Floats], shifts: Floats) -> Solved:
        """The same from a small polytope on, or from a large one where that is too small."""
        for first in FIRST_POLYTOPE, LARGEST_POLYTOPE:
            choice = self._polytope(known, self.tolerance * MARGIN, first)
            solved = self._adapted(choice._replace(full=False), shifts)
            if not solved.failure or solved.fallback or self.most < LARGEST_POLYTOPE:
                break
        return solved

    def _adapted(self, choice: Choice, shifts: Floats) -> Solved:
        """Choices by forces from a first one on; the best met where none is enough."""
        best: Solved | None = None
        idle = 0
        for _ in range(ADAPTIONS):
            before = OF_A_GUESS if best is None else best.residual
            rough = Tolerances(ROUGH * before, ROUGH_KRYLOV)
            try:
                solved = self._solved(choice, shifts, rough)
            except TorusTooLarge as too_large:
                if best is None:
                    raise
                reason = f"{too_large}; these {len(best.torus.harmonics)}"
                return self._to_rounding(best, reason)
            if solved.failure:
                return replace(solved, fallback=best.torus if best else None)
            if choice.full:
                return self._to_rounding(solved, self._all_that_fit)
            if best is None or solved.residual < GAIN * best.residual:
                best, idle = solved, 0
            else:
                idle += 1
            if solved.residual <= self.tolerance or idle == PATIENCE:
                break
            cosines, shifts = solved.iterate.cosines, solved.iterate.shifts
            choice = adaptive_harmonics(
                solved.equation, cosines, shifts, self.tolerance, self.most
            )
        return self._to_rounding(solved, NO_GAIN)

    def _to_rounding(self, solved: Solved, reason: str) -> Solved:
        """The same solved to rounding, with a warning where the tolerance is not reached."""
        start = solved.iterate.cosines, solved.iterate.shifts
        again = self._newton(solved.equation, *start, TIGHT)
        if again.failure:
            return replace(again, fallback=solved.torus)
        if again.residual <= self.tolerance:
            return again
        return self._above_tolerance(again, reason)

    def _solved(self, choice: Choice, shifts: Floats, tolerances: Tolerances) -> Solved:
        """Of a choice; TorusTooLarge before what does not fit into memory is allocated."""
        chain, table = self.guess.chain, choice.cosines
        chosen = choice.harmonics, choice.separated
        least = least_sizes(chain, *chosen)
        require_memory(least, chain)
        equation = InvarianceEquation(chain, self.guess.seeds, *chosen)
        self.report(f"{len(table)} harmonics, {equation.points} points", NO_FRACTION)
        start = np.where(equation.mask, table, 0)
        sizes = sizes_of(least, equation, start, shifts)
        if tolerances is not TIGHT:
            reached = (2 * MOST_STEPS + 1) * table.size
            sizes = replace(sizes, candidates=min(reached, 2 * MOST_COEFFICIENTS))
        require_memory(sizes, chain)
        return self._newton(equation, start, shifts, tolerances)

    def _newton(
        self,
        equation: InvarianceEquation,
        cosines: Floats,
        shifts: Floats,
        tolerances: Tolerances,
    ) -> Solved:
        found = newton(
            equation,
            self.conditions,
            cosines,
            shifts,
            self.report,
            tolerances=tolerances,
            growth=self.growth,
        )
        torus = self._torus(equation, found)
        residual = float(torus.residual())
        if not found.failure:
            self.report(f"residual {residual:.1e} between the grid points", NO_FRACTION)
        return Solved(equation, found, torus, residual)

    def _torus(self, equation: InvarianceEquation, found: Iterate) -> Torus[Newton]:
        """Of an iterate, without harmonics of a ring in which nothing moves."""
        guess, nearest = self.guess, near_resonances(equation, found.cosines, found.shifts)
        kept = equation.mask[:, 0] if guess.travels else slice(None)
        return Torus(
            guess.chain,
            guess.seeds,
            self._frequencies(found.shifts),
            equation.harmonics[kept],
            found.cosines[kept].astype(float),
            {q: float(phi) for q, phi in guess.phases.items()},
            travels=guess.travels,
            origin=Newton(found.steps, nearest),
        )

    def _frequencies(self, shifts: Floats) -> tuple[Fraction, ...]:
        with mpmath.workdps(2 * DIGITS):
            linear = [self.guess.chain.linear_frequency(q) for q in self.guess.seeds]
            pairs = zip(linear, shifts, strict=True)
            found = [w + mpf(rational(shift)) for w, shift in pairs]
            return tuple(Fraction(text(omega, FREQUENCY_DIGITS)) for omega in found)

    @property
    def _all_that_fit(self) -> str:
        return f"{ALL_THAT_FIT} (most_harmonics={self.most})"

    def _above_tolerance(self, solved: Solved, reason: str) -> Solved:
        """With the reason why its residual stays above the tolerance."""
        left = f"leave a residual of {solved.residual:.2g}"
        warning = f"{reason} {left}, above the tolerance {self.tolerance:.0e}"
        return replace(solved, warning=warning)
