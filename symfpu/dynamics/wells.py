"""Where the bonds of an orbit can be: the well of V that they stay in, its barriers and walls."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.chain.potentials.polynomial import Polynomial
from symfpu.chain.potentials.potential import Potential
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES

Floats = NDArray[np.float64]

# by which the energy of one bond may exceed the total: far beyond the error of any step worth
# taking
FACTOR = 4.0
# bond stretches, where nothing else bounds them: fourth powers do not overflow much before
LARGEST_STRETCH = 1e100
BISECTIONS = 60
# stretches at which the turning points of a closed law are looked for
SCANNED = (1e-4, 1e4, 4000)


def potential(chain: Chain, r: float) -> float:
    """V(r) of one bond."""
    return float(bonds.potential(chain.law(), r))


def stretch_bounds(chain: Chain, energy: float) -> tuple[float, float, bool]:
    """Stretches that no bond of an orbit of this energy leaves, and whether it can escape.

    A bond leaves them only if the orbit escapes or the step is too coarse.

    While all bonds are inside their wells each holds no more than the whole energy and what
    others may lose in deeper wells: it stays where V is below. Where that is beyond a barrier,
    the bond may pass, and has passed for good where V is below every well. Where V levels off
    below it, bonds break, but the length of the chain is fixed: sum r_j = 0.
    """
    with np.errstate(all="ignore"):
        left, right = _Side(chain.potential, -1), _Side(chain.potential, 1)
        depth = max(left.depth, right.depth)
        level = energy + chain.N * depth
        least, left_escapes = left.limit(level, depth)
        most, right_escapes = right.limit(level, depth)
    longest = min((chain.N - 1) * min(least, most), LARGEST_STRETCH)
    least, most = (longest if d == math.inf else d for d in (least, most))
    return -least, most, left_escapes or right_escapes


def require_within_walls(chain: Chain, Q: Floats) -> None:
    """InputError for a state with a bond at or beyond the wall of its potential; names it."""
    wall = chain.potential.wall
    if wall is None:
        return
    stretches = np.asarray(chain.stretches(Q))
    beyond = (stretches - wall) * math.copysign(1, wall) >= 0
    if beyond.any():
        bond = int(np.argwhere(beyond)[0][-1])
        typed = f"a stretch r_{bond} = {stretches[beyond][0]:.6g} of bond {bond}"
        side = "above" if wall < 0 else "below"
        allowed = f"stretches {side} {wall:g}, where {chain.potential} is infinite"
        raise InputError("Q", typed, allowed, "start from smaller amplitudes")


def leaving_bond(stretches: Floats, velocities: Floats, bounds: Floats) -> int:
    """The bond j that is outside of the bounds, or that will be first if it moves as now.

    Shapes (N,), (N,), (2,).
    """
    least, most = bounds
    outside = (stretches < least) | (stretches > most)
    if outside.any():
        return int(np.argmax(outside))
    ahead = np.where(velocities < 0, least, most)
    with np.errstate(divide="ignore"):
        times = (ahead - stretches) / np.abs(velocities)
    return int(np.argmin(np.abs(times)))


@lru_cache(maxsize=64)
def turning_points(law: Potential) -> tuple[float, ...]:
    """The stretches r, 0 aside, at which the tension V' vanishes, in growing order."""
    if isinstance(law, Polynomial):
        return _roots(law)
    closed = law.law(DOUBLES)
    found = []
    with np.errstate(all="ignore"):
        for side in (-1.0, 1.0):
            distances = np.geomspace(*SCANNED)
            end = _end(law, side)
            if end < LARGEST_STRETCH:
                distances = end * distances / (1 + distances)
            signs = np.sign(bonds.tension(closed, side * distances))
            turned = np.flatnonzero(signs[1:] * signs[:-1] < 0)
            for low, high in (distances[i : i + 2] for i in turned):
                found.append(side * _turn(closed, side, low, high))
    return tuple(sorted(found))


def _roots(law: Polynomial) -> tuple[float, ...]:
    """The real roots of 1 + c_3 r + c_4 r^2 + ..., isolated by balls."""
    import flint

    common = math.lcm(*(c.denominator for c in law.coefficients))
    whole = [common, *(int(c * common) for c in law.coefficients)]
    balls: Any = flint.fmpz_poly(whole).complex_roots()
    return tuple(sorted(float(root.real) for root, _ in balls if root.imag == 0))


def _turn(law: bonds.Law, side: float, low: float, high: float) -> float:
    begun = bonds.tension(law, side * low)
    return _first(lambda r: bonds.tension(law, side * r) * begun <= 0, low, high)


def _end(law: Potential, side: float) -> float:
    """The distance of the wall on one side, or the largest."""
    if law.wall is not None and law.wall * side > 0:
        return abs(law.wall)
    return LARGEST_STRETCH


class _Side:
    """One side of a bond at rest; distances from there are positive."""

    def __init__(self, law: Potential, side: int) -> None:
        self.side, self.law = float(side), law.law(DOUBLES)
        self.end = _end(law, self.side)
        self.turns = [abs(r) for r in turning_points(law) if r * side > 0]

    def V(self, distance: float) -> float:
        return float(bonds.potential(self.law, self.side * distance))

    @cached_property
    def depth(self) -> float:
        """Of the deepest well beside that at rest, below zero."""
        ends = [0.0, *self.turns]
        return max(0.0, *(-self.V(turn) for turn in ends))

    def limit(self, level: float, depth: float) -> tuple[float, bool]:
        """How far a bond comes that holds no more than a level, and whether it can escape.

        Infinite where V levels off below.
        """
        enough = FACTOR * level
        there = self.V(self.end)
        if there < 0:
            return self._before_the_fall(level, depth)
        if there < enough:
            return math.inf, False
        outermost = max(self.turns, default=0.0)
        # not a number: where two infinite terms of V cancel, at the wall
        return _first(lambda r: not self.V(r) < enough, outermost, self.end), False

    def _before_the_fall(self, level: float, depth: float) -> tuple[float, bool]:
        """The same where V falls for ever beyond its last barrier."""
        top = max(self.turns, key=self.V, default=self.end)
        height, enough = self.V(top), FACTOR * level
        if height >= enough:
            return _first(lambda r: self.V(r) >= enough, 0.0, top), False
        if height > level:
            return top, False
        return _first(lambda r: self.V(r) < -depth, top, self.end), True


def _first(reached: Callable[[float], bool], low: float, high: float) -> float:
    """Where a condition begins to hold between low and high, by bisection.

    It goes by the logarithm while the numbers are far apart.
    """
    for _ in range(2 * BISECTIONS):
        middle = (
            math.sqrt(max(low, 1e-200) * high) if high > 2 * low else 0.5 * (low + high)
        )
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high
