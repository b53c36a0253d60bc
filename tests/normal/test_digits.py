"""Normal frequencies in many digits: Floquet multipliers by Taylor series, Toda's exact ones, the series of a phantom seed."""

from functools import cache

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, NoNormalModes, normal_modes, refine, toda
from symfpu.normal import digits as normal_digits
from symfpu.refinement import iterative_refinement
from symfpu.refinement.iterative_refinement import Failure
from tests.normal import cases
from tests.tolerances import NORMAL_CONVERGED, NORMAL_VARIATION, OBSERVED_ORDER

HYPERBOLIC = Chain(8, beta=1), ((1, "0.1"), (5, "0.7"))
# of the torus of 50 digits, 1074 harmonics; the issue has 1.577380 +- 0.035136 i
SIGMA_4 = "1.57738003613099878949746504259083203189511881292963"
GROWTH_4 = "0.035136143270181357980215832942368939678481634372013"


@cache
def torus(chain, amplitudes, digits, order=6):
    return refine(cases.torus(chain, amplitudes, order), amplitudes=dict(amplitudes), digits=digits)


def small(digits=20):
    return torus(Chain(4, alpha="0.3", beta="0.2"), ((1, "0.1"), (3, "0.05")), digits, 4)


@cache
def small_modes():
    return normal_modes(small())


def below(difference, digits):
    return abs(difference) < mpmath.mpf(10) ** -digits


class TaylorChain:
    """A chain of fixed ends with V = r^2/2 + alpha r^3/3 and its variations, by power series in t, in particle coordinates."""

    ORDER = 40

    def __init__(self, N, alpha, columns):
        self.N, self.alpha, self.columns = N, mpmath.mpf(alpha), columns

    def step(self, x, v, h):
        """x, v : (1 + columns, N-1), the orbit and its variations; the same after the time h."""
        xs, vs = [x], [v]
        for k in range(self.ORDER):
            xs.append(vs[k] / (k + 1))
            vs.append(self._acceleration(xs[: k + 1]) / (k + 1))
        powers = [h**k for k in range(self.ORDER + 1)]
        return sum(a * p for a, p in zip(xs, powers, strict=True)), sum(a * p for a, p in zip(vs, powers, strict=True))

    def _acceleration(self, xs):
        """The coefficient of t^k of all accelerations, from those of positions up to k."""
        walls = np.zeros((len(xs[0]), 1), dtype=object)
        r = [np.diff(np.hstack([walls, x, walls]), axis=1) for x in xs]
        square = sum(a[0] * b for a, b in zip(r, reversed(r), strict=True))
        factor = np.array([self.alpha, *[2 * self.alpha] * self.columns], dtype=object)
        return np.diff(r[-1] + factor[:, None] * square, axis=1)


def monodromy_by_taylor(orbit, alpha, steps):
    """The map of variations over a period of an orbit that starts at rest, (2(N-1), 2(N-1))."""
    N, digits = orbit.chain.N, orbit.digits
    with mpmath.workdps(digits + 10):
        n = N - 1
        chain = TaylorChain(N, alpha, 2 * n)
        modes = np.array([[mpmath.sqrt(mpmath.mpf(2) / N) * mpmath.sinpi(mpmath.mpf(q * k) / N) for k in range(1, N)] for q in range(1, N)])
        one, zero = np.vectorize(mpmath.mpf)(np.eye(n).astype(object)), np.full((n, n), mpmath.mpf(0))
        x = np.vstack([orbit.Q(0) @ modes, one, zero])
        v = np.vstack([np.full((1, n), mpmath.mpf(0)), zero, one])
        omega = orbit.frequency
        h = 2 * mpmath.pi * omega.denominator / omega.numerator / steps
        for _ in range(steps):
            x, v = chain.step(x, v, h)
        return mpmath.matrix(np.hstack([x[1:], v[1:]]).tolist())


@pytest.mark.long
@pytest.mark.parametrize("amplitude", ["0.3", "1"], ids=["stable", "unstable"])
def test_of_a_breather_they_are_the_multipliers_of_its_monodromy_to_all_digits(amplitude):
    chain = Chain(4, alpha="0.5")
    orbit = refine(symfpu.torus(chain, (2,), amplitudes={2: amplitude}), digits=26, amplitudes={2: amplitude})
    found = normal_modes(orbit)
    assert found.stable == (amplitude == "0.3")
    monodromy = monodromy_by_taylor(orbit, "0.5", 24)
    with mpmath.workdps(36):
        unit = mpmath.eye(monodromy.rows)
        for value in found.multipliers().values():
            for multiplier in (value, 1 / value, mpmath.conj(value)):
                assert below(mpmath.det(monodromy - multiplier * unit), 22)
                assert not below(mpmath.det(monodromy - 1.0001 * multiplier * unit), 7)


@pytest.mark.parametrize("digits", [18, pytest.param(35, marks=pytest.mark.long)])
def test_todas_are_those_of_its_spectral_curve_to_all_digits(digits):
    solution = torus(Chain(4, potential=toda("1/2")), ((1, "0.2"), (3, "0.1")), digits, 4)
    exact = symfpu.toda_torus(solution.chain, (1, 3), frequencies=solution.frequencies, digits=digits + 5).normal_frequencies
    found = normal_modes(solution)
    assert found.frequencies.keys() == exact.keys()
    with mpmath.workdps(digits + 10):
        assert all(below(found.frequencies[q] - w, digits - 1) for q, w in exact.items())


