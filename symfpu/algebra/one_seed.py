"""The compiled product of two series in one seed: convolutions of rows.

The monomials of degree d in z, conj z are numbered by the power p = 0 .. d of z, and powers add. So
a product is a convolution over p of rows of lanes. A tile of rows of the result stays in registers
while all splits are summed: for `TILE` steps it loads two rows a step and one tile of neighbours
in all, where the general product loads and stores two rows for each multiply-add. Importing this
module imports numba.
"""

from __future__ import annotations

import platform
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from symfpu.algebra import uncompiled
from symfpu.algebra.kernels import as_doubles, reduce_lanes
from symfpu.compiled import JIT, compiled, vector_bits

# rows of a result that are summed at once: eight vectors, of 512 bits or two halves of 256 a row,
# hide the time that a sum takes, and leave registers for the factors
TILE = 8 if vector_bits() == 512 else 4

X86 = platform.machine() in ("x86_64", "AMD64")
FLUSH = np.uint32(0x8040)  # subnormal results, and subnormal factors, as zero

_untyped: Any = cgutils
INT64 = ir.IntType(64)
DOUBLE = ir.DoubleType()


class _Rows:
    """Rows of an array as vectors, in the code that is written."""

    def __init__(self, builder: Any, base: Any, width: int) -> None:
        self.builder, self.base, self.width = builder, base, width
        self.vector = ir.VectorType(DOUBLE, width)

    def at(self, index: Any, offset: int = 0) -> Any:
        builder = self.builder
        row = builder.add(index, INT64(offset))
        first = builder.gep(self.base, [builder.mul(row, INT64(self.width))])
        kind = ir.VectorType(self.base.type.pointee, self.width)
        return builder.bitcast(first, kind.as_pointer())

    def load(self, index: Any, offset: int = 0) -> Any:
        """As doubles."""
        row = self.builder.load(self.at(index, offset), align=4)
        return as_doubles(self.builder, row, self.vector)


class _Tile:
    """Sums in registers, one for each row of a tile, in the code that is written."""

    def __init__(self, builder: Any, results: _Rows, o: Any, count: int) -> None:
        self.builder, self.results, self.o = builder, results, o
        self.sums = [_untyped.alloca_once(builder, results.vector) for _ in range(count)]
        for t, place in enumerate(self.sums):
            builder.store(results.load(o, t), place, align=8)

    def add_product(self, t: int, left: Any, right: Any) -> None:
        """sums[t] += left right, fused."""
        builder, place = self.builder, self.sums[t]
        product = builder.fmul(left, right, flags=("contract",))
        known = builder.load(place, align=8)
        total = builder.fadd(known, product, flags=("contract",))
        builder.store(total, place, align=8)

    def add_steps(self, left: _Rows, i: Any, right: _Rows, j: Any, steps: int) -> None:
        """sums[t] += left[i + u] right[j + t - u] for all t and u < steps: each row loaded once."""
        count = len(self.sums)
        others = {offset: right.load(j, offset) for offset in range(1 - steps, count)}
        for u in range(steps):
            factor = left.load(i, u)
            for t in range(count):
                self.add_product(t, factor, others[t - u])

    def store(self) -> None:
        for t, place in enumerate(self.sums):
            total = self.builder.load(place, align=8)
            self.builder.store(total, self.results.at(self.o, t), align=8)


def _convolution(tile: int) -> Any:
    """The intrinsic that sums a tile of so many rows."""

    @intrinsic
    def code(
        _context: Any,
        lanes: Any,
        left: Any,
        i: Any,
        right: Any,
        j: Any,
        count: Any,
        out: Any,
        o: Any,
    ) -> Any:
        """out[o + t] += sum of left[i + n] right[j + t - n] over n < count, for t < tile."""
        integer = types.intp
        arguments = (lanes, left, integer, right, integer, integer, out, integer)
        signature = types.void(*arguments)

        def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            def rows(position: int) -> _Rows:
                make = context.make_array(sig.args[position])
                return _Rows(
                    builder, make(context, builder, args[position]).data, lanes.count
                )

            _, _, i, _, j, count, _, o = args
            left, right = rows(1), rows(3)
            sums = _Tile(builder, rows(6), o, tile)
            whole = builder.mul(builder.sdiv(count, INT64(TILE)), INT64(TILE))
            for first, end, steps in ((INT64(0), whole, TILE), (whole, count, 1)):
                turns = cgutils.for_range_slice(builder, first, end, INT64(steps), inc=True)
                with turns as (n, _):
                    sums.add_steps(left, builder.add(i, n), right, builder.sub(j, n), steps)
            sums.store()
            return context.get_dummy_value()

        return signature, generate

    return code


convolution: Any = _convolution if JIT else uncompiled.convolution
add_tile: Any = convolution(TILE)
add_one_row: Any = convolution(1)


