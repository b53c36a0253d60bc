"""Arrays of numbers of many digits as flat arrays of words, and back to the last bit.

Each number is its mantissa in words (`symfpu.algebra.words`) with its binary exponent.
"""

from __future__ import annotations

from math import prod
from typing import Any

import mpmath
import numpy as np
from mpmath import libmp
from numpy.typing import NDArray

from symfpu.algebra.words import IntegerTable
from symfpu.errors import InputError

Array = NDArray[Any]
INTEGERS = "<i8"


def is_of_many_digits(values: Array) -> bool:
    """Whether all are mpf, of one precision in print or of none."""
    first = next(values.flat, None)
    digits = getattr(first, "digits", None)
    return all(
        isinstance(x, mpmath.mpf) and getattr(x, "digits", None) == digits
        for x in values.flat
    ) and isinstance(first, mpmath.mpf)


def packed(values: Array) -> tuple[Array, Array]:
    """Words of the mantissas, (n, words), and exponents, (n,). Raises InputError."""
    if not all(mpmath.isfinite(x) for x in values.flat):
        problem = "a number that is not finite"
        raise InputError("result", problem, "finite numbers", "compute it again")
    parts = [x._mpf_ for x in values.flat]
    mantissas = np.empty((len(parts), 1), dtype=object)
    mantissas[:, 0] = [
        -int(mantissa) if sign else int(mantissa) for sign, mantissa, _, _ in parts
    ]
    words = IntegerTable.of(mantissas).words
    exponents = np.array([exponent for _, _, exponent, _ in parts], dtype=INTEGERS)
    return words.reshape(len(parts), -1).astype(INTEGERS), exponents


def unpacked(words: Array, exponents: Array, shape: tuple[int, ...]) -> Array:
    """The numbers of such arrays."""
    count = prod(shape)
    table = IntegerTable(words.reshape(count, 1, -1))
    values: Array = np.empty(count, dtype=object)
    pairs = zip(table.integers()[:, 0], exponents.tolist(), strict=True)
    for i, (mantissa, exponent) in enumerate(pairs):
        values[i] = mpmath.mp.make_mpf(libmp.from_man_exp(int(mantissa), exponent))
    return values.reshape(shape)
