"""Any number of digits from one end to the other: amplitudes against printed values, tori against doubles, bad input, memory."""

import itertools
import re
import subprocess
import sys
from fractions import Fraction

import flint
import mpmath
import numpy as np
import psutil
import pytest
import symengine as se
from symengine.lib.symengine_wrapper import RealMPFR

from symfpu.chain.chain import Chain
from symfpu.errors import InputError, TooLarge
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import amplitude_history, shifts, solve_amplitudes
from tests.oracles import mode_space
from tests.oracles.oscillators import cubic_oscillator, duffing
from tests.reference import BETA_BREATHER, MISPRINTED, PERIODIC_ORBITS, TWO_TORUS
from tests.tolerances import (
    AMPLITUDE_OF_TWENTY_EIGHT,
    DIFFERENCE_OF_DOUBLES,
    ENERGY_OF_FIFTY,
    LAST_DIGIT,
    LAST_PLACE,
    PERIODIC_ORBIT,
    PLACE_37,
    SAME_AS_DOUBLES,
    SHIFT_OF_TWENTY_EIGHT,
    TINY_RESIDUAL,
)

REFERENCES = [TWO_TORUS, BETA_BREATHER]
PRINTED = 40  # decimal places of the reference values

# --- a third route, beside the package and mode space: bond space over all bonds, balls, Kronecker's substitution


