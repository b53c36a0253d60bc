"""Laurent series: how far they are known."""

from fractions import Fraction

import pytest

from symfpu.algebra.laurent import Laurent


@pytest.mark.parametrize("step", [1, 2])
def test_series_know_how_far_they_are_known(step):
    x = Laurent(0, [Fraction(0), Fraction(2), Fraction(1)], step)
    assert (x * x.inverse()).coefficients == [0, 1]
    assert (x * x.inverse()).low == -step
    assert (x.inverse() + x).end == step
    assert (x + 1).coefficients == [1, 2, 1]


def test_zero_has_no_inverse():
    with pytest.raises(ZeroDivisionError):
        Laurent(0, [Fraction(0)] * 3, 1).inverse()
