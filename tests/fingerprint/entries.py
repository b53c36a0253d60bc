"""What the fingerprint keeps of a value, and when two of them agree.

Numbers are kept with 15 digits, as text; whole numbers, words and fractions as they are. An entry says what may move between machines:
AVX2 and AVX-512, or another BLAS, add in another order.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from numbers import Integral
from typing import Any

import mpmath
import numpy as np

from tests.tolerances import LEAST_OF_DOUBLES

# how far two values of an entry may differ: relative to the largest number of its list, and absolutely
WITHIN = {
    "exact": (0.0, 0.0),  # decided in integers: nothing may move
    "digits": (2e-15, 0.0),  # computed with many digits: one unit in the last of fifteen
    "rounding": (1e-12, 0.0),  # a few thousand operations on doubles
    "solver": (1e-9, 0.0),  # an equation solved in doubles, or errors that a matrix enlarges
    "sampled": (1e-6, 0.0),  # fits and frequencies of an orbit, times of crossings
    "magnitude": (0.1, 0.0),  # a quotient of noise
    "noise": (1e-6, 1e-12),  # residuals and errors: what rounding leaves has no digits
}
FACTOR = 1e3  # noise of many digits, below the absolute bound, is compared as a magnitude
NOISY = re.compile(
    r"residual|error|symplecticity|map_error|asymmetry|newton|rounding|radius|bound|error_of|uncertainty|drift$|coefficient$|^distance$"
)
ROUGH = {"longest"}  # what is divided by noise
LEFT_OUT = {"symfpu_version", "seconds", "provenance", "created"}  # of this run, not of the result
NUMBER = re.compile(r"[-+]?\d+\.\d*(?:e[-+]?\d+)?|[-+]?\d+e[-+]?\d+|[-+]?(?:inf|nan)", re.IGNORECASE)
WORDED = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")  # numbers in a sentence


@dataclass(frozen=True)
class Within:
    """A value with its class, where the usual one does not do."""

    name: str
    value: Any


def exact(value: Any) -> Within:
    return Within("exact", value)


def solver(value: Any) -> Within:
    return Within("solver", value)


def sampled(value: Any) -> Within:
    return Within("sampled", value)


def noise(value: Any) -> Within:
    return Within("noise", value)


def entry(value: Any) -> dict[str, Any]:
    """The class and the text of a value; numbers of many digits are compared as such."""
    if isinstance(value, Within):
        return {"within": value.name, "value": plain(value.value)}
    if isinstance(value, np.ndarray):
        value = value.tolist()  # of no dimension: a number
    if isinstance(value, dict) and "kind" in value and "symfpu_version" in value:
        return {"within": "solver", "value": plain(value)}  # a record
    return {"within": _usual(value), "value": plain(value)}


def _usual(value: Any) -> str:
    leaves = list(_leaves(value))
    if any(isinstance(leaf, mpmath.mpf | mpmath.mpc) for leaf in leaves):
        return "digits"
    inexact = any(isinstance(leaf, float | complex | np.inexact) for leaf in leaves)
    return "rounding" if inexact else "exact"


def _leaves(value: Any) -> Any:
    if isinstance(value, Mapping):
        for item in value.values():
            yield from _leaves(item)
    elif isinstance(value, list | tuple):
        for item in value:
            yield from _leaves(item)
    else:
        yield value


def plain(value: Any) -> Any:
    """As JSON keeps it."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items() if key not in LEFT_OUT}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple | range):
        return [plain(item) for item in value]
    if value is None or isinstance(value, bool | np.bool_):
        return None if value is None else bool(value)
    if isinstance(value, Integral):
        return int(value) if abs(int(value)) < 10**15 else str(int(value))
    if isinstance(value, Fraction):
        return str(value)
    if isinstance(value, complex | np.complexfloating | mpmath.mpc):
        return [fifteen(value.real), fifteen(value.imag)]
    if isinstance(value, float | np.floating | mpmath.mpf):
        return fifteen(value)
    words = str(value)
    return fifteen(mpmath.mpf(words)) if NUMBER.fullmatch(words) else words


