"""Normal frequencies along lines of tori: onsets by both sides, by Floquet's multipliers, and crossings."""

import math
from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, normal_family, normal_modes, refine
from symfpu.families.normal_events import RESONANCE, STABILITY, discriminant
from symfpu.families.normal_zeros import Bracket, collision
from symfpu.normal.resonances import PARAMETRIC, SUM
from tests.normal.test_meeting import EDGES
from tests.refusals import each, refused
from tests.tolerances import BESIDE_A_CROSSING, BESIDE_AN_ONSET, NARROW_EVENT, NORMAL_CONVERGED, ONSET

HYPERBOLIC = Chain(8, beta=1)


@cache
def along_breathers():
    breather = symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: "0.5"})
    return normal_family(breather, {2: "1"}, members=2, modes=[1])


def test_a_collision_is_found_without_looking_near_it():
    asked = []

    def D(x):
        asked.append(x)
        return math.expm1(0.43 - x) * (1 + x)

    part, error = collision(D, Bracket(0.38, 0.46, D(0.38), D(0.46)), 1e-3)
    assert part == pytest.approx(0.43, abs=NORMAL_CONVERGED)
    assert error < NORMAL_CONVERGED
    assert min(abs(x - 0.43) for x in asked) > 1e-4


@pytest.mark.long
def test_a_breather_loses_its_stability_where_a_multiplier_leaves_the_circle():
    [event] = along_breathers().events
    assert (event.kind, event.begins, event.after) == (STABILITY, True, 0)
    assert (event.resonance.kind, event.resonance.modes, event.resonance.harmonic) == (PARAMETRIC, (1,), (1,))
    for side in (-1, 1):
        A = event.amplitudes[2] + side * BESIDE_AN_ONSET
        assert symfpu.floquet(symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: repr(A)})).stable == (side < 0)


@pytest.mark.long
def test_what_comes_back_says_so():
    breather = symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: "1"})
    [event] = normal_family(breather, {2: "0.5"}, members=2, modes=[1]).events
    assert not event.begins
    assert event.amplitudes[2] == pytest.approx(along_breathers().events[0].amplitudes[2], abs=ONSET)
    assert "hyperbolic up to" in repr(event)


@pytest.mark.long
def test_the_onset_of_a_torus_is_the_same_from_both_sides():
    """By real frequencies alone, and by rates of growth alone: four tori each, beside it on one side."""
    start = {1: "0.1", 5: "0.41"}
    solution = refine(symfpu.torus(HYPERBOLIC, tuple(start), amplitudes=start, method="series", order=6), amplitudes=start)
    [event] = normal_family(solution, {1: "0.1", 5: "0.44"}, members=2, modes=[4, 6]).events
    assert (event.resonance.kind, event.resonance.modes, event.resonance.harmonic) == (SUM, (4, 6), (0, 2))
    for side in (-1, 1):
        places = event.amplitudes[5] + side * np.arange(1, 5) * 6e-4
        values = []
        for A in places:
            torus = refine(solution, amplitudes={1: "0.1", 5: float(A)})
            found = normal_modes(torus, modes=[4, 6])
            assert found.stable == (side < 0)
            values.append(discriminant(found, event.resonance))
        onset = sum(a * np.prod([v / (v - w) for v in values if v != w]) for a, w in zip(places, values, strict=True))
        assert event.amplitudes[5] == pytest.approx(onset, abs=ONSET)


@pytest.mark.long
def test_a_narrow_tongue_of_a_torus_has_both_ends():
    """2 sigma_4 = (3,1).omega, 2e-5 of an amplitude wide, between two tori 0.15 apart; the ends as those that digits judge."""
    start = {1: "0.1", 5: "0.1"}
    solution = refine(symfpu.torus(HYPERBOLIC, tuple(start), amplitudes=start, method="series", order=6), amplitudes=start)
    begins, ends = normal_family(solution, {1: "0.1", 5: "0.25"}, members=2, modes=[4], resonance_length=4).events
    assert (begins.begins, ends.begins) == (True, False)
    for event, edge in zip((begins, ends), EDGES, strict=True):
        assert (event.resonance.kind, event.resonance.harmonic) == (PARAMETRIC, (3, 1))
        assert event.amplitudes[5] == pytest.approx(edge, abs=NARROW_EVENT)
        assert abs(event.amplitudes[5] - edge) < 0.15 * event.error


@pytest.mark.long
def test_a_resonance_that_is_crossed_without_harm():
    """Of modes 1 and 3 beside mode 2, which do not couple at twice its frequency."""
    chain = Chain(4, beta=1)
    [event] = normal_family(symfpu.torus(chain, (2,), amplitudes={2: "0.6"}), {2: "1"}, members=2).events
    assert (event.kind, event.resonance.condition) == (RESONANCE, "sigma_1 + sigma_3 = (2).omega")
    sides = []
    for side in (-1, 1):
        A = event.amplitudes[2] + side * BESIDE_A_CROSSING
        found = normal_modes(symfpu.torus(chain, (2,), amplitudes={2: repr(A)}))
        assert found.stable
        sides.append(event.resonance.distance_of(found))
    assert sides[0] * sides[1] < 0
    assert sum(sides) == pytest.approx(0, abs=BESIDE_A_CROSSING**2)


def test_a_distance_is_that_of_the_list():
    found = normal_modes(symfpu.torus(Chain(4, beta=1), (2,), amplitudes={2: "0.1"}))
    for resonance in found.resonances:
        assert resonance.distance_of(found) == pytest.approx(resonance.distance, abs=NORMAL_CONVERGED)
    assert symfpu.ParametricResonance("own", (3,), (0,), 0.0).left_of({3: 1.5}) == 1.5


@each(amplitudes=[{3: "1"}, {2: "x"}], members=[1], modes=[[2]], resonance_length=[-1], solution=[3])
def test_arguments_out_of_range_are_refused(name, value):
    refused(normal_family, name, value, solution=symfpu.torus(Chain(4, beta=1), (2,), amplitudes={2: "0.1"}), amplitudes={2: "1"})
