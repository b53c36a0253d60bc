"""Alignment indices GALI_2 .. GALI_7 of the paper's chain. Measured, not asserted.

Allowed: a billion units of time within the hour on one core. With shorter vectors (a cache of machine code of their own):
NUMBA_CPU_NAME=haswell NUMBA_CPU_FEATURES= NUMBA_CACHE_DIR=... for 256 bits.
"""

import time

import numpy as np
import pytest

from symfpu import Chain, alignment_indices
from symfpu.dynamics.alignment import random_frame
from symfpu.dynamics.schemes import SCHEMES
from symfpu.dynamics.tangent import moving_frame
from symfpu.dynamics.tangent_loops import advance

CHAIN, T = Chain(32, "0.33"), 1e6
OPERATIONS = 16 + 7 * 6  # a bond and kick: of the orbit with V' and V'' of (c_3, c_4), and of seven vectors


@pytest.fixture(autouse=True)
def compiled():
    """Loops are compiled once, before anything is timed."""
    alignment_indices(CHAIN, *start(), 100.0, samples=64, frames=1)


def start():
    """Modes 1 and 2 at the amplitudes of a low-energy torus."""
    Q = np.zeros(31)
    Q[:2] = 1.0, 0.3
    return Q, np.zeros(31)


def test_gali_to_a_million(benchmark, record):
    begun = time.process_time()
    found = benchmark.pedantic(alignment_indices, (CHAIN, *start(), T), {"frames": 1}, rounds=1, iterations=1)
    hours = 1e9 / T * (time.process_time() - begun) / 3600
    record(
        f"GALI_2..7, N = 32, T = {T:.0e}, steps of {found.step:g}",
        note=f"to 1e9: {hours:.2f} h of processor time; energy error {found.energy_error:.1e}; {found.dimension().verdict}",
    )


def test_cost_of_a_step(benchmark, record):
    """Of the loop alone, and of the orbit without deviations, in turns: the seven vectors against what they are carried along."""
    scheme, steps, rounds = SCHEMES["blanes_moan6"], 20_000, 5
    frames = [moving_frame(CHAIN, *start(), *drawn, 0.4, scheme=scheme) for drawn in (random_frame(7, 31, 0), np.zeros((2, 0, 31)))]

    def seconds(frame):
        begun = time.process_time()
        advance(*frame.arguments(), steps)
        return (time.process_time() - begun) / steps

    whole, orbit = (min(each) for each in zip(*(map(seconds, frames) for _ in range(rounds)), strict=True))
    benchmark.pedantic(seconds, (frames[0],), rounds=1, iterations=1)
    updates = CHAIN.N * scheme.stages
    record(
        "a step of an orbit with 7 deviations, N = 32",
        multiply_adds=steps * updates * OPERATIONS / 2,
        note=f"{1e6 * whole:.2f} us, {1e9 * whole / updates / 7:.3f} ns a bond and vector; the orbit alone {1e6 * orbit:.2f} us",
    )
