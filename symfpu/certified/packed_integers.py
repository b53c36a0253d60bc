"""Lists of integers as text: small ones take a character, others log2(46) bits each.

x is 2x, or -2x-1 where it is negative, in digits of base 46 with the lowest first; all digits of
a number but its last are marked by 46 more. Ours.
"""

from __future__ import annotations

from collections.abc import Iterable

ALPHABET = "".join(chr(k) for k in range(33, 127) if chr(k) not in '"\\')
BASE = len(ALPHABET) // 2


def packed(values: Iterable[int]) -> str:
    """The integers one after another.

    >>> packed([0, -1, 3, 1000])
    '!#(gM'
    """
    return "".join(map(packed_integer, values))


def packed_integer(x: int) -> str:
    """One of them."""
    rest = 2 * x if x >= 0 else -2 * x - 1
    digits = []
    while rest >= BASE:
        rest, digit = divmod(rest, BASE)
        digits.append(ALPHABET[digit + BASE])
    return "".join(digits) + ALPHABET[rest]
