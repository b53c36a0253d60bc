"""A series and its torus, or any other solution, in one file.

The file is a ZIP archive of bundle.json and of arrays that numpy.load reads.

Everything but the tables is in bundle.json: numbers that must come back exactly are strings, and
a digest covers the whole. The tables are flat arrays, order after order and row after row:
doubles, words of integers (symfpu.algebra.words), or places in the list of expressions. Their row
counts follow from the number of seeds and the order (symfpu.algebra.grading). Loading executes
nothing: it compares, splits and rebuilds, and checks every size before it allocates.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from math import pi
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from numpy.typing import NDArray

from symfpu.bundles.entries import UnknownPotential, number, number_entry
from symfpu.bundles.series import series_entries, series_from, series_tables
from symfpu.bundles.solutions import FOURIER, solution_entries, solution_from
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
from symfpu.numbers.typed import integer, order_of
from symfpu.results.field import Field
from symfpu.results.numbers import json_value
from symfpu.results.result import Result
from symfpu.series.series import LindstedtSeries
from symfpu.tori.from_series import FromSeries, RootCertificate
from symfpu.tori.torus import Torus, comes_from, require_solution

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
Solved: TypeAlias = LindstedtSeries | Torus
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
class Bundle(Result):
    """What a file held. Made by `load`; numbers are as they were saved, to the last bit or digit.

    All is dimensionless; the format is ours.

    series : None for a solution without one, as every torus of a ring. torus : any solution, of the
        class that was saved, or None.
    verdict : None if none was saved.
    provenance : created (UTC), command, versions by package.
    test_vectors : a few points of the torus as it was when it was saved: t, Q and P, (N-1,), as
        decimals.
    other : a result that is neither a series nor a solution, or None.

    >>> import tempfile
    >>> from symfpu import Chain, lindstedt
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     load(save(f"{folder}/a", lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2)))
    Bundle(LindstedtSeries(N=8, beta=0.1, ...), no torus, no verdict, saved ... by symfpu ...)
    """

    series: LindstedtSeries | None
    torus: Torus | None
    verdict: Json | None
    provenance: Json
    test_vectors: tuple[OrbitPoint, ...] = field(repr=False, default=())
    other: Any = None

    @property
    def result(self) -> Any:
        """What was saved: the solution, the series, or any other result."""
        held = self.series if self.torus is None else self.torus
        return self.other if held is None else held

    def _fields(self) -> Iterator[Field]:
        """What the file holds, and what made it."""
        held = self.result
        yield Field("kind", type(held).__name__)
        yield from held._fields()
        yield Field("provenance", dict(self.provenance))
        yield Field("assessment", self.verdict)
        points = [json_value(point._asdict()) for point in self.test_vectors]
        yield Field("test_vectors", points)

    def __repr__(self) -> str:
        torus = "no torus"
        if comes_from(self.torus, FromSeries):
            torus = f"a torus of {', '.join(self.torus.origin.facts()[:2])}"
        verdict = "a verdict" if self.verdict is not None else "no verdict"
        version = self.provenance["versions"].get("symfpu", "of unknown version")
        saved = f"saved {self.provenance['created']} by symfpu {version}"
        held = f"{self.series!r}, {torus}" if self.series else repr(self.result)
        return f"Bundle({held}, {verdict}, {saved})"


def save(
    path: Path | str,
    result: Solved,
    *,
    verdict: Json | None = None,
    command: str | None = None,
    created: datetime | None = None,
) -> Path:
    """Write a series, a torus with its series, or any other solution as one file; returns its path.

    path : of the file, which is written whole or not at all.
    result : what to keep, with all its digits; dimensionless.
    verdict : any dictionary that JSON gives back unchanged. command : what made the result.
        created : default now.

    A torus is evaluated at a few times, which go into the file as test vectors. The format is ours.
    Raises InputError for other arguments and for a file that cannot be written; an existing file
    stays as it was then.

    >>> import tempfile
    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     load(save(f"{folder}/a", series)).series.seeds
    (3,)
    """
    path = named_path(path)
    if not isinstance(result, LindstedtSeries):
        require_solution(result, "result")
    require_notes(verdict, command, created)
    parts, members = parts_of(result)
    points: list[OrbitPoint] = []
    if not isinstance(result, LindstedtSeries):
        points = _test_vectors(result)
    known = document(verdict, command, created)
    vectors = [point._asdict() for point in points]
    write_document(path, known | parts | {"test_vectors": vectors}, members)
    return path


def document(verdict: Json | None, command: str | None, created: datetime | None) -> Json:
    """What every file begins with; without a series, a torus and test vectors yet."""
    moment = (created or datetime.now(UTC)).astimezone(UTC)
    return {
        "format": BUNDLE,
        "schema": SCHEMA,
        "created": moment.isoformat(timespec="seconds"),
        "command": command,
        "versions": _versions(),
        "series": None,
        "torus": None,
        "verdict": verdict,
        "test_vectors": [],
    }


def parts_of(result: Solved) -> tuple[Json, dict[str, Array]]:
    """The entries of series and torus, and their arrays."""
    if isinstance(result, LindstedtSeries):
        series, torus = result, None
    elif comes_from(result, FromSeries):
        series, torus = result.origin.series, _torus_entries(result)
    else:
        entries, members = solution_entries(result)
        return {"series": None, "torus": entries}, members
    members, layout = series_tables(series)
    return {"series": series_entries(series) | layout, "torus": torus}, members


def load(path: Path | str) -> Bundle:
    """The series and the torus that `save` wrote, exactly as they were.

    Nothing in the file is executed.

    path : of the file. Everything in it is dimensionless but for the date. The format is ours.

    Raises BundleError for a file that is damaged, foreign, of another schema than this symfpu
    writes, or too large for the free memory; OSError for one that is missing or not to be read.

    >>> import tempfile
    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     kept = load(save(f"{folder}/breather", series)).series
    >>> all((a == b).all() for a, b in zip(kept.coordinates, series.coordinates, strict=True))
    True
    """
    return load_with(path, _no_solution)


def _no_solution(archive: Archive, body: Json) -> Any:
    problem = f"holds {body['root']['class']:.40}, no series and no solution"
    raise BundleError(archive.path, problem, "symfpu show opens it")


def load_with(path: Path | str, other: Callable[[Archive, Json], Any]) -> Bundle:
    """As `load`; other : makes the result of a file with neither a series nor a solution."""
    path = named_path(path)
    with open_to_read(path, "path") as stream:
        if stream.read(len(ARCHIVE)) != ARCHIVE:
            raise _foreign(path)
        try:
            return _bundle(path, Archive(path, stream), other)
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


def _foreign(path: Path) -> BundleError:
    """What a file is that is no archive, and what opens it."""
    named = format_of(path)
    advice = opened_by(named)
    if advice is None:
        return BundleError(path, "is not a symfpu bundle", SAVED_ADVICE)
    return BundleError(path, f"is a file of the format {named!r}, no bundle", advice)


def named_path(path: object) -> Path:
    """A path; InputError for what names no file."""
    if not isinstance(path, (str, os.PathLike)) or "\0" in os.fsdecode(path):
        raise InputError("path", path, "the name of a file", "pass a string or a Path")
    return Path(os.fsdecode(path))


def require_notes(verdict: object, command: object, created: object) -> None:
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


def _by_seed(entries: Mapping[str, Any], seeds: Sequence[int]) -> dict[int, Any]:
    values = {int(q): number(entry) for q, entry in entries.items()}
    if set(values) != set(seeds):
        raise ValueError(
            f"numbers for the seeds {tuple(values)} where {tuple(seeds)} are due"
        )
    return values


def _torus_entries(torus: Torus[FromSeries]) -> Json:
    history = {
        str(K): [number_entry(a) for a in row] for K, row in torus.origin.history.items()
    }
    proof = torus.origin.certificate
    certificate = proof and asdict(proof) | {"radius": _entries_by_seed(proof.radius)}
    return {
        "amplitudes": _entries_by_seed(torus.amplitudes),
        "phases": _entries_by_seed(torus.phases),
        "frequency_order": torus.origin.frequency_order,
        "order": torus.origin.order,
        "history": history,
        "root_residual": repr(float(torus.origin.root_residual)),
        "certificate": certificate,
        "warnings": list(torus.warnings),
    }


def _entries_by_seed(values: Mapping[int, Any]) -> Json:
    return {str(q): number_entry(value) for q, value in values.items()}


def _torus(body: Json, series: LindstedtSeries) -> Torus[FromSeries]:
    order = order_of(body["order"])
    frequency_order = integer(body["frequency_order"], "frequency_order", 0)
    if max(order, frequency_order) > series.order or series.frequencies is None:
        orders = f"order {order} and frequency order {frequency_order}"
        raise ValueError(f"no torus of {orders} can come from this series")
    seeds, proof = series.seeds, body["certificate"]
    history = {int(K): tuple(map(number, row)) for K, row in body["history"].items()}
    amplitudes = _by_seed(body["amplitudes"], seeds)
    origin = FromSeries(
        series=series,
        amplitudes=tuple(amplitudes[q] for q in seeds),
        frequency_order=frequency_order,
        order=order,
        history=history,
        root_residual=float(body["root_residual"]),
        certificate=proof and _certificate(proof, seeds),
    )
    phases, warnings = _by_seed(body["phases"], seeds), map(str, body["warnings"])
    return origin.torus(phases, tuple(warnings))


def _certificate(proof: Json, seeds: tuple[int, ...]) -> RootCertificate:
    radius = _by_seed(proof["radius"], seeds)
    return RootCertificate(proof["certified"] is True, radius, str(proof["reason"]))


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


def _bundle(path: Path, archive: Archive, other: Callable[[Archive, Json], Any]) -> Bundle:
    body = archive.body
    if body.get("kind") in KINDS:
        kind = KINDS[body["kind"]]
        problem = f"is a checkpoint of {kind.of}, which holds no torus"
        raise BundleError(path, problem, f"go on from it with {kind.resume}")
    series = torus = held = None
    if "result" in body:
        held = other(archive, body["result"])
    else:
        series, torus = _held(archive, body)
    return Bundle(
        series=series,
        torus=torus,
        verdict=None if body["verdict"] is None else dict(body["verdict"]),
        provenance={name: body[name] for name in ("created", "command", "versions")},
        test_vectors=tuple(map(_orbit_point, body["test_vectors"])),
        other=held,
    )


def _held(archive: Archive, body: Json) -> tuple[Any, Any]:
    """The series and the solution of the entries that `parts_of` makes, or None."""
    series = None if body["series"] is None else series_from(archive, body["series"])
    return series, _solution(archive, body["torus"], series)


def parts_from(archive: Archive, body: Json) -> Any:
    """The series or the solution of such entries."""
    series, torus = _held(archive, body)
    return series if torus is None else torus


def _orbit_point(entry: Json) -> OrbitPoint:
    Q, P = tuple(map(str, entry["Q"])), tuple(map(str, entry["P"]))
    return OrbitPoint(str(entry["t"]), Q, P)


def _solution(
    archive: Archive, body: Json | None, series: LindstedtSeries | None
) -> Torus | None:
    if series is not None:
        return None if body is None else _torus(body, series)
    if body is None or body["kind"] != FOURIER:
        kind = None if body is None else body["kind"]
        raise ValueError(f"a torus of kind {kind!r:.40} without a series")
    return solution_from(archive, body)
