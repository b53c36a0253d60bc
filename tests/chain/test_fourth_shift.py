"""The next order of the frequency of one mode: derived again, against breathers, and against Toda's exact torus."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
import symengine as se
import sympy

from symfpu import Chain, breather_at_amplitude, frequency_expansion, frequency_shift, frequency_shift_formula, toda_torus
from symfpu.chain.fourth_shift import fourth_factor
from symfpu.chain.potentials.typed import potential_of_text
from symfpu.errors import InputError
from symfpu.numbers.typed import rational
from tests.tolerances import FORTY_DIGITS, HUNDRED_ROUNDINGS, SLOPE

# whole numbers for c_3 .. c_6 from which all five functions follow, and two potentials beside them
TEXTS = ["poly:1", "poly:0,1", "poly:1,1", "poly:1,0,1", "poly:1,0,0,1", "poly:2,-3,5,7", "lj:12,6"]
A, OMEGA = se.Symbol("A1"), se.Symbol("Omega_1")


def expansion(chain, q):
    """The terms in A^4 in the unit (A^2/2N)^2, by the universal recursion."""
    found = frequency_expansion(chain, (q,), q, 4 // chain.degree_step)
    names = {se.Symbol(f"A{q}"): 1, se.Symbol(f"Omega_{q}"): OMEGA}
    unit = chain.potential.coefficient(2 + chain.degree_step) or Fraction(1)
    return rational(unit ** (4 // chain.degree_step)) * found.subs(names)


@pytest.mark.parametrize("text", TEXTS)
def test_every_n_at_once(text):
    V = potential_of_text(text)
    W = OMEGA**2
    ours = OMEGA * fourth_factor(V, None, W, rational)
    difference = sympy.sympify(str(ours - expansion(Chain("N", potential=V), 1)))
    assert sympy.cancel(difference) == 0


@pytest.mark.long
@pytest.mark.parametrize("text", ["poly:1", "poly:0,1", "poly:2,-3,5,7"])
@pytest.mark.parametrize("N", [2, 3, 4, 5, 6, 8, *(pytest.param(N, marks=pytest.mark.long) for N in (7, 9, 10, 12))])
def test_every_mode_of_a_chain(text, N):
    """Special or not, N/4 and N/5 are not: numbers to forty digits."""
    chain = Chain(N, potential=text)
    for q in range(1, N):
        with mpmath.workdps(60):
            omega = chain.linear_frequency(q)
            ours = omega * fourth_factor(chain.potential, Fraction(q, N), omega**2, lambda x: mpmath.mpf(x.numerator) / x.denominator)
            theirs = sympy.lambdify(sympy.Symbol("Omega_1"), sympy.sympify(str(expansion(chain, q))), "mpmath")(omega)
            assert abs(ours - theirs) <= FORTY_DIGITS * (1 + abs(theirs))


@pytest.mark.parametrize(("N", "q"), [(2, 1), (8, 4), (3, 1), (9, 3), (3, 2), (12, 8)])
def test_special_modes_in_higher_couplings(N, q):
    """c_5 and c_6 where harmonics are missing: 1/2, 1/3 and 2/3 of N, exactly."""
    for text in TEXTS[3:]:
        chain = Chain(N, potential=text)
        omega = 2 * sympy.sin(sympy.pi * q / (2 * N))
        ours = omega * fourth_factor(chain.potential, Fraction(q, N), omega**2, lambda x: sympy.Rational(x.numerator, x.denominator))
        theirs = sympy.sympify(str(expansion(chain, q))).subs(sympy.Symbol("Omega_1"), omega)
        assert sympy.simplify(ours - theirs) == 0


@pytest.mark.parametrize(
    ("text", "largest"), [("toda:1/2", 0.1), ("morse:1/2", 0.1), ("lj:4,2", 0.02), ("expr:cosh(r)-1", 0.2), ("poly:1/4,1/5", 0.1)]
)
@pytest.mark.parametrize(("N", "q"), [(8, 1), (6, 3), (6, 4)])
def test_breathers_have_this_frequency_up_to_the_sixth_power(text, largest, N, q):
    chain = Chain(N, potential=text)
    amplitudes = largest * np.array([1, 0.5])
    errors = []
    for A in amplitudes:
        shift = frequency_shift(chain, {q: A}, degree=4)[q]
        errors.append(breather_at_amplitude(chain, q, A).frequency - chain.frequencies()[q - 1] - shift)
    errors = np.abs(errors).astype(float)
    slope = np.log(errors[0] / errors[1]) / np.log(2)
    assert slope == pytest.approx(6, abs=SLOPE)


def test_exact_energies_of_todas_chain():
    """At the frequency of the formula the exact torus has the energy of the breather, up to the sixth power."""
    chain, q = Chain(8, potential="toda:1/2"), 1
    errors = []
    for A in (0.4, 0.2):
        omega = chain.frequencies()[q - 1] + frequency_shift(chain, {q: A}, degree=4)[q]
        exact = toda_torus(chain, (q,), frequencies=(omega,), digits=14).energy
        errors.append(abs(float(exact) - float(breather_at_amplitude(chain, q, A).energy())))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(6, abs=SLOPE)


def test_todas_cancellations():
    W = se.Symbol("W")
    found = fourth_factor(potential_of_text("toda:1"), None, W, rational)
    kept = 1 / W - se.Rational(3, 4) + 3 / (4 - W)
    assert sympy.cancel(sympy.sympify(str(found - kept))) == 0


@pytest.mark.parametrize("chain", [Chain(9, potential="lj:12,6"), Chain(9, alpha="1/4", beta="1/7")], ids=str)
@pytest.mark.parametrize("q", [1, 3, 4, 6, 8])
def test_formulas_give_the_numbers(chain, q):
    values = {se.Symbol(f"A{q}"): 0.3, se.Symbol(f"Omega_{q}"): float(chain.frequencies()[q - 1])}
    formula = frequency_shift_formula(chain, (q,), degree=4)[q]
    assert float(formula.subs(values)) == pytest.approx(frequency_shift(chain, {q: 0.3}, degree=4)[q], rel=HUNDRED_ROUNDINGS)
    assert frequency_shift(chain, {q: 0.3}, degree=4) != frequency_shift(chain, {q: 0.3})


def test_what_is_not_known_is_refused():
    chain = Chain(8, alpha=1)
    with pytest.raises(InputError, match="one seed where degree is 4"):
        frequency_shift(chain, {1: 0.1, 2: 0.1}, degree=4)
    with pytest.raises(InputError, match="2 or 4"):
        frequency_shift_formula(chain, (1,), degree=6)
