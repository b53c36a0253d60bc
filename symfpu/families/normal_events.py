"""Where normal frequencies collide or resonate between two tori of a curve.

Two elliptic directions of opposite signature may meet, sigma_q + sigma_q' = nu.omega or 2 sigma_q =
nu.omega, and leave the real line as a hyperbolic pair: then the real parts stay locked at the
resonance. The frequencies have a root there; the discriminant has none,

    D = (sigma_q + sigma_q' - nu.omega)^2 before, -4 (Im sigma_q)^2 beyond,

the square of the difference of the two that meet. It passes through zero as a smooth function of
the place does, and so its zero is found as one of any such function, to the last digits. A
resonance that is crossed between real frequencies is a zero of its own distance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from symfpu.frames.recorded import Recorded
from symfpu.normal.frequencies import LOCKED, NormalFrequencies, frequencies_of
from symfpu.normal.modes import NoNormalModes, NormalModes
from symfpu.normal.resonances import (
    PARAMETRIC,
    SUM,
    ParametricResonance,
    crossed_resonances,
)
from symfpu.normal.search import followed_modes
from symfpu.refinement.tori import NoTorus
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.ring_torus import RingTorus, amplitudes_by_seed

STABILITY, RESONANCE = "stability", "resonance"
RESONANCE_LENGTH = 4  # sum |nu_i| up to which a resonance that is crossed is an event
MET = 1e-8  # distance up to which a resonance was crossed, and not jumped over
PLACE = 1e-12  # of the way, to which the crossing of a resonance is located
ROUGH = 1e-6  # of the way, from which an event is said to be interpolated
# where two frequencies are nearer than this, relative, D is not computed but interpolated
LEAST_GAP = 5e-4
SHARE = 0.2  # of the bracket, that the points about an estimate reach out to
ROUNDS = 6  # of estimates, each with a point on either side
NODES = (-1.0, -0.6, -0.3, 0.3, 0.6, 1.0)  # of the last estimate, in units of the gap

NARROWED = 1e-7  # of the way, to which it is halved where D is too small to interpolate
NOISE = 1e-10  # of D, below which its sign says nothing

Failed = (NoTorus, NoNormalModes)


class Outside(Exception):
    """An estimate of a zero leaves the places between which it is."""


@dataclass(frozen=True)
class NormalEvent(Recorded):
    """What normal frequencies do between two members of a family; dimensionless. Ours.

    kind : 'stability' (two normal frequencies meet and leave the real line, or come back), or
        'resonance' (one is crossed, and both stay real). resonance : which, with its distance.
    after : the number of the first of the two members. part : where, on a line of `normal_family`
        0 to 1 from its first member to the last, in a `family` from the member `after` to the
        next. amplitudes : by seed there. energy : H there.
    begins : whether the directions are hyperbolic beyond it; False for a resonance. error : of
        `part`, estimated; the whole step where no torus in between could be judged.

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


class Bracket(NamedTuple):
    """Two places of a curve, and what a function is there, of opposite signs."""

    low: float
    high: float
    at_low: float
    at_high: float

    @property
    def width(self) -> float:
        return self.high - self.low

    @property
    def least(self) -> float:
        """The smaller size of the two values."""
        return min(abs(self.at_low), abs(self.at_high))

    @property
    def largest(self) -> float:
        """The larger one."""
        return max(abs(self.at_low), abs(self.at_high))

    def secant(self) -> float:
        """Where the function is zero if it is linear."""
        return self.low + self.width * self.at_low / (self.at_low - self.at_high)

    def half(self, middle: float, value: float) -> Bracket:
        """The half in which the sign changes."""
        if (value < 0) == (self.at_low < 0):
            return self._replace(low=middle, at_low=value)
        return self._replace(high=middle, at_high=value)


class Known(NamedTuple):
    """What is known at a place of a curve; modes : the eigenfunctions to begin with nearby."""

    place: float
    normal: NormalFrequencies
    modes: NormalModes


