"""Packets: the derived energies against sums by hand, the printed laws, and the page."""

import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import symengine as se

from symfpu import Chain, InputError, asymptotic_energy, asymptotic_group_energy, asymptotic_profile, group_energy, profile_law
from tests.tolerances import LIMIT_OF_LONG_CHAINS, SLOPE

ALPHA, BETA = Chain("N", alpha=1), Chain("N", beta=1)
N, pi = se.Symbol("N"), se.pi


def exact_energy(length, s, q):
    """First order of alpha in numbers: pairs of seeds, E_n = 1, mu = 1/sqrt(2N)."""
    Omega = dict(enumerate(Chain(length, alpha=1).frequencies(), start=1))
    total = 0.0
    for l in range(1, s + 1):
        for m in range(l, s + 1):
            for sign in (1, -1):
                if abs(l + sign * m) == q or l + m == q or abs(l - m) == q:
                    drive = Omega[l] + sign * Omega[m]
                    # 2 w_l w_m cos, w^2 = E/2; once for l = m
                    product = (1 if l == m else 2) * 0.5 * Omega[q] ** 2 / (Omega[q] ** 2 - drive**2)
                    total += (1 + drive**2 / Omega[q] ** 2) * product**2
    return total / (2 * length)


@pytest.mark.parametrize("s", [2, 3, 4])
def test_group_energies_are_sums_over_pairs(s):
    """k = 1 of alpha by hand, at two lengths: the error falls as N^-4."""
    errors = []
    for length in (40, 80):
        q = s + s // 2
        formula = asymptotic_energy(ALPHA, tuple(range(1, s + 1)), q)
        numbers = {f"E{n}": 1 for n in range(1, s + 1)} | {"N": length}
        errors.append(abs(float(formula.subs(numbers)) / exact_energy(length, s, q) - 1))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=2 * SLOPE)


def factor(chain, s, k):
    """C_k(s) of E^(k) = C_k(s) (eps/M) lambda^k, as of lambda^(2k) for beta."""
    eps = se.Symbol("epsilon")
    unit = eps * N**4 / (pi * s) ** 4 if chain.alpha else eps**2 * N**4 / (pi * s) ** 4
    return se.expand(asymptotic_group_energy(chain, s, k, terms=1) / (eps * N / s * unit**k))


@pytest.mark.parametrize("chain", [ALPHA, BETA], ids=str)
@pytest.mark.parametrize("s", [1, 2, 3, 4])
def test_group_energies_scale_as_eksa_and_eksp(chain, s):
    """The powers of N, eps, s and the coupling are those of the paper; the factor is a rational number."""
    for k in (0, 1, 2):
        C = factor(chain, s, k)
        assert C.is_Number
        assert C > 0
        assert k or C == 1
        length, epsilon = 200, 1e-9
        formula = asymptotic_group_energy(chain, s, k, terms=1)
        typed = group_energy(chain.at(N=length), s, epsilon, k)
        typed_factor = (k + 0.5) ** 2 if chain.alpha else 1
        value = float(formula.subs({"N": length, "epsilon": epsilon}))
        assert value == pytest.approx(float(C) * float(typed) / typed_factor, rel=LIMIT_OF_LONG_CHAINS)


def test_factor_of_eksa_is_too_small():
    """(k + 1/2)^2 is 2.25 and 6.25; four seeds of equal energy at random phases have 19.2 and 54.3."""
    assert [round(float(factor(ALPHA, 4, k)), 1) for k in (1, 2)] == [19.2, 54.3]
    assert factor(ALPHA, 1, 3) == 16
    assert factor(BETA, 1, 2) == se.Rational(81, 4096)


PAGE = Path(__file__).parents[2] / "docs" / "asymptotics.md"
ROWS = [line.split("|")[1:-1] for line in PAGE.read_text().splitlines() if line.startswith("| ") and line[2].isdigit()]


@pytest.mark.long
@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"s={row[0].strip()}")
def test_factors_of_the_page(row):
    s, *printed = (cell.strip() for cell in row)
    cases = [(ALPHA, 1), (ALPHA, 2), (ALPHA, 3), (BETA, 1), (BETA, 2)]
    assert any(printed)
    for text, (chain, k) in zip(printed, cases, strict=True):
        if text:
            digits = len(text.replace(".", "").lstrip("0"))
            assert f"{float(factor(chain, int(s), k)):.{digits}g}" == f"{float(text):.{digits}g}"


