"""The torus that FPU-trajectories are near: how the distance falls with the angles, and what the lines of Fig. 9's are."""

import math
from fractions import Fraction

import numpy as np
import pytest

import symfpu
from symfpu import Chain, Torus, integrate, packet_state, refine, torus_near
from tests.tolerances import AT_THE_START, COMBINATION_HEIGHT, FALL_BY_AN_ANGLE

pytestmark = pytest.mark.long

CHAIN = Chain(32, alpha="0.33")


def lines_of(energy, T):
    orbit = integrate(CHAIN, *packet_state(CHAIN, (1,), energy), T, step=0.2, samples=1)
    return symfpu.frequency_analysis(orbit, lines=16, level=1e-7)


def test_each_angle_more_brings_the_torus_nearer_to_the_trajectory():
    """A trajectory on a torus of more angles than it is given would stay where it is."""
    start, _ = packet_state(CHAIN, (1,), "0.001")
    lines = lines_of("0.001", 1e5)
    distances = []
    for s in (1, 2, 3):  # four to six: test_up_to_six_angles_none_is_the_last_of_fig_9
        torus = refine(torus_near(lines, range(1, s + 1)))
        assert not torus.warnings
        distances.append(np.abs(torus.state()[0] - start).max() / np.abs(start).max())
    falls = np.divide(distances[:-1], distances[1:])
    assert (falls > FALL_BY_AN_ANGLE).all()


def require_combination(lines):
    """The line of mode 8 is no sixth frequency: on the torus of four angles it is the harmonic (-1, 1, 1, 1), with its height and sign."""
    torus = refine(torus_near(lines, (1, 2, 3, 4)), tolerance=1e-6, most_harmonics=6000)
    rate = float(np.dot((-1, 1, 1, 1), [float(w) for w in torus.frequencies]))
    line = min((x for x in lines.lines if x.mode == 8), key=lambda x: abs(x.frequency - rate))
    (at,) = np.flatnonzero((torus.harmonics == (1, -1, -1, -1)).all(axis=1))
    height = line.amplitude * np.cos(line.phase)
    assert torus.cosines[at, 7] == pytest.approx(height, rel=COMBINATION_HEIGHT)


# of mode 6 at rest: omega - Omega by the fourth order's shift for A_1 .. A_5, and the coordinate that five angles leave
SHIFT_OF_MODE_6, START_OF_MODE_6 = -1.6e-5, -1e-4
FEW = 4000  # harmonics: residuals of some 1e-5, below the distances that are compared but for the last


def at_rest(torus):
    """With phases 0 and pi."""
    phases = {q: math.pi * round(float(x) / math.pi) for q, x in torus.phases.items()}
    return Torus(torus.chain, torus.seeds, torus.frequencies, torus.harmonics, torus.cosines, phases)


def with_mode_6(torus):
    """And a small motion of mode 6."""
    count = len(torus.harmonics)
    harmonics = np.zeros((count + 1, 6), dtype=np.int64)
    harmonics[:-1, :-1] = torus.harmonics
    harmonics[-1, -1] = 1
    row = np.zeros((1, 31))
    row[0, 5] = abs(START_OF_MODE_6)
    omega = Fraction(float(CHAIN.linear_frequency(6)) + SHIFT_OF_MODE_6)
    phases = dict(torus.phases) | {6: math.pi}
    return Torus(CHAIN, (*torus.seeds, 6), (*torus.frequencies, omega), harmonics, np.concatenate([torus.cosines, row]), phases)


def test_up_to_six_angles_none_is_the_last_of_fig_9():
    """Tori through the start of their seeds: each angle more divides what is left in the other modes by ten or more."""
    start, _ = packet_state(CHAIN, (1,), "0.014915")
    lines = lines_of("0.014915", 1e6)
    require_combination(lines)
    distances = []
    near = None
    for s in (4, 5, 6):
        if s < 6:
            guess = at_rest(torus_near(lines, range(1, s + 1)))
            near = refine(guess, amplitudes=guess.amplitudes, most_harmonics=FEW)
        else:
            near = with_mode_6(near)
        near = refine(near, start={q: float(start[q - 1]) for q in near.seeds}, most_harmonics=FEW)
        left = np.abs(near.Q(0.0) - start) / start[0]
        assert left[:s].max() < AT_THE_START
        assert near.energy() == pytest.approx(0.014915, rel=10.0 ** (-s))
        distances.append(left.max())
    falls = np.divide(distances[:-1], distances[1:])
    assert (falls > 10).all()
