"""A ZIP archive of one JSON document and of flat .npy arrays, with digests.

It is written whole or not at all, and read without trust.
"""

from __future__ import annotations

import hashlib
import json
import os
import struct
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import psutil
from numpy.typing import NDArray

from symfpu.errors import SymfpuError
from symfpu.files.formats import BUNDLE
from symfpu.files.writing import write_file
from symfpu.numbers.typed import integer

Array = NDArray[Any]
Json = dict[str, Any]

SCHEMA = 9  # of all that is written, and the one that is read
DOCUMENT = "bundle.json"
COMPRESSION = 1  # mantissas are noise; the zeros between them are gone at the first level
CHUNK = 1 << 22
DEFLATE_RATIO = 1032  # no deflated byte stands for more
DOCUMENT_GROWTH = 20  # bytes of memory for a byte of JSON, about
SAVED_ADVICE = "give a file that symfpu.save wrote"
MEMORY_ADVICE = "close other programs"


class BundleError(SymfpuError):
    """A file that cannot be loaded: damaged, foreign, newer or too large.

    Raised by `load` and where checkpoints are read. Ours.

    path : of the file; problem : what is wrong; advice : what to do.
    """

    def __init__(self, path: Path, problem: str, advice: str) -> None:
        self.path = path
        self.problem = problem
        self.advice = advice
        super().__init__(f"{path} {problem}; {advice}")


# what zipfile, zlib, json, numpy and our own checks say to a damaged or hostile file
DAMAGE = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    EOFError,
    LookupError,
    OSError,
    RuntimeError,
    StopIteration,
    SymfpuError,
    TypeError,
    ValueError,
    struct.error,
    zipfile.BadZipFile,
    zlib.error,
)


def digest_of(body: Json) -> str:
    text = json.dumps(body, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def _header(dtype: str, count: int) -> bytes:
    """What an .npy file of version 1.0 begins with; a multiple of 64 bytes."""
    header = f"{{'descr': '{dtype}', 'fortran_order': False, 'shape': ({count},), }}"
    spaces = -(len(header) + 11) % 64
    padded = header + " " * spaces + "\n"
    length = struct.pack("<H", len(padded))
    return b"\x93NUMPY\x01\x00" + length + padded.encode("ascii")


def member_digest(values: Array) -> str:
    digest = hashlib.sha256(_header(values.dtype.str, values.size))
    digest.update(values.data)
    return digest.hexdigest()


def write_archive(path: Path, body: Json, members: Mapping[str, Array]) -> None:
    """The file whole; InputError where it cannot be written, and it stays as it was."""
    write_file(path, lambda stream: _write_members(stream, body, members), "path")


def write_document(path: Path, body: Json, members: Mapping[str, Array]) -> None:
    """An archive of a document, with the digests of its arrays and of itself."""
    digests = {name: member_digest(values) for name, values in members.items()}
    whole = body | {"arrays": digests}
    write_archive(path, whole | {"digest": digest_of(whole)}, members)


def _write_members(stream: BinaryIO, body: Json, members: Mapping[str, Array]) -> None:
    method = zipfile.ZIP_DEFLATED
    with zipfile.ZipFile(stream, "w", method, compresslevel=COMPRESSION) as archive:
        document = zipfile.ZipInfo(DOCUMENT)
        archive.writestr(document, json.dumps(body), method, COMPRESSION)
        for name, values in members.items():
            large = values.nbytes >= 1 << 30
            with archive.open(f"{name}.npy", "w", force_zip64=large) as member:
                member.write(_header(values.dtype.str, values.size))
                for start in range(0, values.size, CHUNK):
                    member.write(values[start : start + CHUNK].data)


class Archive:
    """The document and the arrays of a file, checked.

    The document against its digest, the arrays before they are allocated.
    """

    def __init__(self, path: Path, stream: BinaryIO) -> None:
        self.path = path
        self._zip = zipfile.ZipFile(stream)
        entries = self._zip.infolist()
        members = {info.filename: info for info in entries}
        if DOCUMENT not in members:
            raise BundleError(
                path, f"is not a symfpu bundle (no {DOCUMENT} in it)", SAVED_ADVICE
            )
        if len(members) < len(entries):
            raise ValueError("a member occurs twice")
        size = os.fstat(stream.fileno()).st_size
        free = psutil.virtual_memory().available
        for info in entries:
            _refuse_claims(info, size)
        document = DOCUMENT_GROWTH * members[DOCUMENT].file_size
        needed = sum(info.file_size for info in entries) + document
        if needed > free:
            problem = f"needs {needed:,} bytes of memory, {free:,} are free"
            raise BundleError(path, problem, MEMORY_ADVICE)
        self.body = self._document(path)
        self.digests: dict[str, str] = self.body["arrays"]
        named = {f"{name}.npy" for name in self.digests}
        if set(members) != {DOCUMENT, *named}:
            raise ValueError(
                f"it holds {sorted(members)}, not the arrays {sorted(self.digests)}"
            )

    def _document(self, path: Path) -> Json:
        info = self._zip.getinfo(DOCUMENT)
        with self._zip.open(info) as member:
            body = json.loads(member.read(info.file_size))
        if not isinstance(body, dict) or body.get("format") != BUNDLE:
            problem = f"is not a symfpu bundle (its format is not {BUNDLE!r})"
            raise BundleError(path, problem, SAVED_ADVICE)
        schema = integer(body["schema"], "schema", 1)
        if schema > SCHEMA:
            newer = (
                f"was written by a newer symfpu (schema {schema}; this one reads {SCHEMA})"
            )
            raise BundleError(path, newer, "update symfpu")
        if schema < SCHEMA:
            older = f"is of an older format (schema {schema}; this symfpu reads {SCHEMA})"
            raise BundleError(path, older, "compute it again, and write another file")
        if body.pop("digest") != digest_of(body):
            raise ValueError(f"{DOCUMENT} does not match its digest")
        return body

    def entries(self, name: str) -> int:
        """How many numbers the file claims for an array, at most."""
        return self._zip.getinfo(f"{name}.npy").file_size // 8

    def array(self, name: str, dtype: str, count: int) -> Array:
        """An array of so many numbers of a type.

        ValueError where the file holds another, or its digest differs.
        """
        info = self._zip.getinfo(f"{name}.npy")
        header = _header(dtype, count)
        nbytes = np.dtype(dtype).itemsize * count
        due = len(header) + nbytes
        if info.file_size != due:
            raise ValueError(
                f"{info.filename} holds {info.file_size} bytes where {due} are due"
            )
        values: Array = np.empty(count, dtype)
        flat = values.view(np.uint8)
        with self._zip.open(info) as member:
            if member.read(len(header)) != header:
                raise ValueError(
                    f"{info.filename} is not an array of {count} numbers {dtype}"
                )
            for start in range(0, nbytes, CHUNK):
                part = member.read(min(CHUNK, nbytes - start))
                flat[start : start + CHUNK] = np.frombuffer(part, np.uint8)
        if member_digest(values) != self.digests[name]:
            raise ValueError(f"{info.filename} does not match its digest")
        return values


def _refuse_claims(info: zipfile.ZipInfo, size: int) -> None:
    """ValueError for a member that a file of this size cannot hold, or of an unknown method."""
    # others inflate without a bound
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ValueError(f"{info.filename} is compressed by method {info.compress_type}")
    if info.compress_size > size or info.file_size > DEFLATE_RATIO * info.compress_size:
        raise ValueError(f"{info.filename} claims {info.file_size} bytes")
