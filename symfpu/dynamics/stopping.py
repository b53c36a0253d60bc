"""When an orbit is stopped.

The reasons are a step beyond stability, an escape over a barrier of the potential of the bonds,
and numbers that overflow.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.dynamics.scheme import Scheme
from symfpu.errors import SymfpuError

Floats = NDArray[np.float64]

# by which the energy of one bond may exceed the total: far beyond the error of any step worth
# taking
FACTOR = 4.0
# bond stretches, where nothing else bounds them: fourth powers do not overflow much before
LARGEST_STRETCH = 1e100
BISECTIONS = 60


class OrbitStopped(SymfpuError):
    """An orbit that cannot be followed further; base of EscapedOrbit and UnstableStep.

    Raised by `integrate` and its users. Ours.

    time : of the stop; mode : of the largest (growth of) harmonic energy; energy : total;
        dimensionless.
    orbit : its place among several, () for one.
    """

    def __init__(
        self,
        reason: str,
        advice: str,
        *,
        time: float,
        mode: int,
        energy: float,
        orbit: tuple[int, ...] = (),
    ) -> None:
        self.time, self.mode, self.energy, self.orbit = time, mode, energy, orbit
        place = f" of orbit {orbit}" if orbit else ""
        super().__init__(
            f"{reason} at time {time:.10g} in mode {mode}{place}, energy {energy:.6g}; {advice}"
        )


class EscapedOrbit(OrbitStopped):
    """A bond went over a barrier of its potential, beyond which it falls without bound.

    Raised by `integrate`; the potential is that of Eq. fpuham.

    time, mode, energy, orbit : as in OrbitStopped; dimensionless.
    """


class UnstableStep(OrbitStopped):
    """The step is beyond the stability of the scheme, or too coarse to conserve the energy.

    Raised by `integrate`. Ours.

    time, mode, energy, orbit : as in OrbitStopped; dimensionless.
    """


def require_stable(chain: Chain, scheme: Scheme, step: float, energy: float) -> None:
    """Raises UnstableStep for a step that lets a harmonic mode grow."""
    Omega = chain.frequencies()
    unstable = abs(step) * Omega > scheme.stable_phase
    if unstable[-1]:
        mode = int(np.argmax(unstable)) + 1
        largest = scheme.stable_phase / Omega[-1]
        raise UnstableStep(
            f"a step of {abs(step):.6g} of {scheme.name} is unstable",
            f"take a step below {largest:.4g}, and a fraction of it for accuracy",
            time=0.0,
            mode=mode,
            energy=energy,
        )


def potential(chain: Chain, r: float) -> float:
    """V(r) of one bond."""
    return float(bonds.potential(chain.law(), r))


def stretch_bounds(chain: Chain, energy: float) -> tuple[float, float, bool]:
    """Stretches that no bond of an orbit of this energy leaves, and whether it can escape.

    A bond leaves them only if the orbit escapes or the step is too coarse.

    While all bonds are inside their wells each holds no more than the whole energy: it stays
    where V <= energy. Where that is beyond a barrier, the bond may pass, and has passed for good
    where V < 0. With beta > 0 there are no such barriers: V is bounded below.
    """
    left, right = (_bound(chain, energy, side) for side in (-1.0, 1.0))
    return -left[0], right[0], left[1] or right[1]


def _bound(chain: Chain, energy: float, side: float) -> tuple[float, bool]:
    def V(distance: float) -> float:
        return potential(chain, side * distance)

    alpha, beta = side * float(chain.alpha), float(chain.beta)
    square = alpha * alpha - 4 * beta  # V' = r (1 + alpha r + beta r^2)
    slopes = [-alpha + sign * math.sqrt(square) for sign in (1, -1)] if square >= 0 else []
    turns = [2 / slope for slope in slopes if slope > 0]
    if beta > 0:
        depth = max([0.0, *(-V(turn) for turn in turns)])
        most = FACTOR * (energy + chain.N * depth)
        outermost = max(turns, default=0.0)
        return _first(lambda r: V(r) >= most, outermost, LARGEST_STRETCH), False
    top = min([*turns, LARGEST_STRETCH])
    height, enough = V(top), FACTOR * energy
    if height >= enough:
        return _first(lambda r: V(r) >= enough, 0.0, top), False
    if height > energy:
        return top, False
    return _first(lambda r: V(r) < 0, top, LARGEST_STRETCH), True


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
