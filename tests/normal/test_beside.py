"""Directions beside a frequency of the torus, where shifts of the angles are solutions, too."""

from functools import cache

import numpy as np
import pytest

from symfpu import Chain, NoNormalModes, family, floquet, normal_family, normal_modes, refine
from tests.tolerances import BESIDE_MULTIPLIER, EXTRAPOLATED_ONSET

pytestmark = pytest.mark.long

ONSET = 4.7650999042  # A_1 where the energy turns: 2 sigma_11 = 18 omega
AMPLITUDES = ("4.77", "4.766", "4.7652", "4.765", "4.764", "4.76")


@cache
def near_the_turn():
    """N = 16, beta = 1, seed 1, on the branch of the family that turns at H = 0.8127."""
    found = family(Chain(16, beta=1), (1,), "5", from_energy="0.5", tolerance=1e-10, members=40)
    [fold] = [e for e in found.events if e.what == "H"]
    return found.members[fold.after].torus


def breather(A):
    return refine(near_the_turn(), amplitudes={1: A}, tolerance=1e-10)


@pytest.mark.parametrize("A", AMPLITUDES)
def test_one_mode_alone_is_found_up_to_1e_4_from_its_onset(A):
    """By the square of the logarithm of Floquet's multipliers next to 1, which is smooth through the onset."""
    orbit = breather(A)
    found = normal_modes(orbit, modes=[11])
    mode = found.mode(11)
    assert bool(mode.growth) == (float(A) < ONSET)
    assert mode.signature == (0 if mode.growth else 1)
    turn = 2 * np.pi / float(orbit.frequency)
    square = (complex(mode.sigma) * turn - 18 * np.pi) ** 2
    known = -(np.log(floquet(orbit).multipliers) ** 2)
    assert np.abs(known - square).min() < BESIDE_MULTIPLIER


def test_the_square_of_its_distance_vanishes_at_the_onset():
    """A parabola through three of each side has its zero where the energy turns."""
    squares = []
    for A in AMPLITUDES[:-1]:
        orbit = breather(A)
        off = complex(normal_modes(orbit, modes=[11]).frequencies[11]) - 9 * float(orbit.frequency)
        squares.append((off**2).real)
    beyond = np.array(AMPLITUDES[:-1], dtype=float) - ONSET
    inverse = np.polyfit(np.array(squares) / max(squares), beyond, 3)
    assert abs(inverse[-1]) < EXTRAPOLATED_ONSET


def test_a_line_through_the_onset_has_it():
    line = normal_family(breather("4.766"), {1: "4.7645"}, members=4, modes=[11], resonance_length=0)
    growing = [bool(member.mode(11).growth) for member in line.members]
    assert growing == [member.torus.amplitudes[1] < ONSET for member in line.members]


@pytest.mark.parametrize("A", ["4.76511", "4.7651", "4.76509"])
def test_nearer_than_doubles_tell_the_reason_says_what_to_do(A):
    with pytest.raises(NoNormalModes, match=r"not told from a shift.*sigma_11 = \(9\)\.omega.*move an amplitude by 1e-5"):
        normal_modes(breather(A), modes=[11])
