"""MPFR's numbers stand for mpf inside of long sums: the same to the last bit, at the same precision."""

import operator

import gmpy2
import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from symfpu import Chain, lindstedt
from symfpu.algebra.polynomials import evaluate, powers_of
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION, from_integers, working_digits
from symfpu.numbers.mpfr import MPFR, at_the_face, in_mpf, inside, scaled_integers
from symfpu.tori.resummation import _pade_sum, pade_sum

DIGITS = 40
SERIES = lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3905", "0.7655"), 8, digits=DIGITS)
AMPLITUDES = [mpmath.mpf("0.21"), mpmath.mpf("-0.13")]

whole = st.integers(-(2**200), 2**200)
exponents = st.integers(-400, 400)


def array(*values):
    return np.array(values, dtype=object)


@given(whole, exponents, whole.filter(bool), exponents, st.sampled_from([10, 40, 100]))
def test_sums_products_quotients_and_roots_are_those_of_mpf(a, i, b, j, digits):
    with working_digits(digits):
        left, right = from_integers(array(a, b), array(i, j))
        inner = scaled_integers(array(a, b), array(i, j))
        assert (in_mpf(inner) == array(left, right)).all()
        for act in (operator.add, operator.sub, operator.mul, operator.truediv):
            assert in_mpf(array(act(*inner)))[0]._mpf_ == act(left, right)._mpf_
        assert in_mpf(MPFR.sqrt(np.abs(inner)))[0]._mpf_ == mpmath.sqrt(abs(left))._mpf_


def test_the_working_precision_is_put_back_with_mpmaths():
    before = gmpy2.get_context().precision
    with MULTIPRECISION.context(DIGITS):
        assert gmpy2.get_context().precision == mpmath.mp.prec
    assert gmpy2.get_context().precision == before
    with pytest.raises(ZeroDivisionError):
        broken_off()
    assert gmpy2.get_context().precision == before


def broken_off():
    with MULTIPRECISION.context(DIGITS):
        return 1 / mpmath.mpf(0)


def test_inside_of_doubles_are_doubles():
    assert inside(DOUBLES) is DOUBLES
    values = np.array([0.5])
    assert at_the_face(values) is values


@pytest.mark.parametrize("order", range(9))
def test_terms_of_harmonics_are_those_of_scalar_mpf(order):
    nu, values = SERIES.harmonic_terms(AMPLITUDES, order)
    _, index = SERIES.grading.harmonics(SERIES.degree(order))
    with MULTIPRECISION.context(DIGITS):
        products, exponent = SERIES._integers(AMPLITUDES, order)
        sums = np.zeros(values.shape, dtype=object)
        np.add.at(sums, index, products)
        scaled = from_integers(sums, exponent) * (SERIES._sign(order) / SERIES._kappa)
        expected = scaled / SERIES.chain.frequencies(MULTIPRECISION)
        expected[(nu != 0).any(axis=1)] *= 2
    assert any(x for x in expected.flat)
    assert [x._mpf_ for x in values.flat] == [x._mpf_ for x in expected.flat]


def test_terms_of_frequencies_are_those_of_scalar_mpf():
    with MULTIPRECISION.context(DIGITS):
        squares = [a**2 for a in AMPLITUDES]
        powers = powers_of(squares, 4, mpmath.mpf(1))
        expected = [[evaluate(p, powers) for p in row] for row in SERIES._frequency_polynomials]
    terms, slopes = SERIES.frequency_terms(squares)
    for k, row in enumerate(expected):
        for i, (value, gradient) in enumerate(row):
            assert terms[k, i] == value
            assert list(slopes[k, i]) == gradient


def test_pade_sums_are_those_of_scalar_mpf():
    with MULTIPRECISION.context(DIGITS):
        ratios = array(*(mpmath.mpf(n) / 7 for n in range(-6, 7)))
        terms = np.array([ratios**k / (k + 1) for k in range(9)], dtype=object)
        expected, found = _pade_sum(terms), pade_sum(terms)
    assert [x._mpf_ for x in found.values] == [x._mpf_ for x in expected.values]
    assert (found.disagreement == expected.disagreement).all()
    assert all(isinstance(x, mpmath.mpf) for x in found.values)


def test_pade_sums_take_the_precision_of_mpmath():
    with mpmath.workdps(80):  # set by whoever calls it, and not for MPFR
        terms = array(*(mpmath.mpf(2) ** -k for k in range(7))) / 3
        assert abs(pade_sum(terms).values[()] - mpmath.mpf(2) / 3) < mpmath.mpf(10) ** -79
