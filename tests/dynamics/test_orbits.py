"""Orbits: against other integrators and tori, reversal, sampling, what stops them, and runs that were killed."""

from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symfpu import Chain, EscapedOrbit, InputError, OrbitStopped, UnstableStep, integrate, lindstedt, random_state, refine, solve_amplitudes
from symfpu.chain import bonds
from symfpu.dynamics.schemes import SCHEMES
from symfpu.dynamics.wells import stretch_bounds
from symfpu.errors import RunInterrupted
from tests import tolerances
from tests.dynamics.cases import resumed
from tests.dynamics.test_kept_runs import press
from tests.refusals import each, refused
from tests.tolerances import COARSE_STEP, ENERGY_WALK, ESCAPE_ENERGY, LAST_DIGIT, STEP_ERROR, THOUSAND_ROUNDINGS

MIXED = Chain(7, alpha="0.3", beta="0.2")

EVERY = pytest.mark.parametrize("name", SCHEMES)


@pytest.fixture(scope="module")
def state():
    draws = np.random.default_rng(3)
    return draws.normal(scale=0.3, size=6), draws.normal(scale=0.3, size=6)


@EVERY
def test_time_runs_back_to_rounding(name, state):
    there = integrate(MIXED, *state, 100.0, step=0.1, scheme=name, samples=3)
    back = integrate(MIXED, there.Q[-1], there.P[-1], -100.0, step=0.1, scheme=name, samples=3)
    assert there.times[-1] == 100
    assert back.times[-1] == -100
    assert np.max(np.abs(there.Q[-1] - state[0])) > 0.1
    assert back.Q[-1] == pytest.approx(state[0], abs=THOUSAND_ROUNDINGS)
    assert back.P[-1] == pytest.approx(state[1], abs=THOUSAND_ROUNDINGS)


