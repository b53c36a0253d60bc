"""Tori through given coordinates of their seeds at t = 0: the conditions, orbits that stay on them, wrong arguments."""

import numpy as np
import pytest

from symfpu import Chain, InputError, integrate, refine_at_start, torus_at_amplitudes
from tests.refinement.test_ring_tori import of_series
from tests.tolerances import ORBIT, ROUNDING

PI = "3.14159265358979324"
CASES = (
    (Chain(8, alpha="0.3"), {1: "0.4", 2: "0.02"}, {2: PI}, {1: "0.4", 2: 0}),
    (Chain(8, beta="0.3"), {1: "0.3", 3: "0.01"}, {}, {1: "0.3", 3: "0.011"}),
    (Chain(2, beta=1), {1: "0.4"}, {}, {1: "0.41"}),
    (Chain(7, potential="toda:0.4"), {2: "0.2", 6: "0.1"}, {2: "0.5"}, {2: "0.17", 6: "0.1"}),
    (Chain(4, alpha="0.3"), {1: "0.2", 2: "0.1", 3: "0.05"}, {1: PI}, {1: "-0.2", 2: "0.1", 3: "0.05"}),
)


@pytest.mark.parametrize(("chain", "amplitudes", "phases", "start"), CASES, ids=repr)
def test_seeds_start_where_they_are_told_and_the_orbit_stays_on_it(chain, amplitudes, phases, start):
    torus = refine_at_start(torus_at_amplitudes(chain, amplitudes, order=4, phases=phases), start)
    assert torus.verdict == "torus"
    found = torus.Q(0.0)
    for q, x in start.items():
        assert abs(found[q - 1] - float(x)) <= ROUNDING
    assert dict(torus.phases) == {q: float(phases.get(q, 0)) for q in amplitudes}
    orbit = integrate(chain, *torus.state(), 50.0, step=0.01, samples=3)
    assert np.abs(orbit.Q - torus.Q(orbit.times)).max() < ORBIT


@pytest.mark.parametrize(
    ("coordinates", "words"),
    [
        ({1: "0.4"}, "name every seed"),
        ({1: "0.4", 2: 0, 3: 0}, "name every seed"),
        ([0.4, 0.0], "name every seed"),
        ({1: 0, 2: 0}, "an orbit that moves"),
        ({1: "near", 2: 0}, "coordinates, 1"),
    ],
)
def test_wrong_coordinates(coordinates, words):
    guess = torus_at_amplitudes(Chain(8, alpha="0.3"), {1: "0.4", 2: "0.02"}, order=2)
    with pytest.raises(InputError, match=words):
        refine_at_start(guess, coordinates)


def test_what_is_no_torus_of_fixed_ends():
    with pytest.raises(InputError):
        refine_at_start("torus", {1: 1})
    with pytest.raises(InputError, match="ends"):
        refine_at_start(of_series(12, {2: 0.001, 3: 0.002}, {"beta": "0.3"}), {2: 1, 3: 1})
