"""Normal frequencies along a line of tori between two sets of amplitudes, with their events."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from symfpu.chain.chain import require_fixed_ends
from symfpu.errors import InputError, RunInterrupted
from symfpu.families.continuation import extrapolated
from symfpu.families.normal_events import (
    RESONANCE_LENGTH,
    Known,
    NormalEvent,
    Stretch,
)
from symfpu.families.normal_folder import KeptLine
from symfpu.files.progress import Progress, unheard
from symfpu.frames.attributes import attributes
from symfpu.frames.grid import Grid, Variable
from symfpu.frames.tabled import Gridded
from symfpu.normal.frequencies import frequencies_of
from symfpu.normal.modes import NormalModes
from symfpu.normal.search import checked_modes, followed_modes
from symfpu.notebook import Shown
from symfpu.numbers.counted import counted
from symfpu.numbers.typed import Number, exact, integer
from symfpu.refinement.tori import NoTorus, RefinedTorus, refine_at_amplitudes
from symfpu.tori.quasiperiodic import QuasiPeriodic, require_solution
from symfpu.tori.ring_torus import amplitudes_by_seed

HALVINGS = 6  # of a step to a torus that Newton's method does not reach at once


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
        count = counted(len(self.members), "member")
        return f"NormalFamily({chain}, {count}, {line}, {self.verdict}, {events})"

    @property
    def verdict(self) -> str:
        """In words."""
        unstable = sum(found.stable is False for found in self.members)
        return f"{unstable} of them unstable" if unstable else "stable"

    @property
    def _span(self) -> int:
        return len(self.members) - 1

    @staticmethod
    def _amplitudes(found: NormalModes) -> dict[int, float]:
        return {q: float(a) for q, a in amplitudes_by_seed(found.torus).items()}

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
    resonance_length: int = RESONANCE_LENGTH,
    folder: Path | str | None = None,
    progress: Progress | None = None,
) -> NormalFamily:
    """Normal frequencies of the tori on the line from one to other amplitudes, with events.

    solution : the first torus or breather, refined, with fixed ends. amplitudes : of the last
        one, by seed, exact numbers.
    members : how many tori, 2 or more, at equal steps. modes : which normal modes; default all.
    resonance_length : largest sum |nu_i| of the resonances whose crossing is an event; 0 for none.
        The onset of instability is found whatever its nu, up to 12.
    folder : every member is kept there as a file at once, and an interrupted line goes on from
        it. progress : called as (label, fraction), once a torus.

    Dimensionless. Each mode is continued from one member to the next. Events are located by the
    zero of a smooth function of the amplitudes: the discriminant of two frequencies that meet, the
    distance of a resonance that is crossed. A resonance of two directions that turn out to be
    hyperbolic where it is met has an event at both ends. Instabilities that begin and end between
    two members without such a crossing are not seen. `family` with normal=True follows tori of one
    ratio, through folds, and locates the same events. Ours.
    Raises InputError, also for a folder that holds another line; NoTorus and NoNormalModes where a
    member has none; RunInterrupted, a KeyboardInterrupt, where there is a folder.

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
    line = _Line(solution, _end(solution, amplitudes), count)
    kept = KeptLine(
        line.described(chosen, length), None if folder is None else Path(folder)
    )
    line.take(kept.members)
    tell = progress or unheard
    try:
        for n in range(len(kept.members), count):
            tell(f"torus {n + 1} of {count}", n / count)
            found = line.modes_at(n, chosen, kept.members[-1:])
            kept.add(found, _events(line, kept.members[-1:], found, n, length))
    except KeyboardInterrupt as stop:
        if kept.folder is None:
            raise
        done = f"after {len(kept.members)} tori"
        raise RunInterrupted(done, str(kept.folder)) from stop
    return NormalFamily(tuple(kept.members), line.parts, tuple(kept.events))


def _end(solution: QuasiPeriodic, amplitudes: Mapping[int, Number]) -> dict[int, float]:
    given: object = amplitudes
    if not isinstance(given, Mapping) or set(given) != set(solution.seeds):
        allowed = f"an amplitude for each of the seeds {solution.seeds}"
        raise InputError("amplitudes", given, allowed, "write it as {seed: number}")
    return {q: float(exact(given[q], f"amplitudes, A_{q}")) for q in solution.seeds}


def _events(
    line: _Line, before: list[NormalModes], found: NormalModes, n: int, length: int
) -> list[NormalEvent]:
    """Between the last member and the one found; none before the second."""
    ends = zip(line.parts[n - len(before) : n + 1], [*before, found], strict=True)
    known = [Known(part, frequencies_of(modes, {}), modes) for part, modes in ends]
    if len(known) < 2:
        return []
    first, second = known
    return Stretch(line.torus, first, second, n - 1).events(length)


class _Line:
    """Tori between two sets of amplitudes, by the part of the way."""

    def __init__(
        self, first: QuasiPeriodic, end: Mapping[int, float], members: int
    ) -> None:
        self.start = {q: float(a) for q, a in amplitudes_by_seed(first).items()}
        self.end = dict(end)
        self.parts = tuple(n / (members - 1) for n in range(members))
        self._chain = first.chain
        self._known: dict[float, QuasiPeriodic] = {0.0: first}
        self._last: dict[float, QuasiPeriodic] = {}

    def described(self, modes: tuple[int, ...], length: int) -> dict[str, Any]:
        """What two runs of one line have in common."""
        ends = (self.start, self.end)
        return {
            "N": self._chain.N,
            **self._chain.typed_law,
            "amplitudes": [{str(q): repr(a) for q, a in end.items()} for end in ends],
            "members": len(self.parts),
            "modes": list(modes),
            "resonance_length": length,
        }

    def take(self, members: list[NormalModes]) -> None:
        """Members of a run that was interrupted."""
        pairs = zip(self.parts, members, strict=False)
        known = {part: found.torus for part, found in pairs}
        self._known |= {x: t for x, t in known.items() if isinstance(t, QuasiPeriodic)}

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

    def modes_at(
        self, n: int, modes: tuple[int, ...], before: list[NormalModes]
    ) -> NormalModes:
        """Normal modes of a member, continued from those of the one before."""
        part = self.parts[n]
        self._known[part] = self.torus(part)
        self._last.clear()
        near = before[0] if before else None
        found, missing = followed_modes(self._known[part], near, modes=modes)
        for none in missing.values():
            raise none
        return found
