"""The length N of a chain as a symbol, and the modes that are counted from its end."""

from __future__ import annotations

from numbers import Integral
from typing import Any, NoReturn, cast

from symfpu.errors import InputError


class SymbolicLength:
    """N that is no number yet: it prints, it equals itself, and nothing can be computed with it.

    Every other use of it raises InputError, wherever in the package it happens: so whatever takes
    a chain needs no check of its own.
    """

    __slots__ = ()

    def __repr__(self) -> str:
        return "N"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SymbolicLength)

    def __hash__(self) -> int:
        return hash(SymbolicLength)

    def __format__(self, form: str) -> str:
        return repr(self) if not form else self._refuse()

    def _refuse(self, *_: object) -> NoReturn:
        """InputError, with the next step."""
        allowed = "a number where something is computed with it"
        raise InputError("N", "N", allowed, "put a number for N: chain.at(N=32)")

    __array_ufunc__ = None  # NumPy leaves operators to those below
    __int__ = __index__ = __float__ = __bool__ = _refuse
    __neg__ = __pos__ = __abs__ = __round__ = _refuse
    __lt__ = __le__ = __gt__ = __ge__ = _refuse
    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = _refuse
    __truediv__ = __rtruediv__ = __floordiv__ = __rfloordiv__ = _refuse
    __mod__ = __rmod__ = __divmod__ = __rdivmod__ = __pow__ = __rpow__ = _refuse


Integral.register(SymbolicLength)  # a whole number, although nobody knows which


# typed as what it stands for, so that code for numbers stays as it is
LENGTH = cast(int, SymbolicLength())


class HighMode(int):
    """The mode N - b of a chain of any length, kept as the integer -b.

    >>> HighMode(-2), f"Omega_{HighMode(-2)}"
    (N-2, 'Omega_N-2')
    """

    def __repr__(self) -> str:
        return f"N-{-int(self)}"

    __str__ = __repr__


def mode_label(value: Any, argument: str) -> int:
    """A mode of a chain of any length: q from the start, or N - b as 'N-b' from the end.

    Raises InputError for anything else.

    >>> mode_label(3, "q"), mode_label("N-2", "q")
    (3, N-2)
    """
    if isinstance(value, HighMode):
        return value
    if isinstance(value, str):
        start, _, end = value.replace(" ", "").partition("-")
        if start == "N" and end.isdecimal() and int(end) > 0:
            return HighMode(-int(end))
    if not isinstance(value, bool) and isinstance(value, Integral):
        number = int(value)
        if number > 0:
            return number
    allowed = (
        "a mode 1, 2, ... from the start of the spectrum, or 'N-1', 'N-2', ... from its end"
    )
    raise InputError(argument, value, allowed, "count it from one of the ends")


def label_entry(label: int) -> int | str:
    """A label as files keep it: a number, or "N-b". `mode_label` reads it.

    >>> label_entry(3), label_entry(HighMode(-2))
    (3, 'N-2')
    """
    return str(label) if isinstance(label, HighMode) else int(label)


def mode_of(label: int, N: int) -> int:
    """The mode that a label means in a chain of N bonds.

    >>> mode_of(mode_label("N-2", "q"), 32)
    30
    """
    return label % N


def seed_labels(seeds: Any) -> tuple[int, ...]:
    """Distinct modes of a chain of any length, in the given order.

    Raises InputError for anything else.

    >>> seed_labels((1, "N-2"))
    (1, N-2)
    """
    allowed = "distinct modes such as 1, 2 or 'N-1', 'N-2'"
    if isinstance(seeds, str) or not hasattr(seeds, "__iter__"):
        raise InputError("seeds", seeds, allowed, "pass a sequence such as (1, 2)")
    labels = tuple(mode_label(q, "seeds") for q in seeds)
    if not labels:
        raise InputError("seeds", (), allowed, "name at least one seed mode")
    if len(set(labels)) < len(labels):
        raise InputError("seeds", labels, allowed, "name every seed once")
    return labels
