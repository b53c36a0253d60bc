"""A series and its torus, or a refined torus, in one file: a ZIP archive of bundle.json and of arrays that numpy.load reads.

Everything but the tables is in bundle.json: numbers that must come back exactly are strings, and a digest covers the whole.
The tables are flat arrays, order after order and row after row: doubles, words of integers (symfpu.algebra.words), or places
in the list of expressions. Their row counts follow from the number of seeds and the order (symfpu.algebra.grading).
Loading executes nothing: it compares, splits and rebuilds, and checks every size before it allocates.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from functools import partial
from math import comb, pi, prod
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import canonical_count
from symfpu.algebra.words import IntegerTable
from symfpu.bundles.entries import ExpressionNodes, expressions_of, fraction, fraction_text, number, number_entry
from symfpu.bundles.refined import refined_entries, refined_from
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.files.archive import FORMAT, SCHEMA, Archive, BundleError, Json, digest_of, member_digest, write_archive
from symfpu.files.checkpoint import KINDS
from symfpu.numbers.arithmetic import text
from symfpu.numbers.typed import integer, seed_modes
from symfpu.refinement.tori import RefinedTorus
from symfpu.series.divisors import SmallDivisor
from symfpu.series.recursion import shared_grading
from symfpu.series.series import LindstedtSeries, ResiduePoint
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.torus import QTorus, RootCertificate

Array = NDArray[Any]
Shapes = tuple[list[tuple[int, ...]], list[tuple[int, ...]]]  # of the tables of coordinates and of corrections, by order
PACKAGES = ("symfpu", "numpy", "scipy", "mpmath", "symengine", "sympy", "python-flint", "gmpy2", "numba", "llvmlite")
DTYPES = {"float64": "<f8", "residue": "<f8", "fixedpoint": "<i8", "symbolic": "<i8", "nested": "<i8"}
REFINED = "refined"  # kind of a torus without a series
LONGEST_REASON = 160
LONG_RUN = 100  # periods of the slowest seed at which the last test vector is taken


class OrbitPoint(NamedTuple):
    """A point of the torus for tests of other programs: t, and Q_1 .. Q_(N-1) and P_1 .. P_(N-1) at t, as decimals."""

    t: str
    Q: tuple[str, ...]
    P: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Bundle:
    """What a file held. series : None for a refined torus. torus, verdict : None if none was saved. provenance : created (UTC),
    command, versions by package. test_vectors : a few points of the torus as it was when it was saved."""

    series: LindstedtSeries | None
    torus: QTorus | RefinedTorus | None
    verdict: Json | None
    provenance: Json
    test_vectors: tuple[OrbitPoint, ...] = field(repr=False, default=())

    def __repr__(self) -> str:
        torus = "no torus"
        if isinstance(self.torus, QTorus):
            torus = f"QTorus of frequency order {self.torus.frequency_order}, order {self.torus.order}"
        verdict = "a verdict" if self.verdict is not None else "no verdict"
        saved = f"saved {self.provenance['created']} by symfpu {self.provenance['versions'].get('symfpu', 'of unknown version')}"
        held = f"{self.series!r}, {torus}" if self.series else repr(self.torus)
        return f"Bundle({held}, {verdict}, {saved})"


def save(
    path: Path | str,
    result: LindstedtSeries | QTorus | RefinedTorus,
    *,
    verdict: Json | None = None,
    command: str | None = None,
    created: datetime | None = None,
) -> Path:
    """Write a series, a torus with its series, or a refined torus as one file, whole or not at all; returns its path.

    verdict : any dictionary that JSON gives back unchanged. command : what made the result. created : default now.
    A torus is evaluated at a few times, which go into the file as test vectors.
    Raises InputError for other arguments and for a file that cannot be written; an existing file stays as it was then.

    >>> import tempfile
    >>> from symfpu.series.lindstedt import lindstedt
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     load(save(f"{folder}/breather", lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2))).series.seeds
    (3,)
    """
    path = _path(path)
    _require_arguments(result, verdict, command, created)
    if isinstance(result, RefinedTorus):
        entries, members = refined_entries(result)
        parts: Json = {"series": None, "torus": entries | {"kind": REFINED}}
    else:
        series = result if isinstance(result, LindstedtSeries) else result.series
        members, layout = _tables(series)
        parts = {"series": _series_entries(series) | layout, "torus": _torus_entries(result) if isinstance(result, QTorus) else None}
    body: Json = {
        "format": FORMAT,
        "schema": SCHEMA,
        "created": (created or datetime.now(UTC)).astimezone(UTC).isoformat(timespec="seconds"),
        "command": command,
        "versions": _versions(),
        **parts,
        "verdict": verdict,
        "test_vectors": [] if isinstance(result, LindstedtSeries) else [point._asdict() for point in _test_vectors(result)],
        "arrays": {name: member_digest(values) for name, values in members.items()},
    }
    write_archive(path, body | {"digest": digest_of(body)}, members)
    return path


def load(path: Path | str) -> Bundle:
    """The series and the torus that `save` wrote, exactly as they were; nothing in the file is executed.

    Raises BundleError for a file that is damaged, foreign, newer than this symfpu or too large for the free memory;
    OSError for one that is missing or not to be read.
    """
    path = _path(path)
    with path.open("rb") as stream:
        if stream.read(4) != b"PK\x03\x04":
            raise BundleError(path, "is not a symfpu bundle", "give a file that symfpu.save wrote")
        try:
            return _bundle(path, Archive(path, stream))
        except BundleError:
            raise
        except Exception as error:  # whatever zipfile, zlib, json, numpy and our own checks say to a damaged or hostile file
            reason = " ".join(f"{type(error).__name__} {error}".split())[:LONGEST_REASON]
            raise BundleError(path, f"is damaged ({reason})", "restore it from a copy or compute it again") from None


def _path(path: object) -> Path:
    if not isinstance(path, (str, os.PathLike)) or "\0" in os.fsdecode(path):
        raise InputError("path", path, "the name of a file", "pass a string or a Path")
    return Path(os.fsdecode(path))


def _require_arguments(result: object, verdict: object, command: object, created: object) -> None:
    if not isinstance(result, (LindstedtSeries, QTorus, RefinedTorus)):
        allowed = "a LindstedtSeries, a QTorus or a RefinedTorus"
        raise InputError("result", type(result).__name__, allowed, "pass what lindstedt, solve_amplitudes or refine gave")
    if command is not None and not isinstance(command, str):
        raise InputError("command", command, "a string or None", "join its words")
    if created is not None and not isinstance(created, datetime):
        raise InputError("created", created, "a datetime or None", "leave it out")
    if verdict is not None and not (isinstance(verdict, dict) and _json_keeps(verdict)):
        raise InputError("verdict", verdict, "None or a dictionary that JSON gives back unchanged", "use strings as keys, and lists")


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
        raise ValueError(f"numbers for the seeds {tuple(values)} where {tuple(seeds)} are due")
    return values


# the series


def _tables(series: LindstedtSeries) -> tuple[dict[str, Array], Json]:
    """The flat arrays by name, and what else is needed to cut them into tables again."""
    layout: Json = {}
    tables = {"coordinates": series.coordinates, "corrections": series.corrections[1:]}
    if series.ring == "fixedpoint":
        tables = {name: tuple(table.words for table in parts) for name, parts in tables.items()}
        layout["words"] = {name: [int(words.shape[2]) for words in parts] for name, parts in tables.items()}
        if series.radii:
            tables["coordinate_radii"] = (np.array([radius for radius, _ in series.radii]),)
            tables["correction_radii"] = tuple(radii for _, radii in series.radii)
    if series.symbolic:
        expressions = ExpressionNodes()
        tables = {name: tuple(expressions.places(table) for table in parts) for name, parts in tables.items()}
        layout["expressions"] = expressions.nodes
    members = {}
    for name, parts in tables.items():
        dtype = "<f8" if name.endswith("radii") else DTYPES[series.ring]
        members[name] = np.concatenate([np.empty(0, dtype), *(np.ravel(part) for part in parts)]).astype(dtype, copy=False)
    return members, layout


def _series_entries(series: LindstedtSeries) -> Json:
    point = series.point
    return {
        "N": series.chain.N,
        "alpha": fraction_text(series.chain.alpha),
        "beta": fraction_text(series.chain.beta),
        "seeds": list(series.seeds),
        "frequencies": None if series.frequencies is None else [fraction_text(w) for w in series.frequencies],
        "order": series.order,
        "ring": series.ring,
        "digits": series.digits,
        "bits": series.bits,
        "unit": fraction_text(series.unit),
        "multiply_adds": str(series.multiply_adds),
        "smallest_divisors": [asdict(d) | {"size": repr(d.size)} for d in series.smallest_divisors],
        "point": point and {"prime": str(point.prime), "root": str(point.root), "frequencies": list(map(str, point.frequencies))},
    }


def _shapes(body: Json, chain: Chain, seeds: int, order: int, most: int) -> Shapes:
    """The shapes of all tables; ValueError as soon as they need more than `most` rows, so that no count grows without bound."""
    shapes: Shapes = ([], [])
    for k in range(order + 1):
        degree = chain.degree_step * k
        shapes[0].append((canonical_count(seeds, degree + 1), chain.N - 1))
        shapes[1].append((0 if degree % 2 or not k else comb(degree // 2 + seeds - 1, seeds - 1), seeds))
        most -= shapes[0][-1][0]
        if most < 0:
            raise ValueError(f"order {order} of {seeds} seeds needs more rows than the file holds")
    if body["ring"] == "fixedpoint":
        for tables, name, first in zip(shapes, ("coordinates", "corrections"), (0, 1), strict=True):
            counts = [integer(n, "words", 1) for n in body["words"][name]]
            tables[first:] = [(*shape, n) for shape, n in zip(tables[first:], counts, strict=True)]
    return shapes


def _split(flat: Array, shapes: Iterable[tuple[int, ...]]) -> list[Array]:
    parts, at = [], 0
    for shape in shapes:
        parts.append(flat[at : at + prod(shape)].reshape(shape))
        at += prod(shape)
    return parts


def _read_tables(archive: Archive, body: Json, chain: Chain, seeds: int, order: int) -> Json:
    """Coordinates, corrections and radii as a series holds them."""
    shapes = _shapes(body, chain, seeds, order, archive.entries("coordinates"))

    def tables(name: str, dtype: str, shapes: Sequence[tuple[int, ...]]) -> list[Array]:
        return _split(archive.array(name, dtype, sum(map(prod, shapes))), shapes)

    ring = body["ring"]
    wrap: Callable[[Array], Any] = np.asarray
    radii: tuple[Any, ...] = ()
    if ring == "fixedpoint":
        wrap = IntegerTable
        if "coordinate_radii" in archive.digests:
            largest = archive.array("coordinate_radii", "<f8", order + 1).tolist()
            radii = tuple(zip(largest, tables("correction_radii", "<f8", [shape[:2] for shape in shapes[1]]), strict=True))
    elif ring in ("symbolic", "nested"):
        wrap = partial(_looked_up, expressions_of(body["expressions"]))
    return {
        "coordinates": tuple(map(wrap, tables("coordinates", DTYPES[ring], shapes[0]))),
        "corrections": (np.zeros((0, seeds)), *map(wrap, tables("corrections", DTYPES[ring], shapes[1][1:]))),  # order 0 has none
        "radii": radii,
    }


def _series(archive: Archive, body: Json) -> LindstedtSeries:
    chain = Chain(integer(body["N"], "N", 2), fraction(body["alpha"]), fraction(body["beta"]))
    seeds, order = seed_modes(body["seeds"], chain.N), integer(body["order"], "order", 0)
    chosen, point, digits = body["frequencies"], body["point"], body["digits"]
    frequencies = None if chosen is None else tuple(fraction(w) for w in chosen)
    if list(seeds) != sorted(seeds) or (frequencies is not None and (len(frequencies) != len(seeds) or min(frequencies) <= 0)):
        raise ValueError(f"seeds {seeds} and frequencies {chosen} do not go together")
    if (frequencies is not None, digits is not None, point is not None) != {
        "float64": (True, False, False),
        "fixedpoint": (True, True, False),
        "residue": (False, False, True),
    }.get(body["ring"], (False, False, False)):
        raise ValueError(f"frequencies, digits and point do not fit the ring {body['ring']!r:.40}")
    return LindstedtSeries(
        chain=chain,
        seeds=seeds,
        frequencies=frequencies,
        order=order,
        ring=body["ring"],
        **_read_tables(archive, body, chain, len(seeds), order),
        grading=shared_grading(len(seeds), 1 + chain.degree_step * order),
        unit=fraction(body["unit"]),
        smallest_divisors=tuple(
            SmallDivisor(float(d["size"]), integer(d["mode"], "mode", 1), tuple(map(int, d["harmonic"])), integer(d["order"], "order", 0))
            for d in body["smallest_divisors"]
        ),
        multiply_adds=int(body["multiply_adds"]),
        digits=None if digits is None else integer(digits, "digits", 1),
        bits=integer(body["bits"], "bits", 0),
        point=point and ResiduePoint(int(point["prime"]), int(point["root"]), tuple(int(w) for w in point["frequencies"])),
    )


def _looked_up(expressions: Array, places: Array) -> Array:
    if places.size and not 0 <= places.min() <= places.max() < len(expressions):
        raise ValueError("a coefficient is none of the expressions")
    return np.asarray(expressions[places])


# the torus


def _torus_entries(torus: QTorus) -> Json:
    proof = torus.certificate
    return {
        "amplitudes": {str(q): number_entry(a) for q, a in torus.amplitudes.items()},
        "phases": {str(q): number_entry(a) for q, a in torus.phases.items()},
        "frequency_order": torus.frequency_order,
        "order": torus.order,
        "history": {str(K): [number_entry(a) for a in row] for K, row in torus.history.items()},
        "root_residual": repr(float(torus.root_residual)),
        "certificate": proof and asdict(proof) | {"radius": {str(q): number_entry(r) for q, r in proof.radius.items()}},
        "warnings": list(torus.warnings),
    }


def _torus(body: Json, series: LindstedtSeries) -> QTorus:
    proof, order, frequency_order = body["certificate"], *(integer(body[name], name, 0) for name in ("order", "frequency_order"))
    if max(order, frequency_order) > series.order or series.frequencies is None:
        raise ValueError(f"no torus of order {order} and frequency order {frequency_order} can come from this series")
    return QTorus(
        series=series,
        amplitudes=_by_seed(body["amplitudes"], series.seeds),
        phases=_by_seed(body["phases"], series.seeds),
        frequency_order=frequency_order,
        order=order,
        history={int(K): tuple(map(number, row)) for K, row in body["history"].items()},
        root_residual=float(body["root_residual"]),
        certificate=proof and RootCertificate(proof["certified"] is True, _by_seed(proof["radius"], series.seeds), str(proof["reason"])),
        warnings=tuple(map(str, body["warnings"])),
    )


def _test_vectors(torus: QuasiPeriodic) -> list[OrbitPoint]:
    """The torus at the start, after a period of the slowest seed, about, and after many."""
    period = 2 * pi / float(min(torus.frequencies))
    times = [0.0, float(f"{period:.4g}"), float(f"{LONG_RUN * period:.4g}")]

    def written(values: Array) -> tuple[str, ...]:
        return tuple(repr(float(x)) if torus.digits is None else text(x, torus.digits) for x in values)

    return [
        OrbitPoint(repr(t), written(Q), written(P)) for t, Q, P in zip(times, torus.positions(times), torus.momenta(times), strict=True)
    ]


def _bundle(path: Path, archive: Archive) -> Bundle:
    body = archive.body
    if body.get("kind") in KINDS:
        kind = KINDS[body["kind"]]
        raise BundleError(path, f"is a checkpoint of {kind.of}, which holds no torus", f"go on from it with {kind.resume}")
    series = None if body["series"] is None else _series(archive, body["series"])
    torus: QTorus | RefinedTorus | None = None
    if series is None:
        if body["torus"]["kind"] != REFINED:
            raise ValueError(f"a torus of kind {body['torus']['kind']!r:.40} without a series")
        torus = refined_from(archive, body["torus"])
    elif body["torus"] is not None:
        torus = _torus(body["torus"], series)
    return Bundle(
        series=series,
        torus=torus,
        verdict=None if body["verdict"] is None else dict(body["verdict"]),
        provenance={name: body[name] for name in ("created", "command", "versions")},
        test_vectors=tuple(OrbitPoint(str(v["t"]), tuple(map(str, v["Q"])), tuple(map(str, v["P"]))) for v in body["test_vectors"]),
    )
