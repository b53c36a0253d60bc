"""A torus with numbers in it against sums of terms, quadrature, integration, and the rate at which its errors fall."""

from dataclasses import replace

import numpy as np
import pytest

from symfpu import Chain, FromSeries, InputError, lindstedt, solve_amplitudes
from symfpu.tori.columns import mean_cosine
from tests.tolerances import RESIDUAL_ROUNDING, ROUNDING, SLOPE

PHASES = {1: 0.4, 2: -1.3}


@pytest.fixture(scope="module")
def torus():
    """Both couplings, two seeds, phases: nothing is symmetric."""
    series = lindstedt(Chain(8, alpha="0.3", beta="0.1"), (1, 2), ("0.3905", "0.7663"), 6)
    return solve_amplitudes(series, phases=PHASES)


@pytest.fixture(scope="module")
def breather():
    series = lindstedt(Chain(8, beta="0.3"), (3,), ("1.113",), 5)
    return solve_amplitudes(series, phases={3: 0.7})


@pytest.mark.parametrize("T", [0.0, -1.0, float("nan"), float("inf")])
def test_bad_averaging_times_are_refused(torus, T):
    with pytest.raises(InputError, match=r"^T = "):
        torus.average_spectrum(T)


def test_mean_cosine_at_rate_zero_is_the_cosine():
    assert mean_cosine(np.array([0.0, 2.0]), np.array([0.3, 0.0]), 5.0) == pytest.approx([np.cos(0.3), np.sin(10.0) / 10.0], rel=ROUNDING)


def at_coupling(couplings, factor, order):
    """A torus of fixed amplitudes: only mu changes. The frequencies follow from the series itself."""
    chain = Chain(8, **{name: float(value) * factor for name, value in couplings.items()})
    omega = chain.frequencies()[1] + 0.0
    for _ in range(40):  # omega = Omega + sum mu^k omega^(k)(A; omega) by iteration
        series = lindstedt(chain, (2,), (repr(float(omega)),), order + 2)
        omega = series.frequency_terms([0.25])[0].sum()
    return FromSeries(series, (0.5,), frequency_order=order + 2, order=order).torus()


@pytest.mark.long
@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("couplings", [{"alpha": 0.2}, {"beta": 0.4}], ids=str)
def test_the_residual_falls_as_mu_to_the_next_order(couplings, order):
    factors = np.array([1.0, 0.5, 0.25]) if order < 4 else np.array([1.0, 0.7, 0.5])  # above the rounding of the forces
    residuals = [at_coupling(couplings, f, order).residual() for f in factors]
    slope = np.polyfit(np.log(factors), np.log(residuals), 1)[0]
    assert slope == pytest.approx(order + 1, abs=SLOPE)


def test_residuals_are_by_mode_and_on_the_grid(breather):
    residuals = breather.residuals(32)
    assert residuals.shape == (7,)
    assert (residuals[1::2] == 0).any() or residuals[1::2].max() < ROUNDING
    force = [
        np.abs(breather.origin.series.chain.accelerations(replace(breather, phases={3: 2 * np.pi * (j + 1 / 3) / 32}).Q(0.0))).max()
        for j in range(32)
    ]
    assert breather.residual(32) == pytest.approx(residuals.max() / max(force), rel=RESIDUAL_ROUNDING)
    with pytest.raises(InputError, match="points"):
        breather.residual(0)


def test_cut_at_an_order_it_is_the_torus_of_that_order(torus):
    for order in (0, 3, 6):
        cut = torus.origin.cut_at(order).torus(torus.phases)
        expected = solve_amplitudes(torus.origin.series, order=order, phases=PHASES)
        assert (cut.origin.order, cut.amplitudes) == (order, expected.amplitudes)
        assert np.array_equal(cut.harmonics, expected.harmonics)
        assert np.array_equal(cut.cosines, expected.cosines)
    with pytest.raises(InputError, match=r"^order = 7.*0\.\.6"):
        torus.origin.cut_at(7)


@pytest.mark.parametrize("series", ["a series", lindstedt(Chain(8, alpha=1), (1,), order=2)])
def test_what_is_no_series_with_frequencies_is_refused(series):
    with pytest.raises(InputError, match=r"^series = "):
        FromSeries(series, (0.1,), 0, 2)


def test_a_doubt_keeps_what_is_known(torus):
    residual = torus.residual()
    doubted = torus.doubted(["a reason"])
    assert (doubted.warnings, doubted.residual()) == (("a reason",), residual)
    assert torus.warnings != doubted.warnings
    assert repr(doubted).endswith("; a reason)")
    assert doubted.origin is torus.origin
