"""The compiled loops of orbits: plain arrays in, moved in place.

Importing this module imports numba.

No fast-math: what comes out does not depend on how loops are cut into vectors, nor on how many
orbits go together as lanes (symfpu.numbers.lanes); laws of bonds are inlined, since a loop that
calls is not cut into vectors. Indices are unsigned, since an index that may
be negative costs a comparison. Every step ends with a look at the state: a loop stops after the
first one with a bond stretch out of bounds or not a number, and returns the number of steps
before it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.chain import bond_loops
from symfpu.compiled import compiled
from symfpu.numbers.lanes import entry, put, within

_ONE = np.uint64(1)
_compiled = compiled(error_model="numpy")


@_compiled
def move_particles(
    x: Any,
    p: Any,
    law: Any,
    steps: int,
    first_drift: float,
    kicks: Any,
    drifts: Any,
    bounds: Any,
) -> int:
    """Particles of a chain between walls, moved by kicks of all springs.

    Displacements and momenta have shape (N+1,), zero at the walls; of several chains at once
    (N+1, LANES), which stop together. bounds : of the stretches, (2,) or (2, LANES).

    Kick and drift are one pass: the tension of a bond needs both its ends before they move, and
    is carried to the next particle.
    """
    one, bonds = _ONE, np.uint64(x.shape[0] - 1)
    least, most = entry(bounds, 0), entry(bounds, 1)
    done = 0
    for j in range(one, bonds):
        put(x, j, entry(x, j) + first_drift * entry(p, j))
    while done < steps:
        for i in range(kicks.shape[0]):
            kick, drift = kicks[i], drifts[i]
            r = entry(x, one)
            left = bond_loops.tension(law, r)
            for j in range(one, bonds):
                r = entry(x, j + one) - entry(x, j)
                right = bond_loops.tension(law, r)
                momentum = entry(p, j) + kick * (right - left)
                put(p, j, momentum)
                put(x, j, entry(x, j) + drift * momentum)
                left = right
        inside = 0
        for j in range(bonds):
            r = entry(x, j + one) - entry(x, j)
            inside += within(r, least, most)
        if inside < bonds:
            break
        done += 1
    for j in range(one, bonds):
        put(x, j, entry(x, j) - first_drift * entry(p, j))
    return done


@_compiled
def look_at_particles(
    x: Any,
    p: Any,
    law: Any,
    stride: int,
    first_drift: float,
    kicks: Any,
    drifts: Any,
    bounds: Any,
    seen: Any,
) -> int:
    """Moves by `stride` steps as often as `seen` has rows, and copies the state there.

    seen : shape (looks, 2, N+1), or (looks, 2, N+1, LANES).
    """
    for i in range(seen.shape[0]):
        done = move_particles(x, p, law, stride, first_drift, kicks, drifts, bounds)
        seen[i, 0] = x
        seen[i, 1] = p
        if done < stride:
            return int(i * stride + done)
    return int(seen.shape[0] * stride)


@_compiled
def _product(first: Any, wide: Any, out: Any) -> None:
    """Coefficients of the product of two cosine polynomials at the N bonds.

    They are sums of a_k e^(ik theta) with a_-k = a_k, and e^(2iN theta) = -1 at the bonds: first[k]
    is a_k for k = 0 .. N-1, a_0 = 0; the other one is extended, wide[k + N] = b_k, k = -N .. 2N.

    Two terms at a time; a polynomial of few modes has few terms.
    """
    one, N = _ONE, np.uint64(first.shape[0])
    for k in range(N):
        out[k] = 0.0
    m = one
    while m < N:
        a, b = first[m], (first[m + one] if m + one < N else 0.0)
        if a != 0.0 or b != 0.0:
            lower, upper = N - m, N + m
            for k in range(N):
                out[k] += a * (wide[lower + k] + wide[upper + k]) + b * (
                    wide[lower - one + k] + wide[upper + one + k]
                )
        m += one + one


@_compiled
def _extend(b: Any, wide: Any) -> None:
    """b_-k = b_k, b_N = 0, b_(2N-k) = -b_k."""
    N = b.shape[0]
    for k in range(N):
        wide[N + k] = b[k]
        wide[N - k] = b[k]
        wide[3 * N - k] = -b[k]
    wide[0] = 0.0
    wide[2 * N] = 0.0


@_compiled
def _rotate(v: Any, w: Any, halves: Any, sines: Any) -> None:
    """Rotation by angles phi as three shears, tan(phi/2), sin(phi), tan(phi/2).

    Each keeps areas exactly, whatever the rounding of its coefficient, where cosines and sines that
    do not quite have squares of sum 1 would add up to a growth of 1e-16 a drift.
    """
    for q in range(v.shape[0]):
        a = v[q] + halves[q] * w[q]
        b = w[q] - sines[q] * a
        v[q] = a + halves[q] * b
        w[q] = b


@_compiled
def move_modes(
    v: Any,
    w: Any,
    law: Any,
    steps: int,
    entry: float,
    kicks: Any,
    drifts: Any,
    Omega: Any,
    most: float,
) -> int:
    """Modes moved by rotations and by kicks of the forces beyond the harmonic ones.

    v_q = Omega_q Q_q / sqrt(2N) and w_q = P_q / sqrt(2N), shape (N,) with entries 0 for q = 0: the
    coefficients of the bond stretches are v, those of the tensions g = c_3 v v + c_4 v v v + ...,
    and dw_q/dt = -Omega_q (v_q + g_q).
    """
    N, stages = v.shape[0], kicks.shape[0]
    halves, sines = np.empty((stages + 1, N)), np.empty((stages + 1, N))
    for i in range(stages + 1):
        drift = entry if i == stages else drifts[i]
        for q in range(N):
            halves[i, q], sines[i, q] = (
                np.tan(0.5 * drift * Omega[q]),
                np.sin(drift * Omega[q]),
            )
    terms = len(law)
    while terms > 1 and law[terms - 1] == 0.0:
        terms -= 1
    wide, power, next_power, pull = (
        np.zeros(3 * N + 2),
        np.zeros(N),
        np.zeros(N),
        np.zeros(N),
    )
    done = 0
    _rotate(v, w, halves[stages], sines[stages])
    while done < steps:
        for i in range(stages):
            power[:] = v
            pull[:] = 0.0
            for n in range(terms):
                _extend(power, wide)
                _product(v, wide, next_power)
                power, next_power = next_power, power
                for q in range(1, N):
                    pull[q] += law[n] * power[q]
            for q in range(1, N):
                w[q] -= kicks[i] * Omega[q] * pull[q]
            _rotate(v, w, halves[i], sines[i])
        total = 0.0
        for q in range(1, N):
            total += v[q] * v[q]
        if not total <= most:
            break
        done += 1
    _rotate(v, w, -halves[stages], -sines[stages])
    return done


@_compiled
def look_at_modes(
    v: Any,
    w: Any,
    law: Any,
    stride: int,
    entry: float,
    kicks: Any,
    drifts: Any,
    Omega: Any,
    most: float,
    seen: Any,
) -> int:
    """The same for modes; seen (looks, 2, N)."""
    for i in range(seen.shape[0]):
        done = move_modes(v, w, law, stride, entry, kicks, drifts, Omega, most)
        seen[i, 0] = v
        seen[i, 1] = w
        if done < stride:
            return int(i * stride + done)
    return int(seen.shape[0] * stride)
