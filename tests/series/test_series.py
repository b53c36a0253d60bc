"""Access to a series: arrays, expressions, sums and its repr."""

import numpy as np
import pytest
import symengine as se

from symfpu import Chain, InputError, lindstedt
from tests.tolerances import CENTRAL_DIFFERENCE, COEFFICIENT, DIFFERENCE_ROUNDING, ROUNDING

AMPLITUDES = {1: 0.31, 2: 0.17}


@pytest.fixture(scope="module")
def series():
    return lindstedt(Chain(8, alpha="-0.3", beta="0.2"), (1, 2), ("0.395", "0.775"), 5)


def number(expression, values):
    return float(expression.subs({se.Symbol(name): value for name, value in values.items()}).n(real=True))


def symbols(angles):
    return {f"A{q}": a for q, a in AMPLITUDES.items()} | {f"theta{q}": t for q, t in zip(AMPLITUDES, angles, strict=True)}


def test_order_zero_is_the_seeds(series):
    assert str(series.term(1, 0)) == "1.0*A1*cos(theta1)"
    assert all(series.term(q, 0) == 0 for q in range(3, 8))
    assert number(series.frequency_correction(2, 0), {}) == pytest.approx(2 * np.sin(np.pi / 8), rel=ROUNDING)


@pytest.mark.parametrize("order", range(6))
def test_terms_are_the_cosines_of_the_arrays(series, order):
    """mu^k term(q, k) at numbers against harmonic_terms, for angles that are not symmetric."""
    angles = np.array([0.7, -1.9])
    nu, values = series.harmonic_terms(list(AMPLITUDES.values()), order)
    summed = np.cos(nu @ angles) @ values
    scale = np.abs(values).max()
    for q in range(1, 8):
        expected = series.chain.mu**order * number(series.term(q, order), symbols(angles))
        assert summed[q - 1] == pytest.approx(expected, abs=COEFFICIENT * scale)


def test_the_gauge_leaves_the_seed_harmonic_to_order_zero(series):
    for i, q in enumerate((1, 2)):
        unit = [int(j == i) for j in range(2)]
        for k in range(1, 6):
            nu, values = series.harmonic_terms(list(AMPLITUDES.values()), k)
            assert (values[(nu == unit).all(axis=1), q - 1] == 0).all()


@pytest.mark.parametrize("q", [1, 2])
def test_frequency_terms_are_the_expressions(series, q):
    terms, _ = series.frequency_terms([a**2 for a in AMPLITUDES.values()])
    for k in range(6):
        expected = series.chain.mu**k * number(series.frequency_correction(q, k), symbols((0, 0)))
        assert terms[k, q - 1] == pytest.approx(expected, rel=COEFFICIENT)


@pytest.mark.parametrize("q", [1, 2])
def test_squared_frequency_is_the_square_of_the_frequency(series, q):
    values = symbols((0, 0))
    omega = [number(series.frequency_correction(q, k), values) for k in range(6)]
    for k in range(6):
        product = sum(omega[j] * omega[k - j] for j in range(k + 1))
        assert number(series.squared_frequency_correction(q, k), values) == pytest.approx(product, rel=COEFFICIENT, abs=COEFFICIENT)


def test_frequency_derivatives_are_differences(series):
    squares, step = np.array([0.09, 0.03]), 1e-5
    _, jacobian = series.frequency_terms(squares)
    for j in range(2):
        shift = step * np.eye(2)[j]
        difference = (series.frequency_terms(squares + shift)[0] - series.frequency_terms(squares - shift)[0]) / (2 * step)
        assert np.allclose(jacobian[:, :, j], difference, rtol=CENTRAL_DIFFERENCE, atol=DIFFERENCE_ROUNDING)  # step^2 and EPS / step


@pytest.mark.parametrize("with_mu", [False, True])
def test_absolute_sums_are_sums_of_moduli(series, with_mu):
    """S_1 over all coefficients h, S_2 over harmonics (Eqs. serabs2, serabs3)."""
    first, second = series.absolute_sums(1, list(AMPLITUDES.values()), with_mu=with_mu)
    assert first.shape == second.shape == (6,)
    for k in range(6):
        exponents, values = series.coefficients(1, k)
        by_harmonic = {}
        total = 0.0
        for row, value in zip(exponents, values, strict=True):
            nu = tuple(row[0::2] - row[1::2])
            powers = row[0::2] + row[1::2]
            h = value * (2 if any(nu) else 1) * np.prod((np.array(list(AMPLITUDES.values())) / 2) ** powers)
            total += abs(h)
            by_harmonic[nu] = by_harmonic.get(nu, 0.0) + h
        unit = abs(series.chain.mu) ** k if with_mu else 1.0
        assert first[k] == pytest.approx(unit * total, rel=COEFFICIENT)
        assert second[k] == pytest.approx(unit * sum(map(abs, by_harmonic.values())), rel=COEFFICIENT, abs=COEFFICIENT * unit * total)


@pytest.mark.parametrize(
    "call",
    [
        lambda s: s.term(0, 1),
        lambda s: s.term(8, 1),
        lambda s: s.term(1, 6),
        lambda s: s.term(1, -1),
        lambda s: s.coefficients(1.5, 1),
        lambda s: s.frequency_correction(3, 1),
        lambda s: s.frequency_correction(1, 6),
        lambda s: s.harmonic_terms([0.1, 0.1], 6),
        lambda s: s.absolute_sums(9, [0.1, 0.1]),
    ],
)
def test_modes_and_orders_outside_the_series_are_refused(series, call):
    with pytest.raises(InputError):
        call(series)


def test_a_universal_form_has_no_numbers():
    series = lindstedt(Chain(8, alpha=1), (1,), order=2)
    with pytest.raises(InputError, match="frequencies"):
        series.harmonic_terms([0.1], 1)
    with pytest.raises(InputError, match="frequencies"):
        series.frequency_terms([0.1])
