"""The potential of a bond in source code: as good as doubles at any stretch, in every language, and FPU chains as they were."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy

from symfpu import Chain, Torus, compile_evaluator, export
from symfpu.codegen.bond_potential import HIGHEST_POWER, REMAINDER, STRETCH, bond_potential
from tests.codegen.compilers import program, self_test
from tests.tolerances import BOND_OF_FORTY_FIVE, OF_LARGEST

GROWING = ["toda:1/2", "toda:-100", "toda:1e-3", "lj:12,6", "lj:13/2,1/3", "morse:2"]
MEASURED = ["expr:cosh(r)-1", "expr:log(cosh(r))"]
SIZES = 2.0 ** -np.arange(0, 40, 1.7)


def bond_of(typed):
    return bond_potential(Chain(4, potential=typed))


@pytest.mark.parametrize("typed", [*GROWING, *MEASURED])
def test_both_forms_keep_the_digits_of_doubles(typed):
    """The polynomial up to its reach and the closed form from there on, against the closed form at eighty digits."""
    bond = bond_of(typed)
    near, far = (sympy.lambdify(STRETCH, form, "math") for form in (bond.taylor(), bond.closed))
    V = sympy.lambdify(STRETCH, bond.closed, "mpmath")
    beyond = [(1 + size) * side for size in SIZES for side in (1, -1)]
    below = [size * side for size in SIZES for side in (1, -1)]
    with mpmath.workdps(80):
        for form, parts in ((near, below), (far, beyond)):
            for r in (part * 2.0**bond.reach for part in parts):
                exact = V(mpmath.mpf(r))
                assert abs(form(r) - exact) <= OF_LARGEST * exact


@pytest.mark.parametrize("typed", GROWING)
def test_the_remainder_is_what_was_proved_and_the_reach_the_largest(typed):
    """Of the exact polynomial, at the reach; at four times the reach the bound must fail for a reason: V differs there."""
    bond = bond_of(typed)
    V = sympy.lambdify(STRETCH, bond.closed, "mpmath")
    assert len(bond.coefficients) == HIGHEST_POWER - 2

    def remainder(r):
        """Relative to r^2/2."""
        with mpmath.workdps(80):
            x = mpmath.mpf(r)
            cut = x**2 / 2 + sum(mpmath.mpf(c.numerator) / c.denominator * x**n for n, c in enumerate(bond.coefficients, 3))
            return abs(mpmath.mpc(V(x) - cut)) / (x**2 / 2)

    reach = 2.0**bond.reach
    assert max(remainder(reach), remainder(-reach)) <= float(REMAINDER)
    assert max(remainder(4 * reach), remainder(-4 * reach)) > float(REMAINDER)


def test_fpu_chains_need_none_and_polynomials_are_themselves():
    assert bond_of("poly:1/3,1/5") is None
    bond = bond_of("poly:1/3,0,1/5")
    assert (bond.closed, bond.reach) == (None, None)
    assert sympy.expand(bond.exactly() - Chain(4, potential="poly:1/3,0,1/5").potential.expression(STRETCH)) == 0


def moving(typed, size):
    """A torus whose bonds go as far as the size, on no orbit: its energy is that of the chain all the same."""
    chain = Chain(5, potential=typed)
    harmonics, cosines = np.array([[1], [2]]), np.array([[size, 0, 0.25 * size, 0], [0, 0.5 * size, 0, 0.125 * size]])
    return Torus(chain, (1,), (Fraction(5, 8),), harmonics, cosines, {1: 0.5})


LARGE = {"toda:1/2": 8.0, "lj:12,6": 0.25, "morse:2": 1.0, "expr:cosh(r)-1": 8.0, "poly:1/3,0,1/5": 1.0}


@pytest.fixture(params=[1, 1e-5], ids=["large", "small"])
def size(request):
    return request.param


@pytest.mark.parametrize("typed", LARGE)
@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_energies_of_evaluators_are_those_of_the_chain(typed, backend, size):
    if backend == "c":
        program("gcc")
    torus = moving(typed, size * LARGE[typed])
    times = np.linspace(0, 9, 21)
    exact = torus.energy(times)
    assert np.abs(compile_evaluator(torus, backend=backend).energy(times) / exact - 1).max() <= OF_LARGEST


@pytest.mark.parametrize("typed", LARGE)
def test_energies_of_python_files_are_those_of_the_chain(typed, size, tmp_path):
    """NumPy to the digits of doubles, mpmath to as many as are asked for."""
    torus = moving(typed, size * LARGE[typed])
    spaces = {}
    for language in ("numpy", "mpmath"):
        file = export(torus, language, tmp_path / f"{language}_file")
        spaces[language] = {"__name__": "moving"}
        exec(compile(file.read_text(), str(file), "exec"), spaces[language])
        assert spaces[language]["self_test"]() <= spaces[language]["TOLERANCE"]
    times = np.linspace(0, 9, 21)
    found = spaces["numpy"]["energy"](times)
    assert np.abs(found / torus.energy(times) - 1).max() <= OF_LARGEST
    V = sympy.lambdify(STRETCH, torus.chain.potential.expression(STRETCH), "mpmath")
    with mpmath.workdps(200):
        r = mpmath.mpf(size * LARGE[typed]) / 7
        exact = V(r)
    with mpmath.workdps(45):
        assert abs(spaces["mpmath"]["_potential"](r) / exact - 1) <= BOND_OF_FORTY_FIVE


@pytest.mark.long
@pytest.mark.parametrize("language", ["c", "fortran", "octave"])
@pytest.mark.parametrize("typed", LARGE)
def test_files_of_other_languages_pass_their_own_test(typed, language, size, tmp_path):
    run = self_test(export(moving(typed, size * LARGE[typed]), language, tmp_path / "sample"), tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr
    assert "largest deviation" in run.stdout
