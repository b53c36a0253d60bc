"""The compiled loops: products of graded polynomials, plain arrays in, plain arrays out.

One monomial owns one row of 8 or 16 lanes (bonds, or seeds); a product of two monomials is one
fused multiply-add of whole rows. The inner loop is written with vectors because a compiler does
not find them behind the table of products.

With a modulus p < 2^40 the same loops work on residues, held as doubles in -p/2 .. p/2: a b - p
round(a b / p) is exact with fused multiply-adds, and at most 2^12 of them are summed before they
are reduced. Importing this module imports numba.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from symfpu.algebra import uncompiled
from symfpu.compiled import JIT, compiled

INT64 = ir.IntType(64)
Float64 = types.float64


def _emit(builder: Any, name: str, *operands: Any) -> Any:
    """Call an LLVM intrinsic on doubles or vectors of doubles."""
    kind = operands[0].type
    suffix = f"v{kind.count}f64" if isinstance(kind, ir.VectorType) else "f64"
    signature = ir.FunctionType(kind, [kind] * len(operands))
    declared: Any = cgutils
    return builder.call(
        declared.get_or_insert_function(builder.module, signature, f"{name}.{suffix}"),
        operands,
    )


def as_doubles(builder: Any, values: Any, vector: Any) -> Any:
    """A vector of doubles as it is, one of singles converted."""
    return values if values.type == vector else builder.fpext(values, vector)


def spread_value(builder: Any, value: Any, width: int) -> Any:
    """A number in all lanes of a vector."""
    undefined = ir.Constant(ir.VectorType(value.type, width), ir.Undefined)
    first = builder.insert_element(undefined, value, ir.IntType(32)(0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
    return builder.shuffle_vector(first, undefined, zeros)


def _modular_product(builder: Any, a: Any, b: Any, modulus: Any, inverse: Any) -> Any:
    """a b minus the nearest multiple of the modulus, exact up to one multiple: high part, its
    remainder, and the low part.
    """
    high = builder.fmul(a, b)
    low = _emit(builder, "llvm.fma", a, b, builder.fneg(high))
    quotient = _emit(builder, "llvm.rint", builder.fmul(high, inverse))
    return builder.fadd(
        _emit(builder, "llvm.fma", builder.fneg(quotient), modulus, high), low
    )


@intrinsic
def _modular_product_code(_context: Any, a: Any, b: Any, modulus: Any, inverse: Any) -> Any:
    """a b modulo the modulus for doubles below 2^40 in size, up to one multiple of it."""

    def generate(_target: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return _modular_product(builder, *args)

    return Float64(Float64, Float64, Float64, Float64), generate


@intrinsic
def _row_code(
    _context: Any,
    lanes: Any,
    left: Any,
    i: Any,
    weight: Any,
    right: Any,
    j: Any,
    out: Any,
    o: Any,
    table: Any,
    t: Any,
    start: Any,
    stop: Any,
    modulus: Any,
) -> Any:
    """out[o + table[t + n]] += weight left[i] right[j + n] for start <= n < stop.

    lanes : a tuple whose length is the row's.

    modulus : None, or a number: then every product is taken modulo it. One piece of code on
    purpose: it emits one loop.
    """
    integer = types.intp
    signature = types.void(
        lanes,
        left,
        integer,
        Float64,
        right,
        integer,
        out,
        integer,
        table,
        integer,
        integer,
        integer,
        modulus,
    )
    width = lanes.count

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        vector = ir.VectorType(ir.DoubleType(), width)

        def pointer(position: int) -> Any:
            return context.make_array(sig.args[position])(
                context, builder, args[position]
            ).data

        def row(base: Any, index: Any) -> Any:
            first = builder.gep(base, [builder.mul(index, INT64(width))])
            kind = ir.VectorType(base.type.pointee, width)
            return builder.bitcast(first, kind.as_pointer())

        def load(place: Any) -> Any:
            """A row of doubles, or of singles as doubles."""
            return as_doubles(builder, builder.load(place, align=4), vector)

        def spread(value: Any) -> Any:
            return spread_value(builder, value, width)

        factor = builder.fmul(load(row(pointer(1), args[2])), spread(args[3]))
        right_rows, out_rows = row(pointer(4), args[5]), row(pointer(6), args[7])
        places = builder.gep(pointer(8), [args[9]])
        modular = sig.args[12] != types.none
        if modular:
            prime, inverse = (
                spread(args[12]),
                spread(builder.fdiv(ir.DoubleType()(1.0), args[12])),
            )
        with cgutils.for_range_slice(builder, args[10], args[11], INT64(1), inc=True) as (
            n,
            _,
        ):
            place = builder.sext(builder.load(builder.gep(places, [n])), INT64)
            target = builder.gep(out_rows, [place])
            other = load(builder.gep(right_rows, [n]))
            if modular:
                total = builder.fadd(
                    builder.load(target, align=8),
                    _modular_product(builder, factor, other, prime, inverse),
                )
            else:
                product = builder.fmul(factor, other, flags=("contract",))
                total = builder.fadd(
                    builder.load(target, align=8), product, flags=("contract",)
                )
            builder.store(total, target, align=8)
        return context.get_dummy_value()

    return signature, generate


modular_product: Any = _modular_product_code if JIT else uncompiled.modular_product
multiply_row: Any = _row_code if JIT else uncompiled.multiply_row


@compiled()
def reduce_lanes(rows, first, last, moduli, inverses):  # type: ignore[no-untyped-def]
    """Rows first .. last - 1 modulo the modulus of each lane, in -p/2 .. p/2.

    Integers below 2^52 in size, overwritten. rows : (count, lanes). moduli, inverses : (lanes,).
    """
    for n in range(first, last):
        for lane in range(len(moduli)):
            value = rows[n, lane]
            turns = np.rint(value * inverses[lane])
            rows[n, lane] = value - moduli[lane] * turns


@compiled()
def _reduce_block(out, rows, moduli):  # type: ignore[no-untyped-def]
    """These rows modulo the modulus of each lane; without moduli nothing."""
    if moduli is not None:
        reduce_lanes(out, rows[0], rows[1], moduli, 1.0 / moduli)


@compiled()
def _first_wanted(table, t, start, wanted):  # type: ignore[no-untyped-def]
    """The first entry from t on, before t + start, whose rank is a wanted one; ranks ascend."""
    while start > 0 and table[t + start - 1] >= wanted:
        start -= 1
    return start


@compiled()
def multiply(
    lanes: Any,
    left: Any,
    right: Any,
    out: Any,
    degree: int,
    first_row: int,
    splits: Any,
    symmetric: bool,
    active: Any,
    blocks: Any,
    tables: Any,
    modulus: Any,
    moduli: Any = None,
    limit: int = 0,
) -> int:
    """The products of all `splits` of a degree, summed; canonical rows only, others as they are.

    Returns the number of multiply-adds.

    lanes : tuple of 8 or 16 zeros; its length is the row length of left, right and out.
    left, right : (rows of all degrees, lanes). out : (rows of this degree, lanes), counted from
    first_row, filled.
    splits : (count, 2) degrees of the factors. symmetric : left is right, splits have d1 <= d2,
    and each unordered pair is multiplied once and added with weight two (a square once). active :
    for a sparse left factor, which of its rows are not zero; else empty. blocks : outer monomials
    to fill. tables : algebra.grading.ProductTables. modulus : None or a prime.
    moduli : None, or of each lane, with modulus None: sums are reduced, to -p/2 .. p/2, only where
    they could have more than `limit` products, and at the end.
    """
    (
        outer_degree,
        pair_start,
        pair_left,
        pair_right,
        block,
        inner_count,
        inner_start,
        first_canonical,
        table,
        offset,
        stride,
    ) = tables
    sparse = len(active) > 0
    count = 0
    for outer in blocks:
        x = outer_degree[outer]
        target = block[degree, outer] - first_row
        wanted = first_canonical[degree - x] if inner_start[outer] else 0
        rows = (target + wanted, target + inner_count[degree - x])
        out[rows[0] : rows[1]] = 0.0
        pending = 1.0
        for split in range(len(splits)):
            d1, d2 = splits[split, 0], splits[split, 1]
            mirror = symmetric and d1 == d2
            for x1 in range(max(0, x - d2), min(d1, x) + 1):
                y1, y2 = d1 - x1, d2 - (x - x1)
                swap = not sparse and inner_count[y1] > inner_count[y2]
                if swap:
                    y1, y2 = y2, y1
                places, step, length = offset[y1, y2], stride[y1, y2], inner_count[y2]
                for pair in range(pair_start[outer, x1], pair_start[outer, x1 + 1]):
                    l, r = pair_left[pair], pair_right[pair]
                    if mirror and l > r:
                        continue
                    weight = 2.0 if symmetric and not (mirror and l == r) else 1.0
                    i0, j0 = block[d1, l], block[d2, r]
                    if swap:
                        i0, j0 = j0, i0
                    start = length if wanted > 0 else 0
                    for i in range(inner_count[y1]):
                        t = places + i * step
                        start = _first_wanted(table, t, start, wanted)
                        if sparse and not active[i0 + i]:
                            continue
                        pending += weight
                        if pending > limit:
                            _reduce_block(out, rows, moduli)
                            pending = 1.0 + weight
                        if swap:
                            multiply_row(
                                lanes,
                                right,
                                i0 + i,
                                weight,
                                left,
                                j0,
                                out,
                                target,
                                table,
                                t,
                                start,
                                length,
                                modulus,
                            )
                        else:
                            multiply_row(
                                lanes,
                                left,
                                i0 + i,
                                weight,
                                right,
                                j0,
                                out,
                                target,
                                table,
                                t,
                                start,
                                length,
                                modulus,
                            )
                        count += length - start
        _reduce_block(out, rows, moduli)
    return count * len(lanes)


@compiled()
def _reduce_slices(out, rows, moduli):  # type: ignore[no-untyped-def]
    """These rows of all slices modulo the modulus of each lane; without moduli nothing."""
    if moduli is not None:
        for part in range(len(out)):
            own = moduli[part]
            reduce_lanes(out[part], rows[0], rows[1], own, 1.0 / own)


@compiled()
def multiply_diagonal(  # type: ignore[no-untyped-def]
    lanes,
    left,
    right,
    out,
    degree,
    has_left,
    has_right,
    blocks,
    tables,
    diagonal,
    moduli,
    limit,
):
    """The products of a series in the monomials |z|^(2e) and another one, of a degree.

    Canonical rows only, others as they are. lanes, blocks, tables, limit : as of
    `multiply`. left, right : (slices, rows of all degrees, lanes). out : (slices, rows of this
    degree, lanes), filled. has_left, has_right : (degrees,) which degrees the factors have.
    diagonal : algebra.grading.DiagonalTables. moduli : None, or (slices, lanes), of each lane.
    """
    block, counts, table = tables.block, tables.inner_count, tables.inner_table
    for outer in blocks:
        inner = degree - tables.outer_degree[outer]
        target = block[degree, outer] - block[degree, 0]
        wanted = tables.first_canonical[inner] if tables.inner_start[outer] else 0
        rows = (target + wanted, target + counts[inner])
        out[:, rows[0] : rows[1]] = 0.0
        pending = 1.0
        for pair in range(diagonal.pair_start[outer], diagonal.pair_start[outer + 1]):
            l, r = diagonal.pair_left[pair], diagonal.pair_right[pair]
            for y in range(0, inner + 1, 2):
                d = tables.outer_degree[l] + y
                if d == 0 or d == degree or not (has_left[d] and has_right[degree - d]):
                    continue
                i0, j0, length = block[d, l], block[degree - d, r], counts[inner - y]
                for n in range(diagonal.inner_start[y], diagonal.inner_start[y + 1]):
                    i = diagonal.inner_rank[n]
                    t = (
                        tables.table_offset[y, inner - y]
                        + i * tables.table_stride[y, inner - y]
                    )
                    start = length if wanted > 0 else 0
                    start = _first_wanted(table, t, start, wanted)
                    pending += 1.0
                    if pending > limit:
                        _reduce_slices(out, rows, moduli)
                        pending = 2.0
                    for part in range(len(out)):
                        multiply_row(
                            lanes, left[part], i0 + i, 1.0, right[part], j0, out[part],
                            target, table, t, start, length, None,
                        )  # fmt: skip
        _reduce_slices(out, rows, moduli)


@compiled()
def multiply_elements(left, right, modulus, out):  # type: ignore[no-untyped-def]
    """out = left right modulo a prime below 2^40, element by element, in -p/2 .. p/2.

    Arrays of one shape, contiguous.
    """
    inverse = 1.0 / modulus
    a, b, c = left.ravel(), right.ravel(), out.ravel()
    for n in range(len(a)):
        value = modular_product(a[n], b[n], modulus, inverse)
        c[n] = value - modulus * np.rint(value * inverse)


@compiled()
def multiply_rows(values, factors, moduli):  # type: ignore[no-untyped-def]
    """values[i] *= factors[i] modulo moduli[i], in -p/2 .. p/2.

    values : (primes, count), overwritten.
    """
    for i in range(len(values)):
        modulus, factor = moduli[i], factors[i]
        inverse = 1.0 / modulus
        for n in range(values.shape[1]):
            value = modular_product(values[i, n], factor, modulus, inverse)
            values[i, n] = value - modulus * np.rint(value * inverse)


@compiled()
def reduce_rows(values, moduli):  # type: ignore[no-untyped-def]
    """values[i] modulo moduli[i], in -p/2 .. p/2, for integers below 2^52 in size.

    values (primes, count), overwritten.
    """
    for i in range(len(values)):
        modulus = moduli[i]
        inverse = 1.0 / modulus
        for n in range(values.shape[1]):
            values[i, n] -= modulus * np.rint(values[i, n] * inverse)


@compiled(fastmath={"contract"})
def multiply_places(values, wanted, factors, places, moduli):  # type: ignore[no-untyped-def]
    """values[i, n] *= factors[i, places[n]] modulo moduli[i] where wanted; else zero.

    values : (primes, count), below a prime in size, overwritten. wanted, places : (count,).
    """
    for i in range(len(values)):
        modulus = moduli[i]
        inverse = 1.0 / modulus
        for n in range(values.shape[1]):
            value = values[i, n] * factors[i, places[n]] if wanted[n] else 0.0
            values[i, n] = value - modulus * np.rint(value * inverse)


@compiled()
def to_lanes(values, target, rows, conjugates):  # type: ignore[no-untyped-def]
    """target[slice, r, lane] = values[prime, ., bond] for r of rows, and of their conjugates.

    values : (primes, rows, half). target : (slices, all rows, lanes), lanes counted through the
    slices; the last ones may be over.
    """
    primes, count, half = values.shape
    width = target.shape[2]
    for part in range(len(target)):
        for r in range(count):
            row, conjugate = rows[r], conjugates[r]
            prime, bond = divmod(part * width, half)
            lane = 0
            while lane < width and prime < primes:
                run = min(half - bond, width - lane)
                for n in range(run):
                    value = values[prime, r, bond + n]
                    target[part, row, lane + n] = value
                    target[part, conjugate, lane + n] = value
                prime, bond, lane = prime + 1, 0, lane + run


@compiled()
def from_lanes(source, values, rows, factor):  # type: ignore[no-untyped-def]
    """The way back: values[prime, ., bond] = factor source[slice, r, lane] for r of rows."""
    primes, count, half = values.shape
    width = source.shape[2]
    for part in range(len(source)):
        for r in range(count):
            row = rows[r]
            prime, bond = divmod(part * width, half)
            lane = 0
            while lane < width and prime < primes:
                run = min(half - bond, width - lane)
                for n in range(run):
                    values[prime, r, bond + n] = factor * source[part, row, lane + n]
                prime, bond, lane = prime + 1, 0, lane + run
