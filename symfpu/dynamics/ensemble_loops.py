"""The compiled loop of an ensemble: eight orbits with fixed ends, each with one deviation.

Importing this module imports numba. x, p : displacements and momenta at the sites 0 .. N of eight
orbits, (N+1, LANES), zero at the walls (symfpu.numbers.lanes). dx, dp : a deviation from each of
them, in the same lane.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.chain import bond_loops
from symfpu.compiled import compiled
from symfpu.numbers.lanes import entry, put

_ONE = np.uint64(1)
_compiled = compiled(error_model="numpy")
# a call at every kick costs some per cent of a short chain
_always_inlined = compiled(error_model="numpy", forceinline=True)


@_always_inlined
def _drift(x: Any, p: Any, length: float) -> None:
    for j in range(_ONE, np.uint64(x.shape[0] - 1)):
        put(x, j, entry(x, j) + length * entry(p, j))


@_always_inlined
def _kick_and_drift(
    x: Any, p: Any, dx: Any, dp: Any, law: Any, kick: float, drift: float
) -> None:
    """One pass, as for particles: the pulls of a bond need both its ends before they move."""
    first, bonds = _ONE, np.uint64(x.shape[0] - 1)
    stretch, strain = entry(x, first), entry(dx, first)
    left = bond_loops.tension(law, stretch)
    strained_left = bond_loops.stiffness(law, stretch) * strain
    for j in range(first, bonds):
        stretch = entry(x, j + _ONE) - entry(x, j)
        strain = entry(dx, j + _ONE) - entry(dx, j)
        right = bond_loops.tension(law, stretch)
        strained_right = bond_loops.stiffness(law, stretch) * strain
        momentum = entry(p, j) + kick * (right - left)
        deviation = entry(dp, j) + kick * (strained_right - strained_left)
        put(p, j, momentum)
        put(dp, j, deviation)
        put(x, j, entry(x, j) + drift * momentum)
        put(dx, j, entry(dx, j) + drift * deviation)
        left, strained_left = right, strained_right


@_compiled
def move_ensemble(
    x: Any,
    p: Any,
    dx: Any,
    dp: Any,
    law: Any,
    steps: int,
    first_drift: float,
    kicks: Any,
    drifts: Any,
) -> None:
    """So many steps of a splitting and of their exact derivative.

    first_drift, kicks, drifts : as `Scheme.merged` gives them. A lane that overflows stays so, and
    does not touch the others.
    """
    _drift(x, p, first_drift)
    _drift(dx, dp, first_drift)
    for _ in range(steps):
        for i in range(kicks.shape[0]):
            _kick_and_drift(x, p, dx, dp, law, kicks[i], drifts[i])
    _drift(x, p, -first_drift)
    _drift(dx, dp, -first_drift)
