"""The compiled loops of orbits of a ring, as those of symfpu.dynamics.orbit_loops for fixed ends.

Importing this module imports numba. The sites are 0 .. N, and site N is site 0 again: the bond
that closes the ring is like every other one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.chain import bond_loops
from symfpu.compiled import compiled

_ONE = np.uint64(1)
_compiled = compiled(error_model="numpy")


@_compiled
def move_ring(
    x: Any,
    p: Any,
    law: Any,
    steps: int,
    entry: float,
    kicks: Any,
    drifts: Any,
    least: float,
    most: float,
) -> int:
    """Particles of a ring, moved by kicks of all springs; returns the steps done.

    Displacements and momenta have shape (N+1,), the first particle stands at both ends.

    Kick and drift are one pass. The first particle moves last: the bonds on both sides of it need
    it as it was.
    """
    first, one, bonds = np.uint64(0), _ONE, np.uint64(x.shape[0] - 1)
    done = 0
    for j in range(bonds):
        x[j] += entry * p[j]
    x[bonds] = x[first]
    while done < steps:
        for i in range(kicks.shape[0]):
            kick, drift = kicks[i], drifts[i]
            r = x[one] - x[first]
            opening = bond_loops.tension(law, r)
            left = opening
            for j in range(one, bonds):
                r = x[j + one] - x[j]
                right = bond_loops.tension(law, r)
                momentum = p[j] + kick * (right - left)
                p[j] = momentum
                x[j] += drift * momentum
                left = right
            p[first] += kick * (opening - left)
            x[first] += drift * p[first]
            x[bonds] = x[first]
        done += 1
        inside = 0
        for j in range(bonds):
            r = x[j + one] - x[j]
            inside += (r >= least) & (r <= most)
        if inside < bonds:
            break
    for j in range(bonds):
        x[j] -= entry * p[j]
    x[bonds], p[bonds] = x[first], p[first]
    return done


@_compiled
def look_at_ring(
    x: Any,
    p: Any,
    law: Any,
    stride: int,
    entry: float,
    kicks: Any,
    drifts: Any,
    least: float,
    most: float,
    seen: Any,
) -> int:
    """Moves by `stride` steps as often as `seen` has rows, and copies the state there.

    seen : shape (looks, 2, N+1).
    """
    for i in range(seen.shape[0]):
        done = move_ring(x, p, law, stride, entry, kicks, drifts, least, most)
        seen[i, 0] = x
        seen[i, 1] = p
        if done < stride:
            return int(i * stride + done)
    return int(seen.shape[0] * stride)
