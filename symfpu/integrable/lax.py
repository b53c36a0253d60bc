"""Flaschka's matrices of a Toda ring, and the gaps of a state.

With V = (e^(2ar) - 1 - 2ar)/(4a^2) and unit masses the Jacobi matrix with off-diagonal entries
a_j = e^(a r_j)/2 and diagonal entries b_j = a p_j keeps its spectrum:

    da_j/dt = a_j (b_(j+1) - b_j),  db_j/dt = 2 (a_j^2 - a_(j-1)^2).

At rest it is 1/2, 0, 1/2 with the spectrum 2 cos(theta)/2. The eigenvalues of the periodic matrix
of a ring of n particles, and of the antiperiodic one (the entry in the corner with a minus), are
the 2n edges of its bands: lambda_0 > (lambda_1 >= lambda_2) > (lambda_3 >= lambda_4) > ... The pair
number k, k = 1 .. n-1, bounds gap k. At rest it is closed, at cos(k pi / n), and to first order

    gap k = 2 |a| omega_k times the amplitude of the wave cos(2 pi k j / n + omega_k t),

omega_k = 2 sin(pi k / n): one gap for each travelling wave, k and n - k being the same wave number
in the two directions.

Fixed ends with N bonds are the odd states x_(-j) = -x_j of the ring of n = 2N. Reflection times
alternating signs takes the matrix L to -L. So the spectrum is even: gaps q and 2N - q are equal,
gap N is closed always, and N - 1 gaps are left, gap q for mode q. To first order

    gap q = sqrt(2/N) |a| Omega_q A_q,  E_q = N gap^2 / (4 a^2).

In vectors e_j +- (-1)^j e_(-j) L is off-diagonal, of blocks K and its transpose, so the edges are
+- the singular values of two blocks: one of shape (N, N), one (N-1, N+1).

Doubles give gaps to an absolute error of a few times 1e-16: harmonic energies E_q down to about
1e-31 N/a^2. Relative accuracy of smaller gaps needs digits, and a state of as many. Source: ours.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from symfpu.numbers.arithmetic import DOUBLES, Arithmetic, Numbers
from symfpu.numbers.functions import exp


def jacobi_entries(
    stretches: Numbers, momenta: Numbers, a: Fraction, numbers: Arithmetic
) -> tuple[Numbers, Numbers]:
    """Flaschka's a_j = e^(a r_j)/2 and b_j = a p_j, shapes as given."""
    scale = numbers.number(a)
    return exp(stretches * scale) / 2, momenta * scale


def odd_edges(
    bonds: Numbers, momenta: Numbers, numbers: Arithmetic
) -> tuple[Numbers, Numbers, Numbers]:
    """Positive edges of a chain with fixed ends.

    bonds : a_0 .. a_(N-1), shape (..., N); momenta : b_1 .. b_(N-1), shape (..., N-1).
    Returns the outer edge, shape (...), upper and lower edges of gaps 1 .. N-1, (..., N-1).
    """
    N = bonds.shape[-1]
    square = _square_block(bonds, momenta, numbers)
    wide = _wide_block(bonds, momenta, numbers)
    equal_parity = _singular_values(square, numbers)
    other_parity = _singular_values(wide, numbers)
    # the outer edge stands in the periodic block; gaps k have the parity of k - 1, or of k
    with_top, without = other_parity, equal_parity
    if N % 2:
        with_top, without = equal_parity, other_parity
    upper = numbers.zeros((*bonds.shape[:-1], N - 1))
    lower = numbers.zeros((*bonds.shape[:-1], N - 1))
    upper[..., 0::2], lower[..., 0::2] = without[..., 0::2], without[..., 1::2]
    upper[..., 1::2], lower[..., 1::2] = with_top[..., 1::2], with_top[..., 2::2]
    return with_top[..., 0], upper, lower


def _square_block(bonds: Numbers, momenta: Numbers, numbers: Arithmetic) -> Numbers:
    """L from e_0 .. e_(N-1) of one parity to e_1 .. e_N of the other."""
    N = bonds.shape[-1]
    root = numbers.sqrt(numbers.array(2))
    block = numbers.zeros((*bonds.shape[:-1], N, N))
    for j in range(N):
        onward = bonds[..., j]
        block[..., j, j] = onward * root if j in (0, N - 1) else onward
    if N == 1:
        return block
    for j in range(1, N):
        block[..., j - 1, j] = momenta[..., j - 1]
    for j in range(2, N):
        block[..., j - 2, j] = bonds[..., j - 1]
    return block


