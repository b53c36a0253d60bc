"""A long run on disk, unfinished or finished: one archive, replaced whole, read without trust and only for the same parameters."""

from __future__ import annotations

import hashlib
import os
from numbers import Real
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.errors import InputError
from symfpu.files.archive import FORMAT, SCHEMA, Archive, BundleError, Json, digest_of, member_digest, write_archive
from symfpu.numbers.typed import integer

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ADVICE = "name another file, or remove this one"
LENGTH = ("steps", "sampled steps")  # parameters that a longer run, which goes on from a shorter one, has otherwise


class Kind(NamedTuple):
    """What a checkpoint is of: its name in the file, with its article, and what goes on from it."""

    name: str
    of: str
    resume: str


ORBIT = Kind("orbit", "an orbit", "integrate(..., file=...) or symfpu orbit --checkpoint")
ALIGNMENT = Kind("alignment indices", "alignment indices", "alignment_indices(..., file=...) or symfpu gali --checkpoint")
KINDS = {kind.name: kind for kind in (ORBIT, ALIGNMENT)}


def digest(values: NDArray[Any]) -> str:
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()


def checkpoint_path(file: object) -> Path:
    """The path, if a file can be written there; InputError before anything is computed otherwise."""
    if not isinstance(file, (str, os.PathLike)):
        raise InputError("file", file, "the name of a file", "pass a string or a Path")
    path = Path(os.fsdecode(file))
    if path.is_dir() or not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise InputError("file", str(path), "a file in a folder that exists and can be written", "choose another")
    return path


def seconds_between(every: object) -> float:
    """Seconds from one checkpoint to the next; raises InputError."""
    if isinstance(every, bool) or not isinstance(every, Real) or not float(every) >= 0:
        raise InputError("every", every, "seconds, 0 or more", "leave it out")
    return float(every)


def write_checkpoint(path: Path, parameters: Json, steps: int, arrays: dict[str, Floats], kind: Kind = ORBIT) -> None:
    """Replaces the file whole: on a full disk InputError, and what it held is still there."""
    members = {name: np.ascontiguousarray(values, dtype="<f8").reshape(-1) for name, values in arrays.items()}
    body: Json = {
        "format": FORMAT,
        "schema": SCHEMA,
        "kind": kind.name,
        "parameters": parameters,
        "steps": steps,
        "shapes": {name: list(values.shape) for name, values in arrays.items()},
        "arrays": {name: member_digest(values) for name, values in members.items()},
    }
    write_archive(path, body | {"digest": digest_of(body)}, members)


def read_checkpoint(path: Path, parameters: Json, kind: Kind = ORBIT) -> tuple[int, dict[str, Floats]] | None:
    """Steps done and the arrays, or None where there is no file. The checkpoint may be one of fewer steps in all.

    Raises InputError for a checkpoint of other parameters, BundleError for a file that is none.
    """
    if not path.exists():
        return None
    with path.open("rb") as stream:
        try:
            if stream.read(4) != b"PK\x03\x04":
                raise ValueError("it is no archive")
            archive = Archive(path, stream)
            if archive.body.get("kind") != kind.name:
                raise BundleError(path, f"is not a checkpoint of {kind.of}", ADVICE)
            _require_same(path, archive.body["parameters"], parameters, kind)
            shapes = {name: [integer(n, "shape", 0) for n in shape] for name, shape in archive.body["shapes"].items()}
            arrays = {name: archive.array(name, "<f8", int(np.prod(shape))).reshape(shape) for name, shape in shapes.items()}
            return integer(archive.body["steps"], "steps", 0), arrays
        except (BundleError, Refused):
            raise
        except Exception as error:  # whatever zipfile, zlib, json and our own checks say to a damaged or hostile file
            raise BundleError(path, f"is not a checkpoint of {kind.of}, or is damaged ({type(error).__name__} {error})", ADVICE) from None


class Refused(InputError):
    """A checkpoint of another run."""


def marks_of(path: Path, known: Floats, done: int, asked: Ints, *, exact: bool) -> Ints:
    """Where a run that goes on has its samples: those it has, and after them those asked for.

    known : numbers of steps at which there are samples, up to `done`. exact : whether those asked for before `done`
    must be among them. Raises InputError if they are not, BundleError if known are none.
    """
    marks = known.astype(np.int64)
    rising = bool(np.all(np.diff(marks) > 0)) and bool(np.all(marks == known))
    if known.ndim != 1 or not rising or (marks.size and not 0 <= marks[0] <= marks[-1] <= done):
        raise BundleError(path, "is damaged (its samples are in no order)", ADVICE)
    missing = np.setdiff1d(asked[asked <= done], marks)
    if exact and missing.size:
        allowed = f"samples that the run in the file has, or later ones (there is none after {missing[0]} steps)"
        raise Refused("samples", f"{asked.size} times", allowed, ADVICE)
    return np.concatenate([marks, asked[asked > done]])


def _require_same(path: Path, found: Json, parameters: Json, kind: Kind) -> None:
    longer = integer(found["steps"], "steps", 0) < parameters["steps"]
    for name, value in parameters.items():
        if found.get(name) != value and not (longer and name in LENGTH):
            was, now = (f"{str(v)[:40]}" for v in (found.get(name), value))
            raise Refused("file", str(path), f"a checkpoint of the same {kind.name} ({name} is {was} in it, {now} here)", ADVICE)