class Stretch:
    """A curve of tori between two of them, whose normal frequencies are known.

    torus : of the place on the curve, from that of the first to that of the second; NoTorus where
    there is none. after : the number of the first.
    """

    def __init__(
        self,
        torus: Callable[[float], QuasiPeriodic],
        first: Known,
        second: Known,
        after: int,
    ) -> None:
        self._torus, self._after = torus, after
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
        found, missing = followed_modes(self._torus(place), near.modes, modes=modes)
        for none in missing.values():
            raise none
        return Known(place, frequencies_of(found, missing), found)

    def _onset(
        self, resonance: ParametricResonance, low: Known, high: Known
    ) -> NormalEvent:
        """Where the discriminant is zero."""
        values = [discriminant(end.normal, resonance) for end in (low, high)]
        bracket = Bracket(low.place, high.place, *values)

        def of(place: float) -> float:
            return discriminant(self._known(place, resonance.modes).normal, resonance)

        gap = 2 * LEAST_GAP * abs(resonance.left_of(_real(low.normal)))
        begins = bracket.at_high < 0
        try:
            place, error = located(of, bracket, gap**2)
        except Failed:
            place, error = bracket.secant(), bracket.width
        return self._event(STABILITY, resonance, place, begins=begins, error=error)

    def _crossing(self, resonance: ParametricResonance) -> Iterator[NormalEvent]:
        """Where the distance is zero: two onsets if both are hyperbolic there, none if it jumps."""
        low, high = self._first, self._second
        values = [resonance.distance_of(end.normal) for end in (low, high)]
        bracket = Bracket(low.place, high.place, *values)

        def of(place: float) -> float:
            return resonance.distance_of(self._known(place, resonance.modes).normal)

        try:
            place = _zero(of, bracket)
            there = self._known(place, resonance.modes)
        except Failed:
            yield self._crossed_apart(resonance, of, bracket)
            return
        distance = resonance.distance_of(there.normal)
        if there.normal.growth:
            yield self._onset(resonance, low, there)
            yield self._onset(resonance, there, high)
        elif abs(distance) < MET:
            yield self._event(RESONANCE, resonance, place, distance, error=PLACE)

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
        return self._event(RESONANCE, resonance, place, error=error)

    def _event(
        self,
        kind: str,
        resonance: ParametricResonance,
        place: float,
        distance: float = 0.0,
        *,
        begins: bool = False,
        error: float,
    ) -> NormalEvent:
        """At a place, with what its torus has there."""
        q, modes, harmonic = resonance.kind, resonance.modes, resonance.harmonic
        met = ParametricResonance(q, modes, harmonic, distance)
        amplitudes, energy = self._where(place)
        after = self._after
        return NormalEvent(kind, met, after, place, amplitudes, energy, begins, error)

    def _where(self, place: float) -> tuple[dict[int, float], float]:
        """Amplitudes and energy, interpolated where there is no torus."""
        try:
            return _measured(self._torus(place))
        except NoTorus:
            ends = [_measured(end.normal.torus) for end in (self._first, self._second)]
        (A, low), (B, high) = ends
        width = self._second.place - self._first.place
        part = (place - self._first.place) / width
        between = {q: (1 - part) * a + part * B[q] for q, a in A.items()}
        return between, (1 - part) * low + part * high


def _measured(torus: QuasiPeriodic | RingTorus) -> tuple[dict[int, float], float]:
    amplitudes = {q: float(a) for q, a in amplitudes_by_seed(torus).items()}
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
    found = []
    for side, modes in ((first, before & changed), (second, after & changed)):
        for resonance in side.resonances:
            meets = resonance.kind in (PARAMETRIC, SUM)
            locked = abs(resonance.distance) < LOCKED
            if meets and locked and modes.issuperset(resonance.modes):
                found.append(resonance)
    return found


def _unstable(found: NormalFrequencies) -> set[int]:
    return {q for q, w in found.frequencies.items() if complex(w).imag}


def _real(found: NormalFrequencies) -> dict[int, float]:
    return {q: complex(w).real for q, w in found.frequencies.items()}


def _zero(function: Callable[[float], float], bracket: Bracket) -> float:
    """Where a function changes its sign, by Brent's secants."""
    from scipy.optimize import brentq

    low, high = bracket.low, bracket.high
    known = {low: bracket.at_low, high: bracket.at_high}

    def value(part: float) -> float:
        if part not in known:
            known[part] = function(part)
        return known[part]

    return float(brentq(value, low, high, xtol=PLACE))


def located(
    D: Callable[[float], float], bracket: Bracket, least: float
) -> tuple[float, float]:
    """As `collision`, between halves of the way where it leads out of it or D is too small.

    So are the ends of a narrow tongue, and of a short piece; then the error is what is left.
    """
    width = NARROWED * bracket.width
    while bracket.width > width:
        try:
            if bracket.least > least:
                return collision(D, bracket, least)
        except (*Failed, Outside):
            pass
        middle = (bracket.low + bracket.high) / 2
        value = D(middle)
        if abs(value) < NOISE:
            return middle, bracket.width
        bracket = bracket.half(middle, value)
    return (bracket.low + bracket.high) / 2, bracket.width


def collision(
    D: Callable[[float], float], bracket: Bracket, least: float
) -> tuple[float, float]:
    """The zero of a smooth function that cannot be computed where |D| < least, and its error.

    By secants of higher order: the inverse interpolation through points on both sides, drawn
    together until they stand at the least |D|. The error is what two points fewer change. Raises
    Outside.
    """
    low, high = bracket.low, bracket.high
    known = {low: bracket.at_low, high: bracket.at_high}
    best = _inverse(known)
    for _ in range(ROUNDS):
        if not low < best < high:
            raise Outside
        slope = _slope(known, best)
        room = SHARE * min(best - low, high - best, key=abs)
        nearest = min(least / slope, room)
        reach = max(nearest, min(room, SHARE * _spread(known, best)))
        for part in (best - reach, best + reach):
            known[part] = D(part)
        before, best = best, _inverse(_closest(known, best, 4))
        if reach <= nearest and abs(best - before) < reach / 2:
            break
    known = {best + x * reach / min(map(abs, NODES)) / 3: 0.0 for x in NODES}
    known = {part: D(part) for part in known}
    fewer = _inverse(_closest(known, best, len(NODES) - 2))
    best = _inverse(known)
    return best, abs(best - fewer)


def _inverse(known: Mapping[float, float]) -> float:
    """The place as a polynomial of the value, at the value 0 (Lagrange)."""
    total = 0.0
    for part, value in known.items():
        others = [other for other in known.values() if other != value]
        total += part * float(np.prod([b / (b - value) for b in others]))
    return total


def _closest(known: Mapping[float, float], best: float, count: int) -> dict[float, float]:
    near = sorted(known, key=lambda part: abs(part - best))[:count]
    return {part: known[part] for part in near}


def _slope(known: Mapping[float, float], best: float) -> float:
    (a, x), (b, y) = _closest(known, best, 2).items()
    return abs((y - x) / (b - a))


def _spread(known: Mapping[float, float], best: float) -> float:
    return max(abs(part - best) for part in _closest(known, best, 2))
