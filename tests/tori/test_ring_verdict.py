"""The verdict on waves of a ring: the words of fixed ends for the same torus, and what is refused."""

import numpy as np
import pytest

from symfpu import Chain, InputError, assess, lindstedt, solve_amplitudes, unfold
from tests.tolerances import RESUMMED

CASES = [("0.3903", 8), ("0.3903", 2)]


def test_amplitudes_settle_as_those_of_fixed_ends_where_the_words_differ():
    """Opposite waves are judged at all angles of the two; fixed ends know one of them. Near the end of the series this is seen."""
    fixed = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3925",), 12)
    waves = lindstedt(Chain(16, alpha="0.3", ends="periodic"), (1, -1), ("0.3925", "0.3925"), 12)
    between, around = assess(fixed, solve_amplitudes(fixed)), assess(waves, solve_amplitudes(waves))
    assert around.root_uncertainty == pytest.approx(between.root_uncertainty, rel=RESUMMED)
    assert around.residuals[-1] > 2 * between.residuals[-1]


@pytest.mark.parametrize(("omega", "order"), CASES)
def test_a_standing_wave_is_judged_as_that_of_fixed_ends(omega, order):
    fixed = lindstedt(Chain(8, alpha="0.3"), (1,), (omega,), order)
    between = assess(fixed, solve_amplitudes(fixed))
    waves = lindstedt(Chain(16, alpha="0.3", ends="periodic"), (1, -1), (omega, omega), order)
    around = assess(waves, solve_amplitudes(waves))
    assert around.verdict == between.verdict
    assert around.growth == pytest.approx(between.growth, rel=RESUMMED)
    assert around.best_order == between.best_order
    if np.isfinite(between.root_uncertainty):
        assert around.root_uncertainty == pytest.approx(between.root_uncertainty, rel=RESUMMED)


def test_one_wave_far_below_its_radius_converges_and_far_beyond_it_does_not():
    words = []
    for omega in ("0.767", "1.1"):
        series = lindstedt(Chain(8, beta=1, ends="periodic"), (-1,), (omega,), 8)
        found = assess(series, solve_amplitudes(series))
        assert len(found.residuals) == len(found.energy_errors) == 9
        words.append(found.word)
    assert words[0] == "converged"
    assert words[1] != "converged"


def test_a_torus_of_another_series_is_refused():
    series = lindstedt(Chain(16, alpha="0.3", ends="periodic"), (1,), ("0.391",), 4)
    other = lindstedt(Chain(16, alpha="0.3", ends="periodic"), (1,), ("0.3911",), 4)
    standing = unfold(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.391",), 4)))
    for torus in (solve_amplitudes(other), standing):
        with pytest.raises(InputError, match=r"solved from this series|a torus of a series"):
            assess(series, torus)


def test_terms_of_opposite_seeds_are_named_apart():
    """Each wave of a seed has the divisor 0 in its own mode."""
    series = lindstedt(Chain(7, beta="0.5", ends="periodic"), (1, -1), ("0.868767", "0.868667"), 3)
    first, *_ = assess(series, solve_amplitudes(series)).terms
    assert first.order == 0
    assert (first.mode, first.harmonic) in {(1, (1, 0)), (-1, (0, 1))}
    assert first.divisor == 0
