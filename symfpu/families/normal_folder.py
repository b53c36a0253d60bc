"""Normal modes of the members of a family as files, and what they do between members as JSON."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import Any

from symfpu.errors import InputError
from symfpu.families.normal_events import NormalEvent
from symfpu.files.archive import BundleError
from symfpu.files.locking import one_run
from symfpu.files.sealed import document_in, read_bytes, write_sealed
from symfpu.files.writing import made_folder
from symfpu.normal.frequencies import NormalFrequencies, frequencies_again
from symfpu.normal.modes import NormalModes
from symfpu.normal.resonances import ParametricResonance
from symfpu.store.saved_file import load, save
from symfpu.tori.torus import Torus

Json = dict[str, Any]
RECORD = "line.json"


def normal_file(folder: Path, index: int) -> Path:
    """That of the normal modes of a member."""
    return folder / f"normal-{index:04d}.symfpu"


def write_modes(folder: Path, index: int, found: NormalModes) -> None:
    """The normal modes of a member, with their torus and eigenfunctions."""
    save(normal_file(folder, index), found)


def read_modes(folder: Path, index: int) -> NormalModes:
    """The same again; InputError where they are not there, BundleError where damaged."""
    file = normal_file(folder, index)
    try:
        found = load(file)
    except FileNotFoundError as error:
        allowed = "the normal modes that its record counts"
        advice = f"restore {file.name}, or choose another folder"
        raise InputError("folder", str(folder), allowed, advice) from error
    if not isinstance(found, NormalModes):
        raise BundleError(file, "holds no normal modes", "choose another folder")
    return found


def forget_modes(folder: Path, index: int | None) -> None:
    """Leave only those of one member: the next are continued from them."""
    for file in folder.glob(normal_file(folder, 0).name.replace("0000", "*")):
        if index is None or file != normal_file(folder, index):
            file.unlink(missing_ok=True)


def normal_entry(found: NormalFrequencies | None) -> Json | None:
    """Normal frequencies of a member for its record, to the last digit."""
    if found is None:
        return None
    sigma = {q: complex(w) for q, w in found.frequencies.items()}
    return {
        "sigma": {str(q): [repr(w.real), repr(w.imag)] for q, w in sigma.items()},
        "signatures": {str(q): n for q, n in found.signatures.items()},
        "residual": repr(found.residual),
        "missing": {str(q): why for q, why in found.missing.items()},
    }


def normal_from(entry: Json | None, torus: Torus) -> NormalFrequencies | None:
    """The same again; KeyError, TypeError or ValueError for what is none."""
    if entry is None:
        return None
    pairs = {int(q): (float(a), float(b)) for q, (a, b) in entry["sigma"].items()}
    return frequencies_again(
        torus,
        {q: complex(a, b) if b else a for q, (a, b) in pairs.items()},
        signatures={int(q): int(n) for q, n in entry["signatures"].items()},
        residual=float(entry["residual"]),
        missing={int(q): str(why) for q, why in entry["missing"].items()},
    )


def event_entry(event: NormalEvent) -> Json:
    """An event for a record."""
    return asdict(event)


def event_from(entry: Json) -> NormalEvent:
    """The same again; KeyError, TypeError or ValueError for what is none."""
    met = entry["resonance"]
    harmonic, modes = tuple(met["harmonic"]), tuple(met["modes"])
    resonance = ParametricResonance(met["kind"], modes, harmonic, met["distance"])
    amplitudes = {int(q): a for q, a in entry["amplitudes"].items()}
    return NormalEvent(**entry | {"resonance": resonance, "amplitudes": amplitudes})


class KeptLine:
    """Members and events of a line so far, in memory and after every member in a folder.

    plan : what two runs of one line have in common. folder : None for memory alone.
    """

    def __init__(self, plan: Json, folder: Path | None) -> None:
        self._plan, self.folder = plan, folder
        self.members: list[NormalModes] = []
        self.events: list[NormalEvent] = []
        self._held = ExitStack()  # the lock of the folder
        if folder is None:
            return
        with ExitStack() as held:
            made = made_folder(folder, "folder")
            held.enter_context(one_run(made, run="line of tori", argument="folder"))
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
            plan, count = record["plan"], int(record["members"])
            self.events = [event_from(entry) for entry in record["events"]]
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            advice = f"{RECORD} is damaged, or of an older symfpu; choose another folder"
            raise InputError("folder", str(folder), "a line of tori", advice) from error
        keys = dict.fromkeys([*self._plan, *plan])
        if different := [key for key in keys if plan.get(key) != self._plan.get(key)]:
            allowed = f"the same line of tori (its {different[0]} differs)"
            raise InputError("folder", str(folder), allowed, "choose another folder")
        self.members = [read_modes(folder, n) for n in range(count)]

    def add(self, found: NormalModes, events: list[NormalEvent]) -> None:
        """The member first, then the record that counts it: a run may be stopped at any time."""
        if self.folder is not None:
            write_modes(self.folder, len(self.members), found)
        self.members.append(found)
        self.events += events
        if self.folder is not None:
            events_so_far = [event_entry(event) for event in self.events]
            record = {
                "plan": self._plan,
                "members": len(self.members),
                "events": events_so_far,
            }
            write_sealed(self.folder / RECORD, record)
