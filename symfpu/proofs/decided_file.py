"""The file of a long proof: a header line, then one line for each decided flat."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from symfpu.errors import InputError
from symfpu.proofs.certificates import RuleException, Witness
from symfpu.proofs.every_length import DecidedFlat
from symfpu.proofs.flats import Flat
from symfpu.series.series import ResiduePoint

HEADER = {"format": "symfpu decided flats", "schema": 2}


class DecidedFile:
    """Flats decided so far; with no path nothing is kept."""

    def __init__(self, path: Path | str | None, case: Mapping[str, Any]) -> None:
        self.path = None if path is None else Path(path)
        self.header = json.dumps(HEADER | dict(case))

    def read(self) -> dict[Flat, DecidedFlat]:
        """What the file holds, a last line that was cut left out; starts it if there is none."""
        if self.path is None:
            return {}
        try:
            text = self.path.read_text() if self.path.exists() else ""
            start = self.header + "\n"
            if not text.startswith(start) and not start.startswith(text):
                allowed = f"a new file, or one with the header {self.header}"
                raise InputError("file", str(self.path), allowed, "name another file")
            complete = text[: text.rfind("\n") + 1] or start
            found = [_decided(json.loads(line)) for line in complete.splitlines()[1:]]
            if complete != text:
                self.path.write_text(complete)
        except OSError as error:
            allowed = "a file that can be read and written"
            advice = f"name another ({error.strerror})"
            raise InputError("file", str(self.path), allowed, advice) from error
        except (ValueError, KeyError, TypeError) as error:
            if isinstance(error, InputError):
                raise
            advice = "it is damaged: remove it or name another"
            raise InputError("file", str(self.path), "decided flats", advice) from error
        return {each.flat: each for each in found}

    def append(self, batch: Sequence[DecidedFlat]) -> None:
        """Add decided flats."""
        if self.path is not None:
            with self.path.open("a") as file:
                file.writelines(json.dumps(asdict(found)) + "\n" for found in batch)


def _decided(record: dict[str, Any]) -> DecidedFlat:
    flat = record["flat"]
    witnesses = [w | {"monomial": tuple(w["monomial"])} for w in record["witnesses"]]
    points = [p | {"frequencies": tuple(p["frequencies"])} for p in record["points"]]
    return DecidedFlat(
        Flat(flat["N"], tuple(flat["seeds"]), flat["dimension"]),
        tuple(RuleException(**e) for e in record["exceptions"]),
        tuple(record["chained"]),
        tuple(Witness(**w) for w in witnesses),
        tuple(ResiduePoint(**p) for p in points),
        tuple(record["undecided"]),
    )
