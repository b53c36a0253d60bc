"""The linearised flow about a torus: its basis is canonical and moves as the equations say."""

import numpy as np
import pytest

from symfpu import Chain, normal_modes, refine, torus_at_amplitudes
from symfpu.action_angle.foretold import flow_of
from symfpu.action_angle.linear_flow import symplectic
from symfpu.dynamics.tangent import tangent_steps
from tests.tolerances import CANONICAL, NORMAL_VARIATION

STEP, STEPS = 0.05, 200


@pytest.fixture(scope="module")
def torus():
    return refine(torus_at_amplitudes(Chain(6, alpha="0.3", beta="0.2"), {1: "0.3", 2: "0.2"}, 4))


def test_angles_and_actions_are_canonical(torus):
    """Omega(E, F) = 1; no two of E, and no two of F, have a product."""
    along, across, _ = flow_of(torus).basis(np.array([0.7, 31.0]))
    ones = np.broadcast_to(np.eye(2), (2, 2, 2))
    assert symplectic(along, across) == pytest.approx(ones, abs=CANONICAL)
    for one in (along, across):
        assert symplectic(one, one) == pytest.approx(0 * ones, abs=CANONICAL)


@pytest.mark.long
def test_normal_directions_have_no_product_with_the_torus(torus):
    """Of modes at rest because they are made so, of normal modes because they are so."""
    for normal in (None, normal_modes(torus)):
        along, across, beside = flow_of(torus, normal).basis(np.array([0.7]))
        for one in (along, across):
            assert np.abs(symplectic(one, beside)).max() < CANONICAL


def test_the_basis_moves_as_the_equations_say(torus):
    """Integrated by the derivative of steps of order 8, a frame is where the closed form has it."""
    flow = flow_of(torus, normal_modes(torus), 1.3)
    n = torus.chain.N - 1
    frame = np.random.default_rng(1).normal(size=(2 * n, 3))
    moved = tangent_steps(torus.chain, *torus.state(1.3), frame[:n].T, frame[n:].T, STEP, STEPS)
    times = np.array([STEP * STEPS])
    basis = np.concatenate(flow.basis(times), axis=2)
    found = (basis @ flow.moved(flow.coordinates(frame), times))[0]
    assert found == pytest.approx(np.concatenate(moved[2:], axis=1).T, abs=NORMAL_VARIATION)


def test_the_mean_metric_is_the_mean(torus):
    flow = flow_of(torus)
    around = np.linspace(0, 2 * np.pi, 32, endpoint=False)
    theta = np.stack(np.meshgrid(around, around), axis=-1).reshape(-1, 2)
    along = flow._along(theta)[0]
    mean = (np.swapaxes(along, 1, 2) @ along).mean(axis=0)
    assert flow.mean_metric() == pytest.approx(mean, rel=CANONICAL)
