"""The potentials of a bond: their functions, coefficients and differential equations against their own expressions."""

import math
import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy
from numba import njit

from symfpu import Chain, lennard_jones, morse, polynomial, toda
from symfpu.chain import bond_loops, bonds
from symfpu.chain.potentials.typed import kinds, potential_of_text
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION
from tests.tolerances import FORTY_DIGITS, ROUNDING

POTENTIALS = [
    toda("1/2"),
    toda("-3"),
    lennard_jones(12, 6),
    lennard_jones("5/2", 1),
    morse("2/3"),
    morse(-1),
    polynomial("1/3", 0, "1/5"),
    polynomial(0, 0, 1),
]
STRETCHES = [-0.7, -0.1, -1e-3, -1e-9, 1e-12, 0.02, 0.4, 1.7]
FUNCTIONS = {
    bonds.potential: lambda V, r: V,
    bonds.tension: sympy.diff,
    bonds.stiffness: lambda V, r: sympy.diff(V, r, 2),
    bonds.anharmonic_tension: lambda V, r: sympy.diff(V, r) - r,
    bonds.anharmonic_stiffness: lambda V, r: sympy.diff(V, r, 2) - 1,
}


@pytest.fixture(params=POTENTIALS, ids=repr)
def potential(request):
    return request.param


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: f.__name__)
def test_functions_are_those_of_the_expression(potential, function):
    r = sympy.Symbol("r")
    exact = sympy.lambdify(r, FUNCTIONS[function](potential.expression(r), r), "mpmath")
    with mpmath.workdps(90):
        expected = [exact(mpmath.mpf(x)) for x in STRETCHES]
    law = potential.law(DOUBLES)
    size = [abs(float(e)) + x * x for e, x in zip(expected, STRETCHES, strict=True)]  # a zero of its own is no error
    found = [function(law, x) for x in STRETCHES]
    assert np.allclose((np.array(found) - np.array(expected, dtype=float)) / size, 0, atol=100 * ROUNDING)
    assert np.array_equal(function(law, np.array(STRETCHES)), found)
    with mpmath.workdps(55):
        many = [function(potential.law(MULTIPRECISION), mpmath.mpf(x)) for x in STRETCHES]
        assert all(abs(a - b) <= FORTY_DIGITS * s for a, b, s in zip(many, expected, size, strict=True))


@pytest.mark.long
@pytest.mark.parametrize("name", ["tension", "stiffness"])
def test_loops_compile_the_same_functions(potential, name):
    loop, law = getattr(bond_loops, name), potential.law(DOUBLES)
    compiled = njit(error_model="numpy")(lambda law, r: loop(law, r))
    assert np.allclose([compiled(law, r) for r in STRETCHES], [loop(law, r) for r in STRETCHES], rtol=ROUNDING, atol=0)


def test_coefficients_are_those_of_the_taylor_series(potential):
    r = sympy.Symbol("r")
    V = potential.expression(r)
    for n in range(3, 9):
        derivative = sympy.diff(V, r, n).subs(r, 0)
        assert sympy.Rational(derivative) == sympy.Rational(potential.coefficient(n)) * math.factorial(n - 1)
    assert (V.subs(r, 0), sympy.diff(V, r).subs(r, 0), sympy.diff(V, r, 2).subs(r, 0)) == (0, 0, 1)
    assert potential.even == (sympy.simplify(V - V.subs(r, -r)) == 0)


def test_growths_add_up_to_the_tension(potential):
    """Coefficient by coefficient: (n + 1) g_(n+1) + slope n g_n = rate g_n."""
    tension = [Fraction(0)] * 9
    for growth in potential.growths():
        g = Fraction(1)
        for n in range(1, 9):
            g *= (growth.rate - growth.slope * (n - 1)) / n
            tension[n] += growth.weight * g
    expected = [0, 1, *(potential.coefficient(n + 1) for n in range(2, 9))]
    assert tension == expected or not potential.growths()


def test_typed_and_printed(potential):
    assert potential_of_text(potential.text) == potential
    assert repr(potential) == potential.text.replace(":", "(").replace(",", ", ") + ")"
    assert pickle.loads(pickle.dumps(Chain(8, potential=potential))) == Chain(8, potential=potential)


def test_short_names():
    assert potential_of_text("lj:12,6") == lennard_jones(12, 6)
    assert potential_of_text(" poly: 0.33, 0, 1/5") == polynomial("0.33", 0, "1/5")
    assert Chain(8, potential="poly:0.33,0.1") == Chain(8, alpha="0.33", beta="0.1")
    assert {"toda", "morse", "lj", "lennard_jones", "poly", "polynomial"} <= kinds().keys()


@pytest.mark.parametrize("text", ["", "toda", "toda:", "toda:1,2", "toda:x", "toda:0", "fpu:1", "lj:6,12", "lj:12,12", "poly:", "poly:0,0"])
def test_what_is_no_potential_is_refused_in_one_line(text):
    with pytest.raises(InputError) as caught:
        Chain(8, potential=text)
    assert "\n" not in str(caught.value)


def test_couplings_and_a_potential_are_too_much():
    with pytest.raises(InputError, match="not both"):
        Chain(8, alpha=1, potential=toda(1))
    with pytest.raises(InputError, match="potential"):
        Chain(8, potential=1)


def test_couplings_of_a_chain_that_has_none_are_refused_by_its_name():
    with pytest.raises(InputError, match=r"toda\(1\)"):
        _ = Chain(8, potential=toda(1)).alpha


@pytest.mark.parametrize(
    ("text", "step", "mu", "relative"),
    [
        ("toda:1/2", 1, 0.125, {2: 1, 3: Fraction(2, 3), 4: Fraction(1, 3)}),
        ("poly:0,0,2", 1, 0.25, {4: 2}),
        ("poly:0,3", 2, 3 / 16, {3: 1}),
        ("poly:0,0,0,2", 2, 1 / 16, {5: 2}),
        ("poly:1,0,0,2", 1, 0.25, {2: 1, 5: 2}),
    ],
)
def test_small_parameter_of_other_potentials(text, step, mu, relative):
    chain = Chain(8, potential=text)
    highest = 5 if "toda" not in text else 4
    assert (chain.degree_step, chain.mu, chain.relative_couplings(highest)) == (step, mu, relative)
