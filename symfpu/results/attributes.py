"""What holds for a whole table: the kind of result, the version, the chain as it is typed."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from numbers import Integral
from typing import Any, Protocol

import numpy as np

from symfpu import __version__
from symfpu.results.numbers import exact_text

Attributes = dict[str, Any]

DIMENSIONLESS = "dimensionless"
RADIANS = "radians"


class SomeChain(Protocol):
    """What results say of a chain."""

    @property
    def N(self) -> int: ...
    @property
    def ends(self) -> str: ...
    @property
    def typed_law(self) -> dict[str, str]: ...
    @property
    def typed(self) -> dict[str, Any]: ...
    @property
    def label(self) -> str: ...


def attributes(result: object, chain: SomeChain | None = None, **more: Any) -> Attributes:
    """Of a result; what is None is left out.

    chain : of the result, if it knows it. more : by name, written as `plain` does.
    """
    known: Attributes = {"result": type(result).__name__, "symfpu_version": __version__}
    known["units"] = DIMENSIONLESS
    if chain is not None:
        known |= {"chain": repr(chain), "N": chain.N}
        known |= chain.typed_law
        known["ends"] = chain.ends
    others = {name: plain(value) for name, value in more.items() if value is not None}
    return known | others


def plain(value: Any) -> Any:
    """A value as a netCDF file can hold it: a whole number, a double or text.

    Exact numbers and those of many digits become text, as they are typed; lists and mappings too.

    >>> plain((Fraction(1, 3), Fraction(1, 2))), plain({1: 0.5}), plain((1, 2)), plain(True)
    ('1/3, 0.5', '1: 0.5', '1, 2', 'True')
    """
    if isinstance(value, Mapping):
        return ", ".join(f"{key}: {plain(item)}" for key, item in value.items())
    if isinstance(value, tuple | list):
        return ", ".join(str(plain(item)) for item in value)
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Fraction):
        return exact_text(value)
    return float(value) if isinstance(value, float | np.floating) else str(value)
