"""Power laws of borders in the length of the chain."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from symfpu.errors import InputError
from symfpu.results.field import Field, fields_of
from symfpu.results.numbers import fifteen_digits, number_text
from symfpu.results.result import Result

LEAST_LENGTHS = 3  # that a slope and its error need


@dataclass(frozen=True)
class BorderLaw(Result):
    """H of a border = factor * N^exponent, by least squares of logarithms; ours, dimensionless.

    error : of the exponent, one standard deviation from the scatter about the line. local :
        exponents between neighbouring lengths, which show whether there is a law at all. lengths,
        energies : what was fitted. The energy per particle goes with one power less.

    >>> power_law((8, 16, 32), (1.0, 0.5, 0.24))
    BorderLaw(H = 8.56 N^(-1.03 +- 0.017), N = 8 .. 32, local exponents -1.06 .. -1)
    """

    factor: float
    exponent: float
    error: float
    lengths: tuple[int, ...]
    energies: tuple[float, ...]

    @property
    def local(self) -> tuple[float, ...]:
        """Exponents between neighbouring lengths."""
        changes = np.diff(np.log(self.energies)) / np.diff(np.log(self.lengths))
        return tuple(float(x) for x in changes)

    def entry(self) -> dict[str, Any]:
        """The exponent with its error and what was fitted, for a record."""
        return {
            "factor": fifteen_digits(self.factor),
            "exponent": fifteen_digits(self.exponent),
            "error": fifteen_digits(self.error),
            "local": [fifteen_digits(x) for x in self.local],
            "lengths": list(self.lengths),
            "energies": [number_text(H, None) for H in self.energies],
        }

    def _fields(self) -> Iterator[Field]:
        yield from fields_of(self.entry())

    def __repr__(self) -> str:
        law = f"H = {self.factor:.3g} N^({self.exponent:.3g} +- {self.error:.2g})"
        lengths = f"N = {self.lengths[0]} .. {self.lengths[-1]}"
        local = f"local exponents {min(self.local):.3g} .. {max(self.local):.3g}"
        return f"BorderLaw({law}, {lengths}, {local})"


def power_law(lengths: Sequence[int], energies: Sequence[float]) -> BorderLaw:
    """The line through ln H over ln N nearest to these borders.

    Raises InputError for fewer than three lengths.
    """
    if len(lengths) < LEAST_LENGTHS:
        allowed = f"{LEAST_LENGTHS} lengths or more"
        raise InputError("lengths", tuple(lengths), allowed, "add borders at other N")
    x, y = np.log(lengths), np.log(energies)
    slope, intercept = np.polyfit(x, y, 1)
    left = y - (slope * x + intercept)
    scatter = float(left @ left) / (len(x) - 2)
    spread = float(((x - x.mean()) ** 2).sum())
    return BorderLaw(
        factor=math.exp(intercept),
        exponent=round(float(slope), 12),
        error=math.sqrt(scatter / spread),
        lengths=tuple(int(N) for N in lengths),
        energies=tuple(float(H) for H in energies),
    )
