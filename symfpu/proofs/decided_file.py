"""The file of a long proof: a head of one line, then one line for each decided flat."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from symfpu.files.kept_lines import KeptLines
from symfpu.proofs.certificates import RuleException, Witness
from symfpu.proofs.every_length import DecidedFlat
from symfpu.proofs.flats import Flat
from symfpu.series.coefficients import ResiduePoint

FORMAT, SCHEMA = "symfpu decided flats", 3

Json = dict[str, Any]


class DecidedFile(KeptLines):
    """The decided flats of one theorem, on disk where a path is given.

    Used as `with DecidedFile(path, model, s, order) as kept`: `kept.decided` by their flats, at
    first those that were there; `kept.append(batch)`. InputError for a file of something else.
    """

    run = "proof"

    def __init__(self, path: Path | str | None, model: str, s: int, order: int) -> None:
        known: Json = {"format": FORMAT, "schema": SCHEMA}
        super().__init__(path, known | {"model": model, "seeds_number": s, "order": order})
        self.decided: dict[Flat, DecidedFlat] = {}

    def take(self, entries: list[Json]) -> None:
        """The decided flats by their flats."""
        self._know(list(map(_decided, entries)))

    def append(self, batch: Sequence[DecidedFlat]) -> None:
        """Add a batch, whole or not at all; FileFull where it finds no room."""
        self.add(map(asdict, batch))
        self._know(batch)

    def _know(self, batch: Sequence[DecidedFlat]) -> None:
        self.decided |= {found.flat: found for found in batch}


def _decided(record: Json) -> DecidedFlat:
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
