"""A result as columns: each row one number of it, or one thing that has several."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from symfpu.results.attributes import Attributes
from symfpu.results.packages import package

if TYPE_CHECKING:
    import pandas as pd

Column = NDArray[Any] | Sequence[Any]
Columns = Mapping[str, Column]


@dataclass(frozen=True)
class Table:
    """Columns of one length by name, and what holds for all of their rows.

    Numbers stay what they are in the result: doubles, mpf, fractions, expressions.
    """

    columns: Columns
    attributes: Attributes

    def frame(self) -> pd.DataFrame:
        """As a DataFrame of pandas; whole numbers with holes are of its type Int64."""
        library = package("pandas")
        columns = {}
        for name, values in self.columns.items():
            columns[name] = values
            if _has_holes(values):
                columns[name] = library.array(list(values), dtype="Int64")
        frame: pd.DataFrame = library.DataFrame(columns)
        frame.attrs.update(self.attributes)
        return frame


def _has_holes(values: Column) -> bool:
    """Whether it is of whole numbers, and of None where there is none."""
    if isinstance(values, np.ndarray):
        return False
    present = [value for value in values if value is not None]
    return len(present) < len(values) and all(isinstance(x, int) for x in present)


def by_seed(name: str, seeds: Sequence[Any], values: NDArray[Any]) -> dict[str, Column]:
    """One column for each seed of an array (rows, s), such as harmonic_1, harmonic_4."""
    return {f"{name}_{q}": values[:, i] for i, q in enumerate(seeds)}


def joined(numbers: Sequence[Any]) -> str:
    """Numbers in one cell.

    >>> joined((1, -2))
    '1,-2'
    """
    return ",".join(map(str, numbers))
