"""The file of a sweep: a head of one line, then one line for each row, as they come.

A line that a dead process left unfinished is cut off; one process at a time writes.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import IO, Any

from symfpu import __version__
from symfpu.errors import InputError, SymfpuError
from symfpu.files.writing import output_file, write_bytes
from symfpu.sweeps.rows import Json, SweepFailure, SweepRow

try:
    import fcntl
except ImportError:  # no locks of this kind: the user sees to it that one process writes
    fcntl = None  # type: ignore[assignment]

FORMAT, SCHEMA = "symfpu sweep", 1
NAMED = "name another file, or remove this one"


class FileFull(SymfpuError):
    """A row that could not be written. Raised by `sweep`.

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


def head_of(function: str, fixed: Mapping[str, Any]) -> Json:
    """What the first line says: which function, of which version, with which shared arguments."""
    known: Json = {"format": FORMAT, "schema": SCHEMA, "symfpu_version": __version__}
    return known | {"function": function, "fixed": dict(fixed)}


def key_of(case: Json) -> str:
    """The same text for the same case."""
    return json.dumps(case, sort_keys=True)


class RowsFile:
    """The rows of one sweep, on disk where a path is given.

    Used as `with RowsFile(path, head) as kept`: `kept.rows` by the key of their case, at first
    those that were there; `kept.append(row)`. InputError for a file of something else.

    retry : whether rows of failures are forgotten.
    """

    def __init__(self, path: Path | str | None, head: Json, *, retry: bool = False) -> None:
        advice = "choose another"
        self.path = None if path is None else output_file(Path(path), "file", advice)
        self.head = head
        self.rows: dict[str, SweepRow] = {}
        self._retry = retry
        self._stream: IO[bytes] | None = None

    def __enter__(self) -> RowsFile:
        if self.path is None:
            return self
        self._stream = _opened(self.path)
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
            self.rows = _rows(path, content, self.head)
        whole = content.rfind(b"\n") + 1
        if whole < len(content):
            stream.truncate(whole)
        if not whole:
            self._write(first)
        if self._retry:
            self._forget_failures(path)

    def _forget_failures(self, path: Path) -> None:
        """Leave only rows with results: another file in its place, whole or not at all."""
        good = {key: row for key, row in self.rows.items() if row.failure is None}
        if len(good) == len(self.rows):
            return
        self.rows = good
        lines = [_line(self.head), *(_line(_entry(row)) for row in good.values())]
        write_bytes(path, b"".join(lines))
        before, self._stream = self._stream, _opened(path)
        if before is not None:
            before.close()

    def append(self, row: SweepRow) -> None:
        """Add a row, whole or not at all; FileFull where it finds no room."""
        if self._stream is not None:
            self._write(_line(_entry(row)))
        self.rows[key_of(row.case)] = row

    def _write(self, line: bytes) -> None:
        stream = self._stream
        assert stream is not None
        before = os.fstat(stream.fileno()).st_size
        try:
            written = 0
            while written < len(line):
                written += stream.write(line[written:])
        except OSError as error:
            with suppress(OSError):
                stream.truncate(before)
            reason = error.strerror or type(error).__name__
            raise FileFull(str(self.path), len(self.rows), reason) from error


def _opened(path: Path) -> IO[bytes]:
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
        advice = "wait for the other sweep, or name another file"
        raise InputError("file", str(path), allowed, advice) from error
    return stream


def read_rows(path: Path) -> tuple[Json, list[SweepRow]]:
    """The head and the rows of a file of any sweep; InputError for another file."""
    try:
        content = path.read_bytes()
    except OSError as error:
        advice = f"name another ({error.strerror})"
        raise InputError("file", str(path), "a file that can be read", advice) from error
    first = content.partition(b"\n")[0]
    try:
        head = json.loads(first)
    except ValueError:
        head = None
    if not isinstance(head, dict) or head.get("format") != FORMAT:
        raise InputError("file", str(path), "the file of a sweep", "name another")
    return head, list(
        _rows(path, content, head_of(head["function"], head["fixed"])).values()
    )


def _line(entry: Json) -> bytes:
    return json.dumps(entry).encode() + b"\n"


def _entry(row: SweepRow) -> Json:
    """A row as its line holds it: a result or a failure, not both."""
    if row.failure is None:
        return {"case": row.case, "result": row.result}
    return {"case": row.case, "failure": asdict(row.failure)}


def _rows(path: Path, content: bytes, head: Json) -> dict[str, SweepRow]:
    """The rows of the whole lines after the head, which must be this one."""
    first, *lines = content.split(b"\n")[:-1] or [content]
    _require_same(path, first, head)
    try:
        rows = [_row(json.loads(line)) for line in lines]
    except (ValueError, KeyError, TypeError) as error:
        advice = "it is damaged: remove it or name another"
        raise InputError("file", str(path), "rows of a sweep", advice) from error
    by_key = {key_of(row.case): row for row in rows}
    if len(by_key) < len(rows):
        advice = "it is damaged: remove it or name another"
        raise InputError("file", str(path), "a row for each case, once", advice)
    return by_key


def _row(entry: Json) -> SweepRow:
    if "failure" in entry:
        return SweepRow(dict(entry["case"]), None, SweepFailure(**entry["failure"]))
    return SweepRow(dict(entry["case"]), entry["result"])


def _require_same(path: Path, first: bytes, head: Json) -> None:
    try:
        found = json.loads(first)
    except ValueError:
        found = None
    if found == head:
        return
    allowed = "a new file, or that of this sweep"
    if not isinstance(found, dict) or "format" not in found:
        raise InputError("file", str(path), allowed, NAMED)
    if found["format"] != FORMAT:
        said = f"its format is {found['format']!r} and not {FORMAT!r}"
        raise InputError("file", str(path), allowed, f"{said}: {NAMED}")
    differ = [name for name in head if found.get(name) != head[name]]
    others = [f"{name} {found.get(name)!r} and not {head[name]!r}" for name in differ]
    raise InputError("file", str(path), allowed, f"it has {', '.join(others)}: {NAMED}")


def in_order(rows: Mapping[str, SweepRow], keys: Iterable[str]) -> tuple[SweepRow, ...]:
    """The rows of these cases, as far as they are there."""
    return tuple(rows[key] for key in keys if key in rows)
