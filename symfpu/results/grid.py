"""A result as arrays over named axes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.results.attributes import DIMENSIONLESS, Attributes
from symfpu.results.packages import package
from symfpu.results.table import Table

if TYPE_CHECKING:
    import xarray

Array = NDArray[Any]

ROUNDED = "rounded to float64"  # what is said of numbers of many digits and of exact ones


class Variable(NamedTuple):
    """An array, the names of its axes, and what it is in words."""

    axes: tuple[str, ...]
    values: ArrayLike
    meaning: str
    units: str = DIMENSIONLESS


@dataclass(frozen=True)
class Grid:
    """Variables over axes, and what holds for all of them.

    axes : by name the labels along it: numbers or text. variables : by name.
    rows : the axes that a table of it has one row for each place of. across : an axis that such a
        table has one column for each place of.
    """

    axes: Mapping[str, ArrayLike]
    variables: Mapping[str, Variable]
    attributes: Attributes
    rows: tuple[str, ...]
    across: str | None = None

    def dataset(self) -> xarray.Dataset:
        """As a Dataset of xarray that netCDF can hold.

        Numbers of many digits and exact ones are rounded to doubles, and say so; complex ones are
        two variables.
        """
        variables = {}
        for name, variable in self.variables.items():
            for part, values in _real_parts(name, np.asarray(variable.values)):
                notes = {"long_name": variable.meaning, "units": variable.units}
                if _is_rounded(values):
                    notes["precision"] = ROUNDED
                    values = values.astype(np.float64)
                variables[part] = (variable.axes, values, notes)
        axes = {name: (name, np.asarray(at)) for name, at in self.axes.items()}
        found: xarray.Dataset = package("xarray").Dataset(variables, axes, self.attributes)
        return found

    def table(self) -> Table:
        """A row for each place of `rows`: their labels, then the variables that go with them."""
        columns = {}
        for name in self.rows:
            columns[name] = self._column(np.asarray(self.axes[name]), (name,))
        for name, variable in self._of_rows():
            for part, values in _real_parts(name, np.asarray(variable.values)):
                columns[part] = self._column(values, variable.axes)
        return Table(columns, self.attributes)

    def _of_rows(self) -> Iterator[tuple[str, Variable]]:
        """The variables over axes of rows alone; of those across one more, each of its places."""
        rows = set(self.rows)
        for name, variable in self.variables.items():
            axes = variable.axes
            if not rows & set(axes):
                continue
            if set(axes) <= rows:
                yield name, variable
            elif self.across == axes[-1] and set(axes[:-1]) <= rows:
                values = np.asarray(variable.values)
                for i, label in enumerate(np.asarray(self.axes[self.across])):
                    yield f"{name}_{label}", Variable(axes[:-1], values[..., i], "")

    def _column(self, values: Array, axes: tuple[str, ...]) -> Array:
        """Values over some of the axes of rows, repeated along the others."""
        shape = [len(np.asarray(self.axes[name])) for name in self.rows]
        places = [axes.index(name) for name in self.rows if name in axes]
        present = zip(self.rows, shape, strict=True)
        lengths = [n if name in axes else 1 for name, n in present]
        ordered = values.transpose(places).reshape(lengths)
        return np.broadcast_to(ordered, shape).reshape(-1)


def _real_parts(name: str, values: Array) -> Iterator[tuple[str, Array]]:
    """An array under its name, a complex one in two parts."""
    if not np.iscomplexobj(values):
        yield name, values
        return
    yield f"{name}_real", values.real
    yield f"{name}_imaginary", values.imag


def _is_rounded(values: Array) -> bool:
    """Whether these are numbers that a double may not hold."""
    return values.dtype == object and not all(isinstance(x, str) for x in values.flat)
