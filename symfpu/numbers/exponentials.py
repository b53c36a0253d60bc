"""e^x - 1 and log(1 + x) inside compiled loops, for numbers and for all lanes at once.

Importing this module imports numba, whose overloads have no annotations. There are no calls and no
branches, only sums, products, quotients and choices, each rounded as it is: a lane has the bits of
a number alone, on every machine. Errors are below 1.1 units in the last place
(tests/numbers/test_exponentials.py), those of log(1 + x) below 0.8.

Reductions are those of Tang, ACM TOMS 15 (1989) 144 and 16 (1990) 378: x = k log 2 + r and
1 + x = 2^k (1 + f), log 2 in two parts of which the first times k is exact.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic, overload

from symfpu.numbers.lanes import LANES, LanesType

__all__ = ["expm1_loop", "log1p_loop"]

# log 2 to 33 bits, and what is left of it
LOG2_HEAD, LOG2_TAIL = (
    float.fromhex("0x1.62e42fee00000p-1"),
    float.fromhex("0x1.a39ef35793c76p-33"),
)
PER_LOG2 = 1 / math.log(2)
WHOLE = 1.5 * 2.0**52  # plus x is rounded to whole numbers
MANTISSA = 52
BIAS = 1023
ROOT_HALF = 0x3FE6A09E00000000  # the bits of sqrt(1/2)
# e^x - 1 is -1 to the last bit below, infinite above
LEAST, MOST = -50.0, 710.0
TINY = 2.0**-54  # of whose size e^x - 1 is x

# ((e^r - 1 - r)/r^2 - 1/2)/r, |r| < 0.35, to 1e-18
E = tuple(1 / math.factorial(n + 3) for n in range(12))
# (log((1 + s)/(1 - s))/s - 2)/s^2, |s| < 0.172, to 1e-17
L = tuple(2 / (2 * n + 3) for n in range(10))

_intrinsic: Any = intrinsic
_I64 = ir.IntType(64)


def above(x: Any, y: Any, then: Any, other: Any) -> Any:
    """`then` where x > y, else `other`."""
    return np.where(x > y, then, other)


def power_of_two(shifted: Any) -> Any:
    """2^(k-1) of WHOLE + k."""
    bits = np.asarray(shifted, np.float64).view(np.int64)
    return ((bits << MANTISSA) + ((BIAS - 1) << MANTISSA)).view(np.float64)


def exponent(u: Any) -> Any:
    """k of u = 2^k m, sqrt(1/2) <= m < sqrt(2)."""
    bits = np.asarray(u, np.float64).view(np.int64)
    return ((bits - ROOT_HALF) >> MANTISSA).astype(np.float64)


def mantissa(u: Any) -> Any:
    """The m of it."""
    bits = np.asarray(u, np.float64).view(np.int64)
    return (((bits - ROOT_HALF) & (2**MANTISSA - 1)) + ROOT_HALF).view(np.float64)


def expm1_loop(x: Any) -> Any:
    """e^x - 1 = 2^k (1 + r + q) - 1, where q is of the size of r^2/2."""
    inside = above(x, MOST, MOST, x)
    inside = above(LEAST, inside, LEAST, inside)
    shifted = inside * PER_LOG2 + WHOLE
    k = shifted - WHOLE
    head, tail = inside - k * LOG2_HEAD, k * LOG2_TAIL
    r = head - tail
    lost = (head - r) - tail
    z = r * r
    w = z * z
    even = (E[1] + z * E[3]) + w * ((E[5] + z * E[7]) + w * (E[9] + z * E[11]))
    odd = (E[0] + z * E[2]) + w * ((E[4] + z * E[6]) + w * (E[8] + z * E[10]))
    q = (0.5 * z + z * (r * odd + z * even)) + (lost + lost * r)
    half = power_of_two(shifted)  # of the power: that of the largest x overflows
    whole, part = half - 0.5, half * r
    value = whole + part
    value = 2.0 * (value + ((whole - value) + part + half * q))
    return above(inside, -TINY, above(TINY, inside, x, value), value)


def log1p_loop(x: Any) -> Any:
    """log(1 + x) = k log 2 + log(1 + f) + c/u, where u = 1 + x - c is rounded."""
    u = 1.0 + x
    most = u - 1.0
    k = exponent(u)
    c = ((x - most) + (1.0 - (u - most))) / u
    rounded = above(k * k, 0.5, 1.0, 0.0)  # where k = 0, f is x itself
    c = rounded * c
    f = above(rounded, 0.5, mantissa(u) - 1.0, x)
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    even = L[0] + w * (L[2] + w * (L[4] + w * (L[6] + w * L[8])))
    odd = L[1] + w * (L[3] + w * (L[5] + w * (L[7] + w * L[9])))
    square = 0.5 * f * f
    small = s * (square + z * (even + z * odd)) + (k * LOG2_TAIL + c)
    value = k * LOG2_HEAD - ((square - small) - f)
    value = above(math.inf, x, value, x)
    edge = above(-1.0, x, math.nan, -math.inf)
    return above(x, -1.0, value, above(-0.5, x, edge, x))


def _kind(*kinds: Any) -> Any:
    """Lanes if one of them is, else a number."""
    return next((kind for kind in kinds if isinstance(kind, LanesType)), types.float64)


def _same_shape(kind: Any, element: Any) -> Any:
    return ir.VectorType(element, LANES) if isinstance(kind, LanesType) else element


def _constant(of_type: Any, value: int) -> Any:
    vector = isinstance(of_type, ir.VectorType)
    return ir.Constant(of_type, [value] * LANES if vector else value)


@_intrinsic
def _above(context, x, y, then, other):  # type: ignore[no-untyped-def]
    def build(target, builder, signature, values):  # type: ignore[no-untyped-def]
        x, y, then, other = values
        return builder.select(builder.fcmp_ordered(">", x, y), then, other)

    kind = _kind(x, y, then, other)
    return kind(kind, kind, kind, kind), build


def _of_bits(change: Any) -> Any:
    """An intrinsic: a number whose bits, as a whole number, are changed by a builder."""

    @_intrinsic
    def of_bits(context, x):  # type: ignore[no-untyped-def]
        def build(target, builder, signature, values):  # type: ignore[no-untyped-def]
            integers = _same_shape(x, _I64)
            bits = builder.bitcast(values[0], integers)
            made = change(builder, bits, lambda value: _constant(integers, value))
            return builder.bitcast(made, _same_shape(x, ir.DoubleType()))

        return x(x), build

    return of_bits


def _build_power(builder: Any, bits: Any, whole: Any) -> Any:
    shifted = builder.shl(bits, whole(MANTISSA))
    return builder.add(shifted, whole((BIAS - 1) << MANTISSA))


def _build_exponent(builder: Any, bits: Any, whole: Any) -> Any:
    """2^52 + BIAS + k: before AVX-512 no instruction makes doubles of long integers."""
    moved = builder.add(bits, whole((BIAS << MANTISSA) - ROOT_HALF))
    return builder.or_(builder.lshr(moved, whole(MANTISSA)), whole(_TWO_52))


def _build_mantissa(builder: Any, bits: Any, whole: Any) -> Any:
    moved = builder.sub(bits, whole(ROOT_HALF))
    return builder.add(builder.and_(moved, whole(2**MANTISSA - 1)), whole(ROOT_HALF))


_TWO_52 = (BIAS + MANTISSA) << MANTISSA  # the bits of 2^52
_SHIFTED_EXPONENT = 2.0**MANTISSA + BIAS
_power_of_bits, _exponent_of_bits, _mantissa_of_bits = map(
    _of_bits, (_build_power, _build_exponent, _build_mantissa)
)


@overload(above, jit_options={"forceinline": True})
def _choose(x, y, then, other):  # type: ignore[no-untyped-def]
    return lambda x, y, then, other: _above(x, y, then, other)


@overload(power_of_two, jit_options={"forceinline": True})
def _power_of_two(shifted):  # type: ignore[no-untyped-def]
    return lambda shifted: _power_of_bits(shifted)


@overload(exponent, jit_options={"forceinline": True})
def _exponent(u):  # type: ignore[no-untyped-def]
    return lambda u: _exponent_of_bits(u) - _SHIFTED_EXPONENT


@overload(mantissa, jit_options={"forceinline": True})
def _mantissa(u):  # type: ignore[no-untyped-def]
    return lambda u: _mantissa_of_bits(u)
