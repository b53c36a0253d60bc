"""Numbers and chains of a result as text, and back without executing anything."""

from __future__ import annotations

import re
from typing import Any

import mpmath
from mpmath import libmp

from symfpu.chain.chain import Chain
from symfpu.chain.ends import ENDS
from symfpu.chain.potentials.potential import Potential
from symfpu.chain.potentials.typed import potential_of_text
from symfpu.errors import InputError
from symfpu.files.archive import Json
from symfpu.numbers.arithmetic import text
from symfpu.numbers.typed import fraction, fraction_text, integer

SYMBOL = "N"  # of a chain whose length is no number
FIXED = "fixed"  # the ends of chains that name none


class UnknownPotential(ValueError):
    """The potential of a file that this symfpu cannot make."""

    def __init__(self, written: str) -> None:
        super().__init__(f"holds a chain of the potential {written!r:.60}")


def number_entry(value: Any) -> str | dict[str, str]:
    """A double as its shortest decimal, or an mpf by its bits.

    Of an mpf, the hexadecimal mantissa and the binary exponent, with a decimal to read.

    An mpf as hexadecimal mantissa and binary exponent, with a decimal to read.
    """
    if not isinstance(value, mpmath.mpf):
        if float(value) != value:
            raise InputError(
                "result", value, "doubles and mpf as its numbers", "convert them"
            )
        return repr(float(value))
    if not mpmath.isfinite(value):
        raise InputError(
            "result", value, "finite numbers", "solve for the amplitudes again"
        )
    sign, mantissa, exponent, bits = value._mpf_
    exact = f"{'-' if sign else ''}{int(mantissa):#x}p{exponent}"
    return {"exact": exact, "decimal": text(value, max(1, bits * 3 // 10))}


def number(entry: Any) -> Any:
    """The number of such an entry, to the last bit."""
    if isinstance(entry, str):
        return float(entry)
    found = re.fullmatch(r"(-?0x[0-9a-f]+)p(-?\d{1,18})", entry["exact"], re.ASCII)
    if not found:
        raise ValueError(f"{entry['exact']!r:.40} is no binary number")
    return mpmath.mp.make_mpf(libmp.from_man_exp(int(found[1], 16), int(found[2])))


def chain_entries(chain: Chain) -> Json:
    """A chain as exact text: alpha and beta of an FPU chain, the potential of any other.

    The ends of a ring are named.
    """
    N = SYMBOL if chain.symbolic else int(chain.N)
    ends = {"ends": chain.ends} if chain.periodic else {}
    if chain.fpu:
        alpha, beta = map(fraction_text, chain.couplings)
        return {"N": N, "alpha": alpha, "beta": beta, **ends}
    return {"N": N, "potential": potential_entry(chain.potential), **ends}


def potential_entry(potential: Potential) -> str:
    """A potential as it is typed; InputError where that would not give it back."""
    try:
        kept = potential_of_text(potential.text) == potential
    except InputError:
        kept = False
    if not kept:
        allowed = "a potential that its text gives back"
        advice = "take shorter numbers for it"
        raise InputError("potential", potential.text, allowed, advice)
    return potential.text


def chain_from(body: Json, ends: str = FIXED) -> Chain:
    """The chain of such entries; UnknownPotential where its potential is no known one.

    ends : those that it must have; ValueError for others.
    """
    N = SYMBOL if body["N"] == SYMBOL else integer(body["N"], "N", 2)
    if body.get("ends", FIXED) != ends or ends not in ENDS:
        raise ValueError(f"a chain with {body.get('ends')!r:.40} ends, not {ends}")
    if "potential" not in body:
        couplings = fraction(body["alpha"]), fraction(body["beta"])
        return Chain(N, *couplings, ends=ends)
    written = str(body["potential"])
    try:
        return Chain(N, potential=potential_of_text(written), ends=ends)
    except InputError as error:
        raise UnknownPotential(written) from error
