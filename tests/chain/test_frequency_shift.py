"""The closed-form shift: exactly, for every mode and pair of modes of every chain up to N = 40, and against the series."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
import symengine as se
import sympy

from symfpu.algebra.selection import fold
from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift, frequency_shift_formula, shift_coefficients
from symfpu.chain.potentials.toda import toda
from symfpu.errors import InputError
from symfpu.series.lindstedt import lindstedt
from tests.oracles.cyclotomic import Cyclotomic, omega, vanishes
from tests.tolerances import DISTINCTION, HUNDRED_ROUNDINGS, NEARLY_LINEAR, RELATIVE_SHIFT, THOUSAND_ROUNDINGS

LENGTHS = range(2, 41)


def divisor_terms(N, q, n):
    """The sum of B^2 L_m that the recursion gives for the shift of q by n: (weight, Omega_m^2, divisor), exact.

    [omega_q^2]^(2) = -Omega_q^2 Omega_n^2 A_n^2 times this sum. For n = q: B_mqq^2 (1/2 L_m(2 e_q) + L_m(0)). For n != q:
    B_qnm^2 (L_m(e_q + e_n) + L_m(e_q - e_n)) + B_qqm B_mnn L_m(0).
    """
    chain = Chain(N=N, alpha=1)
    Q, P = omega(N, q), omega(N, n)
    terms, constant = [], Fraction(0)
    for m in range(1, N):
        square = omega(N, m) * omega(N, m)
        if q == n and (b := chain.B(m, q, q)):
            terms.append((Fraction(b * b, 2), square, square - 4 * (Q * Q)))
            constant += b * b
        elif q != n:
            if b := chain.B(q, n, m):
                terms += [(Fraction(b * b), square, square - (Q + P) * (Q + P)), (Fraction(b * b), square, square - (Q - P) * (Q - P))]
            constant += chain.B(q, q, m) * chain.B(m, n, n)
    return terms, constant


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
            squares = {m: chain.B(q, n, m) ** 2 for m in {fold(q + n, N), abs(q - n)} - {0, N}}
            assert set(squares.values()) <= {1}
            assert set(squares) == ({fold(2 * q, N)} - {N} if q == n else {fold(q + n, N), abs(q - n)} - {0, N})
            constant = sum(chain.B(q, q, m) * chain.B(m, n, n) for m in {fold(2 * q, N)} - {0, N})
            if q != n:
                assert constant == (-1 if q + n == N else 0)
                assert (q + n == N) == (len(squares) == 1)
            elif 2 * q == N:
                assert squares == {}
                assert shift_coefficients(N, q, q)[0] == (0, 0)


@pytest.mark.parametrize("N", [2, 3, 6, 9, 10, pytest.param(40, marks=pytest.mark.long)])
def test_alpha_shift_is_exact_in_the_cyclotomic_field(N):
    """By another route: every mode and pair in the field of the 4N-th roots of unity."""
    for q in range(1, N):
        for n in range(q, N):
            terms, constant = sparse_terms(N, q, n)
            (a, b), _ = shift_coefficients(N, q, n)
            # closed form: -sum / 2 Omega_n^2 = a + b Omega_n^2, so sum = -2 b - 2 a / Omega_n^2
            fractions = terms + ([(2 * a, Cyclotomic(N, {0: 1}), omega(N, n) * omega(N, n))] if a else [])
            assert vanishes(N, fractions, -2 * b - constant), (q, n)


def sparse_terms(N, q, n):
    """divisor_terms, with m only where a coupling can be: the same list, found without a search over all m."""
    chain = Chain(N=N, alpha=1)
    Q, P = omega(N, q), omega(N, n)
    terms, constant = [], Fraction(0)
    for m in {m for m in (q + n, abs(q - n), 2 * N - q - n) if 0 < m < N}:
        square = omega(N, m) * omega(N, m)
        b = chain.B(q, n, m)
        if q == n:
            terms.append((Fraction(b * b, 2), square, square - 4 * (Q * Q)))
            constant += b * b
        elif b:
            terms += [(Fraction(b * b), square, square - (Q + P) * (Q + P)), (Fraction(b * b), square, square - (Q - P) * (Q - P))]
    if q != n:
        constant += sum(chain.B(q, q, m) * chain.B(m, n, n) for m in (2 * q, 2 * N - 2 * q) if 0 < m < N)
    return [t for t in terms if t[0]], constant


@pytest.mark.parametrize("N", [2, 5, 8, 9])
def test_couplings_are_where_the_short_list_says(N):
    for q in range(1, N):
        for n in range(q, N):
            full, constant = divisor_terms(N, q, n)
            short, constant_short = sparse_terms(N, q, n)
            assert constant == constant_short
            key = lambda t: (t[0], sorted(t[1].terms.items()), sorted(t[2].terms.items()))  # noqa: E731
            assert sorted(map(key, full)) == sorted(map(key, short))


@pytest.mark.parametrize("N", LENGTHS)
def test_beta_shift_is_a_coupling(N):
    """omega^(1) = Omega_q/2 (3/4 C_qqqq Omega_q^2 A_q^2 + 3/2 C_qqnn Omega_n^2 A_n^2): integers only."""
    chain = Chain(N=N, beta=1)
    for q in range(1, N):
        for n in range(1, N):
            weight = Fraction(3, 8) if n == q else Fraction(3, 4)
            assert shift_coefficients(N, q, n)[1] == weight * chain.C(q, q, n, n)


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
    ],
    ids=str,
)
def test_shift_is_the_lowest_correction_of_the_series_at_the_linear_frequencies(chain, seeds):
    with mpmath.workdps(40):
        linear = [mpmath.nstr(chain.linear_frequency(q), 36) for q in seeds]
    order = 2 // chain.degree_step
    series = lindstedt(chain, seeds, linear, order)
    squares = np.array([0.3, 0.7])
    terms, _ = series.frequency_terms(squares)
    shift = frequency_shift(chain, dict(zip(seeds, np.sqrt(squares), strict=True)))
    assert list(shift.values()) == pytest.approx(terms[order], rel=RELATIVE_SHIFT)  # divisors at the linear frequencies to 36 digits
    Omega = {se.Symbol(f"Omega_{q}"): float(chain.frequencies()[q - 1]) for q in seeds}
    A = {se.Symbol(f"A{q}"): float(np.sqrt(x)) for q, x in zip(seeds, squares, strict=True)}
    for q, formula in frequency_shift_formula(chain, seeds).items():
        assert float(formula.subs(Omega | A)) == pytest.approx(shift[q], rel=HUNDRED_ROUNDINGS)


@pytest.mark.parametrize("N", LENGTHS)
def test_toda_coupling_leaves_the_own_amplitude_only(N):
    """beta = 2 alpha^2/3: omega_q = Omega_q (1 + alpha^2/(2N) A_q^2), for every mode, special or not."""
    seeds = range(1, N)
    for q, formula in frequency_shift_formula(Chain(N=N, alpha=1, beta="2/3"), seeds).items():
        difference = formula / se.Symbol(f"Omega_{q}") - se.Symbol(f"A{q}") ** 2 / (2 * N)
        middle = {se.Symbol(f"Omega_{N // 2}"): se.sqrt(2)} if N % 2 == 0 else {}  # 2 sin(pi/4)
        assert se.expand(se.expand(difference).subs(middle)) == 0


def printed_bracket(chain, q, n, squares):
    """The bracket of Eqs. omamid/omafin as printed, divisors at the linear frequencies: shift of q by A_n^2 = squares[n]."""
    Omega = dict(enumerate(chain.frequencies(), 1))
    total = 0.0
    for m in range(1, chain.N):
        if q == n:
            total += Omega[m] ** 2 * chain.B(m, q, q) ** 2 * (1 / (Omega[m] ** 2 - 4 * Omega[q] ** 2) + 2 / Omega[m] ** 2)
            continue
        for s, t in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            if b := chain.B(q, n, m):
                total += Omega[m] ** 2 * 2 * b**2 / (Omega[m] ** 2 - (s * Omega[q] + t * Omega[n]) ** 2)
            if b := chain.B(q, q, m) * chain.B(m, n, n):
                total += Omega[m] ** 2 * b / (Omega[m] ** 2 - ((s + t) * Omega[n]) ** 2)
    return -Omega[q] / 4 * Omega[n] ** 2 * squares * total


def test_printed_bracket_counts_other_seeds_twice():
    """Right for the own amplitude; twice too large for another seed, and with a further wrong term where q + n = N."""
    chain = Chain(N=16, alpha=1)
    right = {n: frequency_shift(chain, {2: 0.0, n: 1.0})[2] * 2 * chain.N for n in (5, 14)} | {
        2: frequency_shift(chain, {2: 1.0})[2] * 2 * chain.N
    }
    assert printed_bracket(chain, 2, 2, 1.0) == pytest.approx(right[2], rel=THOUSAND_ROUNDINGS)
    assert printed_bracket(chain, 2, 5, 1.0) == pytest.approx(2 * right[5], rel=THOUSAND_ROUNDINGS)
    assert printed_bracket(chain, 2, 14, 1.0) != pytest.approx(2 * right[14], rel=DISTINCTION)
    assert printed_bracket(chain, 2, 14, 1.0) != pytest.approx(right[14], rel=DISTINCTION)


def test_bad_amplitudes_are_named():
    with pytest.raises(InputError, match="seeds"):
        frequency_shift(Chain(N=4, alpha=1), {4: 0.1})
    with pytest.raises(InputError, match="A_2"):
        frequency_shift(Chain(N=4, alpha=1), {2: float("nan")})


@pytest.mark.parametrize(("N", "seeds"), [(2, (1,)), (8, (1, 4, 7)), (9, (2, 3, 6))])
def test_that_of_toda_is_the_square_of_the_own_amplitude(N, seeds):
    """(a^2/2N) Omega_q A_q^2, exactly: for every mode, special or not, and beside any other seed."""
    a = Fraction(3, 7)
    formulas = frequency_shift_formula(Chain(N, potential=toda(a)), seeds)
    for q in seeds:
        expected = se.Rational(9, 98 * N) * se.Symbol(f"Omega_{q}") * se.Symbol(f"A{q}") ** 2
        middle = {se.Symbol(f"Omega_{N // 2}"): se.sqrt(2)} if 2 * q == N else {}
        assert se.expand((formulas[q] - expected).subs(middle)) == 0


@pytest.mark.parametrize("law", ["toda:1/2", "lj:12,6", "morse:1", "poly:1/3,0,1/5", "poly:0,1/2,0,1/3", "poly:0,0,1"])
@pytest.mark.parametrize(("N", "seeds"), [(2, (1,)), (8, (1, 3)), (9, (4, 5))])
def test_that_of_any_potential_is_that_of_its_first_two_coefficients(law, N, seeds):
    """Against the series, at frequencies next to the linear ones: higher coefficients do not enter."""
    chain = Chain(N, potential=law)
    linear = chain.frequencies()
    frequencies = [linear[q - 1] * (1 + 1e-9 * q) for q in seeds]
    order = 2 // chain.degree_step
    series = lindstedt(chain, seeds, frequencies, order)
    amplitudes = {q: 0.1 / q for q in seeds}
    terms, _ = series.frequency_terms(np.array([a**2 for a in amplitudes.values()]), order)
    shifts = frequency_shift(chain, amplitudes)
    assert terms[order] == pytest.approx([shifts[q] for q in seeds], rel=NEARLY_LINEAR, abs=NEARLY_LINEAR * 1e-3)
    if law == "poly:0,0,1":
        assert not any(shifts.values())
