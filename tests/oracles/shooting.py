"""Breathers by shooting: Newton's method on the motion over half a period, from rest to rest, with the tangent map as its Jacobian.

Root finding as in section 6.4 of the paper; nothing of it balances harmonics. An orbit with P(0) = 0 that is at rest again at T/2
returns at T, since the motion is reversible.
"""

from typing import NamedTuple

import numpy as np

from symfpu.dynamics.kahan_li8 import KAHAN_LI8
from symfpu.dynamics.tangent import tangent_steps
from tests.tolerances import SHOT_HALF_PERIOD, SHOT_LAST_STEP, SHOT_STEP

FIRST_STEP, DOUBLINGS = 0.1, 5  # time of the coarser of the first two integrations
ITERATIONS = 25


class Shot(NamedTuple):
    """start : Q(0). closure : the distance of (omega Q, P) after a period from the start, over omega max|Q|, with steps half as long.

    history : max|P(T/2)| / (omega max|Q|) of the guess and after every Newton step.
    """

    start: np.ndarray
    closure: float
    history: tuple


def shoot(chain, seed, frequency, guess):
    """The orbit near a guess Q(0), of which the modes that the symmetry forbids are dropped."""
    half = np.pi / float(frequency)
    allowed = np.full(chain.N - 1, True)
    if chain.potential.even or seed % 2 == 0:
        allowed = (np.arange(1, chain.N) - seed) % 2 == 0
    start = np.where(allowed, guess, 0.0)
    steps = _steps(chain, start, half)
    start, history = _newton(chain, start, np.flatnonzero(allowed), half, steps)
    Q, P = _moved(chain, start, half / (2 * steps), 4 * steps)
    distance = max(np.max(np.abs(Q - start)), np.max(np.abs(P)) / float(frequency))
    return Shot(start, distance / np.max(np.abs(start)), history)


def _moved(chain, start, step, count):
    none = np.zeros((0, chain.N - 1))
    Q, P, *_ = tangent_steps(chain, start, 0 * start, none, none, step, count, scheme=KAHAN_LI8)
    return Q, P


def _newton(chain, start, free, half, steps):
    directions = np.eye(chain.N - 1)[free]
    history, before = [], np.inf
    for _ in range(ITERATIONS):
        _, P, _, slopes = tangent_steps(chain, start, 0 * start, directions, 0 * directions, half / steps, steps, scheme=KAHAN_LI8)
        history.append(np.max(np.abs(P)) * half / (np.pi * np.max(np.abs(start))))
        stalled = len(history) > 2 and history[-1] > history[-2] / 2
        if before <= SHOT_STEP or (before < SHOT_LAST_STEP and stalled):
            return start, tuple(history)
        step = np.linalg.solve(slopes[:, free].T, P[free])
        start = start.copy()
        start[free] -= step
        before = np.max(np.abs(step)) / np.max(np.abs(start))
    raise ArithmeticError(f"no convergence in {ITERATIONS} steps")


def _steps(chain, start, half):
    """Steps with which half a period from the guess is integrated to SHOT_HALF_PERIOD."""
    steps = int(np.ceil(half / FIRST_STEP))
    coarse = np.concatenate(_moved(chain, start, half / steps, steps))
    for _ in range(DOUBLINGS):
        steps *= 2
        fine = np.concatenate(_moved(chain, start, half / steps, steps))
        if np.max(np.abs(fine - coarse)) <= (2**KAHAN_LI8.order - 1) * SHOT_HALF_PERIOD * np.max(np.abs(fine)):
            break
        coarse = fine
    return steps
