"""The file of a long run of many cases: a header line, then one line of JSON for each case."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Generic, TypeVar

from symfpu.errors import InputError

Case = TypeVar("Case")


class LinesFile(Generic[Case]):
    """Cases decided so far; with no path nothing is kept.

    header : what the run is of, all of which must agree. made : a case from its line, by
    ValueError, KeyError or TypeError where it is none. what : the cases in words, for errors.
    """

    def __init__(
        self,
        path: Path | str | None,
        header: dict[str, Any],
        made: Callable[[dict[str, Any]], Case],
        what: str,
    ) -> None:
        self.path = None if path is None else Path(path)
        self.header, self.made, self.what = json.dumps(header), made, what

    def read(self) -> list[Case]:
        """What the file holds, a last line that was cut left out; starts it if there is none.

        Raises InputError for a file of another run, a damaged one, and one that cannot be written.
        """
        if self.path is None:
            return []
        try:
            text = self.path.read_text() if self.path.exists() else ""
            start = self.header + "\n"
            if not text.startswith(start) and not start.startswith(text):
                allowed = f"a new file, or {self.what} with the header {self.header}"
                raise self._refused(allowed, "name another file")
            complete = text[: text.rfind("\n") + 1] or start
            cases = [self.made(json.loads(line)) for line in complete.splitlines()[1:]]
            if complete != text:
                self.path.write_text(complete)
        except OSError as error:
            allowed = "a file that can be read and written"
            raise self._refused(allowed, f"name another ({error.strerror})") from error
        except (ValueError, KeyError, TypeError) as error:
            if isinstance(error, InputError):
                raise
            advice = "it is damaged: remove it or name another"
            raise self._refused(f"lines of {self.what}", advice) from error
        return cases

    def _refused(self, allowed: str, advice: str) -> InputError:
        return InputError("file", str(self.path), allowed, advice)

    def append(self, records: Iterable[dict[str, Any]]) -> None:
        """Add decided cases, flushed to the file."""
        if self.path is not None:
            with self.path.open("a") as file:
                file.writelines(json.dumps(record) + "\n" for record in records)
