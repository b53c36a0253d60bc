"""MPFR's numbers stand for mpf inside of long sums: the same to the last bit, at the same precision."""

import operator

import gmpy2
import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION, from_integers, working_digits
from symfpu.numbers.mpfr import MPFR, at_the_face, in_mpf, inside, scaled_integers
from symfpu.tori.resummation import pade_sum

DIGITS = 40

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


def test_pade_sums_take_the_precision_of_mpmath():
    with mpmath.workdps(80):  # set by whoever calls it, and not for MPFR
        terms = array(*(mpmath.mpf(2) ** -k for k in range(7))) / 3
        assert abs(pade_sum(terms).values[()] - mpmath.mpf(2) / 3) < mpmath.mpf(10) ** -79
