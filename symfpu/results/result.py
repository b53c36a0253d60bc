"""What every result is: fields declared once, from which follow its record, text, HTML and picture.

Those with numbers in rows are a table, too, and those with arrays over named axes a data set.
"""

from __future__ import annotations

import base64
from abc import ABC, abstractmethod
from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.results.field import Field, chain_fields, seeds_field
from symfpu.results.grid import Grid
from symfpu.results.head import headed
from symfpu.results.numbers import json_value
from symfpu.results.pictures import picture_of
from symfpu.results.table import Table

if TYPE_CHECKING:
    import pandas as pd
    import xarray

PAGE = """<div class="symfpu-answer" style="display: flex; flex-wrap: wrap; gap: 1.5em">
<div><div style="margin-bottom: 0.4em"><b>{head}</b></div>
<table>{rows}</table></div>
{picture}</div>"""
ROW = '<tr><td style="text-align: left">{}</td><td style="text-align: left">{}</td></tr>'

# of results whose certificate is their file
BY_CERTIFICATE = "its certificate is kept by .write(path), and symfpu verify opens it"


@public
class Result(ABC):
    """A result: what it says of itself is declared by its class alone.

    not_kept : why `save` takes none of its class, as advice; empty for those that it takes.
    """

    not_kept: ClassVar[str] = ""

    @abstractmethod
    def _fields(self) -> Iterator[Field]:
        """What it says of itself, in order; of every class its own."""

    def _answer(self) -> str:
        """The verdict in a line."""
        return str(getattr(self, "verdict", ""))

    def _lines(self, width: int | None) -> Iterator[str]:
        """Its answer for a reader, in lines. width : columns of the terminal, if it is one."""
        yield repr(self)

    def text(self, width: int | None = None) -> str:
        """Its answer in lines, as the command line prints it.

        width : columns into which tables are folded; default as wide as they are.

        >>> from symfpu import Chain, family
        >>> print(family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005").text())
        Family(N=8, alpha=0.3, seeds=1, 3 members, H = 0.0005 .. 0.001, ...)
          Member(torus, H=0.0005, ...)
          Member(torus, H=...)
          Member(torus, H=0.001, ...)
        """
        return "\n".join(self._lines(width))

    def _require_whole(self) -> None:
        """ValueError where its parts do not fit together: of what a file held."""
        repr(self)

    def record(self) -> dict[str, Any]:
        """Its answer as a dictionary that JSON can hold, with the keys of the command line.

        `kind` is the class. The chain is as typed, what belongs to a seed is by seed. Numbers that
        need more than 15 digits are strings that lose none; measures of size (residuals, errors)
        are numbers of 15 digits. The keys are in docs/records.md.

        >>> import symfpu
        >>> from symfpu import Chain
        >>> chain = Chain(N=4, alpha=1)
        >>> torus = symfpu.torus(chain, (1,), energy="0.001", method="series", order=2)
        >>> found = torus.record()
        >>> found["kind"], found["origin"], found["N"], found["alpha"], float(found["energy"])
        ('Torus', 'FromSeries', 4, '1', 0.001)
        """
        known = {field.key: field.value for field in self._fields() if field.key}
        return headed({"kind": type(self).__name__} | known)

    def plot(self, ax: Any = None) -> Any:
        """The picture that one expects of it: see `symfpu.plots` for this one and for others.

        ax : axes of matplotlib; default new ones of pyplot. Returns the axes. Raises InputError.
        """
        picture = picture_of(type(self))
        if picture is None:
            allowed = "a result with a usual picture"
            raise InputError("result", type(self).__name__, allowed, "see symfpu.plots")
        return picture.draw(self, ax)

    def _repr_html_(self) -> str:
        """Verdict, numbers and a small picture, which notebooks show in place of the text."""
        picture, name = picture_of(type(self)), type(self).__name__
        shown = ""
        if picture is not None and picture.possible(self):
            data = base64.b64encode(picture.small(self)).decode()
            words = f"{picture.name} of this {name}"
            shown = f'<img alt="{words}" src="data:image/png;base64,{data}">'
        labelled = [field for field in self._fields() if field.label]
        rows = [ROW.format(escape(field.label), escape(field.text)) for field in labelled]
        head = escape(": ".join(filter(None, (name, self._answer()))))
        return PAGE.format(head=head, rows="".join(rows), picture=shown)


