"""The compiled loops that round integers given by their residues, `words.ResidueBasis`.

Some columns of residues at a time stay in the cache, through both changes of basis. Plain arrays
in, plain arrays out. Importing this module imports numba.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from symfpu.algebra import uncompiled
from symfpu.algebra.kernels import INT64, spread_value
from symfpu.compiled import JIT, compiled

_untyped: Any = cgutils
COLUMNS = 64  # integers rounded at once, so that they stay in the cache
# columns and rows of a product of matrices whose sums stay in registers
SPAN, BLOCK, SINGLE = (0.0,) * 8, (0.0,) * 4, (0.0,)


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

        own = [builder.add(args[3], INT64(r)) for r in range(rows.count)]
        targets = [as_vector(place(7, row, args[6])) for row in own]
        totals = [_untyped.alloca_once(builder, vector) for _ in own]
        for total, target in zip(totals, targets, strict=True):
            builder.store(builder.load(target, align=8), total, align=8)
        turns = cgutils.for_range_slice(builder, INT64(0), args[5], INT64(1), inc=True)
        with turns as (i, _):
            column = builder.load(as_vector(place(4, i, args[6])), align=8)
            for total, row in zip(totals, own, strict=True):
                entry = builder.load(place(2, row, i))
                factor = spread_value(builder, entry, lanes.count)
                product = builder.fmul(factor, column, flags=("contract",))
                known = builder.load(total, align=8)
                added = builder.fadd(known, product, flags=("contract",))
                builder.store(added, total, align=8)
        for total, target in zip(totals, targets, strict=True):
            builder.store(builder.load(total, align=8), target, align=8)
        return context.get_dummy_value()

    return signature, generate


add_matrix_product: Any = _matrix_code if JIT else uncompiled.add_matrix_product


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
    primes. limb : 2^20. scale : a `words.Scale` of these bits. words : (wanted, n) int64 of
    three limbs each, zeros, filled, or (0, 0) for none; rounded : the `words.Rounding` of the
    first primes, as many as hold what is rounded. sizes : (count,), filled with the distances,
    zero where they are not wanted, or (0,) for none.
    """
    primes, count = len(residues), scale.lowest.shape[1]
    own, shares = np.zeros((primes, COLUMNS)), np.zeros((primes, COLUMNS))
    limbs = np.zeros((max(count, len(rounded.modulus_limbs)), COLUMNS))
    turns, distances = np.zeros(COLUMNS), np.zeros(COLUMNS)
    sizes[:] = 0.0
    places = np.empty(COLUMNS, dtype=np.int64)
    done, at, farthest, farther = 0, 0, 0.0, 0.0
    while at < residues.shape[1]:
        n, at = _next_columns(residues, wanted, at, places)
        near = _taken(residues, places[:n], own)
        farthest = max(farthest, _shares(own, n, basis, shares, turns, distances))
        if len(sizes):
            for b in range(n):
                sizes[places[b]] = distances[b]
        _limbs_of(shares, turns, n, basis, limb, limbs[:count])
        _reduce_row(limbs[count - 1], n, scale.top)
        _without_lowest(own, limbs[:count], n, basis, scale)
        _put_back(own, places[:n], near, residues)
        if len(words):
            first = shares[: len(rounded.moduli)]
            farther = max(farther, _shares(own, n, rounded, first, turns, distances))
            own_limbs = limbs[: min(len(rounded.modulus_limbs), 3 * words.shape[1])]
            _limbs_of(first, turns, n, rounded, limb, own_limbs)
            _reduce_row(own_limbs[-1], n, limb)  # what words hold has no limbs above it
            _add_words(own_limbs, n, done, words)
        done += n
    return farthest, farther


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
