"""The step with deviation vectors: order of the table, exact derivative, symplecticity, work that grows as N."""

import time

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.dynamics.blanes_moan6 import DRIFTS, KICKS
from symfpu.dynamics.kahan_li8 import flow
from symfpu.dynamics.tangent import moving_frame, tangent_steps
from symfpu.errors import InputError

MIXED = Chain(7, alpha="0.3", beta="0.2")
EYE = np.eye(12)

# A dozen coefficients, each rounded to a double.
COEFFICIENTS = 1e-15

# What the tangent map promises: some dozen stages with rounded products of matrices of norm about one.
SYMPLECTIC = 1e-13

# Some hundred stages, each rounded once, in another order of sums.
ROUNDED = 1e-13

# Slopes of errors over a few halvings: the next order changes them by less.
ORDER_SLOPE = 0.1

# Seconds of a loop on a machine with other work; the work itself is linear.
LINEAR = 0.35


@pytest.fixture(scope="module")
def state():
    random = np.random.default_rng(3)
    return random.normal(scale=0.3, size=6), random.normal(scale=0.3, size=6)


def tangent_map(state, step, steps, **table):
    return np.hstack(tangent_steps(MIXED, *state, EYE[:, :6], EYE[:, 6:], step, steps, **table)[2:]).T


def moved(state, step, steps):
    return np.append(*tangent_steps(MIXED, *state, np.zeros((1, 6)), np.zeros((1, 6)), step, steps)[:2])


def test_the_table_is_symmetric_and_consistent():
    assert len(DRIFTS) == len(KICKS) + 1 == 15
    assert DRIFTS[::-1] == DRIFTS
    assert KICKS[::-1] == KICKS
    assert sum(DRIFTS) == pytest.approx(1, abs=COEFFICIENTS)
    assert sum(KICKS) == pytest.approx(1, abs=COEFFICIENTS)


def test_the_observed_order_is_six(state):
    exact = np.append(*flow(MIXED, *state, 4.0, 200))
    steps = np.array([16, 20, 26, 32, 40])
    errors = [np.max(np.abs(moved(state, 4.0 / n, int(n)) - exact)) for n in steps]
    assert -np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(6, abs=ORDER_SLOPE)


def test_the_step_is_reversible(state):
    there = tangent_steps(MIXED, *state, EYE[:, :6], EYE[:, 6:], 0.3, 20)
    back = np.hstack(tangent_steps(MIXED, *there, -0.3, 20)[2:])
    assert back == pytest.approx(EYE, abs=ROUNDED)


@pytest.mark.parametrize("steps", [1, 7])
def test_the_tangent_map_is_the_derivative_of_the_step(state, steps):
    """Central differences of a coarse step err by h^2, down to where rounding begins."""
    M, point = tangent_map(state, 0.4, steps), np.append(*state)

    def slopes(h):
        return np.array(
            [(moved(np.split(point + h * e, 2), 0.4, steps) - moved(np.split(point - h * e, 2), 0.4, steps)) for e in EYE]
        ).T / (2 * h)

    sizes = np.array([0.04, 0.02, 0.01, 0.005])
    errors = [np.max(np.abs(slopes(h) - M)) for h in sizes]
    assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] == pytest.approx(2, abs=ORDER_SLOPE)
    assert np.max(np.abs((4 * slopes(0.005) - slopes(0.01)) / 3 - M)) < 1e-3 * errors[-1]


@pytest.mark.parametrize("step", [0.05, 0.25, 0.7])
def test_the_tangent_map_is_symplectic(state, step):
    J = np.kron([[0, 1], [-1, 0]], np.eye(6))
    M = tangent_map(state, step, 5)
    assert np.max(np.abs(M.T @ J @ M - J)) < SYMPLECTIC


def test_vectors_do_not_know_of_each_other(state):
    """Twelve vectors lie in two blocks of lanes; one by one they move the same, and the same with another way to count steps."""
    whole = tangent_map(state, 0.25, 6)
    for i, e in enumerate(EYE):
        alone = tangent_steps(MIXED, *state, e[None, :6], e[None, 6:], 0.25, 6)
        assert np.hstack(alone[2:])[0] == pytest.approx(whole[:, i], abs=ROUNDED)
    first = tangent_steps(MIXED, *state, EYE[:, :6], EYE[:, 6:], 0.25, 2)
    both = np.hstack(tangent_steps(MIXED, *first, 0.25, 4)[2:]).T
    assert both == pytest.approx(whole, abs=ROUNDED)
    assert tangent_map(state, 0.25, 0) == pytest.approx(EYE, abs=ROUNDED)


def test_another_table_can_be_passed(state):
    """The leapfrog by hand."""
    Q, P = state
    h = 0.1
    middle = Q + h / 2 * P
    after = P + h * MIXED.accelerations(middle)
    found = tangent_steps(MIXED, Q, P, EYE[:, :6], EYE[:, 6:], h, 1, drifts=(0.5, 0.5), kicks=(1.0,))
    assert found[0] == pytest.approx(middle + h / 2 * after, abs=ROUNDED)
    assert found[1] == pytest.approx(after, abs=ROUNDED)


def test_the_work_grows_as_the_chain():
    """Seconds of a step from N = 256 to 2048, the best of some."""
    from symfpu.dynamics.tangent_loops import advance

    seconds, lengths = [], (256, 512, 1024, 2048)
    for N in lengths:
        zero = np.zeros((7, N - 1))
        frame = moving_frame(Chain(N, beta=1), zero[0] + 1e-3, zero[0], zero + 1e-3, zero, 0.1)
        spent = []
        for _ in range(15):
            start = time.process_time()
            advance(frame.x, frame.p, frame.dx, frame.dp, *frame.couplings, frame.kicks, frame.drifts, 40)
            spent.append(time.process_time() - start)
        seconds.append(min(spent))
    assert np.polyfit(np.log(lengths), np.log(seconds), 1)[0] == pytest.approx(1, abs=LINEAR)


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"Q": [0.1]}, "Q"),
        ({"P": [[0.1] * 6]}, "P"),
        ({"dP": [[0.1] * 6]}, "dP"),
        ({"dQ": [0.1] * 6}, "dQ"),
        ({"Q": [np.nan] * 6}, "Q"),
        ({"step": 0}, "step"),
        ({"step": np.inf}, "step"),
        ({"steps": 1.5}, "steps"),
        ({"kicks": (1.0,)}, "drifts"),
    ],
)
def test_bad_input_is_refused(state, changes, name):
    arguments = {"Q": state[0], "P": state[1], "dQ": EYE[:2, :6], "dP": EYE[:2, 6:], "step": 0.1, "steps": 3} | changes
    with pytest.raises(InputError, match=rf"^{name} = "):
        tangent_steps(MIXED, **arguments)