class BallSeries:
    """W_q^(k) of the design's section 3 in ball arithmetic, for one coupling; polynomials as univariate ones.

    z_1^p1 conj(z_1)^n1 z_2^p2 .. of degree d is x^(p1 + B n1 + B^2 p2 ..) with the last exponent left out, B > d.
    """

    def __init__(self, reference, order, bits=320):
        self.reference, self.order, self.bits = reference, order, bits
        self.chain = Chain(reference.N, reference.alpha, reference.beta)
        self.step = self.chain.degree_step
        self.base = 2 + self.step * order
        N, self.seeds = self.chain.N, reference.seeds
        with flint.ctx.workprec(bits):
            self.chosen = [flint.arb(flint.fmpq(*_ratio(w))) for w in reference.frequencies]
            self.linear = {q: 2 * flint.arb.sin_pi_fmpq(flint.fmpq(q, 2 * N)) for q in range(1, N)}
            self.cosines = [[flint.arb.cos_pi_fmpq(flint.fmpq(q * (2 * j + 1), 2 * N)) for q in range(1, N)] for j in range(N)]
            seeds = {q: flint.arb_poly([0]) for q in range(1, N)}
            for i, q in enumerate(self.seeds):
                for place in (2 * i, 2 * i + 1):
                    seeds[q] += self._monomial(place)
            self.u, self.W = [seeds], [[flint.arb_poly([1])] * len(self.seeds)]
            self.bonds = [self._on_bonds(seeds)]
            for k in range(1, order + 1):
                self._advance(k)

    def _monomial(self, place):
        exponent = self.base**place if place < 2 * len(self.seeds) - 1 else 0
        return flint.arb_poly([0] * exponent + [1])

    def _on_bonds(self, u):
        return [sum((u[q] * c for q, c in enumerate(row, 1)), start=flint.arb_poly([0])) for row in self.cosines]

    def _force(self, k):
        """-sum B u u = -(4/N) sum_j c_j^2 cos, or -sum C u u u = -(8/N) sum_j c_j^3 cos."""
        total = []
        for j in range(self.chain.N):
            c, zero = [bonds[j] for bonds in self.bonds], flint.arb_poly([0])
            if self.step == 1:
                total.append(sum((c[n] * c[k - 1 - n] for n in range(k)), start=zero) * 4)
            else:
                squares = [sum((c[a] * c[n - a] for a in range(n + 1)), start=zero) for n in range(k)]
                total.append(sum((squares[n] * c[k - 1 - n] for n in range(k)), start=zero) * 8)
        back = [[-x / self.chain.N for x in row] for row in self.cosines]
        parts = [[t * x for x in row] for t, row in zip(total, back, strict=True)]
        return {q: sum((part[q - 1] for part in parts), start=flint.arb_poly([0])) for q in self.linear}

    def _advance(self, k):
        right, degree = self._force(k), 1 + self.step * k
        corrections = []
        for i, q in enumerate(self.seeds):
            for n in range(1, k):
                right[q] += self.W[n][i] * self.u[k - n][q]
            corrections.append(flint.arb_poly([0]))
        u = {}
        for q, polynomial in right.items():
            coefficients = polynomial.coeffs()
            for exponent, value in enumerate(coefficients):
                if value == 0:
                    continue
                powers = self._exponents(exponent, degree)
                nu = tuple(powers[0::2][i] - powers[1::2][i] for i in range(len(self.seeds)))
                if q in self.seeds and nu in (unit := self._unit(q), tuple(-n for n in unit)):
                    if nu == unit:
                        i = self.seeds.index(q)
                        lowered = exponent - self.base ** (2 * i)
                        corrections[i] += flint.arb_poly([0] * lowered + [-value])
                    coefficients[exponent] = flint.arb(0)
                else:
                    coefficients[exponent] = value * self._multiplier(q, nu)
            u[q] = flint.arb_poly(coefficients)
        self.u.append(u)
        self.W.append(corrections)
        self.bonds.append(self._on_bonds(u))

    def _unit(self, q):
        return tuple(int(p == q) for p in self.seeds)

    def _exponents(self, exponent, degree):
        powers = []
        for _ in range(2 * len(self.seeds) - 1):
            exponent, digit = divmod(exponent, self.base)
            powers.append(digit)
        return (*powers, degree - sum(powers))

    def _multiplier(self, q, nu):
        own = self.chosen[self.seeds.index(q)] if q in self.seeds else self.linear[q]
        drive = sum((n * w for n, w in zip(nu, self.chosen, strict=True)), start=flint.arb(0))
        divisor = own**2 - drive**2
        return self.linear[q] ** 2 / divisor if not divisor.contains(0) else self._never(q, nu)

    def _never(self, q, nu):
        """A coefficient that is zero but not exactly so as a ball, at a divisor that vanishes, would end here."""
        raise AssertionError((q, nu))

    def mismatch(self, amplitudes, K):
        """Truncated omega_q minus the chosen one for every seed, as balls, at balls of amplitudes."""
        chain = self.chain
        mu = flint.arb(flint.fmpq(*_ratio(self.reference.alpha))) / flint.arb(2 * chain.N).sqrt() if self.step == 1 else None
        mu = mu if mu is not None else flint.arb(flint.fmpq(*_ratio(self.reference.beta))) / (2 * chain.N)
        w = [self.linear[q] * a / 2 for q, a in zip(self.seeds, amplitudes, strict=True)]
        result = []
        for i, q in enumerate(self.seeds):
            squares = [mu**k * self.linear[q] ** 2 * self._value(self.W[k][i], self.step * k, w) for k in range(K + 1)]
            omega = [self.linear[q]]
            for k in range(1, K + 1):
                known = sum((omega[j] * omega[k - j] for j in range(1, k)), start=flint.arb(0))
                omega.append((squares[k] - known) / (2 * self.linear[q]))
            result.append(sum(omega, start=flint.arb(0)) - self.chosen[i])
        return result

    def _value(self, polynomial, degree, w):
        total = flint.arb(0)
        for exponent, value in enumerate(polynomial.coeffs()):
            if value == 0:  # a ball about zero is not equal to zero, and stays
                continue
            powers = self._exponents(exponent, degree)
            term = value
            for i, x in enumerate(w):
                term = term * x ** (powers[2 * i] + powers[2 * i + 1])
            total += term
        return total


def _ratio(text):
    value = Fraction(text)
    return value.numerator, value.denominator


