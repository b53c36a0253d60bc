"""Numbers that a file holds besides coefficients, correctly rounded to doubles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

import mpmath

from symfpu.algebra.grading import Ints

WORK_DIGITS = 60  # from which numbers are rounded, or split into several doubles


def turns(frequencies: Iterable[Fraction]) -> list[tuple[float, float]]:
    """omega / 2 pi of every seed as the sum of two doubles."""
    pairs = []
    with mpmath.workdps(WORK_DIGITS):
        for w in frequencies:
            exact = mpmath.mpf(w.numerator) / w.denominator
            pairs.append(_two_doubles(exact / (2 * mpmath.pi)))
    return pairs


def inverse_turn() -> tuple[float, float]:
    """1 / 2 pi as the sum of two doubles."""
    with mpmath.workdps(WORK_DIGITS):
        return _two_doubles(1 / (2 * mpmath.pi))


def _two_doubles(exact: Any) -> tuple[float, float]:
    high = float(exact)
    return high, float(exact - high)


def rates(harmonics: Ints, frequencies: Sequence[Fraction]) -> list[float]:
    """nu.omega of harmonics (H, s)."""
    values = []
    for nu in harmonics.tolist():
        products = (n * w for n, w in zip(nu, frequencies, strict=True))
        values.append(float(sum(products)))
    return values


def bond_cosines(N: int) -> list[float]:
    """cos(k pi / 2N) for k = 0 .. 4N-1."""
    with mpmath.workdps(WORK_DIGITS):
        angles = [mpmath.mpf(k) / (2 * N) for k in range(4 * N)]
        return [float(mpmath.cospi(x)) for x in angles]


def bond_norm(N: int) -> float:
    """sqrt(2/N)."""
    with mpmath.workdps(WORK_DIGITS):
        return float(mpmath.sqrt(mpmath.mpf(2) / N))
