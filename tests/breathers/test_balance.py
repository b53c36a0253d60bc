"""Periodic orbits against independent numbers, an elliptic oscillator, integration over a period, and where they must fail."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import symfpu
from symfpu import Chain, InputError, NoPeriodicOrbit, NoRealAmplitude, UndeterminedAmplitudes, refine
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
    orbit = symfpu.torus(Chain(known.N, alpha=known.alpha), (known.seed,), frequencies=(known.frequency,))
    assert orbit.frequency == Fraction(known.frequency)
    assert orbit.amplitude == pytest.approx(known.amplitude, rel=PERIODIC_ORBIT)
    assert orbit.energy() == pytest.approx(known.energy, rel=PERIODIC_ORBIT)
    assert orbit.residual() < NEWTON_RESIDUAL


@pytest.mark.parametrize(("chain", "seed", "amplitude"), CASES, ids=repr)
def test_the_orbit_closes(chain, seed, amplitude):
    orbit = symfpu.torus(chain, (seed,), amplitudes={seed: amplitude})
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
        orbit = symfpu.torus(chain, (seed,), frequencies=(mpmath.nstr(omega, 25),))
        assert orbit.frequency == Fraction(mpmath.nstr(omega, 25))
        assert abs(orbit.amplitude / amplitude - 1) < ELLIPTIC
        assert abs(float(symfpu.torus(chain, (seed,), amplitudes={seed: float(amplitude)}).frequency) / omega - 1) < ELLIPTIC
    others = np.delete(np.arange(N - 1), seed - 1)
    assert np.all(orbit.cosines[:, others] == pytest.approx(0, abs=ELLIPTIC))


def test_a_small_shift_of_the_frequency_loses_no_digits():
    """The Duffing oscillator at a swing of 1e-3: omega - Omega is 1e-7, of which the difference of doubles has 9 digits."""
    chain = Chain(2, beta="0.5")
    with mpmath.workdps(30):
        squared = chain.linear_frequency(1) ** 2
        omega, amplitude = duffing(squared, squared**2 / 8 * chain.C(1, 1, 1, 1), mpmath.mpf("0.001"))
        assert abs(symfpu.torus(chain, (1,), frequencies=(mpmath.nstr(omega, 29),)).amplitude / amplitude - 1) < ELLIPTIC


def test_the_breather_of_figure_9():
    """The printed A = 1.3009 at this frequency is a root of a truncated series; the orbit has another, and A = 1.3009 another frequency."""
    orbit = symfpu.torus(ALPHA, (1,), frequencies=(FIG9,))
    assert orbit.amplitude == pytest.approx(1.27153895251, abs=PERIODIC_ORBIT)
    assert orbit.energy() == pytest.approx(0.014318397381, abs=PERIODIC_ORBIT)
    printed = symfpu.torus(ALPHA, (1,), amplitudes={1: "1.3009149083500795"})
    assert float(printed.frequency) == pytest.approx(0.09845654289692, abs=tolerances.THIRTEEN_PLACES)
    assert printed.energy() == pytest.approx(0.015239087871, abs=PERIODIC_ORBIT)
    assert after_one_period(orbit) < PERIOD_RETURN
    assert refine(printed, frequencies=(FIG9,)).amplitude == pytest.approx(orbit.amplitude, rel=PERIODIC_ORBIT)


@pytest.mark.long
def test_the_walk_stays_on_the_family():
    """At A = 3 Newton's method from the linear mode falls onto a branch in resonance, mode 17 at harmonic 15, omega = 0.09874."""
    assert float(symfpu.torus(ALPHA, (1,), amplitudes={1: 3}).frequency) == pytest.approx(0.0999729484, abs=TEN_PLACES)


@pytest.fixture(scope="module")
def orbit():
    return symfpu.torus(Chain(8, alpha="0.4", beta="0.1"), (3,), amplitudes={3: "0.8"})


@pytest.mark.parametrize("what", [{"frequencies": ("0.1",)}, {"amplitudes": {1: "0.1"}}, {"energy": 1}], ids=str)
@pytest.mark.parametrize("seed", [0, 32, 1.5, "1"])
def test_seeds_outside_the_chain_are_refused(what, seed):
    with pytest.raises(InputError, match=r"^seeds = "):
        symfpu.torus(ALPHA, (seed,), **what)


@pytest.mark.parametrize("number", [0, "one", float("nan")])
def test_numbers_that_select_no_orbit_are_refused(number):
    with pytest.raises(InputError, match=r"^frequencies"):
        symfpu.torus(ALPHA, (1,), frequencies=(number,))
    with pytest.raises(InputError, match=r"^amplitudes"):
        symfpu.torus(ALPHA, (1,), amplitudes={1: number})


def test_the_wrong_side_of_the_linear_frequency_has_no_amplitude():
    with pytest.raises(NoRealAmplitude, match="A_1"):
        symfpu.torus(ALPHA, (1,), frequencies=("0.097",))
    with pytest.raises(UndeterminedAmplitudes):
        symfpu.torus(Chain(2, alpha=1), (1,), frequencies=("1.4",))


def test_a_walk_that_ends_carries_its_last_orbit():
    """A soft mode ends at its barrier."""
    with pytest.raises(NoPeriodicOrbit, match="ask for an orbit of smaller amplitude") as failure:
        symfpu.torus(Chain(6, beta=-1), (4,), amplitudes={4: "1.5"})
    assert failure.value.seed == 4
    assert failure.value.iterate.shape[1] == 5
    assert 0 < failure.value.frequency < Chain(6, beta=-1).frequencies()[3]
    assert "the best iterate" in str(failure.value)
