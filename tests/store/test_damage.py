"""Bundles: one clear line for every file that is not one, is damaged, or lies."""
# ruff: noqa: F811 (pytest passes fixtures by name)

import hashlib
import io
import json
import os
import pickle
import random
import struct
import tracemalloc
import zipfile

import numpy as np
import pytest
import symengine as se

from symfpu import BundleError, Chain, lindstedt, load, prove_propagation, save, saved_file
from symfpu.files.archive import Archive
from tests.store.test_saved_file import ALPHA, digest, healthy, opened, same  # noqa: F401 (a fixture)
from tests.system import raising


def refused(path, data):
    """Whether these bytes are refused, by one line that names the file; else what they load as."""
    path.write_bytes(data)
    try:
        return saved_file(path)
    except BundleError as error:
        line, shown = str(error), error.__cause__ or (error.__context__ and not error.__suppress_context__)
    assert line.startswith(f"{path} ")
    assert "\n" not in line
    assert not shown  # no traceback of a library above ours
    return None


def test_no_truncated_file_loads(healthy, tmp_path):
    _, data = healthy
    for length in [*range(0, len(data), 23), *range(len(data) - 120, len(data))]:
        assert refused(tmp_path / "cut", data[:length]) is None


def test_flipped_bits_and_overwritten_bytes_are_found(healthy, tmp_path):
    """Most are refused; those in fields of the archive that nobody reads change nothing."""
    bundle, data = healthy
    source, found = random.Random(5), 0
    for trial in range(1000):
        bad, at = bytearray(data), source.randrange(len(data))
        if trial % 2:
            bad[at] ^= 1 << source.randrange(8)
        else:
            bad[at : at + source.randrange(1, 40)] = source.randbytes(source.randrange(40))
        result = refused(tmp_path / "bad", bytes(bad))
        found += result is None
        assert result is None or same(result, bundle)
    assert found > 900


@pytest.mark.long
def test_every_bit_of_the_directory_may_flip(healthy, tmp_path):
    """The part that claims sizes, names and methods."""
    bundle, data = healthy
    for at in range(data.index(b"PK\x01\x02"), len(data)):
        for bit in range(8):
            result = refused(tmp_path / "bad", data[:at] + bytes([data[at] ^ 1 << bit]) + data[at + 1 :])
            assert result is None or same(result, bundle)


def foreign(kind, path):
    if kind == "certificate":
        prove_propagation(8, (1, 4), 2).write(path)
    elif kind == "npz":
        with path.open("wb") as stream:
            np.savez(stream, coordinates=np.zeros(3))
    elif kind == "other zip":
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("bundle.json", "[]")
    else:
        contents = {"empty": b"", "text": b"Q = 1\n", "pickle": pickle.dumps({"format": "symfpu bundle"}), "PK only": b"PK\x03\x04"}
        path.write_bytes(contents[kind])


FOREIGN = {
    "certificate": "is a file of the format 'symfpu propagation certificate', no bundle; symfpu verify opens it",
    "PK only": "is damaged",
}


@pytest.mark.parametrize("kind", ["certificate", "npz", "other zip", "empty", "text", "pickle", "PK only"])
def test_foreign_files_are_refused(kind, tmp_path):
    foreign(kind, tmp_path / "file")
    with pytest.raises(BundleError, match=FOREIGN.get(kind, "is not a symfpu bundle")):
        load(tmp_path / "file")


def test_a_lack_of_memory_is_no_damage(healthy, tmp_path, monkeypatch):
    path = tmp_path / "file"
    path.write_bytes(healthy[1])
    monkeypatch.setattr(Archive, "array", raising(MemoryError()))
    with pytest.raises(BundleError, match="needs more memory than is free; close other programs"):
        load(path)


def test_files_that_cannot_be_read_are_errors_of_the_system(tmp_path):
    for path in (tmp_path / "missing", tmp_path):
        with pytest.raises(OSError, match=path.name):
            load(path)


