"""Pade sums against closed forms, against mpmath's Pade table, and against the torus itself where its series converges."""

import itertools
import math
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest

from symfpu import Chain, InputError, NoRealAmplitude, lindstedt, pade_amplitudes, pade_frequencies, pade_poles, resum, solve_amplitudes
from symfpu.paper.printed import APPENDIX_F, FIG9_BREATHER, TWO_TORUS
from symfpu.tori.resummation import LARGEST_SUM, pade_sum, resum_by_order
from tests.reference import PERIODIC_ORBITS
from tests.tolerances import BRANCH_POINT, HIGH_PRECISION, PADE_TABLE, POLES, RESIDUAL_ROUNDING, RESUMMED, ROUNDING, SUMMED_FIG1

DIGITS = 40


@pytest.fixture(params=["doubles", "mpf"])
def number(request):
    """The type of the terms, in a context of DIGITS digits."""
    with mpmath.workdps(DIGITS):
        yield float if request.param == "doubles" else mpmath.mpf


def terms_of(values, number):
    return np.array([number(x) for x in values], dtype=float if number is float else object)


def logarithm(x, count):
    """The terms of log(1 + x)."""
    return [(-1) ** k * mpmath.mpf(x) ** (k + 1) / (k + 1) for k in range(count)]


def euler(x, count):
    """The terms of the integral of exp(-t) / (1 + x t), which diverge for every x."""
    return [(-1) ** k * mpmath.factorial(k) * mpmath.mpf(x) ** k for k in range(count)]


@pytest.mark.parametrize("m", [1, 2, 4])
def test_the_sum_is_the_diagonal_approximant_of_mpmath(number, m):
    coefficients = [mpmath.mpf(1) / (k + 1) ** 2 + mpmath.mpf(k % 3) / 7 for k in range(2 * m + 1)]
    top, bottom = mpmath.pade(coefficients, m, m)
    expected = mpmath.polyval(top[::-1], 1) / mpmath.polyval(bottom[::-1], 1)
    values = pade_sum(terms_of(coefficients, number)).values
    assert abs(values[()] / expected - 1) < (PADE_TABLE if number is float else HIGH_PRECISION)


@pytest.mark.parametrize("m", [1, 2, 4])
def test_the_disagreement_is_that_with_the_neighbour_of_the_same_terms(m):
    """[m/m] against [m+1/m-1], both of 2m+1 terms: of the size of the error, not a bound of it."""
    with mpmath.workdps(DIGITS):
        coefficients = logarithm(1, 2 * m + 1)
        one, other = ((mpmath.polyval(p[::-1], 1) for p in mpmath.pade(coefficients, m + d, m - d)) for d in (0, 1))
        difference = next(one) / next(one) - next(other) / next(other)
        summed = pade_sum(np.array(coefficients, dtype=object))
        assert summed.disagreement == pytest.approx(abs(float(difference)), rel=ROUNDING)


@pytest.mark.parametrize("x", ["0.1", "1"])
def test_eulers_divergent_series_is_summed_from_above(x):
    """A Stieltjes series: its [n/n] decrease to the integral of exp(-t) / (1 + x t) = exp(1/x) E_1(1/x) / x."""
    with mpmath.workdps(DIGITS):
        y = 1 / mpmath.mpf(x)
        expected = mpmath.exp(y) * mpmath.e1(y) * y
        errors = [pade_sum(np.array(euler(x, 2 * n + 1), dtype=object)).values[()] - expected for n in range(1, 12)]
        assert all(after < before for before, after in itertools.pairwise(errors))
        assert errors[-1] > 0
        assert errors[-1] < errors[0] / 1000


def test_terms_beyond_the_largest_approximant_are_not_used():
    with mpmath.workdps(DIGITS):
        terms = np.array(logarithm(1, 2 * LARGEST_SUM + 9), dtype=object)
        used = pade_sum(terms[: 2 * LARGEST_SUM + 1]).values[()]
        terms[2 * LARGEST_SUM + 1 :] = mpmath.mpf(7)
        assert pade_sum(terms).values[()] == used
        terms[2 * LARGEST_SUM] *= 2
        assert pade_sum(terms).values[()] != used


@pytest.mark.parametrize("zeros", [1, 2, 5])
def test_leading_zeros_change_nothing(number, zeros):
    terms = terms_of(logarithm(1, 9), number)
    padded = pade_sum(np.concatenate([terms_of([0] * zeros, number), terms]))
    plain = pade_sum(terms)
    assert padded.values[()] == plain.values[()]
    assert padded.disagreement == plain.disagreement


def test_a_polynomial_is_its_own_sum(number):
    """Zeros after the last term end Wynn's table."""
    for values in ([0, 0, 0, 0], [5, 0, 0], [1, 2, 3, 0, 0], [0, 1, -4, 2, 0, 0, 0]):
        summed = pade_sum(terms_of(values, number))
        assert (summed.values[()], summed.disagreement) == (sum(values), 0)


