"""Samples of an orbit, integrated anew block after block; none is kept."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.dynamics.averages import steps_between_looks
from symfpu.dynamics.motion import Motion
from symfpu.dynamics.orbits import Orbit
from symfpu.errors import InputError
from symfpu.files.progress import Progress
from symfpu.spectral.record import LINE_WIDTH

Numbers = NDArray[Any]

BLOCK = 8192  # samples held at once
FEWEST = 256  # samples
MOVING = (
    1e-3  # of the harmonic energy at the first sample: a mode whose frequency is looked for
)
# of the slowest one, at least: the windows of three quarters, whose difference is the error, have
# the half width of a line, from which on it is apart from its mirror image at -f
FEWEST_TURNS = LINE_WIDTH / 0.75
NO_BOUNDS = np.array([[-np.inf, np.inf]])  # the orbit has been here: it stays within them


def require_samples(T: float, step: float) -> int:
    """How many samples there are of an orbit of this length; InputError for too few."""
    interval = step * steps_between_looks(step)
    count = int(T / interval * (1 + 1e-12)) + 1
    if count < FEWEST:
        least = f"at least {FEWEST * abs(interval):.6g}"
        raise InputError("orbit", f"T = {T:.6g}", least, "integrate a longer one")
    return count


def require_turns(chain: Chain, mode: int, T: float) -> None:
    """InputError for an orbit that is too short for the linear frequency of its slowest mode."""
    period = 2 * math.pi / float(chain.frequencies()[mode - 1])
    turns = T / period
    if turns < FEWEST_TURNS:
        given = f"T = {T:.6g}, {turns:.2g} turns of mode {mode}"
        least = (
            f"at least {math.ceil(FEWEST_TURNS * period)}, {FEWEST_TURNS:.2g} turns of it"
        )
        raise InputError("orbit", given, least, "integrate a longer one")


def _slowest(orbit: Orbit) -> int:
    """The lowest mode that moves."""
    energies = orbit.chain.harmonic_energies(orbit.Q[0], orbit.P[0])
    moving = energies > MOVING * energies.sum()
    return int(np.argmax(moving)) + 1


class Samples:
    """The mode coordinates of an orbit at equal times from 0, by the orbit's scheme and step.

    interval : between two samples, at most half a unit of time unless a step is longer, so that
        the linear frequencies, below 2, and three times them stand for themselves.
    """

    def __init__(self, orbit: Orbit) -> None:
        self.orbit = orbit
        self.stride = steps_between_looks(orbit.step)
        self.interval = orbit.step * self.stride
        self.T = float(orbit.times[-1])
        self.count = require_samples(self.T, orbit.step)
        require_turns(orbit.chain, _slowest(orbit), self.T)

    def first(self, count: int, *, parts: int = 1) -> Numbers:
        """The first so many, (count, N-1), by steps of which so many are one of the orbit."""
        orbit = self.orbit
        motion = Motion(orbit.chain, orbit.scheme, orbit.step / parts, NO_BOUNDS)
        state = motion.coordinates(orbit.Q[:1], orbit.P[:1])
        _, Q, _ = motion.look(state, count - 1, self.stride * parts, map)
        return np.concatenate([orbit.Q[:1], Q[0]])

    def blocks(self, progress: Progress) -> Iterator[Numbers]:
        """Arrays (n, N-1), one after the other; after the first each begins after the last."""
        motion = Motion(self.orbit.chain, self.orbit.scheme, self.orbit.step, NO_BOUNDS)
        start, momenta = self.orbit.Q[:1], self.orbit.P[:1]
        state = motion.coordinates(start, momenta)
        done = 1
        yield start
        while done < self.count:
            looks = min(BLOCK, self.count - done)
            _, Q, _ = motion.look(state, looks, self.stride, map)
            done += looks
            progress("samples", done / self.count)
            yield Q[0]
