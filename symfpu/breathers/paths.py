"""A periodic orbit as its linearisation sees it: stretches of the bonds in time, and a symmetry.

A reversal, an involution that turns time round, leaves the orbit at angle 0 where it is. With fixed
ends it changes the sign of the momenta, and the orbit is at rest then. A wave on a ring is nowhere
at rest: there x_j -> -x_(-j), p_j -> p_(-j). In canonical coordinates with the reversal
diag(1, -1) both are the same; these are (Q, P), and on a ring, by sine and cosine waves,
(x of sines, p of cosines) and (p of sines, -x of cosines).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.dynamics.tangent import real_waves
from symfpu.errors import InputError
from symfpu.tori.torus import require_solution

Floats = NDArray[np.float64]
MORE_ANGLES = (
    "take normal_modes(solution), which tells the stability of tori of any number of angles"
)


class PeriodicPath(NamedTuple):
    """An orbit of a chain through a point that its reversal leaves where it is.

    stretches : of the bonds at times (T,), shape (T, N). harmonics : how many it has. flow : the
    velocity at t = 0 in the coordinates that the reversal turns round, (N-1,). frame : from the
    coordinates of tangent maps to those with the reversal diag(1, -1), orthogonal and symplectic,
    (2(N-1), 2(N-1)); None where they are the same.
    """

    chain: Chain
    omega: float
    stretches: Callable[[Floats], Floats]
    harmonics: int
    flow: Floats
    frame: Floats | None


def path_of(solution: object) -> PeriodicPath:
    """The path of a solution of one angle, of any ends; InputError for any other."""
    torus = require_solution(solution, "orbit")
    if len(torus.seeds) > 1:
        given = f"a torus of {len(torus.seeds)} angles"
        raise InputError("orbit", given, "a solution of one angle", MORE_ANGLES)
    wave = replace(torus.in_doubles(), phases={torus.seed: 0.0})
    chain, omega, (Q, P) = wave.chain, float(wave.frequency), wave.state()
    cosines = wave.by_harmonic()
    force = chain.accelerations(Q)
    if not chain.periodic:
        coefficients = chain.stretches(cosines)
        rates = np.arange(len(cosines)) * omega

        def stretches(t: Floats) -> Floats:
            return np.asarray(np.cos(np.multiply.outer(t, rates)) @ coefficients)

        return PeriodicPath(chain, omega, stretches, len(cosines), force, None)
    waves, frame = real_waves(chain), reversal_frame(chain)
    velocity = [waves @ chain.positions(part) for part in (P, force)]
    flow = (frame @ np.concatenate(velocity))[chain.N - 1 :]

    def along(t: Floats) -> Floats:
        return chain.stretches(wave.Q(t))

    return PeriodicPath(chain, omega, along, len(cosines), flow, frame)


def reversal_frame(chain: Chain) -> Floats:
    """Rows: x of sines, p of cosines, then p of sines, -x of cosines; columns: x, p of waves."""
    n, numbers = chain.N - 1, np.array(chain.mode_numbers)
    sines, cosines = np.flatnonzero(numbers < 0), np.flatnonzero(numbers > 0)
    frame = np.zeros((2 * n, 2 * n))
    upper = np.concatenate([sines, n + cosines])
    lower = np.concatenate([n + sines, cosines])
    signs = np.where(np.arange(n) < len(sines), 1, -1)
    frame[np.arange(n), upper] = 1
    frame[n + np.arange(n), lower] = signs
    return frame
