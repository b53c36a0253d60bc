"""The ring of fixed-point numbers against mode space, against the other rings, and against itself with more digits."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
import symengine as se

from symfpu.algebra.fixedpoint import FixedPointRing, Precision
from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes
from symfpu.chain.chain import Chain
from symfpu.errors import ResonantDivisor
from symfpu.series.divisors import FixedPointDivisors, gauge_terms
from symfpu.series.lindstedt import lindstedt
from tests.oracles import mode_space
from tests.oracles.cases import CASES, SHALLOW
from tests.oracles.trigonometric import from_amplitudes, from_monomials
from tests.oracles.universal import multiplier
from tests.tolerances import CHOSEN_RESONANCE, COEFFICIENT, FORTY_DIGITS

DIGITS = 40
ORACLE_DIGITS = 60
CANCELLING = ("beta, three seeds",)  # see test_float64
NAMES = [case.name for case in CASES]


def series_of(case, digits=DIGITS):
    return lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order, digits=digits)


@pytest.fixture(scope="module")
def fixed():
    return {case.name: series_of(case) for case in CASES}


@pytest.fixture(scope="module")
def doubles():
    return {case.name: series_of(case, digits=None) for case in CASES}


@pytest.fixture
def oracle(monkeypatch):
    """The slow series of a case, at more digits than it is compared to."""
    monkeypatch.setattr(mode_space, "DIGITS", ORACLE_DIGITS)
    return lambda case: mode_space.ModeSpaceSeries(case.N, case.alpha, case.beta, case.seeds, case.frequencies, case.order)


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_series_is_that_of_mode_space(case, fixed, oracle):
    """Every coefficient of every order, coordinates and both frequency series, to the promised digits of its order."""
    series, slow = fixed[case.name], oracle(case)
    with mpmath.workdps(ORACLE_DIGITS):
        for k in range(case.order + 1):
            compare({q: from_monomials(*series.coefficients(q, k)) for q in range(1, case.N)}, {q: slow.Q[q][k] for q in slow.Q})
            for squared, theirs in ((True, slow.omega_squared), (False, slow.omega)):
                ours = {q: from_amplitudes(*series.frequency_coefficients(q, k, squared=squared)) for q in case.seeds}
                compare(ours, {q: theirs[q][k] for q in case.seeds})


def compare(ours, theirs):
    """All coefficients of one order, relative to the largest of them."""
    scale = max((abs(value) for terms in theirs.values() for value in terms.values()), default=0)
    for q, terms in theirs.items():
        for key in terms.keys() | ours[q].keys():
            assert abs(ours[q].get(key, 0) - terms.get(key, 0)) <= FORTY_DIGITS * scale


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_tables_are_those_of_doubles(case, fixed, doubles):
    """Different units; both are powers of one number in the degree."""
    ours, theirs = fixed[case.name], doubles[case.name]
    for kind, lowered in (("coordinates", 1), ("corrections", 1)):
        for k, (integers, expected) in enumerate(zip(getattr(ours, kind), getattr(theirs, kind), strict=True)):
            if k == 0 and kind == "corrections":
                assert integers.size == expected.size == 0
                continue
            values = integers.floats(-ours.bits) * (float(ours.unit) / float(theirs.unit)) ** (ours.degree(k) - lowered)
            assert values.shape == expected.shape
            assert np.abs(values - expected).max(initial=0) <= COEFFICIENT * np.abs(expected).max(initial=0)


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
    for table, expected in zip(fixed[case.name].coordinates, doubles[case.name].coordinates, strict=True):
        assert (table.words.any(axis=-1) == (expected != 0)).all()


@pytest.mark.parametrize("case", [case for case in SHALLOW if case.name not in CANCELLING], ids=lambda c: c.name)
def test_the_nonzero_pattern_is_that_of_the_symbolic_ring(case, fixed):
    symbols = lindstedt(fixed[case.name].chain, case.seeds, order=case.order)
    for table, entries in zip(fixed[case.name].coordinates, symbols.coordinates, strict=True):
        assert (table.words.any(axis=-1) == np.vectorize(lambda x: se.expand(x) != 0, otypes=[bool])(entries)).all()


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


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_order_zero_is_the_seeds_and_nothing_else(case):
    series = series_of(replace_order(case, 0))
    (table,), (correction,) = series.coordinates, series.corrections
    assert table.integers().tolist() == [
        [(1 << series.bits) if row_seed == q else 0 for q in range(1, case.N)] for row_seed in seeds_by_row(series)
    ]
    assert correction.shape == (0, len(case.seeds))
    assert series.radii[0][0] == 0
    (value,) = series.coefficients(case.seeds[0], 0)[1]
    assert abs(value - 1) < FORTY_DIGITS


def replace_order(case, order):
    return case._replace(order=order)


def seeds_by_row(series):
    return [series.seeds[int(np.argmax(powers))] for powers in series.grading.powers(1)]


def test_the_repr_states_promised_and_guard_digits(fixed):
    for series in fixed.values():
        assert series.digits == DIGITS
        assert series.guard_digits == int(series.bits * np.log10(2)) - DIGITS >= 6
        assert f"({DIGITS} digits, {series.guard_digits} guard digits)" in repr(series)
        assert series.ring == "fixedpoint"


def test_seeds_in_any_order_carry_their_own_frequency():
    chain = Chain(8, "0.33")
    one = lindstedt(chain, (2, 1), ("0.79", "0.4"), 3, digits=30)
    two = lindstedt(chain, (1, 2), ("0.4", "0.79"), 3, digits=30)
    assert (one.seeds, one.frequencies) == (two.seeds, two.frequencies)
    assert all((a.words == b.words).all() for a, b in zip(one.coordinates, two.coordinates, strict=True))


def test_floats_are_read_by_their_shortest_decimal():
    """0.33 is 33/100, and 0.4 is 2/5: not the doubles next to them."""
    one = lindstedt(Chain(8, 0.33), (1,), (0.4,), 3, digits=40)
    two = lindstedt(Chain(8, Fraction(33, 100)), (1,), (Fraction(2, 5),), 3, digits=40)
    other = lindstedt(Chain(8, 0.33), (1,), (Fraction(0.4),), 3, digits=40)
    assert all((a.words == b.words).all() for a, b in zip(one.coordinates, two.coordinates, strict=True))
    assert not (one.coordinates[1].words == other.coordinates[1].words).all()


def test_progress_goes_up_to_all_of_the_work():
    steps = []
    lindstedt(Chain(8, "0.3"), (1,), ("0.39",), 3, digits=30, progress=lambda label, fraction: steps.append(fraction))
    assert steps == sorted(steps)
    assert steps[-1] == 1


def test_multiply_adds_are_those_of_all_primes():
    """The same products as one prime of the residue ring, so many times as there are primes."""
    counts = [lindstedt(Chain(8, "0.3"), (1,), ("0.39",), 6, digits=d).multiply_adds for d in (20, 80)]
    assert 0 < 2 * counts[0] < counts[1]


@pytest.mark.parametrize(
    ("N", "seeds", "frequencies", "mode", "harmonic", "order"),
    [
        (9, (1, 2), ("1/4", "3/4"), 3, (1, 1), 1),  # Omega_3 = 1 is the one rational linear frequency
        (6, (1,), ("1/2",), 2, (2,), 1),
        (16, (1, 3), ("0.2", "0.6"), 1, (2, -1), 2),  # omega_1 = omega_3 - 2 omega_1
    ],
)
def test_an_exact_zero_is_a_resonance(N, seeds, frequencies, mode, harmonic, order):
    with pytest.raises(ResonantDivisor) as caught:
        lindstedt(Chain(N, alpha="0.1"), seeds, frequencies, 5, digits=40)
    error = caught.value
    assert (error.mode, error.harmonic, error.order, error.exact) == (mode, harmonic, order, True)


def test_a_longer_chain_has_more_modes_not_other_ones(fixed):
    """Replacing a coupling in a chain changes the series: nothing is kept between calls but tables of monomials."""
    case = CASES[NAMES.index("both, three seeds")]
    series = fixed[case.name]
    again = series_of(case)
    other = lindstedt(series.chain.at(beta="0.2"), case.seeds, case.frequencies, case.order, digits=DIGITS)
    assert all((a.words == b.words).all() for a, b in zip(series.coordinates, again.coordinates, strict=True))
    assert not (series.coordinates[2].integers() == other.coordinates[2].integers()).all()


@pytest.mark.parametrize("least", [0.0, 1e-9])
@pytest.mark.parametrize("bits", [40, 200])
@pytest.mark.parametrize(
    ("N", "seeds", "frequencies"), [(8, (1, 3), ("0.391", "1.113")), (9, (2,), ("0.68404",)), (8, (1,), ("0.382683433",))]
)
def test_multipliers_are_their_definition_rounded_down(N, seeds, frequencies, bits, least):
    """2^bits L_q(nu) by mpmath at far more bits, to one unit, also next to a resonance; zero elsewhere."""
    divisors = FixedPointDivisors(Chain(N, 1), seeds, [Fraction(w) for w in frequencies], bits, least=least)
    grading = Grading(len(seeds), 6)
    space = CosineModes(N, seeds, grading)
    count = 0
    with mpmath.workprec(6 * bits + 200):
        for degree in range(2, 7):
            nu, _ = grading.harmonics(degree)
            carried = space.mask_by_harmonic(degree)
            table = divisors.multipliers(nu, carried, degree - 1)
            gauge = gauge_terms(nu, seeds, N)
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
