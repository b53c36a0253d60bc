"""Eight doubles at once inside compiled loops: sums, differences and products of lanes.

Importing this module imports numba, whose overloads have no annotations. Lanes are what a loop
takes from a row of an array (n, LANES) and puts back; of an array (n,) it takes one number, so
that one loop serves both. Without the compiler lanes are arrays of NumPy.

Each lane is rounded as one number would be: nothing is fused and nothing reassociated, so that
bits depend neither on how many numbers go together nor on the machine. Vectors of 512 bits hold
the lanes in one piece, shorter ones in two or four.
"""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.core.typeconv.castgraph import Conversion
from numba.extending import intrinsic, lower_cast, models, overload, register_model
from numpy.typing import NDArray

__all__ = [
    "LANES",
    "LanesType",
    "entry",
    "lane",
    "put",
    "total",
    "with_lane",
    "within",
    "zeros",
]

LANES = 8
LINE = 64  # bytes that a processor fetches together; lanes across two of them cost twice

_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_MASK = ir.IntType(LANES)
_PLACE = ir.IntType(32)

# numba's own annotations describe what these are given, not what they make of it
_intrinsic: Any = intrinsic
_lower_cast: Any = lower_cast


class LanesType(types.Type):
    """Of eight doubles, for the compiler; a number becomes eight of its kind."""

    def __init__(self) -> None:
        super().__init__("Lanes")

    def can_convert_from(self, context: Any, other: Any) -> Any:
        return Conversion.safe if isinstance(other, types.Float) else None

    def unify(self, context: Any, other: Any) -> Any:
        return self if isinstance(other, types.Float) else None


_LANES = LanesType()


@register_model(LanesType)
class _Model(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _VECTOR)  # type: ignore[no-untyped-call]


