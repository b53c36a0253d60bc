"""Potentials written down as expressions: coefficients, laws and refusals."""

import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import symengine as se
import sympy
from numba import njit

from symfpu import Chain, InputError, from_expression, integrate, lennard_jones, lindstedt, polynomial, toda
from symfpu.chain import bond_loops, bonds
from symfpu.chain.potentials.typed import potential_of_text
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION
from symfpu.numbers.long_doubles import LONG_DOUBLES
from tests.chain.test_potentials import FUNCTIONS, POTENTIALS, SinhLaw
from tests.series.test_potentials import assert_same
from tests.tolerances import FIFTY_DIGITS, FORTY_DIGITS, ROUNDING

R = sympy.Symbol("r")
LJ = "((1+r)**-12/12 - (1+r)**-6/6 + 1/12)/6"
SAME = {"(exp(r) - 1 - r)": toda("1/2"), "exp(-6*r)/36 - 1/36 + r/6": toda(-3), LJ: lennard_jones(12, 6)}
MORSE = "(1 - exp(-sqrt(2)*r))**2/4"
OTHERS = [
    "cosh(r) - 1",
    MORSE,
    "-log(1 - r**2/9)*9/2",
    "r*asinh(r)/2",
    "r*tan(r/2)",
    "r*atanh(r/4)*2",
    "r*sin(r)/2 + r**2*sinh(r)/r/7 - r**2/7 + r**4*exp(pi*r)",
]
STRETCHES = [-0.7, -0.1, -1e-3, -1e-9, 1e-12, 0.02, 0.0626, 0.4, 0.51, 1.7]  # some just beyond a radius


@pytest.fixture(params=[*SAME, *OTHERS], ids=str)
def potential(request):
    return from_expression(request.param)


@pytest.fixture(params=[*POTENTIALS, *SAME, *OTHERS], ids=str)
def any_potential(request):
    return from_expression(request.param) if isinstance(request.param, str) else request.param


@pytest.mark.parametrize("text", SAME)
def test_coefficients_of_the_same_potential_are_the_same(text):
    made = from_expression(text)
    assert made.exact
    assert [made.coefficient(n) for n in range(3, 82)] == [SAME[text].coefficient(n) for n in range(3, 82)]


@pytest.mark.parametrize(("order", "digits"), [(4, 20), (10, None)])
def test_series_of_the_same_potential_are_the_same(order, digits):
    potentials = from_expression(LJ), lennard_jones(12, 6)
    a, b = (lindstedt(Chain(8, potential=V), (1, 2), ("0.392", "0.768"), order, digits=digits) for V in potentials)
    assert a.multiply_adds == b.multiply_adds
    assert_same(a, b, ROUNDING)


def test_polynomials_are_polynomials():
    assert from_expression("r**2/2 + 0.33*r**3/3") == polynomial("0.33")
    assert from_expression(R**2 / 2 + 0.1 * R**3 * (1 + R**2), R) == polynomial("0.3", 0, "0.5")
    assert Chain(8, potential="expr:r**2/2+r**3/12+r**4/28") == Chain(8, alpha="1/4", beta="1/7")


def test_even_potentials():
    chain = Chain(8, potential="expr:cosh(r)-1")
    assert chain.potential.even
    assert (chain.degree_step, chain.mu) == (2, float(Fraction(1, 96)))
    assert chain.relative_couplings(7) == {3: 1, 5: Fraction(36, 120), 7: Fraction(216, 5040)}
    even = {text for text in OTHERS if from_expression(text).even}
    assert even == {"cosh(r) - 1", "-log(1 - r**2/9)*9/2", "r*asinh(r)/2", "r*tan(r/2)", "r*atanh(r/4)*2"}


def test_irrational_coefficients_are_numbers_of_the_asked_digits():
    V = from_expression(MORSE)
    assert (V.exact, V.digits) == (False, 50)
    with mpmath.workdps(80):
        for n in range(3, 82):
            exact = (-mpmath.sqrt(2)) ** n * (2**n - 2) * n / (4 * mpmath.factorial(n))
            found = V.coefficient(n)
            assert abs(mpmath.mpf(found.numerator) / found.denominator / exact - 1) < FIFTY_DIGITS
    assert from_expression(MORSE, digits=60).coefficient(3) != V.coefficient(3)


