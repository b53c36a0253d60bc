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

from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.newton import Newton
from symfpu.tori.torus import Torus

MOST_UNKNOWNS = 4000  # of a dense matrix
INVERSE_STEPS = 100  # from a random vector to the null vector, at most
SETTLED = (
    1e-3  # change of that vector in a step, of its largest coefficient, that ends them
)
CLEAR = 0.9  # of the largest coefficient: where another one is as large, none is named

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Sheet:
    """The derivative of the equations of the other coefficients, at one torus.

    sign, logarithm : of its determinant divided by that of the linear chain at these frequencies,
        the product of the divisors; the sign changes where the series is singular.
    mode, harmonic : the coefficient that moves most in its weakest direction; None and () where
        no direction is the weakest, or no coefficient moves most.
    """

    sign: int
    logarithm: float
    mode: int | None
    harmonic: tuple[int, ...]


def sheet_of(torus: Torus[Newton]) -> Sheet | None:
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
    matrix /= divisors[:, None]
    sign, logarithm, weakest = _determinant(matrix)
    if weakest is None:
        return Sheet(sign, logarithm, None, ())
    harmonic = tuple(map(int, torus.harmonics[rows[weakest]]))
    return Sheet(sign, logarithm, int(columns[weakest]) + 1, harmonic)


def _determinant(matrix: Floats) -> tuple[int, float, int | None]:
    """Its sign, the logarithm of its size, and what is largest in the nearly null vector."""
    from scipy import linalg

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", linalg.LinAlgWarning)
        factors, pivots = linalg.lu_factor(matrix, check_finite=False)
    swaps = int((pivots != np.arange(len(pivots))).sum())
    negative = int((factors.diagonal() < 0).sum())
    sign = -1 if (swaps + negative) % 2 else 1
    logarithm = float(np.log(np.abs(factors.diagonal())).sum())
    return sign, logarithm, _weakest((factors, pivots))


def _weakest(factors: tuple[Floats, NDArray[np.intp]]) -> int | None:
    """What is largest in the nearly null vector, None where that is not sure."""
    from scipy import linalg

    vector = np.random.default_rng(0).standard_normal(len(factors[1]))
    for _ in range(INVERSE_STEPS):
        before = vector
        vector = linalg.lu_solve(factors, vector, check_finite=False)
        vector = vector / vector[np.argmax(np.abs(vector))]
        if float(np.max(np.abs(vector - before))) < SETTLED:
            break
    else:
        return None
    sizes = np.abs(vector)
    largest = int(np.argmax(sizes))
    return None if (np.delete(sizes, largest) > CLEAR).any() else largest
