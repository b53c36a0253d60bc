"""Every scheme: its coefficients, its observed order against exact one-mode solutions, and what splitting in mode space keeps."""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.special import ellipj

import symfpu
from symfpu import Chain, integrate
from symfpu.dynamics.schemes import SCHEMES
from tests import tolerances
from tests.tolerances import ENERGY_WALK, FAR_TAIL, ORBIT, PEER_RELATIVE, PRESENCE, SLOPE, TAIL, TAIL_MODE, THOUSAND_ROUNDINGS

# Slopes of errors over a factor of two in the step: the next order, h^2, changes them by less.
ORDER_SLOPE = 0.3

# Steps of a time of about 20 over which the error of a scheme is between rounding and one.
STEPS = {"yoshida4": (100, 140, 200), "aba864": (40, 56, 80), "blanes_moan6": (40, 56, 80), "kahan_li8": (20, 28, 40)}


def test_aba864_kills_the_terms_of_first_order_up_to_the_eighth():
    """Errors of first order in the kicks vanish where sum b_i c_i^k = 1/(k+1), c_i the times of the kicks, k = 0 .. 7."""
    scheme = SCHEMES["aba864_modes"]
    times = np.cumsum(scheme.drifts[:-1])
    for k in range(8):
        assert np.dot(scheme.kicks, times**k) == pytest.approx(1 / (k + 1), abs=tolerances.SCHEME_COEFFICIENTS)
    assert abs(np.dot(scheme.kicks, times**8) - 1 / 9) > PRESENCE


def cnoidal(chain, q, A, t):
    """Q_q(t) and P_q(t) from rest at A of the mode N/2 of the beta chain, Q'' = -a Q - b Q^3, by Jacobi's elliptic functions.

    All bonds stretch by r = +-sqrt(2/N) Omega cos(pi/4) Q: b = beta Omega^4 / (2N) sum of the eight sign choices.
    """
    a = 2.0
    b = 2 * a * float(chain.beta) * (math.sqrt(2 / chain.N) * math.sqrt(2) * math.cos(math.pi / 4)) ** 2 / 2
    w = math.sqrt(a + b * A * A)
    sn, cn, dn, _ = ellipj(w * t, b * A * A / (2 * w * w))
    return A * cn, -A * w * sn * dn


def half_period(chain, A):
    """Time and place of the other turning point of the mode 2N/3 of the alpha chain, Q'' = -3 Q + k Q^2, from rest at A, by quadrature."""
    k = float(chain.alpha) / math.sqrt(2 * chain.N) * 3 * math.sqrt(3)
    # E - V = (A - Q) (Q - B) (c - (k/3) Q) with the turning points A > B
    other = np.roots([k / 3, k / 3 * A - 1.5, (k / 3 * A - 1.5) * A])
    B = float(min(other, key=abs))
    far = float(max(other, key=abs))
    time, _ = quad(lambda phi: 1 / math.sqrt(2 * k / 3 * (far - (A + B) / 2 - (A - B) / 2 * math.cos(phi))), 0, math.pi, epsabs=1e-14)
    return time, B


def error_of_beta(name, steps, A=0.5, T=20.0):
    chain, q = Chain(8, beta=1), 4
    orbit = integrate(chain, A * np.eye(7)[q - 1], np.zeros(7), T, step=T / steps, scheme=name, samples=1)
    return float(np.max(np.abs(np.array(cnoidal(chain, q, A, T)) - (orbit.Q[-1, q - 1], orbit.P[-1, q - 1]))))


def error_of_alpha(name, steps, A=0.4, halves=12):
    chain, q = Chain(6, alpha="0.5"), 4
    half, _ = half_period(chain, A)
    T = halves * half
    orbit = integrate(chain, A * np.eye(5)[q - 1], np.zeros(5), T, step=T / steps, scheme=name, samples=1)
    return float(np.max(np.abs((orbit.Q[-1, q - 1] - A, orbit.P[-1, q - 1]))))


@pytest.mark.parametrize("error", [error_of_beta, error_of_alpha])
@pytest.mark.parametrize("name", STEPS)
def test_the_observed_order_on_one_mode(name, error):
    errors = [error(name, n) for n in STEPS[name]]
    assert -np.polyfit(np.log(STEPS[name]), np.log(errors), 1)[0] == pytest.approx(SCHEMES[name].order, abs=ORDER_SLOPE)
    assert error(name, 40 * STEPS[name][0]) < tolerances.FORTY_TIMES_THE_STEPS
    assert error("kahan_li8", 800) < THOUSAND_ROUNDINGS


def test_the_splitting_in_modes_has_order_six_for_small_kicks_and_four_for_large_ones():
    """epsilon^2 h^6 + epsilon^3 h^4; the part epsilon h^8 is below both."""
    for A, steps, order in ((0.1, (50, 64, 80), 6), (4.0, (100, 140, 200), 4)):
        errors = [error_of_beta("aba864_modes", n, A=A) for n in steps]
        assert -np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(order, abs=ORDER_SLOPE)


