"""What a sweep gives: one row for each case, with its result or with what went wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.results.attributes import attributes, plain
from symfpu.results.grid import Grid, Variable
from symfpu.results.result import Gridded

Json = dict[str, Any]

LARGEST_WHOLE = 2**63
LONGEST_LIST = 20  # in a cell of a table


@dataclass(frozen=True)
class SweepFailure:
    """Why a case has no result.

    kind : the class of the error. message : its text. numbers : what it carries, by name, as JSON
    holds it.
    """

    kind: str
    message: str
    numbers: Json = field(default_factory=dict)

    def __str__(self) -> str:
        return f"{self.kind}: {self.message}"


@dataclass(frozen=True)
class SweepRow:
    """One case of a sweep, all as JSON holds it.

    case : its arguments by name. result : its record, number, list or mapping; None where it
    failed. failure : None where it did not.
    """

    case: Json
    result: Any = None
    failure: SweepFailure | None = None


@dataclass(frozen=True)
class SweepRows(Gridded):
    """The rows of a sweep. Made by `sweep` and `read_sweep`.

    function : its name, with its module. fixed : the arguments that all cases share, as JSON holds
    them. rows : in the order of the cases; each has case, and result or failure. Dimensionless.
    Ours.

    >>> failure = SweepFailure("InputError", "N = 1")
    >>> rows = SweepRow({"N": 4}, 0.25), SweepRow({"N": 1}, None, failure)
    >>> swept = SweepRows("a.function", {}, rows)
    >>> swept
    SweepRows(a.function: 2 cases, 1 failed: 1 InputError)
    >>> swept.to_frame()
       case  N  result     failure failure_message
    0     0  4    0.25
    1     1  1     NaN  InputError           N = 1
    """

    function: str
    fixed: Json
    rows: tuple[SweepRow, ...] = field(repr=False)

    def __repr__(self) -> str:
        count = f"{len(self.rows)} case" + "s" * (len(self.rows) != 1)
        kinds = Counter(row.failure.kind for row in self.failures if row.failure)
        failed = ""
        if kinds:
            named = ", ".join(f"{n} {kind}" for kind, n in kinds.most_common())
            failed = f", {len(self.failures)} failed: {named}"
        return f"SweepRows({self.function}: {count}{failed})"

    @property
    def failures(self) -> tuple[SweepRow, ...]:
        """The rows of the cases that failed."""
        return tuple(row for row in self.rows if row.failure is not None)

    def _grid(self) -> Grid:
        """Rows along the axis `case`, and a column for each number of an argument or a result."""
        cells = [dict(_row_cells(row)) for row in self.rows]
        names = dict.fromkeys(name for row in cells for name in row)
        variables = {}
        for name in names:
            values = _column([row.get(name) for row in cells])
            variables[name] = Variable(("case",), values, name)
        fixed = {name: plain(value) for name, value in self.fixed.items()}
        known = fixed | attributes(self, function=self.function)
        return Grid({"case": np.arange(len(cells))}, variables, known, ("case",))


def _row_cells(row: SweepRow) -> Iterator[tuple[str, Any]]:
    """Arguments under their names, numbers of a result under theirs, the failure last."""
    taken = set()
    for name, value in _cells("", row.case):
        taken.add(name)
        yield name, value
    for name, value in _cells(
        "" if isinstance(row.result, Mapping) else "result", row.result
    ):
        yield (f"result_{name}" if name in taken else name), value
    if row.failure is not None:
        yield "failure", row.failure.kind
        yield "failure_message", row.failure.message


def _cells(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """A value as cells: those of a mapping under its name and theirs, a short list as one text.

    Longer lists, and lists of lists, are in the rows alone.
    """
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _cells(f"{name}_{key}" if name else str(key), item)
    elif isinstance(value, list):
        if len(value) <= LONGEST_LIST and not any(
            isinstance(x, list | dict) for x in value
        ):
            yield name, ",".join(map(str, value))
    elif value is not None:
        yield name, value


def _column(values: list[Any]) -> NDArray[Any]:
    """Numbers as numbers, text that is one too, rounded to doubles; all else as text."""
    found = [_number(value) for value in values]
    if any(
        number is None
        for number, value in zip(found, values, strict=True)
        if value is not None
    ):
        return np.array(["" if value is None else str(value) for value in values])
    if all(isinstance(number, int) for number in found):
        return np.array(found, np.int64)
    return np.array([np.nan if number is None else float(number) for number in found])


def _number(value: Any) -> int | float | None:
    """The number that a cell is; None where it is none."""
    if (
        isinstance(value, int)
        and not isinstance(value, bool)
        and abs(value) < LARGEST_WHOLE
    ):
        return value
    if isinstance(value, float):
        return value
    if not isinstance(value, str):
        return None
    try:
        return float(Fraction(value)) if "/" in value else float(value)
    except (ValueError, OverflowError, ZeroDivisionError):
        return None
