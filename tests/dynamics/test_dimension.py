"""Verdicts on orbits: none too early, none taken back, over random states, frames and times; and the measures behind them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from symfpu import AlignmentIndices, Chain, alignment_indices
from symfpu.dynamics.dimension import CHAOS_GROWTH, EARLY_TIME, FULL_DECADES, LOW_DECADES, ODDNESS, linear_decades, outgrown_powers
from tests.tolerances import DECADES, LATE_DECADES, WHOLE_NUMBERS

MIXED, BETA = Chain(32, alpha="0.33", beta="0.1"), Chain(8, beta=1)
TIMES = np.geomspace(1.0, 1e7, 500)


def state(n, scale, seed):
    """Displacements and momenta as mode coordinates: normal deviates times the scale."""
    draws = np.random.default_rng(seed)
    return scale * draws.normal(size=n), scale * draws.normal(size=n)


def until(found, T):
    """The same run, ended earlier."""
    early = found.times <= 1.001 * T
    parts = {name: getattr(found, name)[early] for name in ("times", "log10_gali", "lyapunov")}
    return replace(found, **parts)


def verdicts(found, longest):
    """What is said after a thousand units of time, and then three times in every factor of ten."""
    times = np.geomspace(1e3, longest, 1 + round(3 * np.log10(longest / 1e3)))
    return [until(found, T).dimension().verdict for T in times]


@cache
def mixed(seed):
    x, p = state(31, 0.3, seed)
    return alignment_indices(MIXED, MIXED.modes(x), MIXED.modes(p), 3e5, vectors=2, samples=600, frames=1)


def made(growth, steps, vectors=5, N=16):
    """Indices with the slopes of a torus and any growth of the first vector."""
    falls = np.cumsum(np.broadcast_to(steps, vectors - 1))
    return AlignmentIndices(Chain(N, alpha="0.33"), TIMES, np.log10(TIMES)[:, None] * falls, growth / TIMES, 0.4, 1e-12)


@pytest.mark.long
@pytest.mark.parametrize("frame", range(6))
@pytest.mark.parametrize(("seed", "T"), [(0, 1e4), (1, 3e4), (2, 3e3)])
def test_a_chaotic_orbit_is_not_called_regular_before_its_chaos_shows(seed, T, frame):
    x, p = state(31, 0.3, seed)
    found = alignment_indices(MIXED, MIXED.modes(x), MIXED.modes(p), T, vectors=2, seed=frame, frames=1).dimension()
    assert found.verdict == "undecided"
    assert "take a longer time" in found.reason


@pytest.mark.long
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(1, 6))])
def test_it_is_called_chaotic_once_it_shows_with_two_vectors_too(seed):
    said = verdicts(mixed(seed), 1e5)
    assert said == ["undecided"] * said.index("chaotic") + ["chaotic"] * (len(said) - said.index("chaotic"))


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(
    ("chain", "scale"),
    [(BETA, 0.1), (BETA, 0.3), (Chain(8, alpha="0.5", beta="0.1"), 0.2), (Chain(4, beta=1), 0.5)],
)
def test_no_word_is_taken_back(chain, scale, seed):
    """Regular and chaotic states, among them one that grows as t for more than three decades and is chaotic after all (N = 4, seed 3)."""
    found = alignment_indices(chain, *state(chain.N - 1, scale, seed), 1e5, samples=600, vectors=6, frames=1)
    for vectors in (2, 4, 6):
        said = verdicts(replace(found, log10_gali=found.log10_gali[:, : vectors - 1]), 1e5)
        words = [word for word in said if word != "undecided"]
        assert len(set(words)) <= 1
        assert said[len(said) - len(words) :] == words


@pytest.mark.long
@pytest.mark.parametrize("frame", range(6))
@pytest.mark.parametrize(
    ("chain", "Q", "P"),
    [
        (BETA, [0, 0, 0, 0.3, 0, 0, 0], [0] * 7),
        (Chain(2, beta=1), [0.5], [0.0]),
        (Chain(2, beta=1), [0.0], [3.0]),
    ],
)
def test_periodic_orbits_are_regular_in_every_frame(chain, Q, P, frame):
    found = alignment_indices(chain, Q, P, 1e5, step=0.2, vectors=2, seed=frame, frames=1)
    assert found.dimension().verdict == "regular, dimension 1"
    assert set(verdicts(found, 1e5)) <= {"undecided", "regular, dimension 1"}


@pytest.mark.parametrize("seed", [0, 2])
def test_a_torus_of_full_dimension_is_believed_after_four_decades(seed):
    chain = Chain(4, beta=1)
    found = alignment_indices(chain, *state(3, 0.5, seed), 2e5, samples=600, frames=1)
    assert until(found, 2e4).dimension().verdict == "undecided"
    assert found.dimension().verdict == "regular, dimension 3"


def test_what_is_undecided_says_what_it_would_take():
    late = np.log(np.maximum(TIMES, 1e4))
    reason = made(late, 0.0).dimension().reason
    assert "|v| has grown as t for 3.0 decades, and 4 are needed" in reason
    assert reason.endswith("take a longer time, about 1e+08, or take more vectors")
    assert made(late + np.log(np.maximum(TIMES, 1e6) / 1e6), 0.0).dimension().verdict == "undecided"
    assert "e^10 would do" in made(2 * np.log(TIMES), 0.0).dimension().reason
    assert made(0 * late, 0.0).dimension().reason.endswith("on a torus as t^1 in the end: take a longer time")


def test_a_low_dimension_needs_fewer_decades_than_a_full_one():
    late = np.log(np.maximum(TIMES, 10 ** (7 - LOW_DECADES - 0.3)))
    assert made(late, [0, -1, -1, -1]).dimension().verdict == "regular, dimension 2"
    assert made(late, [0, 0, 0, 0]).dimension().verdict == "undecided"
    assert made(np.log(TIMES), [0, 0, 0, 0]).dimension().verdict == "regular, dimension 5 or more"
    assert made(late, [0, 0, -1, -1], N=5).dimension().verdict == "undecided"  # 3 of 4 dimensions
    assert made(np.log(TIMES), [0, 0, -1, -1], N=5).dimension().verdict == "regular, dimension 3"


def test_slopes_that_have_not_settled_decide_nothing():
    found = made(np.log(TIMES), [0, -1, -1, -1])
    bent = found.log10_gali - 0.6 * np.maximum(0.0, np.log10(TIMES) - 6.25)[:, None]
    assert replace(found, log10_gali=bent).dimension().verdict == "undecided"


@pytest.mark.parametrize("power", [0.0, 1.0, 2.0, 3.0])
def test_no_power_that_a_torus_may_have_is_chaos(power):
    waves = np.sin(7 * np.log(TIMES))
    assert outgrown_powers(TIMES, power * np.log(TIMES) + waves) < CHAOS_GROWTH / 2
    assert made(power * np.log(TIMES), 0.0).dimension().verdict != "chaotic"


def test_exponential_growth_outgrows_every_power_and_that_stays():
    growth = np.log(TIMES) + 1e-3 * np.minimum(TIMES, 1e5)
    outgrown = [outgrown_powers(TIMES[:n], growth[:n]) for n in range(100, 501, 20)]
    assert outgrown == sorted(outgrown)
    assert outgrown[0] == pytest.approx(0.0, abs=WHOLE_NUMBERS)
    assert outgrown[-1] > 5 * CHAOS_GROWTH


def test_linear_growth_is_counted_back_from_the_end():
    assert linear_decades(TIMES, np.log(TIMES)) == pytest.approx(7 - np.log10(EARLY_TIME), abs=DECADES)
    assert linear_decades(TIMES, np.log(np.maximum(TIMES, 1e4))) == pytest.approx(3.0, abs=LATE_DECADES)
    assert linear_decades(TIMES, (1 + 2 * ODDNESS) * np.log(TIMES)) == 0.0
    assert FULL_DECADES > LOW_DECADES


@pytest.mark.parametrize(
    ("steps", "growth", "supported"),
    [
        ([0, -1, -1, -0.5], 1.0, 2),  # G_2, G_3, G_4 have settled, G_5 has not
        ([-1, -0.5, -0.5, -0.5], 1.0, 1),
        ([0, 0, -0.5, -1], 1.0, None),
        ([0, -1, -1, -0.5], 0.3, None),  # before vectors grow indices say nothing
    ],
)
def test_an_undecided_orbit_has_a_best_supported_dimension(steps, growth, supported):
    found = made(growth * np.log(TIMES), steps).dimension()
    assert (found.verdict, found.value, found.supported) == ("undecided", None, supported)


def test_a_decided_dimension_is_the_supported_one():
    found = made(np.log(TIMES), [0, -1, -1, -1]).dimension()
    assert found.supported == found.value == 2
    assert found.frames == (2,)