@pytest.mark.long
@pytest.mark.parametrize("digits", [30, 45])
def test_a_hyperbolic_one_has_its_digits_whatever_the_truncation(digits):
    found = normal_modes(torus(*HYPERBOLIC, digits), modes=(4,))
    mode = found.mode(4)
    sigma, growth = mode.sigma.real, mode.growth  # at the precision of mpmath as it stands
    with mpmath.workdps(60):
        assert below(sigma - mpmath.mpf(SIGMA_4), digits)
        assert below(growth - mpmath.mpf(GROWTH_4), digits)
        assert below(mode.error, digits)
    assert mode.kind == "hyperbolic"


@pytest.mark.long
def test_the_series_of_a_phantom_seed_misses_its_next_power():
    chain = Chain(4, alpha="0.3", beta="0.2")
    left = []
    for scale in (1, 2):
        solution = torus(chain, ((1, f"{scale * 1e-4:.4f}"), (3, f"{scale * 2e-4:.4f}")), 40, 4)
        series = symfpu.solve_normal_frequency(solution, 2, 4, digits=40)
        with mpmath.workdps(50):
            left.append(abs(series.sigma - normal_modes(solution).frequencies[2]))
    assert below(left[0], 22)
    assert float(mpmath.log(left[1] / left[0], 2)) == pytest.approx(6, abs=OBSERVED_ORDER)


@pytest.mark.long
def test_doubles_near_a_collision_say_what_digits_say_or_that_they_do_not_know():
    """2 sigma_1 = omega, hyperbolic from A_2 = 0.770623247525 on (docs/normal-modes.md)."""
    chain, words = Chain(4, alpha="0.5"), {}
    for part in ("-1e-11", "-1e-13", "1e-13", "1e-11"):
        amplitude = mpmath.nstr(mpmath.mpf("0.770623247525") + mpmath.mpf(part), 16)
        breather = symfpu.torus(chain, (2,), amplitudes={2: amplitude})
        words[part] = normal_modes(breather, modes=[1]).stable
        if part.endswith("11"):
            exact = normal_modes(refine(breather, digits=25, amplitudes={2: amplitude}), modes=[1])
            assert exact.stable is words[part]
            assert exact.undecided == ()
    assert words == {"-1e-11": True, "-1e-13": None, "1e-13": None, "1e-11": False}


def test_an_undecided_verdict_says_so():
    breather = symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: "0.7706232475251"})
    found = normal_modes(breather, modes=[1])
    assert found.undecided == (1,)
    assert found.verdict.startswith("undecided: modes 1, nearer to a collision than")


def test_sizes_and_digits_agree_with_doubles():
    found, doubles = small_modes(), normal_modes(small().in_doubles())
    assert (found.digits, doubles.digits) == (20, None)
    for one, other in zip(found.modes, doubles.modes, strict=True):
        assert one.in_doubles().sigma == pytest.approx(other.sigma, rel=NORMAL_CONVERGED)
        assert float(one.action) == pytest.approx(other.action, rel=NORMAL_VARIATION)
        with mpmath.workdps(30):
            assert below(sum(x**2 for x in one.coefficients.flat) - 1, 20)
        assert below(one.error, 20)
        assert below(one.residual, 18)
        assert one.coefficients[0, one.mode - 1] > 0


@pytest.mark.long
def test_steps_that_gain_nothing_are_named(monkeypatch):
    torus = small(40)
    monkeypatch.setattr(iterative_refinement, "MOST_STEPS", 1)
    with pytest.raises(NoNormalModes, match=r"no 40 digits.*refinement stops.*in_doubles"):
        normal_modes(torus)


def test_one_mode_without_digits_does_not_lose_the_others(monkeypatch):
    refined = normal_digits.PreciseModes.refined

    def stopped(modes, mode, tell):
        if mode.mode == 3:
            raise Failure("no more")
        return refined(modes, mode, tell)

    orbit = refine(symfpu.torus(Chain(4, beta=1), (2,), amplitudes={2: "0.1"}), digits=20)
    whole = normal_modes(orbit)
    assert whole.frequencies.keys() == {1, 3}
    monkeypatch.setattr(normal_digits.PreciseModes, "refined", stopped)
    found = normal_modes(orbit)
    assert found.missing.keys() == {3}
    assert "no 20 digits of its frequency: no more" in found.missing[3]
    assert found.frequencies == {1: whole.frequencies[1]}
    with pytest.raises(NoNormalModes, match="no more"):
        normal_modes(orbit, modes=[1, 3])


def test_more_harmonics_are_taken_where_some_are_missing(monkeypatch):
    fitted = normal_digits.fitted_harmonics

    def fewer(torus):
        every = fitted(torus)
        return every[np.abs(every).sum(axis=1) <= 0.6 * np.abs(every).sum(axis=1).max()]

    monkeypatch.setattr(normal_digits, "fitted_harmonics", fewer)
    found = normal_modes(small(), modes=[2])
    with mpmath.workdps(30):
        assert below(found.frequencies[2] - small_modes().frequencies[2], 20)
