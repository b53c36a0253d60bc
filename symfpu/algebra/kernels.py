"""The compiled loop: products of graded polynomials, plain arrays in, plain arrays out.

One monomial owns one row of 8 or 16 lanes (bonds, or seeds); a product of two monomials is one fused multiply-add of
whole rows. The inner loop is written with vectors because a compiler does not find them behind the table of products.
Importing this module imports numba.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic

INT64 = ir.IntType(64)


@intrinsic
def multiply_row(
    typing: Any, lanes: Any, left: Any, i: Any, weight: Any, right: Any, j: Any, out: Any, o: Any, table: Any, t: Any, start: Any, stop: Any
) -> Any:
    """out[o + table[t + n]] += weight left[i] right[j + n] for start <= n < stop; `lanes` is a tuple whose length is the row's."""
    signature = types.void(
        lanes, left, types.intp, types.float64, right, types.intp, out, types.intp, table, types.intp, types.intp, types.intp
    )
    width = lanes.count

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        vector = ir.VectorType(ir.DoubleType(), width)

        def pointer(position: int) -> Any:
            return context.make_array(sig.args[position])(context, builder, args[position]).data

        def row(base: Any, index: Any) -> Any:
            return builder.bitcast(builder.gep(base, [builder.mul(index, INT64(width))]), vector.as_pointer())

        undefined = ir.Constant(vector, ir.Undefined)
        lane_zero = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
        weights = builder.insert_element(undefined, args[3], ir.IntType(32)(0))
        weights = builder.shuffle_vector(weights, undefined, lane_zero)
        factor = builder.fmul(builder.load(row(pointer(1), args[2]), align=8), weights)
        right_rows, out_rows = row(pointer(4), args[5]), row(pointer(6), args[7])
        places = builder.gep(pointer(8), [args[9]])
        with cgutils.for_range_slice(builder, args[10], args[11], INT64(1), inc=True) as (n, _):
            place = builder.sext(builder.load(builder.gep(places, [n])), INT64)
            target = builder.gep(out_rows, [place])
            product = builder.fmul(factor, builder.load(builder.gep(right_rows, [n]), align=8), flags=("contract",))
            builder.store(builder.fadd(builder.load(target, align=8), product, flags=("contract",)), target, align=8)
        return context.get_dummy_value()

    return signature, generate


@njit(nogil=True, cache=True)
def multiply(lanes, left, right, out, degree, first_row, splits, symmetric, active, blocks, tables):  # type: ignore[no-untyped-def]
    """Add the products of all `splits` of a degree into out, canonical rows only; returns the number of multiply-adds.

    lanes : tuple of 8 or 16 zeros; its length is the row length of left, right and out.
    left, right : (rows of all degrees, lanes). out : (rows of this degree, lanes), counted from first_row.
    splits : (count, 2) degrees of the factors. symmetric : left is right and each unordered pair is added once, with
    weight one (a square with itself: one half). active : for a sparse left factor, which of its rows are not zero; else empty.
    blocks : outer monomials to fill. tables : algebra.grading.ProductTables.
    """
    (outer_degree, pair_start, pair_left, pair_right, block, inner_count, inner_start, first_canonical, table, offset, stride) = tables
    sparse = len(active) > 0
    count = 0
    for outer in blocks:
        x = outer_degree[outer]
        target = block[degree, outer] - first_row
        wanted = first_canonical[degree - x] if inner_start[outer] else 0
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
                    weight = 0.5 if mirror and l == r else 1.0
                    i0, j0 = block[d1, l], block[d2, r]
                    if swap:
                        i0, j0 = j0, i0
                    start = length if wanted > 0 else 0
                    for i in range(inner_count[y1]):
                        t = places + i * step
                        while start > 0 and table[t + start - 1] >= wanted:
                            start -= 1
                        if sparse and not active[i0 + i]:
                            continue
                        if swap:
                            multiply_row(lanes, right, i0 + i, weight, left, j0, out, target, table, t, start, length)  # type: ignore[call-arg]
                        else:
                            multiply_row(lanes, left, i0 + i, weight, right, j0, out, target, table, t, start, length)  # type: ignore[call-arg]
                        count += length - start
    return count * len(lanes)
