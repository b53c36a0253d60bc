"""Multipliers and smallest divisors against mpmath and brute force; exact zeros are named."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symfpu import Chain, InputError, ResonantDivisor, lindstedt
from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes
from symfpu.series.divisors import Float64Divisors, UniversalDivisors
from tests.oracles.universal import DIGITS, multiplier
from tests.tolerances import MULTIPLIER, NEAR_RESONANCE, RELATIVE_SHIFT

N, SEEDS, FREQUENCIES = 8, (1, 3), ("0.391", "1.113")


def space_of(N, seeds, top):
    return CosineModes(N, seeds, Grading(len(seeds), top))


def all_multipliers(divisors):
    """(harmonics, multipliers) of every degree from 2 on."""
    space = divisors.space
    for degree in range(2, space.grading.degree + 1):
        nu, _ = space.grading.harmonics(degree)
        yield nu, divisors.multipliers(nu, space.mask_by_harmonic(degree), degree - 1)


def test_multipliers_are_their_definition():
    divisors = Float64Divisors(Chain(N, 1), space_of(N, SEEDS, 6), [Fraction(w) for w in FREQUENCIES])
    count = 0
    with mpmath.workdps(DIGITS):
        for nu, table in all_multipliers(divisors):
            for row, column in np.argwhere(table):
                expected = multiplier(N, SEEDS, FREQUENCIES, int(column) + 1, nu[row].tolist())
                assert abs(table[row, column] / expected - 1) < MULTIPLIER
                count += 1
    assert count > 100


def test_the_gauge_leaves_out_the_own_harmonic_of_a_seed():
    space, frequencies = space_of(N, SEEDS, 5), [Fraction(w) for w in FREQUENCIES]
    for divisors in (Float64Divisors(Chain(N, 1), space, frequencies), UniversalDivisors(space)):
        for nu, table in all_multipliers(divisors):
            for i, q in enumerate(SEEDS):
                unit = (nu == np.eye(2, dtype=int)[i]).all(axis=1)
                assert all(value == 0 for value in table[unit, q - 1])


@pytest.mark.parametrize("digits", [8, 13, 16])
def test_a_small_divisor_keeps_its_digits(digits):
    """2 omega_1 = Omega_2 to so many digits: the multiplier is 1 / (a difference), known to the digits of the frequencies."""
    with mpmath.workdps(60):
        near = Fraction(mpmath.nstr(mpmath.sin(mpmath.pi / 8), digits + 1)) + Fraction(1, 10**digits)
        divisors = Float64Divisors(Chain(8, 1), space_of(8, (1,), 2), [near])
        value = next(table for nu, table in all_multipliers(divisors))[1, 1]
        exact = multiplier(8, (1,), (near,), 2, (2,))
        assert abs(exact) > 10 ** (digits - 2)
        assert abs(value / exact - 1) < NEAR_RESONANCE


def brute_force(chain, seeds, frequencies, top):
    """(size, mode, harmonic, degree) of every divisor where the selection rules let the mode carry the harmonic."""
    grading = Grading(len(seeds), top)
    space = CosineModes(chain.N, seeds, grading)
    found = {}
    for degree in range(2, top + 1):
        nu, index = grading.harmonics(degree)
        mask = space.mask(degree)
        for h, harmonic in enumerate(map(tuple, nu.tolist())):
            for q in range(1, chain.N):
                gauge = q in seeds and harmonic == tuple(int(p == q) for p in seeds)
                if mask[index == h, q - 1].any() and not gauge:
                    base = frequencies[seeds.index(q)] if q in seeds else 2 * np.sin(q * np.pi / (2 * chain.N))
                    drive = sum(n * w for n, w in zip(harmonic, frequencies, strict=True))
                    found.setdefault((q, harmonic), (abs(base**2 - drive**2), degree - 1))
    return sorted((size, q, nu, order) for (q, nu), (size, order) in found.items())


@pytest.mark.parametrize(
    ("N", "seeds", "frequencies"), [(8, (1, 3), (0.391, 1.113)), (9, (4,), (1.29,)), (6, (1, 2, 5), (0.52, 1.01, 1.95))]
)
def test_smallest_divisors_are_sorted_and_those_of_brute_force(N, seeds, frequencies):
    chain = Chain(N, alpha="0.1")
    series = lindstedt(chain, seeds, frequencies, 4)
    kept = series.smallest_divisors
    expected = brute_force(chain, seeds, frequencies, 5)
    assert len(kept) == 10
    assert [d.size for d in kept] == sorted(d.size for d in kept)
    assert [d.size for d in kept] == pytest.approx([size for size, *_ in expected[:10]], rel=RELATIVE_SHIFT)
    where = {(q, nu): order for _, q, nu, order in expected}
    assert all(where[d.mode, d.harmonic] == d.order for d in kept)
    assert repr(kept[0]) in repr(series)


@pytest.mark.parametrize("digits", [None, 40])
@pytest.mark.parametrize(
    ("N", "seeds", "frequencies", "mode", "harmonic", "order"),
    [
        (9, (1, 2), ("1/4", "3/4"), 3, (1, 1), 1),  # Omega_3 = 1 is the one rational linear frequency
        (16, (1, 2), ("0.2", "0.4"), 1, (1, -1), 1),  # omega_1 = omega_2 - omega_1
        (16, (1, 3), ("0.2", "0.6"), 1, (2, -1), 2),  # omega_1 = omega_3 - 2 omega_1
    ],
)
def test_an_exact_zero_names_mode_harmonic_and_order(N, seeds, frequencies, mode, harmonic, order, digits):
    with pytest.raises(ResonantDivisor) as caught:
        lindstedt(Chain(N, alpha="0.1"), seeds, frequencies, 5, digits=digits)
    error = caught.value
    assert (error.mode, error.harmonic, error.order, error.exact) == (mode, harmonic, order, True)
    assert isinstance(error, InputError)
    assert f"_{mode}^2" in str(error)
    assert f"order {order}" in str(error)
    assert str(harmonic) in str(error)
    assert "\n" not in str(error)


def test_a_resonance_that_no_selection_rule_lets_in_is_no_resonance():
    """omega_5 = 2 omega_1 needs the harmonic (2, 0), which has an even degree: beta has none."""
    series = lindstedt(Chain(16, beta="0.1"), (1, 5), ("0.2", "0.4"), 1)
    assert series.smallest_divisors[0].size > 0


def test_a_divisor_below_the_resolution_of_doubles_is_refused_but_not_called_zero():
    """omega_1 = Omega_2 / 2 to 50 digits: rational, so the divisor is not zero, but nobody can tell in doubles."""
    with mpmath.workdps(60):
        near = Fraction(mpmath.nstr(mpmath.sin(mpmath.pi / 8), 50))
    with pytest.raises(ResonantDivisor) as caught:
        lindstedt(Chain(8, alpha=1), (1,), (near,), 1)
    assert not caught.value.exact
    assert (caught.value.mode, caught.value.harmonic) == (2, (2,))
