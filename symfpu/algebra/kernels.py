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
COLUMNS = 64  # integers rounded at once, so that they stay in the cache
# columns and rows of a product of matrices whose sums stay in registers
SPAN, BLOCK, SINGLE = (0.0,) * 8, (0.0,) * 4, (0.0,)
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
            undefined = ir.Constant(vector, ir.Undefined)
            first = builder.insert_element(undefined, value, ir.IntType(32)(0))
            return builder.shuffle_vector(
                first,
                undefined,
                ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width),
            )

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


@intrinsic
def _matrix_code(
    _context: Any,
    lanes: Any,
    rows: Any,
    matrix: Any,
    k: Any,
    columns: Any,
    count: Any,
    b: Any,
    out: Any,
) -> Any:
    """out[k + r, b + l] += sum of matrix[k + r, i] columns[i, b + l] over i < count.

    lanes, rows : tuples with as many entries as there are l and r; all sums stay in registers.
    """
    integer = types.intp
    signature = types.void(lanes, rows, matrix, integer, columns, integer, integer, out)

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        vector = ir.VectorType(ir.DoubleType(), lanes.count)
        made = {
            position: context.make_array(sig.args[position])(
                context, builder, args[position]
            )
            for position in (2, 4, 7)
        }
        widths = {n: builder.extract_value(made[n].shape, 1) for n in made}

        def place(position: int, row: Any, column: Any) -> Any:
            at = builder.add(builder.mul(row, widths[position]), column)
            return builder.gep(made[position].data, [at])

        def as_vector(pointer: Any) -> Any:
            return builder.bitcast(pointer, vector.as_pointer())

        def spread(value: Any) -> Any:
            undefined = ir.Constant(vector, ir.Undefined)
            first = builder.insert_element(undefined, value, ir.IntType(32)(0))
            zeros = ir.Constant(
                ir.VectorType(ir.IntType(32), lanes.count), [0] * lanes.count
            )
            return builder.shuffle_vector(first, undefined, zeros)

        own = [builder.add(args[3], INT64(r)) for r in range(rows.count)]
        targets = [as_vector(place(7, row, args[6])) for row in own]
        declared: Any = cgutils
        totals = [declared.alloca_once(builder, vector) for _ in own]
        for total, target in zip(totals, targets, strict=True):
            builder.store(builder.load(target, align=8), total, align=8)
        turns = cgutils.for_range_slice(builder, INT64(0), args[5], INT64(1), inc=True)
        with turns as (i, _):
            column = builder.load(as_vector(place(4, i, args[6])), align=8)
            for total, row in zip(totals, own, strict=True):
                factor = spread(builder.load(place(2, row, i)))
                product = builder.fmul(factor, column, flags=("contract",))
                known = builder.load(total, align=8)
                added = builder.fadd(known, product, flags=("contract",))
                builder.store(added, total, align=8)
        for total, target in zip(totals, targets, strict=True):
            builder.store(builder.load(total, align=8), target, align=8)
        return context.get_dummy_value()

    return signature, generate


add_matrix_product: Any = _matrix_code if JIT else uncompiled.add_matrix_product
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


@compiled()
def _next_columns(residues, wanted, first, places):  # type: ignore[no-untyped-def]
    """The next wanted columns from `first` on, into places; those between are set to zero.

    Returns how many they are, and where to go on.
    """
    n, at = 0, first
    while at < residues.shape[1] and n < len(places):
        if wanted[at]:
            places[n] = at
            n += 1
        else:
            residues[:, at] = 0.0
        at += 1
    return n, at


@compiled()
def _taken(residues, places, own):  # type: ignore[no-untyped-def]
    """own[:, b] = residues[:, places[b]]; whether the places are neighbours."""
    n = len(places)
    near = n > 0 and places[n - 1] - places[0] == n - 1
    for i in range(len(residues)):
        row, values = residues[i], own[i]
        if near:
            first = places[0]
            for b in range(n):
                values[b] = row[first + b]
        else:
            for b in range(n):
                values[b] = row[places[b]]
    return near


@compiled(fastmath={"contract"})
def _shares(own, n, basis, shares, turns, sizes):  # type: ignore[no-untyped-def]
    """Residues over the cofactors, (primes, n), and the multiple of all primes that they exceed.

    Fills the distances of the sums of shares from that whole number; returns the largest.
    """
    turns[:n] = 0.0
    for i in range(len(shares)):
        modulus, factor = basis.moduli[i], basis.inverses[i]
        inverse = 1.0 / modulus
        for b in range(n):
            value = own[i, b] * factor
            value -= modulus * np.rint(value * inverse)
            shares[i, b] = value
            turns[b] += value * inverse
    farthest = 0.0
    for b in range(n):
        whole = np.rint(turns[b])
        sizes[b] = abs(turns[b] - whole)
        farthest = max(farthest, sizes[b])
        turns[b] = whole
    return farthest


@compiled()
def _add_product(matrix, columns, n, out):  # type: ignore[no-untyped-def]
    """out[:, :n] += matrix columns[:, :n]; of columns beyond n anything may become.

    matrix : (rows, count). columns : (count, COLUMNS). out : (rows, COLUMNS).
    """
    count, rows = len(columns), len(out)
    whole = rows - rows % len(BLOCK)
    for k in range(0, whole, len(BLOCK)):
        for b in range(0, n, len(SPAN)):
            add_matrix_product(SPAN, BLOCK, matrix, k, columns, count, b, out)
    for k in range(whole, rows):
        for b in range(0, n, len(SPAN)):
            add_matrix_product(SPAN, SINGLE, matrix, k, columns, count, b, out)


