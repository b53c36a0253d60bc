"""Arrays of MPFR's numbers: ten times faster than mpmath's in long sums and products.

They are used inside of long computations; what leaves these are mpf. Sums, products, quotients and
square roots of both are rounded to the nearest at one working precision, so they are the same to
the last bit.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import gmpy2
import mpmath
import numpy as np
from mpmath import libmp
from numpy.typing import NDArray

from symfpu.numbers.arithmetic import MULTIPRECISION, Arithmetic, Numbers


class Mpfr(Arithmetic):
    """Object arrays of mpfr at the working precision that
    `Multiprecision.context` and `working_digits` set."""

    def number(self, value: Fraction) -> Any:
        return gmpy2.mpfr(gmpy2.mpq(value.numerator, value.denominator))

    def array(self, values: Any) -> NDArray[Any]:
        """Of integers, exact fractions, doubles as they are, mpf or mpfr."""
        return np.asarray(_MPFR(np.asarray(values, dtype=object)), dtype=object)

    def zeros(self, shape: tuple[int, ...]) -> NDArray[Any]:
        return np.full(shape, gmpy2.mpfr(0), dtype=object)

    def cos(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(_COS(values), dtype=object)

    def sin(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(_SIN(values), dtype=object)

    def sqrt(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(_SQRT(values), dtype=object)

    def exp(self, values: Numbers) -> Numbers:
        return np.asarray(_EXP(values), dtype=object)

    def log(self, values: Numbers) -> Numbers:
        return np.asarray(_LOG(values), dtype=object)

    @property
    def pi(self) -> Any:
        return gmpy2.const_pi()


MPFR = Mpfr()


def inside(numbers: Arithmetic) -> Arithmetic:
    """The arithmetic of long sums whose results are in this one: MPFR's numbers for mpf."""
    return MPFR if numbers is MULTIPRECISION else numbers


def in_mpf(values: Numbers) -> Numbers:
    """mpf of the same value, unrounded."""
    return np.asarray(_MPF(values), dtype=object)


def at_the_face(values: Numbers) -> Numbers:
    """Results of long sums: mpf for MPFR's numbers, doubles as they are."""
    return in_mpf(values) if values.dtype == object else values


def scaled_integers(
    values: NDArray[np.object_], exponents: NDArray[Any]
) -> NDArray[np.object_]:
    """Integers times 2^exponents, rounded to the working precision; shapes that broadcast."""
    whole_exponents = np.asarray(exponents).astype(object)
    return np.asarray(_SCALED(values, whole_exponents), dtype=object)


def _scaled(value: int, exponent: int) -> Any:
    number = gmpy2.mpfr(value)
    if exponent >= 0:
        return gmpy2.mul_2exp(number, exponent)
    return gmpy2.div_2exp(number, -exponent)


def _mpfr(value: Any) -> Any:
    if isinstance(value, mpmath.mpf):
        sign, mantissa, exponent, _ = value._mpf_
        return _scaled(-mantissa if sign else mantissa, exponent)
    if isinstance(value, Fraction):
        return MPFR.number(value)
    return gmpy2.mpfr(value)


def _mpf(value: Any) -> Any:
    mantissa, exponent = value.as_mantissa_exp()
    return mpmath.mp.make_mpf(libmp.from_man_exp(mantissa, int(exponent)))


_MPFR, _MPF = np.frompyfunc(_mpfr, 1, 1), np.frompyfunc(_mpf, 1, 1)
_SCALED = np.frompyfunc(_scaled, 2, 1)
_COS, _SIN, _SQRT, _EXP, _LOG = (
    np.frompyfunc(f, 1, 1) for f in (gmpy2.cos, gmpy2.sin, gmpy2.sqrt, gmpy2.exp, gmpy2.log)
)
