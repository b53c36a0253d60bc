"""Sums of cosines on a tensor grid: against sums by hand, harmonics that fold on the grid among them."""

from fractions import Fraction

import numpy as np
import pytest

from symfpu import Chain, Torus
from symfpu.tori import torus as torus_module
from tests.tolerances import THOUSAND_ROUNDINGS

CHAIN = Chain(8, alpha="0.3")


@pytest.mark.parametrize("points", [1, 3, 6])
def test_a_residual_is_that_of_angles_one_by_one(points, monkeypatch):
    draws = np.random.default_rng(2)
    harmonics = np.array([[1, 0], [0, 1], [2, -1], [3, 4], [0, 0]])
    cosines = draws.normal(scale=0.1, size=(5, CHAIN.N - 1))
    torus = Torus(CHAIN, (1, 2), (Fraction("0.21"), Fraction("0.43")), harmonics, cosines, {1: 0.0, 2: 0.0})
    at_once = torus.residuals(points)
    monkeypatch.setattr(torus_module, "TRANSFORMED", 0)
    assert at_once == pytest.approx(torus.residuals(points), rel=THOUSAND_ROUNDINGS)
