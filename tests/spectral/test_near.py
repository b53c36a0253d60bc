"""From an orbit back to its torus."""

from dataclasses import replace

import pytest

from symfpu import Chain, InputError, frequency_analysis, integrate, lindstedt, refine, solve_amplitudes, torus_near
from tests.tolerances import AMPLITUDE_FROM_LINES


@pytest.fixture(scope="module")
def found():
    series = lindstedt(Chain(N=4, beta=1), (1, 2), ("0.769", "1.42"), 5)
    torus = refine(solve_amplitudes(series, phases={1: 0.4, 2: 1.0}))
    orbit = integrate(torus.chain, *torus.state(3.0), 3000, step=0.1)
    return torus, frequency_analysis(orbit, lines=8, level=1e-9)


def test_newton_finds_the_torus_that_the_orbit_is_on(found):
    torus, analysis = found
    near = torus_near(analysis)
    assert near.residual() < 1e-2
    again = refine(near)
    for q in (1, 2):
        assert abs(again.amplitudes[q]) == pytest.approx(abs(torus.amplitudes[q]), abs=AMPLITUDE_FROM_LINES)
    assert float(again.energy()) == pytest.approx(float(torus.energy()), abs=AMPLITUDE_FROM_LINES)
    start = torus.Q(3.0)
    assert again.Q(0.0) == pytest.approx(start, abs=AMPLITUDE_FROM_LINES)


def test_fewer_seeds_leave_the_other_lines_out(found):
    _, analysis = found
    near = torus_near(analysis, (1,))
    assert near.seeds == (1,)
    assert near.harmonics.shape[1] == 1


def test_bad_arguments_are_named(found):
    with pytest.raises(InputError, match="seeds"):
        torus_near(found[1], (3,))
    with pytest.raises(InputError, match="FrequencyAnalysis"):
        torus_near(found[0])


def test_a_second_frequency_of_a_mode_is_no_seed(found):
    """Named 3 for want of another name, it moves mode 2: a torus of seed 3 would have A_3 = 0."""
    _, analysis = found
    renamed = replace(analysis, seeds=tuple(3 if q == 2 else q for q in analysis.seeds))
    with pytest.raises(InputError, match=r"3, a second frequency of mode 2 .* take seeds=\(1,\)"):
        torus_near(renamed)
    assert torus_near(renamed, (1,)).seeds == (1,)
