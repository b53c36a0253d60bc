"""Certificates: what they prove is true, and what is not true they do not prove."""

import re
from dataclasses import replace
from fractions import Fraction

import flint
import mpmath
import numpy as np
import pytest

from symfpu import Chain, lindstedt, solve_amplitudes
from symfpu.series.tables import LOG10_2
from symfpu.tori.root_certificate import certify_root, frequency_balls
from tests.tolerances import ALLOWANCE_ESTIMATE, TEN_ROUNDINGS

DIGITS = 40

GOOD = {
    "alpha, one seed": (Chain(16, "0.33"), (1,), ("0.1963",), 12),
    "alpha, negative, two seeds": (Chain(16, "-0.33"), (1, 2), ("0.19626", "0.39046"), 8),
    "alpha, four seeds": (Chain(16, "0.3"), (1, 2, 3, 4), ("0.1962", "0.3907", "0.5812", "0.7661"), 4),
    "beta, one seed": (Chain(18, beta="0.6"), (5,), ("0.8482365235",), 12),
    "beta, negative": (Chain(8, beta="-0.3"), (3,), ("1.109",), 5),
    "beta, two seeds": (Chain(16, beta="0.3"), (1, 2), ("0.1964", "0.3909"), 4),
    "beta, four seeds": (Chain(16, beta="0.3"), (1, 2, 3, 4), ("0.1964", "0.3909", "0.5815", "0.7667"), 2),
    "both, two seeds": (Chain(8, "0.3", "0.1"), (1, 2), ("0.3905", "0.7663"), 6),
    "beta, two bonds": (Chain(2, beta="0.5"), (1,), ("1.45",), 10),
}


def torus_of(name, digits=DIGITS):
    chain, seeds, frequencies, order = GOOD[name]
    return solve_amplitudes(lindstedt(chain, seeds, frequencies, order, digits=digits))


@pytest.fixture(scope="module")
def tori():
    return {name: torus_of(name) for name in GOOD}


def squares_of(torus, factor=1):
    with mpmath.workdps(DIGITS + 40):
        return [a**2 * factor for a in torus.amplitudes.values()]


def inequality(reason):
    """The two numbers of 'the Newton step of A^2 is only bounded by ..., not below ...'."""
    found = re.fullmatch(r"seed (\d+): the Newton step of A\^2 is only bounded by (\S+), not below (\S+)", reason)
    assert found, reason
    return int(found[1]), float(found[2]), float(found[3])


@pytest.mark.parametrize("name", GOOD)
def test_good_roots_are_certified_to_the_asked_digits(name, tori):
    torus = tori[name]
    assert torus.origin.certificate.certified
    assert torus.origin.certificate.reason == ""
    assert "certified" in repr(torus)
    assert "not certified" not in repr(torus)
    for q, amplitude in torus.amplitudes.items():
        assert 0 < torus.origin.certificate.radius[q] <= abs(amplitude) * mpmath.mpf(10) ** -DIGITS


@pytest.mark.long
@pytest.mark.parametrize("name", GOOD)
def test_the_box_holds_the_root_of_twenty_more_digits(name, tori):
    torus, better = tori[name], torus_of(name, DIGITS + 20)
    with mpmath.workdps(DIGITS + 40):
        for q, amplitude in torus.amplitudes.items():
            assert abs(better.amplitudes[q] - amplitude) <= torus.origin.certificate.radius[q]


@pytest.mark.parametrize(("beta", "square"), [("0.5", "1/4"), ("3", "4/49"), ("-0.7", "2/3")])
def test_the_box_holds_the_exact_root_of_a_closed_form(beta, square):
    """N = 3, seed 1: Omega = 1 (Niven), so omega = 1 + (beta / 6) (3/8) C_1111 A^2 at order 1 with rational numbers only."""
    chain, square = Chain(3, beta=beta), Fraction(square)
    omega = 1 + chain.beta / 6 * Fraction(3, 8) * chain.C(1, 1, 1, 1) * square
    for digits in (5, 30, 200):
        torus = solve_amplitudes(lindstedt(chain, (1,), (omega,), 1, digits=digits))
        assert torus.origin.certificate.certified
        with mpmath.workdps(digits + 30):
            exact = mpmath.sqrt(mpmath.mpf(square.numerator) / square.denominator)
            assert abs(torus.amplitudes[1] - exact) <= torus.origin.certificate.radius[1]
            assert abs(torus.amplitudes[1] / exact - 1) < mpmath.mpf(10) ** -digits


