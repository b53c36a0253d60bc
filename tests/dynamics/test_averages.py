"""Running averages of mode energies: against sums by hand, closed forms, and runs that were interrupted."""

import numpy as np
import pytest

from symfpu import Chain, integrate, lindstedt, refine, solve_amplitudes
from symfpu.dynamics.schemes import SCHEMES
from tests.tolerances import SLOPE, THOUSAND_ROUNDINGS

MIXED = Chain(7, alpha="0.3", beta="0.2")
STEP = 0.125  # four of them between two looks


@pytest.fixture(scope="module")
def start():
    draws = np.random.default_rng(5)
    return draws.normal(scale=0.2, size=(3, 6)), draws.normal(scale=0.2, size=(3, 6))


@pytest.fixture(scope="module")
def torus():
    return refine(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3905", "0.7663"), 6)))


@pytest.mark.parametrize("name", SCHEMES)
def test_averages_are_trapezoid_sums_of_the_samples(name, start):
    made = integrate(MIXED, *start, 60.0, step=STEP, scheme=name, samples=np.arange(0, 60.1, 0.5), averages=True)
    energies = made.harmonic_energies()
    assert made.times == pytest.approx(np.arange(0, 60.1, 0.5))
    assert np.array_equal(made.averages[0], energies[0])
    sums = np.cumsum(0.5 * (energies[1:] + energies[:-1]), axis=0)
    assert made.averages[1:] == pytest.approx(sums / np.arange(1, 121)[:, None, None], rel=THOUSAND_ROUNDINGS)


def test_averages_at_few_samples_are_those_at_many(start):
    many = integrate(MIXED, *start, 400.0, step=STEP, samples=np.arange(0, 400.1, 0.5), averages=True)
    few = integrate(MIXED, *start, 400.0, step=STEP, samples=[150.0], averages=True)
    assert few.averages == pytest.approx(many.averages[[0, 300, 800]], rel=THOUSAND_ROUNDINGS)


def test_looks_twice_as_dense_are_four_times_as_good(torus):
    start, T = (torus.Q(0.0), torus.P(0.0)), 20.0
    errors = []
    for look in (0.5, 0.25, 0.125):
        made = integrate(torus.chain, *start, T, step=0.0625, samples=1, averages=True, look=look)
        errors.append(np.abs(made.averages[-1] - torus.average_spectrum(T)).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert rates == pytest.approx([2, 2], abs=SLOPE)


@pytest.mark.parametrize(("run", "look"), [({"step": 0.7, "scheme": "aba864_modes"}, 1.0), ({"step": 0.25, "look": 5.0}, 5.0)])
def test_long_steps_and_rare_looks_are_enough_for_a_long_time(torus, run, look):
    """Fast lines w alias to slow ones, 2 pi/look - w, and average out as those do: none is near 2 pi/look here."""
    T = 7000.0
    made = integrate(torus.chain, torus.Q(0.0), torus.P(0.0), T, samples=[700.0], averages=True, **run)
    assert (made.step, made.times.tolist()) == (run["step"], [0.0, 700.0, T])
    assert made.averages[-1] == pytest.approx(torus.average_spectrum(T), rel=look / T)
