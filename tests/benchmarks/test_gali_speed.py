"""Alignment indices GALI_2 .. GALI_7 of the paper's chain. Measured, not asserted."""

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.dynamics.alignment import alignment_indices

CHAIN, T = Chain(32, "0.33"), 1e6


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
    found = benchmark.pedantic(alignment_indices, (CHAIN, *start(), T), {"frames": 1}, rounds=1, iterations=1)
    seconds = benchmark.stats.stats.median
    record(
        f"GALI_2..7, N = 32, T = {T:.0e}, steps of {found.step:g}",
        note=f"to 1e7: {10 * seconds:.0f} s by extrapolation; energy error {found.energy_error:.1e}; {found.dimension().verdict}",
    )
