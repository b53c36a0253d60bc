"""The checked arguments of a family, and its members and events as they are kept.

They are kept in memory, and in a folder if there is one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.families.beginnings import first_energy
from symfpu.families.continuation import FIRST_STEP
from symfpu.families.members import (
    Event,
    Level,
    Member,
    linear_by_mode,
    member,
    series_member,
)
from symfpu.families.normal_events import NormalEvent
from symfpu.families.normal_folder import (
    event_entry,
    event_from,
    forget_modes,
    normal_entry,
    normal_from,
    read_modes,
    write_modes,
)
from symfpu.families.normal_way import NormalWay
from symfpu.files.locking import one_run
from symfpu.files.progress import Progress
from symfpu.files.sealed import document_in, read_bytes, write_sealed
from symfpu.files.writing import made_folder
from symfpu.normal.frequencies import NormalFrequencies
from symfpu.numbers.typed import Number, double, exact, integer
from symfpu.refinement.newton import Newton
from symfpu.store.saved_file import load, save
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus, comes_from

Json = dict[str, Any]
BEGINNING = "1/1000"  # of the energy asked for, where breathers begin by default
# energies whose doubles are neither 0 nor infinite
SMALLEST, LARGEST = Fraction(1, 10**300), 10**300
RECORD = "family.json"
APPENDIX_BEGINNING = "1/10"  # the same with Appendix A


@dataclass(frozen=True)
class Plan:
    """Checked arguments.

    start : amplitudes that have the first energy in the linear chain; chosen : by from_energy, not
    from the goal. normal : the largest sum |nu_i| of resonances of normal frequencies that are
    events, None where these are not asked for.
    """

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
    normal: int | None = None

    @property
    def first(self) -> float:
        """Energy of the first member: that of the starting amplitudes in the linear chain."""
        linear = linear_by_mode(self.chain, self.start)
        return sum((linear[q] * a) ** 2 / 2 for q, a in self.start.items())

    @property
    def level(self) -> Level:
        """Where the family ends."""
        return Level(self.goal, self.harmonic)

    def done(self, members: list[Member]) -> float:
        """How far towards the goal, by the logarithm of the energy."""
        if not members:
            return 0.0
        energy, first = self.level.of_member(members[-1]), self.first
        if self.level.passed(energy):
            return 1.0
        if not 0 < first < self.goal or not energy > 0:
            return 0.0
        return max(math.log(energy / first) / math.log(self.goal / first), 0.0)

    def described(self) -> Json:
        """What two runs of one family have in common."""
        chain = self.chain
        ratio = {str(q): repr(x) for q, x in self.ratio.items()}
        start = {str(q): repr(a) for q, a in self.start.items()}
        return {
            "N": chain.N,
            **chain.typed_law,
            **({"ends": chain.ends} if chain.periodic else {}),
            "seeds": list(self.seeds),
            "ratio": ratio,
            "ratio_of": "mode energies" if self.energies else "amplitudes",
            "start": start,
            "order": self.order,
            "multipliers": self.multipliers,
            "normal": self.normal,
            "tolerance": repr(self.tolerance),
        }


def checked_family(
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
    normal: int | None,
) -> Plan:
    """The arguments of `family`, checked; normal : as of the Plan."""
    chosen = tuple(sorted(chain.seeds_of(seeds)))
    goal = exact(to_energy, "to_energy")
    if amplitude_ratio is not None and energy_ratio is not None:
        allowed = "only one of amplitude_ratio and energy_ratio"
        raise InputError("energy_ratio", dict(energy_ratio), allowed, "leave one out")
    if multipliers and len(chosen) > 1:
        advice = "only periodic orbits have multipliers"
        raise InputError("multipliers", multipliers, "False for more than one seed", advice)
    if amplitude_ratio is not None:
        ratio = _checked_ratio("amplitude_ratio", amplitude_ratio, chosen)
        _require_free(ratio)
    else:
        _require_different_energies(chosen, energy_ratio)
        ratio = _checked_ratio("energy_ratio", energy_ratio, chosen)
    linear = linear_by_mode(chain, chosen)
    weights = ratio
    if amplitude_ratio is None:
        shares = {q: _share_of_seed(chain, q) for q in chosen}
        weights = {q: math.sqrt(x / shares[q]) / linear[q] for q, x in ratio.items()}
    if from_energy is None:
        first = _default_first(chain, weights, goal, order)
    else:
        first = exact(from_energy, "from_energy")
    _require_energies(first, goal, from_energy, to_energy)
    energy = sum((linear[q] * w) ** 2 / 2 for q, w in weights.items())
    scale = math.sqrt(float(first) / energy)
    start = {q: w * scale for q, w in weights.items()}
    return Plan(
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
        normal=normal,
    )


def _share_of_seed(chain: Chain, q: int) -> float:
    """The part of a wave's energy that is in the mode of its seed; the rest is in the mode -q."""
    return 0.5 if chain.periodic and 2 * q != chain.N else 1.0