def test_entries_are_summed_each_by_itself(number):
    """Shapes (count, 2, 3), with zeros, a late beginning and a polynomial among the entries."""
    columns = [
        logarithm(1, 9),
        [0] * 9,
        [0, 0, *logarithm(2, 7)],
        [mpmath.mpf(2) / 3**k for k in range(3)] + [0] * 6,
        euler("0.3", 9),
        [0] * 8 + [1],
    ]
    together = pade_sum(np.stack([terms_of(c, number) for c in columns], axis=-1).reshape(9, 2, 3))
    assert together.values.shape == together.disagreement.shape == (2, 3)
    assert together.disagreement.dtype == np.float64
    for i, column in enumerate(columns):
        alone = pade_sum(terms_of(column, number))
        assert together.values.flat[i] == alone.values[()]
        assert together.disagreement.flat[i] == alone.disagreement


@pytest.fixture(scope="module")
def breather():
    """Fig. 7 at an order where doubles see no truncation."""
    printed = APPENDIX_F[-3]
    return solve_amplitudes(lindstedt(printed.chain, printed.seeds, printed.frequencies, 30), phases={1: 0.4})


@pytest.fixture(scope="module")
def two_torus():
    return solve_amplitudes(lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, TWO_TORUS.order), frequency_order=24)


def test_frequencies_of_a_converged_torus_are_the_chosen_ones(breather):
    summed = pade_frequencies(breather.origin.series, breather.amplitudes)
    assert summed.values == pytest.approx([float(w) for w in breather.frequencies], rel=ROUNDING)
    assert summed.disagreement < ROUNDING


def test_the_frequency_order_cuts_the_terms(breather):
    """Order 2 has two terms, Omega and mu^2 omega^(2), which are added; order 0 of a series has one."""
    terms, _ = breather.origin.series.frequency_terms([breather.amplitudes[1] ** 2])
    assert pade_frequencies(breather.origin.series, breather.amplitudes, 3).values == terms[0] + terms[2]
    printed = APPENDIX_F[-3]
    shortest = lindstedt(printed.chain, printed.seeds, printed.frequencies, 1)
    with pytest.raises(InputError, match="frequency_order = 1"):
        pade_frequencies(shortest, breather.amplitudes)


def test_amplitudes_of_a_converged_torus_are_the_truncated_root(breather):
    summed = pade_amplitudes(breather.origin.series, {1: 1.2 * breather.amplitudes[1]})
    assert summed[1] == pytest.approx(PERIODIC_ORBITS[0].amplitude, rel=RESUMMED)
    assert summed[1] == pytest.approx(breather.amplitudes[1], rel=RESUMMED)


def test_amplitudes_with_digits_are_the_root_of_the_resummed_frequencies():
    printed = APPENDIX_F[-2]
    series = lindstedt(printed.chain, printed.seeds, printed.frequencies, 12, digits=30)
    amplitudes = pade_amplitudes(series, solve_amplitudes(series).amplitudes)
    with mpmath.workdps(45):
        shift = pade_frequencies(series, amplitudes).values[0] - mpmath.mpf(printed.frequencies[0])
        assert abs(shift) < mpmath.mpf(10) ** -30
        assert float(amplitudes[25]) == pytest.approx(PERIODIC_ORBITS[1].amplitude, rel=RESUMMED)


def test_no_real_amplitude_and_no_frequencies_are_told():
    with pytest.raises(NoRealAmplitude, match="A_3"):
        pade_amplitudes(lindstedt(Chain(16, beta="0.3"), (3,), ("0.57",), 4), {3: 0.1})
    with pytest.raises(InputError, match="universal form"):
        pade_amplitudes(lindstedt(Chain(16, alpha=1), (1,), order=2), {1: 0.1})


def frequency_series(coefficients):
    """Stands in for a series of one seed of an alpha chain whose frequency has these coefficients of mu^2 A^2, ..."""

    def frequency_terms(squares, order):
        terms = np.zeros((order + 1, 1))
        powers = np.arange(1, len(coefficients) + 1)
        terms[2::2, 0] = np.array(coefficients) * float(squares[0]) ** powers
        return terms, None

    return SimpleNamespace(
        chain=Chain(8, alpha=1),
        seeds=(1,),
        order=2 * len(coefficients),
        digits=None,
        frequencies=(1,),
        frequency_terms=frequency_terms,
    )


@pytest.mark.parametrize("poles", [(1.5, -2.5), (0.75, 4.0), (2.0, -3.0, 5.0)])
def test_poles_of_a_sum_of_geometric_series(poles):
    """sum_i i / (1 - x / r_i) has the poles r_i. Five spare terms are rounding noise, and give no pole."""
    spare = 5
    coefficients = [math.fsum(i / r**k for i, r in enumerate(poles, 1)) for k in range(1, 2 * len(poles) + spare + 1)]
    found = pade_poles(frequency_series(coefficients), 1, {1: 1.0})
    assert found == pytest.approx(np.array(sorted(poles, key=abs)), rel=POLES)
    shrunk = pade_poles(frequency_series(coefficients), 1, {1: 0.5})
    assert shrunk == pytest.approx(4 * found, rel=POLES)


def test_too_few_terms_have_no_poles():
    assert len(pade_poles(frequency_series([1.0, 0.5]), 1, {1: 1.0})) == 0


