"""The series of normal frequencies, solved at a torus, against Newton's method on eigenfunctions."""

from functools import cache

import numpy as np
import pytest

from symfpu.breathers.balance import breather_at_amplitude
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.normal.modes import NoNormalModes
from symfpu.normal.search import normal_modes
from symfpu.normal.self_consistent import solve_normal_frequency
from symfpu.refinement.tori import refine_at_amplitudes
from symfpu.tori.frequencies import torus_at_amplitudes
from tests.tolerances import NORMAL_CONVERGED, OBSERVED_ORDER, THIRTY_DIGITS

MODELS = {
    "alpha": (Chain(5, alpha="0.3"), 4),
    "beta": (Chain(5, beta="0.5"), 2),
    "Toda": (Chain(6, potential="toda:1/2"), 4),
    "both": (Chain(5, alpha="0.3", beta="0.2"), 4),
}


@cache
def torus(chain, amplitudes, order):
    wanted = dict(amplitudes)
    return refine_at_amplitudes(torus_at_amplitudes(chain, wanted, order=order), wanted)


@pytest.mark.parametrize("model", ["alpha", *(pytest.param(m, marks=pytest.mark.long) for m in ("beta", "Toda", "both"))])
def test_what_the_series_misses_is_of_the_next_order(model):
    chain, order = MODELS[model]
    missing = []
    for scale in (1, 2):
        solution = torus(chain, ((1, f"{scale * 0.04}"), (3, f"{scale * 0.03}")), 2 * order)
        exact = normal_modes(solution).frequencies
        missing.append([abs(solve_normal_frequency(solution, q, order).sigma - w) for q, w in exact.items()])
    power = chain.degree_step * order + 2
    assert np.log2(np.divide(missing[1], missing[0])) == pytest.approx(power, abs=OBSERVED_ORDER)


def test_the_solution_solves_the_equation_with_digits():
    solution = torus_at_amplitudes(Chain(4, beta=1), {1: "0.1"}, order=3, digits=30)
    found = solve_normal_frequency(solution, 3, 3, digits=30)
    assert abs(found.at(solution.amplitudes) / found.sigma - 1) < THIRTY_DIGITS
    doubles = solve_normal_frequency(solution, 3, 3)
    assert doubles.sigma == pytest.approx(float(found.sigma), abs=NORMAL_CONVERGED)


@pytest.mark.long
def test_a_hyperbolic_direction_is_refused():
    """Far beyond the onset no real sigma solves the equation, once the partner's divisor enters."""
    solution = torus(Chain(8, beta=1), ((1, "0.1"), (5, "0.7")), 6)
    with pytest.raises(NoNormalModes, match="continues mode 4"):
        solve_normal_frequency(solution, 4, 5)


def test_arguments_out_of_range_are_refused():
    breather = breather_at_amplitude(Chain(4, beta=1), 2, "0.1")
    for arguments, message in (((2, 3), "no seed"), ((4, 3), "^mode"), ((1, 0), "^order")):
        with pytest.raises(InputError, match=message):
            solve_normal_frequency(breather, *arguments)
    with pytest.raises(InputError, match="solution"):
        solve_normal_frequency(3, 1, 2)


def test_two_particles():
    chain = Chain(3, alpha=1)
    found = solve_normal_frequency(breather_at_amplitude(chain, 1, "0.02"), 2, 8)
    exact = normal_modes(breather_at_amplitude(chain, 1, "0.02")).frequencies[2]
    assert found.sigma == pytest.approx(exact, abs=NORMAL_CONVERGED)
