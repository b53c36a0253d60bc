"""Normal frequencies along a line of tori between two sets of amplitudes, with their events."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from symfpu.errors import InputError, RunInterrupted
from symfpu.families.normal_events import (
    RESONANCE_LENGTH,
    Known,
    NormalEvent,
    Stretch,
    event_fields,
)
from symfpu.families.normal_folder import KeptLine
from symfpu.families.normal_line import Line
from symfpu.files.progress import Progress, unheard
from symfpu.normal.frequencies import frequencies_of
from symfpu.normal.modes import NormalModes
from symfpu.normal.resonances import resonance_length_of
from symfpu.normal.torus import checked_modes, checked_solution
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, double, integer
from symfpu.results.attributes import attributes
from symfpu.results.field import (
    Field,
    chain_fields,
    exact_by_seed,
    numbers_by_seed,
    seeds_field,
)
from symfpu.results.grid import Grid, Variable
from symfpu.results.numbers import fifteen_digits
from symfpu.results.result import Gridded
from symfpu.tori.torus import Torus


@dataclass(frozen=True, eq=False)
class NormalFamily(Gridded):
    """Normal frequencies of tori on a line between two sets of amplitudes.

    Made by `normal_family`; dimensionless. Ours.

    members : NormalModes of each torus, in order. parts : 0 .. 1, where each is. events : on the
    way.

    >>> import symfpu
    >>> from symfpu import Chain, normal_family
    >>> breather = symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.1"})
    >>> normal_family(breather, {2: "0.2"}, members=3)
    NormalFamily(N=4, beta=1, 3 members, A_2=0.1 .. 0.2, stable, no events)
    """

    members: tuple[NormalModes, ...] = field(repr=False)
    parts: tuple[float, ...] = field(repr=False)
    events: tuple[NormalEvent, ...]

    def _lines(self, width: int | None) -> Iterator[str]:
        """A line a member, and the events."""
        torus = self.members[0].torus
        seeds = ",".join(map(str, torus.seeds))
        count = f"{len(self.members)} tori, {self.verdict}"
        yield f"{torus.chain.label}, seeds {seeds}: {count}"
        for one in self.members:
            amplitudes = self._amplitudes(one).items()
            where = ", ".join(f"A_{q}={a:.8g}" for q, a in amplitudes)
            yield f"  {where}: {frequencies_of(one, {})!r}"
        yield from (f"  {event!r}" for event in self.events)
        if not self.events:
            yield "  no events"

    def _fields(self) -> Iterator[Field]:
        torus = self.members[0].torus
        yield from chain_fields(torus.chain)
        yield seeds_field(torus.seeds)
        yield Field("verdict", self.verdict)
        placed = zip(self.members, self.parts, strict=True)
        members = [_member_entry(*pair) for pair in placed]
        yield Field("members", members, "members", str(len(members)))
        yield Field("events", [event.entry() for event in self.events])
        yield from event_fields(self.events)

    def __repr__(self) -> str:
        chain = self.members[0].torus.chain.label
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
        return {q: float(a) for q, a in found.torus.amplitudes.items()}

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


def _member_entry(found: NormalModes, part: float) -> dict[str, Any]:
    """A member of a line; its chain and seeds are those of the line."""
    return {
        "part": fifteen_digits(part),
        "amplitudes": numbers_by_seed(found.torus.amplitudes, None),
        "frequencies": exact_by_seed(found.torus.omega),
        **frequencies_of(found, {}).entry(),
    }


@public
def normal_family(
    solution: Torus,
    amplitudes: Mapping[int, Number],
    *,
    members: int = 9,
    modes: Any = None,
    resonance_length: int = RESONANCE_LENGTH,
    folder: Path | str | None = None,
    progress: Progress | None = None,
) -> NormalFamily:
    """Normal frequencies of the tori on the line from one to other amplitudes, with events.

    solution : the first torus or breather, refined, with fixed ends or of a ring as `normal_modes`
        takes it: standing waves stay what `unfold` makes. amplitudes : of the last one, by seed,
        exact numbers.
    members : how many tori, 2 or more, at equal steps. modes : which normal modes; default all.
    resonance_length : largest sum |nu_i| of the resonances whose crossing is an event; 0 for none.
        The onset of instability is found whatever its nu, up to 24.
    folder : every member is kept there as a file at once, and an interrupted line goes on from
        it. progress : called as (label, fraction), once a torus.

    Dimensionless. Each mode is continued from one member to the next. Events are located by
    Newton's method on the torus, which has among its conditions that the discriminant of two
    frequencies that meet is zero, or the distance of a resonance that is crossed. A resonance of
    two directions that turn out to be hyperbolic where it is met has an event at both ends.
    Instabilities that begin and end between two members without such a crossing are not seen.
    `family` with normal=True follows tori of one ratio, through folds, and locates the same events.
    Ours.
    Raises InputError, also for a folder that holds another line; NoTorus and NoNormalModes where a
    member has none; RunInterrupted, a KeyboardInterrupt, where there is a folder.

    >>> import symfpu
    >>> from symfpu import Chain, normal_family
    >>> breather = symfpu.torus(Chain(N=4, alpha="0.5"), (2,), amplitudes={2: "0.5"})
    >>> normal_family(breather, {2: "1"}, members=2, modes=[1])
    NormalFamily(N=4, alpha=0.5, 2 members, A_2=0.5 .. 1, ...)
    """
    checked_solution(solution)
    count = integer(members, "members", 2)
    length = resonance_length_of(resonance_length, solution.seeds, 0)
    chosen = checked_modes(solution, modes)
    line = Line(solution, _end(solution, amplitudes), count)
    kept = KeptLine(
        line.described(chosen, length), None if folder is None else Path(folder)
    )
    tell = progress or unheard
    try:
        line.take(kept.members)
        for n in range(len(kept.members), count):
            tell(f"torus {n + 1} of {count}", n / count)
            found = line.modes_at(n, chosen, kept.members[-1:])
            kept.add(found, _events(line, kept.members[-1:], found, n, length))
    except KeyboardInterrupt as stop:
        if kept.folder is None:
            raise
        done = f"after {len(kept.members)} tori"
        raise RunInterrupted(done, str(kept.folder)) from stop
    finally:
        kept.end()
    return NormalFamily(tuple(kept.members), line.parts, tuple(kept.events))


def _end(solution: Torus, amplitudes: Mapping[int, Number]) -> dict[int, float]:
    given: object = amplitudes
    if not isinstance(given, Mapping) or set(given) != set(solution.seeds):
        allowed = f"an amplitude for each of the seeds {solution.seeds}"
        raise InputError("amplitudes", given, allowed, "write it as {seed: number}")
    return {q: double(given[q], f"amplitudes, A_{q}") for q in solution.seeds}


def _events(
    line: Line, before: list[NormalModes], found: NormalModes, n: int, length: int
) -> list[NormalEvent]:
    """Between the last member and the one found; none before the second."""
    ends = zip(line.parts[n - len(before) : n + 1], [*before, found], strict=True)
    known = [Known(part, frequencies_of(modes, {}), modes) for part, modes in ends]
    if len(known) < 2:
        return []
    first, second = known
    return Stretch(line, first, second, n - 1).events(length)
