"""The compiled loops of the tangent maps: plain arrays in, moved in place. Importing this module imports numba.

x and p are particle coordinates and momenta of k columns between two walls, shape (N+1, k), rows
of the walls zero. A kick and the drift after it are one pass over the bonds: the tension of bond
j needs x[j+1] before and x[j] before it moves.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.chain.bonds import stiffness, tension
from symfpu.compiled import compiled

_compiled, _inlined = compiled(fastmath={"contract"}), compiled(fastmath={"contract"}, keep=False)
_tension, _stiffness = _inlined(tension), _inlined(stiffness)


@_compiled
def _move(x: Any, p: Any, j: int, slope: float, tension: Any, kick: float, drift: float) -> None:
    """Kick and drift particle j between the bond on its left, whose tension comes in, and the
    bond on its right, whose goes out.
    """
    for c in range(x.shape[1]):
        right = slope * (x[j + 1, c] - x[j, c])
        p[j, c] += kick * (right - tension[c])
        x[j, c] += drift * p[j, c]
        tension[c] = right


@_compiled
def carry(x: Any, p: Any, slopes: Any, kicks: Any, drifts: Any) -> None:
    """Deviations under bonds of stiffness slopes[i, j] at the i-th kick.

    Slopes (stages, N), kicks and drifts of one step.
    """
    bonds = x.shape[0] - 1
    for i in range(slopes.shape[0]):
        tension = slopes[i, 0] * x[1]
        kick, drift = kicks[i % len(kicks)], drifts[i % len(kicks)]
        for j in range(1, bonds):
            _move(x, p, j, slopes[i, j], tension, kick, drift)


@_compiled
def carry_along(x: Any, p: Any, law: Any, steps: int, kicks: Any, drifts: Any) -> None:
    """Column 0 under the forces of the chain, the other columns as deviations from it."""
    bonds = x.shape[0] - 1
    tension = np.empty(x.shape[1])
    for i in range(steps * len(kicks)):
        kick, drift = kicks[i % len(kicks)], drifts[i % len(kicks)]
        r = x[1, 0]
        tension[:] = _stiffness(law, r) * x[1]
        own = _tension(law, r)
        for j in range(1, bonds):
            r = x[j + 1, 0] - x[j, 0]
            right = _tension(law, r)
            position, momentum = x[j, 0], p[j, 0] + kick * (right - own)
            _move(x, p, j, _stiffness(law, r), tension, kick, drift)
            x[j, 0], p[j, 0], own = position + drift * momentum, momentum, right
