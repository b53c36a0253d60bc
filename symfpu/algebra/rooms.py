"""Memory for products, which come and go degree by degree.

Fresh memory of the size of a product takes longer than the work on it: the system clears it page
by page. A room is cleared once, and let again when its last tenant is forgotten.
"""

from __future__ import annotations

import weakref
from math import prod
from typing import Any

from symfpu.algebra.dense import Floats, aligned_zeros


class Rooms:
    """Arrays of doubles of up to `largest` entries; what they hold at first is left from others."""

    def __init__(self, largest: int) -> None:
        self._largest = largest
        self._rooms: list[tuple[Floats, weakref.ref[Any]]] = []

    def take(self, shape: tuple[int, ...]) -> Floats:
        """An array, until nothing refers to it; parts of it do not count."""
        free = [n for n, (_, tenant) in enumerate(self._rooms) if tenant() is None]
        memory = self._rooms.pop(free[0])[0] if free else aligned_zeros((self._largest,))
        tenant = memory[: prod(shape)].reshape(shape)
        self._rooms.append((memory, weakref.ref(tenant)))
        return tenant
