"""The potentials of a bond: their functions, coefficients and differential equations against their own expressions."""

import math
import pickle
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import numpy as np
import pytest
import sympy

from symfpu import Chain, InputError, integrate, lennard_jones, lindstedt, morse, polynomial, toda
from symfpu.chain import bonds
from symfpu.chain.potentials.potential import Growth, Potential
from symfpu.chain.potentials.typed import kinds, potential_of_text
from tests.tolerances import ROUNDING, THOUSAND_ROUNDINGS

POTENTIALS = [
    toda("1/2"),
    toda("-3"),
    lennard_jones(12, 6),
    lennard_jones("5/2", 1),
    morse("2/3"),
    morse(-1),
    polynomial("1/3", 0, "1/5"),
    polynomial(0, 0, 1),
    polynomial("1/4"),
    polynomial(0, "-1/2"),
    polynomial("3/10", "1/5"),
    polynomial("1/10", "-1/5", "3/10", "2/5", "-1/2"),
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


def test_coefficients_are_those_of_the_taylor_series(potential):
    r = sympy.Symbol("r")
    V = potential.expression(r)
    for n in range(3, 9):
        derivative = sympy.diff(V, r, n).subs(r, 0)
        assert sympy.Rational(derivative) == sympy.Rational(potential.coefficient(n)) * math.factorial(n - 1)
    assert (V.subs(r, 0), sympy.diff(V, r).subs(r, 0), sympy.diff(V, r, 2).subs(r, 0)) == (0, 0, 1)
    assert potential.even == (sympy.simplify(V - V.subs(r, -r)) == 0)


class SinhLaw(NamedTuple):
    """Of V = (cosh(a r) - 1)/a^2; it calls functions of this module and a method of its own."""

    a: float

    def potential(self, r):
        return (np.cosh(self.a * r) - 1) / self.a**2

    def tension(self, r):
        return difference(self.a, r) / self.a

    def stiffness(self, r):
        return self.sum_of_exponentials(r)

    def sum_of_exponentials(self, r):
        return half_sum(self.a, r, 1)

    def anharmonic_tension(self, r):
        return self.tension(r) - r

    def anharmonic_stiffness(self, r):
        return self.stiffness(r) - 1


def exponential(x):
    return np.exp(x)


def half_sum(a, r, sign):
    return (exponential(a * r) + sign * exponential(-a * r)) / 2


def difference(a, r):
    """Two functions that call the same one, which calls another."""
    return half_sum(a, r, -1) + 0 * difference_again(a, r)


def difference_again(a, r):
    return half_sum(a, r, -1)


@dataclass(frozen=True, repr=False)
class Cosh(Potential):
    """A potential as a user writes one, whose tension is a sum of growths and V even or said to be."""

    kind = "cosh"
    a: Fraction
    even: bool = True
    extra: Fraction = Fraction(0)
    unit: Fraction = Fraction(1)

    @property
    def parameters(self):
        return (self.a,)

    def coefficient(self, n):
        return self.extra if n % 2 else self.a ** (n - 2) / math.factorial(n - 1)

    def growths(self):
        weight = self.unit / (2 * self.a)
        return Growth(weight, Fraction(0), self.a), Growth(-weight, Fraction(0), -self.a)

    def law(self, numbers):
        return SinhLaw(numbers.number(self.a))

    def expression(self, r):
        a = sympy.Rational(self.a)
        return (sympy.cosh(a * r) - 1) / a**2


@pytest.mark.parametrize("digits", [None, 30])
@pytest.mark.parametrize("even", [True, False])
def test_series_of_an_even_potential_with_growths_are_those_of_its_polynomial(even, digits):
    chain = Chain(8, potential=Cosh(Fraction(2), even))
    same = Chain(8, potential=polynomial(0, "2/3", 0, "2/15", 0, "4/315"))
    order = 2 if even else 4
    found = lindstedt(chain, (1, 2), ("0.41", "0.817"), order, digits=digits).frequency_correction(1, order)
    expected = lindstedt(same, (1, 2), ("0.41", "0.817"), 2, digits=digits).frequency_correction(1, 2)
    found, expected = (sympy.Poly(sympy.sympify(x), *sympy.symbols("A1 A2")) for x in (found, expected))
    scale = 1 if even else Fraction(2, 3) ** 2  # mu is c_4/(2N), or 1/sqrt(2N) where V is not said to be even
    sizes = [(abs(a - b * sympy.Rational(scale)), abs(a)) for a, b in zip(found.coeffs(), expected.coeffs(), strict=True)]
    assert all(size > 0 and off <= ROUNDING * 100 * size for off, size in sizes)


@pytest.mark.long
def test_orbits_of_a_law_that_calls_functions_go_together():
    own, known = Chain(8, potential=Cosh(Fraction(1))), Chain(8, potential="expr:cosh(r)-1")
    Q = np.outer(np.linspace(0.1, 0.3, 9), np.ones(7))
    found, expected = (integrate(chain, Q, 0 * Q, 20, step=0.1, samples=4).Q for chain in (own, known))
    assert np.allclose(found, expected, rtol=0, atol=THOUSAND_ROUNDINGS)


WRONG = {
    "even": (Cosh(Fraction(2), True, Fraction(1, 3)), "coefficient(3) = 0, since V is even"),
    "growths": (Cosh(Fraction(2), True, Fraction(0), Fraction(2)), "growths whose sum has c_2 = 1"),
    "coefficient": (Cosh(Fraction(2), False, Fraction(1, 3)), "growths whose sum has c_3 = 1/3"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_potential_that_contradicts_itself_is_refused(name):
    potential, allowed = WRONG[name]
    with pytest.raises(InputError) as caught:
        Chain(8, potential=potential)
    assert allowed in caught.value.allowed


def test_typed_and_printed(potential):
    assert potential_of_text(potential.text) == potential
    assert repr(potential) == potential.text.replace(":", "(").replace(",", ", ") + ")"
    assert pickle.loads(pickle.dumps(Chain(8, potential=potential))) == Chain(8, potential=potential)


@pytest.mark.parametrize("powers", [(12, 6), ("25/2", "13/3")])
def test_couplings_of_lennard_jones_are_binomials_to_high_powers(powers):
    """Each from the one before; the 5000th of whole powers is as near as the tenth."""
    m, n = (Fraction(p) for p in powers)
    potential, steep, flat = lennard_jones(*powers), Fraction(1), Fraction(1)
    for k in range(60):
        assert potential.coefficient(k + 1) == (flat - steep) / (m - n)
        steep, flat = (x * Fraction(-p - 1 - k) / (k + 1) for x, p in ((steep, m), (flat, n)))
    chain = Chain(8, potential=lennard_jones(12, 6))
    assert len(chain.relative_couplings(5000)) == 4999


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
