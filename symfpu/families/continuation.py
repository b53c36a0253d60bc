"""Families of tori by pseudo-arclength continuation from the linear limit.

A family keeps the ratio of its amplitudes or mode energies. Its way is measured in the variables
(ln |A|, shift / scale) of the seeds, scale the shift where the step begins: from one member a step
goes along the secant of the last two and Newton's method returns to the family in the plane across
it, so that a turn of the energy or of a frequency is passed like any other point. A torus is taken
if all its coefficients and its tangent continue the members before it (`symfpu.families.whole`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from symfpu.families.members import Level, linear_by_mode
from symfpu.families.whole import Whole, require_one_curve, whole
from symfpu.files.progress import Progress
from symfpu.refinement.conditions import Condition, plane, ratio_conditions
from symfpu.refinement.guesses import extrapolated, shifts_of
from symfpu.refinement.lattice import Floats
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import NoTorus, refined_torus
from symfpu.tori.torus import Torus

FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.3, 0.6, 1e-3  # along the way
# the smallest from a doubtful member: near a saddle such ones crawl on without end
DOUBTFUL_STEP = 0.05
EASY_STEPS = 4  # Newton steps up to which the next step along the way is longer
FACTOR = 1.3  # by how much
KEPT_SCALE = (
    0.3  # of the largest shift so far, below which the unit of shifts does not fall
)
# distance from the predicted point, in steps, beyond which a member belongs to another family
DISTANCE_LIMIT = 0.5
RESIDUAL_LIMIT = 1e-6  # residual beyond which a torus is no member
GOAL_HALVINGS = 8  # of a step that passes the energy asked for
OVERHANG = (
    1e-6  # of the distance of two tori, by which one between them may seem to lie outside
)


class Way:
    """The last two tori of a family, and steps from them."""

    def __init__(
        self,
        ratio: Mapping[int, float],
        *,
        energies: bool,
        tolerance: float,
        progress: Progress | None,
        tori: Sequence[Torus[Newton]],
        step: float,
        largest: float = 0.0,
    ) -> None:
        self.ratio, self.energies = ratio, energies
        self.tolerance, self.progress = tolerance, progress
        self.tori, self.step = list(tori), step
        self.largest = largest  # relative shift so far
        self._known: dict[int, Whole] = {}  # by id of the torus

    def local(self, *tori: Torus[Newton]) -> Way:
        """The same family from other tori, to look between members."""
        other = Way(
            self.ratio,
            energies=self.energies,
            tolerance=self.tolerance,
            progress=self.progress,
            tori=tori,
            step=self.step,
            largest=self.largest,
        )
        other._known = self._known
        return other

    def scales(self) -> Floats:
        """A size for the shifts of all seeds that vanishes with none of them.

        The largest relative one, not far below any before.
        """
        torus = self.tori[0]
        linear = np.array(list(linear_by_mode(torus.chain, torus.seeds).values()))
        shifts = [np.abs(shifts_of(torus)).astype(float) for torus in self.tori[-2:]]
        relative = [float(np.max(shift / linear)) for shift in shifts]
        self.largest = max(self.largest, *relative)
        size = max(relative[-1], KEPT_SCALE * self.largest)
        return np.asarray(size * linear)

    def _conditions(self, first: Condition) -> list[Condition]:
        """A condition, and the ratio that the family keeps."""
        ratio = ratio_conditions(tuple(self.ratio), self.ratio, energies=self.energies)
        return [first, *ratio]

    def variables(self, torus: Torus[Newton], scales: Floats) -> Floats:
        """Where a torus is, (ln |A| of the seeds, shifts in units of scales), shape (2s,)."""
        A = np.array([np.longdouble(abs(a)) for a in torus.amplitudes.values()])
        shifts = shifts_of(torus) / scales
        return np.concatenate([np.log(A), shifts])

    def at(self, distance: float) -> Torus[Newton]:
        """The torus at this length of way from the last one, along the secant; raises NoTorus.

        A negative length leads back to the one before.
        """
        before, last = self.tori[-2:]
        x, tangent, scales, length = self._secant()
        guess = extrapolated(before, last, distance / length)
        conditions = self._conditions(plane(x, tangent, scales, distance))
        found = refined_torus(
            guess, conditions, tolerance=self.tolerance, progress=self.progress
        )
        _require_resolved(found)
        gone = (self.variables(found, scales) - x).astype(float)
        off = float(np.linalg.norm(gone - distance * tangent))
        if off > DISTANCE_LIMIT * max(abs(distance), SMALLEST_STEP):
            reason = f"the torus found is {off / abs(distance):.2g} steps off the way"
            raise NoTorus(reason, found, found.residual())
        if distance > 0:
            towards, *here = map(self._whole, (before, last, found))
            require_one_curve(*here, towards=towards)
        else:
            self._require_between(found)
        return found

    def _secant(self) -> tuple[Floats, Floats, Floats, float]:
        """The variables of the last torus, the secant from the one before, scales, its length."""
        before, last = self.tori[-2:]
        scales = self.scales()
        x = self.variables(last, scales)
        difference = x - self.variables(before, scales)
        length = float(np.linalg.norm(difference.astype(float)))
        tangent = (difference / length).astype(float)
        return x, tangent, scales, length

    def _whole(self, torus: Torus[Newton]) -> Whole:
        """A torus with its tangent, which is computed once."""
        if id(torus) not in self._known:
            x, tangent, scales, _ = self._secant()
            across = plane(x, tangent, scales, 0.0)
            self._known[id(torus)] = whole(torus, self._conditions(across))
        return self._known[id(torus)]

    def require_neighbours(self) -> None:
        """NoTorus unless the last two tori lie on one smooth piece of a curve."""
        require_one_curve(*map(self._whole, self.tori[-2:]))

    def _require_between(self, found: Torus[Newton]) -> None:
        """NoTorus for a torus that does not fit the curve between the last two."""
        before, last = self.tori[-2:]
        require_one_curve(*map(self._whole, (before, found, last)))

    def between(self, level: Level) -> Torus[Newton]:
        """The torus of an energy between those of the last two; raises NoTorus."""
        before, last = self.tori[-2:]
        low, high = level.of(before), level.of(last)
        part = (level.energy - low) / (high - low)
        conditions = self._conditions(level.condition)
        guess = extrapolated(before, last, part - 1)
        found = refined_torus(
            guess, conditions, tolerance=self.tolerance, progress=self.progress
        )
        _require_resolved(found)
        along, astray = self.place(found)
        if astray > DISTANCE_LIMIT or not -OVERHANG <= along <= 1 + OVERHANG:
            torus = f"the torus of {level.name} = {level.energy:.6g}"
            raise NoTorus(f"{torus} is not between two neighbours", found, found.residual())
        self._require_between(found)
        return found

    def meeting(self, condition: Condition, guess: Torus) -> Torus[Newton]:
        """The torus of a condition between the last two, from a guess.

        Raises NoTorus, also for one that is elsewhere or doubtful.
        """
        conditions = self._conditions(condition)
        found = refined_torus(
            guess, conditions, tolerance=self.tolerance, progress=self.progress
        )
        along, astray = self.place(found)
        if astray > DISTANCE_LIMIT or not 0 <= along <= 1 or found.warnings:
            raise NoTorus("it is not between two neighbours", found, found.residual())
        self._require_between(found)
        return found

    def place(self, torus: Torus[Newton]) -> tuple[float, float]:
        """How far along the way between the last two tori another one is, and how far off it.

        Both in the distance of the two.
        """
        scales = self.scales()
        three = (*self.tori[-2:], torus)
        start, end, here = (self.variables(x, scales).astype(float) for x in three)
        secant, gone = end - start, here - start
        along = float(gone @ secant) / float(secant @ secant)
        off = float(np.linalg.norm(gone - along * secant))
        return along, off / float(np.linalg.norm(secant))

    def advance(self, goal: Level) -> Torus[Newton]:
        """The next torus, by the longest step that succeeds; raises NoTorus when none does.

        The goal chooses no step. It ends the one that leads beyond.
        """
        found = self._longest_step()
        if goal.passed(reached := goal.of(found)) and not goal.met(reached):
            found = self._reached(goal, found)
        if len(found.origin.steps) <= EASY_STEPS:
            self.step = min(self.step * FACTOR, LARGEST_STEP)
        self.tori = [*self.tori[-2:], found]
        kept = set(map(id, self.tori))
        self._known = {key: known for key, known in self._known.items() if key in kept}
        return found

    def _longest_step(self) -> Torus[Newton]:
        while True:
            try:
                return self.at(self.step)
            except NoTorus:
                smallest = DOUBTFUL_STEP if self.tori[-1].warnings else SMALLEST_STEP
                if self.step < smallest:
                    raise
                self.step /= 2

    def _reached(self, goal: Level, beyond: Torus[Newton]) -> Torus[Newton]:
        """The torus of the goal between the last one and one beyond, by halves of the way."""
        low, high = self.tori[-1], beyond
        for halving in range(GOAL_HALVINGS + 1):
            pair = self.local(low, high)
            try:
                return pair.between(goal)
            except NoTorus:
                if halving == GOAL_HALVINGS:
                    raise
            *_, length = pair._secant()
            middle = pair.at(-length / 2)
            passed = goal.passed(goal.of(middle))
            low, high = (low, middle) if passed else (middle, high)
        raise AssertionError


def _require_resolved(found: Torus[Newton]) -> None:
    """Raises NoTorus for what is no member of a family."""
    if min(found.frequencies) <= 0:  # the mirror image of the family behind a saddle
        raise NoTorus("a frequency passes zero", found, found.residual())
    if found.warnings and (residual := found.residual()) > RESIDUAL_LIMIT:
        raise NoTorus(
            f"{len(found.harmonics)} harmonics do not resolve it", found, residual
        )