def test_series_of_more_digits_than_the_potential_has_are_refused():
    chain, more = (Chain(8, potential=from_expression(MORSE, digits=d)) for d in (30, 60))
    with pytest.raises(InputError, match="at most 30, the digits of the Taylor series"):
        lindstedt(chain, (1,), ("0.392",), order=3, digits=31)
    a, b = (lindstedt(c, (1,), ("0.392",), order=3, digits=30) for c in (chain, more))
    assert_same(a, b, ROUNDING)


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: f.__name__)
def test_functions_are_those_of_the_expression(any_potential, function):
    potential = any_potential
    inside = [x for x in STRETCHES if x > -1]
    exact = sympy.lambdify(R, FUNCTIONS[function](potential.expression(R), R), "mpmath")
    with mpmath.workdps(90):
        expected = np.array([exact(mpmath.mpf(x)) for x in inside])
    law = potential.law(DOUBLES)
    lowest = next(n for n in range(3, 9) if potential.coefficient(n)) - 2
    floor = np.abs(inside) ** (2 if function is bonds.potential else 1)
    if "anharmonic" in function.__name__:
        floor = np.abs(inside) ** (lowest + ("tension" in function.__name__))
    size = np.abs(expected.astype(float)) + floor
    found = np.array([function(law, x) for x in inside])
    assert np.all(np.abs(found - expected.astype(float)) <= ROUNDING * size)
    assert np.array_equal(function(law, np.array(inside)), found)
    long = function(potential.law(LONG_DOUBLES), np.array(inside, dtype=np.longdouble))
    assert long.dtype == np.longdouble
    assert np.all(np.abs(long.astype(float) - expected.astype(float)) <= ROUNDING * size)
    with mpmath.workdps(55):
        many = function(potential.law(MULTIPRECISION), np.array([mpmath.mpf(x) for x in inside]))
        assert np.all(np.abs(many - expected) <= FORTY_DIGITS * size)


@pytest.mark.long
@pytest.mark.parametrize("made", [*POTENTIALS, LJ, MORSE, SinhLaw(0.5)], ids=str)
@pytest.mark.parametrize("name", ["tension", "stiffness"])
def test_loops_compile_the_same_functions(made, name):
    """Those that a law calls, too, of its module and of its own."""
    potential = from_expression(made) if isinstance(made, str) else made
    loop, law = getattr(bond_loops, name), potential if isinstance(potential, SinhLaw) else potential.law(DOUBLES)
    compiled = njit(error_model="numpy")(lambda law, r: loop(law, r))
    assert np.isnan(compiled(law, -1.5)) == (made == LJ or getattr(made, "wall", None) == -1)
    assert np.allclose([compiled(law, r) for r in STRETCHES], [loop(law, r) for r in STRETCHES], rtol=ROUNDING, atol=ROUNDING)


GROWTHS = {
    **{text: len(V.growths()) for text, V in SAME.items()},
    "r - log(1 + r)": 1,
    "4*(1 + r/2 - sqrt(1 + r))": 1,
    "(exp(r) - 1 - r)/2 + (r - log(1 + r))/2": 2,
    "((2 - r)**(-3)*8 - 1)/3 - r/2": 1,
    "sinh(2*r)/2 - r + (exp(r) - 1 - r)": 3,
    "cosh(r) - 1": 0,
    MORSE: 0,
    "r**2/2 + (exp(r) - 1 - r - r**2/2)": 1,
    "r**2/2 + (exp(2*r) - 1 - 2*r - 2*r**2)": 0,
    "1/(1 + r**2/2) - 1 + r**2": 0,
}


@pytest.mark.parametrize("made", [*GROWTHS, *POTENTIALS], ids=str)
def test_exponentials_and_powers_are_found(made):
    """Their sum is the tension, coefficient by coefficient: (n + 1) g_(n+1) + slope n g_n = rate g_n."""
    V = from_expression(made) if isinstance(made, str) else made
    growths = V.growths()
    assert made in POTENTIALS or len(growths) == GROWTHS[made]
    tension = [Fraction(0)] * 20
    for growth in growths:
        g = Fraction(1)
        for n in range(1, 20):
            g *= (growth.rate - growth.slope * (n - 1)) / n
            tension[n] += growth.weight * g
    expected = [0, 1, *(V.coefficient(n + 1) for n in range(2, 20))]
    assert not growths or tension == expected


