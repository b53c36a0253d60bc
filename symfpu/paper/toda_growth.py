"""How deviations grow along an orbit that is near a torus of the Toda chain, and what GALI shows.

The actions I_i of the Toda chain (`symfpu.integrable`) are functions of the state; E_i = J grad I_i
is the derivative of the torus by its angle. Neighbouring tori turn against each other: a deviation
v becomes v + t sum_i E_i (grad omega_i . v), up to what stays bounded. So the singular values of
that matrix are the rates at which directions of the torus come in, one after the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.dynamics.alignment import random_frame
from symfpu.dynamics.dimension import DECADES, Evidence, TorusDimension, torus_dimension
from symfpu.dynamics.several_frames import together
from symfpu.integrable.invariants import toda_invariants

Floats = NDArray[np.float64]
STEP = (
    1e-5  # of central differences in a coordinate or momentum; of order one are their sizes
)
FIRST_TIME, SAMPLES = 1.0, 400


@dataclass(frozen=True, eq=False)
class TodaGrowth:
    """The growth of deviations along an orbit of the Toda chain.

    chain : whose orbit it approximates. matrix : v grows by t matrix v, (2n, 2n). rates : its
    singular values, descending, (n,). frequencies : of the torus, (n,).
    """

    chain: Chain
    matrix: Floats
    frequencies: Floats

    @property
    def rates(self) -> Floats:
        values = np.linalg.svd(self.matrix, compute_uv=False)
        return np.asarray(values[: self.chain.N - 1])

    def indices(self, times: Floats, vectors: int, seed: int) -> tuple[Floats, Floats]:
        """log10 GALI_k of a frame of `alignment_indices`, (T, k-1), and log |v_1|.

        What is bounded stands still, so that waves about them are left out.
        """
        n = self.chain.N - 1
        frame = np.concatenate(random_frame(vectors, n, seed), axis=1).T
        moved = frame + times[:, None, None] * (self.matrix @ frame)
        lengths = np.linalg.norm(moved, axis=1)
        factors = np.linalg.qr(moved / lengths[:, None, :], mode="r")
        heights = np.abs(np.diagonal(factors, axis1=1, axis2=2))
        return np.cumsum(np.log10(heights), axis=1)[:, 1:], np.log(lengths[:, 0])

    def dimension(self, T: float, vectors: int, frames: int) -> TorusDimension:
        """What an integration to T shows, by so many frames."""
        times = np.geomspace(FIRST_TIME, T, SAMPLES)
        said = []
        for seed in range(frames):
            gali, growth = self.indices(times, vectors, seed)
            seen = Evidence(times, growth, gali, self.chain.N - 1, DECADES)
            said.append(torus_dimension(seen))
        return together(said)

    def first_shown(self, vectors: int, frames: int, last: float) -> dict[int, float]:
        """The first time, of two in a decade up to the last, at which a dimension is shown."""
        found: dict[int, float] = {}
        for T in 10 ** np.arange(5.0, np.log10(last) + 0.25, 0.5):
            value = self.dimension(float(T), vectors, frames).value
            if value is not None:
                found.setdefault(value, float(T))
        return found


def toda_growth(chain: Chain, Q: Floats, P: Floats) -> TodaGrowth:
    """Of the Toda chain with the alpha of this one, by differences of its actions."""
    n = chain.N - 1
    state = np.concatenate([Q, P])
    by_action, by_frequency = [], []
    for step in STEP * np.eye(2 * n):
        after, before = (_invariants(chain, state + sign * step) for sign in (1, -1))
        by_action.append((after[0] - before[0]) / (2 * STEP))
        by_frequency.append((after[1] - before[1]) / (2 * STEP))
    action, frequency = np.array(by_action), np.array(by_frequency)  # (2n, n)
    along = np.concatenate([action[n:], -action[:n]])
    return TodaGrowth(chain, along @ frequency.T, _invariants(chain, state)[1])


def _invariants(chain: Chain, state: Floats) -> tuple[Floats, Floats]:
    """Actions and frequencies."""
    n = chain.N - 1
    found = toda_invariants(chain, state[:n], state[n:])
    return np.asarray(found.actions, dtype=float), np.asarray(
        found.frequencies, dtype=float
    )
