"""Potentials as they are typed: "toda:1/2", "poly:0.33,0,1/5", "lj:12,6"."""

from __future__ import annotations

import pkgutil
from collections.abc import Callable
from functools import cache
from importlib import import_module

from symfpu.chain import potentials
from symfpu.chain.potentials.potential import Potential, require_consistent
from symfpu.errors import InputError

EXAMPLES = "such as toda:1/2, poly:0.33,0,1/5 or lj:12,6"


@cache
def kinds() -> dict[str, Callable[..., Potential]]:
    """The functions that make potentials, by name: one in each file that is named after it."""
    found: dict[str, Callable[..., Potential]] = {}
    for module in pkgutil.iter_modules(potentials.__path__):
        home = import_module(f"{potentials.__name__}.{module.name}")
        make = getattr(home, module.name, None)
        if make is not None:
            found[module.name] = make
            found |= dict.fromkeys(getattr(home, "OTHER_NAMES", ()), make)
    return found


def potential_of_text(text: str) -> Potential:
    """The potential that a text such as "toda:1/2" names.

    Raises InputError for an unknown name and for numbers that the potential does not take.

    >>> potential_of_text("lj:12,6")
    lennard_jones(12, 6)
    """
    name, _, numbers = text.strip().partition(":")
    make = kinds().get(name.strip())
    if make is None:
        known = ", ".join(sorted(kinds()))
        raise InputError("potential", text, f"one of {known}", f"write it {EXAMPLES}")
    values = [value.strip() for value in numbers.split(",")] if numbers.strip() else []
    try:
        return make(*values)
    except TypeError as error:
        allowed = f"a potential with its numbers, {EXAMPLES}"
        raise InputError("potential", text, allowed, "give the numbers it takes") from error


def potential_given(value: object) -> Potential:
    """A potential as it was given, or as typed; InputError for anything else.

    And for one that contradicts itself.
    """
    if isinstance(value, str):
        value = potential_of_text(value)
    if not isinstance(value, Potential):
        allowed = "a potential, or a text such as 'toda:1/2'"
        raise InputError("potential", value, allowed, "write potential=toda('1/2')")
    require_consistent(value)
    return value
