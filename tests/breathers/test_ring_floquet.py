"""Multipliers of periodic orbits on rings: against the map up to a shift by sites, Toda's curve, Hill's equation, and fixed ends."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import symfpu
from symfpu import Chain, InputError, floquet, lindstedt, solve_amplitudes, toda_torus, unfold
from symfpu.breathers.floquet import ELLIPTIC, TANGENT, TRIVIAL, monodromy
from symfpu.dynamics.kahan_li8 import KAHAN_LI8
from symfpu.dynamics.tangent import real_waves, tangent_steps
from tests.refinement.test_ring_tori import TODA
from tests.tolerances import EIGENVALUES, FLOQUET_PHASE, MONODROMY, PEER_ABSOLUTE, PEER_RELATIVE
from tests.tori.test_ring_torus import ring

STEP = 0.02
CASES = [(5, 2, "0.5", TODA), (8, 2, "0.5", {"alpha": "0.3"})]
LONG = [
    (8, 1, "2", {"beta": 1}),
    (9, -4, "0.3", {"alpha": "0.3", "beta": "0.2"}),
    (12, 3, "1", {"beta": 1}),
    (2, 1, "0.5", {"beta": 1}),
    (32, 1, "2", {"alpha": "0.3"}),
]


def until_it_is_shifted(orbit):
    """The tangent map over the shortest time after which the wave is itself but for a shift, back by the shift; both in real waves.

    Returns the map, and the shift by which its power over a period is too far.
    """
    chain, q = orbit.chain, orbit.seed
    N, common = chain.N, math.gcd(q, chain.N)
    sites = next(k for k in range(N) if (k * q - common) % N == 0)
    time = 2 * np.pi * common / N / float(orbit.frequency)
    steps = math.ceil(time / STEP)
    waves = real_waves(chain)
    units = np.vstack([waves, 0 * waves]), np.vstack([0 * waves, waves])
    deviations = [chain.modes(unit) for unit in units]
    *_, dQ, dP = tangent_steps(chain, *orbit.state(), *deviations, time / steps, steps, scheme=KAHAN_LI8)

    def back(rows, by):
        return np.roll(rows, -by, axis=1) @ waves.T

    moved = [back(chain.positions(rows), sites) for rows in (dQ, dP)]
    whole = sites * (N // common)
    shift = np.hstack([back(units[0], -whole), back(units[1], -whole)]).T
    return np.hstack(moved).T, shift


@pytest.mark.parametrize(("N", "q", "A", "law"), [*CASES, *(pytest.param(*case, marks=pytest.mark.long) for case in LONG)])
def test_the_map_of_a_period_is_a_power_of_the_map_up_to_a_shift(N, q, A, law):
    orbit = symfpu.torus(ring(N, **law), (q,), amplitudes={q: A})
    part, shift = until_it_is_shifted(orbit)
    power = shift @ np.linalg.matrix_power(part, N // math.gcd(q, N))
    found = floquet(orbit)
    assert np.abs(found.monodromy - power).max() < MONODROMY * max(1, np.abs(power).max())
    assert np.array_equal(monodromy(orbit), found.monodromy)
    growth = np.abs(np.linalg.eigvals(part)).max() ** (N // math.gcd(q, N))
    assert np.isclose(found.largest, growth, rtol=math.sqrt(EIGENVALUES))  # the double 1 costs half of the digits
    assert (found.kinds[0], len(found.pairs)) == (TRIVIAL, N - 1)


@pytest.mark.parametrize(
    ("N", "q", "A"), [(5, 2, "0.4"), pytest.param(8, -3, "0.4", marks=pytest.mark.long), pytest.param(9, 1, "1", marks=pytest.mark.long)]
)
def test_waves_of_toda_are_stable_with_the_normal_frequencies_of_the_curve(N, q, A):
    chain = ring(N, **TODA)
    orbit = symfpu.torus(chain, (q,), amplitudes={q: A})
    found = floquet(orbit)
    assert found.stable
    curve = toda_torus(chain, (q,), frequencies=orbit.frequencies, digits=20)
    period = 2 * math.pi / float(orbit.frequency)
    assert len(curve.normal_frequencies) == N - 2
    for sigma in curve.normal_frequencies.values():
        angle = np.exp(1j * float(sigma) * period)
        assert np.abs(found.multipliers - angle).min() < FLOQUET_PHASE


@pytest.mark.long
@pytest.mark.parametrize("A", ["0.2", "0.5", "1.5"])
def test_of_mode_half_N_of_beta_every_mode_has_a_hill_equation(A):
    """All r_j^2 are equal: Q_q'' = -Omega_q^2 (1 + 3 beta r^2) Q_q, one by one."""
    orbit = symfpu.torus(ring(8, beta=1), (4,), amplitudes={4: A})
    found = floquet(orbit)
    period = 2 * np.pi / float(orbit.frequency)
    start = [orbit.x(0.0)[0], orbit.p(0.0)[0]]
    expected = []
    for linear in orbit.chain.frequencies()[3:]:

        def motion(t, y, square=linear**2):
            stiffness = square * (1 + 12 * y[0] ** 2)
            return [y[1], -4 * y[0] - 16 * y[0] ** 3, y[3], -stiffness * y[2], y[5], -stiffness * y[4]]

        run = solve_ivp(motion, (0, period), [*start, 1, 0, 0, 1], method="DOP853", rtol=PEER_RELATIVE, atol=PEER_ABSOLUTE)
        expected.append(run.y[2, -1] + run.y[5, -1])
    traces = found.pairs.sum(axis=1)
    for trace in expected:
        assert np.abs(traces - trace).min() < EIGENVALUES
    assert set(found.kinds) == ({TRIVIAL, ELLIPTIC} if A == "0.2" else {TRIVIAL, ELLIPTIC, TANGENT})


def test_an_unfolded_breather_has_the_multipliers_of_fixed_ends_among_its_own():
    fixed = symfpu.torus(Chain(4, beta=1), (3,), amplitudes={3: "1"})
    there, here = floquet(unfold(fixed)), floquet(fixed)
    for multiplier in here.multipliers:
        assert np.abs(there.multipliers - multiplier).min() < MONODROMY
    assert len(there.multipliers) == 2 * 7


def test_tori_of_more_angles_are_refused():
    series = lindstedt(ring(8, beta=1), (1, 2), ("0.78", "1.43"), 1)
    with pytest.raises(InputError, match="normal_modes"):
        floquet(solve_amplitudes(series))