def forged(path, change):
    """Rewrite a bundle after change(members, body), all digests made right again."""
    members, body = opened(path)
    change(members, body)
    for name in body["arrays"]:
        if f"{name}.npy" in members:
            body["arrays"][name] = hashlib.sha256(members[f"{name}.npy"]).hexdigest()
    members["bundle.json"] = json.dumps(body | {"digest": digest({k: v for k, v in body.items() if k != "digest"})}).encode()
    return written(path, members)


def written(path, members, compression=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", compression) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return path


def numpy_file(array):
    stream = io.BytesIO()
    np.save(stream, array)
    return stream.getvalue()


class Bomb:
    def __reduce__(self):
        return os.mkdir, ("executed",)


def origin_in(body):
    """The fields of the origin of a torus."""
    return body["result"]["fields"]["origin"]["fields"]


CHANGES = {
    "newer": (lambda m, b: b.update(schema=10), r"newer symfpu \(schema 10; this one reads 9\); update symfpu"),
    "older": (lambda m, b: b.update(schema=8), r"is of an older format \(schema 8; this symfpu reads 9\); compute it again"),
    "newer without a digest": (lambda m, b: b.update(schema=10, arrays={}), "newer symfpu"),
    "schema 0": (lambda m, b: b.update(schema=0), "schema"),
    "schema as text": (lambda m, b: b.update(schema="9"), "schema"),
    "foreign format": (lambda m, b: b.update(format="another"), "is not a symfpu bundle"),
    "missing array": (lambda m, b: m.pop("part0.corrections.npy"), "not the arrays"),
    "undeclared array": (lambda m, b: b["arrays"].pop("part0.corrections"), "corrections"),
    "extra member": (lambda m, b: m.update(readme=b"x"), "readme"),
    "missing key": (lambda m, b: b["parts"][0].pop("unit"), "unit"),
    "pickled objects": (lambda m, b: m.update({"part0.coordinates.npy": numpy_file(np.array([Bomb()], dtype=object))}), "coordinates"),
    "other dtype": (
        lambda m, b: m.update({"part0.corrections.npy": numpy_file(np.zeros(4, dtype=np.int64))}),
        "is not an array of 4 numbers <f8",
    ),
    "other shape": (
        lambda m, b: m.update({"part0.coordinates.npy": numpy_file(np.zeros(999))}),
        "holds 8120 bytes where",
    ),
    "high order": (lambda m, b: b["parts"][0].update(order=10**4), "more rows than the file holds"),
    "long chain": (lambda m, b: b["parts"][0].update(N=10**6), "coordinates"),
    "huge order": (lambda m, b: b["parts"][0].update(order=10**18), "order = .*from 0 to 10000"),
    "huge chain": (lambda m, b: b["parts"][0].update(N=10**18), "N = .*from 2 to 1000000"),
    "no chain": (lambda m, b: b["parts"][0].update(N=1), "N = 1"),
    "no coupling": (lambda m, b: b["parts"][0].update(alpha="0"), "alpha, beta"),
    "zero denominator": (lambda m, b: b["parts"][0].update(alpha="1/0"), "ZeroDivisionError"),
    "code for a number": (lambda m, b: b["parts"][0].update(alpha="__import__('os').mkdir('executed')"), "is no exact number"),
    "long power": (lambda m, b: b["parts"][0].update(alpha="1e999999999"), "is no exact number"),
    "seed outside": (lambda m, b: b["parts"][0].update(seeds=[1, 8]), "seeds"),
    "seeds out of order": (lambda m, b: b["parts"][0].update(seeds=[2, 1]), "do not go together"),
    "frequency missing": (lambda m, b: b["parts"][0].update(frequencies=["0.4"]), "do not go together"),
    "negative frequency": (lambda m, b: b["parts"][0].update(frequencies=["0.4", "-0.8"]), "do not go together"),
    "no frequencies": (lambda m, b: b["parts"][0].update(frequencies=None), "do not fit"),
    "unknown ring": (lambda m, b: b["parts"][0].update(ring="octonions", frequencies=None), "octonions"),
    "amplitude of no seed": (lambda m, b: origin_in(b)["amplitudes"]["tuple"].append({"float": "0.1"}), "seeds"),
    "amplitude of code": (lambda m, b: origin_in(b)["amplitudes"].update(tuple=[{"mpf": {"exact": "exit()"}}] * 2), "is no binary number"),
    "order of the torus": (lambda m, b: origin_in(b).update(order=4), "no torus of order 4"),
    "frequency order": (lambda m, b: origin_in(b).update(frequency_order=4), "no torus"),
    "another chain": (lambda m, b: b["result"]["fields"]["chain"]["chain"].update(alpha="0.4"), "the series is one of another torus"),
    "verdict as text": (lambda m, b: b.update(verdict="good"), "is damaged"),
}


@pytest.mark.parametrize("case", CHANGES)
def test_forged_files_are_refused(case, healthy, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "forged").write_bytes(healthy[1])
    change, message = CHANGES[case]
    forged(tmp_path / "forged", change)
    with pytest.raises(BundleError, match=message):
        load(tmp_path / "forged")
    assert os.listdir() == ["forged"]


def test_what_a_later_version_adds_to_the_same_schema_is_ignored(healthy, tmp_path):
    def change(members, body):
        body["news"] = body["parts"][0]["news"] = 1
        members["news.npy"], body["arrays"]["news"] = numpy_file(np.zeros(3)), ""

    bundle, data = healthy
    (tmp_path / "later").write_bytes(data)
    assert same(saved_file(forged(tmp_path / "later", change)), bundle)


def test_changes_without_the_digest_are_found(healthy, tmp_path):
    """The archive's own checksums are right, as after a careless edit."""
    for name in ("bundle.json", "part0.coordinates.npy"):
        (tmp_path / "edited").write_bytes(healthy[1])
        members, _ = opened(tmp_path / "edited")
        old, new = (b'"0.3"', b'"0.4"') if name == "bundle.json" else (members[name][-8:], b"12345678")
        members[name] = members[name].replace(old, new)
        with pytest.raises(BundleError, match="does not match its digest"):
            load(written(tmp_path / "edited", members))


def test_a_member_may_occur_once(healthy, tmp_path):
    (tmp_path / "twice").write_bytes(healthy[1])
    with pytest.warns(UserWarning, match="Duplicate"), zipfile.ZipFile(tmp_path / "twice", "a") as archive:
        archive.writestr("part0.coordinates.npy", b"another")
    with pytest.raises(BundleError, match="a member occurs twice"):
        load(tmp_path / "twice")


def forged_integers(name, change):
    """A forgery that changes an array of integers in place."""

    def forge(members, body):
        values = np.load(io.BytesIO(members[name])).copy()
        change(values)
        members[name] = numpy_file(values)

    return forge


@pytest.mark.parametrize(
    ("forge", "message"),
    [
        (forged_integers("part0.program_right.npy", lambda a: a.__setitem__(0, 100)), "comes before its parts"),
        (forged_integers("part0.program_left.npy", lambda a: a.__setitem__(0, -1)), "comes before its parts"),
        (forged_integers("part0.program_start.npy", lambda a: a.__setitem__(-2, 100)), "are in no order"),
        (forged_integers("part0.program_start.npy", lambda a: a.__setitem__(0, 1)), "are in no order"),
        (forged_integers("part0.coordinates.npy", lambda a: a.__setitem__(0, 10**6)), "is no node of the program"),
        (forged_integers("part0.coordinates.npy", lambda a: a.__setitem__(0, -2)), "is no node of the program"),
        (lambda m, b: b["parts"][0]["program"]["symbols"].pop(), "other leaves than symbols"),
        (lambda m, b: b["parts"][0]["program"]["symbols"].__setitem__(0, ["eval", "exit()"]), "no kind of symbol"),
        (lambda m, b: b["parts"][0]["program"].update(terms=2**50), "a program of"),
        (lambda m, b: b["parts"][0]["program"]["integers"].update(program_left="|O"), r"no kind of integers: '\|O'"),
        (lambda m, b: b["parts"][0]["program"]["integers"].update(program_left="<i8"), "bytes where"),
        (lambda m, b: b["parts"][0]["program"]["integers"].pop("program_left"), "KeyError 'program_left'"),
        (lambda m, b: b["parts"][0]["program"].update(integers="<f8"), "no kind of integers"),
        (lambda m, b: b["parts"][0]["program"]["symbols"][0].append("0"), "no harmonic"),
        (lambda m, b: b["parts"][0]["program"]["symbols"][0].append(True), "no harmonic"),
        (lambda m, b: b["parts"][0]["program"]["symbols"][0].__setitem__(1, 0), "symbol = 0"),
    ],
)
def test_forged_programs_are_refused(forge, message, tmp_path):
    path = save(tmp_path / "symbolic", lindstedt(ALPHA, (1, 2), order=2))
    with pytest.raises(BundleError, match=message):
        load(forged(path, forge))


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"N": 16}, "seeds = 'N-1'"),
        ({"N": "M"}, "N = 'M'"),
        ({"seeds": ["N-1", 1]}, "do not go together"),
        ({"seeds": [1, "N-2"]}, "holds .* bytes where"),
        ({"seeds": [1, "N+1"]}, "seeds = 'N\\+1'"),
        ({"ring": "float64", "frequencies": ["0.1", "1.9"]}, "no series of the ring 'float64' is one for all N"),
        ({"order": 10**4}, "more rows than the file holds"),
        ({"order": 10**18}, "order = .*from 0 to 10000"),
    ],
    ids=str,
)
def test_forged_series_for_all_lengths_are_refused(entries, message, tmp_path):
    path = save(tmp_path / "all", lindstedt(Chain("N", alpha=1), (1, "N-1"), order=2))
    with pytest.raises(BundleError, match=message):
        load(forged(path, lambda m, b: b["parts"][0].update(entries)))


