"""Orbits with deviation vectors: a splitting on T + V and its exact derivative.

The work is O(N) for a vector and a step. Any scheme on T + V can move them
(symfpu.dynamics.schemes): they are symmetric compositions of drifts and kicks, so that orbit and
deviations are moved by maps that are symplectic to rounding and reversible at every step length.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain import bonds
from symfpu.chain.bonds import Law
from symfpu.chain.chain import Chain
from symfpu.dynamics.blanes_moan6 import BLANES_MOAN6
from symfpu.dynamics.kahan_li8 import KAHAN_LI8
from symfpu.dynamics.scheme import Scheme
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Numbers
from symfpu.numbers.typed import integer

Floats = NDArray[np.float64]
TABLE = 4_000_000  # entries of a table of stretches held at once


@dataclass(frozen=True, eq=False)
class MovingFrame:
    """An orbit and its deviation vectors as the compiled loops want them.

    Made by `moving_frame`; the arrays are moved in place. x, p : of the sites 0 .. N, (N+1,); dx,
    dp : (blocks, N+1, LANES). vectors : how many lanes are used. kicks, drifts : of one step of the
    scheme, as lengths of time.
    """

    chain: Chain
    scheme: Scheme
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

    def arguments(self) -> tuple[Any, ...]:
        """What the loops take first."""
        state = self.x, self.p, self.dx, self.dp
        return *state, self.law, self.kicks, self.drifts, self.chain.periodic

    def remembered(self) -> MovingFrame:
        """One whose orbit stays where this one's is now."""
        return replace(self, x=self.x.copy(), p=self.p.copy())

    def orbit(self) -> tuple[Numbers, Numbers]:
        """Mode coordinates and momenta of the orbit, (N-1,) each."""
        moving = self.chain.kind_of_ends.moving
        Q = np.asarray(self.chain.modes(moving(self.x)))
        P = np.asarray(self.chain.modes(moving(self.p)))
        return Q, P

    def deviations(self) -> tuple[Numbers, Numbers]:
        """Mode coordinates and momenta of the deviations, (vectors, N-1) each."""
        dQ = _out_of_lanes(self.chain, self.dx, self.vectors)
        dP = _out_of_lanes(self.chain, self.dp, self.vectors)
        return dQ, dP


def tangent_steps(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    dQ: ArrayLike,
    dP: ArrayLike,
    step: float,
    steps: int,
    *,
    scheme: Scheme = BLANES_MOAN6,
) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    """A state some steps later, and its deviations moved by the exact derivative of the step.

    Q, P : one state, (N-1,). dQ, dP : m deviations, (m, N-1), m = 0 allowed. Returns all four. On a
    ring complex, Q_(-q) = conj Q_q, and so are the deviations: none moves the ring as a whole.
    step : length in time, negative for the past. scheme : on T + V. The derivative is that of the
    map in exact arithmetic: it is symplectic to rounding at every step length. Raises InputError.

    >>> one = [[1.0]], [[0.0]]
    >>> dQ = tangent_steps(Chain(N=2, beta=1), [0.0], [0.0], *one, 0.1, 1)[2]
    >>> dQ.round(6)  # cos(sqrt(2) t)
    array([[0.990017]])
    """
    # lazy: numba takes longer to import than all the rest
    from symfpu.chain.bond_loops import run_loop
    from symfpu.dynamics.tangent_loops import advance

    frame = moving_frame(chain, Q, P, dQ, dP, step, scheme=scheme)
    count = integer(steps, "steps", 0)
    run_loop(advance, frame.law, *frame.arguments(), count)
    return *frame.orbit(), *frame.deviations()


