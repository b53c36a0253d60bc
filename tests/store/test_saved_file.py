"""Bundles: exact round trips in every ring, and one clear line for every file that is not one, is damaged, or lies."""

import errno
import hashlib
import io
import json
import os
import random
import zipfile
from dataclasses import fields, is_dataclass, replace
from datetime import UTC, datetime
from fractions import Fraction
from functools import partial
from itertools import product

import mpmath
import numpy as np
import pytest

from symfpu import Chain, InputError, RootCertificate, lindstedt, load, prove_propagation, save, saved_file, solve_amplitudes
from symfpu.algebra.formulas import NodeTable
from symfpu.algebra.grading import Grading
from symfpu.proofs.certificates import random_point
from symfpu.series.residues import residue_series
from tests.system import of_system, raising

ALPHA, BETA, BOTH = Chain(8, alpha="0.3"), Chain(8, beta="-0.1"), Chain(8, alpha="1/3", beta="0.7")
PHASES = {1: 0.4, 2: -1.3}


def residues(chain, seeds, order):
    point = random_point(chain.N, len(seeds), 1 + chain.degree_step * order, random.Random(1))
    return residue_series(chain, seeds, point, order)


SERIES = {
    "alpha": lambda: lindstedt(ALPHA, (1, 2), ("0.3905", "0.7663"), 6),
    "beta": lambda: lindstedt(BETA, (1, 2), ("0.3905", "0.7663"), 4),
    "both": lambda: lindstedt(BOTH, (1, 2), ("0.3905", "0.7663"), 4),
    "wrapped modes": lambda: lindstedt(Chain(5, alpha=1), (3, 4), ("1.61", "1.91"), 8),
    "order 0": lambda: lindstedt(ALPHA, (2,), ("0.77",), 0),
    "N = 2": lambda: lindstedt(Chain(2, beta=1), (1,), ("1.4",), 3),
    "one seed, scaled": lambda: lindstedt(Chain(8, alpha=1000), (1,), ("0.3905",), 60),
    "four seeds": lambda: lindstedt(BOTH, (1, 2, 3, 5), ("0.3905", "0.766", "1.113", "1.67"), 3),
    "long fraction": lambda: lindstedt(ALPHA, (1,), (Fraction(3**9100 + 1, 3**9101),), 2),
    "digits": lambda: lindstedt(BOTH, (1, 2), ("0.3905", "0.7663"), 4, digits=30),
    "digits, beta": lambda: lindstedt(BETA, (1, 2), ("0.3905", "0.7663"), 3, digits=70),
    "digits, order 0": lambda: lindstedt(BETA, (1,), ("0.3905",), 0, digits=30),
    "residue": lambda: residues(ALPHA, (1, 2), 5),
    "residue, beta": lambda: residues(BETA, (3,), 3),
    "symbolic": lambda: lindstedt(BOTH, (1, 2), order=3),
    "nested": lambda: lindstedt(BOTH, (1, 2), order=4, ring="nested"),
    "nested, beta": lambda: lindstedt(BETA, (1, 2, 5), order=2, ring="nested"),
}
POTENTIALS = ["toda:1/2", "lj:12,6", "poly:1/3,0,1/5", "poly:0,0,0,1/5"]
CHOSEN = {"universal": {}, "digits": {"frequencies": ("0.392",), "digits": 30}}
WAVES = [{"potential": "toda:1/2"}, {"beta": "1/3"}, {"alpha": "1/3", "beta": "-1/5"}]


def waves(order=6, **law):
    chain = Chain(8, **(law or WAVES[0]), ends="periodic")
    return lindstedt(chain, (1, -3), ("0.7661", "1.8486"), order)


OTHERS = {
    f"{text}, {kind}": partial(lindstedt, Chain(8, potential=text), (1,), order=2, **chosen)
    for text, (kind, chosen) in product(POTENTIALS, CHOSEN.items())
}
OTHERS |= {f"waves of order {order}, {law}": partial(waves, order, **law) for order, law in product((0, 1, 5), WAVES)}
ALL_LENGTHS = {
    "all N": lambda: lindstedt(Chain("N", alpha=1, beta="1/3"), (1, 2), order=3),
    "all N, both ends": lambda: lindstedt(Chain("N", alpha=1), ("N-2", 1), order=4, ring="nested"),
    "all N, high, beta": lambda: lindstedt(Chain("N", beta="-1/3"), ("N-1",), order=2),
    "all N, Toda": lambda: lindstedt(Chain("N", potential="toda:1/2"), (1,), order=3, ring="nested"),
    "all N, order 0": lambda: lindstedt(Chain("N", beta=1), ("N-1", 3), order=0),
}


