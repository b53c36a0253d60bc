"""Families of tori in energy: what was followed, and members between those that were met."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.families.members import Event, Level, Member, members_grid
from symfpu.families.normal_events import NormalEvent, event_fields
from symfpu.numbers.counted import counted
from symfpu.numbers.long_doubles import DIGITS, long
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, double, exact
from symfpu.refinement.conditions import frequency, ratio_conditions
from symfpu.refinement.guesses import extrapolated
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import refine, refined_torus
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, chain_fields, seeds_field
from symfpu.results.grid import Grid, Variable
from symfpu.results.result import Gridded
from symfpu.results.table import joined
from symfpu.tori.energy import Energy
from symfpu.tori.torus import Torus

# in the order in which they are told, as one and as several
KINDS_OF_EVENTS = {
    "fold": ("fold", "folds"),
    "resonance": ("resonance", "resonances"),
    "stability": ("change of stability", "changes of stability"),
}


class NotInFamily(SymfpuError):
    """No member of a family has this energy or frequency.

    Raised by `family`, `member_at_energy` and others.

    quantity : its name; value : asked for; reached : the range of the members, (least, largest);
        dimensionless.
    ending : why the family was not followed further. Ours.
    """

    def __init__(
        self, quantity: str, value: float, reached: tuple[float, float], ending: str
    ) -> None:
        self.quantity, self.value = quantity, value
        self.reached, self.ending = reached, ending
        least, largest = reached
        super().__init__(
            f"no member has {quantity} = {value:.10g}: "
            f"the family goes from {least:.10g} to {largest:.10g} and {ending}; "
            f"take a value in this range, or follow the family further"
        )


SHOWN_EVENTS = 12
SHOWN_MEMBERS = 8  # besides the first; the last one is among them


@dataclass(frozen=True, eq=False)
class Family(Gridded):
    """Tori of growing energy with one ratio of amplitudes or mode energies.

    Events tell what happens on the way. Made by `family`; dimensionless. Ours, or Appendix A.

    chain, seeds : the model and the s modes. members : in order of the way.
    events : folds, resonances and changes of stability, between members. ending : why it was not
        followed further. normal_events : what the normal frequencies do between members, where they
        are asked for.
    harmonic : whether its goal was a harmonic energy.
    energy_ratio : of the averaged mode energies by seed, where it is these that keep their ratio.

    >>> from symfpu import Chain, family
    >>> family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    Family(N=8, alpha=0.3, seeds=1, 3 members, H = 0.0005 .. 0.001, no events; it reached the
    energy asked for)
    >>> found = family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005").to_xarray()
    >>> dict(found.sizes), found.amplitude.dims
    ({'member': 3, 'seed': 1, 'mode': 7}, ('member', 'seed'))
    """

    chain: Chain
    seeds: tuple[int, ...]
    members: tuple[Member, ...] = field(repr=False)
    events: tuple[Event, ...]
    ending: str
    harmonic: bool = False
    energy_ratio: Mapping[int, float] | None = field(repr=False, default=None)
    normal_events: tuple[NormalEvent, ...] = ()

    def _answer(self) -> str:
        return f"it {self.ending}"

    def _lines(self, width: int | None) -> Iterator[str]:
        """Some members, the first and the last among them, and the strongest events."""
        yield repr(self)
        count = len(self.members)
        places = {round(i * (count - 1) / SHOWN_MEMBERS) for i in range(SHOWN_MEMBERS + 1)}
        if len(places) < count:
            shown = f"{len(places)} of {count} members shown"
            yield f"  {shown}; all with --json, or in -o FOLDER"
        yield from (f"  {self.members[k]!r}" for k in sorted(places))
        events = sorted(self.events, key=_weight, reverse=True)[:SHOWN_EVENTS]
        yield from (f"  {event!r}" for event in sorted(events, key=lambda e: e.after))
        yield from (f"  {event!r}" for event in self.normal_events)
        weaker = len(self.events) - SHOWN_EVENTS
        if weaker > 0:
            yield f"  ... and {weaker} weaker resonances"

    def _fields(self) -> Iterator[Field]:
        yield from chain_fields(self.chain)
        yield seeds_field(self.seeds)
        yield Field("ending", self.ending)
        energies = [m.energy for m in self.members]
        span = f"{len(self.members)}, H = {min(energies):.6g} .. {max(energies):.6g}"
        yield Field("members", [m.entry() for m in self.members], "members", span)
        yield Field("events", [event.entry() for event in self.events])
        counts = Counter(event.kind for event in self.events)
        for kind in filter(counts.__getitem__, KINDS_OF_EVENTS):
            yield Field("", label=f"events: {kind}", shown=str(counts[kind]))
        if any(m.normal for m in self.members):
            yield Field("normal_events", [event.entry() for event in self.normal_events])
        yield from event_fields(self.normal_events)

    def __repr__(self) -> str:
        chain = self.chain.label
        seeds = ",".join(map(str, self.seeds))
        doubtful = sum(m.verdict != "torus" for m in self.members)
        doubts = f", {doubtful} of them doubtful" if doubtful else ""
        members = f"{counted(len(self.members), 'member')}{doubts}"
        energies = [m.energy for m in self.members]
        H = f"H = {min(energies):.6g} .. {max(energies):.6g}"
        counts = Counter(event.kind for event in self.events)
        kinds = [kind for kind in KINDS_OF_EVENTS if counts[kind]]
        listed = [counted(counts[kind], *KINDS_OF_EVENTS[kind]) for kind in kinds]
        listed += list(map(repr, self.normal_events))
        events = ", ".join(listed) or "no events"
        return f"Family({chain}, seeds={seeds}, {members}, {H}, {events}; it {self.ending})"

    def _grid(self) -> Grid:
        grid = members_grid(self, self.members)
        known = attributes(
            self,
            self.chain,
            seeds=self.seeds,
            ending=self.ending,
            energy_ratio=self.energy_ratio,
        )
        if not self.events:
            return replace(grid, attributes=known)
        variables = {**grid.variables, **self._event_variables()}
        axes = {**grid.axes, "event": range(len(self.events))}
        return replace(grid, axes=axes, variables=variables, attributes=known)

    def _event_variables(self) -> dict[str, Variable]:
        events = self.events
        columns: dict[str, tuple[list[Any], str]] = {
            "event_kind": ([e.kind for e in events], "fold, resonance or stability"),
            "event_what": ([e.what for e in events], "what turns, begins or ends"),
            "event_after": ([e.after for e in events], "the member before it"),
            "event_energy": ([e.energy for e in events], "total energy H there"),
            "event_value": (
                [e.value for e in events],
                "what turns, or the divisor's coefficient",
            ),
            "event_mode": ([e.mode for e in events], "mode of a resonance, or 0"),
            "event_harmonic": ([joined(e.harmonic) for e in events], "nu of a resonance"),
        }
        return {name: Variable(("event",), *pair) for name, pair in columns.items()}


@public
def member_at_energy(found: Family, energy: Number, *, harmonic: bool) -> Torus[Newton]:
    """The torus of a family that has this energy, by Newton's method from the nearest member.

    found : the family. energy : an exact number, dimensionless; H, or with `harmonic` sum E_q,
        both at the angles zero.

    It keeps the ratio that the family keeps. A family by Appendix A keeps none: there the
    amplitudes have the ratio of the nearest member. Eq. eqmo; ours.
    Raises InputError; NotInFamily beyond the range of the members; NoTorus as `refine`
    does.

    >>> from symfpu import Chain, family
    >>> tori = family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    >>> round(float(member_at_energy(tori, "0.0007", harmonic=False).energy()), 12)
    0.0007
    """
    _require_family(found)
    value = double(energy, "energy")
    level = Level(value, bool(harmonic))
    known = np.array([level.of_member(m) for m in found.members])
    least, largest = float(known.min()), float(known.max())
    at_an_end = level.met(least) or level.met(largest)
    if not at_an_end and not least <= value <= largest:
        raise NotInFamily(level.name, value, (least, largest), found.ending)
    distances = np.abs(np.log(known / value))
    nearest = found.members[int(np.argmin(distances))].torus
    asked = Energy(energy, harmonic=harmonic, energy_ratio=found.energy_ratio)
    return refine(nearest, energy=asked)


@public
def member_at_frequency(
    found: Family, seed: int, frequency: Number
) -> tuple[Torus[Newton], ...]:
    """The tori of a family on which this seed has this frequency.

    One for every pair of neighbouring members with the frequency between them.

    found : the family. seed : one of its seeds. frequency : omega_seed, an exact number,
        dimensionless.

    They keep the ratio that the family keeps. Eq. eqmo; ours.
    Raises InputError; NotInFamily beyond the range of the members; NoTorus as `refine` does.

    >>> from symfpu import Chain, family
    >>> tori = family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    >>> [torus] = member_at_frequency(tori, 1, "0.3902")
    >>> [round(A, 9) for A in torus.amplitudes.values()]
    [0.099777085]
    """
    _require_family(found)
    if seed not in found.seeds:
        raise InputError("seed", seed, f"one of the seeds {found.seeds}", "name a seed")
    place, omega = found.seeds.index(seed), exact(frequency, "frequency")
    double(frequency, "frequency")
    known = [m.torus.frequencies[place] for m in found.members]
    least, largest = min(known), max(known)
    if not least <= omega <= largest:
        reached = float(least), float(largest)
        raise NotInFamily(f"omega_{seed}", float(omega), reached, found.ending)
    tori = []
    for k, (before, after) in enumerate(itertools.pairwise(known)):
        if (before - omega) * (after - omega) < 0 or omega == before:
            part = float((omega - before) / (after - before)) if after != before else 0.0
            tori.append(_between(found, k, place, omega, part))
    return tuple(tori)


def _require_family(found: object) -> None:
    if not isinstance(found, Family):
        raise InputError("found", type(found).__name__, "a Family", "pass what family gave")


def _between(
    found: Family, k: int, place: int, omega: Fraction, part: float
) -> Torus[Newton]:
    """The torus with this frequency, between member k and the next, near the given part."""
    with mpmath.workdps(2 * DIGITS):
        exact_omega = mpmath.mpf(omega.numerator) / omega.denominator
        linear = [found.chain.linear_frequency(q) for q in found.seeds]
        shift = long(exact_omega - linear[place])
    first, second = (m.torus.in_doubles() for m in found.members[k : k + 2])
    energies = found.energy_ratio is not None
    ratio = found.energy_ratio or found.members[k].amplitudes
    conditions = [
        frequency(place, shift, linear),
        *ratio_conditions(found.seeds, ratio, energies=energies),
    ]
    return refined_torus(extrapolated(first, second, part - 1), conditions)


def _weight(event: Event) -> float:
    return abs(event.value) if event.kind == "resonance" else float("inf")
