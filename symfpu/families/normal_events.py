"""Where normal frequencies collide or resonate between two tori of a curve.

Two elliptic directions of opposite signature may meet, sigma_q + sigma_q' = nu.omega or 2 sigma_q =
nu.omega, and leave the real line as a hyperbolic pair: then the real parts stay locked at the
resonance. The frequencies have a root there; the discriminant has none,

    D = (sigma_q + sigma_q' - nu.omega)^2 before, -4 (Im sigma_q)^2 beyond,

the square of the difference of the two that meet, which passes through zero as a smooth function
of the place does. A resonance that is crossed between real frequencies is a zero of its own
distance. The torus of either is found by Newton's method, with D or the distance among its
conditions (`symfpu.normal.meeting`), from where a line between the two tori has the zero; where
that does not lead between them, by values of D on tori ever nearer to it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from symfpu.action_angle.newton_twist import NoTwist, action_turn
from symfpu.families.normal_zeros import (
    PLACE,
    SHARE,
    Bracket,
    Failed,
    Outside,
    collision,
    located,
    zero_of,
)
from symfpu.normal.frequencies import NormalFrequencies, frequencies_of
from symfpu.normal.meeting import Crossed, Lost, Meeting, NormalCondition
from symfpu.normal.modes import NormalModes
from symfpu.normal.resonances import (
    OWN,
    PARAMETRIC,
    ParametricResonance,
    crossed_resonances,
    locked_resonances,
)
from symfpu.normal.search import followed_modes
from symfpu.refinement.conditions import Condition
from symfpu.refinement.tori import NoTorus
from symfpu.results.field import Field, fields_of, numbers_by_seed
from symfpu.results.numbers import fifteen_digits
from symfpu.results.result import Result
from symfpu.tori.torus import Torus

STABILITY, RESONANCE = "stability", "resonance"
RESONANCE_LENGTH = 4  # sum |nu_i| up to which a resonance that is crossed is an event
TURNED = (
    1e-6  # of det d ln I / d ln A at the members, what may be left of it where it is zero
)
MET = 1e-8  # distance up to which a resonance was crossed, and not jumped over
ROUGH = 1e-6  # of the way, from which an event is said to be interpolated
# where two frequencies are nearer than this, relative, D is not computed but interpolated
LEAST_GAP = 5e-4

MOST_SHOWN = 8  # events that readers see beside a picture


@dataclass(frozen=True)
class NormalEvent(Result):
    """What normal frequencies do between two members of a family; dimensionless. Ours.

    kind : 'stability' (two normal frequencies meet and leave the real line, or come back), or
        'resonance' (one is crossed, and both stay real). resonance : which, with its distance.
    after : the number of the first of the two members. part : where, on a line of `normal_family`
        0 to 1 from its first member to the last, in a `family` from the member `after` to the
        next. amplitudes : by seed there. energy : H there.
    begins : whether the directions are hyperbolic beyond it; False for a resonance. error : of
        `part`, estimated; rounding where Newton's method found the torus, the whole step where no
        torus in between could be judged.

    >>> met = ParametricResonance("sum", (4, 6), (0, 2), 0.0)
    >>> NormalEvent("stability", met, 3, 0.5, {1: 0.1, 5: 0.4}, 0.25, begins=True)
    stability: sigma_4 + sigma_6 = (0,2).omega, hyperbolic from A_1=0.1, A_5=0.4 on
    """

    kind: str
    resonance: ParametricResonance
    after: int
    part: float
    amplitudes: Mapping[int, float]
    energy: float
    begins: bool = False
    error: float = 0.0

    def entry(self) -> dict[str, Any]:
        """For the record of a family: what it is, and where."""
        return {
            "event": self.kind,
            "resonance": self.resonance.entry(),
            "after": self.after,
            "part": fifteen_digits(self.part),
            "amplitudes": numbers_by_seed(self.amplitudes, None),
            "energy": repr(self.energy),
            "begins": self.begins,
            "error": fifteen_digits(self.error),
        }

    def _fields(self) -> Iterator[Field]:
        yield from fields_of(self.entry())

    def __repr__(self) -> str:
        rough = self.error > ROUGH
        digits = ".3g" if rough else ".12g"
        where = ", ".join(f"A_{q}={a:{digits}}" for q, a in self.amplitudes.items())
        note = " (interpolated)" if rough else ""
        what = f"{self.kind}: {self.resonance.condition}"
        if self.kind == RESONANCE:
            return f"{what}, crossed at {where}{note}"
        if self.begins:
            return f"{what}, hyperbolic from {where}{note} on"
        return f"{what}, hyperbolic up to {where}{note}"


def event_fields(events: Sequence[NormalEvent]) -> Iterator[Field]:
    """The first events, as readers see them."""
    for event in events[:MOST_SHOWN]:
        yield Field("", label=event.kind, shown=repr(event))


class Known(NamedTuple):
    """What is known at a place of a curve; modes : the eigenfunctions to begin with nearby."""

    place: float
    normal: NormalFrequencies
    modes: NormalModes


class Curve(Protocol):
    """Tori by their place on a curve; NoTorus where there is none."""

    def torus(self, place: float) -> Torus:
        """The one at a place."""
        ...

    def met(self, condition: Condition, place: float) -> tuple[float, Torus]:
        """The one that meets a condition, by Newton's method from a place; with its own."""
        ...


