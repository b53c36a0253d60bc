"""The frequency as a function of the amplitudes: against solutions found without series, by the rate of the error."""

import math
import re
from itertools import combinations

import mpmath
import numpy as np
import pytest
import symengine as se

import symfpu
from symfpu import Chain, InputError, frequency_expansion, frequency_shift_formula, lindstedt
from symfpu.algebra.truncated import Truncated, in_one_variable
from symfpu.chain.length import mode_label
from symfpu.chain.symbols import linear_symbol
from symfpu.numbers.arithmetic import MULTIPRECISION
from tests.tolerances import CLOSED_OF_FORTY, SLOPE, SMALL_SHIFT_ERROR


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
    errors = [abs(value(chain, {q: a}, q, order) - float(symfpu.torus(chain, (q,), amplitudes={q: a}).frequencies[0])) for a in (A, A / 2)]
    # the next even degree
    degree = chain.degree_step * order
    assert math.log2(errors[0] / errors[1]) > 2 * (degree // 2) + 2 - 4 * SLOPE
    assert errors[0] < SMALL_SHIFT_ERROR


TORI = [(Chain(16, alpha="0.1"), (1, 2), 4), (Chain(16, beta="0.1"), (3, 4), 2)]
MORE = [
    (Chain(16, alpha="0.1"), (2, 7), 4),
    (Chain(16, alpha="0.1"), (1, 15), 4),
    (Chain(16, beta="0.1"), (3, 13), 2),
    (Chain(16, potential="toda:1/10"), (1, 2), 4),
    (Chain(16, potential="toda:1/10"), (2, 7), 4),
]


@pytest.mark.parametrize(("chain", "seeds", "order"), [*TORI, *(pytest.param(*case, marks=pytest.mark.long) for case in MORE)], ids=str)
def test_error_of_two_seeds_falls_with_the_sixth_power(chain, seeds, order):
    """Generic seeds, seeds in special position, and seeds with the sum N."""
    errors = []
    for a in (0.4, 0.2):
        amplitudes = dict(zip(seeds, (a, 0.7 * a), strict=True))
        torus = symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=10 // chain.degree_step)
        errors.append([abs(value(chain, amplitudes, q, order) - float(w)) for q, w in zip(seeds, torus.frequencies, strict=True)])
    rates = np.log2(np.array(errors[0]) / np.array(errors[1]))
    assert (np.abs(rates - 6) < 4 * SLOPE).all(), rates


class AtLinearFrequencies:
    """The expansion in numbers, at given squares of the amplitudes: in mu alone, where formulas come from series in the amplitudes."""

    def __init__(self, chain, seeds, order, squares):
        self.series = lindstedt(chain, seeds, order=order, ring="nested")
        self.chain, self.order, self.squares = chain, order, squares
        self.linear = [chain.linear_frequency(q) for q in seeds]

    def values(self, place):
        """omega^(k) of a seed by order k."""
        ratios = [in_one_variable([mpmath.mpf(1)]) for _ in self.linear]
        for known in range(1, self.order + 1):
            ratios = [in_one_variable(row).root() for row in self._squared(ratios, known)]
        return [c * self.linear[place] for c in ratios[place].coefficients()]

    def _squared(self, ratios, order):
        """(omega_i / Omega_i)^2 in powers of mu to an order, from frequencies to the order before."""
        sums = [[mpmath.mpf(1), *[mpmath.mpf(0)] * order] for _ in self.linear]
        for k in range(1, order + 1):
            # W^(k) enters with mu^k, and needs its divisors to mu^(order - k)
            omega = [ratio.cut(order - k) * linear for ratio, linear in zip(ratios, self.linear, strict=True)]
            table = self.series.corrections[k]
            if not len(table):
                continue
            values = table.values(lambda symbol, omega=omega: self._multiplier(symbol, omega), lambda number: rational(number))
            diagonal = self.series.grading.diagonal(self.chain.degree_step * k)
            for row, line in zip(diagonal.tolist(), values, strict=True):
                monomial = mpmath.fprod((w**2 * a / 4) ** e for w, a, e in zip(self.linear, self.squares, row, strict=True))
                for i, value in enumerate(line):
                    coefficients = value.coefficients() if isinstance(value, Truncated) else [value]
                    for n, c in enumerate(coefficients):
                        sums[i][k + n] += c * monomial
        return sums

    def _multiplier(self, symbol, omega):
        seeds, own = self.series.seeds, self.chain.linear_frequency(symbol.mode) ** 2
        drive = sum((w * n for w, n in zip(omega, symbol.harmonic, strict=True)), start=omega[0] * 0)
        base = omega[0] * 0 + own
        if symbol.mode in seeds:
            chosen = omega[seeds.index(symbol.mode)]
            base = chosen * chosen
        return (base - drive * drive).inverse() * own


def rational(number):
    return mpmath.mpf(number.numerator) / number.denominator


def in_digits(formula, numbers):
    """A formula at mpf, all its integers made mpf first."""
    text = re.sub(r"(?<![A-Za-z_0-9])(\d+)", r"mpf(\1)", str(formula))
    return eval(text, {"mpf": mpmath.mpf, "sqrt": mpmath.sqrt, **numbers})


def agrees(chain, seeds, order):
    """Formulas of both seeds are the expansion in numbers; and they have one frequency besides the factor."""
    squares = [mpmath.mpf("0.16"), mpmath.mpf("0.09")]
    expected = AtLinearFrequencies(chain, seeds, order, squares)
    numbers = {f"A{q}": mpmath.sqrt(a) for q, a in zip(seeds, squares, strict=True)}
    numbers |= {f"Omega_{q}": chain.linear_frequency(q) for q in chain.mode_numbers}
    for place, q in enumerate(seeds):
        formula = frequency_expansion(chain, seeds, q, order)
        exact = expected.values(place)[order]
        if abs(in_digits(formula, numbers) - exact) > CLOSED_OF_FORTY * abs(exact):
            return False
    return True


SPECIAL = [
    (Chain(12, alpha=1), (3, 6), 4),  # q and 2 q
    (Chain(9, beta=1), (3, 6), 2),  # with the sum N
    (Chain(11, beta=1), (4, 10), 2),  # 3 * 4 + 10 = 2 N
    (Chain(10, beta=1), (1, 4), 2),  # 2 (1 + 4) = N, a multiple only
    pytest.param(Chain(8, alpha=1, beta="1/3"), (4, 7), 4, marks=pytest.mark.long),
    pytest.param(Chain(15, potential="toda:1/2"), (1, 3), 4, marks=pytest.mark.long),
    pytest.param(Chain(14, beta=1), (5, 9), 4, marks=pytest.mark.long),
    pytest.param(Chain(13, alpha=1), (1, 2), 6, marks=pytest.mark.long),
    pytest.param(Chain(53, alpha=1), (5, 17), 4, marks=pytest.mark.long),  # generic
    pytest.param(Chain(53, beta=1), (5, 17), 3, marks=pytest.mark.long),
]


@pytest.mark.parametrize(("chain", "seeds", "order"), SPECIAL, ids=str)
def test_formulas_are_the_expansion_in_numbers(chain, seeds, order):
    with mpmath.workdps(60):
        assert agrees(chain, seeds, order)


@pytest.mark.long
@pytest.mark.parametrize("N", range(3, 11))
def test_all_pairs_of_short_chains_are_the_expansion_in_numbers(N):
    """Every fold and every coincidence of modes that such chains have."""
    with mpmath.workdps(60):
        assert all(agrees(Chain(N, alpha=1), seeds, 2) for seeds in combinations(range(1, N), 2))


@pytest.mark.parametrize("seeds", [(1, 2), (1, 3), (1, "N-1"), ("N-2", "N-1")], ids=str)
def test_special_seeds_have_one_frequency_in_front_and_one_inside(seeds):
    """Their formulas were long sums in the frequencies of all modes."""
    formula = frequency_expansion(Chain("N", beta=1), seeds, seeds[1], 2)
    frequencies = {s for s in formula.free_symbols if s.name.startswith("Omega")}
    assert frequencies <= {se.Symbol("Omega_1"), linear_symbol(mode_label(seeds[1], "q"))}


def test_all_lengths_and_one_have_the_same_formula_of_special_seeds():
    every = frequency_expansion(Chain("N", beta=1), (1, "N-1"), "N-1", 2)
    one = frequency_expansion(Chain(40, beta=1), (1, 39), 39, 2)
    names = {"A_{N-1}": "A39", "Omega_{N-1}": "Omega_39"}
    assert every.subs({se.Symbol(old): se.Symbol(new) for old, new in names.items()}) == one


@pytest.mark.long
@pytest.mark.parametrize(("chain", "order", "rate"), [(Chain(53, alpha="0.1"), 6, 8), (Chain(37, beta="0.1"), 4, 10)], ids=str)
def test_error_of_high_orders_falls_with_the_next_power(chain, order, rate):
    """Against tori whose divisors hold the frequencies themselves, in 40 digits."""
    seeds, errors = (5, 17), []
    with mpmath.workdps(50):
        mu = chain.small_parameter(MULTIPRECISION)
        for a in (mpmath.mpf("0.4"), mpmath.mpf("0.2")):
            expansion = AtLinearFrequencies(chain, seeds, order, [a**2, (a / 2) ** 2])
            longer = order + 6 // chain.degree_step
            torus = symfpu.torus(chain, (5, 17), amplitudes={5: str(a), 17: str(a / 2)}, method="series", order=longer, digits=40)
            row = []
            for place, w in enumerate(torus.frequencies):
                found = sum(mu**k * c for k, c in enumerate(expansion.values(place)))
                row.append(float(abs(found - mpmath.mpf(w.numerator) / w.denominator)))
            errors.append(row)
    rates = np.log2(np.array(errors[0]) / np.array(errors[1]))
    assert (np.abs(rates - rate) < 4 * SLOPE).all(), rates


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


@pytest.mark.parametrize(("seeds", "q"), [((1, 2, 3), 1), ((1, 2), 3), ((1,), "N-1"), ((9,), 9)], ids=str)
def test_what_has_no_formula_is_refused(seeds, q):
    with pytest.raises(InputError):
        frequency_expansion(Chain(9, alpha=1), seeds, q, 2)
