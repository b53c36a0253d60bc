"""The selection rules against sums over all signs, and the parities against the mirror image of the bonds."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes, fold
from tests.tolerances import THOUSAND_ROUNDINGS

CHAINS = [(8, (1,)), (8, (3, 6)), (5, (1, 2, 4)), (6, (2, 4)), (2, (1,)), (7, (2, 3, 5, 6)), (9, (3,))]


@given(st.integers(-300, 300), st.integers(2, 40))
def test_fold_gives_the_wave_number_of_the_same_cosine_up_to_sign(number, N):
    """cos(n theta) = +-cos(fold(n) theta) on all points (j + 1/2) pi / N, and 0 <= fold(n) <= N."""
    theta = (np.arange(N) + 0.5) * np.pi / N
    q = fold(number, N)
    assert 0 <= q <= N
    assert min(abs(np.cos(number * theta) - s * np.cos(q * theta)).max() for s in (1, -1)) < THOUSAND_ROUNDINGS


def sums_of_signs(powers, seeds):
    factors = [q for q, e in zip(seeds, powers, strict=True) for _ in range(e)]
    return {sum(s * q for s, q in zip(signs, factors, strict=True)) for signs in product((1, -1), repeat=len(factors))}


@pytest.mark.parametrize(("N", "seeds", "highest"), [*((*chain, 5) for chain in CHAINS), (40, tuple(range(1, 15)), 2)])
def test_masks_are_the_sums_over_all_signs(N, seeds, highest):
    """More than 12 seeds leave 64-bit keys behind: every pair of seeds still carries its own sums."""
    grading = Grading(len(seeds), highest)
    space = CosineModes(N, seeds, grading)
    for degree in range(1, highest + 1):
        for powers, carried in zip(grading.powers(degree), space.mask(degree), strict=True):
            expected = {fold(total, N) for total in sums_of_signs(powers, seeds)} - {0, N}
            assert {int(q) + 1 for q in np.flatnonzero(carried)} == expected


@pytest.mark.parametrize(("N", "seeds"), CHAINS)
def test_a_monomial_carries_modes_of_its_parity_only(N, seeds):
    grading = Grading(len(seeds), 4)
    space = CosineModes(N, seeds, grading)
    for degree in range(1, 5):
        for parity, carried in zip(space.parity(degree), space.mask(degree), strict=True):
            assert all((q + 1 - parity) % 2 == 0 for q in np.flatnonzero(carried))


@pytest.mark.parametrize(("N", "seeds"), [(5, (1, 2)), (8, (1, 3)), (9, (2, 4, 5))])
def test_even_monomials_come_first_and_each_once(N, seeds):
    space = CosineModes(N, seeds, Grading(len(seeds), 6))
    for degree in range(1, 7):
        order, even = space.even_first(degree)
        assert sorted(order.tolist()) == list(range(len(space.parity(degree))))
        assert (space.parity(degree)[order] == (np.arange(len(order)) >= even)).all()
    for parity in (0, 1):
        assert (np.arange(1, N)[space.modes(parity)] % 2 == parity).all()
