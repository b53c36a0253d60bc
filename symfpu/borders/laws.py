"""Power laws of borders in the length of the chain."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from symfpu.errors import InputError

LEAST_LENGTHS = 3  # that a slope and its error need


@dataclass(frozen=True)
class BorderLaw:
    """H of a border = factor * N^exponent, by least squares of the logarithms; dimensionless.

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
