"""The symbolic ring: integer polynomials in L_q(nu), equal to the mode-space series of Eqs. moda and modb."""

import numpy as np
import pytest
import symengine as se

from symfpu import Chain, lindstedt
from symfpu.algebra.formulas import multiplier_symbol
from tests.oracles.cases import SHALLOW

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


def test_nested_coefficients_are_the_expanded_ones():
    expanded, nested = (lindstedt(Chain(7, alpha=1), (1, 3), order=3, ring=ring) for ring in ("symbolic", "nested"))
    shorter = 0
    for a, b in zip(expanded.coordinates, nested.coordinates, strict=True):
        assert ((a == 0) == (b == 0)).all()
        assert all(se.expand(x - y) == 0 for x, y in zip(np.ravel(a), np.ravel(b), strict=True))
        shorter += sum(len(str(x)) > len(str(y)) for x, y in zip(np.ravel(a), np.ravel(b), strict=True))
    assert shorter > 0
    assert se.expand(expanded.frequency_correction(1, 2) - nested.frequency_correction(1, 2)) == 0