def near(balls, K):
    """The root of the ball series near the given amplitudes, as mpf."""
    reference = balls.reference

    def equations(*point):
        with flint.ctx.workprec(balls.bits):
            return [_middle(f) for f in balls.mismatch([_exact(x) for x in point], K)]

    with mpmath.workdps(70):
        start = [mpmath.mpf(float(a)) for a in reference.amplitudes[K]]
        return list(mpmath.findroot(equations, start, solver="mdnewton", tol=1e-120))


def _middle(ball):
    assert ball.rad() < flint.arb(2) ** -200
    mantissa, exponent = ball.mid().man_exp()
    return mpmath.ldexp(int(mantissa), int(exponent))


def _exact(x):
    mantissa, exponent = int(x.man) * (-1 if x < 0 else 1), int(x.exp)
    return flint.arb(mantissa) * flint.arb(2) ** exponent


def right(text):
    """A reference value, or what should have been printed in its place."""
    return MISPRINTED.get(text, text)


def series_of(reference, digits, order=None):
    chain = Chain(reference.N, reference.alpha, reference.beta)
    return lindstedt(chain, reference.seeds, reference.frequencies, order or max(reference.amplitudes), digits=digits)


def close(ours, printed):
    with mpmath.workdps(80):
        return all(abs(a - mpmath.mpf(right(text))) <= LAST_PLACE for a, text in zip(ours, printed, strict=True))


@pytest.mark.parametrize(
    "reference",
    [pytest.param(REFERENCES[0], id="alpha, 2-torus", marks=pytest.mark.long), pytest.param(REFERENCES[1], id="beta, breather")],
)
def test_printed_amplitudes_are_met_to_their_last_digit(reference):
    """All seven strings to all 40 places, but the two misprinted ones, which ours differ from in the 23rd place."""
    series = series_of(reference, 45)
    history = amplitude_history(series)
    for K, printed in reference.amplitudes.items():
        torus = solve_amplitudes(series, frequency_order=K)
        assert torus.certificate.certified
        assert close(torus.amplitudes.values(), printed)
        assert close(history.amplitudes[K], printed)
        for q, text in zip(reference.seeds, printed, strict=True):
            equal = [a == b for a, b in zip(mpmath.nstr(torus.amplitudes[q], 50), text, strict=False)]
            common = (equal.index(False) if False in equal else len(text)) - len("0.")
            assert common == 22 if text in MISPRINTED else common >= PRINTED - 2


def test_both_misprints_are_slips_of_one_place():
    """Without the three inserted digits, and with one digit replaced, the printed strings are ours."""
    (first, ours), (second, theirs) = MISPRINTED.items()
    with mpmath.workdps(60):
        assert abs(mpmath.mpf(first[:24] + first[27:]) - mpmath.mpf(ours)) < PLACE_37
    assert [i for i, (a, b) in enumerate(zip(second, theirs, strict=True)) if a != b] == [24]


@pytest.mark.parametrize(
    ("reference", "K"),
    [(BETA_BREATHER, 12), (BETA_BREATHER, 6), (BETA_BREATHER, 1), (TWO_TORUS, 4), pytest.param(TWO_TORUS, 12, marks=pytest.mark.long)],
    ids=["beta 12", "beta 6", "beta 1", "alpha 4", "alpha 12"],
)
def test_balls_on_all_bonds_give_the_same_roots(reference, K):
    """Nothing of the package but the chain's numbers: the right strings are met, the misprinted ones are not."""
    series = BallSeries(reference, K)
    assert close(near(series, K), reference.amplitudes[K])
    with flint.ctx.workprec(series.bits):
        printed = [flint.arb(text) for text in reference.amplitudes[K]]
        misses = [abs(f) for f in series.mismatch(printed, K)]
        wrong = any(text in MISPRINTED for text in reference.amplitudes[K])
        assert any(f > flint.arb("1e-28") for f in misses) == wrong
        assert all(f < flint.arb("1e-40") for f in misses) != wrong


