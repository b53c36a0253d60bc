"""The symbolic ring: integer polynomials in L_q(nu), equal to the mode-space series of Eqs. moda and modb."""

import mpmath
import numpy as np
import pytest
import symengine as se

from symfpu.algebra.formulas import multiplier_symbol
from symfpu.chain.chain import Chain
from symfpu.series.lindstedt import lindstedt
from tests.oracles.cases import SHALLOW
from tests.oracles.mode_space import ModeSpaceSeries
from tests.oracles.trigonometric import from_amplitudes, from_monomials
from tests.oracles.universal import DIGITS, Numbers, evaluate
from tests.tolerances import HIGH_PRECISION

ONE_COUPLING = [case for case in SHALLOW if "0" in (case.alpha, case.beta)]


def universal(case):
    return lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, order=case.order)


@pytest.mark.parametrize("case", ONE_COUPLING, ids=lambda c: c.name)
def test_coefficients_are_integer_polynomials(case):
    entries = [entry for table in universal(case).coordinates for entry in np.ravel(table) if entry != 0]
    assert entries
    for entry in entries:
        assert all(se.sympify(c).is_Integer for c in se.sympify(entry).as_coefficients_dict().values())


def test_the_first_order_of_a_breather_is_the_closed_form():
    """sum B u_1 u_1 drives mode 2 alone: u_2^(1) = -L_2(2) w^2 - 2 L_2(0) |w|^2 and the conjugate of the first."""
    series = lindstedt(Chain(N=6, alpha=1), seeds=(1,), order=1)
    exponents, table = series.grading.exponents(2)[series.grading.canonical(2)].tolist(), np.asarray(series.coordinates[1])
    expected = {(1, 1): -2 * multiplier_symbol(2, (0,)), (2, 0): -multiplier_symbol(2, (2,))}
    assert {tuple(row): values[1] for row, values in zip(exponents, table, strict=True)} == expected
    assert all(value == 0 for q, column in enumerate(table.T) for value in column if q != 1)


def substituted(polynomial, numbers):
    return {key: evaluate(se.expand(value), numbers) for key, value in polynomial.items()}


def assert_equal(ours, theirs):
    """Key by key, to the digits of both; what the slow route leaves of an exact cancellation counts as absent."""
    scale = max((abs(value) for value in theirs.values()), default=0)
    theirs = {key: value for key, value in theirs.items() if abs(value) > HIGH_PRECISION * scale}
    assert ours.keys() == theirs.keys()
    assert all(abs(ours[key] - theirs[key]) <= HIGH_PRECISION * scale for key in ours)


@pytest.mark.parametrize("case", SHALLOW, ids=lambda c: c.name)
def test_the_series_is_that_of_mode_space(case):
    series = universal(case)
    oracle = ModeSpaceSeries(case.N, case.alpha, case.beta, case.seeds, case.frequencies, case.order)
    harmonics = [nu for d in range(series.degree(case.order) + 1) for nu in series.grading.harmonics(d)[0].tolist()]
    with mpmath.workdps(DIGITS):
        numbers = Numbers(case, harmonics)
        for k in range(case.order + 1):
            for q in range(1, case.N):
                assert_equal(substituted(from_monomials(*series.coefficients(q, k)), numbers), oracle.Q[q][k])
            for q in case.seeds:
                squared = from_amplitudes(*series.frequency_coefficients(q, k, squared=True))
                assert_equal(substituted(squared, numbers), oracle.omega_squared[q][k])
                corrections = from_amplitudes(*series.frequency_coefficients(q, k))
                assert_equal(substituted(corrections, numbers), oracle.omega[q][k])


def test_nested_coefficients_are_the_expanded_ones():
    expanded, nested = (lindstedt(Chain(7, alpha=1), (1, 3), order=3, ring=ring) for ring in ("symbolic", "nested"))
    shorter = 0
    for a, b in zip(expanded.coordinates, nested.coordinates, strict=True):
        assert ((a == 0) == (b == 0)).all()
        assert all(se.expand(x - y) == 0 for x, y in zip(np.ravel(a), np.ravel(b), strict=True))
        shorter += sum(len(str(x)) > len(str(y)) for x, y in zip(np.ravel(a), np.ravel(b), strict=True))
    assert shorter > 0
    assert se.expand(expanded.frequency_correction(1, 2) - nested.frequency_correction(1, 2)) == 0
