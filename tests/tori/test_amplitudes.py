"""Amplitudes against reference values, periodic orbits, exactly solvable reductions, and what has no solution."""

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, DidNotConverge, InputError, NoRealAmplitude, SymfpuError, amplitude_history, lindstedt, solve_amplitudes
from symfpu.tori.amplitudes import frequency_orders
from tests.oracles.oscillators import cubic_oscillator, duffing
from tests.reference import BETA_BREATHER, PERIODIC_ORBITS, TWO_TORUS
from tests.refusals import each, refused
from tests.tolerances import AMPLITUDE, DIFFERENCE_OF_DOUBLES, ELLIPTIC, PERIODIC_ORBIT, ROUNDING


def reference_series(reference):
    chain = Chain(reference.N, reference.alpha, reference.beta)
    return lindstedt(chain, reference.seeds, reference.frequencies, max(reference.amplitudes))


@pytest.fixture(scope="module")
def two_torus():
    return reference_series(TWO_TORUS)


@pytest.mark.parametrize("reference", [TWO_TORUS, BETA_BREATHER], ids=["alpha, 2-torus", "beta, breather"])
def test_amplitudes_are_the_reference_values_at_every_frequency_order(reference):
    series = reference_series(reference)
    history = amplitude_history(series)
    for K, expected in reference.amplitudes.items():
        torus = solve_amplitudes(series, frequency_order=K)
        assert tuple(torus.amplitudes) == reference.seeds
        assert list(torus.amplitudes.values()) == pytest.approx([float(a) for a in expected], rel=AMPLITUDE)
        assert history.amplitudes[K] == pytest.approx(tuple(torus.amplitudes.values()), rel=AMPLITUDE)


@pytest.mark.parametrize("digits", [None, pytest.param(20, marks=pytest.mark.long)])
@pytest.mark.parametrize("orbit", PERIODIC_ORBITS, ids=lambda o: f"seed {o.seed}")
def test_breathers_are_the_periodic_orbits(orbit, digits):
    series = lindstedt(Chain(orbit.N, orbit.alpha), (orbit.seed,), (orbit.frequency,), orbit.order, digits=digits)
    torus = solve_amplitudes(series)
    assert digits is None or torus.origin.certificate.certified
    assert float(torus.amplitudes[orbit.seed]) == pytest.approx(orbit.amplitude, rel=PERIODIC_ORBIT)
    assert float(torus.energy()) == pytest.approx(orbit.energy, rel=PERIODIC_ORBIT)
    assert torus.warnings == ()


def test_the_root_solves_the_truncated_equations(two_torus):
    for K in (2, 8, 20):
        torus = solve_amplitudes(two_torus, frequency_order=K)
        terms, _ = two_torus.frequency_terms([a**2 for a in torus.amplitudes.values()], K)
        assert np.allclose(terms.sum(axis=0), [0.19626, 0.39046], rtol=ROUNDING, atol=0)
        assert torus.origin.root_residual < ROUNDING


def test_the_two_orders_are_independent(two_torus):
    tori = {(K, k): solve_amplitudes(two_torus, frequency_order=K, order=k) for K in (6, 12) for k in (3, 9)}
    for K in (6, 12):
        assert tori[K, 3].amplitudes == tori[K, 9].amplitudes
        assert (tori[K, 3].origin.frequency_order, tori[K, 3].origin.order) == (K, 3)
        assert len(tori[K, 3].harmonics) < len(tori[K, 9].harmonics)
    assert tori[6, 9].amplitudes != tori[12, 9].amplitudes
    default = solve_amplitudes(two_torus)
    assert (default.origin.frequency_order, default.origin.order) == (20, 20)


def test_history_has_every_order_of_a_correction(two_torus):
    history = amplitude_history(two_torus)
    assert frequency_orders(two_torus) == history.orders == tuple(range(2, 21, 2)) == tuple(history.amplitudes)
    assert solve_amplitudes(two_torus, frequency_order=4).origin.history == dict(history.amplitudes)
    beta = reference_series(BETA_BREATHER)
    assert tuple(amplitude_history(beta).amplitudes) == frequency_orders(beta) == tuple(range(1, 13))
    assert "10 of 10 orders have a root" in repr(history)