@pytest.fixture(scope="module", params=["doubles", "digits"])
def torus(request):
    """Phases, history, warnings; with digits also a certificate."""
    digits = 30 if request.param == "digits" else None
    series = lindstedt(Chain(8, alpha="0.3", beta="0.1"), (1, 2), ("0.3905", "0.7663"), 6, digits=digits)
    return replace(solve_amplitudes(series, frequency_order=4, order=5, phases=PHASES), warnings=('a "doubt", \u00b5 = 1e-3',))


@pytest.fixture(scope="module")
def healthy(tmp_path_factory):
    """A small torus of doubles with everything in it, its bundle, and the bundle's bytes."""
    series = lindstedt(ALPHA, (1, 2), ("0.3905", "0.7663"), 3)
    path = tmp_path_factory.mktemp("bundles") / "healthy"
    save(path, solve_amplitudes(series, phases=PHASES), verdict={"verdict": "good"}, command="a command")
    return saved_file(path), path.read_bytes()


def same(a, b):
    """Equality in type and value, down to the bits of a float and the entries of an array."""
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        inside = all(map(same, a.flat, b.flat)) if a.dtype == object else a.tobytes() == b.tobytes()
        return a.dtype == b.dtype and a.shape == b.shape and inside
    if isinstance(a, NodeTable):
        programs = [(p.symbols, p.start.tolist(), *(t.tolist() for t in p.terms)) for p in (a.program, b.program)]
        return same(a.nodes, b.nodes) and a.expanded == b.expanded and programs[0] == programs[1]
    if isinstance(a, Grading):
        return (a.seeds, a.degree) == (b.seeds, b.degree)
    if is_dataclass(a):
        return all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    if isinstance(a, dict):
        return list(a) == list(b) and all(map(same, a.values(), b.values()))
    if isinstance(a, (tuple, list)):
        return len(a) == len(b) and all(map(same, a, b))
    return repr(a._mpf_) == repr(b._mpf_) if isinstance(a, mpmath.mpf) else repr(a) == repr(b) if isinstance(a, float) else bool(a == b)


@pytest.mark.parametrize("case", SERIES | ALL_LENGTHS | OTHERS)
def test_a_series_comes_back_exactly(case, tmp_path):
    series = (SERIES | ALL_LENGTHS | OTHERS)[case]()
    held = saved_file(save(tmp_path / "series", series))
    assert same(held.result, series)
    assert held.verdict is None
    assert held.test_vectors == ()
    assert repr(held).startswith(f"SavedFile({series!r}, no verdict, saved 20")


def test_numbers_of_a_torus_keep_their_kind(torus, tmp_path):
    """Doubles beside mpf, negative and tiny ones, an infinite radius, no history."""
    origin = replace(
        torus.origin,
        history={},
        root_residual=float("nan"),
        certificate=RootCertificate(False, {1: float("inf"), 2: 5e-324}, "a reason"),
    )
    phases = {2: mpmath.mpf(0), 1: -0.0}
    odd = origin.torus(phases)
    assert same(load(save(tmp_path / "torus", odd)), odd)
    if torus.digits:
        tiny = replace(origin, amplitudes=(mpmath.mpf("-1e-5000"), 0.1)).torus(phases)
        assert same(load(save(tmp_path / "torus", tiny)), tiny)


def test_verdict_and_provenance_survive(torus, tmp_path):
    verdict = {"verdict": "proved", "certificate": prove_propagation(8, (1, 2), 2).certificate(), "sizes": [0.1, 1e300, None, True]}
    created = datetime(2026, 3, 1, 12, 30, tzinfo=UTC)
    held = saved_file(save(str(tmp_path / "torus"), torus, verdict=verdict, command="symfpu solve -N 8 \u00b5", created=created))
    assert same(held.verdict, verdict)
    assert held.provenance["created"] == "2026-03-01T12:30:00+00:00"
    assert held.provenance["command"] == "symfpu solve -N 8 \u00b5"
    assert {"python", "symfpu", "numpy", "scipy", "mpmath", "symengine", "python-flint"} <= set(held.provenance["versions"])
    assert "frequency order 4, order 5" in repr(held)
    assert ", a verdict, saved 2026-03-01T12:30:00+00:00 by symfpu" in repr(held)