def _wide_block(bonds: Numbers, momenta: Numbers, numbers: Arithmetic) -> Numbers:
    """L from e_0 .. e_N of one parity to e_1 .. e_(N-1) of the other."""
    N = bonds.shape[-1]
    root = numbers.sqrt(numbers.array(2))
    block = numbers.zeros((*bonds.shape[:-1], N - 1, N + 1))
    for j in range(1, N):
        before, after = bonds[..., j - 1], bonds[..., j]
        block[..., j - 1, j - 1] = before * root if j == 1 else before
        block[..., j - 1, j] = momenta[..., j - 1]
        block[..., j - 1, j + 1] = after * root if j == N - 1 else after
    return block


def _singular_values(blocks: Numbers, numbers: Arithmetic) -> Numbers:
    """Descending, of the last two axes."""
    if numbers is DOUBLES:
        return np.asarray(np.linalg.svd(blocks, compute_uv=False))
    rows, columns = blocks.shape[-2:]
    flat = blocks.reshape(-1, rows, columns)
    found = [_descending(mpmath.svd_r, block, compute_uv=False) for block in flat]
    return np.array(found, dtype=object).reshape(*blocks.shape[:-2], min(rows, columns))


def _descending(solver: Any, matrix: Numbers, **options: bool) -> list[Any]:
    values = solver(mpmath.matrix(matrix.tolist()), **options)
    return sorted(values, reverse=True)


def ring_edges(
    bonds: Numbers, momenta: Numbers, numbers: Arithmetic
) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    """Edges of a ring of n particles; bond j joins particles j and j + 1.

    bonds, momenta : a_j and b_j, shapes (..., n). Returns the top edge, upper and lower edges of
    gaps 1 .. n-1, shapes (..., n-1), and the bottom edge.
    """
    n = bonds.shape[-1]
    periodic = _eigenvalues(_ring_matrix(bonds, momenta, 1, numbers), numbers)
    antiperiodic = _eigenvalues(_ring_matrix(bonds, momenta, -1, numbers), numbers)
    upper = numbers.zeros((*bonds.shape[:-1], n - 1))
    lower = numbers.zeros((*bonds.shape[:-1], n - 1))
    odd, even = antiperiodic, periodic[..., 1:]
    count = n // 2  # of odd gaps
    upper[..., 0::2] = odd[..., 0 : 2 * count : 2]
    lower[..., 0::2] = odd[..., 1 : 2 * count : 2]
    rest = n - 1 - count
    upper[..., 1::2] = even[..., 0 : 2 * rest : 2]
    lower[..., 1::2] = even[..., 1 : 2 * rest : 2]
    bottom = antiperiodic[..., -1] if n % 2 else periodic[..., -1]
    return periodic[..., 0], upper, lower, bottom


def _ring_matrix(
    bonds: Numbers, momenta: Numbers, sign: int, numbers: Arithmetic
) -> Numbers:
    """The periodic (sign 1) or antiperiodic (-1) Jacobi matrix, shape (..., n, n)."""
    n = bonds.shape[-1]
    matrix = numbers.zeros((*bonds.shape[:-1], n, n))
    for j in range(n):
        matrix[..., j, j] = momenta[..., j]
    for j in range(n):
        entry = bonds[..., j] if j < n - 1 else sign * bonds[..., j]
        after = (j + 1) % n
        matrix[..., j, after] = matrix[..., j, after] + entry
        matrix[..., after, j] = matrix[..., after, j] + entry
    return matrix


def _eigenvalues(matrices: Numbers, numbers: Arithmetic) -> Numbers:
    """Descending, of symmetric matrices in the last two axes."""
    if numbers is DOUBLES:
        return np.asarray(np.linalg.eigvalsh(matrices)[..., ::-1])
    n = matrices.shape[-1]
    flat = matrices.reshape(-1, n, n)
    found = [_descending(mpmath.eigsy, matrix, eigvals_only=True) for matrix in flat]
    return np.array(found, dtype=object).reshape(matrices.shape[:-1])
