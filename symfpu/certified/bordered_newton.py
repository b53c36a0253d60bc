"""Newton's method for an orbit of a given amplitude or energy, and the tangent of its family.

The matrix is that of the proof, in doubles; residuals are balls, corrections are added to the
integers of the orbit. So folds in omega are ordinary points. Ours.
"""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from symfpu.certified.bond_balls import BondBalls
from symfpu.certified.border import FREQUENCY, Border, Fixed, border_of, residual_of
from symfpu.certified.contraction import Attempt, LinearPart, first_free
from symfpu.certified.existence_bounds import linear_part, strip
from symfpu.certified.rounded_orbit import DOUBLE_DIGITS, RoundedOrbit

Floats = NDArray[np.float64]

SLOPES_LEFT = 1e-13  # norm of the slopes that the matrix leaves out
SWEEPS = 40
LAST_UNITS = (
    1000  # of the last place: a correction is the last one if the next is below them
)
FREQUENCY_BITS = 8  # of omega beyond those of the orbit
LONGER = (
    1.5  # times the harmonics of an orbit of doubles, of those that corrections may add
)


class BorderedMatrix:
    """DF with the row and the column of the frequency, factored."""

    def __init__(self, part: LinearPart, free: int) -> None:
        attempt = Attempt(part, free)
        count = attempt.count
        diagonal = np.diag(attempt.divisors[:count])
        self.places, self.omega = attempt.inside, part.omega
        self.linear = part.layout.frequencies()
        self.factors = scipy.linalg.lu_factor(attempt.force[:count] + diagonal)

    def solve(self, of_border: float, rows: Floats) -> tuple[float, Floats]:
        """The unknown and the coefficients that the matrix takes to these, rows by harmonic.

        Beyond the matrix by its diagonal.
        """
        n, q = self.places.n[1:], self.places.q[1:] - 1
        harmonics = max(len(rows), int(n.max()) + 1)
        padded = np.zeros((harmonics, rows.shape[1]))
        padded[: len(rows)] = rows
        given = np.append(of_border, padded[n, q])
        found = scipy.linalg.lu_solve(self.factors, given)
        ratio = np.arange(int(n.max()) + 1, harmonics)[:, None] * self.omega / self.linear
        padded[int(n.max()) + 1 :] /= 1 - ratio**2
        padded[n, q] = found[1:]
        return float(found[0]), padded


def bordered_matrix(balls: BondBalls, border: Border) -> BorderedMatrix:
    """At the orbit of the balls."""
    part = linear_part(balls, SLOPES_LEFT, border)
    return BorderedMatrix(part, first_free(part))


def fixed_orbit(orbit: RoundedOrbit, fixed: Fixed) -> RoundedOrbit:
    """The orbit nearby that has the given value to its last places, if Newton's method finds it.

    At the working precision of python-flint. It ends where corrections stop falling.
    """
    balls = BondBalls(orbit, strip(orbit))
    border = border_of(balls, fixed)
    matrix = bordered_matrix(balls, border)
    longer = LONGER * max(1.0, orbit.digits / DOUBLE_DIGITS)
    last, least = math.ceil(longer * orbit.harmonics), math.inf
    for _ in range(SWEEPS):
        size, larger = corrected(balls, border, matrix, last)
        if not size < least / 2:
            break
        expected = size * size / least if math.isfinite(least) else size
        least, orbit = size, larger
        if expected < LAST_UNITS * 2.0**-orbit.bits:
            break
        balls = BondBalls(orbit, strip(orbit))
        border = replace(border, residual=residual_of(balls, fixed, border.equation_places))
    return orbit


def corrected(
    balls: BondBalls, border: Border, matrix: BorderedMatrix, last: int
) -> tuple[float, RoundedOrbit]:
    """The size of one correction, and the orbit with it."""
    orbit = balls.orbit
    residual = np.array(
        [[float(x.mid()) for x in row] for row in balls.residual()[: last + 1]]
    )
    of_frequency, change = matrix.solve(-float(border.residual.mid()), -residual)
    change = change[: last + 1]
    rows = with_change(orbit, change)
    if border.fixed.kind == FREQUENCY:
        return float(np.abs(change).sum()), replace(orbit, rows=rows)
    step = of_frequency * float(border.unit)
    omega = orbit.omega + Fraction(step) / (2 * orbit.omega)
    places = 2 ** (orbit.bits + FREQUENCY_BITS)
    rounded = Fraction(round(omega * places), places)
    size = float(np.abs(change).sum()) + abs(of_frequency)
    return size, replace(orbit, omega=rounded, rows=rows)


def with_change(orbit: RoundedOrbit, change: Floats) -> tuple[tuple[int, ...], ...]:
    """The integers with a change of the coefficients, without the last rows of zeros."""
    length = max(len(change), len(orbit.rows))
    table = np.zeros((length, orbit.layout.modes), dtype=object)
    table[: len(orbit.rows)] = orbit.rows
    table[: len(change)] += as_integers(change, orbit.bits)
    kept = max(n for n, row in enumerate(table) if any(row))
    return tuple(tuple(row) for row in table[: kept + 1].tolist())


def as_integers(values: Floats, bits: int) -> NDArray[Any]:
    """Doubles in units 2^-bits, to the nearest."""
    ratios = [x.as_integer_ratio() for x in values.ravel().tolist()]
    rounded = [((n << bits + 1) + d) // (2 * d) if n else 0 for n, d in ratios]
    return np.array(rounded, dtype=object).reshape(values.shape)
