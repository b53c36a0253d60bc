"""Parts of the spectral curve: heights of a discriminant, means over gaps, states from spectra, dH = sum omega dI of any state."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symfpu import BandsTooNarrow, Chain, InputError, NoDiscriminant, NoTodaTorus, toda, toda_invariants, toda_torus
from symfpu.integrable.discriminant import Edges, critical_points, edges, free_points
from symfpu.integrable.inverse import ring_state
from symfpu.integrable.quadrature import mean_rule
from symfpu.numbers.arithmetic import MULTIPRECISION, working_digits
from symfpu.numbers.mpfr import MPFR, in_mpf
from tests.integrable.chains import discriminant
from tests.tolerances import ACTIONS_IN_DOUBLES, FORTY_DIGITS, GAP, THIRTY_DIGITS, THOUSAND_ROUNDINGS, TODA_LINEAR


def chebyshev_ring(heights):
    """Critical points and bands of a ring with such gaps."""
    with working_digits(mpmath.mp.dps):
        values = MPFR.array(MULTIPRECISION.array(heights))
        points = critical_points(values, free_points(len(heights) + 1))
        bands = edges(points, values)
    widths, outer = in_mpf(bands.half_widths), in_mpf(np.array([bands.top, bands.bottom], dtype=object))
    return in_mpf(points), Edges(in_mpf(bands.centres), widths, *outer)


@pytest.mark.parametrize("heights", [[0, 0, 0], [1, 0, 0, 2, 0], ["1e-20", 3], [12], [0, 5, 0.5, 0]])
def test_the_discriminant_has_its_heights_and_edges(heights):
    """Of a ring that is made from its bands: Delta, by transfer matrices, is (-1)^j 2 cosh h_j at c_j, and +-2 at edges."""
    with mpmath.workdps(40):
        points, bands = chebyshev_ring(heights)
        bonds, momenta = ring_state(bands.centres + bands.half_widths)
        for j, (point, height) in enumerate(zip(points, heights, strict=True), start=1):
            value = discriminant(bonds, momenta, point)
            assert abs(value / (2 * (-1) ** j * mpmath.cosh(mpmath.mpf(height))) - 1) < THIRTY_DIGITS
        upper, lower = bands.centres + bands.half_widths, bands.centres - bands.half_widths
        for place in (*upper, *lower, bands.top, bands.bottom):
            assert abs(abs(discriminant(bonds, momenta, place)) - 2) < THIRTY_DIGITS
        assert (upper[1:] < lower[:-1]).all()


def test_small_gaps_keep_their_relative_accuracy():
    """Of half width h sin(theta)/n to lowest order."""
    with mpmath.workdps(20):
        _, bands = chebyshev_ring([0, "1e-40", 0])
        assert abs(bands.half_widths[1] / (mpmath.mpf("1e-40") / 4) - 1) < TODA_LINEAR


@pytest.mark.parametrize("distance", ["1e-1", "1e-4", "1e-9"])
def test_means_over_a_gap_are_exact_beside_bands_of_any_width(distance):
    """The mean of 1/(b - x) over |x| < w is 1/sqrt(b^2 - w^2)."""
    with mpmath.workdps(40):
        width, pole = mpmath.mpf("0.3"), mpmath.mpf("0.3") + mpmath.mpf(distance)
        nothing = MULTIPRECISION.zeros((1,))
        x, weights = mean_rule(Edges(nothing, nothing + width, pole, -mpmath.mpf(2)), 0, MULTIPRECISION)
        mean = (weights / (pole - x)).sum()
        assert abs(mean * mpmath.sqrt(pole**2 - width**2) - 1) < THIRTY_DIGITS
        assert abs(weights.sum() - 1) < FORTY_DIGITS


def test_a_band_of_no_width_is_refused():
    nothing = MULTIPRECISION.zeros((1,))
    touching = Edges(nothing, nothing + 1, mpmath.mpf(1), mpmath.mpf(-1))
    with pytest.raises(BandsTooNarrow, match="gap 1"):
        mean_rule(touching, 0, MULTIPRECISION)


@pytest.mark.parametrize("N", [2, 4])
def test_the_energy_changes_by_frequencies_times_changes_of_actions(N):
    """dH = sum omega dI for any state and any direction, by central differences."""
    chain, step = Chain(N, potential=toda("1/2")), mpmath.mpf("1e-14")
    with mpmath.workdps(50):
        draws = np.random.default_rng(N).integers(-50, 50, size=(2, 2, N - 1))
        (state, direction) = (MULTIPRECISION.array(draw.astype(object)) / 100 for draw in draws)
        omega = toda_invariants(chain, *state, digits=40).frequencies
        up, down = (state + sign * step * direction for sign in (1, -1))
        actions = [toda_invariants(chain, *moved, digits=40).actions for moved in (up, down)]
        by_actions = (omega * (actions[0] - actions[1])).sum() / (2 * step)
        by_energy = (chain.energy(*up) - chain.energy(*down)) / (2 * step)
        assert abs(by_actions - by_energy) < step * TODA_LINEAR


def test_invariants_in_doubles_are_those_of_digits():
    chain = Chain(6, alpha="1/3")
    state = np.random.default_rng(3).normal(size=(2, 5)) * 0.2
    doubles, digits = (toda_invariants(chain, *state, digits=n) for n in (None, 30))
    assert doubles.gaps == pytest.approx(digits.gaps.astype(float), abs=GAP)
    assert doubles.actions == pytest.approx(digits.actions.astype(float), rel=ACTIONS_IN_DOUBLES)
    assert doubles.frequencies == pytest.approx(digits.frequencies.astype(float), rel=THOUSAND_ROUNDINGS)
    assert repr(doubles) == repr(digits)
    assert doubles.a == Fraction(1, 3)


def test_invariants_at_rest_are_the_linear_frequencies():
    chain = Chain(7, alpha=1)
    found = toda_invariants(chain, np.zeros(6), np.zeros(6))
    assert found.frequencies == pytest.approx(chain.frequencies(), rel=THOUSAND_ROUNDINGS)
    assert abs(found.actions).max() < GAP**1.5


def test_invariants_are_of_one_state():
    with pytest.raises(InputError, match="toda_gaps takes many"):
        toda_invariants(Chain(3, alpha=1), np.zeros((2, 2)), np.zeros((2, 2)))


def test_frequencies_that_no_torus_has_are_refused_with_what_was_reached():
    """Where the gap of mode 2 is wide, mode 1 is faster than it is alone."""
    with pytest.raises(NoTodaTorus, match="raise the frequency of the lowest gap") as caught:
        toda_torus(Chain(3, potential=toda("1/2")), (1, 2), frequencies=("1.0001", "1.9"))
    assert caught.value.heights[0] < caught.value.heights[1]


def test_heights_beyond_reach_are_refused():
    with mpmath.workdps(20), pytest.raises(NoDiscriminant, match="smaller energy"):
        chebyshev_ring(["1e4", 0, 0])