def fifteen(value: Any) -> str:
    """A number with 15 digits; the sign of a zero is none."""
    if isinstance(value, mpmath.mpf) and mpmath.isfinite(value):
        with mpmath.workdps(40):
            found = mpmath.nstr(value, 15, strip_zeros=False, min_fixed=0, max_fixed=0)
        return "0" if value == 0 else found
    return "0" if value == 0 else f"{float(value):.14e}"


def differences(old: Any, new: Any, within: str, key: str = "") -> list[str]:
    """Where two plain values do not agree, each as a line with both."""
    return list(_differ(old, new, within, key, None))


def _differ(old: Any, new: Any, within: str, key: str, scale: float | None) -> Any:
    if isinstance(old, dict) and isinstance(new, dict):
        yield from _differ_by_key(old, new, within, key)
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        largest = max((abs(float(x)) for x in old if _is_number(x)), default=None)
        shared = max(filter(None, (scale, largest)), default=None)
        for place, pair in enumerate(zip(old, new, strict=True)):
            yield from _differ(*pair, within, f"{key}[{place}]", shared)
    elif not _agree(old, new, within, scale):
        yield f"{key}: was {_short(old)}, is {_short(new)}"


def _differ_by_key(old: dict[str, Any], new: dict[str, Any], within: str, key: str) -> Any:
    for name in [*old, *(name for name in new if name not in old)]:
        inner = f"{key}.{name}" if key else name
        if name not in old:
            yield f"{inner}: was not there, is {_short(new[name])}"
        elif name not in new:
            yield f"{inner}: was {_short(old[name])}, is not there"
        else:
            yield from _differ(old[name], new[name], _within(name, within), inner, None)


def _within(name: str, within: str) -> str:
    """The class of what has this name in a record."""
    if within == "exact":
        return within
    if name in ROUGH:
        return "magnitude"
    return "noise" if NOISY.search(name) else within


def _is_number(value: Any) -> bool:
    return isinstance(value, str) and (value == "0" or NUMBER.fullmatch(value) is not None)


def _agree(old: Any, new: Any, within: str, scale: float | None) -> bool:
    if old == new:
        return True
    if within == "noise" and isinstance(old, int) and isinstance(new, int):
        return True  # steps and products of an iteration
    if isinstance(old, str) and isinstance(new, str):
        if _is_number(old) and _is_number(new):
            return _near(float(old), float(new), within, scale)
        return within != "exact" and _same_words(old, new)
    return False


def _near(old: float, new: float, within: str, scale: float | None) -> bool:
    relative, absolute = WITHIN[within]
    if not math.isfinite(old) or not math.isfinite(new):
        return str(old) == str(new)
    if within == "noise" and new == 0 and abs(old) > LEAST_OF_DOUBLES:
        return abs(old) < absolute
    if within == "noise" and 0 < abs(old) < absolute * 1e-4:
        return abs(old) / FACTOR < abs(new) < abs(old) * FACTOR
    return abs(new - old) <= relative * max(scale or 0.0, abs(old)) + absolute


def _same_words(old: str, new: str) -> bool:
    """Sentences that differ in the last digits of their numbers at most."""
    if WORDED.split(old) != WORDED.split(new):
        return False
    pairs = zip(WORDED.findall(old), WORDED.findall(new), strict=True)
    return all(_same_number(a, b) for a, b in pairs)


def _same_number(old: str, new: str) -> bool:
    """To one unit in the last digit that is printed."""
    if not all(set(number) & set(".e") for number in (old, new)):
        return old == new
    unit = max(10.0 ** Decimal(number).as_tuple().exponent for number in (old, new))
    change, size = abs(float(new) - float(old)), max(abs(float(old)), abs(float(new)))
    return size < WITHIN["noise"][1] or change <= max(1.01 * unit, WITHIN["solver"][0] * size)


def _short(value: Any) -> str:
    shown = str(value)
    return shown if len(shown) <= 80 else f"{shown[:77]}..."
