"""The compiled loops of series at points: sums of products of rows, which stay in registers.

Plain arrays in, plain arrays out; every product is one of residues, see
`several_primes.SeveralPrimesRing`. Importing this module imports numba.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from symfpu.algebra import uncompiled
from symfpu.algebra.kernels import as_doubles, reduce_lanes
from symfpu.compiled import JIT, compiled

INT64 = ir.IntType(64)
DOUBLE = ir.DoubleType()

_untyped: Any = cgutils


@intrinsic
def _sum_code(
    _context: Any,
    lanes: Any,
    left: Any,
    lefts: Any,
    i: Any,
    right: Any,
    rights: Any,
    j: Any,
    first: Any,
    last: Any,
    out: Any,
    o: Any,
) -> Any:
    """out[o] += sum of left[i + lefts[n]] right[j + rights[n]] over first <= n < last."""
    integer = types.intp
    signature = types.void(
        lanes, left, lefts, integer, right, rights, integer, integer, integer, out, integer
    )

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        vector = ir.VectorType(DOUBLE, lanes.count)

        def data(position: int) -> Any:
            make = context.make_array(sig.args[position])
            return make(context, builder, args[position]).data

        def place(base: Any, index: Any) -> Any:
            start = builder.gep(base, [builder.mul(index, INT64(lanes.count))])
            kind = ir.VectorType(base.type.pointee, lanes.count)
            return builder.bitcast(start, kind.as_pointer())

        def row(base: Any, numbers: Any, n: Any, offset: Any) -> Any:
            number = builder.load(builder.gep(numbers, [n]))
            values = builder.load(place(base, builder.add(number, offset)), align=4)
            return as_doubles(builder, values, vector)

        left, lefts, right, rights = (data(position) for position in (1, 2, 4, 5))
        target = place(data(9), args[10])
        total = _untyped.alloca_once(builder, vector)
        builder.store(builder.load(target, align=8), total, align=8)
        turns = cgutils.for_range_slice(builder, args[7], args[8], INT64(1), inc=True)
        with turns as (n, _):
            factor, other = row(left, lefts, n, args[3]), row(right, rights, n, args[6])
            product = builder.fmul(factor, other, flags=("contract",))
            known = builder.load(total, align=8)
            added = builder.fadd(known, product, flags=("contract",))
            builder.store(added, total, align=8)
        builder.store(builder.load(total, align=8), target, align=8)
        return context.get_dummy_value()

    return signature, generate


add_products: Any = _sum_code if JIT else uncompiled.add_products


@compiled()
def _reduced_sum(  # type: ignore[no-untyped-def]
    lanes, left, lefts, i, right, rights, j, count, out, o, moduli, inverses, limit
):
    """out[o] plus a sum of products, as of `add_products`, modulo the modulus of each lane.

    out[o] : below a modulus in size.
    """
    step = limit - 2
    for first in range(0, count, step):
        last = min(first + step, count)
        add_products(lanes, left, lefts, i, right, rights, j, first, last, out, o)
        reduce_lanes(out, o, o + 1, moduli, inverses)


@compiled()
def evaluate(  # type: ignore[no-untyped-def]
    lanes,
    coefficients,
    degree,
    skip,
    tables,
    rows,
    powers,
    places,
    values,
    moduli,
    limit,
    parts,
):
    """The values at points of all polynomials of a degree. Returns the number of multiply-adds.

    lanes : a tuple whose length is the row's. coefficients : (slices, rows of this degree, lanes);
    skip : those of each block before the first that is used. tables, rows, places : as of
    `grading.ProductTables`, `at_points.PointRows` and `at_points.Places`. powers : what
    coefficients are times, (slices, entries, lanes). values : (slices, point rows, lanes), filled.
    moduli : (slices, lanes). limit : products that a sum may have. parts : slices to do.
    """
    done = 0
    for part in parts:
        done += _evaluate(
            lanes, coefficients[part], degree, skip, tables, rows, powers[part], places,
            values[part], moduli[part], limit,
        )  # fmt: skip
    return done


@compiled()
def _evaluate(  # type: ignore[no-untyped-def]
    lanes, coefficients, degree, skip, tables, rows, powers, places, values, moduli, limit
):
    """The same of one slice."""
    inverses = 1.0 / moduli
    total = np.zeros((1, len(lanes)))
    start = tables.block[degree, 0]
    done = 0
    for outer in range(len(tables.outer_degree)):
        inner = degree - tables.outer_degree[outer]
        if inner < 0:
            break
        columns, first = places.columns[inner], tables.block[degree, outer] - start + skip
        every = np.arange(columns)
        target = rows.offset[outer] + inner
        for k in range(rows.counts[outer]):
            at = places.start[inner] + k * columns
            entries = places.flat[at : at + columns]
            total[:] = 0.0
            _reduced_sum(
                lanes, coefficients, every, first, powers, entries, 0, columns,
                total, 0, moduli, inverses, limit,
            )  # fmt: skip
            for lane in range(len(lanes)):
                values[rows.first[k] + target, lane] = total[0, lane]
        done += rows.counts[outer] * columns
    return done * len(lanes)


@compiled()
def _pairs(  # type: ignore[no-untyped-def]
    outer, degree, has_left, has_right, mirror, since, tables, rows, lefts, rights
):
    """The rows of factors whose products give an outer monomial of a degree at its first point.

    mirror : 0 for all pairs; 1 for one of every two that are alike but for their order; 2 for
    those that are their own mirror image. has_left, has_right : (degrees,), which are there.
    since : a degree that one of the factors has at least; negative: that both stay below.
    Returns how many they are.
    """
    inner = degree - tables.outer_degree[outer]
    count = 0
    first, last = tables.pair_start[outer, 0], tables.pair_start[outer, -1]
    for pair in range(first, last):
        l, r = tables.pair_left[pair], tables.pair_right[pair]
        if (mirror == 1 and l > r) or (mirror == 2 and l != r):
            continue
        x = tables.outer_degree[l]
        for a in range(inner + 1):
            d, e = x + a, degree - x - a
            if d == 0 or e == 0 or not (has_left[d] and has_right[e]):
                continue
            if (max(d, e) >= abs(since)) == (since < 0):
                continue
            if l == r and (
                (mirror == 1 and a >= inner - a) or (mirror == 2 and 2 * a != inner)
            ):
                continue
            lefts[count] = rows.offset[l] + a
            rights[count] = rows.offset[r] + inner - a
            count += 1
    return count


@compiled()
def multiply(  # type: ignore[no-untyped-def]
    lanes, left, right, out, degree, there, symmetric, since, early, blocks, skip,
    tables, rows, powers, places, moduli, limit, parts,
):  # fmt: skip
    """The products of all pairs of factors of a degree, interpolated; canonical rows only.

    left, right : (slices, point rows, lanes). out : (slices, rows of this degree, lanes), filled.
    there : (2, degrees) which degrees the left and the right factors have. symmetric :
    left is right. since : 0, or a degree that one of two factors has at least; early : None, or
    what the others give, (slices, points, lanes), as of `square_early`. blocks : outer monomials
    to fill. powers : what values are times to give coefficients. Other arguments, and what is
    returned, as of `evaluate`.
    """
    done = 0
    for part in parts:
        if early is not None:
            done += _multiply(
                lanes, left[part], right[part], out[part], degree, there, symmetric, since,
                early[part], blocks, skip, tables, rows, powers[part], places, moduli[part], limit,
            )  # fmt: skip
        else:
            done += _multiply(
                lanes, left[part], right[part], out[part], degree, there, symmetric, since,
                None, blocks, skip, tables, rows, powers[part], places, moduli[part], limit,
            )  # fmt: skip
    return done


@compiled()
def _multiply(  # type: ignore[no-untyped-def]
    lanes, left, right, out, degree, there, symmetric, since, early, blocks, skip,
    tables, rows, powers, places, moduli, limit,
):  # fmt: skip
    """The same of one slice."""
    inverses = 1.0 / moduli
    most = places.columns.max()
    totals, every = np.zeros((most, len(lanes))), np.arange(most)
    start = tables.block[degree, 0]
    done = 0
    for outer in blocks:
        inner = degree - tables.outer_degree[outer]
        points = places.columns[inner]
        pairs = tables.pair_start[outer, -1] - tables.pair_start[outer, 0]
        longest = pairs * (inner + 1)
        lefts, rights = np.empty(longest, dtype=np.int64), np.empty(longest, dtype=np.int64)
        totals[:] = 0.0
        for mirror in range(1, 3) if symmetric else range(1):
            count = _pairs(
                outer,
                degree,
                there[0],
                there[1],
                mirror,
                since,
                tables,
                rows,
                lefts,
                rights,
            )
            for k in range(points):
                _reduced_sum(
                    lanes, left, lefts, rows.first[k], right, rights, rows.first[k], count,
                    totals, k, moduli, inverses, limit,
                )  # fmt: skip
            if mirror == 1:
                totals *= 2.0
            done += count * points
        if early is not None:
            totals[:points] += early
        reduce_lanes(totals, 0, points, moduli, inverses)
        first = tables.block[degree, outer] - start
        for p in range(skip, inner + 1):
            at = places.start[inner] + (p - skip) * points
            entries = places.flat[at : at + points]
            out[first + p] = 0.0
            _reduced_sum(
                lanes, totals, every, 0, powers, entries, 0, points,
                out, first + p, moduli, inverses, limit,
            )  # fmt: skip
        done += (inner + 1 - skip) * points
    return done * len(lanes)


@compiled()
def square_early(  # type: ignore[no-untyped-def]
    lanes, values, out, degree, has, tables, rows, moduli, limit, parts
):
    """What the degrees below one give to the values of a square, of it and the next degrees.

    One seed. Several degrees at once, because each of them reads all values. out : (degrees,
    slices, points, lanes), zeros, filled. has : (degrees,) which there are. Other arguments as of
    `multiply`.
    """
    done = 0
    for part in parts:
        done += _square_early(
            lanes,
            values[part],
            out[:, part],
            degree,
            has,
            tables,
            rows,
            moduli[part],
            limit,
        )
    return done


@compiled()
def _square_early(  # type: ignore[no-untyped-def]
    lanes, values, out, degree, has, tables, rows, moduli, limit
):
    """The same of one slice."""
    inverses = 1.0 / moduli
    several, points, _ = out.shape
    shape = (2, several, degree)
    lefts, rights = np.empty(shape, dtype=np.int64), np.empty(shape, dtype=np.int64)
    counts = np.zeros((2, several), dtype=np.int64)
    for mirror in range(2):
        for t in range(several):
            counts[mirror, t] = _pairs(
                0, degree + t, has, has, mirror + 1, -degree, tables, rows,
                lefts[mirror, t], rights[mirror, t],
            )  # fmt: skip
    for k in range(points):
        at = rows.first[k]
        for t in range(several):
            for mirror in range(2):
                _reduced_sum(
                    lanes, values, lefts[mirror, t], at, values, rights[mirror, t], at,
                    counts[mirror, t], out[t], k, moduli, inverses, limit,
                )  # fmt: skip
                if mirror == 0:
                    out[t, k] *= 2.0
    return counts.sum() * points * len(lanes)
