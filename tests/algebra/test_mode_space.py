"""Every ring against the slow series in mode space: all coefficients of all orders, coordinates and both frequency series."""

from functools import cache

import mpmath
import pytest
import symengine as se

from symfpu import Chain, lindstedt
from tests.oracles import mode_space
from tests.oracles.cases import CASES, SHALLOW
from tests.oracles.trigonometric import from_amplitudes, from_monomials
from tests.oracles.universal import Numbers, evaluate
from tests.tolerances import COEFFICIENT, FORTY_DIGITS, HIGH_PRECISION

DIGITS = 60
WITHIN = {"doubles": COEFFICIENT, "forty digits": FORTY_DIGITS}


@cache
def slow(case):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mode_space, "DIGITS", DIGITS)
        return mode_space.ModeSpaceSeries(case.N, case.alpha, case.beta, case.seeds, case.frequencies, case.order)


def slow_functions(case, k):
    tables = {"Q": slow(case).Q, "omega": slow(case).omega, "omega^2": slow(case).omega_squared}
    return {(kind, q): orders[k] for kind, table in tables.items() for q, orders in table.items()}


def functions(series, k):
    """Every function of the angles of order k, by what it is."""
    found = {("Q", q): from_monomials(*series.coefficients(q, k)) for q in series.chain.mode_numbers}
    for q in series.seeds:
        found["omega", q] = from_amplitudes(*series.frequency_coefficients(q, k))
        found["omega^2", q] = from_amplitudes(*series.frequency_coefficients(q, k, squared=True))
    return found


@pytest.mark.long
@pytest.mark.parametrize("ring", WITHIN)
@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_numbers_are_those_of_mode_space(case, ring):
    """Relative to the largest coefficient of an order, of coordinates and of each frequency series."""
    digits = 40 if ring == "forty digits" else None
    series = lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order, digits=digits)
    with mpmath.workdps(DIGITS):
        for k in range(case.order + 1):
            ours, theirs = functions(series, k), slow_functions(case, k)
            for kind in ("Q", "omega", "omega^2"):
                own = {what: terms for what, terms in theirs.items() if what[0] == kind}
                scale = largest(*own.values())
                for what, terms in own.items():
                    for key in terms.keys() | ours[what].keys():
                        assert abs(ours[what].get(key, 0) - terms.get(key, 0)) <= WITHIN[ring] * scale


@pytest.mark.parametrize("case", SHALLOW, ids=lambda c: c.name)
def test_symbols_are_those_of_mode_space(case):
    """Key by key; what the slow route leaves of an exact cancellation counts as absent."""
    series = lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, order=case.order)
    harmonics = [nu for d in range(series.degree(case.order) + 1) for nu in series.grading.harmonics(d)[0].tolist()]
    with mpmath.workdps(DIGITS):
        numbers = Numbers(case, harmonics)
        for k in range(case.order + 1):
            theirs = slow_functions(case, k)
            for what, polynomial in functions(series, k).items():
                ours = {key: evaluate(se.expand(value), numbers) for key, value in polynomial.items()}
                allowed = HIGH_PRECISION * largest(theirs[what])
                assert ours.keys() == {key for key, value in theirs[what].items() if abs(value) > allowed}
                assert all(abs(value - theirs[what][key]) <= allowed for key, value in ours.items())


def largest(*functions):
    return max((abs(value) for terms in functions for value in terms.values()), default=0)