def test_the_misprinted_breather_is_refuted_by_signs():
    """omega(A) - omega in balls changes its sign between our last place and the next; at the printed number it does not."""
    series = BallSeries(BETA_BREATHER, 12)
    (printed,) = BETA_BREATHER.amplitudes[12]
    with flint.ctx.workprec(series.bits):
        place = flint.arb("1e-40")
        ours, theirs = flint.arb(flint.fmpq(int(right(printed)[2:]), 10**40)), flint.arb(flint.fmpq(int(printed[2:]), 10**40))
        below, above, there = (series.mismatch([a], 12)[0] for a in (ours - place, ours + place, theirs - place))
        assert below < 0 < above < there


@pytest.mark.long
@pytest.mark.parametrize("reference", REFERENCES, ids=["alpha, 2-torus", "beta, breather"])
def test_mode_space_gives_the_same_roots(reference, monkeypatch):
    """Eqs. moda and modb as printed, at 60 digits: two minutes."""
    monkeypatch.setattr(mode_space, "DIGITS", 60)
    slow = mode_space.ModeSpaceSeries(reference.N, reference.alpha, reference.beta, reference.seeds, reference.frequencies, 12)
    with mpmath.workdps(60):
        chain = Chain(reference.N, reference.alpha, reference.beta)
        mu = mpmath.mpf(reference.alpha) / mpmath.sqrt(2 * chain.N) if chain.alpha else mpmath.mpf(reference.beta) / (2 * chain.N)

        def equations(*A):
            total = [-mpmath.mpf(w) for w in reference.frequencies]
            for i, q in enumerate(reference.seeds):
                for k in range(13):
                    for (powers, _), value in slow.omega[q][k].items():
                        total[i] += value * mu**k * mpmath.fprod(a**e for a, e in zip(A, powers, strict=True))
            return total

        start = [mpmath.mpf(float(a)) for a in reference.amplitudes[12]]
        assert close(mpmath.findroot(equations, start, solver="mdnewton", tol=1e-100), reference.amplitudes[12])


@pytest.mark.long
def test_balls_of_order_twenty_give_the_same_roots():
    assert close(near(BallSeries(TWO_TORUS, 20), 20), TWO_TORUS.amplitudes[20])


@pytest.mark.long
@pytest.mark.parametrize("orbit", PERIODIC_ORBITS, ids=lambda o: f"seed {o.seed}")
def test_breathers_are_the_periodic_orbits(orbit):
    torus = solve_amplitudes(lindstedt(Chain(orbit.N, orbit.alpha), (orbit.seed,), (orbit.frequency,), orbit.order, digits=20))
    assert torus.certificate.certified
    assert float(torus.amplitudes[orbit.seed]) == pytest.approx(orbit.amplitude, rel=PERIODIC_ORBIT)
    assert float(torus.energy()) == pytest.approx(orbit.energy, rel=PERIODIC_ORBIT)


@pytest.mark.long
def test_a_one_mode_reduction_converges_to_the_elliptic_functions():
    """N = 2, beta: x'' + 2 x + beta x^3 at 30 digits: each order gains a factor of 25 and more, to the last digits of the oracle."""
    with mpmath.workdps(30):
        chain = Chain(2, beta="0.5")
        omega, amplitude = duffing(mpmath.mpf(2), mpmath.mpf("0.125") * 4 * chain.C(1, 1, 1, 1), mpmath.mpf("0.3"))
        series = lindstedt(chain, (1,), (mpmath.nstr(omega, 30),), 16, digits=28)
        errors = [abs(solve_amplitudes(series, frequency_order=K).amplitudes[1] / amplitude - 1) for K in range(1, 17)]
    assert all(b < a / 25 for a, b in itertools.pairwise(errors))
    assert errors[-1] < AMPLITUDE_OF_TWENTY_EIGHT


