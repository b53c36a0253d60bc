"""Sizes of a KAM step: the Diophantine constant is true, and what the sizes are of is refused otherwise."""

from fractions import Fraction

import pytest

from symfpu import Chain, InputError, lindstedt, refine, solve_amplitudes
from symfpu.certified.kam import diophantine, kam_sizes, root_near
from tests.every_result import two_angles
from tests.tolerances import KAM_DIGITS, KAM_DOUBLES

NOBLE = (61, -209, 179)  # (19 phi + 7) / (11 phi + 4), phi the golden mean
FIRST = Fraction("0.9999")


def frequencies():
    return FIRST, FIRST * root_near(NOBLE, Fraction("1.7314"), 60)


def test_no_small_divisor_is_below_its_bound():
    gamma, ratio = diophantine(frequencies(), NOBLE), root_near(NOBLE, Fraction("1.7314"), 60)
    least = min(float(abs(FIRST * (k - n * ratio))) * (k + n) for n in range(1, 3000) for k in (int(n * ratio), int(n * ratio) + 1))
    assert gamma <= least
    assert least < 10 * gamma


def test_thirty_digits_leave_a_first_step_fifteen_orders_of_room():
    torus = refine(solve_amplitudes(lindstedt(Chain(3, alpha="0.3"), (1, 2), frequencies(), 6)))
    doubles = kam_sizes(torus, NOBLE).product
    found = kam_sizes(refine(torus, digits=30), NOBLE)
    assert found.product < KAM_DIGITS < KAM_DOUBLES < doubles
    assert found.resonance > 10**20


def test_rational_ratios_are_refused():
    with pytest.raises(InputError, match="irrational"):
        diophantine((Fraction(1), Fraction(2)), (1, -3, 2))
    with pytest.raises(InputError, match="a root"):
        kam_sizes(two_angles(), NOBLE)
