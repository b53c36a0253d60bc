"""Series with free amplitudes for the tests of every language, and their values by another route at many digits."""

from fractions import Fraction
from functools import cache

import mpmath
import numpy as np

from symfpu import Chain, FromSeries, Torus, lindstedt
from symfpu.codegen.series_program import series_facts, series_program
from symfpu.codegen.straight_line import STRAIGHT_LINE
from tests.tolerances import OF_LARGEST, OF_TAIL

DIGITS = 40

# chain, seeds, frequencies of the divisors (exact in doubles), order, frequency order
CASES = {
    "alpha, one seed": (Chain(8, alpha="0.3"), (1,), ("0.390625",), 8, 8),
    "alpha, two seeds": (Chain(16, alpha="0.33"), (1, 2), ("0.1962890625", "0.390625"), 6, 4),
    "mixed, three seeds": (Chain(8, alpha="0.3", beta="0.1"), (1, 2, 5), ("0.390625", "0.765625", "1.671875"), 4, 2),
    "beta, four seeds": (Chain(10, beta="0.5"), (1, 3, 6, 9), ("0.3125", "0.90625", "1.625", "1.984375"), 2, 2),
    "alpha, five seeds": (
        Chain(12, alpha="-0.2"),
        (1, 2, 3, 4, 5),
        ("0.26171875", "0.517578125", "0.767578125", "1.00390625", "1.2216796875"),
        3,
        3,
    ),
    "one mode": (Chain(2, alpha="0.2", beta="0.3"), (1,), ("1.421875",), 7, 6),
    "wrapped modes": (Chain(4, alpha="0.3"), (2, 3), ("1.421875", "1.859375"), 4, 4),
    "one parity only": (Chain(9, beta="0.6"), (5,), ("1.546875",), 5, 3),
    "order 0": (Chain(6, alpha="0.25"), (2, 3), ("1.0078125", "1.4296875"), 0, 0),
    "high order": (Chain(8, alpha="0.25"), (3,), ("1.109375",), 60, 60),
    "toda, two seeds": (Chain(8, potential="toda:0.3"), (1, 2), ("0.390625", "0.765625"), 4, 3),
    "even polynomial": (Chain(6, potential="poly:0,-1/3,0,1/5"), (1, 4), ("0.515625", "1.734375"), 2, 2),
}
UNIVERSAL = {
    "alpha, two seeds": (Chain(8, alpha="0.3"), (1, 2), ("0.390625", "0.765625"), 3, 2),
    "beta, one seed": (Chain(6, beta="1/3"), (2,), ("1.0078125",), 2, 2),
    "mixed, one mode": (Chain(2, alpha="0.2", beta="0.3"), (1,), ("1.421875",), 4, 4),
    "wrapped, order 1": (Chain(4, alpha="-0.3"), (2, 3), ("1.421875", "1.859375"), 1, 0),
    "order 0": (Chain(5, alpha="0.25"), (2,), ("1.1796875",), 0, 0),
    "lennard-jones, one seed": (Chain(6, potential="lj:3,1"), (2,), ("1.0078125",), 3, 2),
    "even polynomial": (Chain(5, potential="poly:0,-1/3,0,1/5"), (1,), ("0.625",), 2, 2),
}


@cache
def numeric(case, digits=DIGITS):
    """The series of a case, by numbers; one for its program and all expected values."""
    chain, seeds, frequencies, order, frequency_order = case
    return lindstedt(chain, seeds, frequencies, max(order, frequency_order), digits=digits)


@cache
def universal(case):
    """The series of a case in universal form."""
    chain, seeds, _, order, frequency_order = case
    return lindstedt(chain, seeds, order=max(order, frequency_order))


# operations up to which a numeric series becomes statements
FORMS = {"statements": 10**9, "tables": 0, "default": STRAIGHT_LINE}


def program_of(series, case, name="sample", form="default"):
    """What the languages are given."""
    orders = {"order": case[3], "frequency_order": case[4]}
    return series_program(series, name, series_facts(series, **orders), **orders, straight_line=FORMS[form])


def drawn(case, seed=3):
    """Amplitudes, phases, other frequencies and times, all exact in doubles; some times are far."""
    draw = np.random.default_rng(seed)
    seeds = case[1]
    size = 0.25 if case[3] < 20 else 0.05

    def short(low, high, count):
        return np.round(draw.uniform(low, high, count) * 1024) / 1024

    amplitudes, phases = short(size / 4, size, len(seeds)), short(-3, 3, len(seeds))
    others = np.array([float(w) for w in case[2]]) + short(-0.02, 0.02, len(seeds))
    times = short(-1, 1, 19) * 10.0 ** draw.integers(0, 5, 19)
    return amplitudes, phases, others, times


def expected_orbit(case, amplitudes, phases, frequencies, times):
    """Q and P at many digits: the torus of the numeric series, its angles turning with the given frequencies."""
    doubles = (tuple(map(float, values)) for values in (amplitudes, phases, frequencies, times))
    return _expected_orbit(case, *doubles)


@cache
def _expected_orbit(case, amplitudes, phases, frequencies, times):
    """The same for every form of a case."""
    torus = _torus(case, amplitudes)
    omega = tuple(map(Fraction, frequencies))
    angles = dict(zip(torus.seeds, phases, strict=True))
    moved = Torus(torus.chain, torus.seeds, omega, torus.harmonics, torus.cosines, angles, DIGITS)
    return moved.Q(times), moved.P(times)


@cache
def _torus(case, amplitudes):
    series = numeric(case)
    return FromSeries(series, tuple(map(mpmath.mpf, amplitudes)), frequency_order=0, order=case[3]).torus()


def expected_frequencies(case, amplitudes):
    """omega(A) (s,) and its Jacobian by A (s, s) at many digits."""
    return _expected_frequencies(case, tuple(amplitudes))


@cache
def _expected_frequencies(case, amplitudes):
    with mpmath.workdps(DIGITS + 15):
        A = np.array([mpmath.mpf(a) for a in amplitudes], dtype=object)
        terms, slopes = numeric(case).frequency_terms(A**2, case[4])
        return terms.sum(axis=0), slopes.sum(axis=0) * 2 * A


def assert_close(values, expected):
    """Relative to the largest value, and each mode relative to its own largest; shapes (T, N-1)."""
    error = np.abs(np.asarray(values) - expected).astype(float)
    scale = np.abs(expected).astype(float)
    assert error.max() <= OF_LARGEST * scale.max()
    assert (error.max(axis=0) <= OF_TAIL * scale.max(axis=0)).all()


def assert_frequencies(omega, jacobian, case, amplitudes):
    """Both relative to their largest entry."""
    exact, slopes = expected_frequencies(case, amplitudes)
    assert np.abs(np.asarray(omega) - exact).max() <= OF_LARGEST * np.abs(exact).max()
    assert np.abs(np.asarray(jacobian) - slopes).max() <= OF_LARGEST * np.abs(slopes).max()
