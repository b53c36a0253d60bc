"""Running time averages of the harmonic energies along orbits.

They follow the trapezoid rule over looks at equal times.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.numbers.arithmetic import Numbers

Floats = NDArray[np.float64]

# time between two looks, at most, unless a step is longer: E_q has no frequency above 4, whose
# half period is 0.785
LOOK = 0.5
LOOKS = 256  # looks held at once


def steps_between_looks(step: float, look: float = LOOK) -> int:
    """Whole steps between two looks at the orbit, no longer than `look` unless a step is."""
    return max(1, int(look / abs(step) * (1 + 1e-12)))


class RunningAverages:
    """Sums over the looks so far.

    total (M, N-1) : of E_q of M orbits, E_q(0) among them. start (M, N-1) : E_q(0).
    """

    def __init__(self, chain: Chain, Q: Numbers, P: Numbers) -> None:
        self.chain, self.start = chain, chain.harmonic_energies(Q, P)
        self.total, self.last, self.looks = self.start.copy(), self.start, 0

    def add(self, Q: Numbers, P: Numbers) -> None:
        """Looks at M orbits; shapes (M, looks, N-1)."""
        energies = self.chain.harmonic_energies(Q, P)
        self.total += energies.sum(axis=1)
        self.last, self.looks = energies[:, -1], self.looks + energies.shape[1]

    def now(self) -> Floats:
        """The averages from time 0 to the last look; (M, N-1)."""
        return np.asarray((self.total - 0.5 * (self.start + self.last)) / self.looks)
