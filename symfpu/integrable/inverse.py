"""A state of a Toda ring from its spectrum: all angles of its gaps at 0 or pi.

Take the particle 0 out of the ring. The Jacobi matrix of the others has one eigenvalue in every
gap. Where each stands at an edge of its gap, the state is its own mirror image about particle 0,
and the matrix persymmetric: such a matrix is determined by its spectrum mu_1 .. mu_(n-1) alone
(Hochstadt). Its weights are w_i ~ 1/prod_(l != i) |mu_i - mu_l|, and the algorithm of Rutishauser,
Kahan, Pal and Walker (Gragg and Harwood 1984) turns mu and w into the matrix with n^2 rotations,
without cancellation. With fixed ends the spectrum is even, so all momenta are zero. Source: ours.
"""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

from symfpu.numbers.arithmetic import Numbers


def ring_state(spectrum: Numbers) -> tuple[Numbers, Numbers]:
    """Flaschka's a_j and b_j, j = 0 .. n-1, from the eigenvalues without particle 0.

    spectrum : mpf, shape (n-1,), one in each gap, at an edge. The trace of the ring is zero and the
    product of all a_j is 2^(-n).
    """
    n = len(spectrum) + 1
    diagonal, squares = persymmetric_matrix(spectrum)
    momenta = np.concatenate([[-diagonal.sum()], diagonal])
    corner = mpmath.ldexp(1, -2 * n) / mpmath.fprod(squares)
    bonds = [mpmath.sqrt(mpmath.sqrt(corner))]
    bonds += [mpmath.sqrt(square) for square in squares]
    bonds.append(bonds[0])
    return np.array(bonds, dtype=object), momenta


def persymmetric_matrix(spectrum: Numbers) -> tuple[Numbers, Numbers]:
    """Diagonal (n-1,) and squared off-diagonal (n-2,) of the persymmetric Jacobi matrix."""
    weights = []
    for i, value in enumerate(spectrum):
        others = np.delete(spectrum, i)
        weights.append(1 / mpmath.fprod(2 * abs(value - other) for other in others))
    total = mpmath.fsum(weights)
    diagonal, squares = spectrum.copy(), spectrum * 0
    squares[0] = weights[0] / total
    for k in range(1, len(spectrum)):
        _include(diagonal, squares, k, spectrum[k], weights[k] / total)
    return diagonal, squares[1:]


def _include(
    diagonal: Numbers, squares: Numbers, last: int, node: Any, weight: Any
) -> None:
    """One more point of the measure: rotations chase it through the matrix, in place."""
    cosine, sine, shift = mpmath.mpf(1), mpmath.mpf(0), mpmath.mpf(0)
    for k in range(last + 1):
        length = squares[k] + weight
        rotated = cosine * length
        sine_before = sine
        cosine, sine = mpmath.mpf(1), mpmath.mpf(0)
        if length > 0:
            cosine, sine = squares[k] / length, weight / length
        change = sine * (diagonal[k] - node) - cosine * shift
        diagonal[k] -= change - shift
        shift = change
        weight = shift**2 / sine if sine > 0 else sine_before * squares[k]
        squares[k] = rotated