@public
class Tabled(Result):
    """A result whose numbers are a table."""

    @abstractmethod
    def _table(self) -> Table:
        """Its columns; of every class its own."""

    def _fields(self) -> Iterator[Field]:
        """Without fields of its own: what holds for its whole table, and the columns."""
        chain, seeds = getattr(self, "chain", None), getattr(self, "seeds", None)
        known = [*chain_fields(chain)] if chain is not None else []
        if isinstance(seeds, tuple):
            known.append(seeds_field(seeds))
        if hasattr(self, "verdict"):
            known.append(Field("verdict", self.verdict))
        yield from known
        yield from table_fields(self._table(), {field.key for field in known})

    def _require_whole(self) -> None:
        repr(self)
        columns = {len(values) for values in self._table().columns.values()}
        if len(columns) > 1:
            raise ValueError(f"columns of the lengths {sorted(columns)} in one table")

    def to_frame(self) -> pd.DataFrame:
        """Its numbers as a DataFrame of pandas; the columns are in docs/tables.md.

        Numbers are as in the result: mpf and exact numbers are objects. `attrs` of the table has
        the kind of result, its chain, and the version. All is dimensionless, angles in radians.
        Needs the extra `data`; raises SymfpuError without it.

        >>> from symfpu import Chain, amplitude_history, lindstedt
        >>> series = lindstedt(Chain(N=8, beta="0.3"), (1,), ("0.3905",), 2)
        >>> table = amplitude_history(series).to_frame()
        >>> list(table), table.attrs["units"]
        (['frequency_order', 'seed', 'amplitude', 'difference', 'failure'], 'dimensionless')
        """
        return self._table().frame()


def columns_field(table: Table) -> Field:
    """The columns of a table."""
    columns = table.columns.items()
    return Field("columns", {name: json_value(list(values)) for name, values in columns})


def table_fields(table: Table, known: set[str]) -> Iterator[Field]:
    """What holds for a whole table besides what is known, and its columns (docs/tables.md)."""
    left_out = {"result", "units", "chain", "symfpu_version", *known}
    about = {key: value for key, value in table.attributes.items() if key not in left_out}
    yield Field("about", json_value(about))
    yield columns_field(table)
    for key, value in about.items():
        yield Field("", label=key.replace("_", " "), shown=str(value))


@public
class Gridded(Tabled):
    """A result whose numbers are arrays over named axes."""

    @abstractmethod
    def _grid(self) -> Grid:
        """Its axes and variables; of every class its own."""

    def _table(self) -> Table:
        return self._grid().table()

    def _require_whole(self) -> None:
        repr(self)
        grid = self._grid()
        lengths = {name: len(np.asarray(labels)) for name, labels in grid.axes.items()}
        for name, variable in grid.variables.items():
            due = tuple(lengths[axis] for axis in variable.axes)
            shape = np.shape(variable.values)
            if shape != due:
                raise ValueError(f"{name} is of the shape {shape}, not {due}")

    def to_xarray(self) -> xarray.Dataset:
        """Its numbers as a Dataset of xarray; the variables are in docs/tables.md.

        `to_netcdf` of the data set writes it, `xarray.open_dataset` reads it. Numbers of many
        digits and exact ones are rounded to doubles, and say so in their attribute `precision`;
        complex ones are two variables. Every variable has its units, and the data set the kind of
        result, its chain, and the version. Needs the extra `data`; raises SymfpuError without it.

        >>> from symfpu import Chain, integrate
        >>> orbit = integrate(Chain(N=4, beta=1), [0.1, 0, 0], [0, 0, 0], 10, step=0.125)
        >>> found = orbit.to_xarray()
        >>> found.chain, found.Q.dims, found.Q.units, found.Q.sel(mode=1, time=0).item()
        ('Chain(N=4, beta=1)', ('time', 'mode'), 'dimensionless', 0.1)
        """
        return self._grid().dataset()
