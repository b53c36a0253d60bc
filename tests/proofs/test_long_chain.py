"""Frequencies of a long chain against SymPy's series."""

from fractions import Fraction

import pytest
import sympy

from symfpu.chain.length import HighMode
from symfpu.proofs.long_chain import BOTH_ENDS, ONE_END, LongChain

STEPS = [ONE_END, BOTH_ENDS]


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("q", [1, 3, HighMode(-2)], ids=str)
def test_frequencies_are_those_of_sympy(step, q):
    x = sympy.Symbol("x")
    function = 2 * sympy.cos(2 * x) if isinstance(q, HighMode) else 2 * sympy.sin(int(q) * x)
    found = LongChain(8 // step, step).frequency(q)
    expected = sympy.series(function, x, 0, found.end).removeO()
    powers = range(found.low, found.end, step)
    assert sum(sympy.Rational(c) * x**p for p, c in zip(powers, found.coefficients, strict=True)) == expected


def test_drives_are_sums_of_frequencies():
    chain = LongChain(4, BOTH_ENDS)
    drive = chain.drive((1, HighMode(-1)), (2, -1))
    assert drive.coefficients[:4] == [-2, 4, 1, Fraction(-2, 3)]
    assert drive.leads_below_zero()
    assert chain.drive((1,), (0,)).first is None
