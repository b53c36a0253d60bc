"""What results inherit: their numbers as a table, and as arrays over named axes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from symfpu.frames.grid import Grid
from symfpu.frames.recorded import Recorded
from symfpu.frames.table import Table
from symfpu.numbers.public import public

if TYPE_CHECKING:
    import pandas as pd
    import xarray


@public
class Tabled(Recorded, ABC):
    """A result whose numbers are a table."""

    @abstractmethod
    def _table(self) -> Table:
        """Its columns; of every class its own."""

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


@public
class Gridded(Tabled):
    """A result whose numbers are arrays over named axes."""

    @abstractmethod
    def _grid(self) -> Grid:
        """Its axes and variables; of every class its own."""

    def _table(self) -> Table:
        return self._grid().table()

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
