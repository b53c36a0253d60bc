"""Samples are those of the orbit itself, but for the rounding of steps that are cut at samples."""

import numpy as np
import pytest

from symfpu import Chain, integrate
from symfpu.spectral.samples import BLOCK, Samples
from tests.tolerances import AMPLITUDE_FROM_LINES


def test_samples_are_the_orbit_at_equal_times():
    chain = Chain(N=4, alpha="0.3", beta=1)
    Q, P = [0.2, 0.0, 0.1], [0.0, 0.1, 0.0]
    T = 0.5 * (BLOCK + 40)
    orbit = integrate(chain, Q, P, T, step=0.125, samples=np.array([100.0, 4000.0, T]))
    heard = []
    samples = Samples(orbit)
    rows = np.concatenate(list(samples.blocks(lambda label, part: heard.append(part))))
    assert len(rows) == samples.count == BLOCK + 41
    assert (rows[0] == orbit.Q[0]).all()
    places = np.rint(orbit.times / samples.interval).astype(int)
    assert rows[places] == pytest.approx(orbit.Q, abs=AMPLITUDE_FROM_LINES)
    assert heard[-1] == 1
    assert len(heard) == 2
