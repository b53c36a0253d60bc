"""A torus with numbers in it against sums of terms, quadrature, integration, and the rate at which its errors fall."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
import symengine as se
from scipy.integrate import simpson, solve_ivp

from symfpu.breathers.balance import periodic_orbit
from symfpu.breathers.digits import periodic_orbit_digits
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import amplitude_history, solve_amplitudes
from symfpu.tori.quasiperiodic import mean_cosine
from symfpu.tori.resummation import pade_amplitudes, pade_frequencies, resum
from symfpu.tori.torus import QTorus
from tests.tolerances import (
    COEFFICIENT,
    DIFFERENCE,
    GRID_AVERAGE,
    ORBIT,
    PEER_ABSOLUTE,
    PEER_RELATIVE,
    QUADRATURE,
    RESIDUAL_ROUNDING,
    ROUNDING,
    SLOPE,
)

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


def test_positions_are_the_sum_of_the_terms(torus):
    series, t = torus.series, 3.7
    values = {se.Symbol(f"A{q}"): a for q, a in torus.amplitudes.items()}
    for q, omega in zip((1, 2), (0.3905, 0.7663), strict=True):
        values[se.Symbol(f"theta{q}")] = omega * t + PHASES[q]
    for q in range(1, 8):
        summed = sum(series.chain.mu**k * float(se.sympify(series.term(q, k)).subs(values).n(real=True)) for k in range(7))
        assert torus.positions(t)[q - 1] == pytest.approx(summed, rel=COEFFICIENT, abs=COEFFICIENT)


def test_shapes_follow_the_times(torus):
    for along in (torus.positions, torus.momenta, torus.harmonic_energies):
        assert along(1.0).shape == (7,)
        assert along([0.0, 1.0, 2.0]).shape == (3, 7)
        assert along([]).shape == (0, 7)
        assert np.allclose(along([0.0, 1.0])[1], along(1.0), rtol=ROUNDING, atol=ROUNDING)
    assert torus.energy().shape == ()
    assert torus.energy([0.0, 1.0]).shape == torus.energy_error([0.0, 1.0]).shape == (2,)
    assert torus.energy_error(0.0) == torus.energy_error(0.0, harmonic=True) == 0


@pytest.mark.parametrize("t", [[[0.0, 1.0]], float("nan"), [0.0, float("inf")]])
def test_bad_times_are_refused(torus, t):
    with pytest.raises(InputError, match=r"^t = "):
        torus.positions(t)


def test_momenta_are_the_derivative_of_positions(torus):
    """Eighth-order central difference."""
    h, t = 0.02, np.linspace(0.0, 20.0, 11)
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    derivative = sum(w * (torus.positions(t + i * h) - torus.positions(t - i * h)) for i, w in weights.items()) / h
    assert np.abs(torus.momenta(t) - derivative).max() < DIFFERENCE


def test_the_amplitude_is_the_coefficient_of_the_seed_harmonic(torus):
    """The gauge of A: not Q_q(0)."""
    for i, q in enumerate((1, 2)):
        row = (torus.harmonics == np.eye(2, dtype=int)[i]).all(axis=1)
        assert torus.cosines[row, q - 1].item() == pytest.approx(torus.amplitudes[q], rel=ROUNDING)
    assert torus.positions(0.0)[0] != torus.amplitudes[1] * np.cos(PHASES[1])


def test_phases_shift_the_angles(torus):
    """Phases omega t0 are the torus at a later time."""
    t0, t = 5.3, np.linspace(0.0, 30.0, 7)
    moved = replace(torus, phases={1: PHASES[1] + 0.3905 * t0, 2: PHASES[2] + 0.7663 * t0})
    assert np.abs(moved.positions(t) - torus.positions(t + t0)).max() < ROUNDING
    assert np.abs(moved.momenta(t) - torus.momenta(t + t0)).max() < ROUNDING
    assert np.allclose(moved.average_spectrum(), torus.average_spectrum(), rtol=ROUNDING)


def test_the_harmonic_energy_is_that_of_the_state(torus):
    Q, P = torus.positions(2.0), torus.momenta(2.0)
    Omega = 2 * np.sin(np.arange(1, 8) * np.pi / 16)
    assert np.allclose(torus.harmonic_energies(2.0), (P**2 + Omega**2 * Q**2) / 2, rtol=ROUNDING)
    assert torus.energy(2.0) == torus.series.chain.energy(Q, P)


def test_the_infinite_average_is_the_average_over_the_angles(torus):
    """An equidistant grid with more points than the squares have harmonics integrates them exactly."""
    points = 4 * torus.series.degree(torus.order) + 1
    total = np.zeros(7)
    angles = 2 * np.pi * np.arange(points) / points
    for phase in angles:
        shifted = [replace(torus, phases={1: other, 2: phase}) for other in angles]
        total += sum(t.harmonic_energies() for t in shifted)
    assert np.allclose(torus.average_spectrum(), total / points**2, rtol=GRID_AVERAGE)


@pytest.mark.parametrize("T", [0.3, 10.0, 50.0])
def test_finite_averages_are_quadratures(torus, T):
    t = np.linspace(0.0, T, 4001)
    expected = simpson(torus.harmonic_energies(t), x=t, axis=0) / T
    assert np.allclose(torus.average_spectrum(T), expected, rtol=QUADRATURE, atol=QUADRATURE * expected.max())


def test_long_averages_tend_to_the_infinite_one_as_one_over_the_time(torus):
    limit = torus.average_spectrum()
    errors = [np.abs(torus.average_spectrum(T) - limit).max() * T for T in (1e3, 1e5)]
    assert max(errors) < 2 * limit.max() / 0.0147  # |sin| <= 1 over the slowest rate, 2 omega_1 - omega_2
    assert np.abs(torus.average_spectrum(1e3) - limit).max() > 0


@pytest.mark.parametrize("T", [0.0, -1.0, float("nan"), float("inf")])
def test_bad_averaging_times_are_refused(torus, T):
    with pytest.raises(InputError, match=r"^T = "):
        torus.average_spectrum(T)


def test_mean_cosine_at_rate_zero_is_the_cosine():
    assert mean_cosine(np.array([0.0, 2.0]), np.array([0.3, 0.0]), 5.0) == pytest.approx([np.cos(0.3), np.sin(10.0) / 10.0], rel=ROUNDING)


@pytest.mark.long
@pytest.mark.parametrize(
    ("couplings", "seeds", "frequencies"),
    [
        ({"alpha": "0.3"}, (1, 2), ("0.39019", "0.7654")),
        ({"beta": "0.3"}, (3,), ("1.1115",)),
        ({"alpha": "0.3", "beta": "0.1"}, (2,), ("0.7660",)),
    ],
    ids=str,
)
def test_the_orbit_is_that_of_the_equations_of_motion(couplings, seeds, frequencies):
    chain = Chain(8, **couplings)
    torus = solve_amplitudes(lindstedt(chain, seeds, frequencies, 14))
    assert torus.residual() < ORBIT / 100
    times = np.linspace(0.0, 200.0, 41)
    start = np.concatenate([torus.positions(0.0), torus.momenta(0.0)])
    orbit = solve_ivp(
        lambda _, y: np.concatenate([y[7:], chain.accelerations(y[:7])]),
        (0.0, 200.0),
        start,
        method="DOP853",
        t_eval=times,
        rtol=PEER_RELATIVE,
        atol=PEER_ABSOLUTE,
    )
    scale = max(torus.amplitudes.values())
    assert np.abs(orbit.y[:7].T - torus.positions(times)).max() < ORBIT * scale
    assert np.abs(orbit.y[7:].T - torus.momenta(times)).max() < ORBIT * scale


def at_coupling(couplings, factor, order):
    """A torus of fixed amplitudes: only mu changes. The frequencies follow from the series itself."""
    chain = Chain(8, **{name: float(value) * factor for name, value in couplings.items()})
    omega = chain.frequencies()[1] + 0.0
    for _ in range(40):  # omega = Omega + sum mu^k omega^(k)(A; omega) by iteration
        series = lindstedt(chain, (2,), (repr(float(omega)),), order + 2)
        omega = series.frequency_terms([0.25])[0].sum()
    return QTorus(series=series, amplitudes={2: 0.5}, phases={2: 0.0}, frequency_order=order + 2, order=order)


@pytest.mark.long
@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("couplings", [{"alpha": 0.2}, {"beta": 0.4}], ids=str)
def test_the_residual_falls_as_mu_to_the_next_order(couplings, order):
    factors = np.array([1.0, 0.5, 0.25]) if order < 4 else np.array([1.0, 0.7, 0.5])  # above the rounding of the forces
    residuals = [at_coupling(couplings, f, order).residual() for f in factors]
    slope = np.polyfit(np.log(factors), np.log(residuals), 1)[0]
    assert slope == pytest.approx(order + 1, abs=SLOPE)


@pytest.mark.long
@pytest.mark.parametrize("order", [1, 2, 3])
def test_the_energy_is_constant_to_the_next_order(order):
    factors, t = np.array([1.0, 0.5, 0.25]), np.linspace(0.0, 40.0, 401)
    errors = [np.abs(at_coupling({"beta": 0.4}, f, order).energy_error(t)).max() for f in factors]
    slope = np.polyfit(np.log(factors), np.log(errors), 1)[0]
    assert slope == pytest.approx(order + 1, abs=SLOPE)


def test_residuals_are_by_mode_and_on_the_grid(breather):
    residuals = breather.residuals(32)
    assert residuals.shape == (7,)
    assert (residuals[1::2] == 0).any() or residuals[1::2].max() < ROUNDING
    force = [
        np.abs(breather.series.chain.accelerations(replace(breather, phases={3: 2 * np.pi * (j + 1 / 3) / 32}).positions(0.0))).max()
        for j in range(32)
    ]
    assert breather.residual(32) == pytest.approx(residuals.max() / max(force), rel=RESIDUAL_ROUNDING)
    with pytest.raises(InputError, match="points"):
        breather.residual(0)


def test_repr_is_an_answer(breather):
    text = repr(breather)
    assert text.startswith(f"QTorus(N=8, beta=0.3, A_3={breather.amplitudes[3]:.12g}, frequency order 5, order 5, H=")
    assert "residual" in text


def printed(values, expected, digits):
    """Whether all of the numbers print as the expected ones to so many digits."""
    flat = zip(np.ravel(values), np.ravel(expected), strict=True)
    return all(str(x) == f"{x}" == repr(x)[5:-2] == mpmath.nstr(y, digits) for x, y in flat)


def test_values_of_many_digits_print_all_of_them():
    """Against the same in mpf that print 15 digits; the precision of mpmath is not touched."""
    series = lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3905", "0.7663"), 4, digits=45)
    torus, plain = solve_amplitudes(series), np.frompyfunc(lambda x: mpmath.mp.make_mpf(x._mpf_), 1, 1)
    amplitudes = list(torus.amplitudes.values())
    history = amplitude_history(series).amplitudes[4]
    results = [
        amplitudes,
        history,
        torus.history[4],
        torus.cosines,
        torus.positions([0.0, 0.3]),
        torus.momenta(0.3),
        torus.energy(),
        torus.energy([0.0, 0.3]),
        torus.harmonic_energies(),
        torus.energy_error([0.3]),
        torus.average_spectrum(),
        resum(torus).cosines,
        list(pade_amplitudes(series, torus.amplitudes).values()),
        pade_frequencies(series, torus.amplitudes).values,
        series.coefficients(3, 1)[1],
        series.frequency_coefficients(1, 2)[1],
        series.frequency_terms([0.1, 0.2])[0],
        series.harmonic_terms(amplitudes, 2)[1],
        series.amplitude_terms(2)[2],
        series.scaled_seeds(amplitudes),
    ]
    for values in results:
        assert printed(values, plain(values), 45)
    assert len(str(amplitudes[0])) == 2 + 45
    breather = periodic_orbit_digits(periodic_orbit(Chain(8, beta=1), 3, "1.2"), 30)
    found = [breather.amplitude, breather.bound, breather.energy()]
    assert printed(found, plain(found), 30)
    assert len(str(breather.amplitude)) == 1 + 30
    accurate = lindstedt(Chain(8, beta="1e-3"), (3,), ("1.1112",), 6, digits=20)
    residual = solve_amplitudes(accurate).residuals()[2]
    assert isinstance(residual, mpmath.mpf)
    assert printed([residual], plain([residual]), 20)
    assert mpmath.mp.dps == 15
