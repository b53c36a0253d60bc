"""Arrays of two precisions: how numbers are read, how dot products keep their digits, and that contexts are put back."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from symfpu import Chain, lindstedt, solve_amplitudes
from symfpu.numbers.arithmetic import (
    DOUBLES,
    MULTIPRECISION,
    arithmetic_of,
    from_integers,
    integers,
    mpf,
    sine_matrix,
    text,
    with_digits,
)
from tests.tolerances import HUNDRED_ROUNDINGS, PRODUCT_OF_FORTY, TRANSFORM_OF_FORTY

PRECISION = 150  # bits


def numbers(least=-200, most=200):
    """mpf of very different sizes, and zero."""
    mantissas, exponents = st.integers(-(2**PRECISION), 2**PRECISION), st.integers(least, most)
    return st.builds(lambda m, e: mpmath.mpf((int(m < 0), abs(m), e, abs(m).bit_length())) if m else mpmath.mpf(0), mantissas, exponents)


matrices = st.integers(1, 5).flatmap(
    lambda n: st.tuples(
        st.lists(st.lists(numbers(), min_size=n, max_size=n), min_size=1, max_size=3),
        st.lists(st.lists(numbers(), min_size=n, max_size=n), min_size=1, max_size=3),
    )
)


@given(matrices)
def test_dot_loses_no_digits_of_small_rows_and_columns(factors):
    """Each entry is cut at 2^-prec of the largest of its row or column, so each sum is off by at most 5 n 2^-prec of both."""
    left, columns = (np.array(rows, dtype=object) for rows in factors)
    with mpmath.workprec(PRECISION):
        ours = MULTIPRECISION.dot(left, columns.T)
    assert ours.shape == (len(left), len(columns))
    with mpmath.workprec(4 * PRECISION + 2000):
        for i, row in enumerate(left):
            for j, column in enumerate(columns):
                allowed = 5 * len(row) * mpmath.ldexp(max(map(abs, row)) * max(map(abs, column)), -PRECISION)
                assert abs(ours[i, j] - mpmath.fdot(row, column)) <= allowed


def test_dot_of_rows_and_columns_of_very_different_size():
    """A row of 1e-300 times a column of 1e300, beside a row and a column of one: every product to all digits."""
    generator = np.random.default_rng(1)
    with mpmath.workdps(40):
        left = MULTIPRECISION.array(generator.random((3, 6)) + 0.5) * np.array(
            [[mpmath.mpf(10) ** -300], [mpmath.mpf(1)], [mpmath.mpf(10) ** 250]]
        )
        right = MULTIPRECISION.array(generator.random((6, 2)) + 0.5) * np.array([[mpmath.mpf(10) ** 300, mpmath.mpf(10) ** -400]])
        product = MULTIPRECISION.dot(left, right)
        for i in range(3):
            for j in range(2):
                assert abs(product[i, j] / mpmath.fdot(left[i], right[:, j]) - 1) < PRODUCT_OF_FORTY


def test_dot_has_the_shapes_of_matmul():
    with mpmath.workdps(30):
        left, right = MULTIPRECISION.array(np.arange(24).reshape(2, 3, 4)), MULTIPRECISION.array(np.arange(20).reshape(4, 5))
        assert MULTIPRECISION.dot(left, right).tolist() == (np.arange(24).reshape(2, 3, 4) @ np.arange(20).reshape(4, 5)).tolist()
        assert MULTIPRECISION.dot(left[0, 0], right).shape == (5,)
        assert MULTIPRECISION.dot(left[:0], right).shape == (0, 3, 5)
        zeros = MULTIPRECISION.dot(left[:, :, :0], right[:0])
        assert zeros.shape == (2, 3, 5)
        assert all(isinstance(x, mpmath.mpf) and x == 0 for x in zeros.flat)


@given(st.lists(st.lists(numbers(), min_size=2, max_size=2), min_size=1, max_size=4))
def test_integers_and_back_keep_the_digits_of_the_largest(rows):
    values = np.array(rows, dtype=object)
    with mpmath.workprec(PRECISION):
        table, exponents = integers(values)
        assert table.shape == values.shape
        assert exponents.shape == (2,)
        back = from_integers(table, exponents)
        for j in range(2):
            allowed = mpmath.ldexp(max(map(abs, values[:, j])), 1 - PRECISION)
            assert all(abs(a - b) <= allowed for a, b in zip(values[:, j], back[:, j], strict=True))


def test_floats_are_read_by_their_shortest_decimal():
    """0.1 means one tenth: as a float, in arrays, as text and as a fraction alike."""
    with mpmath.workdps(50):
        tenth = mpmath.mpf(1) / 10
        for value in (0.1, np.float64(0.1), "0.1", Fraction(1, 10)):
            assert mpf(value) == tenth
        assert MULTIPRECISION.array([0.1, 3, np.int64(7)]).tolist() == [tenth, 3, 7]
        assert mpf(mpmath.mpf(0.1)) == mpmath.mpf(0.1) != tenth  # an mpf is what it is
        assert MULTIPRECISION.number(Fraction(1, 10)) == tenth
        assert mpf(10**60 + 1) - mpf(10**60) in (0, 1)
    assert DOUBLES.number(Fraction(1, 10)) == 0.1


def test_numbers_that_are_none_are_refused():
    for value in ([1j], ["one"], [None], [[1, 2], [3]], [object()]):
        with pytest.raises((TypeError, ValueError)):
            MULTIPRECISION.array(value)


def test_the_arithmetic_of_an_array_is_found():
    assert arithmetic_of([1.0, 2.0]) is arithmetic_of(np.arange(3)) is arithmetic_of([]) is DOUBLES
    assert arithmetic_of([mpmath.mpf(1)]) is arithmetic_of([[1.0, mpmath.mpf(2)]]) is MULTIPRECISION
    assert arithmetic_of([Fraction(1, 2)]) is DOUBLES


@pytest.mark.parametrize("N", [2, 3, 7, 16])
def test_the_sine_matrix_is_orthogonal_at_every_precision(N):
    """Kept tables of one precision are not used at another."""
    for digits in (20, 60, 20, 100):
        with mpmath.workdps(digits):
            matrix = sine_matrix(N)
            square = MULTIPRECISION.dot(matrix, matrix)
            assert abs(square - np.eye(N - 1).astype(int)).max() < mpmath.mpf(10) ** (2 - digits)


def test_transforms_of_the_chain_agree_with_doubles():
    chain = Chain(9, "0.3", "-0.2")
    Q, P = np.random.default_rng(2).normal(size=(2, 4, 8))
    with mpmath.workdps(40):
        many = [f(MULTIPRECISION.array(Q)) for f in (chain.positions, chain.modes, chain.stretches, chain.accelerations)]
        energies = [f(MULTIPRECISION.array(Q), MULTIPRECISION.array(P)) for f in (chain.energy, chain.harmonic_energies)]
        back = chain.modes(many[0])
        assert abs(back - MULTIPRECISION.array(Q)).max() < TRANSFORM_OF_FORTY
    few = [f(Q) for f in (chain.positions, chain.modes, chain.stretches, chain.accelerations)]
    few += [f(Q, P) for f in (chain.energy, chain.harmonic_energies)]
    for ours, theirs in zip(many + energies, few, strict=True):
        assert ours.shape == theirs.shape
        assert np.allclose(ours.astype(float), theirs, rtol=HUNDRED_ROUNDINGS, atol=HUNDRED_ROUNDINGS)


CHAIN = Chain(8, beta="0.3")


@pytest.fixture(scope="module")
def torus():
    return solve_amplitudes(lindstedt(CHAIN, (3,), ("1.113",), 4, digits=30))


def test_results_do_not_depend_on_the_working_precision(torus):
    for digits in (5, 15, 100):
        with mpmath.workdps(digits):
            again = solve_amplitudes(lindstedt(CHAIN, (3,), ("1.113",), 4, digits=30))
            assert again.amplitudes == torus.amplitudes
            assert (again.Q(0.3) == torus.Q(0.3)).all()
            assert again.energy() == torus.energy()
            assert (again.average_spectrum() == torus.average_spectrum()).all()
            assert again.origin.series.term(5, 2) == torus.origin.series.term(5, 2)
            assert again.origin.certificate == torus.origin.certificate


LONG = "0.123456789012345678901234567890123456789012345"  # 45 digits


@pytest.fixture
def long():
    with mpmath.workdps(60):
        return with_digits(mpmath.mpf(LONG), 45)


def test_numbers_print_the_digits_they_were_asked_for(long):
    assert mpmath.mp.dps == 15
    assert str(long) == f"{long}" == LONG
    assert repr(long) == f"mpf('{LONG}')"
    assert f"{long:.20f} {long:+.30e} {long:.3g} {long:>50}" == (
        f"0.12345678901234567890 +1.234567890123456789012345678901e-1 0.123 {LONG:>50}"
    )
    with mpmath.workdps(60):
        tiny, signed, whole = (with_digits(mpmath.mpf(x), 40) for x in ("1e-5000", f"-{LONG}", "3"))
        assert eval(repr(long), {"mpf": mpmath.mpf}) == mpmath.mpf(LONG)
    assert (str(tiny), str(signed), str(whole)) == ("1.0e-5000", LONG.join("-_").replace("_", "")[:42], "3.0")
    assert [str(with_digits(mpmath.mpf(x), 30)) for x in ("inf", "-inf", "nan")] == ["+inf", "-inf", "nan"]
    assert f"{with_digits(mpmath.inf, 30):g}" == "Infinity"


def test_numbers_with_digits_compute_as_any_mpf(long):
    plain = mpmath.mpf(0)
    with mpmath.workdps(60):
        plain += mpmath.mpf(LONG)
    assert isinstance(long, mpmath.mpf)
    assert long == plain
    assert hash(long) == hash(plain)
    assert float(long) == float(plain) == 0.12345678901234568
    assert long < 1 < 1 / long
    for dps in (15, 50):
        with mpmath.workdps(dps):
            pairs = [
                (long + 1, plain + 1),
                (2.5 * long, 2.5 * plain),
                (plain - long, mpmath.mpf(0)),
                (long**2, plain**2),
                (-long, -plain),
                (mpmath.cos(long), mpmath.cos(plain)),
                (np.float64(2) * long, np.float64(2) * plain),
                (long * (1 + 2j), plain * (1 + 2j)),
                (mpmath.mpf(long), +plain),
                (np.sqrt(np.array([long], dtype=object))[0], mpmath.sqrt(plain)),
            ]
            for ours, theirs in pairs:
                assert type(ours) is type(theirs)
                assert ours == theirs
    assert text(long, 45) == text(plain, 45) == LONG
    assert arithmetic_of([long]) is MULTIPRECISION


def test_containers_hold_numbers_with_digits(long):
    plain = mpmath.mpf(long)
    array = with_digits(np.array([[plain, 0.5], [plain, 1]], dtype=object), 45)
    assert array.shape == (2, 2)
    assert [type(x).__name__ for x in array.flat] == ["NumberWithDigits", "float", "NumberWithDigits", "int"]
    assert with_digits(np.zeros((0, 3), dtype=object), 45).shape == (0, 3)
    nested = with_digits({1: (plain, 0.5), 2: "text"}, 20)
    assert (str(nested[1][0]), nested[1][1], nested[2]) == (mpmath.nstr(plain, 20), 0.5, "text")
    doubles = np.zeros(3)
    assert with_digits(doubles, 45) is doubles
    assert with_digits(plain, None) is plain
