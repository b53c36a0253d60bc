"""The values in the file beside those computed anew, and the reasons for what was changed on purpose."""

import importlib
import json
import time
from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from tests.fingerprint.cases import CASES
from tests.fingerprint.entries import differences, entry

HERE = Path(__file__).parent
VALUES = HERE / "values.json"
REASONS = HERE / "reasons.json"
MODULES = ("chains", "series", "solutions", "stability", "dynamics", "theorems")

Entries = dict[str, dict[str, Any]]


def computed(names: Sequence[str] = (), heard: Callable[[str], Any] | None = None) -> Entries:
    """The entries of the cases with these beginnings of names, of all if there are none."""
    for module in MODULES:
        importlib.import_module(f"tests.fingerprint.{module}")
    found: Entries = {}
    for name, case in CASES.items():
        if _chosen(name, names):
            began = time.process_time()
            found |= {f"{name}/{what}": entry(value) for what, value in case()}
            if heard:
                heard(f"{time.process_time() - began:6.1f} s  {name}")
    return found


def read(names: Sequence[str] = ()) -> Entries:
    """The entries of the file."""
    values: Entries = json.loads(VALUES.read_text()) if VALUES.exists() else {}
    return {key: value for key, value in values.items() if _chosen(key, names)}


def _chosen(name: str, beginnings: Sequence[str]) -> bool:
    return not beginnings or any(name.startswith(beginning) for beginning in beginnings)


def compared(old: Entries, new: Entries) -> dict[str, list[str]]:
    """By key, where the values differ, each with the old value and the new one."""
    found = {}
    for key in [*old, *(key for key in new if key not in old)]:
        if key not in new:
            found[key] = ["is not computed any more"]
        elif key not in old:
            found[key] = ["is new"]
        else:
            lines = differences(old[key]["value"], new[key]["value"], old[key]["within"])
            if lines:
                found[key] = lines
    return found


def reasons() -> dict[str, str]:
    """The reasons for intended changes: a key, or a pattern of keys, and one sentence."""
    found: dict[str, str] = json.loads(REASONS.read_text())
    return found


def unexplained(found: dict[str, list[str]], old: Entries) -> list[str]:
    """Keys with a change for which there is no reason; an entry that is new needs none."""
    patterns = list(reasons())
    changed = [key for key in found if key in old]
    return [key for key in changed if not any(key == pattern or fnmatchcase(key, pattern) for pattern in patterns)]


def written(new: Entries, old: Entries, changed: dict[str, list[str]], *, whole: bool) -> None:
    """The file with the entries that have changed; all others stay as they are, to the last digit."""
    everything = read()
    kept = {key: old[key] if key in old and key not in changed else value for key, value in new.items()}
    entries = kept if whole else {key: value for key, value in everything.items() if key not in old or key in kept} | kept
    lines = [f"{json.dumps(key)}: {json.dumps(value)}" for key, value in sorted(entries.items())]
    VALUES.write_text("{\n" + ",\n".join(lines) + "\n}\n")
