"""Which Toda chain a chain is compared with."""

from __future__ import annotations

from fractions import Fraction

from symfpu.chain.chain import Chain, require_any_chain
from symfpu.errors import InputError
from symfpu.numbers.typed import Number, exact


def toda_coupling(chain: Chain, a: Number | None) -> Fraction:
    """a as given, else c_3 of the chain: its own of a Toda chain; InputError where it is zero."""
    require_any_chain(chain)
    if chain.symbolic:
        advice = "put a number for N: chain.at(N=32)"
        raise InputError("chain", chain, "a chain of so many bonds", advice)
    coupling = chain.potential.coefficient(3) if a is None else exact(a, "a")
    if coupling == 0:
        advice = "name the Toda chain to compare with: a = 0 is the harmonic chain"
        raise InputError("a", 0, "a number other than zero", advice)
    return coupling


def gap_numbers(chain: Chain) -> tuple[int, ...]:
    """The gap of every mode, in the order of the modes.

    With fixed ends their numbers are the same. On a ring gap k is the wave cos(2 pi k j/N + omega
    t), and mode q the wave that moves the other way.
    """
    if not chain.periodic:
        return tuple(chain.mode_numbers)
    return tuple(-q % chain.N for q in chain.mode_numbers)
