"""Numbers of results as text and as JSON holds them, without losing a digit."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from numbers import Integral
from typing import Any

import mpmath
import numpy as np

from symfpu.numbers.arithmetic import text
from symfpu.numbers.typed import decimal

LONGEST_TYPED = 2000  # bits of an exact number that is written in decimal digits
LARGEST_NUMBER = 10**15  # of whole numbers in JSON: what all readers keep
BITS_A_DIGIT = 3.33


def fifteen_digits(value: float) -> float:
    """A measure of size to 15 digits, the most that a number in JSON has.

    What needs more is written as a string.
    """
    return float(f"{value:.15g}")


def number_text(value: Any, digits: int | None) -> str:
    """A number that loses no digit.

    The shortest decimal of a double, or so many digits of an mpf.
    """
    return repr(float(value)) if digits is None else text(value, digits)


def exact_text(value: Fraction) -> str:
    """As it is typed; with so many digits that Python prints none of them, in base 16."""
    bits = max(value.numerator.bit_length(), value.denominator.bit_length())
    if bits > LONGEST_TYPED:
        return f"{value.numerator:#x}/{value.denominator:#x}"
    return decimal(value)


def json_value(value: Any) -> Any:
    """A value of a result as JSON can hold it.

    Whole numbers stay numbers, all others become text that loses no digit; complex ones are their
    real and imaginary parts.

    >>> json_value([1, 0.5, None, Fraction(1, 3), 1 + 2j, {1: True}])
    [1, '0.5', None, '1/3', ['1.0', '2.0'], {'1': True}]
    """
    if value is None or isinstance(value, bool | str):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, Mapping):
        return {str(key): json_value(item) for key, item in value.items()}
    if isinstance(value, tuple | list | np.ndarray):
        return [json_value(item) for item in value]
    return _number(value)


def _number(value: Any) -> Any:
    if isinstance(value, Integral):
        return int(value) if abs(int(value)) < LARGEST_NUMBER else str(int(value))
    if isinstance(value, Fraction):
        return exact_text(value)
    if isinstance(value, mpmath.mpf):
        return text(value, max(17, int(value.man.bit_length() / BITS_A_DIGIT)))
    if isinstance(value, complex | np.complexfloating):
        return [repr(float(value.real)), repr(float(value.imag))]
    if isinstance(value, float | np.floating):
        return repr(float(value))
    return str(value)