def test_the_force_in_modes_is_that_of_the_chain():
    """Both splittings with short steps, all modes alive, both couplings."""
    chain, random = Chain(9, alpha="0.4", beta="0.7"), np.random.default_rng(5)
    Q, P = random.normal(scale=0.2, size=(2, 3, 8))
    ends = [integrate(chain, Q, P, 2.0, step=0.005, scheme=name, samples=1) for name in ("kahan_li8", "aba864_modes")]
    particles, modes = (np.stack([end.Q, end.P]) for end in ends)
    assert modes == pytest.approx(particles, abs=THOUSAND_ROUNDINGS)


def scaled_oracle(chain, A, T):
    """Modes at time T from Q_1 = A alone, as y_q = Q_q / A^q, all of size one: DOP853 on the sums over the couplings B, Eq. eqmo."""
    Omega, n = chain.frequencies(), chain.N - 1
    modes = range(1, chain.N)
    terms = [(q, l, m, b * A ** (l + m - q)) for l in modes for m in modes for q, b in chain.coupled(l, m)]
    q, l, m = (np.array(column) - 1 for column in list(zip(*terms, strict=True))[:3])
    weights = np.array([term[3] for term in terms]) * float(chain.alpha) / math.sqrt(2 * chain.N) * Omega[q] * Omega[l] * Omega[m]

    def rates(t, y):
        force = -(Omega**2) * y[:n]
        np.subtract.at(force, q, weights * y[l] * y[m])
        return np.append(y[n:], force)

    run = solve_ivp(rates, (0, T), np.append(np.eye(n)[0], np.zeros(n)), "DOP853", rtol=PEER_RELATIVE, atol=tolerances.PEER_ABSOLUTE)
    return run.y[:n, -1]


def test_tail_modes_keep_their_relative_accuracy_in_mode_space_alone():
    """Modes down to 1e-35, fed by products of products: seed 1, A = 1e-5. DOP853 is good to some 1e-11 here."""
    chain, A, T = Chain(8, alpha="0.33"), 1e-5, 40.0
    exact = scaled_oracle(chain, A, T) * A ** np.arange(1.0, 8)
    start = A * np.eye(7)[0], np.zeros(7)
    errors = {}
    for name in ("aba864_modes", "kahan_li8"):
        errors[name] = np.abs(integrate(chain, *start, T, step=0.05, scheme=name, samples=1).Q[-1] / exact - 1)
    assert np.min(np.abs(exact)) < FAR_TAIL
    assert np.max(errors["aba864_modes"]) < ORBIT
    assert np.max(errors["kahan_li8"][:2]) < 1e-4
    assert np.min(errors["kahan_li8"][4:]) > 1


def test_tails_of_an_orbit_are_those_of_the_series():
    """The breather of seed 1 by its series, modes 6 and 7 below 1e-30: in mode space the orbit follows every mode to a relative error that
    falls as step^4."""
    torus = symfpu.torus(Chain(8, alpha="0.33"), (1,), amplitudes={1: "1e-5"}, method="series", order=8)
    start, times, errors = (torus.Q(0.0), torus.P(0.0)), np.linspace(0.0, 300.0, 31), []
    for step in (0.1, 0.05):
        made = integrate(torus.chain, *start, 300.0, step=step, scheme="aba864_modes", samples=times)
        there = torus.Q(made.times)
        largest = np.abs(there).max(axis=0)
        assert np.all(largest[5:] < TAIL_MODE)
        errors.append(np.max(np.abs(made.Q - there) / largest, axis=0))
    assert np.max(errors[1]) < TAIL
    assert np.log2(errors[0][4:] / errors[1][4:]) == pytest.approx([4, 4, 4], abs=SLOPE)


@pytest.mark.parametrize(
    ("chain", "seeds", "alive"),
    [
        (Chain(16, beta="0.7"), (1, 3), range(1, 16, 2)),
        (Chain(16, alpha="0.5", beta="0.2"), (4,), (4, 8, 12)),
        (Chain(16, beta="0.7"), (5,), (1, 3, 5, 7, 9, 11, 13, 15)),
        (Chain(15, alpha="0.5"), (10,), (10,)),
    ],
)
def test_modes_that_no_product_feeds_stay_exactly_zero(chain, seeds, alive):
    Q = sum(0.3 * np.eye(chain.N - 1)[q - 1] for q in seeds)
    orbit = integrate(chain, Q, np.zeros_like(Q), 200, step=0.25, scheme="aba864_modes")
    moved = np.flatnonzero(np.any((orbit.Q != 0) | (orbit.P != 0), axis=0)) + 1
    assert list(moved) == list(alive)


@pytest.mark.long
def test_rotations_do_not_grow():
    """Six million rotations of a nearly harmonic chain: the largest relative change of H is a random walk of roundings, not a growth."""
    chain = Chain(4, alpha="1e-9")
    orbit = integrate(chain, [0.1, 0.2, 0.3], [0.0, 0.1, 0.0], 2e5, step=0.25, scheme="aba864_modes", samples=50)
    assert orbit.energy_error < ENERGY_WALK
