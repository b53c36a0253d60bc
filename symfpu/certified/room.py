"""Dense matrices of a proof, refused before they are allocated where they would not fit."""

from __future__ import annotations

import psutil

from symfpu.errors import InputError

ADVICE = (
    "take a shorter chain, or an orbit of a higher mode: unknowns go as N Omega_(N-1)/omega"
)


def require_room(N: int, rows: int, columns: int, arrays: int) -> None:
    """InputError where so many arrays of doubles of this size exceed the free memory."""
    needed, free = 8 * arrays * rows * columns, psutil.virtual_memory().available
    if needed > free:
        allowed = (
            f"what fits into the {free:,} bytes of free memory: its proof has {columns:,} "
            f"unknowns at once and needs about {needed:,}"
        )
        raise InputError("orbit", f"of N = {N}", allowed, ADVICE)
