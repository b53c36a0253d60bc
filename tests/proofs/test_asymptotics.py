"""Long chains: rational series in (pi/2N)^2 against SymPy's, against exact sums at finite N, and against orbits."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import symengine as se
import sympy

from symfpu.breathers.balance import breather_at_amplitude
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.localization.laws import breather_law, group_energy
from symfpu.proofs.asymptotics import Laurent, asymptotic_divisor, asymptotic_energy, asymptotic_group_energy, asymptotic_term
from symfpu.series.closed_forms import closed_form
from symfpu.series.lindstedt import lindstedt
from tests.tolerances import LIMIT_OF_LONG_CHAINS, SLOPE, SMALL_BREATHER, TYPED_LAW

ALPHA, BETA, BOTH = Chain("N", alpha=1), Chain("N", beta=1), Chain("N", alpha=1, beta="1/3")
N, pi = se.Symbol("N"), se.pi


def by_sympy(formula, terms):
    """The same powers of 1/N by SymPy's series, from the first one on."""
    n = sympy.Symbol("n", positive=True)
    expansion = sympy.series(sympy.sympify(formula).subs(sympy.Symbol("N"), 1 / n), n, 0, 12).removeO()
    by_power = sympy.collect(sympy.expand(expansion), n, evaluate=False)
    powers = sorted(by_power, key=lambda p: sympy.degree(p * n**20, n))
    first = sympy.degree(powers[0] * n**20, n)
    kept = [p for p in powers if sympy.degree(p * n**20, n) < first + 2 * terms]
    return se.expand(se.sympify(sum(p * by_power[p] for p in kept).subs(n, 1 / sympy.Symbol("N"))))


DIVISORS = [
    (2, (1,), (2,)),
    (3, (1, 2), (1, 1)),
    (5, (2, 3), (1, 1)),
    (1, (1, 2), (-1, 1)),
    (4, (1, 2), (0, 1)),
    (3, (1,), (1,)),
    (2, (1,), (-2,)),
]


@pytest.mark.long
@pytest.mark.parametrize(("m", "seeds", "nu"), DIVISORS, ids=str)
@pytest.mark.parametrize("terms", [1, 2])
def test_divisors_are_those_of_sympy(m, seeds, nu, terms):
    drive = sum(n * se.Symbol(f"Omega_{q}") for n, q in zip(nu, seeds, strict=True))
    own = se.Symbol(f"Omega_{m}")
    sign = 1 if sum(n * q for n, q in zip(nu, seeds, strict=True)) > 0 else -1
    for squared, formula in ((True, own**2 - drive**2), (False, own - sign * drive)):
        exact = closed_form(formula, ALPHA, seeds)
        assert se.expand(asymptotic_divisor(m, seeds, nu, terms=terms, squared=squared) - by_sympy(exact, terms)) == 0


@pytest.mark.parametrize(("n", "m"), [((1,), 2), ((1, 2), 3), ((2, 3), 5)])
def test_detuning_of_appendix_e_lacks_a_factor(n, m):
    """Approximation iii: pi^3 m^3 / 24 N^3, times 1 - sum n^3/m^3."""
    nu = (2,) if len(n) == 1 else (1, 1)
    printed = pi**3 * m**3 / (24 * N**3)
    factor = 1 - sum(Fraction(c * q**3, m**3) for c, q in zip(nu, n, strict=True))
    assert asymptotic_divisor(m, n, nu, terms=1, squared=False) == -printed * se.Rational(factor.numerator, factor.denominator)
    assert factor < 1


def test_frequencies_that_are_equal_leave_nothing():
    assert asymptotic_divisor(1, (1,), (1,)) == 0
    assert asymptotic_divisor(3, (1, 3), (0, -1), squared=False) == 0


TERMS = [
    (ALPHA, (1,), 2, 1),
    (ALPHA, (1,), 3, 2),
    (ALPHA, (1, 2), 3, 1),
    (BETA, (1,), 3, 1),
    (BOTH, (1,), 3, 2),
    (ALPHA, (1,), 2, 3),
    (BETA, (2,), 2, 2),
]


