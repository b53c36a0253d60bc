"""Any result as one file, and back: `save` and `load`.

The file is a ZIP archive of bundle.json and of arrays that numpy.load reads. Everything but arrays
is in bundle.json: numbers that must come back exactly are strings, and a digest covers the whole.
Loading executes nothing: it compares, splits and rebuilds, and checks every size before it
allocates.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from math import pi
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from numpy.typing import NDArray

from symfpu.errors import InputError
from symfpu.files.archive import (
    DAMAGE,
    MEMORY_ADVICE,
    SAVED_ADVICE,
    SCHEMA,
    Archive,
    BundleError,
    Json,
    write_document,
)
from symfpu.files.checkpoint import KINDS
from symfpu.files.formats import ARCHIVE, BUNDLE, format_of, opened_by
from symfpu.files.writing import open_to_read
from symfpu.numbers.arithmetic import text
from symfpu.numbers.public import public
from symfpu.results.field import Field
from symfpu.results.numbers import json_value
from symfpu.results.result import Result
from symfpu.store.entries import UnknownPotential
from symfpu.store.tree import Reader, Writer
from symfpu.tori.torus import Torus

Array = NDArray[Any]
PACKAGES = (
    "symfpu",
    "numpy",
    "scipy",
    "mpmath",
    "symengine",
    "sympy",
    "python-flint",
    "gmpy2",
    "numba",
    "llvmlite",
)
LONGEST_REASON = 160
LONG_RUN = 100  # periods of the slowest seed at which the last test vector is taken


class OrbitPoint(NamedTuple):
    """A point of the torus for tests of other programs, as decimals.

    t : the time. Q, P : mode coordinates and momenta at t, (N-1,); on a ring complex.
    """

    t: str
    Q: tuple[str, ...]
    P: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class SavedFile(Result):
    """All that a file holds: the result, and what was noted with it. Made by `saved_file`.

    result : what `load` gives. verdict : what was saved with it, or None.
    provenance : created (UTC), command, versions by package.
    test_vectors : a few points of a torus as it was when it was saved: t, Q and P, (N-1,), as
        decimals; none of other results. All is dimensionless; the format is ours.

    >>> import tempfile
    >>> from symfpu import Chain, lindstedt
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     saved_file(save(f"{folder}/a", lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2)))
    SavedFile(LindstedtSeries(N=8, beta=0.1, ...), no verdict, saved ... by symfpu ...)
    """

    not_kept = "pass what it holds, its .result"

    result: Any
    verdict: Json | None
    provenance: Json
    test_vectors: tuple[OrbitPoint, ...] = field(repr=False, default=())

    def _fields(self) -> Iterator[Field]:
        """Those of the result, and what made the file."""
        yield Field("kind", type(self.result).__name__)
        yield from self.result._fields()
        yield Field("provenance", dict(self.provenance))
        yield Field("assessment", self.verdict)
        points = [json_value(point._asdict()) for point in self.test_vectors]
        yield Field("test_vectors", points)

    def __repr__(self) -> str:
        verdict = "a verdict" if self.verdict is not None else "no verdict"
        version = self.provenance["versions"].get("symfpu", "of unknown version")
        saved = f"saved {self.provenance['created']} by symfpu {version}"
        return f"SavedFile({self.result!r}, {verdict}, {saved})"


@public
def save(
    path: Path | str,
    result: Any,
    *,
    verdict: Json | None = None,
    command: str | None = None,
    created: datetime | None = None,
) -> Path:
    """Write any result as one file; returns its path.

    path : of the file, which is written whole or not at all.
    result : a series, a torus or breather, or any other result: families, orbits, alignment
        indices, multipliers, verdicts, sweeps, ...; with all its digits.
    verdict : any dictionary that JSON gives back unchanged. command : what made the result.
        created : default now.

    A torus is evaluated at a few times, which go into the file as test vectors. Dimensionless;
    the format is ours (docs/precision.md). Raises InputError for other arguments and for a file
    that cannot be written; an existing file stays as it was then.

    >>> import tempfile
    >>> from symfpu import Chain, integrate
    >>> orbit = integrate(Chain(N=4, beta=1), [0.1, 0, 0], [0, 0, 0], 100, step=0.125)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     load(save(f"{folder}/orbit.symfpu", orbit))
    Orbit(N=4, beta=1, T=100, kahan_li8, step 0.125, 129 samples, H=0.00293214917955,
    energy error ...)
    """
    if not isinstance(result, Result):
        allowed, advice = "a result that symfpu computed", "pass what symfpu computed"
        raise InputError("result", type(result).__name__, allowed, advice)
    if result.not_kept:
        allowed = "a result that has a file"
        raise InputError("result", type(result).__name__, allowed, result.not_kept)
    path = _named(path)
    _require_notes(verdict, command, created)
    if isinstance(result, Torus):
        _require_finite(result)
    writer = Writer()
    root = writer.node(result)
    points = _test_vectors(result) if isinstance(result, Torus) else []
    moment = (created or datetime.now(UTC)).astimezone(UTC)
    body = {
        "format": BUNDLE,
        "schema": SCHEMA,
        "created": moment.isoformat(timespec="seconds"),
        "command": command,
        "versions": _versions(),
        "result": root,
        "parts": writer.parts,
        "verdict": verdict,
        "test_vectors": [point._asdict() for point in points],
    }
    write_document(path, body, writer.arrays)
    return path


@public
def load(path: Path | str) -> Any:
    """The result that `save` wrote, exactly as it was, with its methods. Executes nothing.

    path : of the file. What was noted with it: `saved_file`. Dimensionless; the format is ours.

    Raises BundleError for a file that is damaged, foreign, of another schema than this symfpu
    writes, or too large for the free memory; OSError for one that is missing or not to be read.

    >>> import tempfile
    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     kept = load(save(f"{folder}/breather", series))
    >>> all((a == b).all() for a, b in zip(kept.coordinates, series.coordinates))
    True
    """
    return saved_file(path).result


@public
def saved_file(path: Path | str) -> SavedFile:
    """A file that `save` wrote: its result, and the verdict, command and versions beside it.

    path : of the file. Everything in it is dimensionless but for the date; ours. Raises BundleError
    and OSError as `load` does.

    >>> import tempfile
    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     saved_file(save(f"{folder}/a", series, command="by hand")).provenance["command"]
    'by hand'
    """
    path = _named(path)
    with open_to_read(path, "path") as stream:
        if stream.read(len(ARCHIVE)) != ARCHIVE:
            _refuse(path)
        try:
            return _contents(path, Archive(path, stream))
        except BundleError:
            raise
        except UnknownPotential as error:
            problem = f"{error}, which this symfpu does not know"
            raise BundleError(path, problem, "update symfpu") from None
        except MemoryError:
            problem = "needs more memory than is free"
            raise BundleError(path, problem, MEMORY_ADVICE) from None
        except DAMAGE as error:
            reason = " ".join(f"{type(error).__name__} {error}".split())[:LONGEST_REASON]
            advice = "restore it from a copy or compute it again"
            raise BundleError(path, f"is damaged ({reason})", advice) from None


def _contents(path: Path, archive: Archive) -> SavedFile:
    body = archive.body
    if body.get("kind") in KINDS:
        kind = KINDS[body["kind"]]
        problem = f"is a checkpoint of {kind.of}, which holds no torus"
        raise BundleError(path, problem, f"go on from it with {kind.resume}")
    result = Reader(archive, body["parts"]).value(body["result"], Result)
    if not isinstance(result, Result) or result.not_kept:
        raise ValueError(f"{type(result).__name__} is no result")
    result._require_whole()
    return SavedFile(
        result,
        None if body["verdict"] is None else dict(body["verdict"]),
        {name: body[name] for name in ("created", "command", "versions")},
        tuple(map(_orbit_point, body["test_vectors"])),
    )


def _orbit_point(entry: Json) -> OrbitPoint:
    Q, P = tuple(map(str, entry["Q"])), tuple(map(str, entry["P"]))
    return OrbitPoint(str(entry["t"]), Q, P)


def _refuse(path: Path) -> NoReturn:
    """BundleError: what a file is that is no archive, and what opens it."""
    named = format_of(path)
    advice = opened_by(named)
    if advice is None:
        raise BundleError(path, "is not a symfpu bundle", SAVED_ADVICE)
    raise BundleError(path, f"is a file of the format {named!r}, no bundle", advice)


def _require_finite(torus: Torus) -> None:
    try:
        torus.require_finite()
    except ValueError as error:
        problem, advice = str(error), "compute it again"
        raise InputError("result", problem, "finite numbers", advice) from error


def _named(path: object) -> Path:
    """A path; InputError for what names no file."""
    if not isinstance(path, (str, os.PathLike)) or "\0" in os.fsdecode(path):
        raise InputError("path", path, "the name of a file", "pass a string or a Path")
    return Path(os.fsdecode(path))


def _require_notes(verdict: object, command: object, created: object) -> None:
    """InputError for notes that a file does not keep."""
    if command is not None and not isinstance(command, str):
        raise InputError("command", command, "a string or None", "join its words")
    if created is not None and not isinstance(created, datetime):
        raise InputError("created", created, "a datetime or None", "leave it out")
    if verdict is not None and not (isinstance(verdict, dict) and _json_keeps(verdict)):
        allowed = "None or a dictionary that JSON gives back unchanged"
        raise InputError("verdict", verdict, allowed, "use strings as keys, and lists")


def _json_keeps(value: Json) -> bool:
    try:
        return bool(json.loads(json.dumps(value, allow_nan=False)) == value)
    except (TypeError, ValueError, RecursionError):
        return False


def _versions() -> dict[str, str]:
    from importlib.metadata import PackageNotFoundError, version

    versions = {"python": platform.python_version()}
    for package in PACKAGES:
        with contextlib.suppress(PackageNotFoundError):
            versions[package] = version(package)
    return versions


def _test_vectors(torus: Torus) -> list[OrbitPoint]:
    """The torus at the start, after a period of the slowest seed, about, and after many."""
    period = 2 * pi / float(min(torus.frequencies))
    times = [0.0, float(f"{period:.4g}"), float(f"{LONG_RUN * period:.4g}")]

    def written(values: Array) -> tuple[str, ...]:
        if torus.digits is None:
            return tuple(map(repr, values.tolist()))
        return tuple(text(x, torus.digits) for x in values)

    states = zip(times, torus.Q(times), torus.P(times), strict=True)
    return [OrbitPoint(repr(t), written(Q), written(P)) for t, Q, P in states]
