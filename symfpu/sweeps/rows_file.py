"""The file of a sweep: a head of one line, then one line for each row, as they come."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import IO, Any

from symfpu import __version__
from symfpu.errors import InputError
from symfpu.files.kept_lines import (
    KeptLines,
    damaged,
    entries_of,
    head_in,
    require_same,
)
from symfpu.files.writing import open_to_read
from symfpu.sweeps.rows import Json, SweepFailure, SweepRow

FORMAT, SCHEMA = "symfpu sweep", 2
RUN = "sweep"


def head_of(function: str, fixed: Mapping[str, Any]) -> Json:
    """What the first line says: which function, of which version, with which shared arguments."""
    known: Json = {"format": FORMAT, "schema": SCHEMA, "symfpu_version": __version__}
    return known | {"function": function, "fixed": dict(fixed)}


def key_of(case: Json) -> str:
    """The same text for the same case."""
    return json.dumps(case, sort_keys=True)


class RowsFile(KeptLines):
    """The rows of one sweep, on disk where a path is given.

    Used as `with RowsFile(path, head) as kept`: `kept.rows` by the key of their case, at first
    those that were there; `kept.append(row)`. InputError for a file of something else.

    retry : whether rows of failures are forgotten.
    """

    run = RUN

    def __init__(self, path: Path | str | None, head: Json, *, retry: bool = False) -> None:
        super().__init__(path, head)
        self.rows: dict[str, SweepRow] = {}
        self._retry = retry

    def _begin(self, path: Path, stream: IO[bytes]) -> None:
        super()._begin(path, stream)
        if self._retry:
            self._forget_failures()

    def take(self, entries: list[Json]) -> None:
        """The rows by the key of their case."""
        self.rows = _rows(entries)

    def append(self, row: SweepRow) -> None:
        """Add a row, whole or not at all; FileFull where it finds no room."""
        self.add([_entry(row)])
        self.rows[key_of(row.case)] = row

    def _forget_failures(self) -> None:
        """Leave only rows with results."""
        good = {key: row for key, row in self.rows.items() if row.failure is None}
        if len(good) < len(self.rows):
            self.replace(map(_entry, good.values()))
            self.rows = good


def read_rows(path: Path) -> tuple[Json, list[SweepRow]]:
    """The head and the rows of a file of any sweep; InputError for another file."""
    try:
        with open_to_read(path) as stream:
            content = stream.read()
    except OSError as error:
        advice = f"name another ({error.strerror})"
        raise InputError("file", str(path), "a file that can be read", advice) from error
    head = head_in(content)
    if not isinstance(head, dict) or head.get("format") != FORMAT:
        raise InputError("file", str(path), "the file of a sweep", "name another")
    function, fixed = head.get("function"), head.get("fixed")
    if not (isinstance(function, str) and isinstance(fixed, dict)):
        raise damaged(path, RUN)
    require_same(path, content, head_of(function, fixed), RUN)
    entries = entries_of(path, content, RUN)
    try:
        return head, list(_rows(entries).values())
    except (ValueError, KeyError, TypeError) as error:
        raise damaged(path, RUN) from error


def _rows(entries: Iterable[Json]) -> dict[str, SweepRow]:
    """The rows by the key of their case; ValueError for a case that is there twice."""
    rows = list(map(_row, entries))
    by_key = {key_of(row.case): row for row in rows}
    if len(by_key) < len(rows):
        raise ValueError("a row for each case, once")
    return by_key


def _entry(row: SweepRow) -> Json:
    """A row as its line holds it: a result or a failure, not both."""
    if row.failure is None:
        return {"case": row.case, "result": row.result}
    return {"case": row.case, "failure": asdict(row.failure)}


def _row(entry: Json) -> SweepRow:
    if "failure" in entry:
        return SweepRow(dict(entry["case"]), None, SweepFailure(**entry["failure"]))
    return SweepRow(dict(entry["case"]), entry["result"])


def in_order(rows: Mapping[str, SweepRow], keys: Iterable[str]) -> tuple[SweepRow, ...]:
    """The rows of these cases, as far as they are there."""
    return tuple(rows[key] for key in keys if key in rows)