def test_compressions_that_inflate_without_a_bound_are_refused(healthy, tmp_path):
    (tmp_path / "bzip2").write_bytes(healthy[1])
    members, _ = opened(tmp_path / "bzip2")
    with pytest.raises(BundleError, match="is compressed by method 12"):
        load(written(tmp_path / "bzip2", members, zipfile.ZIP_BZIP2))


def test_names_of_symbols_are_only_names(tmp_path):
    path = save(tmp_path / "symbolic", lindstedt(ALPHA, (1,), order=1))

    def rename(members, body):
        program = body["parts"][0]["program"]
        program["symbols"] = [["symbol", f"exit({i})"] for i, _ in enumerate(program["symbols"])]

    assert se.Symbol("exit(1)") in load(forged(path, rename)).coordinates[1][-1, 1].free_symbols


def memory_of(action):
    tracemalloc.start()
    try:
        with pytest.raises(BundleError) as refusal:
            action()
        return tracemalloc.get_traced_memory()[1], str(refusal.value)
    finally:
        tracemalloc.stop()


def test_claims_and_bombs_allocate_nothing(healthy, tmp_path):
    """A member of 200 MB in 200 kB; a header for 10^15 numbers; sizes that the directory makes up."""
    path, size = tmp_path / "bomb", struct.pack("<I", len(member_of(healthy[1], "part0.coordinates.npy")))
    header = numpy_file(np.zeros(0)).replace(b"(0,), }" + b" " * 14, b"(1000000000000000,), }"[:21])
    cases = [{"part0.coordinates.npy": numpy_file(np.zeros(25_000_000))}, {"part0.coordinates.npy": header}]
    for members in cases:
        path.write_bytes(healthy[1])
        forged(path, lambda m, b, members=members: m.update(members))
        assert memory_of(lambda: load(path))[0] < 10_000_000
    directory = healthy[1].index(b"PK\x01\x02")
    at = healthy[1].index(size, directory)
    path.write_bytes(healthy[1][:at] + struct.pack("<I", 2**31) + healthy[1][at + 4 :])
    peak, message = memory_of(lambda: load(path))
    assert peak < 10_000_000
    assert "claims 2147483648 bytes" in message


def member_of(data, name):
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return archive.read(name)


def test_a_file_larger_than_the_memory_is_refused(healthy, tmp_path, monkeypatch):
    class Memory:
        available = 10_000

    monkeypatch.setattr("psutil.virtual_memory", Memory)
    result = tmp_path / "large"
    result.write_bytes(healthy[1])
    with pytest.raises(BundleError, match=r"needs [\d,]+ bytes of memory, 10,000 are free; close other programs"):
        load(result)
