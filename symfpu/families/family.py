"""Families of tori in energy: followed from the linear limit, kept member by member, gone on with where they were left."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError, RunInterrupted, SymfpuError
from symfpu.families.appendix_a import AppendixAMember, NoFurtherMember, appendix_a_members
from symfpu.families.continuation import Event, Member, Way, extrapolated, first_torus, member, returned
from symfpu.families.events import continued, events_between
from symfpu.families.folder import BEGINNING, Kept, Plan, checked_family
from symfpu.numbers.typed import Number, exact
from symfpu.refinement.conditions import FrequencyShift, ratio_conditions
from symfpu.refinement.invariance import DIGITS, long
from symfpu.refinement.newton import Report
from symfpu.refinement.tori import TOLERANCE, NoTorus, RefinedTorus, refine_at_energy, refined_torus
from symfpu.tori.torus import QTorus

Progress = Callable[[str, float], None]

SECOND = 1.1  # ratio of the amplitudes of the second member and the first
MEMBERS = 200
APPENDIX_A = "appendix-a"
METHODS = ("arclength", APPENDIX_A)
APPENDIX_MEMBERS = 20  # about how many steps lead with Appendix A from the beginning to the energy asked for


class NotInFamily(SymfpuError):
    """No member of a family has this energy or frequency: raised by `family` and the methods of Family.

    quantity : its name; value : asked for; reached : the range of the members, (least, largest);
        dimensionless.
    ending : why the family was not followed further. Ours.
    """

    def __init__(self, quantity: str, value: float, reached: tuple[float, float], ending: str) -> None:
        self.quantity, self.value, self.reached, self.ending = quantity, value, reached, ending
        super().__init__(
            f"no member has {quantity} = {value:.10g}: the family goes from {reached[0]:.10g} to {reached[1]:.10g} and {ending}; "
            f"take a value in this range, or follow the family further"
        )


@dataclass(frozen=True, eq=False)
class Family:
    """Tori of growing energy with one ratio of amplitudes or mode energies, and what happens on the way.

    Made by `family`; dimensionless. Ours, or Appendix A.

    chain, seeds : the model and the s modes. members : in order of the way.
    events : folds, resonances and changes of stability, between members. ending : why it was not followed
        further.
    harmonic : whether its goal was a harmonic energy.
    energy_ratio : of the averaged mode energies by seed, where it is these that keep their ratio.

    >>> from symfpu import Chain, family
    >>> family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    Family(N=8, alpha=0.3, seeds=1, 4 members, H = 0.000500491 .. 0.00105223, no events; it reached the
    energy asked for)
    """

    chain: Chain
    seeds: tuple[int, ...]
    members: tuple[Member, ...] = field(repr=False)
    events: tuple[Event, ...]
    ending: str
    harmonic: bool = False
    energy_ratio: Mapping[int, float] | None = field(repr=False, default=None)

    def __repr__(self) -> str:
        energies = [m.energy for m in self.members]
        doubtful = sum(m.verdict != "torus" for m in self.members)
        doubts = f", {doubtful} of them doubtful" if doubtful else ""
        kinds = {kind: sum(e.kind == kind for e in self.events) for kind in ("fold", "resonance", "stability")}
        events = ", ".join(_counted(n, kind) for kind, n in kinds.items() if n)
        return (
            f"Family({repr(self.chain)[6:-1]}, seeds={','.join(map(str, self.seeds))}, {len(self.members)} members{doubts}, "
            f"H = {min(energies):.6g} .. {max(energies):.6g}, {events or 'no events'}; it {self.ending})"
        )

    def at_energy(self, energy: Number, *, harmonic: bool) -> RefinedTorus:
        """The torus of this energy, H or with `harmonic` sum E_q, from the nearest member; it keeps the ratio that the family keeps.

        A family by Appendix A keeps none: there the amplitudes have the ratio of the nearest member.
        Raises NotInFamily beyond the range of the members, NoTorus as `refine_at_energy` does.
        """
        value = float(exact(energy, "energy"))
        known = np.array([m.harmonic_energy if harmonic else m.energy for m in self.members])
        if not known.min() <= value <= known.max():
            raise NotInFamily("sum E_q" if harmonic else "H", value, (float(known.min()), float(known.max())), self.ending)
        nearest = self.members[int(np.argmin(np.abs(np.log(known / value))))]
        return refine_at_energy(nearest.torus, energy, harmonic=harmonic, energy_ratio=self.energy_ratio)

    def at_frequency(self, seed: int, frequency: Number) -> tuple[RefinedTorus, ...]:
        """The tori on which this seed has this frequency, one for every pair of neighbouring members with it between them.

        They keep the ratio that the family keeps. Raises NotInFamily beyond the range of the members, NoTorus as `refine` does.
        """
        if seed not in self.seeds:
            raise InputError("seed", seed, f"one of the seeds {self.seeds}", "name a seed")
        place, omega = self.seeds.index(seed), exact(frequency, "frequency")
        known = [m.torus.frequencies[place] for m in self.members]
        if not min(known) <= omega <= max(known):
            raise NotInFamily(f"omega_{seed}", float(omega), (float(min(known)), float(max(known))), self.ending)
        with mpmath.workdps(2 * DIGITS):
            shift = long(mpmath.mpf(omega.numerator) / omega.denominator - self.chain.linear_frequency(seed))
        found = []
        for k, (before, after) in enumerate(itertools.pairwise(known)):
            if (before - omega) * (after - omega) < 0 or omega == before:
                first, second = (m.torus.in_doubles() for m in self.members[k : k + 2])
                ratio = self.energy_ratio or self.members[k].amplitudes
                conditions = [FrequencyShift(place, shift), *ratio_conditions(self.seeds, ratio, energies=self.energy_ratio is not None)]
                part = float((omega - before) / (after - before)) if after != before else 0.0
                found.append(refined_torus(extrapolated(first, second, part - 1), conditions))
        return tuple(found)


def _counted(n: int, kind: str) -> str:
    if kind == "stability":
        return f"{n} change{'s' * (n > 1)} of stability"
    return f"{n} {kind}{'s' * (n > 1)}"


def family(
    chain: Chain,
    seeds: tuple[int, ...],
    to_energy: Number,
    *,
    harmonic: bool = False,
    amplitude_ratio: Mapping[int, Number] | None = None,
    energy_ratio: Mapping[int, Number] | None = None,
    from_energy: Number | None = None,
    members: int = MEMBERS,
    multipliers: bool = False,
    tolerance: float = TOLERANCE,
    method: str = "arclength",
    order: int | None = None,
    folder: Path | str | None = None,
    progress: Progress | None = None,
) -> Family:
    """The family of tori of these seeds from small energy to `to_energy`.

    chain, seeds : the model and distinct modes; energies, amplitudes and frequencies are dimensionless.
    to_energy : the goal, an exact number.
    harmonic : whether energies are sum E_q at the angles zero instead of H.
    amplitude_ratio, energy_ratio : by seed, at most one; energy_ratio is of mode energies averaged over the
        torus. Default equal mode energies.
    from_energy : where it begins, by the linear estimate; default a thousandth of the goal, a tenth with
        'appendix-a', or where the family in the folder began; where the series there lead to no torus it
        begins with the last member below of a family that is followed up to it.
    members : the most.
    multipliers : of breathers, with changes of stability. tolerance : as for `refine`. Both only with
        'arclength'.
    method : 'arclength', Newton's method and pseudo-arclength continuation; or 'appendix-a', the algorithm of
        the paper's Appendix A, corrected, whose members are truncated series of `order` and whose mode
        energies grow alike (no ratio is kept).
    order : of those series.
    folder : every member is kept there as a file at once; an interrupted family goes on from it, with other
        goals too.
    progress : called as (label, fraction done).

    The last member is the first one beyond the goal; `Family.at_energy` gives the torus at it. A family that
    cannot be followed to its goal is returned as far as it went; `ending` says why it ended. One that comes
    back to the linear limit ends there.
    Raises InputError for arguments out of range and for a folder that holds another family; where there is no
    first member, NoTorus, or NotInFamily if the family turns or ends below `from_energy`.

    >>> tori = family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    >>> [round(member.energy, 6) for member in tori.members]
    [0.0005, 0.000606, 0.000773, 0.001052]
    """
    if method not in METHODS:
        raise InputError("method", method, f"one of {', '.join(METHODS)}", "name one of these")
    if (method == APPENDIX_A) != (order is not None):
        raise InputError("order", order, f"an order with method = {APPENDIX_A!r}, none with others", "give both or neither")
    if order is not None and multipliers:
        raise InputError("multipliers", multipliers, f"False with method = {APPENDIX_A!r}", "its members are series: leave it out")
    arguments = (to_energy, harmonic, amplitude_ratio, energy_ratio, from_energy, members, multipliers, tolerance, order)
    plan = checked_family(chain, seeds, *arguments)
    kept = Kept(plan, None if folder is None else Path(folder))
    tell = progress or (lambda label, done: None)

    def report(line: str) -> None:
        tell(f"member {len(kept.members) + 1}: {line}", kept.plan.done(kept.members))

    try:
        return _by_arclength(kept.plan, kept, report) if order is None else _by_appendix_a(kept.plan, order, kept, tell)
    except KeyboardInterrupt as stop:
        if kept.folder is None:
            raise
        raise RunInterrupted(f"after {len(kept.members)} members", str(kept.folder)) from stop


def _by_arclength(plan: Plan, kept: Kept, report: Report, *, lower: bool = True) -> Family:
    """Newton's method and pseudo-arclength continuation, gone on with from the members there are. lower : as for `_begun`."""
    _begun(plan, kept, report, lower=lower)

    def ending() -> str:
        """Why the family is not followed further; empty if it is."""
        if plan.done([kept.members[-1]]) >= 1:
            return "reached the energy asked for"
        if returned(kept.members, tolerance=plan.tolerance):
            return "returned to the linear limit"
        return f"was left after {len(kept.members)} members, the most asked for" if len(kept.members) >= plan.most else ""

    why = ending()
    if not why:
        tori = [m.torus for m in kept.members[-3:] if isinstance(m.torus, RefinedTorus)]
        way = Way(
            plan.ratio, energies=plan.energies, tolerance=plan.tolerance, report=report, tori=tori, step=kept.step, largest=kept.largest
        )
        try:
            for found, events in continued(way, len(kept.members) - 1, multipliers=plan.multipliers, last=kept.members[-1]):
                kept.step, kept.largest = way.step, way.largest
                kept.add(found, events)
                if why := ending():
                    break
        except NoTorus as end:
            doubtful = " from a doubtful member" if kept.members[-1].warnings else ""
            why = f"ended: {end.reason}, with steps along the way down to {way.step:.1g}{doubtful}"
    ratio = plan.ratio if plan.energies else None
    return Family(plan.chain, plan.seeds, tuple(kept.members), tuple(kept.events), why, plan.harmonic, ratio)