def test_two_seeds_in_closed_form():
    """N = 3, both modes, beta, order 1: omega_q = Omega_q + (beta/6) Omega_q (3/8 Omega_q^2 C_q A_q^2 + 3/4 Omega_p^2 C_qp A_p^2)
    with Omega = 1, sqrt 3 and C_qqpp: linear in A^2, solved with mpmath."""
    chain = Chain(3, beta="0.4")
    frequencies = ("1.03", "1.79")
    torus = solve_amplitudes(lindstedt(chain, (1, 2), frequencies, 1, digits=DIGITS))
    with mpmath.workdps(DIGITS + 20):
        Omega = [mpmath.mpf(1), mpmath.sqrt(3)]
        slope = mpmath.matrix(2, 2)
        for i in range(2):
            for j in range(2):
                weight = (mpmath.mpf(3) / 8 if i == j else mpmath.mpf(3) / 4) * chain.C(i + 1, i + 1, j + 1, j + 1)
                slope[i, j] = mpmath.mpf(4) / 60 * Omega[i] * Omega[j] ** 2 * weight
        shift = mpmath.matrix([mpmath.mpf(w) - o for w, o in zip(frequencies, Omega, strict=True)])
        squares = mpmath.lu_solve(slope, shift)
        assert torus.origin.certificate.certified
        for q, square in zip((1, 2), squares, strict=True):
            assert abs(torus.amplitudes[q] - mpmath.sqrt(square)) <= torus.origin.certificate.radius[q]


@pytest.mark.parametrize("name", GOOD)
@pytest.mark.parametrize("sign", [1, -1])
def test_a_box_beside_the_root_is_not_certified(name, sign, tori):
    """Moved by twice the half width of the box in A^2: the Newton step leads out of it, and its size is stated."""
    torus = tori[name]
    with mpmath.workdps(DIGITS + 40):
        moved = squares_of(torus, 1 + sign * 2 * mpmath.mpf(10) ** -DIGITS)
    certificate = certify_root(torus.origin.series, moved, torus.origin.frequency_order)
    assert not certificate.certified
    seed, step, allowed = inequality(certificate.reason)
    assert seed in torus.seeds
    assert step == pytest.approx(2 * allowed, rel=ALLOWANCE_ESTIMATE)
    assert allowed == pytest.approx(float(torus.amplitudes[seed]) ** 2 * 10.0**-DIGITS, rel=ALLOWANCE_ESTIMATE)


@pytest.mark.parametrize("name", GOOD)
def test_coefficients_that_are_not_known_well_enough_certify_nothing(name, tori):
    """Radii of the corrections blown up to 10^-digits of one: the value at the root is no longer near zero for sure."""
    torus = tori[name]
    worse = 2.0 ** (torus.origin.series.bits - DIGITS / LOG10_2 + 10)
    radii = tuple((coordinate, (correction + 1) * worse) for coordinate, correction in torus.origin.series.radii)
    certificate = certify_root(replace(torus.origin.series, radii=radii), squares_of(torus), torus.origin.frequency_order)
    assert not certificate.certified
    _, step, allowed = inequality(certificate.reason)
    assert step >= allowed


def test_coefficients_that_are_not_known_at_all_leave_the_jacobian_singular(tori):
    series = tori["beta, one seed"].origin.series
    radii = tuple((coordinate, correction + 2.0 ** (series.bits + 20)) for coordinate, correction in series.radii)
    certificate = certify_root(replace(series, radii=radii), squares_of(tori["beta, one seed"]), series.order)
    assert not certificate.certified
    assert "singular" in certificate.reason


@pytest.mark.parametrize("name", ["alpha, negative, two seeds", "beta, one seed"])
def test_the_root_of_another_order_is_not_that_of_this_one(name, tori):
    torus = tori[name]
    earlier = solve_amplitudes(torus.origin.series, frequency_order=torus.origin.frequency_order - 2)
    assert earlier.origin.certificate.certified
    assert not certify_root(torus.origin.series, squares_of(earlier), torus.origin.frequency_order).certified


