"""Periodic orbits against independent numbers, an elliptic oscillator, integration over a period, and where they must fail."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symfpu import Chain, InputError, NoPeriodicOrbit, NoRealAmplitude, UndeterminedAmplitudes, breather_at_amplitude, periodic_orbit
from tests import tolerances
from tests.oracles.oscillators import duffing
from tests.reference import PERIODIC_ORBITS
from tests.tolerances import ELLIPTIC, LAST_DIGIT, NEWTON_RESIDUAL, PEER_RELATIVE, PERIOD_RETURN, PERIODIC_ORBIT, TEN_PLACES

ALPHA = Chain(N=32, alpha="0.33")
FIG9 = "0.09844127049688513"

CASES = (
    (Chain(N=6, alpha="0.25", beta="0.3"), 4, "0.3"),
    (Chain(N=5, beta="-0.3"), 4, "0.3"),
    (Chain(N=8, alpha="-0.4"), 2, "0.5"),
    (Chain(N=9, alpha=1), 3, "-0.3"),
    (Chain(N=2, alpha=1, beta=1), 1, "0.5"),
    (ALPHA, 1, "1.27"),
)


def after_one_period(orbit):
    chain, Q = orbit.chain, orbit.Q(0.0)
    start = np.concatenate([Q, np.zeros_like(Q)])

    def field(t, y):
        return np.concatenate([y[len(Q) :], chain.accelerations(y[: len(Q)])])

    period = 2 * np.pi / float(orbit.frequency)
    end = solve_ivp(field, (0, period), start, method="DOP853", rtol=PEER_RELATIVE, atol=tolerances.PEER_ABSOLUTE).y[:, -1]
    return np.max(np.abs(end - start)) / np.max(np.abs(start))


@pytest.mark.parametrize("known", PERIODIC_ORBITS, ids=lambda known: f"seed {known.seed}")
def test_independent_numbers(known):
    orbit = periodic_orbit(Chain(known.N, alpha=known.alpha), known.seed, known.frequency)
    assert orbit.frequency == Fraction(known.frequency)
    assert orbit.amplitude == pytest.approx(known.amplitude, rel=PERIODIC_ORBIT)
    assert orbit.energy() == pytest.approx(known.energy, rel=PERIODIC_ORBIT)
    assert orbit.residual() < NEWTON_RESIDUAL


@pytest.mark.parametrize(("chain", "seed", "amplitude"), CASES, ids=repr)
def test_the_orbit_closes(chain, seed, amplitude):
    orbit = breather_at_amplitude(chain, seed, amplitude)
    assert orbit.amplitude == pytest.approx(float(amplitude), rel=LAST_DIGIT)
    assert orbit.residual() < NEWTON_RESIDUAL
    assert after_one_period(orbit) < PERIOD_RETURN


@pytest.mark.parametrize(("N", "seed"), [(2, 1), (4, 2), (6, 4), (9, 3)])
def test_one_mode_of_beta_is_the_duffing_oscillator(N, seed):
    """N/2, 2N/3 and N/3: x'' + Omega^2 x + (beta / 2N) Omega^4 C_qqqq x^3 = 0, solved by elliptic functions; large swing."""
    chain = Chain(N, beta="0.5")
    with mpmath.workdps(30):
        squared = chain.linear_frequency(seed) ** 2
        omega, amplitude = duffing(squared, mpmath.mpf("0.5") / (2 * N) * squared**2 * chain.C(*[seed] * 4), mpmath.mpf(1))
        orbit = periodic_orbit(chain, seed, mpmath.nstr(omega, 25))
        assert orbit.frequency == Fraction(mpmath.nstr(omega, 25))
        assert abs(orbit.amplitude / amplitude - 1) < ELLIPTIC
        assert abs(float(breather_at_amplitude(chain, seed, float(amplitude)).frequency) / omega - 1) < ELLIPTIC
    others = np.delete(np.arange(N - 1), seed - 1)
    assert np.all(orbit.cosines[:, others] == pytest.approx(0, abs=ELLIPTIC))


def test_a_small_shift_of_the_frequency_loses_no_digits():
    """The Duffing oscillator at a swing of 1e-3: omega - Omega is 1e-7, of which the difference of doubles has 9 digits."""
    chain = Chain(2, beta="0.5")
    with mpmath.workdps(30):
        squared = chain.linear_frequency(1) ** 2
        omega, amplitude = duffing(squared, squared**2 / 8 * chain.C(1, 1, 1, 1), mpmath.mpf("0.001"))
        assert abs(periodic_orbit(chain, 1, mpmath.nstr(omega, 29)).amplitude / amplitude - 1) < ELLIPTIC


def test_the_breather_of_figure_9():
    """The printed A = 1.3009 at this frequency is a root of a truncated series; the orbit has another, and A = 1.3009 another frequency."""
    orbit = periodic_orbit(ALPHA, 1, FIG9)
    assert orbit.amplitude == pytest.approx(1.27153895251, abs=PERIODIC_ORBIT)
    assert orbit.energy() == pytest.approx(0.014318397381, abs=PERIODIC_ORBIT)
    printed = breather_at_amplitude(ALPHA, 1, "1.3009149083500795")
    assert float(printed.frequency) == pytest.approx(0.09845654289692, abs=tolerances.THIRTEEN_PLACES)
    assert printed.energy() == pytest.approx(0.015239087871, abs=PERIODIC_ORBIT)
    assert after_one_period(orbit) < PERIOD_RETURN
    assert periodic_orbit(ALPHA, 1, FIG9, printed.cosines).amplitude == pytest.approx(orbit.amplitude, rel=PERIODIC_ORBIT)


@pytest.mark.long
def test_the_walk_stays_on_the_family():
    """At A = 3 Newton's method from the linear mode falls onto a branch in resonance, mode 17 at harmonic 15, omega = 0.09874."""
    assert float(breather_at_amplitude(ALPHA, 1, 3).frequency) == pytest.approx(0.0999729484, abs=TEN_PLACES)


