"""Where a torus passes the singularity of its own series.

At given amplitudes and frequencies of the seeds the equations of motion of all other
coefficients make these a function, whose series is that of Eq. moda. It is singular where the
derivative of these equations is. A family of tori passes such a place smoothly, onto another
sheet of the function: from there on the series, whatever its order, is that of other tori, though
it may converge.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.tori import RefinedTorus, shifts_of

MOST_UNKNOWNS = 4000  # of a dense matrix
INVERSE_STEPS = 3  # from a random vector to the null vector

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Sheet:
    """The derivative of the equations of the other coefficients, at one torus.

    sign : of its determinant, relative to that of the linear chain; it changes where the series
    is singular. mode, harmonic : the coefficient that moves most in its weakest direction.
    """

    sign: int
    mode: int
    harmonic: tuple[int, ...]


def sheet_of(torus: RefinedTorus) -> Sheet | None:
    """The sheet on which a torus lies; None if it has too many coefficients for a dense matrix."""
    equation = InvarianceEquation(torus.chain, torus.seeds, torus.harmonics)
    unknown = equation.mask.copy()
    unknown[equation.seed_rows, equation.seed_columns] = False
    rows, columns = np.nonzero(unknown)
    if len(rows) > MOST_UNKNOWNS:
        return None
    cosines = np.asarray(torus.cosines, np.longdouble)
    slopes = equation.slopes(cosines)
    divisors = equation.divisors(shifts_of(torus)).astype(float)[rows, columns]
    matrix = np.diag(divisors) - equation.block(slopes, rows, columns)
    matrix /= np.abs(divisors)[:, None]
    sign, weakest = _sign_and_weakest(matrix)
    sign *= int(np.prod(np.sign(divisors)))
    return Sheet(
        sign, int(columns[weakest]) + 1, tuple(map(int, torus.harmonics[rows[weakest]]))
    )


def _sign_and_weakest(matrix: Floats) -> tuple[int, int]:
    """Of the determinant, and the place that is largest in the nearly null vector."""
    from scipy import linalg

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", linalg.LinAlgWarning)
        factors, pivots = linalg.lu_factor(matrix, check_finite=False)
    swaps = int((pivots != np.arange(len(pivots))).sum())
    negative = int((factors.diagonal() < 0).sum())
    vector = np.random.default_rng(0).standard_normal(len(pivots))
    for _ in range(INVERSE_STEPS):
        vector = linalg.lu_solve((factors, pivots), vector, check_finite=False)
        vector /= np.abs(vector).max()
    sign = -1 if (swaps + negative) % 2 else 1
    return sign, int(np.argmax(np.abs(vector)))
