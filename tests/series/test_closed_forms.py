"""Formulas in frequencies and in N against the recursion in numbers; series compared exactly."""

from dataclasses import replace
from decimal import Decimal

import numpy as np
import pytest
import symengine as se

from symfpu import Chain, InputError, closed_form, collect_terms, leading_term, lindstedt, same_series, substitute_multipliers
from symfpu.algebra.formulas import NodeTable
from symfpu.chain.length import mode_label, mode_of
from tests.tolerances import COEFFICIENT, TYPED_LAW

N = 11
CASES = [
    ({"alpha": 1}, (1, 3)),
    ({"beta": 1}, (2,)),
    ({"alpha": 1}, (1, "N-1")),
    ({"beta": 1}, ("N-2", "N-1")),
    ({"alpha": 1, "beta": "1/3"}, (1,)),
]


@pytest.mark.parametrize(("couplings", "seeds"), CASES, ids=str)
def test_terms_in_closed_form_are_those_of_the_recursion_in_doubles(couplings, seeds):
    """Universal for all N -> quotients of sines of N -> a number for N, against doubles at that N."""
    order = 2
    series = lindstedt(Chain("N", **couplings), seeds, order=order)
    chain = series.chain.at(N=N)
    modes = [mode_of(q, N) for q in series.seeds]
    frequencies = [str(round(w + 0.003 * (i + 1), 5)) for i, w in enumerate(chain.frequencies()[np.array(modes) - 1])]
    doubles = lindstedt(chain, modes, frequencies, order)
    values = {se.Symbol("N"): N}
    for q, w in zip(series.seeds, frequencies, strict=True):
        values[se.Symbol(f"omega_{q}" if q > 0 else f"omega_{{{q}}}")] = float(w)
    compared = 0
    for k in range(order + 1):
        for q in series.modes:
            if mode_of(q, N) in [mode_of(p, N) for p in series.modes if p != q]:
                continue
            exponents, formulas = series.coefficients(q, k)
            rows, numbers = doubles.coefficients(mode_of(q, N), k)
            expected = dict(zip(map(tuple, rows.tolist()), numbers, strict=True))
            for row, formula in zip(exponents.tolist(), formulas, strict=True):
                found = float(closed_form(formula, series.chain, series.seeds).subs(values))
                assert found == pytest.approx(expected.pop(tuple(row)), rel=COEFFICIENT * 1e3)
                compared += 1
            assert not expected
    assert compared > 5


def test_linear_frequencies_leave_nothing_but_N():
    series = lindstedt(Chain("N", alpha=1), (1, 2), order=3)
    formula = closed_form(series.frequency_correction(1, 2), series.chain, series.seeds, frequencies="linear")
    assert {s.name for s in formula.free_symbols} == {"N", "A1", "A2"}
    # Eq. omamid in closed form: Omega_1 ((1 - 3/4 Omega_1^2) A_1^2 - Omega_2^2 A_2^2)
    first, second = Chain(20, alpha=1).frequencies()[:2]
    value = float(formula.subs({"N": 20, "A1": 1, "A2": 2}))
    assert value == pytest.approx(first * (1 - 0.75 * first**2 - 4 * second**2), rel=TYPED_LAW)


def test_divisors_of_leading_terms_are_those_of_the_paper():
    """Q_2^(1) of one seed: the two divisors Omega_2^2 and Omega_2^2 - 4 omega_1^2."""
    term = substitute_multipliers(leading_term(Chain(8, alpha=1), (1,), 2), (1,))
    A, theta, Omega1, Omega2, omega = se.symbols("A1 theta1 Omega_1 Omega_2 omega_1")
    expected = -(A**2) * Omega1**2 * Omega2 / 2 * (1 / Omega2**2 + se.cos(2 * theta) / (Omega2**2 - 4 * omega**2))
    assert se.expand(term - expected) == 0


@pytest.mark.parametrize("seeds", [(1, 2), ("N",), ()], ids=str)
def test_seeds_that_do_not_fit_are_refused(seeds):
    with pytest.raises(InputError):
        substitute_multipliers(se.Symbol("L_{2}(2)"), seeds)


