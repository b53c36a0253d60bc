"""Orbits with deviation vectors: a symmetric splitting on T + V and its exact derivative, O(N) for a
vector and a step.

The table is that of S. Blanes and P. C. Moan in symfpu.dynamics.blanes_moan6: fourteen kicks a
step, order 6, symplectic and reversible. Others can be passed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.bonds import Law
from symfpu.chain.chain import Chain
from symfpu.dynamics.blanes_moan6 import DRIFTS, KICKS
from symfpu.errors import InputError
from symfpu.numbers.typed import integer

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MovingFrame:
    """An orbit and its deviation vectors as the compiled loops want them; the arrays are moved in place.

    Made by `moving_frame`. x, p : (N+1,) with the walls; dx, dp : (blocks, N+1, LANES). vectors :
    how many lanes are used.
    kicks, drifts : of one step, as lengths of time.
    """

    chain: Chain
    vectors: int
    x: Floats
    p: Floats
    dx: Floats
    dp: Floats
    kicks: Floats
    drifts: Floats

    @property
    def law(self) -> Law:
        """Of the bonds, in doubles."""
        return self.chain.law()

    def orbit(self) -> tuple[Floats, Floats]:
        """Mode coordinates and momenta of the orbit, (N-1,) each."""
        return np.asarray(self.chain.modes(self.x[1:-1])), np.asarray(
            self.chain.modes(self.p[1:-1])
        )

    def deviations(self) -> tuple[Floats, Floats]:
        """Mode coordinates and momenta of the deviations, (vectors, N-1) each."""
        return self._vectors(self.dx), self._vectors(self.dp)

    def _vectors(self, lanes: Floats) -> Floats:
        columns = lanes[:, 1:-1].transpose(0, 2, 1).reshape(-1, self.chain.N - 1)[: self.vectors]
        return np.asarray(self.chain.modes(columns))


def tangent_steps(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    dQ: ArrayLike,
    dP: ArrayLike,
    step: float,
    steps: int,
    *,
    drifts: Sequence[float] = DRIFTS,
    kicks: Sequence[float] = KICKS,
) -> tuple[Floats, Floats, Floats, Floats]:
    """A state some steps later, and its deviations moved by the exact derivative of the step.

    Q, P : one state, (N-1,). dQ, dP : m deviations, (m, N-1). Returns all four. step : length in
    time, negative for the past.
    drifts, kicks : fractions of a step, one drift more than kicks. The derivative is that of the
    map in exact arithmetic: it is symplectic to rounding at every step length. Raises InputError.

    >>> one = [[1.0]], [[0.0]]
    # cos(sqrt(2) t)
    >>> tangent_steps(Chain(N=2, beta=1), [0.0], [0.0], *one, 0.1, 1)[2].round(6)
    array([[0.990017]])
    """
    # lazy: numba takes longer to import than all the rest
    from symfpu.dynamics.tangent_loops import advance

    frame = moving_frame(chain, Q, P, dQ, dP, step, drifts=drifts, kicks=kicks)
    count = integer(steps, "steps", 0)
    advance(frame.x, frame.p, frame.dx, frame.dp, frame.law, frame.kicks, frame.drifts, count)
    return *frame.orbit(), *frame.deviations()


def moving_frame(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    dQ: ArrayLike,
    dP: ArrayLike,
    step: float,
    *,
    drifts: Sequence[float] = DRIFTS,
    kicks: Sequence[float] = KICKS,
) -> MovingFrame:
    """State and deviations for the compiled loops.

    Arguments and errors as those of `tangent_steps`.
    """
    from symfpu.dynamics.tangent_loops import LANES

    if len(drifts) != len(kicks) + 1:
        raise InputError(
            "drifts",
            len(drifts),
            f"one more than kicks, {len(kicks) + 1}",
            "begin and end a step with a drift",
        )
    n, vectors = chain.N - 1, np.shape(dQ)[0] if np.ndim(dQ) == 2 else 0
    given = {"Q": (Q, (n,)), "P": (P, (n,)), "dQ": (dQ, (vectors, n)), "dP": (dP, (vectors, n))}
    particles = []
    for name, (values, shape) in given.items():
        if np.shape(values) != shape:
            raise InputError(
                name,
                np.shape(values),
                f"the shape {shape}",
                "pass one state and as many deviations dQ as dP",
            )
        particles.append(np.asarray(chain.positions(np.asarray(values, dtype=float))))
        if not np.isfinite(particles[-1]).all():
            raise InputError(name, values, "finite numbers", "start from a finite state")
    h = step_length(step)
    x, p, dx, dp = particles
    lanes = [np.zeros((-(-vectors // LANES), chain.N + 1, LANES)) for _ in range(2)]
    for room, columns in zip(lanes, (dx, dp), strict=True):
        for i, column in enumerate(columns):
            room[i // LANES, 1:-1, i % LANES] = column
    stages = h * np.array(kicks, dtype=float), h * np.array(drifts, dtype=float)
    return MovingFrame(chain, vectors, np.pad(x, 1), np.pad(p, 1), lanes[0], lanes[1], *stages)


def step_length(step: float) -> float:
    """The step as a float; InputError if it is no finite number other than zero."""
    if (
        isinstance(step, bool)
        or not isinstance(step, Real)
        or not math.isfinite(float(step))
        or step == 0
    ):
        raise InputError("step", step, "a finite time, not zero", "pass a number such as 0.25")
    return float(step)
