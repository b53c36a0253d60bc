"""Normal frequencies along a line of tori, and where they collide or resonate.

Two elliptic directions of opposite signature may meet, sigma_q + sigma_q' = nu.omega or 2 sigma_q =
nu.omega, and leave the real line as a hyperbolic pair: then the real parts stay locked at the
resonance. The frequencies have a root there; the discriminant has none,

    D = (sigma_q + sigma_q' - nu.omega)^2 before, -4 (Im sigma_q)^2 beyond,

the square of the difference of the two that meet. It passes through zero as a smooth function of
the amplitudes does, and so its zero is found as one of any such function, to the last digits. A
resonance that is crossed between real frequencies is a zero of its own distance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from symfpu.chain.chain import require_fixed_ends
from symfpu.errors import InputError
from symfpu.families.continuation import extrapolated
from symfpu.files.progress import Progress, unheard
from symfpu.frames.attributes import attributes
from symfpu.frames.grid import Grid, Variable
from symfpu.frames.recorded import Recorded
from symfpu.frames.tabled import Gridded
from symfpu.normal.modes import NoNormalModes, NormalModes
from symfpu.normal.resonances import (
    PARAMETRIC,
    SUM,
    ParametricResonance,
    crossed_resonances,
)
from symfpu.normal.search import checked_modes, normal_modes
from symfpu.notebook import Shown
from symfpu.numbers.typed import Number, exact, integer
from symfpu.refinement.tori import NoTorus, RefinedTorus, refine_at_amplitudes
from symfpu.tori.quasiperiodic import QuasiPeriodic, amplitudes_of, require_solution

STABILITY, RESONANCE = "stability", "resonance"
LOCKED = 1e-8  # distance up to which a hyperbolic direction is locked to a resonance
MET = 1e-8  # distance up to which a resonance was crossed, and not jumped over
PLACE = 1e-12  # of the whole way, to which the crossing of a resonance is located
ROUGH = 1e-6  # of the whole way, from which an event is said to be interpolated
# where two frequencies are nearer than this, relative, D is not computed but interpolated
LEAST_GAP = 5e-4
SHARE = 0.2  # of the bracket, that the points about an estimate reach out to
ROUNDS = 6  # of estimates, each with a point on either side
NODES = (-1.0, -0.6, -0.3, 0.3, 0.6, 1.0)  # of the last estimate, in units of the gap
HALVINGS = 6  # of a step to a torus that Newton's method does not reach at once

Failed = (NoTorus, NoNormalModes)


@dataclass(frozen=True)
class NormalEvent(Recorded):
    """Something on the way between two members of a `NormalFamily`; dimensionless. Ours.

    kind : 'stability' (two normal frequencies meet and leave the real line, or come back), or
        'resonance' (one is crossed, and both stay real). resonance : which, with its distance.
    after : the number of the first of the two members. part : where, 0 to 1 from the first member
        of the family to the last. amplitudes : by seed there.
    begins : whether the directions are hyperbolic beyond it; False for a resonance. error : of
        `part`, estimated; the whole step where no torus in between could be judged.

    >>> met = ParametricResonance("sum", (4, 6), (0, 2), 0.0)
    >>> NormalEvent("stability", met, 3, 0.5, {1: 0.1, 5: 0.4}, begins=True)
    stability: sigma_4 + sigma_6 = (0,2).omega, hyperbolic from A_1=0.1, A_5=0.4 on
    """

    kind: str
    resonance: ParametricResonance
    after: int
    part: float
    amplitudes: Mapping[int, float]
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


@dataclass(frozen=True, eq=False)
class NormalFamily(Shown, Gridded):
    """Normal frequencies of tori on a line between two sets of amplitudes.

    Made by `normal_family`; dimensionless. Ours.

    members : NormalModes of each torus, in order. parts : 0 .. 1, where each is. events : on the
    way.

    >>> from symfpu import Chain, breather_at_amplitude, normal_family
    >>> breather = breather_at_amplitude(Chain(N=4, beta=1), 2, "0.1")
    >>> normal_family(breather, {2: "0.2"}, members=3)
    NormalFamily(N=4, beta=1, 3 members, A_2=0.1 .. 0.2, stable, no events)
    """

    members: tuple[NormalModes, ...] = field(repr=False)
    parts: tuple[float, ...] = field(repr=False)
    events: tuple[NormalEvent, ...]

    def __repr__(self) -> str:
        chain = repr(self.members[0].torus.chain)
        chain = chain.removeprefix("Chain(").removesuffix(")")
        first, last = (self._amplitudes(found) for found in self.members[:: self._span])
        line = ", ".join(f"A_{q}={a:.6g} .. {last[q]:.6g}" for q, a in first.items())
        events = "; ".join(map(repr, self.events)) or "no events"
        count = f"{len(self.members)} members"
        return f"NormalFamily({chain}, {count}, {line}, {self.verdict}, {events})"

    @property
    def verdict(self) -> str:
        """In words."""
        unstable = sum(not found.stable for found in self.members)
        return f"{unstable} of them unstable" if unstable else "stable"

    @property
    def _span(self) -> int:
        return len(self.members) - 1

    @staticmethod
    def _amplitudes(found: NormalModes) -> dict[int, float]:
        return {q: float(a) for q, a in amplitudes_of(found.torus).items()}

    def _grid(self) -> Grid:
        torus = self.members[0].torus
        modes = [mode.mode for mode in self.members[0].modes]
        each, every = ("member", "mode"), ("member", "seed")
        sigma = np.array(
            [[complex(m.sigma) for m in found.modes] for found in self.members]
        )
        signature = [[m.signature for m in found.modes] for found in self.members]
        amplitudes = [list(self._amplitudes(found).values()) for found in self.members]
        omega = [[float(w) for w in found.torus.frequencies] for found in self.members]
        return Grid(
            axes={"member": range(len(self.members)), "mode": modes, "seed": torus.seeds},
            variables={
                "sigma": Variable(each, sigma.real, "normal frequency, real part"),
                "growth": Variable(each, np.abs(sigma.imag), "|Im sigma|"),
                "signature": Variable(each, signature, "Krein's signature"),
                "part": Variable(("member",), self.parts, "of the way, 0 to 1"),
                "amplitude": Variable(every, amplitudes, "amplitude A_q of a seed"),
                "frequency": Variable(every, omega, "frequency omega_q of a seed"),
            },
            attributes=attributes(self, torus.chain, seeds=torus.seeds),
            rows=each,
        )


def normal_family(
    solution: QuasiPeriodic,
    amplitudes: Mapping[int, Number],
    *,
    members: int = 9,
    modes: Any = None,
    resonance_length: int = 4,
    progress: Progress | None = None,
) -> NormalFamily:
    """Normal frequencies of the tori on the line from one to other amplitudes, with events.

    solution : the first torus or breather, refined, with fixed ends. amplitudes : of the last
        one, by seed, exact numbers.
    members : how many tori, 2 or more, at equal steps. modes : which normal modes; default all.
    resonance_length : largest sum |nu_i| of the resonances whose crossing is an event; 0 for none.
        The onset of instability is found whatever its nu, up to 12.
    progress : called as (label, fraction), once a torus.

    Dimensionless. Events are located by the zero of a smooth function of the amplitudes: the
    discriminant of two frequencies that meet, the distance of a resonance that is crossed. A
    resonance of two directions that turn out to be hyperbolic where it is met has an event at both
    ends. Instabilities that begin and end between two members without such a crossing are not
    seen. Ours. Raises InputError; NoTorus and NoNormalModes where a member has none.

    >>> from symfpu import Chain, breather_at_amplitude, normal_family
    >>> breather = breather_at_amplitude(Chain(N=4, alpha="0.5"), 2, "0.5")
    >>> normal_family(breather, {2: "1"}, members=2, modes=[1])
    NormalFamily(N=4, alpha=0.5, 2 members, A_2=0.5 .. 1, ...)
    """
    require_solution(solution, "solution")
    require_fixed_ends(solution.chain)
    count = integer(members, "members", 2)
    length = integer(resonance_length, "resonance_length", 0)
    chosen = checked_modes(solution, modes)
    line = _Line(solution, _end(solution, amplitudes), chosen)
    tell = progress or unheard
    parts = [n / (count - 1) for n in range(count)]
    found, events = [], []
    for n, part in enumerate(parts):
        tell(f"torus {n + 1} of {count}", n / count)
        found.append(line.modes_at(part))
        line.keep(part)
        if n:
            events += sorted(line.events(n - 1, found, parts, length), key=lambda e: e.part)
    return NormalFamily(tuple(found), tuple(parts), tuple(events))


def _end(solution: QuasiPeriodic, amplitudes: Mapping[int, Number]) -> dict[int, float]:
    given: object = amplitudes
    if not isinstance(given, Mapping) or set(given) != set(solution.seeds):
        allowed = f"an amplitude for each of the seeds {solution.seeds}"
        raise InputError("amplitudes", given, allowed, "write it as {seed: number}")
    return {q: float(exact(given[q], f"amplitudes, A_{q}")) for q in solution.seeds}


class _Line:
    """Tori between two sets of amplitudes, by the part of the way."""

    def __init__(
        self, first: QuasiPeriodic, end: Mapping[int, float], modes: tuple[int, ...]
    ) -> None:
        self.start = {q: float(a) for q, a in amplitudes_of(first).items()}
        self.end, self.modes = dict(end), modes
        self._known: dict[float, QuasiPeriodic] = {0.0: first}
        self._last: dict[float, QuasiPeriodic] = {}

    def amplitudes(self, part: float) -> dict[int, float]:
        """A_q by seed."""
        return {q: (1 - part) * a + part * self.end[q] for q, a in self.start.items()}

    def torus(self, part: float) -> QuasiPeriodic:
        """From the nearest one that is known, or by halves of the way to it."""
        if part in self._known:
            return self._known[part]
        if part not in self._last:
            self._last[part] = self._reached(part, HALVINGS)
        return self._last[part]

    def _reached(self, part: float, halvings: int) -> RefinedTorus:
        nearest = min(self._known, key=lambda p: abs(p - part))
        try:
            return refine_at_amplitudes(self._guess(part), self.amplitudes(part))
        except NoTorus:
            if not halvings:
                raise
        middle = (nearest + part) / 2
        self._known[middle] = self._reached(middle, halvings - 1)
        return self._reached(part, halvings - 1)

    def _guess(self, part: float) -> QuasiPeriodic:
        """On the line through the two nearest, or the nearest."""
        near = sorted(self._known, key=lambda p: abs(p - part))[:2]
        if len(near) == 1:
            return self._known[near[0]].in_doubles()
        last, before = near
        ratio = (part - last) / (last - before)
        earlier, later = (self._known[p].in_doubles() for p in (before, last))
        return extrapolated(earlier, later, ratio)

    def keep(self, part: float) -> None:
        """A member among the guesses."""
        self._known[part] = self.torus(part)
        self._last.clear()

    def modes_at(self, part: float, modes: tuple[int, ...] | None = None) -> NormalModes:
        """Normal modes of the torus there."""
        chosen = self.modes if modes is None else modes
        return normal_modes(self.torus(part), modes=chosen)

    def events(
        self, n: int, found: list[NormalModes], parts: list[float], length: int
    ) -> Iterator[NormalEvent]:
        """Between the members n and n + 1."""
        first, second = found[n : n + 2]
        low, high = parts[n : n + 2]
        done = set()
        for resonance in _changed(first, second):
            done.add(resonance.modes)
            yield self._onset(n, resonance, low, high, (first, second))
        for resonance in crossed_resonances(first, second, length):
            if resonance.modes not in done:
                yield from self._crossing(n, resonance, low, high, (first, second))

    def _onset(
        self,
        n: int,
        resonance: ParametricResonance,
        low: float,
        high: float,
        ends: tuple[NormalModes, NormalModes],
    ) -> NormalEvent:
        """Where the discriminant is zero."""
        values = tuple(discriminant(found, resonance) for found in ends)

        def of(part: float) -> float:
            return discriminant(self.modes_at(part, resonance.modes), resonance)

        gap = 2 * LEAST_GAP * abs(resonance.left_of(_real(ends[0])))
        met, begins = _moved(resonance, 0.0), values[1] < 0
        try:
            part, error = collision(of, low, high, values, gap**2)
        except Failed:
            part, error = _between(low, high, values), high - low
        where = self.amplitudes(part)
        return NormalEvent(STABILITY, met, n, part, where, begins, error)

    def _crossing(
        self,
        n: int,
        resonance: ParametricResonance,
        low: float,
        high: float,
        ends: tuple[NormalModes, NormalModes],
    ) -> Iterator[NormalEvent]:
        """Where the distance is zero: two onsets if both are hyperbolic there, none if it jumps."""
        values = tuple(resonance.distance_of(found) for found in ends)

        def of(part: float) -> float:
            return resonance.distance_of(self.modes_at(part, resonance.modes))

        try:
            part = _zero(of, low, high, values)
        except Failed:
            yield self._crossed_apart(n, resonance, of, low, high, values)
            return
        where = self.amplitudes(part)
        there = self.modes_at(part, resonance.modes)
        if there.growth:
            yield self._onset(n, resonance, low, part, (ends[0], there))
            yield self._onset(n, resonance, part, high, (there, ends[1]))
        elif abs(resonance.distance_of(there)) < MET:
            met = _moved(resonance, resonance.distance_of(there))
            yield NormalEvent(RESONANCE, met, n, part, where, error=PLACE)

    def _crossed_apart(
        self,
        n: int,
        resonance: ParametricResonance,
        of: Callable[[float], float],
        low: float,
        high: float,
        values: tuple[float, ...],
    ) -> NormalEvent:
        """Where modes that do not couple have one frequency they cannot be told apart."""
        gap = LEAST_GAP * max(map(abs, values)) / SHARE
        try:
            part, error = collision(of, low, high, values, gap)
        except Failed:
            part, error = _between(low, high, values), high - low
        where, met = self.amplitudes(part), _moved(resonance, 0.0)
        return NormalEvent(RESONANCE, met, n, part, where, error=error)


def _moved(resonance: ParametricResonance, distance: float) -> ParametricResonance:
    kind, modes, harmonic = resonance.kind, resonance.modes, resonance.harmonic
    return ParametricResonance(kind, modes, harmonic, distance)


def discriminant(found: NormalModes, resonance: ParametricResonance) -> float:
    """D of the directions of a resonance: below zero where they are hyperbolic."""
    growth = max(float(found.mode(q).growth) for q in resonance.modes)
    if growth:
        return -4 * growth**2
    return resonance.distance_of(found) ** 2


def _changed(first: NormalModes, second: NormalModes) -> list[ParametricResonance]:
    """The resonances to which directions are locked that are hyperbolic in just one of two."""
    before, after = (_unstable(found) for found in (first, second))
    changed = before ^ after
    found = []
    for side, modes in ((first, before & changed), (second, after & changed)):
        for resonance in side.resonances:
            meets = resonance.kind in (PARAMETRIC, SUM)
            locked = abs(resonance.distance) < LOCKED
            if meets and locked and modes.issuperset(resonance.modes):
                found.append(resonance)
    return found


def _unstable(found: NormalModes) -> set[int]:
    return {mode.mode for mode in found.modes if mode.growth}


def _real(found: NormalModes) -> dict[int, float]:
    return {q: complex(w).real for q, w in found.frequencies.items()}


def _between(low: float, high: float, ends: tuple[float, ...]) -> float:
    """Where a function has its zero if it is linear."""
    a, b = ends
    return low + (high - low) * a / (a - b)


def _zero(
    function: Callable[[float], float], low: float, high: float, ends: tuple[float, ...]
) -> float:
    """Where a function changes its sign, by Brent's secants."""
    from scipy.optimize import brentq

    known = dict(zip((low, high), ends, strict=True))

    def value(part: float) -> float:
        if part not in known:
            known[part] = function(part)
        return known[part]

    return float(brentq(value, low, high, xtol=PLACE))


def collision(
    D: Callable[[float], float],
    low: float,
    high: float,
    ends: tuple[float, ...],
    least: float,
) -> tuple[float, float]:
    """The zero of a smooth function that cannot be computed where |D| < least, and its error.

    By secants of higher order: the inverse interpolation through points on both sides, drawn
    together until they stand at the least |D|. The error is what two points fewer change.
    """
    known = dict(zip((low, high), ends, strict=True))
    best = _inverse(known)
    for _ in range(ROUNDS):
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