@intrinsic
def _control_code(_context: Any) -> Any:
    """The control word of the processor's floating-point vectors; 0 where it is no x86."""

    def generate(_target: Any, builder: Any, _signature: Any, _args: Any) -> Any:
        if not X86:
            return ir.IntType(32)(0)
        place = _untyped.alloca_once(builder, ir.IntType(32))
        _control_call(builder, "llvm.x86.sse.stmxcsr", place)
        return builder.load(place)

    return types.uint32(), generate


@intrinsic
def _set_control_code(_context: Any, control: Any) -> Any:
    """Sets that word."""

    def generate(target: Any, builder: Any, _signature: Any, args: Any) -> Any:
        if X86:
            place = _untyped.alloca_once_value(builder, args[0])
            _control_call(builder, "llvm.x86.sse.ldmxcsr", place)
        return target.get_dummy_value()

    return types.void(types.uint32), generate


def _control_call(builder: Any, name: str, place: Any) -> None:
    pointer = ir.IntType(8).as_pointer()
    signature = ir.FunctionType(ir.VoidType(), [pointer])
    function = _untyped.get_or_insert_function(builder.module, signature, name)
    builder.call(function, [builder.bitcast(place, pointer)])


control: Any = _control_code if JIT else uncompiled.control
set_control: Any = _set_control_code if JIT else uncompiled.set_control


@compiled()
def _add_terms(lanes, left, i, right, j, first, last, out, o):  # type: ignore[no-untyped-def]
    """out[o] += sum of left[i + m] right[j - m] over first <= m <= last; how many they are."""
    if first > last:
        return 0
    count = last + 1 - first
    add_one_row(lanes, left, i + first, right, j - first, count, out, o)
    return count


@compiled()
def _zero_rows(values, start, degree):  # type: ignore[no-untyped-def]
    """How many rows of a degree are zero before the first that is not; after the last as many."""
    for n in range(degree + 1):
        for lane in range(values.shape[1]):
            if values[start + n, lane] != 0.0:
                return n
    return degree + 1


@compiled()
def convolve(lanes, left, right, out, splits, starts, tiles, moduli=None, limit=0):  # type: ignore[no-untyped-def]
    """out[p] += sum of left_d[m] right_e[p - m] over all splits (d, e) of a degree.

    Returns the number of multiply-adds. Sums below the smallest normal number become zero: a
    processor takes a hundred times as long for them.

    lanes : a tuple whose length is the row's. left, right : (rows of all degrees, lanes), each
    degree the same from both ends; rows of zeros there are passed over: high harmonics. out :
    (rows of this degree, lanes). starts : (degrees,) first row of each. tiles : first rows of the
    tiles to fill. moduli, limit : as of `kernels.multiply`; a split has fewer products than that.
    """
    before = control()
    set_control(before | FLUSH)
    count = _convolve(lanes, left, right, out, splits, starts, tiles, moduli, limit)
    set_control(before)
    return count * len(lanes)


@compiled()
def _convolve(lanes, left, right, out, splits, starts, tiles, moduli, limit):  # type: ignore[no-untyped-def]
    """The sums, and how many products of rows they have."""
    count = 0
    pending = 1
    for split in range(len(splits)):
        d, e = splits[split, 0], splits[split, 1]
        i, j = starts[d], starts[e]
        # rows of both factors that are not zero, as many at either end
        low, lowest = _zero_rows(left, i, d), _zero_rows(right, j, e)
        high, highest = d - low, e - lowest
        if low > d or lowest > e:
            continue
        if moduli is not None:
            added = min(d, e) + 1
            if pending + added > limit:
                _reduce_tiles(out, tiles, moduli)
                pending = 1
            pending += added
        for p in tiles:
            # terms that all rows of the tile have
            first, last = max(low, p + TILE - 1 - highest), min(high, p - lowest)
            whole = p + TILE <= len(out) and first <= last
            if whole:
                shared = last + 1 - first
                add_tile(lanes, left, i + first, right, j + p - first, shared, out, p)
                count += TILE * shared
            for t in range(p, min(p + TILE, len(out))):
                begin, end = max(low, t - highest), min(high, t - lowest)
                if whole:
                    count += _add_terms(
                        lanes, left, i, right, j + t, begin, first - 1, out, t
                    )
                    begin = last + 1
                count += _add_terms(lanes, left, i, right, j + t, begin, end, out, t)
    if moduli is not None:
        _reduce_tiles(out, tiles, moduli)
    return count


@compiled()
def _reduce_tiles(out, tiles, moduli):  # type: ignore[no-untyped-def]
    """The rows of these tiles modulo the modulus of each lane."""
    inverses = 1.0 / moduli
    for p in tiles:
        reduce_lanes(out, p, min(p + TILE, len(out)), moduli, inverses)
