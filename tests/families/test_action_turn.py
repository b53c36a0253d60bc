"""Where a normal frequency meets those of a torus of two angles: the actions turn there."""

from fractions import Fraction

import numpy as np
import pytest
from scipy.optimize import brentq

from symfpu import Chain, Torus, family, normal_modes, refine
from symfpu.action_angle.newton_twist import action_turn
from symfpu.normal.search import followed_modes
from tests.tolerances import EXTRAPOLATED_ONSET

SIDE = 0.02  # amplitude of the second seed
ABOVE = (4.775, 4.772, 4.77, 4.768, 4.767)  # of the first, where the direction is still elliptic


def with_a_second_seed(orbit, q):
    """The guess of a torus whose second angle turns a normal mode of an orbit."""
    mode = normal_modes(orbit, modes=[q]).mode(q)
    nu = mode.harmonics[:, 0]
    p = mode.coefficients * SIDE / mode.coefficients[nu == 0, q - 1]
    signs = np.where(nu < 0, -1, 1)
    harmonics = np.concatenate([orbit.harmonics @ [[1, 0]], np.stack([signs * nu, signs], axis=1)])
    frequencies = (orbit.frequency, Fraction(mode.sigma))
    cosines = np.concatenate([orbit.cosines, p])
    return Torus(orbit.chain, (orbit.seed, q), frequencies, harmonics, cosines, {orbit.seed: 0.0, q: 0.0})


@pytest.mark.long
def test_the_square_of_the_difference_vanishes_where_the_actions_turn():
    """N = 16, beta = 1, sigma_11 and 9 omega_1 beside the turn of the energy of seed 1: an inverse polynomial in the square."""
    found = family(Chain(16, beta=1), (1,), "5", from_energy="0.5", tolerance=1e-10, members=20)
    [fold] = [e for e in found.events if e.what == "H"]
    orbit = refine(found.members[fold.after].torus, amplitudes={1: "4.79"}, tolerance=1e-10)
    guess = with_a_second_seed(orbit, 5)

    def torus(A):
        return refine(guess, amplitudes={1: repr(A), 5: repr(SIDE)}, tolerance=1e-9)

    turn = brentq(lambda A: action_turn(torus(A)), 4.76, 4.77, xtol=1e-11)
    squares, before = [], None
    for A in (4.78, *ABOVE):
        here = torus(A)
        before, _ = followed_modes(here, before, modes=[11])
        squares.append((before.frequencies[11] - 9 * float(here.frequencies[0])) ** 2)
    near = np.array(squares[-len(ABOVE) :]) / squares[-1]
    inverse = np.polyfit(near, np.array(ABOVE) - turn, len(ABOVE) - 1)
    assert abs(inverse[-1]) < EXTRAPOLATED_ONSET