def test_a_refined_torus_is_followed_to_1e4_at_1e_10():
    torus = refine(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3902", "0.7655"), 8)))
    orbit = integrate(torus.chain, torus.Q(0.0), torus.P(0.0), 1e4, step=0.1)
    there = torus.Q(orbit.times)
    assert np.max(np.abs(orbit.Q - there)) < STEP_ERROR * np.max(np.abs(there))
    assert orbit.energy_error < ENERGY_WALK


def test_samples_are_log_spaced_multiples_of_a_step_that_divides_the_time(state):
    orbit = integrate(MIXED, *state, 100.0, step=0.3, samples=50)
    steps = np.rint(orbit.times / orbit.step)
    assert (orbit.times[0], orbit.times[-1]) == (0, 100)
    assert orbit.step <= 0.3
    assert orbit.times == pytest.approx(steps * orbit.step, rel=LAST_DIGIT)
    assert len(orbit.times) <= 51
    assert np.diff(np.log(orbit.times[-20:])) == pytest.approx(np.full(19, np.log(steps[-1]) / 49), abs=tolerances.LATE_LOG_SPACING)
    chosen = integrate(MIXED, *state, -10.0, step=0.1, samples=[-2.5, -0.04, -7.0])
    assert chosen.times == pytest.approx([0, -2.5, -7, -10])
    seen = []
    integrate(MIXED, *state, 10.0, step=0.1, samples=[5.0], progress=lambda *told: seen.append(told))
    assert seen == [("orbit", 0.5), ("orbit", 1.0)]


def test_the_energy_error_is_that_of_the_samples(state):
    coarse = integrate(MIXED, *state, 100.0, step=0.5, scheme="yoshida4", samples=20)
    worst = max(abs(float(MIXED.energy(Q, P)) / float(MIXED.energy(*state)) - 1) for Q, P in zip(coarse.Q, coarse.P, strict=True))
    assert coarse.energy_error == pytest.approx(worst)
    assert COARSE_STEP < coarse.energy_error < 0.1
    assert f"energy error {coarse.energy_error:.2g})" in repr(coarse)
    assert integrate(MIXED, np.zeros(6), np.zeros(6), 1.0, step=0.5).energy_error == 0


# what stops an orbit


def test_a_step_beyond_stability_is_refused_before_it_is_taken(state):
    for name, scheme in SCHEMES.items():
        step = 1.001 * scheme.stable_phase / float(MIXED.frequencies()[-1])
        with pytest.raises(UnstableStep, match=r"at time 0 in mode 6, energy .*; take a step below") as caught:
            integrate(MIXED, *state, 16 * step, step=step, scheme=name)
        assert (caught.value.time, caught.value.mode, caught.value.orbit) == (0.0, 6, ())
        assert caught.value.energy == pytest.approx(float(MIXED.energy(*state)))


@pytest.mark.parametrize("name", ["yoshida4", "aba864", "kahan_li8"])
def test_the_stable_phase_is_where_a_harmonic_chain_begins_to_grow(name):
    """By powers of the step of a nearly harmonic chain, without the trace."""
    chain, phase = Chain(4, alpha="1e-9"), SCHEMES[name].stable_phase
    Omega = float(chain.frequencies()[-1])
    below = integrate(chain, [0, 0, 0.01], [0, 0, 0], 4e3, step=0.995 * phase / Omega, scheme=name, samples=200)
    assert np.max(np.abs(below.Q)) < 0.1
    object.__setattr__(SCHEMES[name], "stable_phase", 1.01 * phase)  # as if it were stable there
    try:
        with pytest.raises(UnstableStep, match="loses the energy at time") as caught:
            integrate(chain, [0, 0, 0.01], [0, 0, 0], 4e3, step=1.008 * phase / Omega, scheme=name)
    finally:
        object.__setattr__(SCHEMES[name], "stable_phase", phase)
    assert caught.value.mode == 3
    assert 0 < caught.value.time < 4e3


@pytest.mark.long
@EVERY
def test_an_orbit_over_the_barrier_is_stopped_at_once(name):
    """Stopped while its numbers are finite, or as soon as they are not; the time is that at which V of a bond falls without bound."""
    chain, Q, P = Chain(8, alpha=1), np.zeros(7), 1.2 * np.eye(7)[4]
    with pytest.raises(EscapedOrbit, match=r"passes the barrier of its potential at time .* in mode \d of orbit \(1,\), energy") as caught:
        integrate(chain, [0 * Q, Q], [0.1 * P, P], 1e9, step=0.01, scheme=name, samples=3)
    stopped = caught.value
    assert stopped.orbit == (1,)
    assert 1 <= stopped.mode <= 7
    run = solve_ivp(
        lambda t, y: np.append(y[7:], chain.accelerations(y[:7])),
        (0, 100),
        np.append(Q, P),
        "DOP853",
        rtol=tolerances.ESCAPE_RELATIVE,
        atol=tolerances.ESCAPE_ABSOLUTE,
        events=lambda t, y: np.min(chain.stretches(y[:7])) + 1.5,
    )
    first = run.t_events[0][0]
    assert first - 0.02 <= stopped.time <= first + 2
    assert stopped.energy == pytest.approx(float(chain.energy(Q, P)), rel=ESCAPE_ENERGY)


@pytest.mark.parametrize("name", ["kahan_li8", "aba864_modes"])
def test_averages_stop_at_the_step_at_which_the_orbit_does(name):
    """Where every step is looked at, too: the last good state is one of finite numbers."""
    chain, P, stops = Chain(8, alpha=1), 1.2 * np.eye(7)[4], []
    for averages in (False, True):
        with pytest.raises(EscapedOrbit) as caught:
            integrate(chain, 0 * P, P, 600.0, step=0.5, scheme=name, samples=3, averages=averages)
        stops.append(caught.value)
    one, other = stops
    assert (one.time, one.bond, one.mode) == (other.time, other.bond, other.mode)
    assert other.energy == pytest.approx(one.energy, rel=THOUSAND_ROUNDINGS)


def test_an_orbit_that_starts_beyond_the_barrier_is_not_begun():
    with pytest.raises(EscapedOrbit, match="at time 0 in mode 1,"):
        integrate(Chain(2, alpha=1), [-3.0], [0.0], 1.0, step=0.01)


def test_a_coarse_step_that_loses_the_energy_is_stopped():
    """Stable for the harmonic chain, not for the large stretches of this one, which has no barrier."""
    with pytest.raises(UnstableStep, match=r"loses the energy at time .* take a shorter step") as caught:
        integrate(Chain(8, beta=1), np.full(7, 6.0), np.zeros(7), 1e6, step=0.7)
    assert caught.value.time < 1e3
    assert isinstance(caught.value, OrbitStopped)


@pytest.mark.parametrize(
    ("chain", "energy"),
    [
        (Chain(4, alpha=1), 0.03),
        (Chain(4, alpha=1), 0.16),
        (Chain(4, alpha="-1"), 1.0),
        (Chain(4, beta=1), 2.0),
        (Chain(4, beta="-1"), 0.2),
        (Chain(4, beta="-1"), 0.3),
        (Chain(4, alpha=3, beta=1), 0.5),
        (Chain(4, alpha=1, beta="-0.5"), 0.4),
    ],
)
def test_bounds_of_stretches_are_where_the_potential_says(chain, energy):
    least, most, escapes = stretch_bounds(chain, energy)
    assert least < 0 < most
    grid = np.linspace(least, most, 2001)[1:-1]
    if chain.beta <= 0:
        assert np.all(bonds.potential(chain.law(), grid) >= 0)
    # what the energy allows lies inside, if the well is closed by it
    far = np.linspace(-20, 20, 40001)
    allowed = bonds.potential(chain.law(), far) <= energy
    centre = np.argmin(np.abs(far))
    left = far[centre - np.argmin(allowed[: centre + 1][::-1])]
    right = far[centre + np.argmin(allowed[centre:])]
    passable = np.all(allowed[: centre + 1]) or np.all(allowed[centre:])
    assert passable == escapes
    assert np.all(allowed[: centre + 1]) or least <= left
    assert np.all(allowed[centre:]) or right <= most


# checkpoints


def equal(one, other):
    """In all bits; averages are None in both if they were not asked for."""
    return all(np.array_equal(getattr(one, name), getattr(other, name)) for name in ("times", "Q", "P", "averages"))


@pytest.mark.parametrize(("name", "count", "averages"), [*((name, 1, False) for name in SCHEMES), *(("aba864", n, True) for n in (3, 9))])
def test_an_interrupted_run_goes_on_bitwise_from_every_block(name, count, averages, tmp_path, state, monkeypatch):
    """One orbit, a few, and more than there are lanes."""
    monkeypatch.setattr("symfpu.dynamics.orbits.BLOCK", 10_000)
    start = [np.linspace(1.0, 0.5, count)[:, None] * part for part in state]
    run = partial(integrate, MIXED, *start, 200.0, step=0.1, scheme=name, samples=4, averages=averages)
    found, begun = resumed(partial(run, file=tmp_path / "orbit", every=0), 2)
    assert begun >= 5
    assert equal(found, run())


def test_without_a_file_and_beside_the_main_thread_the_interrupt_key_is_left_alone(tmp_path, state):
    with pytest.raises(KeyboardInterrupt) as stop:
        integrate(MIXED, *state, 200.0, step=0.1, progress=press)
    assert not isinstance(stop.value, RunInterrupted)
    with ThreadPoolExecutor(1) as pool:
        pool.submit(integrate, MIXED, *state, 20.0, step=0.1, file=tmp_path / "orbit").result()


# longer runs


LAWS = [Chain(7, potential="toda:1/2"), Chain(7, potential="toda:1/2", ends="periodic")]
LONGER = [*((MIXED, name) for name in SCHEMES), *((chain, "kahan_li8") for chain in LAWS)]


@pytest.mark.parametrize(("chain", "name"), LONGER, ids=str)
@pytest.mark.parametrize("averages", [False, True])
def test_a_finished_run_is_made_longer_bitwise_where_its_times_permit(chain, name, averages, tmp_path):
    run = partial(integrate, chain, *random_state(chain, "0.3", 3), step=0.1, scheme=name, averages=averages)
    file, times, seen = tmp_path / "orbit", np.arange(0.0, 61.0, 5.0), []
    run(30.0, samples=times[times <= 30], file=file)
    longer = run(60.0, samples=times, file=file, progress=lambda label, fraction: seen.append(fraction))
    assert min(seen) > 0.5
    assert equal(longer, run(60.0, samples=times))


def test_what_a_longer_run_cannot_have_is_refused(tmp_path, state):
    file = tmp_path / "orbit"
    integrate(MIXED, *state, 30.0, step=0.1, samples=[10.0, 20.0], file=file)
    for change, name in (({"T": 20.0}, "steps"), ({"T": 60.05}, "step"), ({"T": 60.0, "samples": [5.0, 50.0]}, "none after 50 steps")):
        with pytest.raises(InputError, match=name):
            integrate(**{"chain": MIXED, "Q": state[0], "P": state[1], "step": 0.1, "samples": [20.0], "file": file} | change)


LONG, FLAT = np.zeros((4, 5)), np.zeros((0, 6))


@each(
    chain=[7],
    Q=[[0.1], LONG, np.zeros((6, 4)), [np.nan] * 6, [1e90] * 6],
    P=[[[0.1] * 6], np.zeros((3, 6))],
    T=[np.inf, 0, "1", 1e200],
    step=[0.0, -0.1, True],
    scheme=["euler", None],
    samples=[0, "many", [11.0]],
    workers=[0],
    every=[-1],
    averages=[1],
    look=[0, -1.0, "long", np.inf],
)
def test_bad_input_is_refused(name, value, state):
    refused(integrate, name, value, chain=MIXED, Q=state[0], P=state[1], T=10.0, step=0.1, averages=True)


@pytest.mark.parametrize(("Q", "P", "name"), [(FLAT, FLAT, "Q, P"), (np.zeros((4, 6)), np.zeros(6), "P")])
def test_states_that_do_not_fit_each_other_are_refused(Q, P, name):
    with pytest.raises(InputError, match=rf"^{name} = "):
        integrate(MIXED, Q, P, 10.0, step=0.1)