def in_numbers(formula, **numbers):
    return float(formula.subs({se.Symbol(name): value for name, value in numbers.items()}).n(real=True))


PROFILES = [(ALPHA, 4, 1), (BETA, 4, 1), pytest.param(ALPHA, 4, 2, marks=pytest.mark.long)]


@pytest.mark.parametrize(("chain", "s", "k"), PROFILES, ids=str)
def test_profiles_are_eksa2_and_eksp2_with_the_derived_factor(chain, s, k):
    """log10 e_kappa at kappa = (k + 1/2) M, or 2k M, as printed, but for C_k(s)."""
    length, epsilon = 400, 1e-9
    line = profile_law(chain.at(N=length), s, epsilon)
    M = s / length
    kappa, printed = ((k + 0.5) * M, (k + 0.5) ** 2) if chain.alpha else (2 * k * M, 1)
    lam = epsilon / (math.pi * M) ** (4 if chain.alpha else 2)
    derived = in_numbers(asymptotic_profile(chain, s, k, terms=1), **{"lambda": lam, "M": M})
    excess = derived / math.log(10) - float(line(kappa))
    assert 10**excess == pytest.approx(float(factor(chain, s, k)) / printed, rel=LIMIT_OF_LONG_CHAINS)


@pytest.mark.parametrize("end", ["low", "high"])
def test_profiles_are_logarithms_of_energies(end):
    """Three powers of M^2: the error falls as M^6."""
    s, k, errors = 2, 1, []
    formula = asymptotic_profile(BETA, s, k, terms=3, end=end)
    for length in (20, 40):
        energy = asymptotic_group_energy(BETA, s, k, terms=8, end=end)
        exact = in_numbers(se.log(energy / (N * se.Symbol("epsilon"))), N=length, epsilon=1)
        M = s / length
        found = in_numbers(formula, **{"lambda": 1 / (math.pi * M) ** 2, "M": M})
        errors.append(abs(found - exact))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(6, abs=2 * SLOPE)


@pytest.mark.parametrize("k", range(1, 5))
def test_next_correction_of_one_seed(k):
    """-(5/24) k^2 pi^2 M^2, that of Eq. brelaw."""
    bend = asymptotic_profile(ALPHA, 1, k) - asymptotic_profile(ALPHA, 1, k, terms=1)
    assert se.expand(bend + se.Rational(5 * k**2, 24) * pi**2 * se.Symbol("M") ** 2) == 0


@pytest.mark.parametrize("s", [2, 5, pytest.param(16, marks=pytest.mark.long)])
def test_first_group_is_a_sum_over_pairs(s):
    """C_1(s) = 4 s^3 (4 sum over l < m, l + m = q, of 1/(l m)^2, and 1/l^4 for l = m): by hand, exactly."""
    q = s + s // 2
    pairs = [(a, q - a) for a in range(1, s + 1) if a <= q - a <= s]
    total = sum(Fraction(1 if a == b else 4, (a * b) ** 2) for a, b in pairs)
    C = 4 * s**3 * total
    assert factor(ALPHA, s, 1) == se.Rational(C.numerator, C.denominator)


def test_first_group_of_wide_packets():
    """C_1 = 256 log 2/27 + 64/9, an integral over pairs, where eksa has 9/4; what is left falls as 1/s."""
    limit, errors = 256 * math.log(2) / 27 + 64 / 9, []
    for s in (400, 800):
        q = s + s // 2
        squares = [1 / (a * (q - a)) ** 2 for a in range(s // 2, s + 1)]
        # ordered pairs, less half of the pair of equal seeds
        errors.append(8 * s**3 * sum(squares) - 12 * s**3 * (2 / q) ** 4 * (q % 2 == 0) - limit)
    assert errors[0] / errors[1] == pytest.approx(2, abs=SLOPE)


REFUSED = {
    "no seeds": lambda: asymptotic_group_energy(ALPHA, 0, 1),
    "a negative order": lambda: asymptotic_group_energy(ALPHA, 1, -1),
    "high packets of alpha": lambda: asymptotic_group_energy(ALPHA, 2, 1, end="high"),
    "another end": lambda: asymptotic_profile(ALPHA, 2, 1, end="middle"),
    "a number for N": lambda: asymptotic_profile(Chain(8, alpha=1), 1, 1),
    "other powers of epsilon": lambda: asymptotic_profile(Chain("N", potential="poly:0,0,1"), 1, 2),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_has_no_profile_is_refused(name):
    with pytest.raises(InputError):
        REFUSED[name]()
