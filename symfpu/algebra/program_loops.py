"""The compiled loops of programs: values of all nodes, at one point or at many.

A node is a leaf, or the sum of factor left right over its terms, start[i] to start[i + 1]. Nodes
stand after their parts, so one pass in ascending order is enough. Importing this module imports
numba.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.compiled import compiled


@compiled()
def sum_residues(
    start: Any, left: Any, right: Any, factor: Any, prime: Any, values: Any, sums: Any
) -> None:
    """Sums of factor left right modulo a prime below 2^31, of values of earlier nodes.

    values : (nodes, points); sums : (len(start) - 1, points), left as it is where there are no
    terms, may be values itself; factor : residues. All unsigned.
    """
    for n in range(start.size - 1):
        if start[n] == start[n + 1]:
            continue
        for p in range(values.shape[1]):
            total = np.uint64(0)
            for t in range(start[n], start[n + 1]):
                product = values[left[t], p] * values[right[t], p] % prime
                total += product * factor[t] % prime
            sums[n, p] = total % prime


@compiled(fastmath={"contract"})
def evaluate_doubles(start: Any, left: Any, right: Any, factor: Any, values: Any) -> None:
    """Values in doubles; values : (nodes, points), those of the leaves given."""
    points = values.shape[1]
    for node in range(start.size - 1):
        if start[node] == start[node + 1]:
            continue
        row = values[node]
        row[:] = 0.0
        for t in range(start[node], start[node + 1]):
            weight = factor[t]
            x, y = values[left[t]], values[right[t]]
            for p in range(points):
                row[p] += weight * x[p] * y[p]


@compiled(fastmath={"contract"})
def carry_tangents(
    start: Any, left: Any, right: Any, factor: Any, values: Any, tangents: Any
) -> None:
    """Derivatives of every node along one direction of the leaves: forward differentiation.

    values, tangents : (nodes, points); the tangents of leaves given.
    """
    points = values.shape[1]
    for node in range(start.size - 1):
        if start[node] == start[node + 1]:
            continue
        row = tangents[node]
        row[:] = 0.0
        for t in range(start[node], start[node + 1]):
            weight = factor[t]
            x, y = values[left[t]], values[right[t]]
            dx, dy = tangents[left[t]], tangents[right[t]]
            for p in range(points):
                row[p] += weight * (dx[p] * y[p] + x[p] * dy[p])


@compiled()
def expand_sum(
    left: Any,
    right: Any,
    factor: Any,
    offset: Any,
    words: Any,
    coefficients: Any,
    bits: int,
    room: int,
    keys: Any,
    values: Any,
) -> int:
    """Expands sum of factor left right of polynomials; returns how many terms it has.

    left, right, factor : (terms,), numbers of polynomials. offset : polynomial i has rows
    offset[i] to offset[i + 1] of `words` (rows, W) and `coefficients`. A row of words is a
    monomial: symbol numbers of `bits` bits, descending, filled up with zeros. keys (room, W),
    values (room,) : the table, zeroed; room is a power of two larger than all terms.
    """
    width = words.shape[1]
    slots = 64 // bits
    mask = np.uint64((1 << bits) - 1)
    merged = np.zeros(width, dtype=np.uint64)
    used = np.zeros(room, dtype=np.uint8)
    for t in range(left.size):
        for i in range(offset[left[t]], offset[left[t] + 1]):
            for j in range(offset[right[t]], offset[right[t] + 1]):
                merge_monomials(words[i], words[j], bits, slots, mask, merged)
                place = place_of(merged, keys, used, room)
                values[place] += factor[t] * coefficients[i] * coefficients[j]
    count = 0
    for place in range(room):
        if used[place] and values[place] != 0:
            for w in range(width):
                keys[count, w] = keys[place, w]
            values[count] = values[place]
            count += 1
    return count


@compiled()
def merge_monomials(a: Any, b: Any, bits: int, slots: int, mask: Any, merged: Any) -> None:
    """The product of two monomials: both lists of symbol numbers, descending, as one."""
    width = merged.size
    i = j = 0
    x, y = symbol_at(a, 0, bits, slots, mask), symbol_at(b, 0, bits, slots, mask)
    for w in range(width):
        word = np.uint64(0)
        for s in range(slots):
            if x >= y:
                symbol = x
                i += 1
                x = symbol_at(a, i, bits, slots, mask)
            else:
                symbol = y
                j += 1
                y = symbol_at(b, j, bits, slots, mask)
            word |= symbol << np.uint64(s * bits)
        merged[w] = word


@compiled()
def symbol_at(words: Any, i: int, bits: int, slots: int, mask: Any) -> Any:
    """Symbol number i of a monomial, 0 beyond its end."""
    word = i // slots
    if word >= words.size:
        return np.uint64(0)
    return (words[word] >> np.uint64((i - word * slots) * bits)) & mask


@compiled()
def place_of(words: Any, keys: Any, used: Any, room: int) -> Any:
    """Where a monomial stands in a table of hashes, or is entered."""
    mixed = np.uint64(0)
    for w in range(words.size):
        mixed = (mixed ^ words[w]) * np.uint64(0x9E3779B97F4A7C15)
        mixed ^= mixed >> np.uint64(32)
    place = np.int64(mixed & np.uint64(room - 1))
    while used[place]:
        same = True
        for w in range(words.size):
            if keys[place, w] != words[w]:
                same = False
                break
        if same:
            return place
        place = (place + 1) & (room - 1)
    used[place] = 1
    for w in range(words.size):
        keys[place, w] = words[w]
    return place


@compiled()
def mark_parts(start: Any, left: Any, right: Any, marked: Any) -> None:
    """Marks all that marked nodes are made of."""
    for node in range(marked.size - 1, -1, -1):
        if marked[node]:
            for t in range(start[node], start[node + 1]):
                marked[left[t]] = True
                marked[right[t]] = True
