"""The composition of order 8: its coefficients, its observed order, and its tangent maps against differences and the motion."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symfpu.chain.chain import Chain
from symfpu.dynamics.kahan_li8 import DRIFTS, KICKS, flow, tangent_flow, tangent_map_along
from symfpu.errors import InputError

MIXED = Chain(7, alpha="0.3", beta="0.2")

# Coefficients are rounded to doubles; 17 of them, the largest 0.6.
COEFFICIENTS = 4e-16

# Slopes of errors from 1e-6 to 1e-10 over a few halvings: the next order, h^2, changes them by less.
ORDER_SLOPE = 0.2

# Fourth-order differences with step 1e-3 of a flow with derivatives of order one.
DIFFERENCES = 1e-10

# Some thousand kicks, each rounded once, over a few time units.
ROUNDED = 1e-13


@pytest.fixture(scope="module")
def state():
    random = np.random.default_rng(3)
    return random.normal(scale=0.3, size=6), random.normal(scale=0.3, size=6)


def test_the_coefficients_meet_the_first_conditions_of_order():
    """Symmetric compositions of order 8 need sum g = 1 and sum g^3 = sum g^5 = sum g^7 = 0 among others."""
    assert len(KICKS) == 17
    assert KICKS[::-1] == KICKS
    assert sum(KICKS) == pytest.approx(1, abs=COEFFICIENTS)
    for power in (3, 5, 7):
        assert sum(k**power for k in KICKS) == pytest.approx(0, abs=COEFFICIENTS)
    assert sum(DRIFTS) == pytest.approx(1, abs=COEFFICIENTS)


def test_the_observed_order_is_eight(state):
    """Against the same scheme with steps so short that only rounding is left."""
    exact = np.concatenate(flow(MIXED, *state, 4.0, 200))
    steps = np.array([8, 10, 13, 16, 20])
    errors = [np.max(np.abs(np.concatenate(flow(MIXED, *state, 4.0, int(n))) - exact)) for n in steps]
    assert -np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(8, abs=ORDER_SLOPE)
    peer = solve_ivp(lambda t, y: np.append(y[6:], MIXED.accelerations(y[:6])), (0, 4), np.append(*state), "DOP853", rtol=1e-13, atol=1e-15)
    assert exact == pytest.approx(peer.y[:, -1], abs=1e-12)


def test_the_flow_is_reversible_and_takes_many_states(state):
    Q, P = (np.array([part, 2 * part, -part]) for part in state)
    there = flow(MIXED, Q, P, 3.0, 9)
    assert there[0].shape == (3, 6)
    assert there[1][1] == pytest.approx(flow(MIXED, Q[1], P[1], 3.0, 9)[1], abs=ROUNDED)
    for start, back in zip((Q, P), flow(MIXED, *there, -3.0, 9), strict=True):
        assert back == pytest.approx(start, abs=ROUNDED)


def test_deviations_move_by_the_derivative_of_the_map(state):
    """Also of a coarse one: both are derivatives of the same numbers."""
    directions = np.eye(12)
    Q, P, dQ, dP = tangent_flow(MIXED, *state, directions[:, :6], directions[:, 6:], 2.0, 3)
    assert np.append(Q, P) == pytest.approx(np.append(*flow(MIXED, *state, 2.0, 3)), abs=ROUNDED)

    def moved(h):
        return np.hstack(flow(MIXED, state[0] + h * directions[:, :6], state[1] + h * directions[:, 6:], 2.0, 3))

    h = 1e-3
    slopes = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h)
    assert np.hstack([dQ, dP]) == pytest.approx(slopes, abs=DIFFERENCES)
    M = np.hstack([dQ, dP]).T
    J = np.block([[np.zeros((6, 6)), np.eye(6)], [-np.eye(6), np.zeros((6, 6))]])
    product = M.T @ J @ M
    assert product == pytest.approx(J, abs=ROUNDED)


def test_the_tangent_map_along_an_orbit_is_that_of_the_motion(state, monkeypatch):
    directions, steps = np.eye(12), 60
    whole = np.hstack(tangent_flow(MIXED, *state, directions[:, :6], directions[:, 6:], 2.0, steps)[2:]).T
    track = solve_ivp(
        lambda t, y: np.append(y[6:], MIXED.accelerations(y[:6])),
        (0, 2.1),
        np.append(*state),
        "DOP853",
        rtol=1e-13,
        atol=1e-14,
        dense_output=True,
    ).sol

    def stretches(t):
        return MIXED.stretches(track(t)[:6].T)

    # the dense output of DOP853 is of order 7
    assert tangent_map_along(MIXED, stretches, 2.0, steps) == pytest.approx(whole, abs=1e-9)
    monkeypatch.setattr("symfpu.dynamics.kahan_li8.TABLE", 17 * 7 * 7)  # portions of seven steps
    assert tangent_map_along(MIXED, stretches, 2.0, steps) == pytest.approx(whole, abs=1e-9)


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (([0.1], [0.1], 1.0, 4), "Q"),
        (([0.1] * 6, [[0.1] * 6], 1.0, 4), "P"),
        (([np.inf] * 6, [0.1] * 6, 1.0, 4), "Q, P"),
        (([0.1] * 6, [0.1] * 6, np.nan, 4), "duration"),
        (([0.1] * 6, [0.1] * 6, "1", 4), "duration"),
        (([0.1] * 6, [0.1] * 6, 1.0, 0), "steps"),
        (([0.1] * 6, [0.1] * 6, 1.0, 2.5), "steps"),
    ],
)
def test_bad_input_is_refused(arguments, name):
    with pytest.raises(InputError, match=rf"^{name} = "):
        flow(MIXED, *arguments)
