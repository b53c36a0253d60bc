"""Arguments, results and errors as JSON holds them: no pickle in a file that is kept."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import isfinite
from numbers import Integral, Real
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.potentials.potential import Potential
from symfpu.errors import InputError, SymfpuError
from symfpu.results.numbers import exact_text
from symfpu.results.result import Result

Json = dict[str, Any]

NOT_SAID = ("args", "kind")  # of an error's numbers
LARGEST_INTEGER = 2**53  # in JSON: what all readers keep
BITS_A_DIGIT = 3.32


def argument_value(value: Any, name: str) -> Any:
    """An argument as JSON: the same value has the same text. InputError for what has none.

    >>> argument_value((1, 4), "seeds"), argument_value(Chain(8, beta="1/10"), "chain")
    ([1, 4], {'N': 8, 'alpha': '0', 'beta': '0.1'})
    """
    if isinstance(value, Chain):
        return value.typed | {"N": "N" if value.symbolic else value.N}
    if isinstance(value, Potential):
        return value.text
    if name == "chain" and isinstance(value, Mapping):
        return _chain_value(value)
    if isinstance(value, Mapping):
        return {str(key): argument_value(item, name) for key, item in value.items()}
    if isinstance(value, tuple | list | np.ndarray):
        return [argument_value(item, name) for item in value]
    if value is None or isinstance(value, str | bool | np.bool_) or _is_number(value):
        return _scalar(value)
    allowed = "a chain, text, a number, or a tuple, list or mapping of these"
    raise InputError(
        name, value, allowed, "pass what it is made of, in a function of yours"
    )


def _chain_value(given: Mapping[str, Any]) -> Any:
    """A chain by its arguments; those of an impossible one stay as they are."""
    try:
        return argument_value(Chain(**given), "chain")
    except (SymfpuError, TypeError):
        return {str(key): argument_value(item, str(key)) for key, item in given.items()}


def result_value(value: Any) -> Any:
    """A result as JSON: its record if it has one, else numbers, lists and mappings of them.

    Doubles stay numbers, which lose no digit; numbers of more digits and exact ones are text.
    InputError for what is none of these.

    >>> result_value({"ratio": Fraction(1, 3), "size": 0.1, "z": 1j, "bad": float("nan")})
    {'ratio': '1/3', 'size': 0.1, 'z': [0.0, 1.0], 'bad': 'nan'}
    """
    if isinstance(value, Result):
        return value.record()
    if isinstance(value, Mapping):
        return {str(key): result_value(item) for key, item in value.items()}
    if isinstance(value, tuple | list | np.ndarray):
        return [result_value(item) for item in value]
    if value is None or isinstance(value, str | bool | np.bool_) or _is_number(value):
        return _scalar(value)
    allowed = "a result with a record, numbers, text, or lists and mappings of these"
    raise InputError("result", type(value).__name__, allowed, "return what is to be kept")


def _is_number(value: Any) -> bool:
    return isinstance(value, Real | complex | np.number | mpmath.mpf)


def _scalar(value: Any) -> Any:
    if value is None or isinstance(value, str | bool):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, Integral):
        whole = int(value)
        return whole if abs(whole) <= LARGEST_INTEGER else str(whole)
    if isinstance(value, Fraction):
        return exact_text(value)
    if isinstance(value, mpmath.mpf):
        digits = max(17, int(value.man.bit_length() / BITS_A_DIGIT) + 1)
        return str(mpmath.nstr(value, digits))
    if isinstance(value, complex | np.complexfloating):
        return [_scalar(float(value.real)), _scalar(float(value.imag))]
    real = float(value)
    return real if isfinite(real) else str(real)


def error_value(error: BaseException) -> Json:
    """An error as JSON: its class, its message, and the plain numbers that it carries.

    >>> error = InputError("N", 1, "2 or more", "take a longer chain")
    >>> found = error_value(error)
    >>> found["kind"], found["numbers"]["argument"], found["numbers"]["value"]
    ('InputError', 'N', 1)
    """
    carried = {name: value for name, value in vars(error).items() if name not in NOT_SAID}
    numbers = {name: _carried(value) for name, value in carried.items() if name[0] != "_"}
    return {"kind": type(error).__name__, "message": str(error), "numbers": numbers}


def _carried(value: Any) -> Any:
    """What an error carries; results and other objects as their text."""
    try:
        return repr(value) if isinstance(value, Result) else result_value(value)
    except InputError:
        return repr(value)
