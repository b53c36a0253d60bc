"""How a case is written: a function without arguments that yields names and values."""

from collections.abc import Callable, Iterator
from typing import Any

Case = Callable[[], Iterator[tuple[str, Any]]]
CASES: dict[str, Case] = {}


def case(function: Case) -> Case:
    """Adds it to the list, by its module and name."""
    room = function.__module__.rpartition(".")[2]
    CASES[f"{room}/{function.__name__}"] = function
    return function