@pytest.mark.parametrize(("chain", "seeds", "q", "order"), TERMS, ids=str)
def test_error_of_a_term_falls_with_the_next_power(chain, seeds, q, order):
    """Two powers of 1/N^2 are kept: against the closed form in many digits, the error falls as N^-4."""
    series = lindstedt(chain, seeds, order=order)
    answer = asymptotic_term(series, q, order, terms=2)
    exact = closed_form(series.term(q, order), chain, seeds, frequencies="linear")
    numbers = {symbol: se.Rational(3 * (i + 1), 10) for i, symbol in enumerate(sorted(exact.free_symbols - {N}, key=str))}
    errors = []
    for length in (3000, 6000):
        found, expected = (f.subs(numbers | {N: se.Integer(length)}).n(200, real=True) for f in (answer, exact))
        errors.append(abs(float((found - expected) / expected)))
    assert answer != 0
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=SLOPE)


@pytest.mark.long
def test_a_term_by_sympy():
    series = lindstedt(ALPHA, (1,), order=1)
    exact = closed_form(series.term(2, 1), ALPHA, (1,), frequencies="linear")
    for terms in (1, 2):
        difference = asymptotic_term(series, 2, 1, terms=terms) - by_sympy(exact, terms)
        assert se.expand(difference) == 0


@pytest.mark.parametrize("q", range(1, 9))
def test_law_of_q_breathers_is_exact_in_long_chains(q):
    """Eq. brelaw: E_q = gamma^(q-1) q^2 E_1; the next term multiplies it with 1 - (5/24) (q-1)^2 (pi/N)^2. Ours."""
    E = se.Symbol("E1")
    gamma = E * N**3 / pi**4  # alpha^2 N^4 eps / pi^4
    leading = gamma ** (q - 1) * q**2 * E
    correction = 1 - se.Rational(5 * (q - 1) ** 2, 24) * pi**2 / N**2
    assert se.expand(asymptotic_energy(ALPHA, (1,), q, terms=1) - leading) == 0
    assert se.expand(asymptotic_energy(ALPHA, (1,), q, terms=2) - se.expand(leading * correction)) == 0


def test_typed_law_of_q_breathers_is_the_derived_one():
    chain = Chain(20, alpha="0.33")
    typed = breather_law(chain, 1e-3)
    for q in range(1, 7):
        derived = asymptotic_energy(Chain("N", alpha="0.33"), (1,), q, terms=1)
        assert float(derived.subs({"N": 20, "E1": 1e-3})) == pytest.approx(typed[q - 1], rel=TYPED_LAW)


@pytest.mark.parametrize("k", range(5))
def test_law_of_q_breathers_of_beta(k):
    """E_(2k+1) = (9/64)^k (beta^2 eps^2 N^4 / pi^4)^k E_1: Eq. eksp for one seed, with 3 beta/8 for beta."""
    E = se.Symbol("E1")
    leading = (se.Rational(9, 64) * E**2 * N**2 / pi**4) ** k * E
    assert se.expand(asymptotic_energy(BETA, (1,), 2 * k + 1, terms=1) - leading) == 0


def test_energies_are_those_of_breathers():
    """A breather found by harmonic balance; what is left is the next power of the amplitude and of 1/N^2."""
    orbit = breather_at_amplitude(Chain(32, alpha="0.33"), 1, 0.01)
    spectrum = orbit.average_spectrum()
    for q in (2, 3, 4):
        formula = asymptotic_energy(Chain("N", alpha="0.33"), (1,), q)
        assert float(formula.subs({"N": 32, "E1": float(spectrum[0])})) == pytest.approx(spectrum[q - 1], rel=SMALL_BREATHER)


def exact_energy(length, s, q):
    """First order of alpha in numbers: pairs of seeds, E_n = 1, mu = 1/sqrt(2N)."""
    Omega = dict(enumerate(Chain(length, alpha=1).frequencies(), start=1))
    total = 0.0
    for l in range(1, s + 1):
        for m in range(l, s + 1):
            for sign in (1, -1):
                if abs(l + sign * m) == q or l + m == q or abs(l - m) == q:
                    drive = Omega[l] + sign * Omega[m]
                    # 2 w_l w_m cos, w^2 = E/2; once for l = m
                    product = (1 if l == m else 2) * 0.5 * Omega[q] ** 2 / (Omega[q] ** 2 - drive**2)
                    total += (1 + drive**2 / Omega[q] ** 2) * product**2
    return total / (2 * length)


