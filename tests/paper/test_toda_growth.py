"""Growth of deviations by the Toda chain's actions: that of Newton's torus and its twist, and what frames show of it."""

import numpy as np
import pytest

from symfpu import Chain, refine, torus_at_amplitudes
from symfpu.action_angle.foretold import flow_of
from symfpu.action_angle.linear_flow import symplectic
from symfpu.paper.toda_growth import toda_growth
from tests.paper.cases import growth_at
from tests.tolerances import TODA_GROWTH


@pytest.mark.long
def test_by_actions_and_by_newton():
    """A torus of all modes of three bonds: E Lambda Omega(E, .) from harmonics, and from the spectral curve."""
    torus = refine(torus_at_amplitudes(Chain(3, potential="toda:1/2"), {1: "0.2", 2: "0.3"}, 6))
    flow = flow_of(torus)
    along = flow.basis(np.zeros(1))[0][0]
    newton = along @ flow.twist @ symplectic(along, np.eye(4))
    found = toda_growth(torus.chain, *torus.state())
    assert found.matrix == pytest.approx(newton, abs=TODA_GROWTH * np.abs(newton).max())
    assert found.frequencies == pytest.approx([float(w) for w in torus.frequencies], rel=TODA_GROWTH)


def test_frames_show_the_directions_that_have_grown():
    growth = growth_at([1e-4, 1e-5, 1e-6, 1e-12])
    assert growth.rates[:4] == pytest.approx([1e-4, 1e-5, 1e-6, 1e-12])
    assert growth.dimension(1e3, 6, 2).value is None
    assert growth.dimension(1e10, 6, 2).value == 3
    assert growth.dimension(1e16, 6, 2).value == 4
    shown = growth.first_shown(6, 2, 1e10)
    assert shown.keys() == {3}
    assert 1e6 < shown[3] < 1e10
