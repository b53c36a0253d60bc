"""Which Toda chain a chain is compared with."""

from __future__ import annotations

from fractions import Fraction

from symfpu.chain.chain import Chain, require_chain
from symfpu.errors import InputError
from symfpu.numbers.typed import Number, exact


def toda_coupling(chain: Chain, a: Number | None) -> Fraction:
    """a as given, else c_3 of the chain: its own of a Toda chain; InputError where it is zero."""
    require_chain(chain)
    if chain.symbolic:
        advice = "give it a length by chain.at(N=...)"
        raise InputError("chain", chain, "a chain of so many bonds", advice)
    coupling = chain.potential.coefficient(3) if a is None else exact(a, "a")
    if coupling == 0:
        advice = "name the Toda chain to compare with: a = 0 is the harmonic chain"
        raise InputError("a", 0, "a number other than zero", advice)
    return coupling
