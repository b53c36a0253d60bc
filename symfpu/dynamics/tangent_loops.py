"""The compiled loops of orbits with deviation vectors: plain arrays, moved in place.

Importing this module imports numba. x, p : displacements and momenta of one orbit at the sites 0
.. N, (N+1,), zero at the walls. dx, dp : deviations from it, blocks of LANES vectors, (blocks,
N+1, LANES), zero at the walls and in lanes that are not used. The lanes are the last axis and
their number is fixed, so that the loop over them is one or two machine instructions. ring : whether
site N is site 0 again, and moves.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.chain import bond_loops
from symfpu.compiled import compiled

LANES = 8  # deviation vectors moved by one instruction stream
# least ratio of a diagonal entry of R to its column, above and below which the block changes
LONGER_BLOCK, SHORTER_BLOCK = 1e-3, 1e-5

_compiled = compiled(error_model="numpy")
# a call at every kick costs some per cent of a short chain; so does asking there for the ends,
# which a literal inlined with the loops decides when they are compiled
_always_inlined = compiled(error_model="numpy", forceinline=True)


@_always_inlined
def move_lanes(
    dx: Any,
    dp: Any,
    stiffness: Any,
    drift: float,
    pull: Any,
    slope: Any,
    ring: bool,
) -> None:
    """A kick of all deviations by bonds of this stiffness times the kick, (N,), and a drift.

    dx, dp, pull, slope : as for `kick_and_drift`.
    """
    bonds = len(stiffness)
    last = (bonds - 1) * LANES
    for j in range(bonds):
        for c in range(LANES):
            slope[j * LANES + c] = stiffness[j]
    for b in range(dx.shape[0]):
        here, right = dx[b], dx[b, LANES:]
        for i in range(len(pull)):
            pull[i] = slope[i] * (right[i] - here[i])
        momenta, positions, behind = dp[b, LANES:], dx[b, LANES:], pull[LANES:]
        for i in range(last):
            momenta[i] += behind[i] - pull[i]
            positions[i] += drift * momenta[i]
        if ring:
            for c in range(LANES):
                dp[b, c] += pull[c] - pull[last + c]
                dx[b, c] += drift * dp[b, c]
                dp[b, last + LANES + c] = dp[b, c]
                dx[b, last + LANES + c] = dx[b, c]


@_always_inlined
def kick_and_drift(
    x: Any,
    p: Any,
    dx: Any,
    dp: Any,
    law: Any,
    kick: float,
    drift: float,
    forces: Any,
    ring: bool,
) -> None:
    """One kick, one drift, and their derivatives.

    Bond j has the tension V'(r), its slope is V''(r). dx, dp : flat blocks, (blocks, (N+1) LANES).
    forces : room for the impulses of the bonds on the orbit (N,) and on the lanes (N LANES,), for
    slopes (N,) and (N LANES,). Every loop runs along one flat axis and writes to an array that it
    reads in the same place only, so that the compiler can vectorise it.
    """
    tension, pull, stiffness, slope = forces
    bonds = len(tension)
    ahead = x[1:]
    for j in range(bonds):
        r = ahead[j] - x[j]
        tension[j] = kick * bond_loops.tension(law, r)
        stiffness[j] = kick * bond_loops.stiffness(law, r)
    inner_x, inner_p, after = x[1:], p[1:], tension[1:]
    for j in range(bonds - 1):
        inner_p[j] += after[j] - tension[j]
        inner_x[j] += drift * inner_p[j]
    if ring:
        p[0] += tension[0] - tension[bonds - 1]
        x[0] += drift * p[0]
        p[bonds] = p[0]
        x[bonds] = x[0]
    move_lanes(dx, dp, stiffness, drift, pull, slope, ring)


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
    bonds, blocks = len(x) - 1, dx.shape[0]
    on_orbit = np.empty(bonds), np.empty(bonds)
    on_lanes = np.empty(bonds * LANES), np.empty(bonds * LANES)
    forces = (on_orbit[0], on_lanes[0], on_orbit[1], on_lanes[1])
    # a reshape is a call: once, not at every kick
    flat_dx = dx.reshape(blocks, (bonds + 1) * LANES)
    flat_dp = dp.reshape(blocks, (bonds + 1) * LANES)
    for j in range(bonds + 1):
        x[j] += drifts[0] * p[j]
    for b in range(blocks):
        for i in range((bonds + 1) * LANES):
            flat_dx[b, i] += drifts[0] * flat_dp[b, i]
    for step in range(steps):
        for i in range(len(kicks)):
            drift = drifts[i + 1]
            if i == len(kicks) - 1 and step < steps - 1:
                drift += drifts[0]
            if ring:
                kick_and_drift(x, p, flat_dx, flat_dp, law, kicks[i], drift, forces, True)
            else:
                kick_and_drift(x, p, flat_dx, flat_dp, law, kicks[i], drift, forces, False)


@_compiled
def carry_along(dx: Any, dp: Any, slopes: Any, kicks: Any, drifts: Any, ring: bool) -> None:
    """Deviations under bonds of stiffness slopes[i, j] at the i-th kick, slopes (kicks in all, N).

    kicks : of one step, drifts : after each of them, as lengths of time.
    """
    blocks, bonds = dx.shape[0], dx.shape[1] - 1
    pull, slope = np.empty(bonds * LANES), np.empty(bonds * LANES)
    flat_dx = dx.reshape(blocks, (bonds + 1) * LANES)
    flat_dp = dp.reshape(blocks, (bonds + 1) * LANES)
    for i in range(slopes.shape[0]):
        stage = i % len(kicks)
        stiffness, drift = kicks[stage] * slopes[i], drifts[stage]
        move_lanes(flat_dx, flat_dp, stiffness, drift, pull, slope, ring)


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


@_compiled
def orthonormalise(dx: Any, dp: Any, rows: Any, R: Any, ring: bool) -> float:
    """Replace the first m vectors by their orthonormal basis, V = basis R.

    Returns the least R_jj / |column j of R|.

    rows : room for the vectors, (m, 2n), n = N-1, or N on a ring. R : upper triangular, positive
    diagonal, (m, m). Gram-Schmidt with a second pass, after which the basis is orthonormal to
    rounding. On a ring the mean is taken out first: it does not shrink where a vector does, so
    that its rounding would grow.
    """
    n, least = rows.shape[1] // 2, 1.0
    first = 0 if ring else 1
    for j in range(len(rows)):
        v = rows[j]
        for k in range(n):
            v[k] = dx[j // LANES, k + first, j % LANES]
            v[n + k] = dp[j // LANES, k + first, j % LANES]
        if ring:
            _without_mean(v[:n])
            _without_mean(v[n:])
        for i in range(len(rows)):
            R[i, j] = 0.0
        for _ in range(2):
            for i in range(j):
                overlap = 0.0
                for k in range(2 * n):
                    overlap += rows[i, k] * v[k]
                R[i, j] += overlap
                for k in range(2 * n):
                    v[k] -= overlap * rows[i, k]
        R[j, j] = _length(v)
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
    rows, R = np.empty((m, 2 * moving)), np.zeros((m, m))
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