class Stretch:
    """A curve of tori between two of them, whose normal frequencies are known.

    after : the number of the first.
    """

    def __init__(self, curve: Curve, first: Known, second: Known, after: int) -> None:
        self._curve, self._after = curve, after
        self._first, self._second = first, second

    def events(self, length: int) -> list[NormalEvent]:
        """In order; length : the largest sum |nu_i| of resonances that are crossed, or 0."""
        first, second = self._first.normal, self._second.normal
        found: list[NormalEvent] = []
        done = set()
        for resonance in _changed(first, second):
            done.add(resonance.modes)
            found.append(self._onset(resonance, self._first, self._second))
        for resonance in crossed_resonances(first, second, length):
            if resonance.modes not in done:
                found += self._crossing(resonance)
        return sorted(found, key=lambda event: event.part)

    def _known(self, place: float, modes: tuple[int, ...]) -> Known:
        """Normal modes of the torus there, continued from the nearer end."""
        ends = self._first, self._second
        near = min(ends, key=lambda end: abs(end.place - place))
        torus = self._curve.torus(place)

        def between(part: float) -> Torus:
            return self._curve.torus(near.place + part * (place - near.place))

        found, missing = followed_modes(torus, near.modes, modes=modes, between=between)
        for none in missing.values():
            raise none
        return Known(place, frequencies_of(found, missing), found)

    def _onset(
        self,
        resonance: ParametricResonance,
        low: Known,
        high: Known,
        *,
        crossed: bool = False,
    ) -> NormalEvent:
        """Where the discriminant is zero; crossed : beside a distance of zero at one of the two."""
        values = [discriminant(end.normal, resonance) for end in (low, high)]
        bracket = Bracket(low.place, high.place, *values)
        begins, wild = (True, high) if bracket.at_high < 0 else (False, low)
        place = bracket.beside() if crossed else bracket.secant()
        near, far = sorted((low, high), key=lambda end: abs(end.place - place))
        calm = far if near is wild else near
        if _own(resonance, wild.normal):
            place, error = self._turned(bracket)
            return self._event(STABILITY, resonance, place, error, begins=begins)
        size = (2 * _real(low.normal)[resonance.modes[0]]) ** 2
        for start, known in ((place, near), (place, far), (calm.place, calm)):
            if met := self._met(Meeting(known.modes, resonance), start, bracket, size):
                return self._event(STABILITY, resonance, *met, begins=begins)
        place, error = self._halved(resonance, bracket, low)
        return self._event(STABILITY, resonance, place, error, begins=begins)

    def _met(
        self, condition: NormalCondition, start: float, bracket: Bracket, size: float
    ) -> tuple[float, float, Torus] | None:
        """Place, error and torus of a condition by Newton's method, or None.

        size : that the condition's value is relative to.
        """
        try:
            place, torus = self._curve.met(condition, start)
        except (*Failed, Lost):
            return None
        if not bracket.low < place < bracket.high:
            return None
        return place, bracket.error(place, size * condition.error(torus)), torus

    def _halved(
        self, resonance: ParametricResonance, bracket: Bracket, low: Known
    ) -> tuple[float, float]:
        """The place of an onset by values of D, and its error."""

        def of(place: float) -> float:
            return discriminant(self._known(place, resonance.modes).normal, resonance)

        gap = 2 * LEAST_GAP * abs(resonance.left_of(_real(low.normal)))
        try:
            return located(of, bracket, gap**2)
        except Failed:
            return bracket.secant(), bracket.width

    def _turned(self, bracket: Bracket) -> tuple[float, float]:
        """The place where the actions turn, and its error; D interpolated where they do not.

        There a direction meets a frequency of the torus, where no determinant tells it from shifts
        of the angles.
        """

        def of(place: float) -> float:
            return action_turn(self._curve.torus(place).in_doubles())

        low, high = bracket.low, bracket.high
        try:
            turn = Bracket(low, high, of(low), of(high))
            place = zero_of(of, turn)
            left = abs(of(place))
        except (*Failed, NoTwist, ValueError):
            return bracket.secant(), bracket.width
        if left > TURNED * turn.largest:  # no zero, but a turn of the amplitudes
            return bracket.secant(), bracket.width
        return place, max(PLACE * bracket.width, turn.error(place, left))

    def _crossing(self, resonance: ParametricResonance) -> Iterator[NormalEvent]:
        """Where the distance is zero: two onsets if both are hyperbolic there, none if it jumps."""
        low, high = self._first, self._second
        values = [resonance.distance_of(end.normal) for end in (low, high)]
        bracket = Bracket(low.place, high.place, *values)
        start = bracket.secant()
        near = min((low, high), key=lambda end: abs(end.place - start))
        size = _real(low.normal)[resonance.modes[0]]
        if met := self._met(Crossed(near.modes, resonance), start, bracket, size):
            yield self._event(RESONANCE, resonance, *met)
            return
        yield from self._crossed_by_secants(resonance, bracket)

    def _crossed_by_secants(
        self, resonance: ParametricResonance, bracket: Bracket
    ) -> Iterator[NormalEvent]:
        """The same where Newton's method leads to no torus with real frequencies."""
        low, high = self._first, self._second

        def of(place: float) -> float:
            return resonance.distance_of(self._known(place, resonance.modes).normal)

        try:
            place = zero_of(of, bracket)
            there = self._known(place, resonance.modes)
        except Failed:
            yield self._crossed_apart(resonance, of, bracket)
            return
        distance = resonance.distance_of(there.normal)
        if there.normal.growth:
            yield self._onset(resonance, low, there, crossed=True)
            yield self._onset(resonance, there, high, crossed=True)
        elif abs(distance) < MET:
            yield self._event(RESONANCE, resonance, place, PLACE, distance=distance)

    def _crossed_apart(
        self,
        resonance: ParametricResonance,
        of: Callable[[float], float],
        bracket: Bracket,
    ) -> NormalEvent:
        """Where modes that do not couple have one frequency they cannot be told apart."""
        gap = LEAST_GAP * bracket.largest / SHARE
        try:
            place, error = collision(of, bracket, gap)
        except (*Failed, Outside):
            place, error = bracket.secant(), bracket.width
        return self._event(RESONANCE, resonance, place, error)

    def _event(
        self,
        kind: str,
        resonance: ParametricResonance,
        place: float,
        error: float,
        torus: Torus | None = None,
        *,
        distance: float = 0.0,
        begins: bool = False,
    ) -> NormalEvent:
        """At a place, with what its torus has there; it is sought where none is given."""
        q, modes, harmonic = resonance.kind, resonance.modes, resonance.harmonic
        met = ParametricResonance(q, modes, harmonic, distance)
        amplitudes, energy = _measured(torus) if torus else self._where(place)
        after = self._after
        return NormalEvent(kind, met, after, place, amplitudes, energy, begins, error)

    def _where(self, place: float) -> tuple[dict[int, float], float]:
        """Amplitudes and energy, interpolated where there is no torus."""
        try:
            return _measured(self._curve.torus(place))
        except NoTorus:
            ends = [_measured(end.normal.torus) for end in (self._first, self._second)]
        (A, low), (B, high) = ends
        width = self._second.place - self._first.place
        part = (place - self._first.place) / width
        between = {q: (1 - part) * a + part * B[q] for q, a in A.items()}
        return between, (1 - part) * low + part * high


