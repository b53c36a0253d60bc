"""The file of a long proof: a header line, then one line for each decided flat."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from symfpu.files.lines_file import LinesFile
from symfpu.proofs.certificates import RuleException, Witness
from symfpu.proofs.every_length import DecidedFlat
from symfpu.proofs.flats import Flat
from symfpu.series.series import ResiduePoint

HEADER = {"format": "symfpu decided flats", "schema": 2}


def decided_file(
    path: Path | str | None, case: Mapping[str, Any]
) -> LinesFile[DecidedFlat]:
    """Of the proof of this case; with no path nothing is kept."""
    return LinesFile(path, HEADER | dict(case), _decided, "decided flats")


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
