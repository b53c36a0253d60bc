"""Numbers that checkers round to one side, and what they then look like in decimals.

Like the reader it is a part of every checker that uses it: nothing but the standard library.
"""

from collections.abc import Callable
from fractions import Fraction


def up(x: Fraction | int) -> int:
    """The least integer not below."""
    return -((-x.numerator) // x.denominator)


def scientific(
    x: Fraction, digits: int = 3, rounded: Callable[[Fraction], int] = up
) -> str:
    """A number in decimals, its size rounded up, or another way."""
    if not x:
        return "0"
    exponent = len(str(abs(x.numerator))) - len(str(x.denominator))
    if abs(x) < Fraction(10) ** exponent:
        exponent -= 1
    text = str(rounded(abs(x) / Fraction(10) ** (exponent - digits + 1)))
    if len(text) > digits:
        exponent += 1
        text = text[:digits]
    sign = "-" if x < 0 else ""
    point = f"{text[0]}.{text[1:]}" if digits > 1 else text
    return f"{sign}{point}e{exponent}" if exponent else f"{sign}{point}"
