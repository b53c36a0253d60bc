"""Orbits and tangent maps of the chain by a symmetric composition of order 8: 17 leapfrog steps,
symplectic and reversible.

W. Kahan and R.-C. Li, Math. Comp. 66 (1997) 1089, "s17odr8a". A leapfrog step of length g h is a
drift of g h/2, a kick of g h, a drift of g h/2; drifts that meet are one. Time runs with the
drifts, so that forces given as functions of time keep the order.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.dynamics.scheme import Scheme
from symfpu.errors import InputError
from symfpu.numbers.typed import integer

Floats = NDArray[np.float64]

_HALF = (
    0.13020248308889008087881763,
    0.56116298177510838456196441,
    -0.38947496264484728640807860,
    0.15884190655515560089621075,
    -0.39590389413323757733623154,
    0.18453964097831570709183254,
    0.25837438768632204729397911,
    0.29501172360931029887096624,
)
KICKS = (*_HALF, -0.60550853383003451169892108, *_HALF[::-1])
ENTRY = KICKS[0] / 2  # the first drift
DRIFTS = (
    *((left + right) / 2 for left, right in itertools.pairwise(KICKS)),
    KICKS[-1],
)  # after each kick; the last leads into the next step

ORDER = 8
KAHAN_LI8 = Scheme(
    name="kahan_li8",
    order=ORDER,
    splitting="T + V",
    source="W. Kahan and R.-C. Li, Math. Comp. 66 (1997) 1089, s17odr8a",
    drifts=(ENTRY, *DRIFTS[:-1], ENTRY),
    kicks=KICKS,
)
TABLE = 4_000_000  # entries of a table of stretches held at once


def flow(
    chain: Chain, Q: ArrayLike, P: ArrayLike, duration: float, steps: int
) -> tuple[Floats, Floats]:
    """Mode coordinates and momenta a time later; shapes (..., N-1) to the same.

    duration : a finite time, negative for the past. steps : number of steps of 17 kicks each; the
    error falls as steps^-8; for modes of Omega = 2 it is about 2e-7 a unit of time at steps of
    0.25, and 4e-14 at steps of 0.05. Raises InputError.

    >>> Q, P = flow(Chain(N=2, beta=1), [0.0], [1.0], 2.5, 40)
    >>> round(float(Chain(N=2, beta=1).energy(Q, P)), 12)
    0.5
    """
    (x, p), h, shape = (
        _padded(chain, Q, P),
        _time(duration) / integer(steps, "steps", 1),
        np.shape(Q),
    )
    law, inner_x, inner_p = chain.law(), x[1:-1], p[1:-1]
    inner_x += ENTRY * h * inner_p
    for kick, drift in itertools.islice(
        itertools.cycle(zip(KICKS, DRIFTS, strict=True)), steps * len(KICKS)
    ):
        r = x[1:] - x[:-1]
        tension = bonds.tension(law, r)
        inner_p += kick * h * (tension[1:] - tension[:-1])
        inner_x += drift * h * inner_p
    inner_x -= ENTRY * h * inner_p
    return _modes(chain, x).reshape(shape), _modes(chain, p).reshape(shape)


def tangent_flow(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    dQ: ArrayLike,
    dP: ArrayLike,
    duration: float,
    steps: int,
) -> tuple[Floats, Floats, Floats, Floats]:
    """A state a time later, and deviations from it carried along by the linearised equations.

    Q, P : one state, shape (N-1,). dQ, dP : k deviations, shape (k, N-1). Returns all four. The
    deviations are moved by the exact derivative of what moves the state: their map is symplectic
    to rounding. Raises InputError.
    """
    # lazy: numba takes longer to import than all the rest
    from symfpu.dynamics.loops import carry_along

    (x, p), (dx, dp) = (
        _padded(chain, np.reshape(Q, (1, -1)), np.reshape(P, (1, -1))),
        _padded(chain, dQ, dP),
    )
    x, p = np.hstack([x, dx]), np.hstack([p, dp])
    h = _time(duration) / integer(steps, "steps", 1)
    x[1:-1] += ENTRY * h * p[1:-1]
    carry_along(x, p, chain.law(), steps, h * np.array(KICKS), h * np.array(DRIFTS))
    x[1:-1] -= ENTRY * h * p[1:-1]
    Q, P = _modes(chain, x), _modes(chain, p)
    return Q[0], P[0], Q[1:], P[1:]


def tangent_map_along(
    chain: Chain, stretches: Callable[[Floats], Floats], duration: float, steps: int
) -> Floats:
    """Tangent map of mode coordinates and momenta along a given orbit, from time 0 to duration;
    shape (2(N-1), 2(N-1)).

    stretches : bond stretches r_j of the orbit at times (T,), shape (T, N), as often as wanted.
    Rows and columns are Q_1 .. Q_(N-1), P_1 .. P_(N-1). Raises InputError.
    """
    from symfpu.dynamics.loops import carry

    n, steps = chain.N - 1, integer(steps, "steps", 1)
    h, identity = _time(duration) / steps, np.eye(2 * n)
    x, p = _padded(chain, identity[:, :n], identity[:, n:])
    inside = np.cumsum((ENTRY, *DRIFTS[:-1]))  # times of the kicks in a step of length 1
    portion = max(1, TABLE // (len(KICKS) * chain.N))
    x[1:-1] += ENTRY * h * p[1:-1]
    for first in range(0, steps, portion):
        r = stretches(
            h * np.add.outer(np.arange(first, min(first + portion, steps)), inside).reshape(-1)
        )
        carry(x, p, bonds.stiffness(chain.law(), r), h * np.array(KICKS), h * np.array(DRIFTS))
    x[1:-1] -= ENTRY * h * p[1:-1]
    return np.vstack([_modes(chain, x).T, _modes(chain, p).T])


def _padded(chain: Chain, Q: ArrayLike, P: ArrayLike) -> tuple[Floats, Floats]:
    """Particle coordinates of states (..., N-1) as columns between walls, shape (N+1, k)."""
    x, p = (chain.positions(values).reshape(-1, chain.N - 1).T for values in (Q, P))
    if np.shape(Q) != np.shape(P):
        raise InputError(
            "P",
            np.shape(P),
            f"the shape of Q, {np.shape(Q)}",
            "pass one momentum for each coordinate",
        )
    if not (np.isfinite(x).all() and np.isfinite(p).all()):
        raise InputError("Q, P", (Q, P), "finite numbers", "start from a finite state")
    wall = np.zeros((1, x.shape[1]))
    return np.vstack([wall, x, wall]), np.vstack([wall, p, wall])


def _modes(chain: Chain, x: Floats) -> Floats:
    return np.asarray(chain.modes(x[1:-1].T))


def _time(duration: float) -> float:
    if (
        isinstance(duration, bool)
        or not isinstance(duration, Real)
        or not math.isfinite(float(duration))
    ):
        raise InputError("duration", duration, "a finite time", "pass a number")
    return float(duration)
