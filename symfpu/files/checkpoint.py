"""A long run on disk, unfinished or finished: one archive, replaced whole.

It is read without trust and only for the same parameters.
"""

from __future__ import annotations

import hashlib
import os
from numbers import Real
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.errors import InputError
from symfpu.files.archive import (
    DAMAGE,
    MEMORY_ADVICE,
    SCHEMA,
    Archive,
    BundleError,
    Json,
    digest_of,
    member_digest,
    write_archive,
)
from symfpu.files.formats import ARCHIVE, BUNDLE
from symfpu.files.writing import open_to_read, regular_file
from symfpu.numbers.typed import integer

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ADVICE = "name another file, or remove this one"
# parameters that a longer run, which goes on from a shorter one, has otherwise
LENGTH = ("steps", "sampled steps")
ENDS_LEFT_OUT = {
    "ends": "fixed"
}  # what runs are of that do not name the ends of their chain


class Kind(NamedTuple):
    """What a checkpoint is of: its name in the file, with its article, and what goes on from it."""

    name: str
    of: str
    resume: str


ORBIT = Kind("orbit", "an orbit", "integrate(..., file=...) or symfpu orbit --checkpoint")
ALIGNMENT = Kind(
    "alignment indices",
    "alignment indices",
    "alignment_indices(..., file=...) or symfpu gali --checkpoint",
)
TORUS_DIGITS = Kind(
    "torus with digits",
    "a torus with digits",
    "refine(..., digits=..., file=...) or symfpu refine --digits D --checkpoint",
)
KINDS = {kind.name: kind for kind in (ORBIT, ALIGNMENT, TORUS_DIGITS)}


def digest(values: NDArray[Any]) -> str:
    contiguous = np.ascontiguousarray(values)
    return hashlib.sha256(contiguous.tobytes()).hexdigest()


def checkpoint_path(file: object) -> Path:
    """The path, if a file can be written there.

    InputError before anything is computed otherwise.
    """
    if not isinstance(file, (str, os.PathLike)):
        raise InputError("file", file, "the name of a file", "pass a string or a Path")
    return regular_file(Path(os.fsdecode(file)), "file", "choose another")


def seconds_between(every: object) -> float:
    """Seconds from one checkpoint to the next; raises InputError."""
    if isinstance(every, bool) or not isinstance(every, Real) or not float(every) >= 0:
        raise InputError("every", every, "seconds, 0 or more", "leave it out")
    return float(every)


def write_checkpoint(
    path: Path, parameters: Json, steps: int, arrays: dict[str, Floats], kind: Kind = ORBIT
) -> None:
    """Replaces the file whole: on a full disk InputError, and what it held is still there."""
    members, shapes, digests = {}, {}, {}
    for name, values in arrays.items():
        shapes[name] = list(values.shape)
        members[name] = np.ascontiguousarray(values, dtype="<f8").reshape(-1)
        digests[name] = member_digest(members[name])
    body: Json = {
        "format": BUNDLE,
        "schema": SCHEMA,
        "kind": kind.name,
        "parameters": parameters,
        "steps": steps,
        "shapes": shapes,
        "arrays": digests,
    }
    write_archive(path, body | {"digest": digest_of(body)}, members)


def read_checkpoint(
    path: Path, parameters: Json, kind: Kind = ORBIT
) -> tuple[int, dict[str, Floats]] | None:
    """Steps done and the arrays, or None where there is no file.

    The checkpoint may be one of fewer steps in all.

    Raises InputError for a checkpoint of other parameters, BundleError for a file that is none.
    """
    if not path.exists():
        return None
    with open_to_read(path) as stream:
        try:
            if stream.read(len(ARCHIVE)) != ARCHIVE:
                raise ValueError("it is no archive")
            archive = Archive(path, stream)
            if archive.body.get("kind") != kind.name:
                raise BundleError(path, f"is not a checkpoint of {kind.of}", ADVICE)
            _require_same(path, archive.body["parameters"], parameters, kind)
            arrays = _arrays(archive)
            if "sampled" not in arrays and "sampled steps" in parameters:
                raise ValueError("it does not hold where its samples are")
            return integer(archive.body["steps"], "steps", 0), arrays
        except (BundleError, Refused):
            raise
        except MemoryError:
            problem = "needs more memory than is free"
            raise BundleError(path, problem, MEMORY_ADVICE) from None
        except DAMAGE as error:
            damage = f"is damaged ({type(error).__name__} {error})"
            problem = f"is not a checkpoint of {kind.of}, or {damage}"
            raise BundleError(path, problem, ADVICE) from None


def _arrays(archive: Archive) -> dict[str, Floats]:
    """The arrays in their shapes; all shapes are read before an array is."""
    shapes = {}
    for name, typed in archive.body["shapes"].items():
        shapes[name] = [integer(n, "shape", 0) for n in typed]
    arrays = {}
    for name, shape in shapes.items():
        count = int(np.prod(shape))
        arrays[name] = archive.array(name, "<f8", count).reshape(shape)
    return arrays


class Refused(InputError):
    """A checkpoint of another run."""


def marks_of(path: Path, known: Floats, done: int, asked: Ints, *, exact: bool) -> Ints:
    """Where a run that goes on has its samples: those it has, and after them those asked for.

    known : numbers of steps at which there are samples, up to `done`.
    exact : whether those asked for before `done` must be among them.

    Raises InputError if they are not, BundleError if known are none.
    """
    marks = known.astype(np.int64)
    rising = bool(np.all(np.diff(marks) > 0))
    whole = bool(np.all(marks == known))
    ordered = known.ndim == 1 and rising and whole
    if not ordered or (marks.size and not 0 <= marks[0] <= marks[-1] <= done):
        raise BundleError(path, "is damaged (its samples are in no order)", ADVICE)
    past = asked[asked <= done]
    missing = np.setdiff1d(past, marks)
    if exact and missing.size:
        none = f"there is none after {missing[0]} steps"
        allowed = f"samples that the run in the file has, or later ones ({none})"
        raise Refused("samples", f"{asked.size} times", allowed, ADVICE)
    return np.concatenate([marks, asked[asked > done]])


def _require_same(path: Path, found: Json, parameters: Json, kind: Kind) -> None:
    longer = integer(found["steps"], "steps", 0) < parameters["steps"]
    known = ENDS_LEFT_OUT | found
    for name, value in (ENDS_LEFT_OUT | parameters).items():
        goes_on = longer and name in LENGTH
        if known.get(name) != value and not goes_on:
            was = str(known.get(name))[:40]
            now = str(value)[:40]
            same = f"a checkpoint of the same {kind.name}"
            allowed = f"{same} ({name} is {was} in it, {now} here)"
            raise Refused("file", str(path), allowed, ADVICE)
