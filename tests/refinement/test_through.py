"""Tori through given coordinates of their seeds at t = 0: the conditions, orbits that stay on them, wrong arguments."""

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.dynamics.orbits import integrate
from symfpu.errors import InputError
from symfpu.refinement.conditions import Start
from symfpu.refinement.through import refine_at_start
from symfpu.tori.frequencies import torus_at_amplitudes
from tests.refinement.test_invariance import equation_and_coefficients
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
    found = torus.positions(0.0)
    for q, x in start.items():
        assert abs(found[q - 1] - float(x)) <= ROUNDING
    assert dict(torus.phases) == {q: float(phases.get(q, 0)) for q in amplitudes}
    orbit = integrate(chain, *torus.state(), 50.0, step=0.01, samples=3)
    assert np.abs(orbit.Q - torus.positions(orbit.times)).max() < ORBIT


def test_the_gradient_is_the_derivative_of_the_value():
    equation, c = equation_and_coefficients(Chain(8, alpha="0.3", beta="0.2"), (1, 2, 7), low=2, radius=3)
    condition = Start(1, np.longdouble("0.3"), (0.4, 1.0, 2.0), 0.7)
    shifts = np.zeros(3)
    by_cosine, by_shift = condition.gradient(equation, c, shifts)
    change = np.where(equation.mask, np.random.default_rng(2).normal(size=c.shape), 0)
    moved = condition.value(equation, c + change, shifts) - condition.value(equation, c, shifts)
    assert float(moved) == pytest.approx((by_cosine * change).sum(), rel=ROUNDING)
    assert not by_shift.any()
    torus_value = (c[:, 1] @ np.cos(equation.harmonics @ np.array([0.4, 1.0, 2.0])) - 0.3) / 0.7
    assert float(condition.value(equation, c, shifts)) == pytest.approx(torus_value, rel=ROUNDING)


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