def _begun(plan: Plan, kept: Kept, report: Report, *, lower: bool) -> None:
    """The first two members: from short series, or, where these lead to no torus, the last two of a family that begins lower.

    lower : whether such a family is looked for.
    """
    if len(kept.members) >= min(2, plan.most):
        return
    ratio = plan.ratio if plan.energies else None
    try:
        tori = [
            first_torus(plan.chain, amplitudes, energy_ratio=ratio, tolerance=plan.tolerance, report=report)
            for amplitudes in (plan.start, {q: a * SECOND for q, a in plan.start.items()})
        ]
    except NoTorus:
        if not lower:
            raise
        tori = _led_up(plan, kept, report)
    way = Way(plan.ratio, energies=plan.energies, tolerance=plan.tolerance, report=report, tori=tori, step=kept.step, largest=kept.largest)
    for torus in tori[len(kept.members) : plan.most]:
        found = member(torus, multipliers=plan.multipliers)
        kept.add(found, events_between(way, kept.members[-1], found, 0) if kept.members else [])


def _led_up(plan: Plan, kept: Kept, report: Report) -> list[RefinedTorus]:
    """The last tori, one below and one beyond, of a family that leads from a small part of the first energy up to it."""
    goal = plan.first
    below = replace(plan, goal=goal, start={q: a * math.sqrt(Fraction(BEGINNING)) for q, a in plan.start.items()}, most=MEMBERS)
    way = Kept(replace(below, multipliers=False), None)
    led = _by_arclength(way.plan, way, report, lower=False)
    if below.done(way.members) < 1:
        energies = [m.harmonic_energy if plan.harmonic else m.energy for m in way.members]
        raise NotInFamily("sum E_q" if plan.harmonic else "H", goal, (min(energies), max(energies)), led.ending)
    kept.step, kept.largest = way.step, way.largest
    return [m.torus for m in way.members[-2:] if isinstance(m.torus, RefinedTorus)]


