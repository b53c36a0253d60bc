"""Products of many differences with many digits, in MPFR's numbers: the only costly loop here.

MPFR's numbers multiply several times faster than mpmath's, which hold the same digits.
"""

from __future__ import annotations

from typing import Any

import gmpy2
import mpmath
import numpy as np
from mpmath import libmp

from symfpu.numbers.arithmetic import Numbers


def product_of_distances(points: Numbers, places: Numbers) -> Numbers:
    """prod_k 2 |place - point_k| at the working precision of mpmath; the shape of places.

    points, places : mpf.
    """
    with gmpy2.context(gmpy2.get_context(), precision=mpmath.mp.prec):
        doubled = 2 * _TO_GMP(np.asarray(places, dtype=object))
        product = doubled * 0 + 1
        for point in 2 * _TO_GMP(points):
            product = product * (doubled - point)
    return np.asarray(abs(_TO_MPF(product)), dtype=object)


def _to_gmp(value: Any) -> Any:
    sign, mantissa, exponent, _ = value._mpf_
    number = gmpy2.mpfr(-mantissa if sign else mantissa)
    return (
        gmpy2.mul_2exp(number, exponent)
        if exponent >= 0
        else gmpy2.div_2exp(number, -exponent)
    )


def _to_mpf(value: Any) -> Any:
    mantissa, exponent = value.as_mantissa_exp()
    return mpmath.mp.make_mpf(libmp.from_man_exp(mantissa, int(exponent)))


_TO_GMP = np.frompyfunc(_to_gmp, 1, 1)
_TO_MPF = np.frompyfunc(_to_mpf, 1, 1)