def test_the_test_vectors_are_points_of_the_torus(torus, tmp_path):
    points = saved_file(save(tmp_path / "torus", torus)).test_vectors
    assert [p.t for p in points] == ["0.0", "16.09", "1609.0"]
    t = [float(p.t) for p in points]
    for written, values in (([p.Q for p in points], torus.Q(t)), ([p.P for p in points], torus.P(t))):
        if torus.digits is None:
            assert np.array_equal(np.array(written, dtype=float), values)
        else:
            with mpmath.workdps(60):
                errors = [abs(mpmath.mpf(w) / x - 1) for w, x in zip(np.ravel(written), values.flat, strict=True)]
                assert max(errors) < mpmath.mpf(10) ** (1 - torus.digits)


def test_the_format_is_open(torus, tmp_path):
    """JSON and arrays that numpy reads, digests that anyone can check, inputs as exact strings."""
    members, body = opened(save(tmp_path / "torus", torus))
    assert (body["format"], body["schema"]) == ("symfpu bundle", 9)
    (series,), found = body["parts"], body["result"]["fields"]
    assert (series["alpha"], series["beta"], series["frequencies"]) == ("0.3", "0.1", ["0.3905", "0.7663"])
    assert body["digest"] == digest({k: v for k, v in body.items() if k != "digest"})
    for name, expected in body["arrays"].items():
        assert hashlib.sha256(members[f"{name}.npy"]).hexdigest() == expected
    tables = [getattr(table, "words", table) for table in torus.origin.series.coordinates]
    flat = np.load(io.BytesIO(members["part0.coordinates.npy"]), allow_pickle=False)
    assert np.array_equal(flat, np.concatenate([table.ravel() for table in tables]))
    kept = found["origin"]["fields"]["amplitudes"]["tuple"]
    for entry, amplitude in zip(kept, torus.amplitudes.values(), strict=True):
        assert float(entry["mpf"]["decimal"] if torus.digits else entry["float"]) == float(amplitude)
    assert np.array_equal(np.load(io.BytesIO(members["harmonics.npy"])), torus.harmonics.ravel())


def test_a_program_has_the_shortest_integers(tmp_path):
    series = SERIES["nested"]()
    members, _ = opened(save(tmp_path / "program", series))
    program = series.coordinates[0].program
    for name, values in zip(("start", "left", "right", "factor"), (program.start, *program.terms), strict=True):
        kept = np.load(io.BytesIO(members[f"part0.program_{name}.npy"]))
        assert np.array_equal(kept, values)
        bits = int(max(values.max(), -1 - values.min())).bit_length() + 1
        assert bits <= 8 * kept.dtype.itemsize < 2 * max(bits, 8)


def digest(body):
    return hashlib.sha256(json.dumps(body, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def opened(path):
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    return members, json.loads(members["bundle.json"])


@pytest.mark.parametrize("error", [of_system(errno.ENOSPC), KeyboardInterrupt()])
@pytest.mark.parametrize("step", ["os.replace", "os.fsync", "zipfile._ZipWriteFile.write"])
def test_a_failed_write_leaves_the_old_file(step, error, healthy, tmp_path, monkeypatch):
    path = tmp_path / "kept"
    path.write_bytes(healthy[1])
    monkeypatch.setattr(step, raising(error))
    with pytest.raises(InputError if isinstance(error, OSError) else KeyboardInterrupt, match=r"No space left|^$"):
        save(path, healthy[0].result)
    assert os.listdir(tmp_path) == ["kept"]
    assert path.read_bytes() == healthy[1]


def test_places_that_cannot_be_written_are_refused(healthy, tmp_path):
    (tmp_path / "file").write_bytes(b"x")
    for path in (tmp_path / "missing" / "a", tmp_path / "file" / "a", tmp_path, ""):
        with pytest.raises(InputError, match="a file that can be written"):
            save(path, healthy[0].result.origin.series)
    assert os.listdir(tmp_path) == ["file"]


def test_wrong_arguments_are_refused(healthy, tmp_path):
    path, series = tmp_path / "a", healthy[0].result.origin.series
    for call in (
        lambda: save(path, healthy[0]),
        lambda: save(path, None),
        lambda: save(3, series),
        lambda: save("a\0b", series),
        lambda: load(None),
        lambda: save(path, series, command=["a"]),
        lambda: save(path, series, created="today"),
        lambda: save(path, series, verdict="good"),
        lambda: save(path, series, verdict={1: 2}),
        lambda: save(path, series, verdict={"a": (1, 2)}),
        lambda: save(path, series, verdict={"a": float("nan")}),
        lambda: save(path, series, verdict={"a": series}),
    ):
        with pytest.raises(InputError):
            call()
    assert os.listdir(tmp_path) == []