@pytest.mark.long
def test_the_nearest_pole_of_the_duffing_oscillator_is_where_its_terms_end():
    """Mode N/2 of beta: the ratios of its terms tend to 1 / r as 1/k (Domb and Sykes); r is negative, as for a softer spring."""
    torus = solve_amplitudes(lindstedt(Chain(12, beta="0.5"), (6,), ("1.43",), 26, digits=30))
    terms, _ = torus.origin.series.frequency_terms([torus.amplitudes[6] ** 2])
    ratios = [float(b / a) for a, b in zip(terms[16:, 0], terms[17:, 0], strict=False)]
    limit = np.polyfit(1 / np.arange(17, 27), ratios, 2)[2]
    nearest = pade_poles(torus.origin.series, 6, torus.amplitudes)[0]
    assert nearest.imag == pytest.approx(0, abs=POLES)
    assert nearest.real < 0
    assert 1 < nearest.real * limit < 1 + BRANCH_POINT


def test_the_nearest_pole_of_fig_9_is_at_the_end_of_its_series():
    """A square root at A = 1.286986 (tests/paper/test_convergence.py), seen from the periodic orbit: the poles lie on its cut."""
    printed = FIG9_BREATHER
    series = lindstedt(printed.chain, printed.seeds, printed.frequencies, 100)
    nearest = pade_poles(series, 1, {1: 1.27153895251})[0]
    assert nearest.imag == 0
    assert 1 < nearest.real / (1.286986 / 1.27153895251) ** 2 < 1 + BRANCH_POINT


def test_a_converged_torus_is_its_own_resummation(breather):
    summed = resum(breather)
    assert (summed.chain, summed.seeds, summed.frequencies) == (breather.chain, breather.seeds, breather.frequencies)
    assert (summed.phases, summed.digits) == (breather.phases, None)
    assert np.array_equal(summed.harmonics, breather.harmonics)
    assert np.abs(summed.cosines - breather.cosines).max() < RESUMMED * np.abs(breather.cosines).max()
    assert summed.origin.disagreement.shape == summed.cosines.shape
    assert summed.origin.disagreement.max() < RESUMMED
    assert summed.Q(3.7) == pytest.approx(breather.Q(3.7), rel=0, abs=RESUMMED)


def test_the_divergent_torus_of_fig_1_is_summed(two_torus):
    """Truncated at order 30 it leaves 5e-4 of the accelerations, resummed less than 1e-5."""
    assert two_torus.residual() > 4e-4
    residuals = [t.residual() for t in resum_by_order(two_torus, (18, 24, 30))]
    assert residuals == sorted(residuals, reverse=True)
    assert residuals[-1] < SUMMED_FIG1
    assert resum(two_torus).residual() == residuals[-1]


TORI = {
    "beta, two seeds": (Chain(8, beta="0.3"), (1, 2), ("0.3925", "0.7695"), 5),
    "mixed": (Chain(8, alpha="0.2", beta="0.3"), (1, 2), ("0.3925", "0.7695"), 6),
    "alpha, one seed": (Chain(8, alpha="0.3"), (3,), ("1.1125",), 8),
    "alpha, digits": (Chain(8, alpha="0.3"), (3,), ("1.1125",), 8),
}


@pytest.mark.parametrize("name", TORI)
def test_coefficients_are_sums_over_the_orders_of_their_harmonic(name):
    """Entry by entry from harmonic_terms: the terms of one coefficient, zeros of the wrong parity left out."""
    chain, seeds, frequencies, order = TORI[name]
    series = lindstedt(chain, seeds, frequencies, order, digits=25 if "digits" in name else None)
    torus = solve_amplitudes(series)
    summed = resum(torus)
    amplitudes = [torus.amplitudes[q] for q in seeds]
    step = 2 // chain.degree_step
    with series.numbers.context(series.digits):
        terms = [series.harmonic_terms(amplitudes, k) for k in range(order + 1)]
        parts = [dict(zip(map(tuple, nu.tolist()), values, strict=True)) for nu, values in terms]
        for row, nu in enumerate(map(tuple, summed.harmonics.tolist())):
            first = next(k for k in range(order + 1) if nu in parts[k])
            rows = [parts[k][nu] for k in range(first, order + 1, step) if nu in parts[k]]
            expected = pade_sum(np.stack(rows))
            assert np.array_equal(summed.cosines[row], expected.values)
            assert np.array_equal(summed.origin.disagreement[row], expected.disagreement)


@pytest.mark.parametrize("name", ["mixed", "alpha, one seed", "beta, two seeds"])
@pytest.mark.parametrize("order", [0, 1])
def test_the_lowest_orders_have_nothing_to_accelerate(name, order):
    """Of every coefficient there is one term, or two, which are added."""
    chain, seeds, frequencies, highest = TORI[name]
    torus = solve_amplitudes(lindstedt(chain, seeds, frequencies, highest), order=order)
    summed = resum(torus)
    assert summed.cosines == pytest.approx(torus.cosines, rel=ROUNDING, abs=0)
    assert summed.residual() == pytest.approx(torus.residual(), rel=RESIDUAL_ROUNDING)
