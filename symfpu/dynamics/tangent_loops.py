"""The compiled loops of orbits with deviation vectors: plain arrays, moved in place.

Importing this module imports numba. x, p : displacements and momenta of one orbit at the sites 0
.. N, (N+1,), zero at the walls. dx, dp : deviations from it, blocks of LANES vectors, (blocks,
N+1, LANES), zero at the walls and in lanes that are not used (symfpu.numbers.lanes). ring : whether
site N is site 0 again, and moves.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.chain import bond_loops
from symfpu.compiled import compiled
from symfpu.numbers.lanes import LANES, entry, put, total

# least ratio of a diagonal entry of R to its column, above and below which the block changes
LONGER_BLOCK, SHORTER_BLOCK = 1e-3, 1e-5
TOGETHER = 32_768  # impulses that the second cache holds beside a block of deviations

_ZERO, _ONE = np.uint64(0), np.uint64(1)
_compiled = compiled(error_model="numpy")
# a call at every kick costs some per cent of a short chain
_always_inlined = compiled(error_model="numpy", forceinline=True)


@_always_inlined
def move_lanes(
    dx: Any, dp: Any, begin: Any, stiffness: Any, drift: float, ring: bool
) -> None:
    """A kick of one block of deviations by bonds of this stiffness times the kick, and a drift.

    dx, dp : all blocks, one site after the other, (blocks (N+1), LANES). begin : site 0 of this
    block. stiffness : (N,).

    Kick and drift are one pass, as for particles: every site is read once and written once.
    """
    bonds = np.uint64(len(stiffness))
    first, end = entry(dx, begin), begin + bonds
    here = entry(dx, begin + _ONE)
    opening = stiffness[_ZERO] * (here - first)
    left = opening
    for j in range(_ONE, bonds):
        ahead = entry(dx, begin + j + _ONE)
        right = stiffness[j] * (ahead - here)
        momenta = entry(dp, begin + j) + (right - left)
        put(dp, begin + j, momenta)
        put(dx, begin + j, here + drift * momenta)
        here, left = ahead, right
    if ring:
        momenta = entry(dp, begin) + (opening - left)
        positions = first + drift * momenta
        put(dp, begin, momenta)
        put(dp, end, momenta)
        put(dx, begin, positions)
        put(dx, end, positions)


@_always_inlined
def move_orbit(
    x: Any, p: Any, law: Any, kick: float, drift: float, forces: Any, ring: bool
) -> None:
    """A kick and a drift of the orbit, and the slopes of its impulses before them.

    Bond j has the tension V'(r), its slope is V''(r). forces : room for the impulses of the bonds
    and for their slopes, (N,) each. Two loops, which the compiler can vectorise, laws included:
    neither reads what it has just written beside it.
    """
    tension, stiffness = forces
    bonds = np.uint64(len(tension))
    for j in range(bonds):
        r = x[j + _ONE] - x[j]
        tension[j] = kick * bond_loops.tension(law, r)
        stiffness[j] = kick * bond_loops.stiffness(law, r)
    for j in range(_ONE, bonds):
        p[j] += tension[j] - tension[j - _ONE]
        x[j] += drift * p[j]
    if ring:
        p[_ZERO] += tension[_ZERO] - tension[bonds - _ONE]
        x[_ZERO] += drift * p[_ZERO]
        p[bonds] = p[_ZERO]
        x[bonds] = x[_ZERO]


@_compiled
def advance(
    x: Any,
    p: Any,
    dx: Any,
    dp: Any,
    law: Any,
    kicks: Any,
    drifts: Any,
    ring: bool,
    steps: int,
) -> None:
    """So many steps of a splitting, of an orbit and its deviations.

    kicks (stages,) and drifts (stages + 1,) are lengths of time, drifts that meet are one.
    """
    if steps == 0:
        return
    sites = np.uint64(len(x))
    forces = np.empty(len(x) - 1), np.empty(len(x) - 1)
    # rows once: a view of a block at every kick would be counted as a reference
    rows_x, rows_p = dx.reshape(-1, LANES), dp.reshape(-1, LANES)
    for j in range(sites):
        x[j] += drifts[0] * p[j]
    for j in range(len(rows_x)):
        put(rows_x, j, entry(rows_x, j) + drifts[0] * entry(rows_p, j))
    for step in range(steps):
        for i in range(len(kicks)):
            drift = drifts[i + 1]
            if i == len(kicks) - 1 and step < steps - 1:
                drift += drifts[0]
            move_orbit(x, p, law, kicks[i], drift, forces, ring)
            for b in range(np.uint64(len(dx))):
                move_lanes(rows_x, rows_p, b * sites, forces[1], drift, ring)


@_compiled
def carry_along(dx: Any, dp: Any, impulses: Any, drifts: Any, ring: bool) -> None:
    """Deviations under bonds whose stiffness times the i-th kick is impulses[i]; (kicks, N).

    drifts : after each of the kicks of one step, as lengths of time.

    A block of deviations goes through TOGETHER numbers of kicks before the next one does: it stays
    in the first cache, and the impulses stay in the second.
    """
    sites, kicks = np.uint64(dx.shape[1]), len(impulses)
    rows_x, rows_p = dx.reshape(-1, LANES), dp.reshape(-1, LANES)
    portion = max(1, TOGETHER // impulses.shape[1])
    for first in range(0, kicks, portion):
        for b in range(np.uint64(len(dx))):
            for i in range(first, min(first + portion, kicks)):
                drift = drifts[i % len(drifts)]
                move_lanes(rows_x, rows_p, b * sites, impulses[i], drift, ring)


# loops, not expressions of arrays: those take seconds each to compile
@_compiled
def _length(v: Any) -> float:
    squares = 0.0
    for k in range(len(v)):
        squares += v[k] * v[k]
    return np.sqrt(squares)  # type: ignore[no-any-return]


@_compiled
def _without_mean(v: Any) -> None:
    total = 0.0
    for k in range(len(v)):
        total += v[k]
    for k in range(len(v)):
        v[k] -= total / len(v)


@_always_inlined
def _overlap(u: Any, v: Any) -> float:
    """Product of two vectors in lanes: eight sums, so that no addition waits for the one before."""
    sums = entry(u, 0) * entry(v, 0)
    for g in range(1, len(u)):
        sums = sums + entry(u, g) * entry(v, g)
    return total(sums)


@_compiled
def orthonormalise(dx: Any, dp: Any, rows: Any, R: Any, ring: bool) -> float:
    """Replace the first m vectors by their orthonormal basis, V = basis R.

    Returns the least R_jj / |column j of R|.

    rows : room for the 2n numbers of each vector, n = N-1, or N on a ring, filled up with zeros to
    lanes, (m, groups, LANES). R : upper triangular, positive diagonal, (m, m).
    Gram-Schmidt with a second pass, after which the basis is orthonormal to rounding. On a ring
    the mean is taken out first: it does not shrink where a vector does, so that its rounding
    would grow.
    """
    first = 0 if ring else 1
    n, least = dx.shape[1] - 1 - first, 1.0
    flat = rows.reshape(len(rows), rows.shape[1] * LANES)
    for j in range(len(rows)):
        v, row = flat[j], rows[j]
        for k in range(n):
            v[k] = dx[j // LANES, k + first, j % LANES]
            v[n + k] = dp[j // LANES, k + first, j % LANES]
        if ring:
            _without_mean(v[:n])
            _without_mean(v[n : 2 * n])
        for i in range(len(rows)):
            R[i, j] = 0.0
        for _ in range(2):
            for i in range(j):
                overlap = _overlap(rows[i], row)
                R[i, j] += overlap
                for g in range(len(row)):
                    put(row, g, entry(row, g) - overlap * entry(rows[i], g))
        R[j, j] = np.sqrt(_overlap(row, row))
        least = min(least, R[j, j] / _length(R[: j + 1, j]))
        for k in range(2 * n):
            v[k] /= R[j, j]
        for k in range(n):
            dx[j // LANES, k + first, j % LANES] = v[k]
            dp[j // LANES, k + first, j % LANES] = v[n + k]
        if ring:
            dx[j // LANES, n, j % LANES] = v[0]
            dp[j // LANES, n, j % LANES] = v[n]
    return least


@_compiled
def accumulate(R: Any, columns: Any, diagonal: Any, norms: Any) -> None:
    """Multiply the product of triangular factors by R from the left.

    Columns are unit vectors, norms the logarithms of their lengths.

    diagonal : logarithms of the diagonal of the product.
    """
    for j in range(len(R)):
        diagonal[j] += np.log(R[j, j])
        column = columns[:, j]
        for i in range(j + 1):
            entry = 0.0
            for k in range(i, j + 1):
                entry += R[i, k] * column[k]
            column[i] = entry
        length = _length(column)
        for i in range(len(column)):
            column[i] /= length
        norms[j] += np.log(length)


@_compiled
def carry_frame(
    x: Any,
    p: Any,
    dx: Any,
    dp: Any,
    law: Any,
    kicks: Any,
    drifts: Any,
    ring: bool,
    steps: int,
    block: int,
    longest: int,
    columns: Any,
    diagonal: Any,
    norms: Any,
) -> int:
    """Steps with a frame made orthonormal again after every block.

    The block is halved where the frame is squeezed too much.

    Returns the block to go on with.
    """
    m = len(diagonal)
    moving = len(x) - 1 if ring else len(x) - 2
    rows, R = np.zeros((m, -(-2 * moving // LANES), LANES)), np.zeros((m, m))
    while steps > 0:
        now = min(block, steps)
        advance(x, p, dx, dp, law, kicks, drifts, ring, now)
        least = orthonormalise(dx, dp, rows, R, ring)
        accumulate(R, columns, diagonal, norms)
        steps -= now
        if least < SHORTER_BLOCK and block > 1:
            block //= 2
        elif least > LONGER_BLOCK and now == block and 2 * block <= longest:
            block *= 2
    return block