def test_differences_are_between_consecutive_orders(two_torus):
    history = amplitude_history(two_torus)
    differences = history.differences()
    assert tuple(differences) == tuple(range(2, 19, 2))
    for k, delta in differences.items():
        assert delta == tuple(abs(b - a) for a, b in zip(history.amplitudes[k], history.amplitudes[k + 2], strict=True))


def test_a_good_guess_changes_nothing(two_torus):
    plain = solve_amplitudes(two_torus, frequency_order=8)
    guessed = solve_amplitudes(two_torus, frequency_order=8, guess={1: 0.58, 2: 0.41})
    assert list(guessed.amplitudes.values()) == pytest.approx(list(plain.amplitudes.values()), rel=AMPLITUDE)


def test_a_bad_guess_without_a_real_root_says_so(two_torus):
    with pytest.raises(NoRealAmplitude) as caught:
        solve_amplitudes(two_torus, frequency_order=12, guess={1: 0.1, 2: 1.5})
    assert "\n" not in str(caught.value)


def test_a_root_of_the_truncated_polynomial_only_is_doubted(two_torus):
    """From A = 5 Newton finds another root of order 12, far from that of order 10."""
    torus = solve_amplitudes(two_torus, frequency_order=12, guess={1: 5.0, 2: 5.0})
    assert torus.amplitudes[1] > 1
    assert any("orders 10 and 12 differ" in warning for warning in torus.warnings)


def test_no_root_at_all_carries_the_last_iterate():
    """Order 2 of a beta breather, a A^2 - b A^4 with b > 0, is bounded: omega = 0.9 lies above its maximum."""
    series = lindstedt(Chain(16, beta="0.3"), (3,), ("0.9",), 2)
    with pytest.raises(DidNotConverge) as caught:
        solve_amplitudes(series)
    error = caught.value
    assert error.frequency_order == 2
    assert tuple(error.iterate) == (3,)
    squared = np.sign(error.iterate[3]) * error.iterate[3] ** 2
    terms, _ = series.frequency_terms([squared])
    assert error.residual == pytest.approx(abs(0.9 - terms.sum()), rel=DIFFERENCE_OF_DOUBLES)
    assert set(amplitude_history(series).failures) == {2}


def test_no_real_amplitude_names_the_seed():
    """Below its linear frequency a beta breather with beta > 0 has A^2 < 0."""
    series = lindstedt(Chain(16, beta="0.3"), (3,), ("0.57",), 1)
    with pytest.raises(NoRealAmplitude) as caught:
        solve_amplitudes(series)
    assert caught.value.seed == 3
    assert caught.value.squared < 0
    assert "A_3^2" in str(caught.value)
    assert not isinstance(caught.value, InputError)


def test_a_harmonic_mode_leaves_the_amplitude_undetermined():
    """N = 16, seed 8, alpha: the mode N/2 does not feel the cubic force at all."""
    series = lindstedt(Chain(16, alpha="0.3"), (8,), ("1.42",), 4)
    with pytest.raises(symfpu.UndeterminedAmplitudes) as caught:
        solve_amplitudes(series)
    assert caught.value.seeds == (8,)


@pytest.mark.parametrize(
    ("potential", "orders"),
    [("poly:0,0,0,1/3", [2, 4, 6]), ("poly:0,0,1/4", [6]), ("poly:1/2,0,1/4", [2, 4, 6]), ("poly:0,0,0,0,0,1/5", [3, 6])],
)
@pytest.mark.parametrize("seeds", [(1,), (2, 5, 7)])
def test_amplitudes_come_back_where_the_lowest_force_is_no_square_or_cube(potential, orders, seeds):
    """A force r^5 shifts frequencies with A^4, r^4 only by pairs, with A^6: orders between do not, and are none."""
    wanted = {q: 0.3 / n for n, q in enumerate(seeds, 1)}
    made = symfpu.torus(Chain(8, potential=potential), tuple(wanted), amplitudes=wanted, method="series", order=6)
    torus = solve_amplitudes(lindstedt(made.chain, seeds, tuple(made.frequencies), 6))
    assert torus.amplitudes == pytest.approx(wanted, rel=AMPLITUDE)
    assert list(torus.origin.history) == orders