DOMAINS = {
    LJ: (-1, np.inf),
    "-log(1 - r**2)/2": (-1, 1),
    "(1/((1 - r/2)*(1 + r/3)) - 1 - r/6)*18/7": (-3, 2),
    "2*r*tan(r/4)": (-2 * np.pi, 2 * np.pi),
    "r*atanh(r/4)*2": (-4, 4),
    "r**2/(2 + 4*r + 2*r**2)": (-1, np.inf),
    "r**2/2 + r**3/(exp(r) - 2)": (-np.inf, np.log(2)),
    MORSE: (-np.inf, np.inf),
    "r*sin(r)/2 + r**2*sinh(r)/r/7 - r**2/7": (-np.inf, np.inf),
}


@pytest.mark.parametrize("text", DOMAINS)
def test_walls_are_the_nearest_singularities(text):
    """From them on nothing is a number, in arrays, loops and many digits: an orbit ends there."""
    V, (least, most) = from_expression(text), DOMAINS[text]
    law = V.law(DOUBLES)
    assert (law.least, law.most) == pytest.approx((least, most), rel=ROUNDING)
    nearest = min(least, most, key=abs)
    assert V.wall == (pytest.approx(nearest, rel=ROUNDING) if np.isfinite(nearest) else None)
    inside = [x for x in (0.99 * least, 0.99 * most) if np.isfinite(x)]
    beyond = [x for x in (1.01 * least, 1.01 * most, 5 * least) if np.isfinite(x)]
    found = bonds.tension(law, np.array([*inside, *beyond]))
    assert np.array_equal(np.isnan(found), [False] * len(inside) + [True] * len(beyond))
    many = [bonds.tension(V.law(MULTIPRECISION), mpmath.mpf(x)) for x in beyond]
    assert all(map(mpmath.isnan, many))


def test_a_bond_beyond_the_wall_is_named():
    Q = np.array([6.0, 0, 0, 0, 0, 0, 0])
    with pytest.raises(InputError, match=r"of bond 7.*above -1"):
        integrate(Chain(8, potential=from_expression(LJ)), Q, 0 * Q, 10.0, step=0.01)


def test_laws_are_pickled_with_their_class():
    law = from_expression(MORSE).law(DOUBLES)
    again = pickle.loads(pickle.dumps(law))
    assert again == law
    assert type(again) is type(law)
    assert type(law) is not type(from_expression(LJ).law(DOUBLES))


def test_typed_and_printed(potential):
    assert potential_of_text(potential.text) == potential
    assert eval(repr(potential)) == potential
    copy = pickle.loads(pickle.dumps(Chain(8, potential=potential)))
    assert copy == Chain(8, potential=potential)
    assert hash(copy) == hash(Chain(8, potential=potential))
    assert potential != from_expression("r**2/2 + r**5")
    assert from_expression(potential.expression(R), R) == potential


def test_digits_are_typed_after_the_symbol():
    V = potential_of_text("expr:cosh(r)-1,r,20")
    assert repr(V) == "from_expression('cosh(r) - 1', digits=20)"
    assert potential_of_text(V.text) == V != from_expression("cosh(r) - 1")


def test_expressions_of_sympy_and_symengine_in_any_symbol():
    x, y = sympy.Symbol("x"), se.Symbol("y")
    assert from_expression(sympy.cosh(x) - 1, x) == from_expression("cosh(r)-1") == from_expression(se.cosh(y) - 1, y)
    assert from_expression(0.1 * x**3 * sympy.exp(x) + x**2 / 2, x) == from_expression("r**2/2 + r**3*exp(r)/10")


def test_coefficients_through_vanishing_denominators():
    V = from_expression("r*sin(r)/2 + (sin(r)/r - 1 + r**2/6)*r")
    exact = sympy.series(sympy.sin(R) * R / 2 + sympy.sin(R) - R + R**3 / 6, R, 0, 12).removeO()
    found = [V.coefficient(n) for n in range(3, 10)]
    assert found == [Fraction(str(n * exact.coeff(R, n))) for n in range(3, 10)]


