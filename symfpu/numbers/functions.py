"""Functions that the laws of bonds need, for doubles, long doubles and mpf, numbers and arrays.

Loops compile them through symfpu.chain.bond_loops.
"""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

TERMS = 24  # of e^x - 1 - x for |x| < 1: enough for long doubles


def exp(x: Any) -> Any:
    """e^x."""
    return _EXP(x) if _multiprecision(x) else np.exp(x)


def expm1(x: Any) -> Any:
    """e^x - 1 without cancellation."""
    return _EXPM1(x) if _multiprecision(x) else np.expm1(x)


def log1p(x: Any) -> Any:
    """log(1 + x) without cancellation; not a number for x < -1, minus infinity at -1."""
    if _multiprecision(x):
        return _LOG1P(x)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.log1p(x)


def expm2(x: Any) -> Any:
    """e^x - 1 - x without cancellation."""
    if _multiprecision(x):
        return _EXPM2(x)
    if isinstance(x, float):  # the same, without the cost of small arrays
        number = float(x)
        value = expm2_series(number) if abs(number) < 1 else np.expm1(number) - number
        return np.float64(value)
    small = np.where(np.abs(x) < 1, x, 0 * x)
    far = np.where(np.abs(x) < 1, 0 * x, x)
    return np.where(np.abs(x) < 1, expm2_series(small), np.expm1(far) - far)


def expm2_series(x: Any) -> Any:
    """The same by its Taylor series, for |x| < 1."""
    value = 1.0 + 0.0 * x
    for k in range(TERMS, 2, -1):
        value = 1.0 + x / k * value
    return 0.5 * x * x * value


def _multiprecision(x: Any) -> bool:
    if isinstance(x, np.ndarray):
        return bool(x.dtype == object)
    return isinstance(x, mpmath.mpf)


def _expm2(x: Any) -> Any:
    # twice the bits that x is below one by: 1 + x cancels
    lost = max(0, -2 * mpmath.mag(x)) if x else 0
    with mpmath.workprec(mpmath.mp.prec + lost + 10):
        value = mpmath.expm1(x) - x
    return +value


def _log1p(x: Any) -> Any:
    return mpmath.log1p(x) if x >= -1 else mpmath.nan


_EXP, _EXPM1, _LOG1P, _EXPM2 = (
    np.frompyfunc(f, 1, 1) for f in (mpmath.exp, mpmath.expm1, _log1p, _expm2)
)
