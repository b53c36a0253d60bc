"""What holds for a whole table: the kind of result, the version, the chain as it is typed."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from numbers import Integral, Real
from typing import Any, Protocol

from symfpu import __version__
from symfpu.numbers.typed import decimal

Attributes = dict[str, Any]

DIMENSIONLESS = "dimensionless"
RADIANS = "radians"


class SomeChain(Protocol):
    """What a table says of a chain."""

    @property
    def N(self) -> int: ...
    @property
    def ends(self) -> str: ...
    @property
    def typed_law(self) -> dict[str, str]: ...


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
    """A value as a netCDF file can hold it: whole numbers, doubles, text and lists of numbers.

    Exact numbers and those of many digits become text, as they are typed. Lists of text become
    one text, mappings one line of "key: value".

    >>> plain((Fraction(1, 3), Fraction(1, 2))), plain({1: 0.5}), plain((1, 2)), plain(True)
    ('1/3, 0.5', '1: 0.5', [1, 2], 'True')
    """
    if isinstance(value, Mapping):
        return ", ".join(f"{key}: {plain(item)}" for key, item in value.items())
    if isinstance(value, tuple | list):
        items = list(map(plain, value))
        numbers = all(isinstance(item, int | float) for item in items)
        return items if items and numbers else ", ".join(map(str, items))
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Fraction):
        return decimal(value)
    return float(value) if isinstance(value, Real) else str(value)
