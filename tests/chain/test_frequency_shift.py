"""The closed-form shift: exactly, for every mode and pair of modes of every chain up to N = 40, and against the series."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
import symengine as se
import sympy

from symfpu import Chain, InputError, frequency_shift, frequency_shift_formula, lindstedt
from symfpu.chain.frequency_shift import shift_coefficients
from symfpu.paper.appendix_a_claims import bracket
from tests.chain.test_propagation import folded
from tests.tolerances import DISTINCTION, HUNDRED_ROUNDINGS, RELATIVE_SHIFT, THOUSAND_ROUNDINGS

LENGTHS = range(2, 41)


X, Y = sympy.symbols("x y")  # exp(i q pi / 2N), exp(i n pi / 2N)


def squared_frequency(z):
    """Omega^2 = (2 sin)^2 of a mode with exp(i q pi / 2N) = z; the same for the folded mode 2N - q."""
    return -((z - 1 / z) ** 2)


def frequency(z):
    """Omega of the same mode, times i: the squares of sums are what matters."""
    return z - 1 / z


def multiplier(z, drive):
    """L_m(nu) with exp(i m pi / 2N) = z and i nu.Omega = drive."""
    return squared_frequency(z) / (squared_frequency(z) + drive**2)


def test_alpha_shift_of_generic_modes_is_an_identity_in_both_angles():
    """For all N at once: the own amplitude gives 1/2 L_2q(2 e_q) + L_2q(0) = 3/2 - 2/Omega_q^2, another seed gives 2."""
    own = multiplier(X**2, 2 * frequency(X)) / 2 + 1
    (a, b), _ = shift_coefficients(100, 7, 7)
    assert sympy.cancel(own - (-2 * sympy.Rational(b) - 2 * sympy.Rational(a) / squared_frequency(X))) == 0
    drives = (frequency(X) + frequency(Y), frequency(X) - frequency(Y))
    other = sum(multiplier(z, drive) for z in (X * Y, X / Y) for drive in drives)
    assert sympy.cancel(other - (-2 * sympy.Rational(shift_coefficients(100, 7, 11)[0][1]))) == 0


def test_alpha_shift_of_mirror_modes_is_an_identity_in_one_angle():
    """q + n = N, y = i/x: mode q + n is missing, and B_qqm B_mnn = -1 adds a constant; together they give one half."""
    mirror = sympy.I / X
    drives = (frequency(X) + frequency(mirror), frequency(X) - frequency(mirror))
    other = sum(multiplier(X / mirror, drive) for drive in drives) - 1
    assert sympy.cancel(sympy.expand(other - (-2 * sympy.Rational(shift_coefficients(20, 7, 13)[0][1])))) == 0


@pytest.mark.parametrize("N", LENGTHS)
def test_couplings_of_every_pair_are_those_of_the_identities(N):
    """With the identities above this proves the closed form for every mode and pair of this N: only integers are left."""
    chain = Chain(N=N, alpha=1)
    for q in range(1, N):
        for n in range(1, N):
            squares = {m: chain.B(q, n, m) ** 2 for m in {folded(q + n, N), abs(q - n)} - {0, N}}
            assert set(squares.values()) <= {1}
            assert set(squares) == ({folded(2 * q, N)} - {N} if q == n else {folded(q + n, N), abs(q - n)} - {0, N})
            constant = sum(chain.B(q, q, m) * chain.B(m, n, n) for m in {folded(2 * q, N)} - {0, N})
            if q != n:
                assert constant == (-1 if q + n == N else 0)
                assert (q + n == N) == (len(squares) == 1)
            elif 2 * q == N:
                assert squares == {}
                assert shift_coefficients(N, q, q)[0] == (0, 0)


@pytest.mark.parametrize("N", LENGTHS)
def test_beta_shift_is_a_coupling(N):
    """omega^(1) = Omega_q/2 (3/4 C_qqqq Omega_q^2 A_q^2 + 3/2 C_qqnn Omega_n^2 A_n^2): integers only."""
    chain = Chain(N=N, beta=1)
    for q in range(1, N):
        for n in range(1, N):
            weight = Fraction(3, 8) if n == q else Fraction(3, 4)
            assert shift_coefficients(N, q, n)[1] == weight * chain.C(q, q, n, n)


LAWS = ("toda:1/2", "lj:12,6", "morse:1", "poly:1/3,0,1/5", "poly:0,1/2,0,1/3", "poly:0,0,1")


@pytest.mark.parametrize(
    ("chain", "seeds"),
    [
        (Chain(N=9, alpha=1), (2, 5)),
        (Chain(N=9, alpha=1), (3, 6)),
        (Chain(N=8, alpha=1), (3, 5)),
        (Chain(N=8, alpha=1), (4, 7)),
        (Chain(N=12, beta=1), (6, 7)),
        (Chain(N=12, beta=1), (4, 8)),
        (Chain(N=7, alpha="0.3", beta="-0.2"), (1, 6)),
        *((Chain(N, potential=law), seeds) for law in LAWS for N, seeds in ((2, (1,)), (8, (1, 3)), (9, (4, 5)))),
    ],
    ids=str,
)
def test_shift_is_the_lowest_correction_of_the_series_at_the_linear_frequencies(chain, seeds):
    """Of any potential that of its first two coefficients: higher ones do not enter."""
    with mpmath.workdps(40):
        linear = [mpmath.nstr(chain.linear_frequency(q), 36) for q in seeds]
    order = 2 // chain.degree_step
    series = lindstedt(chain, seeds, linear, order)
    squares = np.array([0.3, 0.7])[: len(seeds)]
    terms, _ = series.frequency_terms(squares)
    shift = frequency_shift(chain, dict(zip(seeds, np.sqrt(squares), strict=True)))
    assert list(shift.values()) == pytest.approx(
        terms[order], rel=RELATIVE_SHIFT, abs=RELATIVE_SHIFT * 1e-3
    )  # divisors at the linear frequencies to 36 digits
    Omega = {se.Symbol(f"Omega_{q}"): float(chain.frequencies()[q - 1]) for q in seeds}
    A = {se.Symbol(f"A{q}"): float(np.sqrt(x)) for q, x in zip(seeds, squares, strict=True)}
    for q, formula in frequency_shift_formula(chain, seeds).items():
        assert float(formula.subs(Omega | A)) == pytest.approx(shift[q], rel=HUNDRED_ROUNDINGS, abs=HUNDRED_ROUNDINGS)


@pytest.mark.parametrize(
    ("N", "law"), [*((N, {"alpha": 1, "beta": "2/3"}) for N in LENGTHS), *((N, {"potential": "toda:3/7"}) for N in (2, 8, 9))]
)
def test_that_of_toda_is_of_the_own_amplitude_alone(N, law):
    """omega_q = Omega_q (1 + a^2/(2N) A_q^2), for every mode, special or not; that of beta = 2 alpha^2/3, too."""
    chain = Chain(N, **law)
    a = se.Rational(*chain.potential.coefficient(3).as_integer_ratio())
    for q, formula in frequency_shift_formula(chain, range(1, N)).items():
        difference = formula / se.Symbol(f"Omega_{q}") - a**2 * se.Symbol(f"A{q}") ** 2 / (2 * N)
        middle = {se.Symbol(f"Omega_{N // 2}"): se.sqrt(2)} if N % 2 == 0 else {}  # 2 sin(pi/4)
        assert se.expand(se.expand(difference).subs(middle)) == 0


def test_printed_bracket_counts_other_seeds_twice():
    """Of Eqs. omamid and omafin, divisors at the linear frequencies: right for the own amplitude; twice too large for another seed, and
    with a further wrong term where q + n = N."""
    chain, linear = Chain(N=16, alpha=1), dict(enumerate(Chain(N=16, alpha=1).frequencies().tolist(), 1))
    alone = [{2: 1.0}, {2: 0.0, 5: 1.0}, {2: 0.0, 14: 1.0}]
    own, other, mirror = (frequency_shift(chain, amplitudes)[2] for amplitudes in alone)
    printed = [bracket(chain, amplitudes, linear, printed=True)[2] for amplitudes in alone]
    assert printed[:2] == pytest.approx([own, 2 * other], rel=THOUSAND_ROUNDINGS)
    assert printed[2] != pytest.approx(2 * mirror, rel=DISTINCTION)
    assert printed[2] != pytest.approx(mirror, rel=DISTINCTION)


def test_bad_amplitudes_are_named():
    with pytest.raises(InputError, match="seeds"):
        frequency_shift(Chain(N=4, alpha=1), {4: 0.1})
    with pytest.raises(InputError, match="A_2"):
        frequency_shift(Chain(N=4, alpha=1), {2: float("nan")})
