"""Breathers of harmonic balance against shooting, another discretisation, and shooting against an exact oscillator."""

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain
from tests.oracles.oscillators import duffing
from tests.oracles.shooting import shoot
from tests.tolerances import NEWTON_RESIDUAL, SAME_ORBIT, SHOT_AMPLITUDE

ALPHA = Chain(N=32, alpha="0.33")

CASES = (
    (ALPHA, 1, "0.0981410995944860"),
    (ALPHA, 25, "1.8830741847088537"),
    (Chain(8, alpha="0.4", beta="0.1"), 3, "1.1137547"),
    (Chain(9, beta=1), 4, "1.3174"),
    (Chain(6, beta="-0.3"), 4, "1.72"),
)


def from_the_linear_mode(chain, seed, frequency):
    """The seed alone, with the amplitude of the orbit to a tenth."""
    guess = np.zeros(chain.N - 1)
    guess[seed - 1] = 1.1 * symfpu.torus(chain, (seed,), frequencies=(frequency,)).amplitude
    return shoot(chain, seed, frequency, guess)


@pytest.mark.parametrize(("chain", "seed", "frequency"), CASES, ids=repr)
def test_harmonic_balance_finds_the_orbit_of_shooting(chain, seed, frequency):
    shot, orbit = from_the_linear_mode(chain, seed, frequency), symfpu.torus(chain, (seed,), frequencies=(frequency,))
    assert shot.start == pytest.approx(orbit.Q(0.0), abs=SHOT_AMPLITUDE * np.max(np.abs(shot.start)))
    assert chain.energy(shot.start, 0 * shot.start) == pytest.approx(orbit.energy(), rel=2 * SHOT_AMPLITUDE)
    assert shot.closure < NEWTON_RESIDUAL


@pytest.mark.parametrize(("N", "seed"), [(4, 2), (6, 4), (9, 3)])
def test_one_mode_of_beta_turns_where_the_duffing_oscillator_turns(N, seed):
    chain = Chain(N, beta="0.5")
    with mpmath.workdps(30):
        squared = chain.linear_frequency(seed) ** 2
        omega, _ = duffing(squared, mpmath.mpf("0.5") / (2 * N) * squared**2 * chain.C(*[seed] * 4), mpmath.mpf(1))
    expected = np.zeros(N - 1)
    expected[seed - 1] = 1
    assert shoot(chain, seed, omega, 1.1 * expected).start == pytest.approx(expected, abs=NEWTON_RESIDUAL)
    assert symfpu.torus(chain, (seed,), frequencies=(mpmath.nstr(omega, 25),)).Q(0.0) == pytest.approx(expected, abs=NEWTON_RESIDUAL)


@pytest.mark.parametrize(("chain", "seed", "amplitude"), [(ALPHA, 1, "1.27"), (Chain(8, alpha="0.4"), 2, "0.3")])
def test_orbits_far_from_rest(chain, seed, amplitude):
    """Seed 2: the odd modes, which the symmetry forbids, are not taken from the guess."""
    orbit = symfpu.torus(chain, (seed,), amplitudes={seed: amplitude})
    shot = shoot(chain, seed, orbit.frequency, 1.001 * orbit.Q(0.0) + (1e-3 if seed == 2 else 0.0))
    assert shot.start == pytest.approx(orbit.Q(0.0), abs=SAME_ORBIT)
    assert seed == 1 or not orbit.Q(0.0)[::2].any()
