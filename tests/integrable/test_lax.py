"""Gaps of states: constants of the motion, symmetric on the ring, linear in small amplitudes, to any number of digits."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symfpu import Chain, InputError, toda, toda_gaps
from symfpu.integrable.lax import jacobi_entries, ring_edges
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION
from tests.integrable.chains import orbit, ring_of, ring_stretches
from tests.refusals import each, refused
from tests.tolerances import FORTY_DIGITS, GAP, GAP_DRIFT, TODA_LINEAR

A = Fraction(1, 2)
LENGTHS = (2, 3, 4, 5, 8)


def state(N, scale=0.3):
    return np.random.default_rng(N).normal(size=(2, N - 1)) * scale


def ring_gaps(x, p, numbers=DOUBLES):
    bonds, momenta = jacobi_entries(ring_stretches(x), p, A, numbers)
    _, upper, lower, _ = ring_edges(bonds, momenta, numbers)
    return upper - lower


@pytest.mark.parametrize("N", LENGTHS)
def test_gaps_are_those_of_the_ring_of_twice_the_length(N):
    """Two formulations: singular values of two blocks, and eigenvalues of the whole ring."""
    chain, (Q, P) = Chain(N, potential=toda(A)), state(N)
    gaps = toda_gaps(chain, Q, P)
    whole = ring_gaps(*ring_of(chain.positions(Q), chain.positions(P)))
    assert whole[: N - 1] == pytest.approx(gaps, abs=GAP)
    assert whole[N:][::-1] == pytest.approx(gaps, abs=GAP)
    assert abs(whole[N - 1]) < GAP
    assert gaps.min() > 100 * GAP


@pytest.mark.parametrize("N", [3, 8])
def test_gaps_do_not_move_along_an_orbit_of_toda_and_do_along_others(N):
    chain, (Q, P) = Chain(N, potential=toda(A)), state(N)
    start = ring_of(chain.positions(Q), chain.positions(P))
    states = orbit(*start, float(A), np.linspace(0, 30, 40))
    gaps = toda_gaps(chain, chain.modes(states[:, 1:N]), chain.modes(states[:, 2 * N + 1 : 3 * N]))
    assert np.ptp(gaps, axis=0).max() < GAP_DRIFT
    harmonic = [np.cos(1.7 * chain.frequencies()) * Q + np.sin(1.7 * chain.frequencies()) / chain.frequencies() * P, P]
    assert abs(toda_gaps(chain, *harmonic) - gaps[0]).max() > 1e6 * GAP_DRIFT


def test_gaps_of_a_travelling_orbit_of_a_ring_do_not_move():
    x, p = np.random.default_rng(7).normal(size=(2, 7)) * 0.3
    states = orbit(x, p - p.mean(), float(A), np.linspace(0, 20, 9))
    gaps = np.array([ring_gaps(y[:7], y[7:]) for y in states])
    assert np.ptp(gaps, axis=0).max() < GAP_DRIFT
    assert gaps[0].min() > 1e6 * GAP_DRIFT


@pytest.mark.parametrize("q", [1, 3, 7])
@pytest.mark.parametrize("moving", [False, True])
def test_a_small_mode_opens_its_own_gap_alone(q, moving):
    """gap q = sqrt(2/N) a Omega_q A_q, the others of the next order."""
    chain, amplitude = Chain(8, potential=toda(A)), 1e-6
    Q, P = np.zeros((2, 7))
    (P if moving else Q)[q - 1] = amplitude * (chain.frequencies()[q - 1] if moving else 1)
    gaps = toda_gaps(chain, Q, P)
    expected = np.zeros(7)
    expected[q - 1] = np.sqrt(2 / 8) * float(A) * chain.frequencies()[q - 1] * amplitude
    assert gaps == pytest.approx(expected, abs=TODA_LINEAR * expected.max())


@pytest.mark.parametrize("direction", [1, -1])
def test_a_travelling_wave_opens_the_gap_of_its_direction(direction):
    """x_j = A cos(2 pi k j / n + omega t): gap k = 2 a omega A."""
    n, k, amplitude = 9, 2, 1e-6
    omega = 2 * np.sin(np.pi * k / n)
    angles = 2 * np.pi * k * np.arange(n) / n
    gaps = ring_gaps(amplitude * np.cos(angles), -direction * omega * amplitude * np.sin(angles))
    expected = np.zeros(n - 1)
    expected[(direction * k) % n - 1] = 2 * float(A) * omega * amplitude
    assert gaps == pytest.approx(expected, abs=TODA_LINEAR * expected.max())


@pytest.mark.parametrize("N", [2, 3, 6])
def test_digits_agree_with_doubles_and_with_more_digits(N):
    chain, (Q, P) = Chain(N, potential=toda(A)), state(N)
    forty, sixty = (toda_gaps(chain, Q, P, digits=digits) for digits in (40, 60))
    assert toda_gaps(chain, Q, P) == pytest.approx(forty.astype(float), abs=GAP)
    assert max(abs(forty - sixty)) < FORTY_DIGITS
    with MULTIPRECISION.context(40):
        x, p = (chain.positions(MULTIPRECISION.array(y)) for y in (Q, P))
        whole = ring_gaps(*ring_of(x, p), MULTIPRECISION)[: N - 1]
        assert max(abs(whole - forty)) < FORTY_DIGITS


def test_gaps_far_below_the_doubles_have_their_digits():
    with mpmath.workdps(60):
        Q = [mpmath.mpf("1e-30"), mpmath.mpf(0), mpmath.mpf(0)]
        (gap, *others) = toda_gaps(Chain(4, potential=toda(A)), Q, [0, 0, 0], digits=45)
        linear = mpmath.sqrt(mpmath.mpf(1) / 2) * mpmath.sinpi(mpmath.mpf(1) / 8) * mpmath.mpf("1e-30")
        assert abs(gap / linear - 1) < TODA_LINEAR
        assert max(others) < TODA_LINEAR * gap


def test_orbits_of_states_have_gaps_by_state():
    chain, Q = Chain(5, alpha="1/3"), np.random.default_rng(1).normal(size=(3, 2, 4)) * 0.1
    gaps = toda_gaps(chain, Q, 0 * Q)
    assert gaps.shape == (3, 2, 4)
    assert np.array_equal(gaps[1, 1], toda_gaps(chain, Q[1, 1], 0 * Q[1, 1]))
    assert np.array_equal(gaps, toda_gaps(Chain(5, beta=1), Q, 0 * Q, a="1/3"))


@each(a=[0], Q=[[0, 0], ["x", 0, 0]], P=[[[0, 0, 0]], [np.inf, 0, 0]], digits=[0], chain=[Chain("N", alpha=1), 4])
def test_bad_input_is_refused_by_name(name, value):
    refused(toda_gaps, name, value, chain=Chain(4, alpha=1), Q=[0, 0, 0], P=[0, 0, 0])


@pytest.mark.parametrize(
    ("chain", "Q", "name"),
    [(Chain(4, beta=1), [0, 0, 0], "a"), (Chain(4, alpha=1), [np.nan, 0, 0], "a r"), (Chain(4, alpha=1), [1e4, 0, 0], "a r")],
)
def test_laws_and_stretches_out_of_range_are_refused(chain, Q, name):
    with pytest.raises(InputError) as caught:
        toda_gaps(chain, Q, [0, 0, 0])
    assert caught.value.argument == name
