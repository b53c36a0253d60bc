"""The ring of fixed-point numbers against mode space, against the other rings, and against itself with more digits."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symfpu import Chain, lindstedt
from symfpu.algebra.fixedpoint import FixedPointRing, Precision
from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes
from symfpu.series.divisors import FixedPointDivisors
from tests.oracles.cases import CASES
from tests.oracles.universal import multiplier
from tests.tolerances import CHOSEN_RESONANCE

DIGITS = 40
CANCELLING = ("beta, three seeds",)  # see test_float64


def series_of(case, digits=DIGITS):
    return lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order, digits=digits)


@pytest.fixture(scope="module")
def fixed():
    return {case.name: series_of(case) for case in CASES}


@pytest.fixture(scope="module")
def doubles():
    return {case.name: series_of(case, digits=None) for case in CASES}


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_zeros_are_exact_where_the_selection_rules_say_so(case, fixed):
    """And in the gauge term of a seed; the words there are zero, not small."""
    series = fixed[case.name]
    space = CosineModes(case.N, case.seeds, series.grading)
    for k, table in enumerate(series.coordinates):
        degree = series.degree(k)
        assert not table.words[~space.mask(degree)].any()
        nu, index = series.grading.harmonics(degree)
        for i, q in enumerate(case.seeds):
            gauge = (nu == np.eye(len(case.seeds), dtype=int)[i]).all(axis=1)[index]
            assert k == 0 or not table.words[gauge, q - 1].any()


@pytest.mark.parametrize("case", [case for case in CASES if case.name not in CANCELLING], ids=lambda c: c.name)
def test_the_nonzero_pattern_is_that_of_doubles(case, fixed, doubles):
    """Which is that of the symbolic ring: test_float64.py."""
    for table, expected in zip(fixed[case.name].coordinates, doubles[case.name].coordinates, strict=True):
        assert (table.words.any(axis=-1) == (expected != 0)).all()


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_twenty_digits_more_change_no_promised_digit(case, fixed):
    """Relative to the largest coefficient of each order, as `digits` promises; other units and other primes on the way."""
    promised_of_each_order(fixed[case.name], series_of(case, DIGITS + 20))


def promised_of_each_order(few, many):
    with mpmath.workdps(many.digits + 30):
        ratio = mpmath.mpf(many.unit.numerator) / many.unit.denominator * few.unit.denominator / few.unit.numerator
        for k in range(few.order + 1):
            for ours, theirs in ((few.coordinates[k], many.coordinates[k]), (few.corrections[k], many.corrections[k])):
                if ours.size == 0:
                    continue
                exact = few.tables.entries(theirs) * mpmath.ldexp(ratio ** (few.degree(k) - 1), few.bits - many.bits)
                allowed = abs(exact).max() * mpmath.mpf(10) ** -few.digits
                assert abs(few.tables.entries(ours) - exact).max() <= allowed


@pytest.mark.long
@pytest.mark.parametrize("digits", [1, 5, 15, 100])
@pytest.mark.parametrize(
    ("chain", "seeds", "frequencies", "order"),
    [
        (Chain(32, "0.33"), (1,), ("0.0984",), 14),
        (Chain(16, beta="-0.6"), (3, 14), ("0.57", "1.92"), 3),
        (Chain(7, "0.3", "0.7"), (1, 2, 6), ("0.46", "0.88", "1.96"), 4),
        (Chain(64, "0.3"), (1, 2), ("0.0493", "0.0984"), 5),
        (Chain(3, "-1"), (1, 2), ("1.03", "1.71"), 10),
    ],
    ids=str,
)
def test_few_and_many_digits_are_met_too(chain, seeds, frequencies, order, digits):
    few, many = (lindstedt(chain, seeds, frequencies, order, digits=d) for d in (digits, digits + 20))
    assert few.bits < many.bits
    promised_of_each_order(few, many)


def test_a_small_divisor_costs_guard_digits_not_promised_ones():
    """2 omega_1 = Omega_2 to eight digits: the second order carries 1 / 1e-9, its square and so on."""
    near = "0.382683433"
    with mpmath.workdps(30):
        assert abs(2 * mpmath.mpf(near) - 2 * mpmath.sin(mpmath.pi / 8)) < CHOSEN_RESONANCE
    few, many = (lindstedt(Chain(8, "0.3"), (1,), (near,), 6, digits=d) for d in (30, 50))
    assert few.guard_digits > lindstedt(few.chain, (1,), ("0.39",), 6, digits=30).guard_digits
    promised_of_each_order(few, many)


def test_multiply_adds_are_those_of_all_primes():
    """The same products as one prime of the residue ring, so many times as there are primes."""
    counts = [lindstedt(Chain(8, "0.3"), (1,), ("0.39",), 6, digits=d).multiply_adds for d in (20, 160)]
    assert 0 < 2 * counts[0] < counts[1]


@pytest.mark.parametrize("least", [0.0, 1e-9])
@pytest.mark.parametrize("bits", [40, 200])
@pytest.mark.parametrize(
    ("N", "seeds", "frequencies"), [(8, (1, 3), ("0.391", "1.113")), (9, (2,), ("0.68404",)), (8, (1,), ("0.382683433",))]
)
def test_multipliers_are_their_definition_rounded_down(N, seeds, frequencies, bits, least):
    """2^bits L_q(nu) by mpmath at far more bits, to one unit, also next to a resonance; zero elsewhere."""
    grading = Grading(len(seeds), 6)
    space = CosineModes(N, seeds, grading)
    divisors = FixedPointDivisors(Chain(N, 1), space, [Fraction(w) for w in frequencies], bits, least=least)
    count = 0
    with mpmath.workprec(6 * bits + 200):
        for degree in range(2, 7):
            nu, _ = grading.harmonics(degree)
            carried = space.mask_by_harmonic(degree)
            table = divisors.multipliers(nu, carried, degree - 1)
            gauge = space.gauge(nu)
            for (row, column), value in np.ndenumerate(table):
                if not carried[row, column] or gauge[row, column]:
                    assert value == 0
                else:
                    exact = mpmath.ldexp(multiplier(N, seeds, frequencies, column + 1, nu[row].tolist()), bits)
                    assert -(mpmath.mpf(2) ** -20) <= exact - int(value) <= 1 + mpmath.mpf(2) ** -20
                    count += 1
    assert count > 20


@pytest.mark.parametrize(("size", "factor", "within"), [(100, 1, True), (30, 2.0**55, True), (30, 2.0**85, False), (100, 2.0**15, False)])
def test_products_with_multipliers_beyond_the_range_are_refused(size, factor, within):
    """2^size over 2^bits times the factor, against 2^headroom: by sizes, which a large factor needs exactly."""
    precision = Precision(100, 10, Fraction(1))
    ring = FixedPointRing(CosineModes(4, (1,), Grading(1, 3)), precision)
    bracket = ring.basis.of_integers(np.array([[1 << size]], dtype=object))
    sizes = np.array([[float(Fraction(1 << (size + precision.bits), ring.basis.modulus))]])
    if within:
        ring._check_range(bracket, sizes, np.array([[factor]]))
    else:
        with pytest.raises(OverflowError, match="exceeds the range"):
            ring._check_range(bracket, sizes, np.array([[factor]]))
