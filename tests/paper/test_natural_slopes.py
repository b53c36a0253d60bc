"""Slopes of natural packets: read off made spectra, and judged."""

import numpy as np
import pytest

from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.natural_slopes import natural_slopes, natural_slopes_claim, tail_slope
from tests.tolerances import LEAST_SQUARES


def test_the_slope_is_that_of_the_tail():
    """Level in the packet, exp(-20 kappa) beyond."""
    kappa = np.arange(1, 64) / 64
    spectrum = np.where(kappa < 16 / 64, 1.0, np.exp(-20 * kappa))
    assert tail_slope(spectrum, 8) == pytest.approx(20, rel=LEAST_SQUARES)


@pytest.mark.parametrize(("power", "verdict"), [(1.0, HOLDS), (1.5, PARTLY), (-1.0, FAILS)])
def test_slopes_go_with_a_power(power, verdict):
    x = np.array([6.0, 9.0, 14.0])
    assert natural_slopes_claim(x, 3.6 * x**power).verdict == verdict


@pytest.mark.long
def test_trajectories_of_one_seed_have_the_linear_law():
    assert natural_slopes_claim(*natural_slopes()).verdict == HOLDS
