"""Seed sets by name, so that one packet is meant at every length of the chain."""

from __future__ import annotations

from fractions import Fraction

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.typed import seed_modes

PLACES = ("low", "middle", "high")
ALLOWED = "modes such as 1,2, or low:2, middle:1/16, high:3"
ADVICE = "a packet has s modes, or the part M of the N modes"


def packet_modes(chain: Chain, packet: str) -> tuple[int, ...]:
    """The modes of a packet on this chain, rising.

    packet : modes such as "1,2"; or "low:s", 1 .. s, "middle:s", the s modes beyond N/2, and
        "high:s", N-s .. N-1, where s is a number of modes or, below 1, a part M of N: s = M N.

    Raises InputError for another text, a part that gives no whole number, and modes that the
    chain does not have.

    >>> [packet_modes(Chain(N=32, beta=1), name) for name in ("1,5", "middle:2", "high:1/16")]
    [(1, 5), (17, 18), (30, 31)]
    """
    place, colon, size = packet.partition(":")
    if not colon:
        return tuple(sorted(seed_modes(_modes(packet), chain.N)))
    if place not in PLACES:
        raise InputError("packet", packet, ALLOWED, ADVICE)
    count = _count(chain, packet, size)
    first = {"low": 1, "middle": chain.N // 2 + 1, "high": chain.N - count}[place]
    return tuple(sorted(seed_modes(range(first, first + count), chain.N)))


def _modes(text: str) -> list[int]:
    try:
        return [int(word) for word in text.split(",")]
    except ValueError:
        raise InputError("packet", text, ALLOWED, ADVICE) from None


def _count(chain: Chain, packet: str, size: str) -> int:
    try:
        asked = Fraction(size)
    except (ValueError, ZeroDivisionError):
        raise InputError("packet", packet, ALLOWED, ADVICE) from None
    count = asked * chain.N if asked < 1 else asked
    if count < 1 or count.denominator != 1:
        allowed = f"a whole number of modes, 1 or more; for N = {chain.N} it is {count}"
        raise InputError("packet", packet, allowed, ADVICE)
    return int(count)
