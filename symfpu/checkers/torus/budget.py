"""The time that checking a certificate may take: it is in proportion to the size of the file."""

import json
import math
from fractions import Fraction

from symfpu.checkers.reading import Json, need

DIGIT = 30  # bits of a digit of Python's integers
KARATSUBA = math.log2(
    3
)  # products of n digits take n^KARATSUBA products of digits, or steps
PLACE = 300  # steps that take as long as one place of a box, or the product of one pair
# certificates of tori that were proved take 410,000 at most; a step is 1.5 to 6 ns
STEPS_A_BYTE = 2_000_000


class Budget:
    """Steps that are left; each piece of work names its steps before it begins."""

    def __init__(self, size: int) -> None:
        self.left = float(STEPS_A_BYTE * size)

    def spend(self, steps: float) -> None:
        """Refuse the certificate where its size does not allow these steps."""
        self.left -= steps
        need(self.left >= 0, "checking it would take more steps than its size allows")


def budget_of(data: Json) -> Budget:
    """That of a certificate, by the bytes of its text."""
    return Budget(len(json.dumps(data, separators=(",", ":"))))


def packed_steps(places: int, bits: int) -> float:
    """Of a product of two integers of so many places, read and written place by place."""
    return float((places * bits / DIGIT) ** KARATSUBA + PLACE * places)


def fraction_steps(x: Fraction | int, bits: int) -> float:
    """Of the product of an integer and a fraction."""
    digits = max(x.numerator.bit_length(), x.denominator.bit_length()) / DIGIT + 1
    return PLACE + digits * (digits + bits / DIGIT)
