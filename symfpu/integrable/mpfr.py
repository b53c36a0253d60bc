"""Arrays of MPFR's numbers: several times faster than mpmath's in long products.

They are used inside the search of a torus; what leaves it are mpf.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import Any

import gmpy2
import mpmath
import numpy as np
from mpmath import libmp
from numpy.typing import NDArray

from symfpu.numbers.arithmetic import Arithmetic, Numbers


class Mpfr(Arithmetic):
    """Object arrays of mpfr at the working precision that `working_digits` sets."""

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


@contextmanager
def working_digits(digits: int) -> Iterator[None]:
    """The same working precision for mpmath and for MPFR, restored afterwards."""
    with (
        mpmath.workdps(digits),
        gmpy2.context(gmpy2.get_context(), precision=mpmath.mp.prec),
    ):
        yield


def in_mpf(values: Numbers) -> Numbers:
    """mpf of the same value, unrounded."""
    return np.asarray(_MPF(values), dtype=object)


def _mpfr(value: Any) -> Any:
    if isinstance(value, mpmath.mpf):
        sign, mantissa, exponent, _ = value._mpf_
        number = gmpy2.mpfr(-mantissa if sign else mantissa)
        if exponent >= 0:
            return gmpy2.mul_2exp(number, exponent)
        return gmpy2.div_2exp(number, -exponent)
    if isinstance(value, Fraction):
        return MPFR.number(value)
    return gmpy2.mpfr(value)


def _mpf(value: Any) -> Any:
    mantissa, exponent = value.as_mantissa_exp()
    return mpmath.mp.make_mpf(libmp.from_man_exp(mantissa, int(exponent)))


_MPFR, _MPF = np.frompyfunc(_mpfr, 1, 1), np.frompyfunc(_mpf, 1, 1)
_COS, _SIN, _SQRT, _EXP, _LOG = (
    np.frompyfunc(f, 1, 1) for f in (gmpy2.cos, gmpy2.sin, gmpy2.sqrt, gmpy2.exp, gmpy2.log)
)
