"""The verdict on waves of a ring: the words of fixed ends for the same torus, and what is refused."""

import numpy as np
import pytest

from symfpu import Chain, assess, lindstedt, solve_amplitudes, travelling_torus, travelling_waves, unfold
from symfpu.errors import InputError
from symfpu.tori.ring_verdict import assess_waves
from tests.tolerances import RESUMMED

CASES = [("0.3903", 8), ("0.3903", 2)]


def test_amplitudes_settle_as_those_of_fixed_ends_where_the_words_differ():
    """Opposite waves are judged at all angles of the two; fixed ends know one of them. Near the end of the series this is seen."""
    fixed = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3925",), 12)
    waves = travelling_waves(Chain(16, alpha="0.3", ends="periodic"), (1, -1), ("0.3925", "0.3925"), 12)
    between, around = assess(fixed, solve_amplitudes(fixed)), assess_waves(waves, travelling_torus(waves))
    assert around.root_uncertainty == pytest.approx(between.root_uncertainty, rel=RESUMMED)
    assert around.residuals[-1] > 2 * between.residuals[-1]


@pytest.mark.parametrize(("omega", "order"), CASES)
def test_a_standing_wave_is_judged_as_that_of_fixed_ends(omega, order):
    fixed = lindstedt(Chain(8, alpha="0.3"), (1,), (omega,), order)
    between = assess(fixed, solve_amplitudes(fixed))
    waves = travelling_waves(Chain(16, alpha="0.3", ends="periodic"), (1, -1), (omega, omega), order)
    around = assess_waves(waves, travelling_torus(waves))
    assert around.headline == between.headline
    assert around.growth == pytest.approx(between.growth, rel=RESUMMED)
    assert around.best_order == between.best_order
    if np.isfinite(between.root_uncertainty):
        assert around.root_uncertainty == pytest.approx(between.root_uncertainty, rel=RESUMMED)


def test_one_wave_far_below_its_radius_converges_and_far_beyond_it_does_not():
    words = []
    for omega in ("0.767", "1.1"):
        series = travelling_waves(Chain(8, beta=1, ends="periodic"), (-1,), (omega,), 8)
        found = assess_waves(series, travelling_torus(series))
        assert len(found.residuals) == len(found.energy_errors) == 9
        words.append(found.word)
    assert words[0] == "converged"
    assert words[1] != "converged"


def test_a_torus_of_another_series_is_refused():
    series = travelling_waves(Chain(16, alpha="0.3", ends="periodic"), (1,), ("0.391",), 4)
    other = travelling_waves(Chain(16, alpha="0.3", ends="periodic"), (1,), ("0.3911",), 4)
    standing = unfold(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.391",), 4)))
    for torus in (travelling_torus(other), standing):
        with pytest.raises(InputError, match="made from this series"):
            assess_waves(series, torus)