def _require_different_energies(seeds: tuple[int, ...], given: object) -> None:
    """InputError for opposite seeds of a ring, which have the same E_q."""
    if any(-q in seeds for q in seeds):
        allowed = "a ratio of modes of different energies: E_q = E_(-q) on a ring"
        raise InputError("energy_ratio", given, allowed, "give amplitude_ratio")


def _require_free(ratio: dict[int, float]) -> None:
    """InputError for opposite seeds of a ring of equal amplitudes."""
    if any(ratio.get(-q) == a for q, a in ratio.items()):
        allowed = "different amplitudes of opposite seeds: with equal ones they stand"
        advice = "follow Chain(N // 2, ...) with fixed ends and unfold its tori"
        raise InputError("amplitude_ratio", ratio, allowed, advice)


def _default_first(
    chain: Chain, weights: Mapping[int, float], goal: Fraction, order: int | None
) -> Fraction:
    """The first energy where none is asked for; weights : amplitudes in the ratio followed."""
    if order is not None:
        return goal * Fraction(APPENDIX_BEGINNING)
    one_walk = len(weights) == 1 and not chain.periodic
    if one_walk or not 0 < goal < LARGEST:
        return goal * Fraction(BEGINNING)
    return first_energy(chain, weights, goal)


def _require_energies(
    first: Fraction, goal: Fraction, from_energy: Number | None, to_energy: Number
) -> None:
    """InputError unless the first energy is below the last, both in the range of doubles."""
    if 0 < goal < LARGEST and SMALLEST < first < goal:
        return
    argument, value = "to_energy", to_energy
    if from_energy is not None and 0 < goal < LARGEST:
        argument, value = "from_energy", from_energy
    allowed = "0 < from_energy < to_energy, in the range of doubles"
    advice = "choose energies in this order; a family followed upwards has the tori of the way down"
    raise InputError(argument, value, allowed, advice)


def _checked_ratio(
    name: str, given: Mapping[int, Number] | None, seeds: tuple[int, ...]
) -> dict[int, float]:
    """A positive number for every seed; all are one where none is given."""
    ratio = dict.fromkeys(seeds, 1) if given is None else given
    complete = hasattr(ratio, "values") and set(ratio) == set(seeds)
    if not complete or not all(exact(x, name) > 0 for x in ratio.values()):
        allowed = f"a positive number for each of the seeds {seeds}"
        raise InputError(name, ratio, allowed, "complete it")
    return {q: double(ratio[q], name) for q in seeds}


def _seeds(described: Json) -> tuple[int, ...]:
    return tuple(int(q) for q in described["seeds"])