def test_the_cubic_oscillator_to_many_digits():
    """N = 3, seed 2, alpha."""
    with mpmath.workdps(30):
        chain = Chain(3, "0.4")
        quadratic = mpmath.mpf("0.4") / mpmath.sqrt(6) * mpmath.sqrt(3) ** 3 * chain.B(2, 2, 2)
        omega, amplitude = cubic_oscillator(mpmath.mpf(3), quadratic, mpmath.mpf("0.01"))
        torus = solve_amplitudes(lindstedt(chain, (2,), (mpmath.nstr(omega, 30),), 16, digits=28))
        assert abs(torus.amplitudes[2] / amplitude - 1) < SHIFT_OF_TWENTY_EIGHT  # omega - Omega, some 1e-7, is known to 28 places


# --- tori of many digits against those of doubles

PAIRS = {
    "both, phases": (Chain(8, "0.3", "0.1"), (1, 2), ("0.3905", "0.7663"), 6, {1: "0.4", 2: "-1.3"}),
    "alpha": (Chain(9, "-0.3"), (1, 3), ("0.348", "1.001"), 6, {}),
    "beta": (Chain(8, beta="0.3"), (3,), ("1.113",), 5, {3: "0.7"}),
    "beta, negative": (Chain(7, beta="-0.3"), (2, 5), ("0.8648", "1.7958"), 3, {5: "2"}),
    "two bonds": (Chain(2, beta="0.5"), (1,), ("1.43",), 6, {}),
}


@pytest.fixture(scope="module", params=PAIRS)
def pair(request):
    chain, seeds, frequencies, order, phases = PAIRS[request.param]
    return [solve_amplitudes(lindstedt(chain, seeds, frequencies, order, digits=d), phases=phases) for d in (40, None)]


def same(many, few):
    many, few = np.asarray(many), np.asarray(few)
    assert many.shape == few.shape
    assert many.dtype == object or many.size == 0
    assert np.abs(many.astype(float) - few).max(initial=0.0) <= SAME_AS_DOUBLES * np.abs(few).max(initial=0.0)


@pytest.mark.parametrize("t", [0.0, 3.7, [0.0, 1.0, 20.0], [], [5]], ids=str)
def test_orbits_and_energies_are_those_of_doubles(pair, t):
    many, few = pair
    for name in ("positions", "momenta", "harmonic_energies"):
        same(getattr(many, name)(t), getattr(few, name)(t))
    same(many.energy(t), few.energy(t))


def test_amplitudes_averages_and_residuals_are_those_of_doubles(pair):
    many, few = pair
    same(list(many.amplitudes.values()), list(few.amplitudes.values()))
    same(many.average_spectrum(), few.average_spectrum())
    assert np.allclose(many.average_spectrum(17.0), few.average_spectrum(17.0), rtol=SAME_AS_DOUBLES)
    assert many.residual(5) == pytest.approx(
        few.residual(5), rel=DIFFERENCE_OF_DOUBLES, abs=LAST_DIGIT
    )  # the doubles cancel down to rounding
    assert (many.harmonics == few.harmonics).all()
    same(many.cosines, few.cosines)
    assert many.frequency_order == few.frequency_order
    assert many.history.keys() == few.history.keys()
    for K, amplitudes in many.history.items():
        assert [float(a) for a in amplitudes] == pytest.approx(few.history[K], rel=SAME_AS_DOUBLES)


def test_history_and_shifts_are_mpf(pair):
    many, few = pair
    same(shifts(many.series), shifts(few.series))
    for differences in amplitude_history(many.series).differences().values():
        assert all(isinstance(d, float) for d in differences)


def test_the_energy_is_that_of_the_state(pair):
    many, _ = pair
    Q, P = many.positions(1.5), many.momenta(1.5)
    with mpmath.workdps(50):
        assert abs(many.chain.energy(Q, P) / many.energy(1.5) - 1) < ENERGY_OF_FIFTY