def test_an_unknown_word_for_frequencies_is_refused():
    with pytest.raises(InputError, match="'chosen' or 'linear'"):
        closed_form(se.Symbol("Omega_1"), Chain("N", alpha=1), (1,), frequencies="exact")


def test_collected_terms_add_up():
    term = lindstedt(Chain("N", alpha=1), (1, 2), order=3).term(3, 3)
    amplitudes = [s for s in term.free_symbols if s.name.startswith("A")]
    by_amplitudes = collect_terms(term, amplitudes)
    assert se.expand(sum(m * c for m, c in by_amplitudes.items()) - term) == 0
    assert {m.free_symbols <= set(amplitudes) for m in by_amplitudes} == {True}
    assert not any(c.free_symbols & set(amplitudes) for c in by_amplitudes.values())
    assert len(by_amplitudes) == 2  # A1^3 A2 and A1 A2^3
    by_phases = collect_terms(term, [s for s in term.free_symbols if s.name.startswith("theta")])
    assert {type(m).__name__.lower() for m in by_phases} == {"cos"}


def test_what_is_no_symbol_is_refused():
    with pytest.raises(InputError, match="symbols"):
        collect_terms(se.Symbol("x"), [se.Symbol("x") + 1])


def test_nested_and_expanded_series_are_the_same():
    nested, expanded = (lindstedt(Chain("N", alpha=1), (1, 2), order=4, ring=ring) for ring in ("nested", "symbolic"))
    assert same_series(nested, expanded)


def test_a_series_for_all_N_is_that_of_each():
    series = lindstedt(Chain("N", beta=1), (1, 2), order=2)
    assert same_series(series, lindstedt(Chain(14, beta=1), (1, 2), order=2))
    assert same_series(lindstedt(Chain(14, beta=1), (1, 2), order=2), series)


DIFFERENT = {
    "order": lambda: lindstedt(Chain(9, alpha=1), (1, 2), order=3),
    "seeds": lambda: lindstedt(Chain(9, alpha=1), (1, 3), order=2),
    "model": lambda: lindstedt(Chain(9, beta=1), (1, 2), order=2),
    "folded": lambda: lindstedt(Chain(6, alpha=1), (1, 2), order=2),
    "couplings": lambda: lindstedt(Chain(9, alpha=1, beta=1), (1, 2), order=2),
}


@pytest.mark.parametrize("name", DIFFERENT)
def test_different_series_are_told_apart(name):
    series = lindstedt(Chain(9, alpha=1), (1, 2), order=2)
    assert not same_series(series, DIFFERENT[name]())


def test_one_node_in_another_place_is_told_apart():
    """The same arrays but for one coefficient."""
    series = lindstedt(Chain(9, alpha=1), (1, 2), order=2)
    table = series.coordinates[2]
    nodes = table.nodes.copy()
    first, second = np.argwhere(table.nonzero)[:2]
    nodes[tuple(first)] = nodes[tuple(second)]
    changed = NodeTable(table.program, nodes, expanded=True)
    assert not same_series(series, replace(series, coordinates=(*series.coordinates[:2], changed)))


def test_series_with_numbers_are_refused():
    series = lindstedt(Chain(9, alpha=1), (1,), ("0.35",), 2)
    with pytest.raises(InputError, match="universal form"):
        same_series(series, series)


def test_labels_of_both_ends_are_read():
    assert [mode_label(q, "q") for q in (2, "N-2", "N - 3")] == [2, -2, -3]


@pytest.mark.parametrize("expression", [{1: 2}, Chain(8, alpha=1), set(), None, True, "x+", "A1 < 2", Decimal("1e1000")], ids=str)
def test_what_is_no_expression_is_refused(expression):
    for refused in (lambda: substitute_multipliers(expression, (1,)), lambda: collect_terms(expression, ["A1"])):
        with pytest.raises(InputError, match="expression"):
            refused()
