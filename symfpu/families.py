"""Families of tori in energy: followed from the linear limit, kept member by member, gone on with where they were left."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import mpmath
import numpy as np

from symfpu.bundle import load, save
from symfpu.certificates import write_text
from symfpu.chain import Chain, decimal
from symfpu.errors import InputError, SymfpuError
from symfpu.exact import Number, exact, integer, seed_modes
from symfpu.refinement.appendix_a import AppendixAMember, NoFurtherMember, appendix_a_members
from symfpu.refinement.conditions import FrequencyShift, ratio_conditions
from symfpu.refinement.continuation import FIRST_STEP, Event, Member, Way, continued, extrapolated, first_torus, member
from symfpu.refinement.invariance import DIGITS, long
from symfpu.refinement.tori import TOLERANCE, NoTorus, RefinedTorus, refine_at_energy, refined_torus
from symfpu.torus import QTorus

Json = dict[str, Any]
Progress = Callable[[str, float], None]

BEGINNING = "1/1000"  # of the energy asked for, where a family begins by default
SECOND = 1.1  # ratio of the amplitudes of the second member and the first
MEMBERS = 200
SMALLEST, LARGEST = Fraction(1, 10**300), 10**300  # energies whose doubles are neither 0 nor infinite
RECORD = "family.json"
APPENDIX_A = "appendix-a"
METHODS = ("arclength", APPENDIX_A)
APPENDIX_BEGINNING, APPENDIX_MEMBERS = "1/10", 20  # of the energy asked for, and about how many steps lead from there to it


class NotInFamily(SymfpuError):
    """An energy or a frequency that no member of a family has; carries the range that was reached and why the family ended."""

    def __init__(self, quantity: str, value: float, reached: tuple[float, float], ending: str) -> None:
        self.quantity, self.value, self.reached, self.ending = quantity, value, reached, ending
        super().__init__(
            f"no member has {quantity} = {value:.10g}: the family goes from {reached[0]:.10g} to {reached[1]:.10g} and {ending}; "
            f"take a value in this range, or follow the family further"
        )


@dataclass(frozen=True, eq=False)
class Family:
    """Tori of growing energy with one ratio of amplitudes or mode energies, and what happens on the way.

    Made by `family`. members : in order of the way. events : folds, resonances and changes of stability, between members.
    ending : why the family was not followed further. harmonic : whether its goal was a harmonic energy. energy_ratio : of the averaged
    mode energies by seed, where it is these that keep their ratio.
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

    method : 'arclength', Newton's method and pseudo-arclength continuation; or 'appendix-a', the algorithm of the paper's Appendix A,
    corrected, whose members are truncated series of `order` and whose mode energies grow alike (no ratio is kept).

    harmonic : whether energies are sum E_q at the angles zero instead of H. amplitude_ratio or energy_ratio (of mode energies
    averaged over the torus) : by seed, default equal mode energies. from_energy : where it begins, by the linear estimate; default a
    thousandth of the goal, a tenth with 'appendix-a', or where the family in the folder began. members : the most. multipliers : of
    breathers, with changes of stability. tolerance : as for `refine`; both only with 'arclength'. folder : every member is kept there
    as a file at once; an interrupted family goes on from it, with other goals too. progress : called as (label, fraction done).

    The last member is the first one beyond the goal; `Family.at_energy` gives the torus at it.
    A family that cannot be followed to its goal is returned as far as it went; `ending` says why it ended.
    Raises InputError for arguments out of range and for a folder that holds another family, NoTorus if there is no first member.
    """
    if method not in METHODS:
        raise InputError("method", method, f"one of {', '.join(METHODS)}", "name one of these")
    if (method == APPENDIX_A) != (order is not None):
        raise InputError("order", order, f"an order with method = {APPENDIX_A!r}, none with others", "give both or neither")
    if order is not None and multipliers:
        raise InputError("multipliers", multipliers, f"False with method = {APPENDIX_A!r}", "its members are series: leave it out")
    plan = _plan(chain, seeds, to_energy, harmonic, amplitude_ratio, energy_ratio, from_energy, members, multipliers, tolerance, order)
    kept = _Kept(plan, None if folder is None else Path(folder))
    plan = kept.plan
    tell = progress or (lambda label, done: None)

    def report(line: str) -> None:
        tell(f"member {len(kept.members) + 1}: {line}", plan.done(kept.members))

    if order is not None:
        return _by_appendix_a(plan, order, kept, tell)
    while len(kept.members) < min(2, plan.most):
        amplitudes = {q: a * SECOND ** len(kept.members) for q, a in plan.start.items()}
        torus = first_torus(chain, amplitudes, energy_ratio=plan.ratio if plan.energies else None, tolerance=tolerance, report=report)
        kept.add(member(torus, multipliers=multipliers), [])
    ending = "reached the energy asked for"

    def finished(last: Member) -> bool:
        return plan.done([last]) >= 1 or len(kept.members) >= plan.most

    tori = [m.torus for m in kept.members[-3:] if isinstance(m.torus, RefinedTorus)]
    way = Way(plan.ratio, energies=plan.energies, tolerance=tolerance, report=report, tori=tori, step=kept.step, largest=kept.largest)
    try:
        if not finished(kept.members[-1]):
            steps = continued(way, len(kept.members) - 1, multipliers=multipliers, last=kept.members[-1], finished=finished)
            for found, events in steps:
                kept.step, kept.largest = way.step, way.largest
                kept.add(found, events)
        if plan.done([kept.members[-1]]) < 1:
            ending = f"was left after {len(kept.members)} members, the most asked for"
    except NoTorus as end:
        ending = f"ended: {end.reason}, with steps along the way down to {way.step:.1g}"
    return Family(chain, plan.seeds, tuple(kept.members), tuple(kept.events), ending, harmonic, plan.ratio if plan.energies else None)


def _by_appendix_a(plan: _Plan, order: int, kept: _Kept, tell: Progress) -> Family:
    """The same by the algorithm of Appendix A, gone on with from the members there are."""
    first = sum((float(plan.chain.frequencies()[q - 1]) * a) ** 2 / 2 for q, a in plan.start.items())
    increment = (plan.goal - first) / plan.chain.N / APPENDIX_MEMBERS
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


@dataclass(frozen=True)
class _Plan:
    """Checked arguments. start : amplitudes of the first member; chosen : by from_energy, not from the goal."""

    chain: Chain
    seeds: tuple[int, ...]
    goal: float
    harmonic: bool
    ratio: dict[int, float]
    energies: bool
    start: dict[int, float]
    most: int
    multipliers: bool
    tolerance: float
    order: int | None
    chosen: bool

    def done(self, members: list[Member]) -> float:
        """How far towards the goal, by the logarithm of the energy."""
        if not members:
            return 0.0
        energy = members[-1].harmonic_energy if self.harmonic else members[-1].energy
        linear = self.chain.frequencies()
        first = sum((float(linear[q - 1]) * a) ** 2 / 2 for q, a in self.start.items())
        if energy >= self.goal:
            return 1.0
        return math.log(energy / first) / math.log(self.goal / first) if 0 < first < self.goal and energy > 0 else 0.0

    def described(self) -> Json:
        """What two runs of one family have in common."""
        return {
            "N": self.chain.N,
            "alpha": decimal(self.chain.alpha),
            "beta": decimal(self.chain.beta),
            "seeds": list(self.seeds),
            "ratio": {str(q): repr(x) for q, x in self.ratio.items()},
            "ratio_of": "mode energies" if self.energies else "amplitudes",
            "start": {str(q): repr(a) for q, a in self.start.items()},
            "order": self.order,
            "multipliers": self.multipliers,
            "tolerance": repr(self.tolerance),
        }


def _plan(
    chain: Chain,
    seeds: tuple[int, ...],
    to_energy: Number,
    harmonic: bool,
    amplitude_ratio: Mapping[int, Number] | None,
    energy_ratio: Mapping[int, Number] | None,
    from_energy: Number | None,
    members: int,
    multipliers: bool,
    tolerance: float,
    order: int | None,
) -> _Plan:
    chosen = tuple(sorted(seed_modes(seeds, chain.N)))
    goal = exact(to_energy, "to_energy")
    first = (
        goal * exact(BEGINNING if order is None else APPENDIX_BEGINNING, "") if from_energy is None else exact(from_energy, "from_energy")
    )
    if not 0 < goal < LARGEST or not SMALLEST < first < goal:
        argument, value = ("from_energy", from_energy) if from_energy is not None and 0 < goal < LARGEST else ("to_energy", to_energy)
        raise InputError(argument, value, "0 < from_energy < to_energy, in the range of doubles", "choose energies in this order")
    if amplitude_ratio is not None and energy_ratio is not None:
        raise InputError("energy_ratio", dict(energy_ratio), "only one of amplitude_ratio and energy_ratio", "leave one out")
    if multipliers and len(chosen) > 1:
        raise InputError("multipliers", multipliers, "False for more than one seed", "only periodic orbits have multipliers")
    name = "energy_ratio" if amplitude_ratio is None else "amplitude_ratio"
    given = next((x for x in (amplitude_ratio, energy_ratio) if x is not None), dict.fromkeys(chosen, 1))
    if not hasattr(given, "values") or set(given) != set(chosen) or not all(exact(x, name) > 0 for x in given.values()):
        raise InputError(name, given, f"a positive number for each of the seeds {chosen}", "complete it")
    ratio, linear = {q: float(exact(given[q], name)) for q in chosen}, chain.frequencies()
    weights = {q: x if amplitude_ratio is not None else math.sqrt(x) / float(linear[q - 1]) for q, x in ratio.items()}
    energy = sum((float(linear[q - 1]) * w) ** 2 / 2 for q, w in weights.items())
    start = {q: w * math.sqrt(float(first) / energy) for q, w in weights.items()}
    return _Plan(
        chain=chain,
        seeds=chosen,
        goal=float(goal),
        harmonic=harmonic,
        ratio=ratio,
        energies=amplitude_ratio is None,
        start=start,
        most=integer(members, "members", 1),
        multipliers=multipliers,
        tolerance=tolerance,
        order=order,
        chosen=from_energy is not None,
    )


def _seeds(described: Json) -> tuple[int, ...]:
    return tuple(int(q) for q in described["seeds"])


class _Kept:
    """Members and events so far, in memory and, if there is a folder, on disk after every member."""

    def __init__(self, plan: _Plan, folder: Path | None) -> None:
        self.plan, self.folder = plan, folder
        self.members: list[Member] = []
        self.events: list[Event] = []
        self.step, self.largest = FIRST_STEP, 0.0
        if folder is not None:
            self._read(folder)

    def _read(self, folder: Path) -> None:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError("folder", str(folder), "a folder that can be written", f"choose another ({error.strerror})") from error
        if not (folder / RECORD).exists():
            return
        try:
            record = json.loads((folder / RECORD).read_text())
            plan, events, count = record["plan"], record["events"], int(record["members"])
            self.step, self.largest = float(record["step"]), float(record["largest"])
            start = {q: float(plan["start"][str(q)]) for q in self.plan.seeds} if _seeds(plan) == self.plan.seeds else self.plan.start
            self.events = [Event(**event | {"harmonic": tuple(event["harmonic"])}) for event in events]
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise InputError("folder", str(folder), "a family that symfpu wrote", f"{RECORD} is damaged; choose another folder") from error
        if not self.plan.chosen:
            self.plan = replace(self.plan, start=start)
        different = [key for key, value in self.plan.described().items() if plan.get(key) != value]
        if different:
            raise InputError("folder", str(folder), f"the same family (its {different[0]} differs)", "choose another folder")
        for k in range(count):
            torus = self._torus(k)
            if isinstance(torus, RefinedTorus):
                self.members.append(member(torus, multipliers=self.plan.multipliers))
            else:
                amplitudes, energy = {q: float(a) for q, a in torus.amplitudes.items()}, float(torus.energy())
                harmonic = float(torus.harmonic_energies().sum())
                self.members.append(Member(torus, amplitudes, energy, harmonic, torus.residual(), torus.warnings))

    def _torus(self, index: int) -> RefinedTorus | QTorus:
        """A member that the record counts; InputError where its file is not there, BundleError where it is damaged."""
        try:
            torus = load(self._file(index)).torus
        except FileNotFoundError as error:
            allowed, advice = f"all {index + 1} members or more", f"restore {self._file(index).name}, or choose another folder"
            raise InputError("folder", str(self.folder), allowed, advice) from error
        if torus is None or (torus.chain, tuple(torus.seeds)) != (self.plan.chain, self.plan.seeds):
            advice = f"{self._file(index).name} is another torus; choose another folder"
            raise InputError("folder", str(self.folder), "members of one family", advice)
        return torus

    def _file(self, index: int) -> Path:
        assert self.folder is not None
        return self.folder / f"member-{index:04d}.symfpu"

    def add(self, found: Member, events: list[Event]) -> None:
        """The member first, then the record that counts it: a run may be stopped at any time."""
        if self.folder is not None and isinstance(found.torus, (RefinedTorus, QTorus)):
            save(self._file(len(self.members)), found.torus, verdict={"verdict": found.verdict, "reasons": list(found.warnings)})
        self.members.append(found)
        self.events += events
        if self.folder is not None:
            record = {
                "plan": self.plan.described(),
                "members": len(self.members),
                "step": self.step,
                "largest": self.largest,
                "events": [asdict(event) for event in self.events],
            }
            write_text(self.folder / RECORD, json.dumps(record, indent=1) + "\n")
