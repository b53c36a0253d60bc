"""Tori that the FPU-trajectory is near: an approach in a short chain, and the claim by what it found."""

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.files.progress import unheard
from symfpu.paper.fig9_tori import Approach, approach, tori_claim


def test_an_angle_more_brings_the_torus_nearer():
    found = approach(Chain(8, alpha="0.3"), "0.001", unheard, angles=(1, 2, 3))
    assert found.angles == (1, 2, 3)
    assert all(np.diff(found.distances) < 0)
    assert found.falls == pytest.approx(np.divide(found.distances[:-1], found.distances[1:]))
    assert max(found.residuals) < found.distances[-1]


@pytest.mark.parametrize(
    ("distances", "verdict", "words"),
    [
        ((0.4, 0.14, 0.02), "holds in part", "none of these is the last"),
        ((0.4, 0.02, 0.019), "holds", "by 20, 1.1"),
        ((0.4, 0.3, 0.2), "does not hold", "by 1.3, 1.5"),
    ],
)
def test_the_claim_says_what_was_found(distances, verdict, words):
    claim = tori_claim(Approach((1, 2, 3), distances, (1e-9,) * 3, (10, 20, 30)))
    assert claim.verdict == verdict
    assert words in claim.ours
    assert ("last" in claim.ours) == (verdict == "holds in part")
