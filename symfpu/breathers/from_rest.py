"""The family of a seed mode from rest: one walk in steps that the family alone chooses.

What is asked of the family cuts the walk and never steers it, so that all functions that follow it
find the same orbits. A step is accepted as `symfpu.breathers.curve` says; at a resonance whose gap
is wide it follows the curve round the turn, and it passes narrow ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.crossings import (
    Gap,
    changed,
    gap_ahead,
    gap_between,
    landing,
    suspects,
)
from symfpu.breathers.curve import (
    Along,
    Linearisation,
    NotOnTheCurve,
    Point,
    alike,
    at_amplitude,
    corrected,
    disagreement,
    more_harmonics,
    point_at,
    require_agreement,
    resolved,
    step_from,
    with_harmonics,
)
from symfpu.breathers.equations import (
    TAIL,
    Balance,
    NoPeriodicOrbit,
    relative_heights,
)
from symfpu.breathers.linearisation import WHOLE
from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift

Floats = NDArray[np.float64]
FIRST_HARMONICS = 8
FIRST_SHIFT = 1e-3  # of the frequency, relative: of the orbit from which steps begin
FIRST_STRETCH = 0.25  # of the bonds, at most, of the same
MOST_DRIVEN = 0.1  # of its amplitude: what it has in another coefficient
LOWERINGS = 40  # halvings of that orbit's amplitude, until it continues the linear mode
LONGEST, SHORTEST = 1.0, 1e-6  # steps, in units of the largest coefficient
LONGEST_OF_MANY = 0.25  # with many unknowns: farther on there are more of them
UNRESOLVED = 0.05  # the shortest step to an orbit that needs too many harmonics
DOUBTFUL = 0.1  # a refused step of this length asks for a resonance
AFTER_A_GAP = 0.1  # the step after a narrow gap
EASY = 0.3  # of what is allowed: a step with less misfit is followed by one twice as long
BACK_AT_REST = "the family comes back to rest"
WIDEST = 0.2  # relative: wider gaps are no event
NEXT = 3.0  # steps to the middle of a gap that is the one met
MOST_STEPS = 300
# relative: half of the amplitudes over which a gap turns the curve away. Narrower ones are passed
NARROW = 1e-3
PASSED, FOLLOWED, AVOIDED = "passed", "followed", "avoided"  # what it does at a gap
LANDINGS = 5  # beyond a narrow gap, ever farther
LEAST_MARGIN, ROUNDING = 1e-3, 1e-12  # relative, of an amplitude and of a coefficient
MARGIN = 16.0  # of the range of amplitudes in which a narrow gap turns the curve


@dataclass(frozen=True, eq=False)
class Passage:
    """A resonance that the walk met after a point, and what it does there.

    what : PASSED if the gap is narrow. At a wide one AVOIDED if the family turns back to smaller
    or larger A, or FOLLOWED if it goes on with a growing harmonic.
    """

    after: int
    gap: Gap
    what: str


class FromRest:
    """Points of the family of a seed mode, from a small amplitude on; A > 0.

    points : so far. passages : of resonances.
    """

    def __init__(self, chain: Chain, seed: int) -> None:
        self.chain, self.seed = chain, seed
        self.points: list[Point] = []
        self.passages: list[Passage] = []
        self.length = LONGEST
        self.iterations = 0
        self._least = Balance(chain, seed, FIRST_HARMONICS)
        self._bend: Floats | None = None
        self._wide: list[Gap] = []
        self.points += self._begun()

    def __iter__(self) -> Iterator[Point]:
        """Points in the order of the walk; NoPeriodicOrbit where it cannot go on."""
        for k in range(MOST_STEPS):
            while len(self.points) <= k:
                self.advance()
            yield self.points[k]
            if k and self.points[k].amplitude < self.points[0].amplitude:
                raise self._ended(BACK_AT_REST)
        raise self._ended(f"{MOST_STEPS} steps do not lead there")

    def _ended(self, reason: str) -> NoPeriodicOrbit:
        return NoPeriodicOrbit(self.points[-1].balance, reason, self.points[-1].z)

    def gap_after(self, number: int) -> Gap | None:
        """The narrow gap that was passed after a point."""
        for passage in self.passages:
            if passage.what == PASSED and passage.after == number:
                return passage.gap
        return None

    @property
    def turned(self) -> bool:
        """Whether a wide gap has turned the family so far."""
        return any(passage.what != PASSED for passage in self.passages)

    def lowered(self, parts: int) -> Point:
        """The point whose amplitude is that of the first over 2^parts."""
        first = self.points[0]
        ratio = 0.5**parts
        balance = first.balance
        guess = first.z * ratio
        guess[-1] *= ratio
        guess[:-1][balance.n != 1] *= ratio
        z, steps, _ = at_amplitude(balance, guess)
        return point_at(balance, z, _seed_axis(balance), steps)

    def _begun(self) -> list[Point]:
        """Two points on the branch that leaves rest along the linear mode."""
        A = self._first_amplitude()
        failure: NoPeriodicOrbit | None = None
        high: Point | None = None
        for _ in range(LOWERINGS):
            low: Point | None = None
            try:
                high = high or self._near_rest(A)
                low = self._near_rest(A / 2)
                pair = alike(low, high)
                if not (reason := _off(*pair)):
                    return list(pair)
                failure = NoPeriodicOrbit(high.balance, reason, high.z)
            except NotOnTheCurve as error:
                axis = A * _seed_axis(self._least)
                failure = NoPeriodicOrbit(self._least, error.reason, axis)
            A, high = A / 2, low
        assert failure is not None
        raise failure

    def _first_amplitude(self) -> float:
        linear = float(self.chain.frequencies()[self.seed - 1])
        unit = np.zeros(self.chain.N - 1)
        unit[self.seed - 1] = 1.0
        stretch = float(np.max(np.abs(self.chain.stretches(unit))))
        A = FIRST_STRETCH / stretch
        shift = abs(frequency_shift(self.chain, {self.seed: 1.0})[self.seed])
        if shift:
            A = float(min(A, (FIRST_SHIFT * linear / shift) ** 0.5))
        driven = self._driven(A)
        while driven > MOST_DRIVEN:  # as halving would find by attempts that fail
            A, driven = A / 2, driven / 2**self.chain.degree_step
        return A

    def _driven(self, amplitude: float) -> float:
        """The largest coefficient besides A, relative to it, that the linear mode drives at once.

        The lowest order of the series in the amplitude: its first power or its square.
        """
        balance = self._least
        equations = balance.equations(amplitude * _seed_axis(balance))
        others = balance.detuning != 0
        others[balance.first] = False
        driven = np.abs(equations[others] / balance.detuning[others])
        return float(driven.max(initial=0.0)) / amplitude

    def _near_rest(self, amplitude: float) -> Point:
        """The orbit that Newton's method finds from the linear mode with its lowest shift."""
        linear = float(self.chain.frequencies()[self.seed - 1])
        shift = frequency_shift(self.chain, {self.seed: amplitude})[self.seed]
        cosines = np.zeros((2, self.chain.N - 1))
        cosines[1, self.seed - 1] = amplitude
        sigma, balance = shift * (2 * linear + shift), self._least
        while True:
            z, steps, _ = at_amplitude(balance, balance.vector(cosines, sigma))
            if resolved(balance, z):
                return point_at(balance, z, _seed_axis(balance), steps)
            cosines, sigma = balance.cosines(z), float(z[-1])
            balance = balance.at(more_harmonics(balance, z))

    def _widened(self, point: Point, harmonics: int) -> Point:
        """The last point with more harmonics, kept so."""
        wider = with_harmonics(point, harmonics)
        if self._bend is not None:
            bend = point.balance.cosines(self._bend), self._bend[-1]
            self._bend = wider.balance.vector(*bend)
        if point is self.points[-1]:
            self.points[-1] = wider
        return wider

    def advance(self) -> None:
        """One point more, by the longest step that is accepted."""
        while True:
            start = self.points[-1]
            bend = self._bend if self._bend is not None else 0 * start.z
            distance = self.length * start.size
            try:
                found, start = step_from(start, distance, bend, self._widened)
                require_agreement(start, found)
            except NotOnTheCurve as refusal:
                if refusal.crossings and self._crossed(refusal, distance):
                    return
                doubtful = refusal.crossings == 1 or self.length <= DOUBTFUL
                if doubtful and self._resonance(refusal.point, distance):
                    return
                self.length /= 2
                shortest = UNRESOLVED if refusal.unresolved else SHORTEST
                if self.length < shortest:
                    reason = f"the family cannot be followed, because {refusal.reason}"
                    raise self._ended(reason) from refusal
                continue
            self._add(start, found)
            return

    def _append(self, found: Point) -> None:
        """A point more; the linearisation of the one before is not kept."""
        self.points[-1] = replace(self.points[-1], linear=None)
        self.points.append(found)

    def _add(self, start: Point, found: Point) -> None:
        moved = float(np.linalg.norm(found.z[:-1] - start.z[:-1]))
        self._bend = (found.tangent - start.tangent) / moved / 2
        self._append(self._trimmed(found))
        self.iterations += found.iterations
        turned = float(np.linalg.norm(found.tangent[:-1] - start.tangent[:-1]))
        longest = LONGEST if len(found.z) <= WHOLE else LONGEST_OF_MANY
        if turned < EASY * 0.3:
            self.length = 2 * self.length
        self.length = min(self.length, longest)

    def _trimmed(self, found: Point) -> Point:
        """A point without half of its harmonics or more, if they are rounding."""
        heights = relative_heights(found.cosines)
        needed = 5 * int(np.flatnonzero(heights > TAIL / 10)[-1]) // 4 + 4
        if max(2 * needed, 2 * FIRST_HARMONICS) > found.balance.harmonics:
            return found
        balance, bend = found.balance, self._bend
        try:
            found = with_harmonics(found, max(needed, FIRST_HARMONICS))
        except NotOnTheCurve:
            return found
        if bend is not None:
            self._bend = found.balance.vector(balance.cosines(bend), bend[-1])
        return found

    def _resonance(self, found: Point | None, distance: float) -> bool:
        """Whether a narrow gap lies ahead, and is passed. Wide ones are noted."""
        start = self.points[-1]
        just = self.passages[-1:] if self.passages else []
        known = {_name(p.gap) for p in just if p.after >= len(self.points) - 3}
        A = abs(start.amplitude)
        known |= {
            _name(gap)
            for gap in self._wide
            if abs(gap.amplitude) / 2 < A < 2 * abs(gap.amplitude)
        }
        for place in suspects(start, found):
            name = int(start.balance.n[place]), int(start.balance.q[place]) + 1
            if name in known:
                continue
            gap = gap_ahead(start, found, place, distance)
            if gap is None:
                continue
            if gap.width >= NARROW:
                self._wide.append(gap)
                step = abs(distance * start.tangent[start.balance.first])
                near = abs(gap.amplitude - start.amplitude) < NEXT * step + gap.half_range
                if near and gap.width < WIDEST:
                    forward = float(start.tangent[start.balance.first])
                    self._note(gap, AVOIDED if gap.turns_back(forward) else FOLLOWED)
            elif self._passed(gap):
                return True
        return False

    def _crossed(self, refusal: NotOnTheCurve, distance: float) -> bool:
        """Whether a step of a long chain has passed narrow gaps alone, and its point is kept.

        The whole solutions agree, and as many divisors change their sign as the index changes by.
        Their gaps are measured from both sides: the orbits in their middles cost too much here.
        """
        start, found = self.points[-1], refusal.point
        if found is None or len(start.z) <= WHOLE or len(start.z) != len(found.z):
            return False
        gaps: list[Gap] = []
        for place in changed(start, found):
            gap = gap_between(start, found, place)
            if gap is not None and gap.width < NARROW:
                gaps.append(gap)
            if len(gaps) == refusal.crossings:
                for each in gaps:
                    self._note(each, PASSED)
                self._add(start, found)
                return True
        return False

    def _note(self, gap: Gap, what: str) -> None:
        self.passages.append(Passage(len(self.points) - 1, gap, what))

    def _passed(self, gap: Gap) -> bool:
        """Whether an orbit beyond a narrow gap continues the one before it, and is kept."""
        start = self.points[-1]
        forward = float(np.sign(start.tangent[start.balance.first]))
        margin = max(MARGIN * gap.half_range, LEAST_MARGIN * abs(gap.amplitude))
        for _ in range(LANDINGS):
            A = gap.amplitude + forward * margin
            margin *= 2
            if (A - start.amplitude) * forward <= 0:
                continue
            try:
                guess, expected = landing(gap, A)
                linear = Linearisation(gap.balance, guess)
                z, steps, linear = corrected(gap.balance, guess, linear, _held(gap, A))
                found = point_at(gap.balance, z, start.tangent, steps, linear)
            except NotOnTheCurve:
                continue
            # from the branch of the resonance back to that of the seed alone the index is kept
            resonant = abs(start.z[gap.place]) > gap.turn
            other = abs(found.index - start.index) == (0 if resonant else 1)
            small = abs(z[gap.place] - expected) <= max(
                abs(expected), ROUNDING * found.size
            )
            if other and small and resolved(gap.balance, z):
                self._note(gap, PASSED)
                self._append(found)
                self._bend, self.length = None, AFTER_A_GAP
                self.iterations += steps
                return True
        return False


def _name(gap: Gap) -> tuple[int, int]:
    return gap.harmonic, gap.mode


def _held(gap: Gap, amplitude: float) -> Along:
    first = gap.balance.first
    return lambda z, tangent: float((amplitude - z[first]) / tangent[first])


def _seed_axis(balance: Balance) -> Floats:
    axis = np.zeros(len(balance.n) + 1)
    axis[balance.first] = 1.0
    return axis


def _index_at_rest(balance: Balance) -> int:
    """The index of the linear mode: one of the border, and the harmonics below their mode."""
    below = balance.detuning < 0
    below[balance.first] = True
    return int(below.sum())


def _off(low: Point, high: Point) -> str:
    """Why two orbits near rest are not on one branch with the linear mode; empty if they are."""
    for point in (low, high):
        others = np.delete(np.abs(point.z[:-1]), point.balance.first)
        if float(others.max(initial=0)) > MOST_DRIVEN * point.size:
            return "another mode has a tenth of the amplitude"
    index = _index_at_rest(high.balance)
    for point in (low, high):
        if point.index != index:
            return f"the index is {point.index}, at rest {index}"
    return disagreement(low, high)