@pytest.mark.long
@pytest.mark.parametrize(
    ("chain", "seeds", "frequencies", "order"),
    [
        (Chain(8, beta="0.3"), (3,), ("1.111145",), 8),
        (Chain(8, "0.1"), (1,), ("0.390181",), 16),
        (Chain(8, beta="0.1"), (1, 3), ("0.390182", "1.1111443"), 7),
    ],
    ids=str,
)
def test_small_tori_solve_the_equations_of_motion_far_beyond_doubles(chain, seeds, frequencies, order):
    """No integration: second derivatives against forces on a grid of angles; and each order gains its share."""
    torus = solve_amplitudes(lindstedt(chain, seeds, frequencies, order, digits=40))
    assert torus.certificate.certified
    assert torus.residual() < TINY_RESIDUAL
    with mpmath.workdps(50):
        assert abs(torus.energy_error(1.0)) < 10 * TINY_RESIDUAL
    residuals = [solve_amplitudes(torus.series, order=k).residual() for k in range(1, order + 1)]
    fall = [b / a for a, b in itertools.pairwise(residuals)]
    assert max(fall) < 0.2


@pytest.mark.parametrize("digits", [20, 40, 100])
def test_expressions_hold_numbers_of_all_digits(digits):
    """term, frequency_correction and squared_frequency_correction at numbers, against harmonic_terms and frequency_terms."""
    chain, A = Chain(8, "-0.3", "0.2"), {1: "0.31", 2: "0.17"}
    series, doubles = (lindstedt(chain, (1, 2), ("0.395", "0.775"), 4, digits=d) for d in (digits, None))
    angles = {"theta1": "0.7", "theta2": "-1.9"}
    values = {se.Symbol(f"A{q}"): a for q, a in A.items()} | {se.Symbol(n): a for n, a in angles.items()}
    values = {name: se.Float(text, dps=digits + 20) for name, text in values.items()}
    with mpmath.workdps(digits + 20):
        theta = np.array([mpmath.mpf(a) for a in angles.values()], dtype=object)
        mu = mpmath.mpf("-0.3") / 4
        frequencies, _ = series.frequency_terms([mpmath.mpf(a) ** 2 for a in A.values()])
        for k in range(5):
            nu, cosines = series.harmonic_terms([mpmath.mpf(a) for a in A.values()], k)
            expected = np.array([mpmath.cos(x) for x in nu @ theta], dtype=object) @ cosines
            for q in range(1, 8):
                term = se.sympify(series.term(q, k))
                assert all(isinstance(x, RealMPFR) for x in term.atoms(se.Float))
                ours = mu**k * mpmath.mpf(str(term.subs(values).n(int(3.33 * digits) + 60, real=True)))
                assert abs(ours - expected[q - 1]) <= mpmath.mpf(10) ** (1 - digits) * abs(cosines).max()
                exponents, coefficients = series.coefficients(q, k)
                few = doubles.coefficients(q, k)
                assert (exponents == few[0]).all()
                same(coefficients, few[1])
            for i, q in enumerate((1, 2)):
                correction = se.sympify(series.frequency_correction(q, k)).subs(values).n(int(3.33 * digits) + 60, real=True)
                ours = mu**k * mpmath.mpf(str(correction))
                assert abs(ours - frequencies[k, i]) <= mpmath.mpf(10) ** (1 - digits)
                same(series.frequency_coefficients(q, k)[1], doubles.frequency_coefficients(q, k)[1])
                same(series.frequency_coefficients(q, k, squared=True)[1], doubles.frequency_coefficients(q, k, squared=True)[1])


def test_absolute_sums_are_those_of_doubles():
    chain = Chain(8, "-0.3", "0.2")
    series, doubles = (lindstedt(chain, (1, 2), ("0.395", "0.775"), 4, digits=d) for d in (30, None))
    for ours, theirs in zip(series.absolute_sums(3, [0.31, 0.17]), doubles.absolute_sums(3, [0.31, 0.17]), strict=True):
        assert np.allclose(ours, theirs, rtol=SAME_AS_DOUBLES)


# --- bad input


