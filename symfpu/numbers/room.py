"""What arrays need is compared with the free memory before they are made."""

from __future__ import annotations

import bisect
from collections.abc import Callable

import psutil

from symfpu.errors import InputError, what_fits


def require_room(argument: str, value: int, needed: Callable[[int], int]) -> None:
    """InputError where the bytes of an argument do not fit; it names the largest that does.

    needed : bytes by the value of the argument, which grow with it.
    """
    free = psutil.virtual_memory().available
    if needed(value) <= free:
        return
    largest = bisect.bisect_right(range(value), free, key=needed) - 1
    raise InputError(
        argument, value, what_fits(needed(value), free), f"take {largest} or less"
    )
