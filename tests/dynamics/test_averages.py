"""Running averages of mode energies: against sums by hand, closed forms, and runs that were interrupted."""

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.dynamics import averages as looks
from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.schemes import SCHEMES
from symfpu.dynamics.stopping import OrbitStopped
from symfpu.errors import InputError
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
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


@pytest.mark.long
def test_averages_of_a_torus_are_its_closed_form(torus):
    """The trapezoid rule is off by look^2/12 (E'(T) - E'(0)) / T at most."""
    made = integrate(torus.chain, torus.positions(0.0), torus.momenta(0.0), 1000.0, step=0.25, samples=30, averages=True)
    linear = torus.chain.frequencies()
    largest = np.abs(torus.cosines).sum(axis=0)
    steepest = 4 * (linear * largest) ** 2  # of dE_q/dt: |P| (|dP/dt| + Omega^2 |Q|), with twice what the harmonics of P allow
    for time, found in zip(made.times[1:], made.averages[1:], strict=True):
        assert np.all(np.abs(found - torus.average_spectrum(time)) <= looks.LOOK**2 / 12 * 2 * steepest * 2 / time + THOUSAND_ROUNDINGS)


def test_looks_twice_as_dense_are_four_times_as_good(torus):
    start, T = (torus.positions(0.0), torus.momenta(0.0)), 20.0
    errors = []
    for look in (0.5, 0.25, 0.125):
        made = integrate(torus.chain, *start, T, step=0.0625, samples=1, averages=True, look=look)
        errors.append(np.abs(made.averages[-1] - torus.average_spectrum(T)).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert rates == pytest.approx([2, 2], abs=SLOPE)


def test_a_long_step_is_looked_at_every_time(torus):
    """Fast harmonics alias to slow ones, w to 2 pi / step - w, and average out as those do."""
    start, T = (torus.positions(0.0), torus.momenta(0.0)), 7000.0
    made = integrate(torus.chain, *start, T, step=0.7, scheme="aba864_modes", samples=5, averages=True)
    assert made.step == 0.7
    assert made.averages[-1] == pytest.approx(torus.average_spectrum(T), rel=1 / T)


def test_rare_looks_are_enough_for_a_long_time(torus):
    """Each line w of E_q leaves w times look/T of itself over sin(w look/2): no line is near 2 pi/look here."""
    start, T = (torus.positions(0.0), torus.momenta(0.0)), 7000.0
    made = integrate(torus.chain, *start, T, step=0.25, samples=[700.0], averages=True, look=5.0)
    assert made.times.tolist() == [0.0, 700.0, T]
    assert made.averages[-1] == pytest.approx(torus.average_spectrum(T), rel=5 / T)


@pytest.mark.parametrize("look", [0, -1.0, "long", np.inf])
def test_a_look_is_a_positive_time(start, look):
    with pytest.raises(InputError, match="look"):
        integrate(MIXED, *start, 10.0, step=STEP, averages=True, look=look)


def test_orbits_and_threads_do_not_mix(start):
    together = integrate(MIXED, *start, 300.0, step=STEP, samples=9, averages=True, workers=2)
    for i in range(3):
        alone = integrate(MIXED, start[0][i], start[1][i], 300.0, step=STEP, samples=9, averages=True)
        assert np.array_equal(together.averages[:, i], alone.averages)
        assert np.array_equal(together.Q[:, i], alone.Q)


def test_an_interrupted_run_keeps_its_averages_bitwise(start, tmp_path):
    class Interrupted(Exception):
        pass

    def stop_soon():
        calls = iter(range(4))

        def progress(label, fraction):
            if next(calls) == 3:
                raise Interrupted

        return progress

    run = {"chain": MIXED, "Q": start[0], "P": start[1], "T": 2000.0, "step": STEP, "samples": 7, "averages": True}
    whole, runs = integrate(**run), 0
    while True:
        runs += 1
        try:
            resumed = integrate(**run, file=tmp_path / "orbit", every=0, progress=stop_soon())
            break
        except Interrupted:
            pass
    assert runs >= 4
    for name in ("Q", "P", "averages"):
        assert np.array_equal(getattr(resumed, name), getattr(whole, name))
    with pytest.raises(InputError, match="steps between looks is 4 in it, 0 here"):
        integrate(**run | {"averages": False}, file=tmp_path / "orbit")


def test_an_escaping_orbit_is_stopped_as_without_averages():
    start = np.array([0.0, 0.0, 2.2]), np.zeros(3)
    stops = []
    for averages in (False, True):
        with pytest.raises(OrbitStopped) as stopped:
            integrate(Chain(4, alpha=1), *start, 1e4, step=0.05, samples=5, averages=averages)
        stops.append((type(stopped.value), stopped.value.time, stopped.value.mode))
    assert stops[0] == stops[1]


def test_averages_are_asked_for_by_a_boolean(start):
    with pytest.raises(InputError, match="averages = 1"):
        integrate(MIXED, *start, 10.0, step=STEP, averages=1)
    assert integrate(MIXED, *start, 10.0, step=STEP).averages is None