@pytest.mark.parametrize("s", [2, 3, 4])
def test_group_energies_are_sums_over_pairs(s):
    """k = 1 of alpha by hand, at two lengths: the error falls as N^-4."""
    errors = []
    for length in (40, 80):
        q = s + s // 2
        formula = asymptotic_energy(ALPHA, tuple(range(1, s + 1)), q)
        numbers = {f"E{n}": 1 for n in range(1, s + 1)} | {"N": length}
        errors.append(abs(float(formula.subs(numbers)) / exact_energy(length, s, q) - 1))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=2 * SLOPE)


def factor(chain, s, k):
    """C_k(s) of E^(k) = C_k(s) (eps/M) lambda^k, as of lambda^(2k) for beta."""
    eps = se.Symbol("epsilon")
    unit = eps * N**4 / (pi * s) ** 4 if chain.alpha else eps**2 * N**4 / (pi * s) ** 4
    return se.expand(asymptotic_group_energy(chain, s, k, terms=1) / (eps * N / s * unit**k))


@pytest.mark.parametrize("chain", [ALPHA, BETA], ids=str)
@pytest.mark.parametrize("s", [1, 2, 3, 4])
def test_group_energies_scale_as_eksa_and_eksp(chain, s):
    """The powers of N, eps, s and the coupling are those of the paper; the factor is a rational number."""
    for k in (0, 1, 2):
        C = factor(chain, s, k)
        assert C.is_Number
        assert C > 0
        assert k or C == 1
        length, epsilon = 200, 1e-9
        formula = asymptotic_group_energy(chain, s, k, terms=1)
        typed = group_energy(chain.at(N=length), s, epsilon, k)
        typed_factor = (k + 0.5) ** 2 if chain.alpha else 1
        value = float(formula.subs({"N": length, "epsilon": epsilon}))
        assert value == pytest.approx(float(C) * float(typed) / typed_factor, rel=LIMIT_OF_LONG_CHAINS)


def test_factor_of_eksa_is_too_small():
    """(k + 1/2)^2 is 2.25 and 6.25; four seeds of equal energy at random phases have 19.2 and 54.3."""
    assert [round(float(factor(ALPHA, 4, k)), 1) for k in (1, 2)] == [19.2, 54.3]
    assert factor(ALPHA, 1, 3) == 16
    assert factor(BETA, 1, 2) == se.Rational(81, 4096)


PAGE = Path(__file__).parents[2] / "docs" / "asymptotics.md"
ROWS = [line.split("|")[1:-1] for line in PAGE.read_text().splitlines() if line.startswith("| ") and line[2].isdigit()]


@pytest.mark.long
@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"s={row[0].strip()}")
def test_factors_of_the_page(row):
    s, *printed = (cell.strip() for cell in row)
    cases = [(ALPHA, 1), (ALPHA, 2), (ALPHA, 3), (BETA, 1), (BETA, 2)]
    assert any(printed)
    for text, (chain, k) in zip(printed, cases, strict=True):
        if text:
            digits = len(text.replace(".", "").lstrip("0"))
            assert f"{float(factor(chain, int(s), k)):.{digits}g}" == f"{float(text):.{digits}g}"


REFUSED = {
    "a number for N": lambda: asymptotic_energy(Chain(8, alpha=1), (1,), 2),
    "a series with N": lambda: asymptotic_term(lindstedt(Chain(8, alpha=1), (1,), order=1), 2, 1),
    "high seeds": lambda: asymptotic_energy(ALPHA, ("N-1",), 2),
    "high seeds of a series": lambda: asymptotic_term(lindstedt(ALPHA, ("N-1",), order=1), 2, 1),
    "a mode at rest": lambda: asymptotic_energy(BETA, (1,), 2),
    "no terms": lambda: asymptotic_divisor(2, (1,), (2,), terms=0),
    "a long harmonic": lambda: asymptotic_divisor(2, (1,), (1, 1)),
    "no seeds": lambda: asymptotic_group_energy(ALPHA, 0, 1),
    "a negative order": lambda: asymptotic_group_energy(ALPHA, 1, -1),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_has_no_expansion_is_refused(name):
    with pytest.raises(InputError):
        REFUSED[name]()


def test_laurent_series_know_how_far_they_are_known():
    x = Laurent(0, [Fraction(0), Fraction(2), Fraction(1)])
    assert (x * x.inverse()).coefficients == [0, 1]
    assert (x.inverse() + x).end == 1
    assert (x + 1).coefficients == [1, 2, 1]
    with pytest.raises(ZeroDivisionError):
        Laurent.number(0, 3).inverse()
