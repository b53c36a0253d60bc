"""The file of a long run: a head of one line, then one line of JSON for each entry, as they come.

Every line ends with its checksum. A line that a dead process left unfinished is cut off; one
process at a time writes.
"""

from __future__ import annotations

import json
import os
import re
import zlib
from abc import ABC, abstractmethod
from collections.abc import Iterable
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import IO, Any, ClassVar, Self

from symfpu.errors import InputError, SymfpuError
from symfpu.files.locking import one_run
from symfpu.files.writing import regular_file, write_bytes

Json = dict[str, Any]

NAMED = "name another file, or remove this one"
DAMAGED = "it is damaged: remove it or name another"
CHECKSUM = "crc32"  # the last key of every line: CRC-32 of the line without this key
LINE = re.compile(rb'(\{.*), "crc32": "([0-9a-f]{8})"\}')


class FileFull(SymfpuError):
    """A row that could not be written. Raised by `sweep` and all that keep rows as it does.

    path : of the file; rows : that are in it, whole; reason : of the system. Ours.
    """

    def __init__(self, path: str, rows: int, reason: str) -> None:
        self.path = path
        self.rows = rows
        self.reason = reason
        advice = "make room there; the same call goes on from them"
        super().__init__(
            f"{path} takes no more rows ({reason}); {rows} are in it: {advice}"
        )


class KeptLines(ABC):
    """The entries of one run, on disk where a path is given. Used in a `with`.

    head : what the run is of, as JSON holds it, on which a file must agree. `take` is given what
    was there; `add` adds. InputError for a file of something else.

    run : what it is in words, for errors.
    """

    run: ClassVar[str]

    def __init__(self, path: Path | str | None, head: Json) -> None:
        advice = "choose another"
        self.path = None if path is None else regular_file(Path(path), "file", advice)
        self.head = head
        self._stream: IO[bytes] | None = None
        self._held = ExitStack()  # the lock, and the stream
        self._count = 0

    @abstractmethod
    def take(self, entries: list[Json]) -> None:
        """Entries of the file; ValueError, KeyError or TypeError for what the run never wrote."""

    def __enter__(self) -> Self:
        if self.path is None:
            return self
        with ExitStack() as held:
            held.enter_context(one_run(self.path, run=self.run))
            self._stream = held.enter_context(_opened(self.path))
            self._begin(self.path, self._stream)
            self._held = held.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        if self._stream is not None:
            with suppress(OSError):
                os.fsync(self._stream.fileno())
            self._stream.close()
        self._held.close()

    def _begin(self, path: Path, stream: IO[bytes]) -> None:
        """Read what is there, cut an unfinished line off, and write the head of a new file."""
        stream.seek(0)
        content = stream.read()
        first = line_of(self.head)
        if not first.startswith(content):
            self._take_from(path, content)
        whole = content.rfind(b"\n") + 1
        if whole < len(content):
            stream.truncate(whole)
        if not whole:
            self._write(first)

    def _take_from(self, path: Path, content: bytes) -> None:
        require_same(path, content, self.head, self.run)
        entries = entries_of(path, content, self.run)
        try:
            self.take(entries)
        except (ValueError, KeyError, TypeError) as error:
            raise damaged(path, self.run) from error
        self._count = len(entries)

    def add(self, entries: Iterable[Json]) -> None:
        """Add entries, all or none of them; FileFull where they find no room."""
        lines = list(map(line_of, entries))
        if self._stream is not None:
            self._write(b"".join(lines))
        self._count += len(lines)

    def replace(self, entries: Iterable[Json]) -> None:
        """Keep these alone: another file in its place, whole or not at all."""
        if self.path is None:
            return
        lines = list(map(line_of, entries))
        write_bytes(self.path, b"".join([line_of(self.head), *lines]))
        before, self._stream = self._stream, _opened(self.path)
        if before is not None:
            before.close()
        self._count = len(lines)

    def _write(self, lines: bytes) -> None:
        stream = self._stream
        assert stream is not None
        before = os.fstat(stream.fileno()).st_size
        try:
            written = 0
            while written < len(lines):
                written += stream.write(lines[written:])
        except OSError as error:
            with suppress(OSError):
                stream.truncate(before)
            reason = error.strerror or type(error).__name__
            raise FileFull(str(self.path), self._count, reason) from error


def line_of(entry: Json) -> bytes:
    """An entry, which has a key at least, as a line with its checksum."""
    alone = json.dumps(entry)
    checksum = zlib.crc32(alone.encode())
    return f'{alone[:-1]}, "{CHECKSUM}": "{checksum:08x}"}}\n'.encode()


def entry_of(line: bytes) -> Json:
    """The entry of a line; ValueError where the checksum is not that of the rest."""
    found = LINE.fullmatch(line)
    if found is None or zlib.crc32(found[1] + b"}") != int(found[2], 16):
        raise ValueError("a line that differs from its checksum")
    entry: Json = json.loads(found[1] + b"}")
    return entry


def _opened(path: Path) -> IO[bytes]:
    """A file to read and to add to; InputError where there is none."""
    try:
        return path.open("a+b", buffering=0)
    except OSError as error:
        allowed = "a file that can be read and written"
        advice = f"name another ({error.strerror})"
        raise InputError("file", str(path), allowed, advice) from error


def head_in(content: bytes) -> Any:
    """What the first line holds, unchecked and without its checksum; None where it is no JSON."""
    try:
        found = json.loads(content.partition(b"\n")[0])
    except ValueError:
        return None
    if isinstance(found, dict):
        found.pop(CHECKSUM, None)
    return found


def entries_of(path: Path, content: bytes, run: str) -> list[Json]:
    """The whole lines after the head; InputError with the number of one that was changed."""
    entries = []
    for number, line in enumerate(content.split(b"\n")[1:-1], start=2):
        try:
            entries.append(entry_of(line))
        except ValueError as error:
            said = f"line {number} was changed, it differs from its checksum"
            advice = f"{said}: remove this line, and the same call makes it again"
            raise InputError("file", str(path), f"rows of a {run}", advice) from error
    return entries


def damaged(path: Path, run: str) -> InputError:
    """The refusal of lines that a run never wrote."""
    return InputError("file", str(path), f"rows of a {run}", DAMAGED)


def require_same(path: Path, content: bytes, head: Json, run: str) -> None:
    """InputError, with what differs, where a file has another head."""
    found = head_in(content)
    if found == head:
        require_checked_head(path, content, run)
        return
    allowed = f"a new file, or that of this {run}"
    if not isinstance(found, dict) or "format" not in found:
        raise InputError("file", str(path), allowed, NAMED)
    if found["format"] != head["format"]:
        said = f"its format is {found['format']!r} and not {head['format']!r}"
        raise InputError("file", str(path), allowed, f"{said}: {NAMED}")
    differ = [name for name in head if found.get(name) != head[name]]
    others = [f"{name} {found.get(name)!r} and not {head[name]!r}" for name in differ]
    raise InputError("file", str(path), allowed, f"it has {', '.join(others)}: {NAMED}")


def require_checked_head(path: Path, content: bytes, run: str) -> None:
    """InputError where the first line differs from its checksum."""
    try:
        entry_of(content.partition(b"\n")[0])
    except ValueError as error:
        advice = f"line 1 was changed, it differs from its checksum: {NAMED}"
        raise InputError("file", str(path), f"the file of a {run}", advice) from error
