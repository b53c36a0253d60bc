"""Directions that are so near to a collision that rounding hides whether they are stable.

Two normal frequencies of opposite signatures that meet leave the real line, as the root of a
discriminant that changes its sign there. Where what rounding makes of sigma is as large as their
distance, or as the rate of growth, neither can be told.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from symfpu.normal.modes import NormalMode
from symfpu.normal.reduction import LEAST_ACTION
from symfpu.tori.torus import Torus


def undecided_modes(torus: Torus, modes: Sequence[NormalMode]) -> tuple[int, ...]:
    """Those of the modes that may be elliptic or hyperbolic; of a ring none is said to be."""
    if torus.chain.periodic:
        return ()
    found = {mode.mode for mode in modes if _hidden(mode)}
    elliptic = [mode for mode in modes if not mode.growth]
    for place, mode in enumerate(elliptic):
        for other in elliptic[place:]:
            if _meeting(torus, mode, other):
                found |= {mode.mode, other.mode}
    return tuple(sorted(found))


def _hidden(mode: NormalMode) -> bool:
    """Whether its own numbers do not tell."""
    if mode.growth:
        return bool(mode.growth <= mode.rounding)
    if mode.digits is not None:
        return False
    # another direction is met, known or not
    return bool(abs(mode.action) < LEAST_ACTION * mode.sigma)


def _meeting(torus: Torus, mode: NormalMode, other: NormalMode) -> bool:
    """Whether sigma and nu.omega - sigma' of the other signature may be one number."""
    sign = mode.signature * other.signature or 1
    coupled = mode.harmonics @ np.array(torus.seeds) % 2 == (mode.mode + other.mode) % 2
    if torus.chain.potential.even:
        coupled &= mode.harmonics.sum(axis=1) % 2 == 0
    left = float(mode.sigma) + sign * float(other.sigma)
    distances = np.abs(left - mode.rates[coupled])
    return bool((distances <= mode.rounding + other.rounding).any())
