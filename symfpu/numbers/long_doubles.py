"""The machine's long doubles: exact numbers rounded to them, alone or as the sum of two."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.numbers.arithmetic import Arithmetic, mpf

DIGITS = 30  # of the numbers that long doubles are made of


def long(value: Any) -> np.longdouble:
    """A rational or an mpf as a long double."""
    with mpmath.workdps(DIGITS):
        exact = mpf(value)
        return np.longdouble(mpmath.nstr(exact, DIGITS))


class LongDoubles(Arithmetic):
    """Numbers as long doubles."""

    def number(self, value: Fraction) -> np.longdouble:
        return long(value)


LONG_DOUBLES = LongDoubles()


def rational(value: np.longdouble) -> Fraction:
    """A long double as the number it is."""
    high = float(value)
    low = float(value - np.longdouble(high))
    return Fraction(high) + Fraction(low)


def in_halves(values: Sequence[mpmath.mpf]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Numbers of ordinary size, each as the sum of two long doubles, of more digits than one."""
    with mpmath.workdps(2 * DIGITS):
        pairs = [_halves(value) for value in values]
    high, low = zip(*pairs, strict=True)
    return np.array(high), np.array(low)


def _halves(value: mpmath.mpf) -> tuple[np.longdouble, np.longdouble]:
    high = _nearest(value)
    first = float(high)
    second = float(high - np.longdouble(first))
    return high, _nearest(value - first - second)


def _nearest(value: mpmath.mpf) -> np.longdouble:
    """By two doubles, faster than `long` by its decimals."""
    first = float(value)
    return np.longdouble(first) + np.longdouble(float(value - first))