@compiled(fastmath={"contract"})
def _carry(low, high, n, limb):  # type: ignore[no-untyped-def]
    """Balances low limbs; what is over goes to the high ones. limb : a power of two."""
    inverse = 1.0 / limb
    for b in range(n):
        carry = np.rint(low[b] * inverse)
        low[b] -= carry * limb
        high[b] += carry


@compiled(fastmath={"contract"})
def _without_lowest(own, limbs, n, basis, scale):  # type: ignore[no-untyped-def]
    """Residues (primes, n) of integers without these limbs, over 2^bits, in their place."""
    for i in range(len(own)):
        total, share = own[i], scale.share[i]
        for b in range(n):
            total[b] *= share
    _add_product(scale.lowest, limbs, n, own)
    for i in range(len(own)):
        _reduce_row(own[i], n, basis.moduli[i])


@compiled(fastmath={"contract"})
def _reduce_row(row, n, modulus):  # type: ignore[no-untyped-def]
    """row[:n] modulo a modulus, integers below 2^52 in size."""
    inverse = 1.0 / modulus
    for b in range(n):
        row[b] -= modulus * np.rint(row[b] * inverse)


@compiled()
def _put_back(own, places, near, residues):  # type: ignore[no-untyped-def]
    """residues[:, places] = own. near : whether the places are neighbours."""
    n = len(places)
    for i in range(len(residues)):
        row, values = residues[i], own[i]
        if near:
            first = places[0]
            for b in range(n):
                row[first + b] = values[b]
        else:
            for b in range(n):
                row[places[b]] = values[b]


@compiled()
def _limbs_of(shares, turns, n, basis, limb, limbs):  # type: ignore[no-untyped-def]
    """The lowest limbs (limbs, n), balanced but for the last, of the integers of these shares."""
    for k in range(len(limbs)):
        row, multiple = limbs[k], basis.modulus_limbs[k]
        for b in range(n):
            row[b] = -multiple * turns[b]
    _add_product(basis.cofactor_limbs, shares, n, limbs)
    for k in range(1, len(limbs)):
        _carry(limbs[k - 1], limbs[k], n, limb)


@compiled()
def _add_words(limbs, n, first, words):  # type: ignore[no-untyped-def]
    """Adds limbs (limbs, n) to words, three each, from a row on."""
    for k in range(len(limbs)):
        word, place = divmod(k, 3)
        for b in range(n):
            words[first + b, word] += np.int64(limbs[k, b]) << (20 * place)


@compiled()
def round_columns(  # type: ignore[no-untyped-def]
    residues, wanted, basis, limb, scale, rounded, words, sizes
):
    """Integers of which residues are given, / 2^bits, rounded to the nearest, in their place.

    Zero where they are not wanted. Returns the largest distance of a sum of shares from a whole
    number, which is small unless an integer exceeds the range; and that of what is rounded.

    residues : (primes, count), overwritten. wanted : (count,). basis : a `words.Rounding` of small
    primes. limb : 2^20. scale : a `words.Scale` of these bits. words : None, or (wanted, n) int64
    of three limbs each, zeros, filled; rounded : the `words.Rounding` of the first primes, as many
    as hold what is rounded. sizes : None, or (count,), filled with the distances; zero where they
    are not wanted.
    """
    primes, count = len(residues), scale.lowest.shape[1]
    own, shares = np.zeros((primes, COLUMNS)), np.zeros((primes, COLUMNS))
    limbs = np.zeros((max(count, len(rounded.modulus_limbs)), COLUMNS))
    turns, distances = np.zeros(COLUMNS), np.zeros(COLUMNS)
    if sizes is not None:
        sizes[:] = 0.0
    places = np.empty(COLUMNS, dtype=np.int64)
    done, at, farthest, farther = 0, 0, 0.0, 0.0
    while at < residues.shape[1]:
        n, at = _next_columns(residues, wanted, at, places)
        near = _taken(residues, places[:n], own)
        farthest = max(farthest, _shares(own, n, basis, shares, turns, distances))
        if sizes is not None:
            for b in range(n):
                sizes[places[b]] = distances[b]
        _limbs_of(shares, turns, n, basis, limb, limbs[:count])
        _reduce_row(limbs[count - 1], n, scale.top)
        _without_lowest(own, limbs[:count], n, basis, scale)
        _put_back(own, places[:n], near, residues)
        if words is not None:
            first = shares[: len(rounded.moduli)]
            farther = max(farther, _shares(own, n, rounded, first, turns, distances))
            own_limbs = limbs[: min(len(rounded.modulus_limbs), 3 * words.shape[1])]
            _limbs_of(first, turns, n, rounded, limb, own_limbs)
            _reduce_row(own_limbs[-1], n, limb)  # what words hold has no limbs above it
            _add_words(own_limbs, n, done, words)
        done += n
    return farthest, farther


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


@compiled()
def put_words(words, wanted, rows, columns, table):  # type: ignore[no-untyped-def]
    """table[rows[r], columns[c], :n] = the words of the next entry, where it is wanted.

    words : (wanted, n). wanted : (rows, columns). table : (all rows, all columns, at least n).
    """
    at, length = 0, words.shape[1]
    for r in range(len(rows)):
        for c in range(len(columns)):
            if wanted[r, c]:
                for n in range(length):
                    table[rows[r], columns[c], n] = words[at, n]
                at += 1
