"""Families followed from the linear limit or from a torus, kept member by member, gone on with."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from symfpu.breathers.equations import NoPeriodicOrbit
from symfpu.breathers.from_rest import BACK_AT_REST
from symfpu.chain.chain import Chain, require_any_chain, require_chain
from symfpu.errors import InputError, RunInterrupted, SymfpuError
from symfpu.families.appendix_a import (
    AppendixAMember,
    NoFurtherMember,
    member_at,
    members_between,
)
from symfpu.families.beginnings import GUESS_ORDER, first_at, returned
from symfpu.families.breather_walk import BreatherWalk
from symfpu.families.continuation import Way
from symfpu.families.events import continued, events_between
from symfpu.families.family import Family, NotInFamily
from symfpu.families.folder import BEGINNING, Kept, Plan, checked_family
from symfpu.families.members import Event, Level, Member, member, series_member
from symfpu.families.normal_events import RESONANCE_LENGTH, NormalEvent
from symfpu.files.progress import Progress, unheard
from symfpu.normal.resonances import resonance_length_of
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, integer
from symfpu.refinement.conditions import ratio_conditions
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import TOLERANCE, NoTorus
from symfpu.tori.from_series import FromSeries
from symfpu.tori.short_series import short_series
from symfpu.tori.torus import Torus, comes_from

SECOND_RATIO = 1.1  # ratio of the amplitudes of the second member and the first
MEMBERS = 200
APPENDIX_A = "appendix-a"
METHODS = ("arclength", APPENDIX_A)
ENDED_AT_GOAL = "reached the energy asked for"
LOWERING = 0.25  # factor of a first energy that no torus of the series has
LOWEST_SHARE = 1e-12  # the part of it that is given up
# about how many steps lead with Appendix A from the beginning to the energy asked for
APPENDIX_MEMBERS = 20


@public
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
    normal: bool = False,
    resonance_length: int = RESONANCE_LENGTH,
    tolerance: float = TOLERANCE,
    method: str = "arclength",
    order: int | None = None,
    folder: Path | str | None = None,
    progress: Progress | None = None,
) -> Family:
    """The family of tori of these seeds from small energy to `to_energy`.

    chain, seeds : the model and distinct modes; energies, amplitudes and frequencies are
        dimensionless. On a ring seeds are signed and tori are travelling waves; standing ones have
        the family of their fixed ends, unfolded.
    to_energy : the goal, an exact number.
    harmonic : whether energies are sum E_q instead of H: at the angles zero, of a ring averaged
        over them.
    amplitude_ratio, energy_ratio : by seed, at most one; energy_ratio is of mode energies
        averaged over the torus. Default equal mode energies. Opposite seeds want an
        amplitude_ratio other than 1: their E_q are one, and waves of equal amplitudes stand.
    from_energy : of the first member. Default: where the family in the folder began; else for
        breathers with fixed ends a thousandth of the goal, for other tori an energy that does not
        depend on the goal, where a frequency is shifted by a thousandth; a tenth of the goal with
        'appendix-a'. Where the series there lead to no torus it is reached by a family from below.
    members : the most.
    multipliers : of breathers, with changes of stability. normal : normal frequencies of every
        member, each continued from the member before, with the places where they collide and
        those of resonances up to sum |nu_i| = resonance_length (`normal_family` says how).
        tolerance : as for `refine`. All only with 'arclength'.
    method : 'arclength', Newton's method and pseudo-arclength continuation; or 'appendix-a', the
        algorithm of the paper's Appendix A, corrected, whose members are truncated series of
        `order` and whose mode energies grow alike (no ratio is kept), with fixed ends.
    order : of those series.
    folder : every member is kept there as a file at once; an interrupted family goes on from it,
        with other goals too.
    progress : called as (label, fraction done).

    Breathers with fixed ends are the points of the walk from rest, whose steps depend on neither
    energy. At a resonance it follows the curve, or passes a gap narrower than 1e-3, as an event.
    The last member of a family that reaches its goal has this energy, to 1e-12. Of a folder with
    members beyond the goal these are left out, and the member at the goal is not kept. A family
    that cannot be followed to its goal is returned as far as it went; `ending` says where and why
    it ended. One that comes back to the linear limit ends there.
    Raises InputError for arguments out of range and for a folder that holds another family; where
    there is no first member, NoTorus, or NotInFamily if the family turns or ends below
    `from_energy`, on a ring ResonantDivisor where opposite waves drive each other at the lowest
    orders; RunInterrupted, a KeyboardInterrupt, where there is a folder.

    >>> tori = family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    >>> [round(member.energy, 6) for member in tori.members]
    [0.0005, 0.000957, 0.001]
    """
    require_any_chain(chain)
    if method == APPENDIX_A:
        require_chain(chain)
    if method not in METHODS:
        raise InputError(
            "method", method, f"one of {', '.join(METHODS)}", "name one of these"
        )
    if (method == APPENDIX_A) != (order is not None):
        raise InputError(
            "order",
            order,
            f"an order with method = {APPENDIX_A!r}, none with others",
            "give both or neither",
        )
    if order is not None and (multipliers or normal):
        raise InputError(
            "multipliers" if multipliers else "normal",
            True,
            f"False with method = {APPENDIX_A!r}",
            "its members are series: leave it out",
        )
    length = integer(resonance_length, "resonance_length", 0)
    arguments = (
        to_energy,
        harmonic,
        amplitude_ratio,
        energy_ratio,
        from_energy,
        members,
        multipliers,
        tolerance,
        order,
        length if normal else None,
    )
    plan = checked_family(chain, seeds, *arguments)
    if normal:
        resonance_length_of(length, plan.seeds, 0)
    tell = progress or unheard

    def of_member(label: str, _: float) -> None:
        tell(f"member {len(kept.members) + 1}: {label}", kept.plan.done(kept.members))

    kept = Kept(plan, None if folder is None else Path(folder), of_member)
    try:
        return (
            _by_arclength(kept.plan, kept, of_member)
            if order is None
            else _by_appendix_a(kept.plan, order, kept, tell)
        )
    except KeyboardInterrupt as stop:
        if kept.folder is None:
            raise
        raise RunInterrupted(
            f"after {counted(len(kept.members), 'member')}", str(kept.folder)
        ) from stop
    finally:
        kept.end()


def _by_arclength(
    plan: Plan, kept: Kept, progress: Progress, *, lower: bool = True
) -> Family:
    """Newton's method and pseudo-arclength continuation, gone on with from the members there are.

    lower : as for `_begun`. Breathers of fixed ends are the points of one walk.
    """
    if len(plan.seeds) == 1 and not plan.chain.periodic:
        return _by_walk(plan, kept, progress)
    if any(plan.level.passed(plan.level.of_member(m)) for m in kept.members):

        def at_goal(k: int) -> Member:
            way = _way(plan, kept, progress, _refined(kept.members[k - 1 : k + 1]))
            return kept.measured(way.between(plan.level))

        return _up_to_goal(plan, kept, at_goal)
    why = _begun(plan, kept, progress, lower=lower) or _ending(plan, kept)
    if not why:
        way = _way(plan, kept, progress)
        try:
            for found in continued(
                way,
                kept.members,
                plan.level,
                multipliers=plan.multipliers,
                normal=kept.normal,
            ):
                kept.step, kept.largest = way.step, way.largest
                kept.cut(found.kept)
                kept.add(found.member, found.events)
                if why := _ending(plan, kept):
                    break
        except NoTorus as end:
            why = _ended(kept, end, way.step)
    return _family(plan, kept.members, kept.events, why)


def _by_walk(plan: Plan, kept: Kept, progress: Progress) -> Family:
    """The points of the walk from rest, whose places depend on neither end of the family."""
    walk = _walk(plan, progress)

    def at_goal(k: int) -> Member:
        [(torus, _)] = itertools.islice(walk.after(_refined(kept.members)[k - 1]), 1)
        return kept.measured(torus)

    if any(plan.level.passed(plan.level.of_member(m)) for m in kept.members):
        return _up_to_goal(plan, kept, at_goal)
    if not kept.members:
        kept.add(kept.measured(_first_of(walk, plan)), [])
    why = _ending(plan, kept)
    try:
        for torus, met in () if why else walk.after(_refined(kept.members)[-1]):
            after = len(kept.members) - 1
            way = _way(plan, kept, progress, [*_refined(kept.members[-2:]), torus])
            normal = kept.normal.of(torus, way) if kept.normal else None
            found = member(torus, multipliers=plan.multipliers, normal=normal)
            events = events_between(way, kept.members[-1], found, after, kept.normal)
            kept.add(found, [*(replace(e, after=after) for e in met), *events])
            if why := _ending(plan, kept):
                break
    except NoTorus as end:
        last = kept.members[-1]
        why = f"{_turned(kept)}ended at H = {last.energy:.7g}: {end.reason}"
    return _family(plan, kept.members, kept.events, why)


def _walk(plan: Plan, progress: Progress) -> BreatherWalk:
    """NoTorus where no orbit continues the linear mode."""
    try:
        return BreatherWalk(plan, progress)
    except NoPeriodicOrbit as failure:
        guess = short_series(plan.chain, plan.start, GUESS_ORDER)
        assert comes_from(guess, FromSeries)
        raise NoTorus(str(failure), guess, guess.residual()) from failure


def _first_of(walk: BreatherWalk, plan: Plan) -> Torus[Newton]:
    """The torus of the first energy; NotInFamily where the family has none."""
    try:
        return walk.first()
    except NoPeriodicOrbit as failure:
        top, turned = walk.reached()
        ending = f"ended: {failure.reason}"
        if turned:
            ending = f"turned at {plan.level.name} = {top:.7g} and {_after_turn(ending)}"
        level = plan.level.name
        raise NotInFamily(level, plan.first, (0.0, top), ending) from failure


def _after_turn(ending: str) -> str:
    return "returned to the linear limit" if BACK_AT_REST in ending else ending


def _way(
    plan: Plan, kept: Kept, progress: Progress, tori: Sequence[Torus[Newton]] = ()
) -> Way:
    """The way of a family from its last members, or from other tori."""
    known = tori or [m.torus for m in kept.members[-3:] if comes_from(m.torus, Newton)]
    return Way(
        plan.ratio,
        energies=plan.energies,
        tolerance=plan.tolerance,
        progress=progress,
        tori=known,
        step=kept.step,
        largest=kept.largest,
    )


def _family(
    plan: Plan,
    members: Sequence[Member],
    events: Sequence[Event | NormalEvent],
    why: str,
) -> Family:
    return Family(
        chain=plan.chain,
        seeds=plan.seeds,
        members=tuple(members),
        events=tuple(e for e in events if isinstance(e, Event)),
        ending=why,
        harmonic=plan.harmonic,
        energy_ratio=plan.ratio if plan.energies and plan.order is None else None,
        normal_events=tuple(e for e in events if isinstance(e, NormalEvent)),
    )


def _ending(plan: Plan, kept: Kept) -> str:
    """Why the family is not followed further; empty if it is."""
    if plan.done([kept.members[-1]]) >= 1:
        return ENDED_AT_GOAL
    if returned(kept.members, tolerance=plan.tolerance):
        return f"{_turned(kept)}returned to the linear limit"
    if len(kept.members) < plan.most:
        return ""
    return f"was left after {counted(len(kept.members), 'member')}, the most asked for"


def _turned(kept: Kept) -> str:
    """Where the energy turned, if it did."""
    folds = [
        event.energy
        for event in kept.events
        if isinstance(event, Event) and (event.kind, event.what) == ("fold", "H")
    ]
    return f"turned at H = {folds[-1]:.7g} and " if folds else ""


def _ended(kept: Kept, end: NoTorus, step: float) -> str:
    """Where and why no further member was found."""
    last = kept.members[-1]
    doubtful = " from a doubtful member" if last.warnings else ""
    nearest = (
        last.torus.origin.near_resonances[:1] if comes_from(last.torus, Newton) else ()
    )
    divisor = "".join(f"; the smallest divisor there is {near!r}" for near in nearest)
    steps = f"with steps along the way down to {step:.1g}{doubtful}{divisor}"
    return f"{_turned(kept)}ended at H = {last.energy:.7g}: {end.reason}, {steps}"


def _up_to_goal(plan: Plan, kept: Kept, at_goal: Callable[[int], Member]) -> Family:
    """The part up to the goal of a family that was followed beyond it.

    Raises InputError if it begins beyond.

    at_goal : gives the member at the goal between a member, by its place, and the one before.
    """
    energies = [plan.level.of_member(m) for m in kept.members]
    beyond = next(k for k, energy in enumerate(energies) if plan.level.passed(energy))
    members = kept.members[: beyond + 1]
    events = [e for e in kept.events if e.after < beyond]
    if not plan.level.met(energies[beyond]):
        if beyond == 0:
            allowed = f"more than {energies[0]:.10g}, where the family in the folder begins"
            raise InputError("to_energy", plan.goal, allowed, "choose another folder")
        found = at_goal(beyond)
        members = [*members[:-1], found]
        events = [e for e in events if e.after < beyond - 1 or e.energy <= found.energy]
    return _family(plan, members, events, ENDED_AT_GOAL)


def _refined(members: Sequence[Member]) -> list[Torus[Newton]]:
    return [m.torus for m in members if comes_from(m.torus, Newton)]


def _begun(plan: Plan, kept: Kept, progress: Progress, *, lower: bool) -> str:
    """The first two members: from short series, or from a family that begins lower.

    lower : whether such a family is looked for, where short series fail.

    Returns why there is no second member; empty if there is.
    """
    if len(kept.members) >= min(2, plan.most):
        return ""
    why = ""
    try:
        tori = _from_series(plan, kept, progress)
    except NoTorus:
        if not lower:
            raise
        tori, why = _led_up(plan, kept, progress)
    way = _way(plan, kept, progress, tori)
    for torus in tori[len(kept.members) : plan.most]:
        found, before = kept.measured(torus), kept.members[-1:]
        events = [e for m in before for e in events_between(way, m, found, 0, kept.normal)]
        kept.add(found, events)
    return why


def _from_series(plan: Plan, kept: Kept, progress: Progress) -> list[Torus[Newton]]:
    """The torus of the first energy, or the one member there is, and one a little above.

    Both are below the goal, or at it.
    """
    ratio = ratio_conditions(plan.seeds, plan.ratio, energies=plan.energies)
    begin = Level(plan.first, plan.harmonic)
    known = _refined(kept.members)

    def near_rest(level: Level, amplitudes: Mapping[int, float]) -> Torus[Newton]:
        tolerance = plan.tolerance
        return first_at(
            level, plan.chain, amplitudes, ratio, tolerance=tolerance, progress=progress
        )

    first = known[0] if known else near_rest(begin, plan.start)
    energy = begin.of(first)
    above = Level(min(SECOND_RATIO**2 * energy, plan.goal), plan.harmonic)
    scale = math.sqrt(above.energy / energy)
    raised = {q: scale * a for q, a in first.amplitudes.items()}
    tori = [first, near_rest(above, raised)]
    _way(plan, kept, progress, tori).require_neighbours()
    return tori


def _led_up(plan: Plan, kept: Kept, progress: Progress) -> tuple[list[Torus[Newton]], str]:
    """The torus of the first energy, and the next one, by a family from a small part of it.

    With why there is no next one. Raises NotInFamily where that family does not reach the energy.
    """
    goal = Level(plan.first, plan.harmonic)
    low = {q: a * math.sqrt(Fraction(BEGINNING)) for q, a in plan.start.items()}
    below = replace(plan, goal=goal.energy, start=low, most=MEMBERS)
    below = replace(below, multipliers=False, normal=None)
    led = Kept(below, None, progress)
    leading = _by_arclength(below, led, progress, lower=False)
    if below.done(led.members) < 1:
        energies = [goal.of_member(m) for m in led.members]
        raise NotInFamily(
            goal.name, goal.energy, (min(energies), max(energies)), leading.ending
        )
    way = _way(plan, led, progress)
    first = way.tori[-1]
    kept.step, kept.largest = way.step, way.largest
    try:
        second = way.advance(plan.level)
    except NoTorus as end:
        return [first], _ended(led, end, way.step)
    kept.step, kept.largest = way.step, way.largest
    return [first, second], ""


def _by_appendix_a(plan: Plan, order: int, kept: Kept, tell: Progress) -> Family:
    """The same by the algorithm of Appendix A, gone on with from the members there are."""
    increment = (plan.goal - plan.first) / plan.chain.N / APPENDIX_MEMBERS
    tori = [m.torus for m in kept.members if comes_from(m.torus, FromSeries)]
    known = [AppendixAMember(torus, increment) for torus in tori]

    def at_goal(k: int) -> Member:
        between = member_at(plan.level, known[k - 1], known[k])
        return series_member(between.torus)

    if any(plan.level.passed(plan.level.of_member(m)) for m in kept.members):
        return _up_to_goal(plan, kept, at_goal)
    why = f"was left after {counted(len(kept.members), 'member')}, the most asked for"
    if len(kept.members) >= plan.most:
        return _family(plan, kept.members, (), why)
    after = (known[-2], known[-1]) if len(known) > 1 else None
    kept.cut(len(known) if after else 0)
    try:
        why = _followed(plan, kept, tell, _steps(plan, order, increment, after))
    except NoFurtherMember as end:
        if not kept.members:
            raise SymfpuError(f"no first member: the family ended: {end}") from end
        why = f"ended at H = {kept.members[-1].energy:.7g}: {end}"
    return _family(plan, kept.members, (), why)


def _steps(
    plan: Plan,
    order: int,
    increment: float,
    after: tuple[AppendixAMember, AppendixAMember] | None,
) -> Iterator[AppendixAMember]:
    """The members by Appendix A that come next.

    Where no beginning is asked for, the first has an energy from which a step leads on.
    """
    begin = Level(plan.first, plan.harmonic)
    while True:
        steps = members_between(
            plan.chain,
            plan.seeds,
            plan.start,
            order,
            increment=increment,
            begin=begin,
            goal=plan.level,
            after=after,
        )
        if plan.chosen or after is not None or begin.energy < LOWEST_SHARE * plan.first:
            return steps
        try:
            return itertools.chain([next(steps), next(steps)], steps)
        except NoFurtherMember:
            begin = replace(begin, energy=LOWERING * begin.energy)


def _followed(
    plan: Plan, kept: Kept, tell: Progress, steps: Iterator[AppendixAMember]
) -> str:
    """Keeps members as long as they are asked for; why there are no more."""
    for found in steps:
        kept.add(series_member(found.torus), [])
        tell(f"member {len(kept.members)}", plan.done(kept.members))
        if plan.done(kept.members) < 1 and len(kept.members) >= plan.most:
            return (
                f"was left after {counted(len(kept.members), 'member')}, the most asked for"
            )
    return ENDED_AT_GOAL
