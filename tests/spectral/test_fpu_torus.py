"""The torus that FPU-trajectories are near: how the distance falls with the angles, and what the lines of Fig. 9's are."""

import numpy as np
import pytest

from symfpu import Chain, frequency_analysis, integrate, packet_state, refine, refine_at_amplitudes, torus_near
from tests.tolerances import COMBINATION_HEIGHT, FALL_BY_AN_ANGLE

pytestmark = pytest.mark.long

CHAIN = Chain(32, alpha="0.33")


def lines_of(energy, T):
    orbit = integrate(CHAIN, *packet_state(CHAIN, (1,), energy), T, step=0.2, samples=1)
    return frequency_analysis(orbit, lines=16, level=1e-7)


def test_each_angle_more_brings_the_torus_nearer_to_the_trajectory():
    """A trajectory on a torus of more angles than it is given would stay where it is."""
    start, _ = packet_state(CHAIN, (1,), "0.001")
    lines = lines_of("0.001", 1e5)
    distances = []
    for s in (1, 2, 3, 4):
        near = torus_near(lines, range(1, s + 1))
        torus = refine(near) if s < 4 else refine_at_amplitudes(near, near.amplitudes)
        assert torus.verdict == "torus"
        distances.append(np.abs(torus.state()[0] - start).max() / np.abs(start).max())
    falls = np.divide(distances[:-1], distances[1:])
    assert (falls > FALL_BY_AN_ANGLE).all()


def test_the_line_of_mode_8_of_fig_9_is_a_combination():
    """No sixth frequency: on the torus of four angles it is the harmonic (-1, 1, 1, 1), with its height and sign."""
    lines = lines_of("0.014915", 1e6)
    torus = refine(torus_near(lines, (1, 2, 3, 4)), tolerance=1e-6, most_harmonics=6000)
    rate = float(np.dot((-1, 1, 1, 1), [float(w) for w in torus.frequencies]))
    line = min((x for x in lines.lines if x.mode == 8), key=lambda x: abs(x.frequency - rate))
    (at,) = np.flatnonzero((torus.harmonics == (1, -1, -1, -1)).all(axis=1))
    height = line.amplitude * np.cos(line.phase)
    assert torus.cosines[at, 7] == pytest.approx(height, rel=COMBINATION_HEIGHT)
