"""Counts in words, of one thing and of several."""

from __future__ import annotations

import math


def counted(count: int, one: str, several: str = "") -> str:
    """A number and what it counts; several : the plural, default with an s.

    >>> from symfpu.numbers.counted import counted
    >>> counted(1, "exponent"), counted(3, "energy", "energies")
    ('1 exponent', '3 energies')
    """
    return f"{count:,} {one if count == 1 else several or one + 's'}"


def short(value: float) -> float | None:
    """A measure for JSON, to six digits; None where it is infinite or not a number.

    >>> short(0.123456789), short(float("inf"))
    (0.123457, None)
    """
    return float(f"{value:.6g}") if math.isfinite(value) else None
