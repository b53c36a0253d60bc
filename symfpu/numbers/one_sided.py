"""Decimals of bounds, rounded to the side on which they stay true."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import ceil, floor
from typing import Any

import mpmath


def above(x: Any, digits: int) -> str:
    """A bound from above, a double, mpf or fraction not below 0, in so many digits not below it.

    >>> from symfpu.numbers.one_sided import above
    >>> above(1.21e-30, 2)
    '1.3e-30'
    """
    return _rounded(x, digits, ceil)


def below(x: Any, digits: int) -> str:
    """A bound from below, a double, mpf or fraction not below 0, in so many digits not above it.

    >>> from symfpu.numbers.one_sided import below
    >>> below(0.0428, 2)
    '0.042'
    """
    return _rounded(x, digits, floor)


def rational(x: Any) -> Fraction:
    """The value of a double, an mpf or a fraction, exact."""
    if not isinstance(x, mpmath.mpf):
        return Fraction(x)
    sign, mantissa, exponent, _ = x._mpf_
    return Fraction(-mantissa if sign else mantissa) * Fraction(2) ** int(exponent)


def _rounded(x: Any, digits: int, side: Callable[[Fraction], int]) -> str:
    exact = rational(x)
    if not exact:
        return "0"
    places = digits - len(str(floor(exact))) if exact >= 1 else digits
    while exact * Fraction(10) ** places < 10 ** (digits - 1):
        places += 1
    whole = side(exact * Fraction(10) ** places)
    with mpmath.workdps(digits + 15):
        return str(mpmath.nstr(mpmath.mpf(whole) / mpmath.mpf(10) ** places, digits))
