"""How large an expression may be: its numbers, its powers, and how deep its functions are nested.

A part is checked as soon as it is built, and its powers before, so that no number grows beyond
its bound. Expressions are walked without recursion.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

MOST_BITS = 8000  # of a numerator or denominator; Python prints integers of 4300 digits
HIGHEST_POWER = 1000  # of r in a product of powers
DEEPEST = 6  # functions and powers of sums within each other
MOST_PARTS = 5000
LARGEST_EXPONENT = 690  # e to it is a double
ALLOWED = (
    f"numbers of at most {MOST_BITS} bits, constants within the range of doubles, powers of r "
    f"up to {HIGHEST_POWER}, functions at most {DEEPEST} deep"
)
ADVICE = "write it with shorter numbers, or in another unit of length"


def small(expression: Any) -> bool:
    """Whether every part of an expression that was built from small ones is small."""
    if not all(map(_has_bits, expression.atoms())):
        return False
    return depth(expression) <= DEEPEST and power(expression) <= HIGHEST_POWER


def short(expression: Any) -> bool:
    """Whether an expression of any origin has few parts, short numbers and little depth."""
    for count, (part, level) in enumerate(_parts(expression)):
        if count > MOST_PARTS or level > 4 * DEEPEST or not _has_bits(part):
            return False
    return True


def _parts(expression: Any) -> Iterator[tuple[Any, int]]:
    """All parts with how deep they are."""
    waiting = [(expression, 0)]
    while waiting:
        part, level = waiting.pop()
        yield part, level
        waiting += [(inner, level + 1) for inner in part.args]


def _has_bits(part: Any) -> bool:
    return not part.is_Rational or _bits(part) <= MOST_BITS


def _bits(number: Any) -> int:
    return max(int(abs(number.p)).bit_length(), int(number.q).bit_length())


def has_power(base: Any, exponent: Any) -> bool:
    """Whether a power is small, before it is built; exponents of numbers are bounded already."""
    if not exponent.is_number:
        return not base.is_number or _magnitude(base) <= LARGEST_EXPONENT
    if base.is_number and not base.is_Rational:
        return _magnitude(base) * float(abs(exponent)) <= LARGEST_EXPONENT
    numbers = (_bits(part) for part in base.atoms() if part.is_Rational)
    size = float(abs(exponent))
    return (
        max(numbers, default=0) * size <= MOST_BITS and power(base) * size <= HIGHEST_POWER
    )


def has_exponential(argument: Any) -> bool:
    """Whether e to a constant is a double."""
    value = abs(argument.evalf())
    return bool(value.is_finite and float(value) <= LARGEST_EXPONENT)


def _magnitude(constant: Any) -> float:
    """The size of the logarithm of a constant; infinite where it has none."""
    value = abs(constant.evalf())
    if not value.is_finite or not float(value):
        return 0.0 if value.is_zero else math.inf
    return abs(math.log(float(value)))


def depth(node: Any) -> int:
    """How many functions and powers are within each other."""
    inner: int = max(map(depth, node.args), default=0)
    return inner + bool(node.is_Function or node.is_Pow)


def power(node: Any) -> float:
    """The highest power of r that products of powers make, functions of r apart."""
    if node.is_Symbol:
        return 1
    if node.is_Mul:
        return sum(map(power, node.args))
    if node.is_Pow and node.exp.is_number:
        return power(node.base) * abs(float(node.exp))
    return max(map(power, node.args), default=0)
