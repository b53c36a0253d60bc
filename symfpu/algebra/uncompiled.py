"""What the kernels write in machine code, in NumPy, for NUMBA_DISABLE_JIT=1.

That setting has all loops interpreted.
"""

from __future__ import annotations

from typing import Any

import numpy as np

SPLIT = 2.0**27 + 1  # cuts a double into two halves whose products are exact


def modular_product(a: Any, b: Any, modulus: float, inverse: float) -> Any:
    """a b modulo the modulus for integers below 2^40 in size, up to one multiple of it.

    Numbers or arrays of doubles.
    """
    high, low = _exact_product(a, b)
    multiple, rest = _exact_product(np.rint(high * inverse), modulus)
    return (high - multiple) - rest + low


def multiply_row(
    lanes: Any,
    left: Any,
    i: int,
    weight: float,
    right: Any,
    j: int,
    out: Any,
    o: int,
    table: Any,
    t: int,
    start: int,
    stop: int,
    modulus: float | None,
) -> None:
    """out[o + table[t + n]] += weight left[i] right[j + n] for start <= n < stop.

    Modulo the modulus, if it is not None.
    """
    factor = left[i].astype(np.float64) * weight
    for n in range(start, stop):
        other = right[j + n]
        product = (
            factor * other
            if modulus is None
            else modular_product(factor, other, modulus, 1.0 / modulus)
        )
        out[o + table[t + n]] += product


def add_matrix_product(
    lanes: Any,
    rows: Any,
    matrix: Any,
    k: int,
    columns: Any,
    count: int,
    b: int,
    out: Any,
) -> None:
    """out[k + r, b + l] += sum of matrix[k + r, i] columns[i, b + l] over i < count."""
    own, some = slice(k, k + len(rows)), slice(b, b + len(lanes))
    out[own, some] += matrix[own, :count] @ columns[:count, some]


def _exact_product(a: Any, b: Any) -> tuple[Any, Any]:
    """The product rounded, and what rounding took from it (Dekker)."""
    product = a * b
    (a1, a0), (b1, b0) = _halves(a), _halves(b)
    return product, ((a1 * b1 - product) + a1 * b0 + a0 * b1) + a0 * b0


def _halves(a: Any) -> tuple[Any, Any]:
    shifted = SPLIT * a
    upper = shifted - (shifted - a)
    return upper, a - upper