FOLD = "0.7019124369457541296273727234870801111276537902432932422214754496871057"


def at_the_fold():
    """Order 2 of a beta breather, c0 + c1 A^2 + c2 A^4 with c2 < 0, at the frequency that is its own maximum."""
    series = lindstedt(Chain(16, beta="0.3"), (3,), (FOLD,), 2, digits=DIGITS)
    with mpmath.workdps(DIGITS + 30):
        c0, c1, c2 = (series._frequency_polynomials[k][0][(k,)] for k in range(3))
        assert abs(c0 - c1**2 / (4 * c2) - mpmath.mpf(FOLD)) < mpmath.mpf(10) ** -(DIGITS + 5)
        return series, -c1 / (2 * c2)


def test_a_singular_jacobian_is_said_so():
    """At the maximum of omega(A^2) two roots meet: no box holds exactly one."""
    series, square = at_the_fold()
    certificate = certify_root(series, [square], 2)
    assert not certificate.certified
    assert certificate.reason == "the Jacobian may be singular within the box"
    assert certificate.radius[3] > 0


def test_a_box_with_two_roots_is_not_certified():
    """To one digit the box reaches over the maximum of omega(A^2) to the second root: a Newton step of zero proves nothing."""
    series, square = at_the_fold()
    with mpmath.workdps(DIGITS + 30):
        c0, c1, c2 = (series._frequency_polynomials[k][0][(k,)] for k in range(3))
        first, second = square * mpmath.mpf("0.97"), square * mpmath.mpf("1.03")
        omega = c0 + c1 * first + c2 * first**2
        assert abs(omega - (c0 + c1 * second + c2 * second**2)) < mpmath.mpf(10) ** -DIGITS
        wide = replace(series, digits=1, frequencies=(Fraction(mpmath.nstr(omega, 60)),))
    assert certify_root(replace(wide, digits=2), [first], 2).certified  # one per cent does not reach it
    certificate = certify_root(wide, [first], 2)
    assert not certificate.certified
    assert "singular" in certificate.reason


def test_a_double_root_is_found_but_not_certified():
    torus = solve_amplitudes(at_the_fold()[0])
    assert not torus.origin.certificate.certified
    assert torus.origin.certificate.reason
    assert "not certified" in repr(torus)


def test_doubles_have_no_certificate():
    torus = solve_amplitudes(lindstedt(Chain(8, beta="0.3"), (3,), ("1.113",), 3))
    assert torus.origin.certificate is None
    assert "certified" not in repr(torus)


@pytest.mark.long
@pytest.mark.parametrize("name", GOOD)
def test_balls_hold_the_coefficients_of_thirty_more_digits(name, tori):
    """mu^k omega_q^(k) as balls from few digits overlap those from many, and contain the latter's midpoints."""
    chain, seeds, frequencies, order = GOOD[name]
    few, many = tori[name].origin.series, lindstedt(chain, seeds, frequencies, order, digits=DIGITS + 30)
    with flint.ctx.workprec(many.bits + 100):
        for ours, theirs in zip(frequency_balls(few), frequency_balls(many), strict=True):
            for polynomial, better in zip(ours, theirs, strict=True):
                assert polynomial.keys() == better.keys()
                for key, value in polynomial.items():
                    assert value.contains(better[key].mid())
                    assert value.rad() > better[key].rad() or value.rad() == 0 or not any(key)


def test_balls_are_the_numbers_of_the_series(tori):
    series = tori["alpha, negative, two seeds"].origin.series
    point = [mpmath.mpf("0.3"), mpmath.mpf("0.2")]
    terms, _ = series.frequency_terms(np.array(point, dtype=object))
    with flint.ctx.workprec(series.bits):
        for k, row in enumerate(frequency_balls(series)):
            for i, polynomial in enumerate(row):
                value = sum((c * flint.arb(0.3) ** e[0] * flint.arb(0.2) ** e[1] for e, c in polynomial.items()), start=flint.arb(0))
                assert abs(float(value.mid()) - float(terms[k, i])) <= TEN_ROUNDINGS * max(1e-3, abs(float(terms[k, i])))
