"""Tori by their amplitudes, and Floquet's multipliers held against normal frequencies."""

from functools import cache

import numpy as np

import symfpu
from symfpu import refine
from tests.tolerances import NORMAL_MULTIPLIER


@cache
def torus(chain, amplitudes, order=6):
    """Of pairs (seed, amplitude), by Newton's method in doubles."""
    wanted = dict(amplitudes)
    return refine(symfpu.torus(chain, tuple(wanted), amplitudes=wanted, method="series", order=order), amplitudes=wanted)


def assert_multipliers(found, expected):
    """Each of Floquet's but the two at 1 is one of the quartets of the normal modes, and the other way round."""
    assert found.stable == expected.stable
    ours = np.array(list(found.multipliers().values()))
    ours = np.concatenate([ours, 1 / ours, ours.conj(), 1 / ours.conj()])
    for one, other in ((expected.multipliers[2:], ours), (ours, expected.multipliers[2:])):
        assert max(np.abs(other - value).min() for value in one) < NORMAL_MULTIPLIER
