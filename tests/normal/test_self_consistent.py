"""The series of normal frequencies, solved at a torus, against Newton's method on eigenfunctions."""

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, normal_modes, solve_normal_frequency
from tests.normal.cases import torus
from tests.tolerances import NORMAL_CONVERGED, OBSERVED_ORDER, THIRTY_DIGITS

MODELS = {
    "alpha": (Chain(5, alpha="0.3"), 4),
    "beta": (Chain(5, beta="0.5"), 2),
    "Toda": (Chain(6, potential="toda:1/2"), 4),
    "both": (Chain(5, alpha="0.3", beta="0.2"), 4),
}


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
    solution = symfpu.torus(Chain(4, beta=1), (1,), amplitudes={1: "0.1"}, method="series", order=3, digits=30)
    found = solve_normal_frequency(solution, 3, 3, digits=30)
    assert abs(found.at(solution.amplitudes) / found.sigma - 1) < THIRTY_DIGITS
    doubles = solve_normal_frequency(solution, 3, 3)
    assert doubles.sigma == pytest.approx(float(found.sigma), abs=NORMAL_CONVERGED)


@pytest.mark.long
def test_a_hyperbolic_direction_is_refused():
    """Far beyond the onset no real sigma solves the equation, once the partner's divisor enters."""
    solution = torus(Chain(8, beta=1), ((1, "0.1"), (5, "0.7")), 6)
    with pytest.raises(symfpu.NoNormalModes, match="continues mode 4"):
        solve_normal_frequency(solution, 4, 5)


def test_arguments_out_of_range_are_refused():
    breather = symfpu.torus(Chain(4, beta=1), (2,), amplitudes={2: "0.1"})
    for arguments, message in (((2, 3), "no seed"), ((4, 3), "^mode"), ((1, 0), "^order")):
        with pytest.raises(InputError, match=message):
            solve_normal_frequency(breather, *arguments)
    with pytest.raises(InputError, match="solution"):
        solve_normal_frequency(3, 1, 2)


@pytest.mark.parametrize("law", [{"alpha": "0.3"}, {"beta": "0.5"}, {"potential": "toda:1/2"}], ids=str)
def test_what_the_series_of_a_ring_misses_is_of_the_next_order(law):
    """About a travelling wave, of waves in both directions, q = N/2 and the seed's own opposite among them."""
    chain, order = Chain(8, ends="periodic", **law), 2
    missing = []
    for amplitude in ("0.1", "0.2"):
        solution = symfpu.torus(chain, (1,), amplitudes={1: amplitude})
        exact = normal_modes(solution).frequencies
        assert set(exact) == {-3, -2, -1, 2, 3, 4}
        missing.append([abs(solve_normal_frequency(solution, q, order).sigma - w) for q, w in exact.items()])
    power = chain.degree_step * order + 2
    rates = np.log2(np.array(missing[1]) / np.array(missing[0]))
    assert rates == pytest.approx(power, abs=OBSERVED_ORDER)


def test_the_series_of_a_ring_is_that_of_its_amplitudes():
    solution = symfpu.torus(Chain(8, alpha="0.3", ends="periodic"), (1,), amplitudes={1: "0.2"})
    found = solve_normal_frequency(solution, -3, 4)
    given = symfpu.normal_frequency_series(solution.chain, (1,), -3, 4, found.frequencies)
    assert given.at({1: 0.2}) == pytest.approx(found.sigma, abs=NORMAL_CONVERGED)
    assert float(found.correction(2).subs({"A1": 1})) == found.coefficients[2][(2,)]


def test_a_ring_has_no_other_series_than_of_travelling_waves_in_doubles():
    solution = symfpu.torus(Chain(8, alpha="0.3", ends="periodic"), (1,), amplitudes={1: "0.2"})
    with pytest.raises(InputError, match=r"^digits"):
        solve_normal_frequency(solution, 2, 2, digits=30)
    with pytest.raises(InputError, match="standing"):
        solve_normal_frequency(symfpu.unfold(symfpu.torus(Chain(4, beta=1), (1,), amplitudes={1: "0.1"})), 2, 2)
    with pytest.raises(InputError, match="on a ring give frequencies="):
        symfpu.normal_frequency_series(solution.chain, (1,), 2, 2)
    with pytest.raises(InputError, match="fixed ends"):
        solve_normal_frequency(solution, 2, 2).closed_shift()
    omega = {1: "0.76", 2: "1.4"}
    for option in ({"digits": 20}, {"ring": "nested"}):
        with pytest.raises(InputError, match=f"^{next(iter(option))}"):
            symfpu.normal_frequency_series(solution.chain, (1,), 2, 2, omega, **option)
