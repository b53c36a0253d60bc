"""The small divisors of a torus, and the coefficients under them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Floats
from symfpu.results.numbers import fifteen_digits

SHOWN_DIVISORS = 10


@dataclass(frozen=True)
class NearResonance:
    """A small divisor (nu.omega)^2 - Omega_q^2 of a torus, and the coefficient under it.

    The coefficient is c_q[nu].
    """

    mode: int
    harmonic: tuple[int, ...]
    divisor: float
    coefficient: float

    def entry(self) -> dict[str, Any]:
        """For a record."""
        return {
            "size": fifteen_digits(self.divisor),
            "mode": self.mode,
            "harmonic": list(self.harmonic),
            "coefficient": fifteen_digits(self.coefficient),
        }

    def __repr__(self) -> str:
        harmonic = ",".join(map(str, self.harmonic))
        place = f"mode {self.mode}, harmonic ({harmonic})"
        return f"{self.divisor:.2g} at {place}, coefficient {self.coefficient:.2g}"


def near_resonances(
    equation: InvarianceEquation, cosines: Floats, shifts: Floats
) -> tuple[NearResonance, ...]:
    """The smallest divisors but those of the seeds, smallest first."""
    every = equation.divisors(shifts).astype(float)
    divisors = np.where(equation.mask, every, np.inf)
    divisors[equation.seed_rows, equation.seed_columns] = np.inf
    numbers = np.broadcast_to(equation.projection.modes, divisors.shape)
    order = np.argsort(np.abs(divisors), axis=None)[:SHOWN_DIVISORS]
    nearest = []
    for r, c in zip(*np.unravel_index(order, divisors.shape), strict=True):
        if np.isfinite(divisors[r, c]):
            harmonic = tuple(equation.harmonics[r].tolist())
            divisor, coefficient = float(divisors[r, c]), float(cosines[r, c])
            found = NearResonance(int(numbers[r, c]), harmonic, divisor, coefficient)
            nearest.append(found)
    return tuple(nearest)
