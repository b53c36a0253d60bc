"""The file of a long run: a head of one line, then one line of JSON for each entry, as they come.

A line that a dead process left unfinished is cut off; one process at a time writes.
"""

from __future__ import annotations

import json
import os
from abc import ABC, abstractmethod
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, ClassVar, Self

from symfpu.errors import InputError, SymfpuError
from symfpu.files.writing import output_file, write_bytes

try:
    import fcntl
except ImportError:  # no locks of this kind: the user sees to it that one process writes
    fcntl = None  # type: ignore[assignment]

Json = dict[str, Any]

NAMED = "name another file, or remove this one"
DAMAGED = "it is damaged: remove it or name another"


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
        self.path = None if path is None else output_file(Path(path), "file", advice)
        self.head = head
        self._stream: IO[bytes] | None = None
        self._count = 0

    @abstractmethod
    def take(self, entries: list[Json]) -> None:
        """Entries of the file; ValueError, KeyError or TypeError for what the run never wrote."""

    def __enter__(self) -> Self:
        if self.path is None:
            return self
        self._stream = _opened(self.path, self.run)
        try:
            self._begin(self.path, self._stream)
        except BaseException:
            self._stream.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if self._stream is not None:
            with suppress(OSError):
                os.fsync(self._stream.fileno())
            self._stream.close()

    def _begin(self, path: Path, stream: IO[bytes]) -> None:
        """Read what is there, cut an unfinished line off, and write the head of a new file."""
        stream.seek(0)
        content = stream.read()
        first = _line(self.head)
        if not first.startswith(content):
            self._take_from(path, content)
        whole = content.rfind(b"\n") + 1
        if whole < len(content):
            stream.truncate(whole)
        if not whole:
            self._write(first)

    def _take_from(self, path: Path, content: bytes) -> None:
        require_same(path, content, self.head, self.run)
        try:
            entries = entries_of(content)
            self.take(entries)
        except (ValueError, KeyError, TypeError) as error:
            raise damaged(path, self.run) from error
        self._count = len(entries)

    def add(self, entries: Iterable[Json]) -> None:
        """Add entries, all or none of them; FileFull where they find no room."""
        lines = list(map(_line, entries))
        if self._stream is not None:
            self._write(b"".join(lines))
        self._count += len(lines)

    def replace(self, entries: Iterable[Json]) -> None:
        """Keep these alone: another file in its place, whole or not at all."""
        if self.path is None:
            return
        lines = list(map(_line, entries))
        write_bytes(self.path, b"".join([_line(self.head), *lines]))
        before, self._stream = self._stream, _opened(self.path, self.run)
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


def _line(entry: Json) -> bytes:
    return json.dumps(entry).encode() + b"\n"


def _opened(path: Path, run: str) -> IO[bytes]:
    """A file to read and to add to, locked; InputError where there is none."""
    try:
        stream = path.open("a+b", buffering=0)
    except OSError as error:
        allowed = "a file that can be read and written"
        advice = f"name another ({error.strerror})"
        raise InputError("file", str(path), allowed, advice) from error
    try:
        if fcntl is not None:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        stream.close()
        allowed = "a file that no other process writes"
        advice = f"wait for the other {run}, or name another file"
        raise InputError("file", str(path), allowed, advice) from error
    return stream


def head_in(content: bytes) -> Any:
    """What the first line holds; None where it is no JSON."""
    try:
        return json.loads(content.partition(b"\n")[0])
    except ValueError:
        return None


def entries_of(content: bytes) -> list[Json]:
    """The whole lines after the head; ValueError where one is no JSON."""
    return [json.loads(line) for line in content.split(b"\n")[1:-1]]


def damaged(path: Path, run: str) -> InputError:
    """The refusal of lines that a run never wrote."""
    return InputError("file", str(path), f"rows of a {run}", DAMAGED)


def require_same(path: Path, content: bytes, head: Json, run: str) -> None:
    """InputError, with what differs, where a file has another head."""
    found = head_in(content)
    if found == head:
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
