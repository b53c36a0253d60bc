"""Compiled: frequencies by order from the series of their squares, with derivatives.

Importing this module imports numba.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symfpu.compiled import compiled

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


_compiled = compiled(error_model="numpy")


@_compiled
def frequencies_by_order(
    y: Floats,
    first: Integers,
    exponents: Integers,
    table: Floats,
    linear: Floats,
    slope: Floats,
    terms: Floats,
    jacobian: Floats,
) -> None:
    """omega^(k) and its derivatives by A^2 into rows k = 1, 2, ... of terms and jacobian, zero yet.

    y : the variables, (s,). first : (top + 1,), where the rows of each order begin. exponents,
    table : (E, s), of [omega^2]^(k) = sum_e table[e] y^e. slope : dy/dA^2.
    """
    powers = _powers(y, exponents)
    for k in range(1, len(first)):
        if first[k - 1] < first[k]:
            for e in range(first[k - 1], first[k]):
                _add_product(powers, exponents[e], table[e], terms[k], jacobian[k])
            _take_root(k, linear, slope, terms, jacobian)


@_compiled
def _powers(y: Floats, exponents: Integers) -> Floats:
    """y_i^n up to the largest n; (s, n + 1)."""
    most = exponents.max() if len(exponents) else 0
    powers = np.ones((len(y), most + 1))
    for i in range(len(y)):
        for n in range(1, most + 1):
            powers[i, n] = y[i] ** n
    return powers


@_compiled
def _add_product(
    powers: Floats, exponents: Integers, row: Floats, square: Floats, slopes: Floats
) -> None:
    """row[q] y^e to the squares, (s,), and its derivatives by y_i to the slopes, (s, s)."""
    s = len(row)
    product = 1.0
    for i in range(s):
        product *= powers[i, exponents[i]]
    for q in range(s):
        square[q] += product * row[q]
    for i in range(s):
        lowered = exponents[i] * powers[i, max(exponents[i] - 1, 0)]
        for other in range(s):
            if other != i:
                lowered *= powers[other, exponents[other]]
        for q in range(s):
            slopes[q, i] += lowered * row[q]


@_compiled
def _take_root(
    k: int, linear: Floats, slope: Floats, terms: Floats, jacobian: Floats
) -> None:
    """[omega^2]^(k) = 2 Omega omega^(k) + sum of omega^(j) omega^(k-j), 0 < j < k."""
    s = len(linear)
    for q in range(s):
        for j in range(1, k):
            terms[k, q] -= terms[j, q] * terms[k - j, q]
        terms[k, q] /= 2.0 * linear[q]
        for i in range(s):
            products = 0.0
            for j in range(1, k):
                products += terms[j, q] * jacobian[k - j, q, i]
            grown = jacobian[k, q, i] * slope[i] - 2.0 * products
            jacobian[k, q, i] = grown / (2.0 * linear[q])
