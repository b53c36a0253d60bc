"""The law of one bond: tension and stiffness are the derivatives of the potential, in any arithmetic and compiled."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symfpu import Chain
from symfpu.chain import bonds
from symfpu.numbers.arithmetic import MULTIPRECISION
from tests.tolerances import ROUNDING

LAWS = [(0.25, 0.0), (0.0, -0.5), (0.3, 0.2), (0.5,), (0.1, -0.2, 0.3, 0.4, -0.5)]
STRETCHES = np.linspace(-1.5, 1.5, 13)


def derivative(law, r, order):
    """Of V(r) = r^2/2 + sum c_n r^n / n, term by term in rationals."""
    terms = {2: Fraction(1), **{n: Fraction(c) for n, c in enumerate(law, 3)}}
    if order == 0:
        return sum(c * r**n / n for n, c in terms.items())
    return sum(c * (r ** (n - 1) if order == 1 else (n - 1) * r ** (n - 2)) for n, c in terms.items())


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("function", "order"), [(bonds.potential, 0), (bonds.tension, 1), (bonds.stiffness, 2)])
def test_the_functions_are_the_potential_and_its_derivatives(law, function, order):
    exact = [float(derivative(law, Fraction(r), order)) for r in STRETCHES]
    assert function(law, STRETCHES) == pytest.approx(exact, rel=ROUNDING, abs=ROUNDING)


@pytest.mark.parametrize("law", LAWS)
def test_what_lies_beyond_the_harmonic_law_does_not_cancel(law):
    r = 2.0**-40
    tension, stiffness = (derivative(law, Fraction(r), order) for order in (1, 2))
    assert bonds.anharmonic_tension(law, r) == pytest.approx(float(tension - Fraction(r)), rel=ROUNDING)
    assert bonds.anharmonic_stiffness(law, r) == pytest.approx(float(stiffness - 1), rel=ROUNDING)


def test_a_chain_gives_its_law_in_the_arithmetic_asked_for():
    chain = Chain(8, alpha="1/3", beta="-1/7")
    assert chain.couplings == (Fraction(1, 3), Fraction(-1, 7))
    assert chain.law() == (1 / 3, -1 / 7)
    with mpmath.workdps(40):
        law = chain.law(MULTIPRECISION)
        assert law == (mpmath.mpf(1) / 3, -mpmath.mpf(1) / 7)
        assert bonds.tension(law, mpmath.mpf(1)) == 1 + law[0] + law[1]