def _by_appendix_a(plan: Plan, order: int, kept: Kept, tell: Progress) -> Family:
    """The same by the algorithm of Appendix A, gone on with from the members there are."""
    increment = (plan.goal - plan.first) / plan.chain.N / APPENDIX_MEMBERS
    known = [AppendixAMember(m.torus, increment) for m in kept.members if isinstance(m.torus, QTorus)]
    after = (known[-2], known[-1]) if len(known) > 1 else None
    del kept.members[len(known) if after else 0 :]
    ending = "reached the energy asked for"
    if plan.done(kept.members) >= 1:
        return Family(plan.chain, plan.seeds, tuple(kept.members), (), ending, plan.harmonic)
    if len(kept.members) >= plan.most:
        ending = f"was left after {len(kept.members)} members, the most asked for"
        return Family(plan.chain, plan.seeds, tuple(kept.members), (), ending, plan.harmonic)
    try:
        for found in appendix_a_members(plan.chain, plan.seeds, plan.start, order, increment=increment, after=after):
            torus = found.torus
            amplitudes = {q: float(a) for q, a in torus.amplitudes.items()}
            kept.add(Member(torus, amplitudes, found.energy, found.harmonic_energy, torus.residual(), torus.warnings), [])
            tell(f"member {len(kept.members)}", plan.done(kept.members))
            if plan.done(kept.members) >= 1:
                break
            if len(kept.members) >= plan.most:
                ending = f"was left after {len(kept.members)} members, the most asked for"
                break
    except NoFurtherMember as end:
        ending = f"ended: {end}"
    if not kept.members:
        raise SymfpuError(f"no first member: the family {ending}")
    return Family(plan.chain, plan.seeds, tuple(kept.members), (), ending, plan.harmonic)
