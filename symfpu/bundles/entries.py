"""Numbers of a result as text, and back without executing anything."""

from __future__ import annotations

import re
from typing import Any

import mpmath
from mpmath import libmp

from symfpu.errors import InputError
from symfpu.numbers.arithmetic import text


def number_entry(value: Any) -> str | dict[str, str]:
    """A double as its shortest decimal.

    An mpf as hexadecimal mantissa and binary exponent, with a decimal to read.
    """
    if not isinstance(value, mpmath.mpf):
        if float(value) != value:
            raise InputError("result", value, "doubles and mpf as its numbers", "convert them")
        return repr(float(value))
    if not mpmath.isfinite(value):
        raise InputError("result", value, "finite numbers", "solve for the amplitudes again")
    sign, mantissa, exponent, bits = value._mpf_
    return {
        "exact": f"{'-' if sign else ''}{int(mantissa):#x}p{exponent}",
        "decimal": text(value, max(1, bits * 3 // 10)),
    }


def number(entry: Any) -> Any:
    if isinstance(entry, str):
        return float(entry)
    found = re.fullmatch(r"(-?0x[0-9a-f]+)p(-?\d{1,18})", entry["exact"], re.ASCII)
    if not found:
        raise ValueError(f"{entry['exact']!r:.40} is no binary number")
    return mpmath.mp.make_mpf(libmp.from_man_exp(int(found[1], 16), int(found[2])))
