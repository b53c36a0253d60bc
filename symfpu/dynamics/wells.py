"""Where the bonds of an orbit can be: the well of V that they stay in, its barriers and walls."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.chain.potentials.polynomial import Polynomial
from symfpu.chain.potentials.potential import Potential
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES, Numbers

Floats = NDArray[np.float64]
Function = Callable[[bonds.Law, Any], Any]

# by which the energy of one bond may exceed the total: far beyond the error of any step worth
# taking
FACTOR = 4.0
# bond stretches, where nothing else bounds them: fourth powers do not overflow much before
LARGEST_STRETCH = 1e100
BISECTIONS = 60
# distances at which turning points and walls of a closed law are looked for
SCANNED = (1e-4, 1e4, 4000)


@dataclass(frozen=True)
class Side:
    """One side of a bond at rest; distances from there are positive.

    end : of the wall, else LARGEST_STRETCH. turns : where V' vanishes, in growing order.
    """

    law: bonds.Law
    sign: float
    end: float
    turns: tuple[float, ...]

    @property
    def wall(self) -> float | None:
        """The stretch where V is infinite, None where there is none."""
        return self.sign * self.end if self.end < LARGEST_STRETCH else None

    def V(self, distance: float) -> float:
        # numbers of NumPy: powers of Python's own raise where they are too large
        return float(bonds.potential(self.law, np.float64(self.sign * distance)))

    @cached_property
    def depth(self) -> float:
        """Of the deepest well beside that at rest, below zero."""
        return max(0.0, *(-self.V(turn) for turn in (0.0, *self.turns)))

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
    left, right = sides(chain.potential)
    with np.errstate(all="ignore"):
        depth = max(left.depth, right.depth)
        level = energy + chain.N * depth
        least, left_escapes = left.limit(level, depth)
        most, right_escapes = right.limit(level, depth)
    longest = min((chain.N - 1) * min(least, most), LARGEST_STRETCH)
    least, most = (longest if d == math.inf else d for d in (least, most))
    return -least, most, left_escapes or right_escapes


def beyond_walls(law: Potential, stretches: Floats) -> NDArray[np.bool_]:
    """Where bonds are at or beyond a wall; what is no number has been there."""
    left, right = (side.wall for side in sides(law))
    beyond = np.zeros(stretches.shape, dtype=bool)
    if left is not None:
        beyond |= ~(stretches > left)
    if right is not None:
        beyond |= ~(stretches < right)
    return beyond


def require_within_walls(chain: Chain, Q: Numbers) -> None:
    """InputError for a state with a bond at or beyond a wall of its potential; names it."""
    stretches = np.asarray(chain.stretches(Q))
    beyond = beyond_walls(chain.potential, stretches) & np.isfinite(stretches)
    if beyond.any():
        bond = int(np.argwhere(beyond)[0][-1])
        stretch = float(stretches[beyond][0])
        typed = f"a stretch r_{bond} = {stretch:.6g} of bond {bond}"
        where = f"{'above' if stretch < 0 else 'below'} {wall_of(chain, stretch):.12g}"
        allowed = f"stretches {where}, where {chain.potential} is infinite"
        raise InputError("Q", typed, allowed, "start from smaller amplitudes")


def wall_of(chain: Chain, stretch: float) -> float:
    """The wall on the side of a stretch; infinite where there is none."""
    left, right = sides(chain.potential)
    wall = left.wall if stretch < 0 else right.wall
    return math.copysign(math.inf, stretch) if wall is None else wall


def nearest_to_wall(chain: Chain, stretches: Floats) -> int:
    """The bond that has the least way to a wall of its potential, shape (N,)."""
    walls = [side.wall for side in sides(chain.potential) if side.wall is not None]
    distances = [np.abs(stretches - wall) for wall in walls]
    return int(np.argmin(np.min(distances, axis=0)))


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
def sides(potential: Potential) -> tuple[Side, Side]:
    """What is to the left and to the right of rest."""
    if isinstance(potential, Polynomial):
        law, roots = potential.law(DOUBLES), _roots(potential)
        turns = [sorted(abs(r) for r in roots if r * sign > 0) for sign in (-1, 1)]
        left, right = map(tuple, turns)
        end = LARGEST_STRETCH
        return Side(law, -1.0, end, left), Side(law, 1.0, end, right)
    with np.errstate(all="ignore"):
        return _scanned(potential, -1.0), _scanned(potential, 1.0)


def _roots(potential: Polynomial) -> list[float]:
    """The real roots of 1 + c_3 r + c_4 r^2 + ..., isolated by balls."""
    import flint

    common = math.lcm(*(c.denominator for c in potential.coefficients))
    whole = [common, *(int(c * common) for c in potential.coefficients)]
    balls: Any = flint.fmpz_poly(whole).complex_roots()
    return [float(root.real) for root, _ in balls if root.imag == 0]


def _scanned(potential: Potential, sign: float) -> Side:
    """One side of a closed law, up to the wall that it names, else to the first that is met.

    That is a pole of V or V', or where they are no numbers.
    """
    law, distances, end = potential.law(DOUBLES), np.geomspace(*SCANNED), LARGEST_STRETCH
    if potential.wall is not None and potential.wall * sign > 0:
        end = abs(potential.wall)
        distances = end * distances / (1 + distances)
    turns: list[float] = []
    for function, i in _events(law, sign * distances):
        there, turned = _crossing(function, law, sign, *map(float, distances[i : i + 2]))
        if not turned:
            end = min(end, there)
            break
        if function is bonds.tension:
            turns.append(there)
    return Side(law, sign, end, tuple(turns))


def _events(law: bonds.Law, stretches: Floats) -> list[tuple[Function, int]]:
    """After which of the stretches V or V' changes its sign or is no number, the nearest first.

    Up to where one of them is zero: there V has levelled off.
    """
    found = []
    for function in (bonds.tension, bonds.potential):
        signs = np.sign(function(law, stretches))
        level = int(np.argmax(signs == 0)) if (signs == 0).any() else len(signs)
        changed = np.flatnonzero(~(signs[1:level] == signs[: level - 1]))
        found += [(function, int(i)) for i in changed]
    return sorted(found, key=lambda event: event[1])


def _crossing(
    function: Function, law: bonds.Law, sign: float, low: float, high: float
) -> tuple[float, bool]:
    """Where between two distances the sign changes, and whether through zero, not at a pole."""
    before = float(function(law, np.float64(sign * low)))

    def value(distance: float) -> float:
        return float(function(law, np.float64(sign * distance))) / before

    there = _first(lambda distance: not value(distance) > 0, low, high)
    return there, abs(value(there)) < 1


def _first(reached: Callable[[float], bool], low: float, high: float) -> float:
    """Where a condition begins to hold between low and high, by bisection.

    It goes by the logarithm while the numbers are far apart.
    """
    for _ in range(2 * BISECTIONS):
        middle = (
            math.sqrt(max(low, 1e-200) * high) if high > 2 * low else 0.5 * (low + high)
        )
        if middle in (low, high):  # nothing is between them
            break
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high