@pytest.fixture(scope="module")
def orbit():
    return breather_at_amplitude(Chain(8, alpha="0.4", beta="0.1"), 3, "0.8")


@pytest.mark.parametrize("search", [periodic_orbit, breather_at_amplitude])
@pytest.mark.parametrize("seed", [0, 32, 1.5, "1"])
def test_seeds_outside_the_chain_are_refused(search, seed):
    with pytest.raises(InputError, match=r"^seeds = "):
        search(ALPHA, seed, "0.1")
    with pytest.raises(InputError, match=r"^seeds = "):
        search(ALPHA, seed, "0.1", np.ones((2, 31)))


@pytest.mark.parametrize("number", [0, "one", float("nan")])
def test_numbers_that_select_no_orbit_are_refused(number):
    with pytest.raises(InputError, match=r"^frequency = "):
        periodic_orbit(ALPHA, 1, number)
    with pytest.raises(InputError, match=r"^amplitude = "):
        breather_at_amplitude(ALPHA, 1, number)


@pytest.mark.parametrize("guess", ["x", 1.0, np.ones((1, 31)), np.ones((3, 30)), np.zeros((2, 31)), np.full((2, 31), np.nan)])
def test_bad_guesses_are_refused(guess):
    with pytest.raises(InputError, match=r"^guess = "):
        periodic_orbit(ALPHA, 1, FIG9, guess)


def test_more_unknowns_than_memory_are_refused():
    with pytest.raises(InputError, match="cut the guess"):
        periodic_orbit(ALPHA, 1, FIG9, np.ones((1000, 31)))


def test_the_wrong_side_of_the_linear_frequency_has_no_amplitude():
    with pytest.raises(NoRealAmplitude, match="A_1"):
        periodic_orbit(ALPHA, 1, "0.097")
    with pytest.raises(UndeterminedAmplitudes):
        periodic_orbit(Chain(2, alpha=1), 1, "1.4")


@pytest.mark.parametrize("scale", [1e-6, 40.0, 1e200])
def test_a_search_that_fails_carries_its_best_iterate(scale):
    guess = np.zeros((3, 31))
    guess[1, 0] = scale
    guess[2, 1] = -scale
    with pytest.raises(NoPeriodicOrbit, match="start from a guess nearer") as failure:
        periodic_orbit(ALPHA, 1, FIG9, guess)
    assert failure.value.seed == 1
    assert failure.value.iterate.shape[1] == 31
    assert failure.value.frequency == pytest.approx(float(FIG9), rel=LAST_DIGIT)
    assert not failure.value.residual < tolerances.NO_CONVERGENCE
