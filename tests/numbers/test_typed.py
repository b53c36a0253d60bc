"""Numbers are what was typed; what is no number is refused by name."""

from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from symfpu import Chain, InputError
from symfpu.numbers.typed import exact, integer, seed_modes


@pytest.mark.parametrize(
    ("typed", "value"),
    [
        ("0.33", Fraction(33, 100)),
        (0.33, Fraction(33, 100)),
        ("-1/3", Fraction(-1, 3)),
        (Fraction(2, 7), Fraction(2, 7)),
        (Decimal("1.250"), Fraction(5, 4)),
        (np.float64(0.1), Fraction(1, 10)),
        (np.int32(-4), Fraction(-4)),
        (7, Fraction(7)),
        ("1e-5", Fraction(1, 100000)),
        (" 2 ", Fraction(2)),
    ],
)
def test_exact_numbers(typed, value):
    result = exact(typed, "x")
    assert result == value
    assert type(result) is Fraction
    assert (type(result.numerator), type(result.denominator)) == (int, int)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_float_is_read_by_its_shortest_decimal(value):
    assert float(exact(value, "x")) == value
    assert exact(value, "x") == Fraction(Decimal(repr(value)))


@pytest.mark.parametrize(
    "typed", ["", "x", "1/0", "nan", "inf", float("nan"), float("-inf"), Decimal("NaN"), Decimal("Infinity"), None, True, 1j, [1]]
)
def test_what_is_no_number_is_refused(typed):
    with pytest.raises(InputError) as caught:
        exact(typed, "omega")
    assert caught.value.argument == "omega"
    assert repr(typed) in str(caught.value)


@pytest.mark.parametrize("value", [3, np.int64(3), np.uint8(3)])
def test_integers_are_plain(value):
    assert integer(value, "k", 0) == 3
    assert type(integer(value, "k", 0)) is int


@pytest.mark.parametrize("value", [-1, 2.0, "2", True, None, Fraction(1, 2)])
def test_what_is_no_integer_in_range_is_refused(value):
    with pytest.raises(InputError, match="k = "):
        integer(value, "k", 0)


def test_seed_modes_are_plain_and_keep_their_order():
    seeds = seed_modes(np.array([5, 3]), 8)
    assert seeds == (5, 3)
    assert all(type(q) is int for q in seeds)
    assert seed_modes((q for q in (1, 7)), 8) == (1, 7)


@pytest.mark.parametrize("seeds", [(), (1, 1), (0,), (8,), (-1,), (1.0,), ("1",), (True,), 3, None])
def test_bad_seeds_are_refused(seeds):
    with pytest.raises(InputError) as caught:
        seed_modes(seeds, 8)
    assert caught.value.argument == "seeds"


@pytest.mark.parametrize("text", ["1e999999999", "1e-999999999", "9" * 2000])
def test_absurd_numbers_are_refused_at_once(text):
    with pytest.raises(InputError):
        exact(text, "alpha")


@pytest.mark.parametrize("coupling", ["1e400", "1e-200", "1e60"])
def test_couplings_that_doubles_cannot_carry_are_refused(coupling):
    with pytest.raises(InputError, match="alpha"):
        Chain(4, alpha=coupling)


def test_numbers_of_many_digits_keep_them_all():
    with mpmath.workdps(60):
        third = mpmath.mpf(1) / 3
        value = exact(third, "amplitude")
        assert mpmath.mpf(value.numerator) / value.denominator == third
    assert value != Fraction(1, 3)
    assert exact(mpmath.mpf(-2) ** -70, "amplitude") == Fraction(1, 2**70)
    with pytest.raises(InputError, match="amplitude"):
        exact(mpmath.inf, "amplitude")
