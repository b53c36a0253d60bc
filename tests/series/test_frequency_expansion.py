"""The frequency as a function of the amplitudes: against solutions found without series, by the rate of the error."""

import math

import numpy as np
import pytest
import symengine as se

from symfpu.breathers.balance import breather_at_amplitude
from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift_formula
from symfpu.errors import InputError
from symfpu.series.frequency_expansion import frequency_expansion
from symfpu.tori.frequencies import torus_at_amplitudes
from tests.tolerances import SLOPE, SMALL_SHIFT_ERROR


def value(chain, amplitudes, q, order):
    """The expansion through an order, as a number."""
    numbers = {se.Symbol(f"A{s}"): a for s, a in amplitudes.items()}
    for m, w in enumerate(chain.frequencies(), start=1):
        numbers[se.Symbol(f"Omega_{m}")] = w
    terms = [frequency_expansion(chain, tuple(amplitudes), q, k).subs(numbers) for k in range(order + 1)]
    return sum(chain.mu**k * float(term) for k, term in enumerate(terms))


BREATHERS = [
    (Chain(8, alpha="0.5"), 1, 4, 0.2),
    (Chain(6, alpha="0.5"), 4, 4, 0.2),  # 3 q = 2 N
    (Chain(9, alpha="0.5"), 3, 2, 0.2),  # 3 q = N
    (Chain(7, beta="0.5"), 3, 3, 0.2),
    (Chain(6, beta="0.5"), 4, 2, 0.2),
    (Chain(8, alpha="0.5", beta="0.3"), 2, 4, 0.2),
    (Chain(8, potential="toda:1/2"), 1, 4, 0.2),
    (Chain(6, potential="lj:12,6"), 4, 4, 0.01),  # 3 q = 2 N
    (Chain(7, potential="poly:1/3,0,1/5"), 3, 4, 0.2),
    (Chain(9, potential="expr:cosh(r)-1"), 3, 2, 0.8),  # 3 q = N
]


@pytest.mark.parametrize(("chain", "q", "order", "A"), BREATHERS, ids=str)
def test_error_of_one_seed_falls_with_the_next_power_of_the_amplitude(chain, q, order, A):
    errors = [abs(value(chain, {q: a}, q, order) - float(breather_at_amplitude(chain, q, a).frequencies[0])) for a in (A, A / 2)]
    # the next even degree
    degree = chain.degree_step * order
    assert math.log2(errors[0] / errors[1]) > 2 * (degree // 2) + 2 - 4 * SLOPE
    assert errors[0] < SMALL_SHIFT_ERROR


TORI = [
    (Chain(16, alpha="0.1"), (2, 7), 4),
    (Chain(16, alpha="0.1"), (1, 2), 4),
    (Chain(16, alpha="0.1"), (1, 15), 4),
    (Chain(16, beta="0.1"), (3, 4), 2),
    (Chain(16, beta="0.1"), (3, 13), 2),
    (Chain(16, potential="toda:1/10"), (1, 2), 4),
    (Chain(16, potential="toda:1/10"), (2, 7), 4),
]


@pytest.mark.parametrize(("chain", "seeds", "order"), TORI, ids=str)
def test_error_of_two_seeds_falls_with_the_sixth_power(chain, seeds, order):
    """Generic seeds, seeds in special position, and seeds with the sum N."""
    errors = []
    for a in (0.4, 0.2):
        amplitudes = dict(zip(seeds, (a, 0.7 * a), strict=True))
        torus = torus_at_amplitudes(chain, amplitudes, order=10 // chain.degree_step)
        errors.append([abs(value(chain, amplitudes, q, order) - float(w)) for q, w in zip(seeds, torus.frequencies, strict=True)])
    rates = np.log2(np.array(errors[0]) / np.array(errors[1]))
    assert (np.abs(rates - 6) < 4 * SLOPE).all(), rates


@pytest.mark.parametrize(("couplings", "order"), [({"alpha": 1}, 2), ({"beta": 1}, 1)], ids=str)
@pytest.mark.parametrize("seeds", [(1, 2), (2, 5), (3,), (1, "N-2")], ids=str)
def test_lowest_order_is_the_known_closed_form(couplings, order, seeds):
    """Two routes: the recursion's nodes, and the sums of Appendix A done by hand."""
    chain, N = Chain("N", **couplings), se.Symbol("N")
    shifts = frequency_shift_formula(chain, seeds)
    mu = couplings.get("alpha", 0) / se.sqrt(2 * N) if "alpha" in couplings else 1 / (2 * N)
    for q, shift in shifts.items():
        assert se.expand(mu**order * frequency_expansion(chain, seeds, str(q) if q < 0 else q, order) - shift) == 0


def test_generic_seeds_of_a_chain_have_the_formula_of_all_chains():
    one = frequency_expansion(Chain(40, alpha=1), (7,), 7, 4)
    every = frequency_expansion(Chain("N", alpha=1), (1,), 1, 4)
    assert str(every).replace("Omega_1", "Omega_7").replace("A1", "A7") == str(one)


def test_odd_orders_of_alpha_vanish():
    assert frequency_expansion(Chain("N", alpha=1), (1,), 1, 3) == 0
    assert frequency_expansion(Chain("N", alpha=1), (1, 2), 1, 0) == se.Symbol("Omega_1")


def test_toda_couplings_leave_no_shift_by_others_at_lowest_order():
    formula = frequency_expansion(Chain("N", alpha=1, beta="2/3"), (3, 10), 3, 2)
    assert se.expand(formula - se.sympify("A3**2*Omega_3")) == 0


@pytest.mark.parametrize(("seeds", "q"), [((1, 2, 3), 1), ((1, 2), 3), ((1,), "N-1"), ((9,), 9)], ids=str)
def test_what_has_no_formula_is_refused(seeds, q):
    with pytest.raises(InputError):
        frequency_expansion(Chain(9, alpha=1), seeds, q, 2)
