"""The compiled loops of orbits of a ring, as those of symfpu.dynamics.orbit_loops for fixed ends.

Importing this module imports numba. The sites are 0 .. N, and site N is site 0 again: the bond
that closes the ring is like every other one, and laws are inlined as there.
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
def move_ring(
    x: Any,
    p: Any,
    law: Any,
    steps: int,
    first_drift: float,
    kicks: Any,
    drifts: Any,
    bounds: Any,
) -> int:
    """Particles of a ring, moved by kicks of all springs; returns the steps that were well.

    Displacements and momenta have shape (N+1,), the first particle stands at both ends; of several
    rings at once (N+1, LANES), which stop together. bounds : of the stretches, (2,) or (2, LANES).

    Kick and drift are one pass. The first particle moves last: the bonds on both sides of it need
    it as it was.
    """
    first, one, bonds = np.uint64(0), _ONE, np.uint64(x.shape[0] - 1)
    least, most = entry(bounds, 0), entry(bounds, 1)
    done = 0
    for j in range(bonds):
        put(x, j, entry(x, j) + first_drift * entry(p, j))
    put(x, bonds, entry(x, first))
    while done < steps:
        for i in range(kicks.shape[0]):
            kick, drift = kicks[i], drifts[i]
            r = entry(x, one) - entry(x, first)
            opening = bond_loops.tension(law, r)
            left = opening
            for j in range(one, bonds):
                r = entry(x, j + one) - entry(x, j)
                right = bond_loops.tension(law, r)
                momentum = entry(p, j) + kick * (right - left)
                put(p, j, momentum)
                put(x, j, entry(x, j) + drift * momentum)
                left = right
            momentum = entry(p, first) + kick * (opening - left)
            position = entry(x, first) + drift * momentum
            put(p, first, momentum)
            put(x, first, position)
            put(x, bonds, position)
        inside = 0
        for j in range(bonds):
            r = entry(x, j + one) - entry(x, j)
            inside += within(r, least, most)
        if inside < bonds:
            break
        done += 1
    for j in range(bonds):
        put(x, j, entry(x, j) - first_drift * entry(p, j))
    put(x, bonds, entry(x, first))
    put(p, bonds, entry(p, first))
    return done


@_compiled
def look_at_ring(
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
        done = move_ring(x, p, law, stride, first_drift, kicks, drifts, bounds)
        seen[i, 0] = x
        seen[i, 1] = p
        if done < stride:
            return int(i * stride + done)
    return int(seen.shape[0] * stride)