def tangent_map_along(
    chain: Chain,
    stretches: Callable[[Floats], Floats],
    duration: float,
    steps: int,
    *,
    scheme: Scheme = KAHAN_LI8,
) -> Floats:
    """Tangent map of mode coordinates and momenta along a given orbit, from time 0 to duration.

    stretches : bond stretches r_j of the orbit at times (T,), shape (T, N), as often as wanted.
    scheme : on T + V; time runs with its drifts, so that forces given as functions of time keep
        the order.

    Returns shape (2(N-1), 2(N-1)); rows and columns are Q_1 .. Q_(N-1), P_1 .. P_(N-1), on a ring
    coordinates and momenta of `real_waves`. Raises InputError.
    """
    from symfpu.dynamics.tangent_loops import carry_along

    n = chain.N - 1
    count = integer(steps, "steps", 1)
    h = step_length(duration, "duration") / count
    entry, kicks, drifts = scheme.merged(h)
    identity = np.eye(2 * n)
    dx = _in_lanes(chain, _displaced(chain, identity[:, :n]))
    dp = _in_lanes(chain, _displaced(chain, identity[:, n:]))
    inside = np.cumsum(scheme.drifts[:-1])  # times of the kicks in a step of length 1
    portion = max(1, TABLE // (scheme.stages * chain.N))
    dx += entry * dp
    for first in range(0, count, portion):
        starts = np.arange(first, min(first + portion, count))
        times = h * np.add.outer(starts, inside).reshape(-1)
        slopes = bonds.stiffness(chain.law(), stretches(times))
        lengths = np.tile(kicks, len(starts))
        carry_along(dx, dp, lengths[:, None] * slopes, drifts, chain.periodic)
    dx -= entry * dp
    rows = [_rows_of_lanes(chain, lanes, 2 * n) for lanes in (dx, dp)]
    return np.vstack([_undisplaced(chain, particles).T for particles in rows])


def real_waves(chain: Chain) -> Floats:
    """Orthonormal real waves of a ring, a row each, in the order of its modes; (N-1, N).

    Mode q > 0 is the cosine of 2 pi q j / N, -q its sine. The mean is left out.

    >>> real_waves(Chain(N=4, beta=1, ends="periodic")).round(3)
    array([[ 0.   ,  0.707,  0.   , -0.707],
           [ 0.707,  0.   , -0.707, -0.   ],
           [ 0.5  , -0.5  ,  0.5  , -0.5  ]])
    """
    N, numbers = chain.N, np.array(chain.mode_numbers)[:, None]
    angles = 2 * np.pi / N * (np.abs(numbers) * np.arange(N) % N)
    size = np.where(2 * numbers == N, N**-0.5, (2 / N) ** 0.5)
    return np.asarray(size * np.where(numbers < 0, np.sin(angles), np.cos(angles)))


def _displaced(chain: Chain, rows: Floats) -> Floats:
    """Particles of real coordinates of the modes."""
    if chain.periodic:
        return np.asarray(rows @ real_waves(chain))
    return np.asarray(chain.positions(rows))


def _undisplaced(chain: Chain, rows: Floats) -> Floats:
    """The way back."""
    if chain.periodic:
        return np.asarray(rows @ real_waves(chain).T)
    return np.asarray(chain.modes(rows))


def moving_frame(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    dQ: ArrayLike,
    dP: ArrayLike,
    step: float,
    *,
    scheme: Scheme = BLANES_MOAN6,
) -> MovingFrame:
    """State and deviations for the compiled loops; arguments as those of `tangent_steps`."""
    n = chain.N - 1
    vectors = np.shape(dQ)[0] if np.ndim(dQ) == 2 else 0
    x = _particles(chain, "Q", Q, (n,))
    p = _particles(chain, "P", P, (n,))
    dx = _particles(chain, "dQ", dQ, (vectors, n))
    dp = _particles(chain, "dP", dP, (vectors, n))
    h = step_length(step)
    kicks = h * np.array(scheme.kicks, dtype=float)
    drifts = h * np.array(scheme.drifts, dtype=float)
    return MovingFrame(
        chain=chain,
        scheme=scheme,
        vectors=vectors,
        x=chain.kind_of_ends.sites(x),
        p=chain.kind_of_ends.sites(p),
        dx=_in_lanes(chain, dx),
        dp=_in_lanes(chain, dp),
        kicks=kicks,
        drifts=drifts,
    )


def step_length(step: float, name: str = "step") -> float:
    """The step as a float; InputError if it is no finite number other than zero."""
    is_number = isinstance(step, Real) and not isinstance(step, bool)
    if not is_number or not math.isfinite(float(step)) or step == 0:
        raise InputError(
            name, step, "a finite time, not zero", "pass a number such as 0.25"
        )
    return float(step)


def _particles(
    chain: Chain, name: str, values: ArrayLike, shape: tuple[int, ...]
) -> Floats:
    """Of modes of this shape to particles; raises InputError."""
    given = np.shape(values)
    if given != shape:
        advice = "pass one state and as many deviations dQ as dP"
        raise InputError(name, given, f"the shape {shape}", advice)
    modes: Numbers = np.asarray(values, dtype=chain.kind_of_ends.mode_type)
    particles = np.asarray(chain.positions(modes))
    if not np.isfinite(particles).all():
        raise InputError(name, values, "finite numbers", "start from a finite state")
    return particles


def _in_lanes(chain: Chain, rows: Floats) -> Floats:
    """Deviations of particles, a row each, as blocks of lanes at the sites."""
    # lazy: numba takes longer to import than all the rest
    from symfpu.numbers.lanes import LANES, zeros

    blocks = -(-len(rows) // LANES)
    lanes = zeros((blocks, chain.N + 1, LANES))
    for i, row in enumerate(chain.kind_of_ends.sites(rows)):
        lanes[i // LANES, :, i % LANES] = row
    return lanes


def _out_of_lanes(chain: Chain, lanes: Floats, vectors: int) -> Numbers:
    """The first deviations of blocks of lanes in mode coordinates, (vectors, N-1)."""
    return np.asarray(chain.modes(_rows_of_lanes(chain, lanes, vectors)))


def _rows_of_lanes(chain: Chain, lanes: Floats, vectors: int) -> Floats:
    """The same as displacements of the particles that move."""
    rows = lanes.transpose(0, 2, 1).reshape(-1, chain.N + 1)
    return np.asarray(chain.kind_of_ends.moving(rows[:vectors]))
