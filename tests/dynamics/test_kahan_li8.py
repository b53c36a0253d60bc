"""The table of the composition of order 8; what it moves is in test_tangent.py and test_schemes.py."""

import pytest

from symfpu.dynamics.kahan_li8 import KAHAN_LI8
from tests.tolerances import SCHEME_COEFFICIENTS


def test_the_coefficients_meet_the_first_conditions_of_order():
    """Symmetric compositions of order 8 need sum g = 1 and sum g^3 = sum g^5 = sum g^7 = 0 among others."""
    assert KAHAN_LI8.stages == 17
    assert KAHAN_LI8.kicks[::-1] == KAHAN_LI8.kicks
    assert sum(KAHAN_LI8.kicks) == pytest.approx(1, abs=SCHEME_COEFFICIENTS)
    for power in (3, 5, 7):
        assert sum(k**power for k in KAHAN_LI8.kicks) == pytest.approx(0, abs=SCHEME_COEFFICIENTS)
    assert sum(KAHAN_LI8.drifts) == pytest.approx(1, abs=SCHEME_COEFFICIENTS)