@pytest.mark.parametrize("digits", [0, -1, 2.5, True, "40", 10**9, 10_001, float("nan"), [40], 1j], ids=str)
def test_digits_that_are_none_are_refused_by_name(digits):
    with pytest.raises(InputError) as caught:
        lindstedt(Chain(8, "0.3"), (1,), ("0.39",), 2, digits=digits)
    assert caught.value.argument == "digits"
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("options", "argument"),
    [
        ({"ring": "float64", "frequencies": ("0.39",)}, "ring"),
        ({"ring": "symbolic"}, "ring"),
        ({}, "frequencies"),
        ({"frequencies": ("0.39", "0.7")}, "frequencies"),
        ({"frequencies": ("0.39",), "order": -1}, "order"),
    ],
    ids=str,
)
def test_digits_go_with_frequencies_and_without_a_ring(options, argument):
    with pytest.raises(InputError) as caught:
        lindstedt(Chain(8, "0.3"), (1,), **{"order": 2, **options}, digits=40)
    assert caught.value.argument == argument
    assert "\n" not in str(caught.value)


LARGE = {"chain": Chain(32, "0.3"), "seeds": (1, 2, 3), "frequencies": ("0.0982", "0.1961", "0.2935")}


def test_what_cannot_fit_is_refused_before_anything_is_allocated(monkeypatch):
    """With a gigabyte free the doubles of order 12 fit, 200 digits of them do not; the advised order does."""

    class Memory:
        available = 10**9

    monkeypatch.setattr(psutil, "virtual_memory", lambda: Memory)
    monkeypatch.setattr(sys.modules["symfpu.series.monomials"], "shared_grading", lambda *_, **__: pytest.fail("monomials were made"))
    with pytest.raises(TooLarge) as caught:
        lindstedt(**LARGE, order=14, digits=200)
    error = caught.value
    assert error.order == 14
    assert 0 < error.largest < 14
    assert error.needed > error.free == 10**9
    assert "\n" not in str(error)
    with pytest.raises(pytest.fail.Exception, match="monomials"):
        lindstedt(**LARGE, order=error.largest, digits=200)
    with pytest.raises(pytest.fail.Exception, match="monomials"):
        lindstedt(**LARGE, order=14)


def test_ten_thousand_digits_of_a_long_series_are_refused_at_once():
    with pytest.raises(TooLarge):
        lindstedt(**LARGE, order=30, digits=10_000)


MEASURE = """
from pathlib import Path
from symfpu.chain.chain import Chain
from symfpu.series.lindstedt import lindstedt
from symfpu.series.memory import _needed
chain, seeds, order, digits = Chain({N}, {alpha!r}, {beta!r}), {seeds}, {order}, {digits}
peak = lambda: int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]) * 1024
lindstedt(chain, seeds, {frequencies}, 1, digits=digits)  # the machine code is loaded
before = peak()
lindstedt(chain, seeds, {frequencies}, order, digits=digits)
print(peak() - before, _needed(chain, len(seeds), order, "fixedpoint", digits))
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the peak of a process from /proc")
@pytest.mark.parametrize(
    "case",
    [
        {"N": 16, "alpha": "0.33", "beta": "0", "seeds": (1, 2, 3), "order": 10, "digits": 60},
        {"N": 16, "alpha": "0.33", "beta": "0.1", "seeds": (1, 2, 3), "order": 12, "digits": 10},
        {"N": 32, "alpha": "0.33", "beta": "0", "seeds": (1,), "order": 120, "digits": 10},
        {"N": 16, "alpha": "0.33", "beta": "0", "seeds": (1, 2), "order": 24, "digits": 50},
    ],
    ids=lambda c: f"N={c['N']} order {c['order']} digits {c['digits']}",
)
@pytest.mark.long
def test_the_predicted_memory_is_an_upper_bound(case):
    """Peak of a process of its own, less what it had before."""
    frequencies = {16: ("0.19626", "0.39046", "0.581"), 32: ("0.0984",)}[case["N"]][: len(case["seeds"])]
    script = MEASURE.format(**case, frequencies=frequencies)
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    measured, predicted = map(int, re.findall(r"\d+", result.stdout))
    assert 10**7 < measured <= predicted