def zeros(shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Zeros, the first of them at the beginning of a line of the cache."""
    size = int(np.prod(shape))
    room = np.zeros(size + LINE // 8)
    first = -room.ctypes.data // 8 % (LINE // 8)
    return room[first : first + size].reshape(shape)


def entry(row: Any, j: Any) -> Any:
    """The number row[j], or the lanes there."""
    return +row[j]


def put(row: Any, j: Any, value: Any) -> None:
    """Sets row[j]."""
    row[j] = value


def total(value: Any) -> float:
    """The sum of the lanes, from the first to the last."""
    return float(functools.reduce(operator.add, value))


def within(value: Any, least: Any, most: Any) -> bool:
    """Whether a number, or every lane, lies between two others."""
    return bool(np.all((value >= least) & (value <= most)))


@_intrinsic
def lane(context, value, place):  # type: ignore[no-untyped-def]
    """The number in one lane."""

    def build(target, builder, signature, values):  # type: ignore[no-untyped-def]
        return builder.extract_element(*values)

    return types.float64(_LANES, types.intp), build


@_intrinsic
def with_lane(context, value, place, number):  # type: ignore[no-untyped-def]
    """The lanes with another number in one of them."""

    def build(target, builder, signature, values):  # type: ignore[no-untyped-def]
        value, place, number = values
        return builder.insert_element(value, number, place)

    return _LANES(_LANES, types.intp, types.float64), build


@_intrinsic
def _load(context, row, j):  # type: ignore[no-untyped-def]
    def build(target, builder, signature, values):  # type: ignore[no-untyped-def]
        return builder.load(_address(target, builder, signature, values), align=8)

    return _LANES(row, types.intp), build


@_intrinsic
def _store(context, row, j, value):  # type: ignore[no-untyped-def]
    def build(target, builder, signature, values):  # type: ignore[no-untyped-def]
        builder.store(values[2], _address(target, builder, signature, values), align=8)
        return target.get_dummy_value()

    return types.void(row, types.intp, _LANES), build


def _address(target: Any, builder: Any, signature: Any, values: Any) -> Any:
    row = target.make_array(signature.args[0])(target, builder, values[0])
    first = builder.mul(values[1], ir.Constant(values[1].type, LANES))
    return builder.bitcast(builder.gep(row.data, [first]), _VECTOR.as_pointer())


def _of_lanes(row: Any) -> bool:
    """Whether the compiler is given an array of lanes, without gaps."""
    return isinstance(row, types.Array) and row.ndim == 2 and row.layout == "C"


@overload(entry)
def _entry(row, j):  # type: ignore[no-untyped-def]
    if _of_lanes(row):
        return lambda row, j: _load(row, j)
    return lambda row, j: row[j]


@overload(put)
def _put(row, j, value):  # type: ignore[no-untyped-def]
    if _of_lanes(row):
        return lambda row, j, value: _store(row, j, value)

    def put_number(row, j, value):  # type: ignore[no-untyped-def]
        row[j] = value

    return put_number


def _spread_number(builder: Any, number: Any) -> Any:
    nowhere = ir.Constant(_VECTOR, ir.Undefined)
    one = builder.insert_element(nowhere, number, ir.Constant(_PLACE, 0))
    places = ir.Constant(ir.VectorType(_PLACE, LANES), [0] * LANES)
    return builder.shuffle_vector(one, nowhere, places)


@_lower_cast(types.Float, LanesType)
def _cast(target, builder, kind, lanes, number):  # type: ignore[no-untyped-def]
    return _spread_number(builder, target.cast(builder, number, kind, types.float64))


def _teach(operation: Callable[..., Any], instruction: str) -> None:
    """Teaches the compiler an operation of lanes, or of lanes and a number."""

    @_intrinsic
    def of_lanes(context, left, right):  # type: ignore[no-untyped-def]
        def build(target, builder, signature, values):  # type: ignore[no-untyped-def]
            return getattr(builder, instruction)(*values)

        return _LANES(_LANES, _LANES), build

    def choose(left, right):  # type: ignore[no-untyped-def]
        kinds = left, right
        if not any(isinstance(kind, LanesType) for kind in kinds):
            return None
        if isinstance(left, types.Integer):
            return lambda left, right: of_lanes(float(left), right)
        return lambda left, right: of_lanes(left, right)

    overload(operation)(choose)


_teach(operator.add, "fadd")
_teach(operator.sub, "fsub")
_teach(operator.mul, "fmul")
_teach(operator.truediv, "fdiv")


@_intrinsic
def _negative(context, value):  # type: ignore[no-untyped-def]
    def build(target, builder, signature, values):  # type: ignore[no-untyped-def]
        return builder.fneg(*values)

    return _LANES(_LANES), build


@overload(operator.neg)
def _neg(value):  # type: ignore[no-untyped-def]
    if isinstance(value, LanesType):
        return lambda value: _negative(value)
    return None


@_intrinsic
def _all_within(context, value, least, most):  # type: ignore[no-untyped-def]
    def build(target, builder, signature, values):  # type: ignore[no-untyped-def]
        value, least, most = values
        above = builder.fcmp_ordered(">=", value, least)
        below = builder.fcmp_ordered("<=", value, most)
        bits = builder.bitcast(builder.and_(above, below), _MASK)
        return builder.icmp_unsigned("==", bits, ir.Constant(_MASK, 2**LANES - 1))

    return types.boolean(_LANES, _LANES, _LANES), build


@overload(within)
def _within(value, least, most):  # type: ignore[no-untyped-def]
    if isinstance(value, LanesType):
        return lambda value, least, most: _all_within(value, least, most)
    return lambda value, least, most: (value >= least) & (value <= most)


@overload(total)
def _total(value):  # type: ignore[no-untyped-def]
    def of_every_lane(value):  # type: ignore[no-untyped-def]
        found: Any = lane(value, 0)
        for place in range(1, LANES):
            found += lane(value, place)
        return found

    return of_every_lane
