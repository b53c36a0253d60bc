"""Long chains: rational series in (pi/2N)^2 against SymPy's, against exact sums at finite N, and against orbits."""

from fractions import Fraction

import numpy as np
import pytest
import symengine as se
import sympy

import symfpu
from symfpu import (
    Chain,
    InputError,
    asymptotic_divisor,
    asymptotic_energy,
    asymptotic_term,
    breather_law,
    closed_form,
    lindstedt,
)
from symfpu.chain.length import mode_label, mode_of, seed_labels
from symfpu.chain.symbols import energy_symbol
from tests.tolerances import SLOPE, SMALL_BREATHER, TYPED_LAW

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


HIGH_DIVISORS = [("N-3", ("N-1",), (1,)), (2, ("N-1",), (2,)), ("N-1", (1, "N-2"), (1, 1)), ("N-5", ("N-2", "N-1"), (2, -1))]


@pytest.mark.parametrize(("m", "seeds", "nu"), HIGH_DIVISORS, ids=str)
def test_divisors_of_high_modes_are_their_limits(m, seeds, nu):
    """Against the frequencies themselves at two lengths, in 300 bits: what is left falls with the next power."""
    for squared in (True, False):
        formula, errors = asymptotic_divisor(m, seeds, nu, terms=3, squared=squared), []
        for length in (500, 1000):
            Omega = [se.Integer(2) * se.sin(mode_of(q, length) * pi / (2 * length)) for q in seed_labels((m, *seeds))]
            own, drive = Omega[0], sum(n * w for n, w in zip(nu, Omega[1:], strict=True))
            exact = own**2 - drive**2 if squared else own - abs(drive.n(300, real=True))
            errors.append(abs(float((formula.subs({N: length}) / exact - 1).n(300, real=True))))
        assert np.log2(errors[0] / errors[1]) > 3 - SLOPE


def test_far_modes_are_found():
    """1 = 3 * 5 - 2 * 7: the rule reaches it at order 4."""
    assert asymptotic_energy(ALPHA, (5, 7), 1, terms=1).free_symbols == {N, se.Symbol("E5"), se.Symbol("E7")}


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
    (BETA, ("N-1",), "N-3", 1),
    pytest.param(ALPHA, ("N-2", "N-1"), 3, 1, marks=pytest.mark.long),
    pytest.param(BETA, (1, "N-1"), "N-3", 1, marks=pytest.mark.long),
    pytest.param(ALPHA, (1, 3), 4, 1, marks=pytest.mark.long),
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
    both_ends = len({isinstance(p, str) for p in seeds}) > 1
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2 if both_ends else 4, abs=SLOPE)


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


BREATHERS = [
    ("alpha", "0.33", 1, (2, 3, 4), 2),
    pytest.param("beta", "0.3", "N-1", ("N-3", "N-5"), 4, marks=pytest.mark.long),
]


@pytest.mark.parametrize(("model", "strength", "seed", "modes", "terms"), BREATHERS)
def test_energies_are_those_of_breathers(model, strength, seed, modes, terms):
    """Found by harmonic balance; what is left is the next power of the amplitude and of 1/N^2."""
    law, place = {model: strength}, mode_of(mode_label(seed, "q"), 32)
    spectrum = symfpu.torus(Chain(32, **law), (place,), amplitudes={place: 0.01}).average_spectrum()
    numbers = {"N": 32, energy_symbol(mode_label(seed, "q")): float(spectrum[place - 1])}
    for q in modes:
        formula = asymptotic_energy(Chain("N", **law), (seed,), q, terms=terms)
        found = spectrum[mode_of(mode_label(q, "q"), 32) - 1]
        assert float(formula.subs(numbers)) == pytest.approx(found, rel=SMALL_BREATHER)


def energy_in_numbers(series, q, order, length):
    """E_q at N without mu^2k from the closed formula: a mean over a grid of phases, E_i = 1 for the seeds."""
    chain, label = series.chain.at(N=length), mode_label(q, "q")
    Omega = chain.frequencies()[[mode_of(p, length) - 1 for p in series.seeds]]
    formula = closed_form(series.term(q, order), series.chain, [str(p) if p < 0 else p for p in series.seeds], frequencies="linear")
    A, theta = series._amplitude_symbols()
    numbers = {N: length} | dict(zip(A, np.sqrt(2) / Omega, strict=True))
    points = 2 * np.pi * np.arange(16) / 16
    own, energies = chain.frequencies()[mode_of(label, length) - 1], []
    speed = sum(w * se.diff(formula, t) for w, t in zip(Omega, theta, strict=True))
    for phases in np.stack(np.meshgrid(*[points] * len(theta)), axis=-1).reshape(-1, len(theta)):
        at = numbers | dict(zip(theta, phases, strict=True))
        Q, P = (float(f.subs(at).n(real=True)) for f in (formula, speed))
        energies.append((P**2 + own**2 * Q**2) / 2)
    return np.mean(energies)


ENERGIES = [
    (ALPHA, (1, 3), 2, 1, 4),
    pytest.param(BETA, (1, "N-1"), "N-3", 1, 2, marks=pytest.mark.long),
    pytest.param(ALPHA, ("N-2", "N-1"), 3, 1, 4, marks=pytest.mark.long),
    pytest.param(Chain("N", potential="toda:1/2"), (1,), 3, 2, 4, marks=pytest.mark.long),
]


@pytest.mark.parametrize(("chain", "seeds", "q", "order", "rate"), ENERGIES, ids=str)
def test_energies_are_means_over_phases(chain, seeds, q, order, rate):
    """Two powers are kept: the error falls with the next one, as N^-4 for seeds at one end."""
    series, errors = lindstedt(chain, seeds, order=order), []
    for length in (40, 80):
        exact = energy_in_numbers(series, q, order, length) * chain.at(N=length).mu ** (2 * order)
        numbers = {energy_symbol(p): 1 for p in seed_labels(seeds)} | {N: length}
        found = float(asymptotic_energy(chain, seeds, q).subs(numbers))
        errors.append(abs(found / exact - 1))
    assert np.log2(errors[0] / errors[1]) > rate - 2 * SLOPE


REFUSED = {
    "a number for N": lambda: asymptotic_energy(Chain(8, alpha=1), (1,), 2),
    "a series with N": lambda: asymptotic_term(lindstedt(Chain(8, alpha=1), (1,), order=1), 2, 1),
    "no mode": lambda: asymptotic_energy(ALPHA, (1,), "M"),
    "a seed twice": lambda: asymptotic_energy(ALPHA, (1, 1), 2),
    "a mode at rest": lambda: asymptotic_energy(BETA, (1,), 2),
    "no terms": lambda: asymptotic_divisor(2, (1,), (2,), terms=0),
    "a long harmonic": lambda: asymptotic_divisor(2, (1,), (1, 1)),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_has_no_expansion_is_refused(name):
    with pytest.raises(InputError):
        REFUSED[name]()