BAD = {
    "r": "without a linear term",
    "r**2/2 + r**3 + r/7": "without a linear term",
    "r**2": "unit stiffness",
    "0.999999999*r**2/2 + r**3": "unit stiffness",
    "cosh(r)": r"V\(0\) = 0",
    "r**2/2": "beyond r\\^2/2",
    "r**2/2 + r**2.5": "analytic",
    "r**2/2 + log(r)*r**3": "analytic",
    "r**2/2 + sqrt(-1)*r**3": "an expression in r of",
    "r**2/2 + sqrt(-2-r)*r**3": "analytic",
    "r**2/2 + x**3": "an expression in r of",
    "r^2/2": "an expression in r of",
    "__import__('os').getcwd()": "an expression in r of",
    "(lambda: r)()": "an expression in r of",
    "exp(r": "an expression in r of",
    "9**9**9": "powers up to 1000",
    "": "an expression in r of",
    "(" * 3000: "at most 2000 characters",
    "((10**1000)**1000)**1000": "numbers of at most",
    "r**2/2 + (((2*r)**1000)**1000)**1000": "numbers of at most",
    "r**2/2 + r**3*((2*r + 1)**1000)**1000": "powers of r up to 1000",
    "r**2/2 + r**3*" + "exp(" * 150 + "r" + ")" * 150: "deep",
    "r**2/2 + r**3*exp(exp(exp(exp(exp(1)))))": "constants within the range of doubles",
    "r**2/2 + r**3*exp(exp(exp(exp(exp(r)))))": "of size 1e-30000 to 1e30000",
    "r**2/2 + 1e400*r**3*exp(r)": "c_3 of V.*1e-50 to 1e50",
    "r**2/2 + r**2*sin(10**300*r)": "c_3 of V.*1e-50 to 1e50",
    "r**2/2 + r**2*sin(10**20*r)": "Taylor coefficients are below 1e300",
}


@pytest.mark.parametrize("text", BAD, ids=lambda text: text[:20])
def test_what_is_no_potential_is_refused_in_one_line(text):
    with pytest.raises(InputError, match=BAD[text]) as caught:
        from_expression(text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ((R**2 / 2 + sympy.Symbol("a") * R**3, R), "alone; put numbers for a"),
        ((R**2 / 2 + sympy.gamma(R + 2) * R**3, R), "an expression in r of"),
        ((None,), "an expression in r of"),
        ((R**2 / 2 + R**3, 2), "the symbol of the stretch"),
        ((R**2 / 2 + sympy.Integer(10) ** 4000 * R**3,), "numbers of at most"),
        ((R**2 / 2 + sympy.Pow(R, 3), "exp"), "the symbol of the stretch"),
        (("cosh(r)-1", "r", 0), "digits = 0"),
        (("cosh(r)-1", "r", 1.5), "digits = 1.5"),
        (("cosh(r)-1", "r", "x"), "digits = 'x'"),
    ],
)
def test_other_arguments_are_refused(arguments, reason):
    with pytest.raises(InputError, match=reason) as caught:
        from_expression(*arguments)
    assert "\n" not in str(caught.value)


RUNS = "__import__('pathlib').Path('made').touch()"


@pytest.mark.parametrize(
    "arguments", [([RUNS],), ({RUNS: 1},), ((RUNS,),), (R**2, RUNS), (R**2, [RUNS]), (RUNS,), (np.array([RUNS]),)], ids=str
)
def test_no_text_is_run_as_a_program(arguments, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError):
        from_expression(*arguments)
    assert not list(tmp_path.iterdir())


def test_a_file_whose_potential_grows_without_bound_is_refused():
    with pytest.raises(InputError, match="numbers of at most"):
        potential_of_text("expr:((10**1000)**1000)**1000")


def test_text_may_name_its_symbol():
    """A name that is part of another, as x of exp, stays what it is there."""
    assert from_expression("exp(x) - 1 - x", "x") == from_expression("exp(r) - 1 - r")
    assert from_expression("exp(x) - 1 - x", se.Symbol("x")) == from_expression("exp(r) - 1 - r")


def test_floats_beyond_doubles_are_what_their_digits_say():
    V = R**2 / 2 + R**3 / 3 + sympy.Float("1e400") * R**4
    with pytest.raises(InputError, match="c_4"):
        from_expression(V, R)