def _measured(torus: Torus) -> tuple[dict[int, float], float]:
    amplitudes = {q: float(a) for q, a in torus.amplitudes.items()}
    return amplitudes, float(torus.energy())


def discriminant(found: NormalFrequencies, resonance: ParametricResonance) -> float:
    """D of the directions of a resonance: below zero where they are hyperbolic."""
    growth = max(abs(complex(found.frequencies[q]).imag) for q in resonance.modes)
    if growth:
        return -4 * growth**2
    return resonance.distance_of(found) ** 2


def _changed(
    first: NormalFrequencies, second: NormalFrequencies
) -> list[ParametricResonance]:
    """The resonances to which directions are locked that are hyperbolic in just one of two."""
    common = set(first.frequencies) & set(second.frequencies)
    before, after = (_unstable(found) & common for found in (first, second))
    changed = before ^ after
    found: list[ParametricResonance] = []
    for side, modes in ((first, before & changed), (second, after & changed)):
        left = set(modes)
        for resonance in locked_resonances(side, modes):
            if left.issuperset(resonance.modes):
                found.append(resonance)
                left -= set(resonance.modes)
    return found


def _own(resonance: ParametricResonance, wild: NormalFrequencies) -> bool:
    """Whether a hyperbolic direction is locked to a frequency of the torus: sigma = nu.omega.

    There shifts of the angles are solutions, too: directions next to them cannot be told from
    these, and no determinant leaves them out.
    """
    if resonance.kind != PARAMETRIC:
        return False
    return any(
        one.kind == OWN
        and one.modes == resonance.modes
        and np.array_equal(2 * np.array(one.harmonic), resonance.harmonic)
        for one in wild.resonances
    )


def _unstable(found: NormalFrequencies) -> set[int]:
    return {q for q, w in found.frequencies.items() if complex(w).imag}


def _real(found: NormalFrequencies) -> dict[int, float]:
    return {q: complex(w).real for q, w in found.frequencies.items()}
