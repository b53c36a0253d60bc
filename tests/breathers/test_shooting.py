"""Shooting against harmonic balance, exact oscillators of one mode, and where it must fail."""

import itertools

import mpmath
import numpy as np
import pytest

from symfpu.breathers.balance import breather_at_amplitude, periodic_orbit
from symfpu.breathers.shooting import ShootingFailed, shoot
from symfpu.chain.chain import Chain
from symfpu.dynamics.schemes import PARTICLE_SCHEMES
from symfpu.errors import InputError, NoRealAmplitude, UndeterminedAmplitudes
from tests.oracles.oscillators import duffing
from tests.tolerances import NEWTON_RESIDUAL, OBSERVED_ORDER, PROMISED_RESIDUAL, SAME_ORBIT, SHOT_AMPLITUDE

ALPHA = Chain(N=32, alpha="0.33")

CASES = (
    (ALPHA, 1, "0.0981410995944860"),
    (ALPHA, 25, "1.8830741847088537"),
    (Chain(8, alpha="0.4", beta="0.1"), 3, "1.1137547"),
    (Chain(9, beta=1), 4, "1.3174"),
    (Chain(6, beta="-0.3"), 4, "1.72"),
)


@pytest.mark.parametrize(("chain", "seed", "frequency"), CASES, ids=repr)
def test_shooting_finds_the_orbit_of_harmonic_balance(chain, seed, frequency):
    """By another discretisation, from the linear mode."""
    shot, orbit = shoot(chain, seed, frequency), periodic_orbit(chain, seed, frequency)
    assert shot.start == pytest.approx(orbit.positions(0.0), abs=SHOT_AMPLITUDE * np.max(np.abs(shot.start)))
    assert shot.energy() == pytest.approx(orbit.energy(), rel=2 * SHOT_AMPLITUDE)
    assert shot.harmonic_energies().sum() == pytest.approx(orbit.harmonic_energies().sum(), rel=2 * SHOT_AMPLITUDE)
    assert shot.frequency == orbit.frequency
    assert shot.closure < NEWTON_RESIDUAL


@pytest.mark.parametrize(("chain", "seed", "frequency"), CASES, ids=repr)
def test_convergence_is_quadratic(chain, seed, frequency):
    """Every residual below the square of the one before, times a constant, until 1e-13 is reached."""
    history = shoot(chain, seed, frequency).history
    seen = [(before, after) for before, after in itertools.pairwise(history[1:]) if after > 1e-13]
    assert all(after < 1e4 * before**2 for before, after in seen)
    assert history[-1] < PROMISED_RESIDUAL
    assert len(history) <= 9


@pytest.mark.parametrize(("N", "seed"), [(4, 2), (6, 4), (9, 3)])
def test_one_mode_of_beta_turns_where_the_duffing_oscillator_turns(N, seed):
    chain = Chain(N, beta="0.5")
    with mpmath.workdps(30):
        squared = chain.linear_frequency(seed) ** 2
        omega, _ = duffing(squared, mpmath.mpf("0.5") / (2 * N) * squared**2 * chain.C(*[seed] * 4), mpmath.mpf(1))
        shot = shoot(chain, seed, mpmath.nstr(omega, 25))
    expected = np.zeros(N - 1)
    expected[seed - 1] = 1
    assert shot.start == pytest.approx(expected, abs=NEWTON_RESIDUAL)


@pytest.mark.parametrize(("name", "agree"), [("blanes_moan6", 1e-11), ("aba864", 1e-10), ("yoshida4", 1e-7)])
def test_another_scheme_finds_the_same_orbit(name, agree):
    """To the error of its shortest steps, which the residual shows."""
    problem = Chain(8, alpha="0.4", beta="0.1"), 3, "1.1137547"
    one, other = shoot(*problem), shoot(*problem, scheme=name)
    assert other.start == pytest.approx(one.start, abs=agree)
    assert other.closure < agree
    assert other.history[-1] < NEWTON_RESIDUAL


def test_the_error_of_shooting_falls_as_the_order_of_the_scheme(monkeypatch):
    problem = Chain(8, alpha="0.4", beta="0.1"), 3, "1.1137547"
    exact = shoot(*problem).start
    monkeypatch.setattr("symfpu.breathers.shooting.DOUBLINGS", 0)
    for name, scheme in PARTICLE_SCHEMES.items():
        shots = []
        for step in (0.4, 0.2):
            monkeypatch.setattr("symfpu.breathers.shooting.FIRST_STEP", step)
            shots.append(shoot(*problem, scheme=name))
        coarse, fine = (np.max(np.abs(shot.start - exact)) for shot in shots)
        order = np.log(coarse / fine) / np.log(shots[1].steps / shots[0].steps)
        assert order == pytest.approx(scheme.order, abs=OBSERVED_ORDER), name


def test_a_guess_leads_to_an_orbit_far_from_rest():
    orbit = breather_at_amplitude(ALPHA, 1, "1.27")
    shot = shoot(ALPHA, 1, orbit.frequency, 1.01 * orbit.positions(0.0))
    assert shot.start == pytest.approx(orbit.positions(0.0), abs=SAME_ORBIT)
    assert shot.iterations == len(shot.history) - 1 > 1
    assert repr(shot).startswith("ShotOrbit(N=32, alpha=0.33, seed 1, omega=0.0984")


def test_modes_that_the_symmetry_forbids_stay_zero():
    orbit = breather_at_amplitude(Chain(8, alpha="0.4"), 2, "0.3")
    shot = shoot(orbit.chain, 2, orbit.frequency, orbit.positions(0.0) + 1e-3)
    assert not shot.start[::2].any()
    assert shot.start == pytest.approx(orbit.positions(0.0), abs=SAME_ORBIT)


@pytest.mark.parametrize("guess", ["x", 1.0, np.ones(30), np.zeros(31), np.full(31, np.nan), np.ones((2, 31))])
def test_bad_guesses_are_refused(guess):
    with pytest.raises(InputError, match=r"^guess = "):
        shoot(ALPHA, 1, "0.0982", guess)


@pytest.mark.parametrize("scheme", ["aba864_modes", "rk4", 8])
def test_schemes_that_move_no_deviations_are_refused(scheme):
    with pytest.raises(InputError, match=r"^scheme = .*choose one of them"):
        shoot(ALPHA, 1, "0.0982", scheme=scheme)


def test_bad_seeds_and_frequencies_are_refused():
    with pytest.raises(InputError, match=r"^seeds = "):
        shoot(ALPHA, 32, "0.0982")
    with pytest.raises(InputError, match=r"^frequency = "):
        shoot(ALPHA, 1, "-0.0982")
    with pytest.raises(NoRealAmplitude):
        shoot(ALPHA, 1, "0.0980")
    with pytest.raises(UndeterminedAmplitudes):
        shoot(ALPHA, 16, "1.41")


def test_failures_carry_the_best_start():
    with pytest.raises(ShootingFailed, match="runs away") as failure:
        shoot(Chain(6, alpha=1), 4, "1.7", np.array([0, 0, 0, 50.0, 0]))
    assert failure.value.seed == 4
    assert failure.value.iterate.shape == (5,)
    with pytest.raises(ShootingFailed, match="pass as guess") as failure:
        shoot(Chain(6, beta=1), 5, "0.7", np.array([0.3, 0, 0.2, 0, 1.0]))
    assert failure.value.residual == min(failure.value.residuals)
