"""Toda chains in particles, written down once more: right-hand sides, orbits, Lax and transfer matrices."""

import numpy as np
from scipy.integrate import solve_ivp

from tests.tolerances import ORBIT_STEP


def ring_of(x, p):
    """The odd state of the ring of 2N particles, of a state of a chain with fixed ends."""
    nothing = np.zeros_like(x[:1])
    return np.concatenate([nothing, x, nothing, -x[::-1]]), np.concatenate([nothing, p, nothing, -p[::-1]])


def ring_stretches(x):
    return np.roll(x, -1) - x


def accelerations(x, a):
    """Of a ring of particles."""
    force = (np.exp(2 * a * ring_stretches(x)) - 1) / (2 * a)
    return force - np.roll(force, 1)


def stiffnesses(x, a):
    return np.exp(2 * a * ring_stretches(x))


def orbit(x, p, a, times):
    """States (times, 2n) of a ring from a state, by Dormand and Prince."""
    n = len(x)

    def motion(_, state):
        return np.concatenate([state[n:], accelerations(state[:n], a)])

    start = np.concatenate([x, p])
    return solve_ivp(motion, (times[0], times[-1]), start, method="DOP853", t_eval=times, rtol=ORBIT_STEP, atol=ORBIT_STEP).y.T


def tangent_map(x, p, a, time):
    """The matrix that takes deviations of a ring (2n,) from the beginning to a time."""
    n = len(x)

    def motion(_, state):
        place, speed, rest = state[:n], state[n : 2 * n], state[2 * n :].reshape(2 * n, 2 * n)
        k = stiffnesses(place, a)
        pull = k[:, None] * (np.roll(rest[:n], -1, axis=0) - rest[:n])
        changes = np.concatenate([rest[n:], pull - np.roll(pull, 1, axis=0)])
        return np.concatenate([speed, accelerations(place, a), changes.ravel()])

    start = np.concatenate([x, p, np.eye(2 * n).ravel()])
    found = solve_ivp(motion, (0, time), start, method="DOP853", rtol=ORBIT_STEP, atol=ORBIT_STEP)
    return found.y[2 * n :, -1].reshape(2 * n, 2 * n)


def discriminant(bonds, momenta, z):
    """Delta(z): the trace of the transfer matrix over all sites of a ring."""
    product = np.eye(2)
    for j in range(len(bonds)):
        step = np.array([[(z - momenta[j]) / bonds[j], -bonds[j - 1] / bonds[j]], [1, 0]])
        product = step @ product
    return np.trace(product)
