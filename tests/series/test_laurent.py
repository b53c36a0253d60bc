"""Laurent series: how far they are known, and frequencies against SymPy's series."""

from fractions import Fraction

import pytest
import sympy

from symfpu.chain.length import HighMode
from symfpu.series.laurent import BOTH_ENDS, ONE_END, Laurent, LongChain

STEPS = [ONE_END, BOTH_ENDS]


@pytest.mark.parametrize("step", STEPS)
def test_series_know_how_far_they_are_known(step):
    x = Laurent(0, [Fraction(0), Fraction(2), Fraction(1)], step)
    assert (x * x.inverse()).coefficients == [0, 1]
    assert (x * x.inverse()).low == -step
    assert (x.inverse() + x).end == step
    assert (x + 1).coefficients == [1, 2, 1]
    with pytest.raises(ZeroDivisionError):
        LongChain(3, step).number(0).inverse()


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
