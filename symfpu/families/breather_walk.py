"""The members of a family of breathers: the points of the walk from rest, and the two ends.

Where members are does not depend on either end (`symfpu.breathers.from_rest`).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from symfpu.breathers.balance import orbit_at, require_same, unknowns_of
from symfpu.breathers.curve import (
    NotOnTheCurve,
    Point,
    alike,
    disagreement,
    point_at,
)
from symfpu.breathers.equations import Balance, NoPeriodicOrbit
from symfpu.breathers.floquet import floquet
from symfpu.breathers.from_rest import FromRest
from symfpu.breathers.passage import (
    EnergyGoal,
    at_part,
    beside_gap,
    first_passage,
    within,
)
from symfpu.families.folder import Plan
from symfpu.families.members import Event, Level, linear_by_mode
from symfpu.files.progress import Progress
from symfpu.refinement.conditions import Condition, plane
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import NoTorus, refined_torus
from symfpu.tori.torus import Torus

SAME = 1e-6  # of the size: members that are nearer are one
TURN_HALVINGS = 20  # of a segment, for the place where the energy turns
HALVINGS = 26  # of a segment, for the place where stability changes
SAME_ORBIT = 1e-8  # of the size: what Newton's method on tori may change of an orbit
FIRST_PARTS = 60  # halvings of the first amplitude, at which members may begin


class BreatherWalk:
    """Members of one seed with fixed ends, from a first energy on."""

    def __init__(self, plan: Plan, progress: Progress) -> None:
        self.plan, self.progress = plan, progress
        (seed,) = plan.seeds
        self.walk = FromRest(plan.chain, seed)

    def first(self) -> Torus[Newton]:
        """The member of the first energy; NoPeriodicOrbit where the family has none."""
        goal = EnergyGoal(self.plan.chain, self.plan.first, self.plan.harmonic)
        return self._refined(first_passage(self.walk, goal), self._at(self.plan.first))

    def reached(self) -> tuple[float, bool]:
        """The largest energy of the walk so far, and whether the energy turns there."""
        goal = EnergyGoal(self.plan.chain, 1.0, self.plan.harmonic)
        points = self.walk.points
        energies = [goal.value(p.balance, p.z) for p in points]
        top = int(np.argmax(energies))
        if not 0 < top < len(points) - 1:
            return max(energies), False
        for start, end in ((top, top + 1), (top - 1, top)):
            pair = alike(points[start], points[end])
            rates = [goal.slope(p.balance, p.z, p.tangent) for p in pair]
            if rates[0] > 0 > rates[1] and self.walk.gap_after(start) is None:
                return self._turn(*pair, goal), True
        return max(energies), False

    def _turn(self, low: Point, high: Point, goal: EnergyGoal) -> float:
        """The energy where it turns between two neighbours, by halving."""
        for _ in range(TURN_HALVINGS):
            middle = at_part(low, high, 0.5)
            rises = goal.slope(middle.balance, middle.z, middle.tangent) > 0
            low, high = (middle, high) if rises else (low, middle)
        return goal.value(low.balance, low.z)

    def after(self, torus: Torus[Newton]) -> Iterator[tuple[Torus[Newton], list[Event]]]:
        """Members after one, up to the goal, and the resonances met on the way to each.

        Ends with NoTorus where the family cannot be followed.
        """
        goal = EnergyGoal(self.plan.chain, self.plan.goal, self.plan.harmonic)
        before = torus
        try:
            for k, start, end in self._segments(torus):
                gap = self.walk.gap_after(k) if k is not None else None
                if gap is None:
                    point = within(start, end, goal)
                else:
                    point = beside_gap(start, end, goal, gap)
                events = self._events(k)
                if point:
                    yield self._refined(point, self._at(self.plan.goal)), events
                    return
                found = self._refined(end, None)
                yield found, events
                before = found
        except (NoPeriodicOrbit, NotOnTheCurve) as failure:
            raise NoTorus(failure.reason, before, before.residual()) from failure

    def _at(self, energy: float) -> Condition:
        return Level(energy, self.plan.harmonic).condition

    def _segments(self, torus: Torus[Newton]) -> Iterator[tuple[int | None, Point, Point]]:
        """Pairs of neighbours from a member on, with the number of the first in the walk."""
        found = False
        for k, start, end in self._pairs(torus):
            if found:
                yield k, start, end
            elif (own := self._between(start, torus, end)) is not None:
                found = True
                last, here = alike(end, own)
                gone = float(np.linalg.norm((last.z - here.z)[:-1]))
                if gone > SAME * end.size:
                    yield k, own, end

    def _pairs(self, torus: Torus[Newton]) -> Iterator[tuple[int | None, Point, Point]]:
        """Neighbours from below a member on."""
        (A,) = map(abs, torus.amplitudes.values())
        first = self.walk.points[0].amplitude
        parts = max(0, int(np.ceil(np.log2(first / A) + SAME)))
        low = [self.walk.lowered(k) for k in range(min(parts, FIRST_PARTS), 0, -1)]
        for start, end in pairwise([*low, self.walk.points[0]]):
            yield None, start, end
        points = iter(self.walk)
        next(points)
        for k, end in enumerate(points):
            yield k, self.walk.points[k], end

    def _between(self, start: Point, torus: Torus[Newton], end: Point) -> Point | None:
        """A torus as a point, if it lies between two neighbours."""
        (A,) = torus.amplitudes.values()
        sizes = sorted((start.amplitude, end.amplitude))
        step = abs(sizes[1] - sizes[0]) + SAME * sizes[1]
        if not sizes[0] - step < abs(A) < sizes[1] + step:
            return None
        start, end = alike(start, end)
        z = unknowns_of(start.balance, torus)
        try:
            own = point_at(start.balance, z, start.tangent)
        except NotOnTheCurve:
            return None
        ahead, back = (
            (end.z - z)[:-1] @ end.tangent[:-1],
            (z - start.z)[:-1] @ start.tangent[:-1],
        )
        if min(ahead, back) < -SAME * end.size:
            return None
        apart = [float(np.linalg.norm((p.z - z)[:-1])) / p.size for p in (start, end)]
        if min(apart) < SAME:
            return own
        return None if disagreement(start, own) or disagreement(own, end) else own

    def _refined(self, point: Point, condition: Condition | None) -> Torus[Newton]:
        """The same orbit by Newton's method on tori; NoTorus if it is another one."""
        guess = orbit_at(point, 0)
        conditions = [condition or self._plane(point)]
        found = refined_torus(
            guess, conditions, tolerance=self.plan.tolerance, progress=self.progress
        )
        require_same(guess, found, max(SAME_ORBIT, 10 * self.plan.tolerance))
        return found

    def _plane(self, point: Point) -> Condition:
        """Across the curve at one of its points."""
        orbit = orbit_at(point, 0)
        linear = np.array(list(linear_by_mode(orbit.chain, orbit.seeds).values()))
        shifts = shifts_of(orbit)
        A = np.longdouble(point.amplitude)
        slope = float(point.tangent[-1]) / (2 * float(orbit.frequency))
        scales = np.maximum(np.abs(shifts.astype(float)), 1e-12 * linear)
        by_A = float(point.tangent[point.balance.first]) / point.amplitude
        tangent = np.array([by_A, slope / scales[0]])
        tangent /= np.linalg.norm(tangent)
        start = np.append(np.log(A), shifts / scales)
        return plane(start, tangent, scales, 0.0)

    def _events(self, k: int | None) -> list[Event]:
        """The resonances that the walk met after a point, without the number of the member."""
        events = []
        for passage in self.walk.passages:
            if passage.after != k:
                continue
            gap = passage.gap
            energy = EnergyGoal(self.plan.chain, 1.0).value(gap.balance, gap.z)
            events.append(
                Event(
                    kind="resonance",
                    what=passage.what,
                    after=0,
                    energy=energy,
                    value=gap.width,
                    mode=gap.mode,
                    harmonic=(gap.harmonic,),
                )
            )
        return events


def stability_between(
    start: Torus[Newton], end: Torus[Newton], stable_before: bool
) -> float | None:
    """The energy between two neighbours where the stability changes, by halving on the curve.

    None where orbits between them do not fit the curve.
    """
    low, high = _neighbours(start, end)
    energy = float(start.energy())
    try:
        for _ in range(HALVINGS):
            middle = at_part(low, high, 0.5)
            orbit = orbit_at(middle, 0)
            energy = float(orbit.energy())
            same = floquet(orbit).stable == stable_before
            low, high = (middle, high) if same else (low, middle)
    except NotOnTheCurve:
        return None
    return energy


def _neighbours(start: Torus[Newton], end: Torus[Newton]) -> tuple[Point, Point]:
    """Two members as points of their curve, in its direction."""
    harmonics = max(8, *(len(torus.by_harmonic()) + 3 for torus in (start, end)))
    balance = Balance(start.chain, start.seed, harmonics)
    z = [unknowns_of(balance, torus) for torus in (start, end)]
    low, high = (point_at(balance, x, z[1] - z[0]) for x in z)
    return low, high
