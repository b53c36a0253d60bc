"""The small divisors of a torus; of travelling waves also integer relations and Umklapp."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import lcm
from typing import Any

import numpy as np

from symfpu.errors import InputError
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Floats, low_harmonics
from symfpu.results.numbers import fifteen_digits
from symfpu.series.ring_resonances import resonant
from symfpu.tori.torus import Torus

SHOWN_DIVISORS = 10
SUSPECT = 1e-9  # of nu.omega, below which it is decided exactly
STANDING = (
    "opposite waves of one frequency stand: refine the solution of Chain(N // 2, ...) with "
    "fixed ends and unfold it; else change a frequency"
)


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


def require_independent(torus: Torus, frequencies: Sequence[Fraction]) -> None:
    """InputError where nu.omega = 0 for a low harmonic: the angles are not independent then.

    frequencies : of the seeds of the torus, (s,).
    """
    harmonics = np.concatenate([low_harmonics(len(frequencies)), torus.harmonics])
    shared = lcm(*(w.denominator for w in frequencies))
    whole = [int(w * shared) for w in frequencies]
    near = np.abs(harmonics @ np.array([float(w) for w in frequencies])) < SUSPECT
    for nu in sorted(harmonics[near].tolist(), key=_size):
        if any(nu) and not sum(n * w for n, w in zip(nu, whole, strict=True)):
            terms = zip(nu, torus.seeds, strict=True)
            relation = " ".join(f"{n:+d} omega_{q}" for n, q in terms if n)
            allowed = "frequencies without an integer relation among the harmonics"
            raise InputError("torus", f"{relation} = 0", allowed, STANDING)


def _size(nu: list[int]) -> tuple[int, list[int]]:
    """The sum of |nu_i|, and of equal ones those first whose first number is positive."""
    return sum(map(abs, nu)), [-n for n in nu]


def driven_in_resonance(torus: Torus, near_resonances: Sequence[NearResonance]) -> str:
    """The lowest of the small divisors that are zero at the linear frequencies, in words.

    Empty where there is none.
    """
    chain, seeds = torus.chain, torus.seeds
    for found in sorted(near_resonances, key=lambda d: _size(list(d.harmonic))):
        if resonant(chain, seeds, found.harmonic, found.mode):
            harmonic = ",".join(map(str, found.harmonic))
            drive = f"the harmonic ({harmonic}) drives mode {found.mode} in resonance"
            return f"{drive} at any frequencies near the linear ones (Umklapp)"
    return ""