def test_a_single_frequency_order_is_told():
    (warning,) = solve_amplitudes(lindstedt(Chain(16, beta="0.3"), (3,), ("0.5806",), 1)).warnings
    assert "only frequency order" in warning


@each(
    frequency_order=[21, -1, 1, 2.0, 0],
    order=[21, -1],
    phases=[{3: 0.1}, {1: float("nan")}, [1]],
    guess=[{1: 0.1}, {1: 0.1, 3: 0.1}, {1: 1e200, 2: 1e200}, {1: 0, 2: 0}],
)
def test_bad_arguments_are_refused_by_name(two_torus, name, value):
    refused(solve_amplitudes, name, value, series=two_torus)


def test_series_without_numbers_or_corrections_are_refused():
    with pytest.raises(InputError, match="universal form"):
        solve_amplitudes(lindstedt(Chain(8, alpha=1), (1,), order=2))
    with pytest.raises(InputError, match="frequency_order"):
        solve_amplitudes(lindstedt(Chain(8, alpha=1), (1,), ("0.4",), 1))
    assert issubclass(InputError, SymfpuError)


@pytest.mark.parametrize(("N", "seed"), [(2, 1), (4, 2), (12, 6), (9, 6), (12, 8), (6, 2), (9, 3)])
def test_one_mode_of_beta_is_the_duffing_oscillator(N, seed):
    """N/2, 2N/3 and N/3: x'' + Omega^2 x + (beta / 2N) Omega^4 C_qqqq x^3 = 0, solved by elliptic functions."""
    chain = Chain(N, beta="0.5")
    with mpmath.workdps(30):
        squared = chain.linear_frequency(seed) ** 2
        omega, amplitude = duffing(squared, mpmath.mpf("0.5") / (2 * N) * squared**2 * chain.C(*[seed] * 4), mpmath.mpf("0.2"))
        torus = solve_amplitudes(lindstedt(chain, (seed,), (mpmath.nstr(omega, 25),), 20))
        assert abs(torus.amplitudes[seed] / amplitude - 1) < ELLIPTIC


@pytest.mark.parametrize("N", [3, 6, 9])
def test_two_thirds_of_alpha_is_the_cubic_oscillator(N):
    """x'' + Omega^2 x + (alpha / sqrt(2N)) Omega^3 B_qqq x^2 = 0, solved by quadrature."""
    chain, seed = Chain(N, alpha="0.4"), 2 * N // 3
    with mpmath.workdps(30):
        Omega = chain.linear_frequency(seed)
        quadratic = mpmath.mpf("0.4") / mpmath.sqrt(2 * N) * Omega**3 * chain.B(seed, seed, seed)
        omega, amplitude = cubic_oscillator(Omega**2, quadratic, mpmath.mpf("0.1"))
        torus = solve_amplitudes(lindstedt(chain, (seed,), (mpmath.nstr(omega, 25),), 24))
        assert abs(torus.amplitudes[seed] / amplitude - 1) < ELLIPTIC
        assert [q for q in range(1, N) if torus.cosines[:, q - 1].any()] == [seed]


def test_no_real_root_at_the_lowest_order_is_said_as_such():
    """Two seeds whose shifts need negative squares at order 2, and no later order has a root either."""
    series = lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3900", "0.7651"), 14)
    with pytest.raises(NoRealAmplitude, match="A_1"):
        solve_amplitudes(series)


def test_commensurable_frequencies_are_refused_though_no_divisor_vanishes():
    """2 omega_1 = omega_2: harmonics (3, 0) and (1, -2) .. coincide, and averages over them would be wrong."""
    series = lindstedt(Chain(16, beta=1), (1, 2), ("0.2", "0.4"), 1)
    with pytest.raises(InputError, match="incommensurable"):
        solve_amplitudes(series)


def test_linear_frequency_has_no_amplitude():
    with pytest.raises(NoRealAmplitude, match="linear frequency"):
        solve_amplitudes(lindstedt(Chain(3, beta=1), (1,), ("1",), 2))