class Kept:
    """Members and events so far, in memory and after every member on disk.

    They are on disk only if there is a folder.
    """

    def __init__(self, plan: Plan, folder: Path | None, progress: Progress) -> None:
        self.plan, self.folder = plan, folder
        self.members: list[Member] = []
        self.events: list[Event | NormalEvent] = []
        length = plan.normal
        self.normal = None if length is None else NormalWay(length, progress)
        self.step, self.largest = FIRST_STEP, 0.0
        self._held = ExitStack()  # the lock of the folder
        if folder is None:
            return
        with ExitStack() as held:
            made = made_folder(folder, "folder")
            held.enter_context(one_run(made, run="family", argument="folder"))
            self._read(folder)
            self._held = held.pop_all()

    def end(self) -> None:
        """Nothing more is kept: another run may go on from the folder."""
        self._held.close()

    def _read(self, folder: Path) -> None:
        if not (folder / RECORD).exists():
            return
        content = read_bytes(folder / RECORD, "folder")
        try:
            record = document_in(content)
            plan, events, count = record["plan"], record["events"], int(record["members"])
            self.step, self.largest = float(record["step"]), float(record["largest"])
            start = (
                {q: float(plan["start"][str(q)]) for q in self.plan.seeds}
                if _seeds(plan) == self.plan.seeds
                else self.plan.start
            )
            self.events = [
                Event(**event | {"harmonic": tuple(event["harmonic"])}) for event in events
            ]
            self.events += map(event_from, record.get("normal_events", []))
            entries = record.get("normal") or [None] * count
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise InputError(
                "folder",
                str(folder),
                "a family that symfpu wrote",
                f"{RECORD} is damaged, or of an older symfpu; choose another folder",
            ) from error
        if not self.plan.chosen:
            self.plan = replace(self.plan, start=start)
        different = [
            key for key, value in self.plan.described().items() if plan.get(key) != value
        ]
        if different:
            raise InputError(
                "folder",
                str(folder),
                f"the same family (its {different[0]} differs)",
                "choose another folder",
            )
        for k in range(count):
            torus = self._torus(k)
            if comes_from(torus, Newton):
                normal = self._normal(folder, torus, entries[k])
                multipliers = self.plan.multipliers
                self.members.append(member(torus, multipliers=multipliers, normal=normal))
            elif comes_from(torus, FromSeries):
                self.members.append(series_member(torus))
        if (
            self.normal is not None
            and (known_at := record.get("normal_modes_of")) is not None
        ):
            self.normal.known = [read_modes(folder, int(known_at))]

    def _normal(
        self, folder: Path, torus: Torus[Newton], entry: Json | None
    ) -> NormalFrequencies | None:
        """Of a member in the folder; InputError where the record of it is damaged."""
        try:
            return normal_from(entry, torus)
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            advice = f"{RECORD} is damaged, or of an older symfpu; choose another folder"
            raise InputError("folder", str(folder), "a family", advice) from error

    def _torus(self, index: int) -> Torus:
        """A member that the record counts.

        InputError where its file is not there, BundleError where it is damaged.
        """
        try:
            torus = load(self._file(index))
        except FileNotFoundError as error:
            allowed, advice = (
                f"all {index + 1} members or more",
                f"restore {self._file(index).name}, or choose another folder",
            )
            raise InputError("folder", str(self.folder), allowed, advice) from error
        ours = self.plan.chain, self.plan.seeds
        if (
            not isinstance(torus, Torus)
            or not isinstance(torus.origin, Newton | FromSeries)
            or (torus.chain, torus.seeds) != ours
        ):
            advice = f"{self._file(index).name} is another torus; choose another folder"
            raise InputError("folder", str(self.folder), "members of one family", advice)
        return torus

    def _file(self, index: int) -> Path:
        assert self.folder is not None
        return self.folder / f"member-{index:04d}.symfpu"

    def cut(self, number: int) -> None:
        """Leave out the members after so many, and what happens on the way to them.

        Files are written over by the next ones.
        """
        del self.members[number:]
        self.events = [event for event in self.events if event.after < number - 1]

    def measured(self, torus: Torus[Newton]) -> Member:
        """A torus as the next member, with all that is asked for."""
        normal = self.normal.of(torus) if self.normal else None
        return member(torus, multipliers=self.plan.multipliers, normal=normal)

    def add(self, found: Member, events: list[Event | NormalEvent]) -> None:
        """The member first, then the record that counts it: a run may be stopped at any time."""
        kept = isinstance(found.torus.origin, Newton | FromSeries)
        if self.folder is not None and kept:
            save(
                self._file(len(self.members)),
                found.torus,
                verdict={"verdict": found.verdict, "reasons": list(found.warnings)},
            )
        self.members.append(found)
        self.events += events
        if self.folder is not None:
            record = {
                "plan": self.plan.described(),
                "members": len(self.members),
                "step": self.step,
                "largest": self.largest,
                "events": [asdict(e) for e in self.events if isinstance(e, Event)],
            }
            of_normal = self._normal_record(self.folder)
            write_sealed(self.folder / RECORD, record | of_normal)
            if of_normal:
                forget_modes(self.folder, of_normal["normal_modes_of"])

    def _normal_record(self, folder: Path) -> Json:
        """Of the normal frequencies; those that the next are continued from go into a file."""
        if self.normal is None:
            return {}
        last = len(self.members) - 1
        if self.normal.known and self.members[-1].normal is not None:
            write_modes(folder, last, self.normal.known[-1])
        with_modes = [k for k, m in enumerate(self.members) if m.normal is not None]
        found = [e for e in self.events if isinstance(e, NormalEvent)]
        return {
            "normal": [normal_entry(m.normal) for m in self.members],
            "normal_events": [event_entry(event) for event in found],
            "normal_modes_of": with_modes[-1] if with_modes else None,
        }
