"""Orbits: against other integrators and tori, reversal, sampling, what stops them, and runs that were killed."""

import errno
import itertools
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symfpu.bundles.bundle import save
from symfpu.chain.chain import Chain
from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.schemes import SCHEMES
from symfpu.dynamics.stopping import EscapedOrbit, OrbitStopped, UnstableStep
from symfpu.dynamics.wells import potential, stretch_bounds
from symfpu.errors import InputError, RunInterrupted
from symfpu.files.archive import BundleError
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from tests.tolerances import (
    COARSE_STEP,
    ENERGY_WALK,
    ESCAPE_ABSOLUTE,
    ESCAPE_ENERGY,
    ESCAPE_RELATIVE,
    LAST_DIGIT,
    LATE_LOG_SPACING,
    ORBIT,
    PEER_ABSOLUTE,
    PEER_ORBIT,
    PEER_ORBIT_YOSHIDA,
    PEER_RELATIVE,
    STEP_ERROR,
    THOUSAND_ROUNDINGS,
)

MIXED = Chain(7, alpha="0.3", beta="0.2")

EVERY = pytest.mark.parametrize("name", SCHEMES)


@pytest.fixture(scope="module")
def state():
    draws = np.random.default_rng(3)
    return draws.normal(scale=0.3, size=6), draws.normal(scale=0.3, size=6)


@pytest.mark.long
@EVERY
def test_orbits_agree_with_dop853(name, state):
    steps = {"yoshida4": 1e-3, "aba864": 5e-3, "blanes_moan6": 0.02, "kahan_li8": 0.05, "aba864_modes": 5e-3}
    orbit = integrate(MIXED, *state, 20.0, step=steps[name], scheme=name, samples=9)
    peer = solve_ivp(
        lambda t, y: np.append(y[6:], MIXED.accelerations(y[:6])),
        (0, 20),
        np.append(*state),
        "DOP853",
        orbit.times,
        rtol=PEER_RELATIVE,
        atol=PEER_ABSOLUTE,
    )
    # yoshida4 alone is of order 4 with large constants
    assert np.hstack([orbit.Q, orbit.P]) == pytest.approx(peer.y.T, abs=PEER_ORBIT_YOSHIDA if name == "yoshida4" else PEER_ORBIT)


def test_orbits_agree_with_heyoka(state):
    """Taylor series of an order of about 20, an optional oracle: pip install heyoka."""
    heyoka = pytest.importorskip("heyoka")
    x, p = (heyoka.make_vars(*(f"{name}{i}" for i in range(6))) for name in "xp")
    walls = [0.0, *x, 0.0]
    r = [right - left for left, right in itertools.pairwise(walls)]
    tension = [s + 0.3 * s**2 + 0.2 * s**3 for s in r]
    forces = [right - left for left, right in itertools.pairwise(tension)]
    system = [*zip(x, p, strict=True), *zip(p, forces, strict=True)]
    peer = heyoka.taylor_adaptive(system, np.concatenate([MIXED.positions(part) for part in state]))
    peer.propagate_until(200.0)
    orbit = integrate(MIXED, *state, 200.0, step=0.05, samples=1)
    assert MIXED.positions(orbit.Q[-1]) == pytest.approx(peer.state[:6], abs=PEER_ORBIT)
    assert MIXED.positions(orbit.P[-1]) == pytest.approx(peer.state[6:], abs=PEER_ORBIT)


@EVERY
def test_time_runs_back_to_rounding(name, state):
    there = integrate(MIXED, *state, 100.0, step=0.1, scheme=name, samples=3)
    back = integrate(MIXED, there.Q[-1], there.P[-1], -100.0, step=0.1, scheme=name, samples=3)
    assert there.times[-1] == 100
    assert back.times[-1] == -100
    assert np.max(np.abs(there.Q[-1] - state[0])) > 0.1
    assert back.Q[-1] == pytest.approx(state[0], abs=THOUSAND_ROUNDINGS)
    assert back.P[-1] == pytest.approx(state[1], abs=THOUSAND_ROUNDINGS)


@EVERY
def test_many_orbits_are_each_as_it_is_alone(name, state):
    Q, P = (np.array([[part, -part], [0.5 * part, 0 * part]]) for part in state)
    many = integrate(MIXED, Q, P, 30.0, step=0.2, scheme=name, samples=5, workers=2)
    assert many.Q.shape == (6, 2, 2, 6)
    assert many.energies.shape == (6, 2, 2)
    assert np.array_equal(many.Q[0], Q)
    for i, j in np.ndindex(2, 2):
        alone = integrate(MIXED, Q[i, j], P[i, j], 30.0, step=0.2, scheme=name, samples=5)
        assert np.array_equal(many.Q[:, i, j], alone.Q)
        assert np.array_equal(many.P[:, i, j], alone.P)
    assert "4 orbits" in repr(many)
    assert not many.Q[:, 1, 1].any()


def test_a_refined_torus_is_followed_to_1e4_at_1e_10():
    torus = refine(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3902", "0.7655"), 8)))
    orbit = integrate(torus.chain, torus.positions(0.0), torus.momenta(0.0), 1e4, step=0.1)
    there = torus.positions(orbit.times)
    assert np.max(np.abs(orbit.Q - there)) < STEP_ERROR * np.max(np.abs(there))
    assert orbit.energy_error < ENERGY_WALK


def test_samples_are_log_spaced_multiples_of_a_step_that_divides_the_time(state):
    orbit = integrate(MIXED, *state, 100.0, step=0.3, samples=50)
    steps = np.rint(orbit.times / orbit.step)
    assert (orbit.times[0], orbit.times[-1]) == (0, 100)
    assert orbit.step <= 0.3
    assert orbit.times == pytest.approx(steps * orbit.step, rel=LAST_DIGIT)
    assert len(orbit.times) <= 51
    assert np.diff(np.log(orbit.times[-20:])) == pytest.approx(np.full(19, np.log(steps[-1]) / 49), abs=LATE_LOG_SPACING)
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
        rtol=ESCAPE_RELATIVE,
        atol=ESCAPE_ABSOLUTE,
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
        stops.append((caught.value.time, caught.value.bond, caught.value.energy))
    assert stops[0][:2] == stops[1][:2]
    assert stops[1][2] == pytest.approx(stops[0][2], rel=THOUSAND_ROUNDINGS)


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
    V = np.array([potential(chain, r) for r in grid])
    if chain.beta <= 0:
        assert np.all(V >= 0)
    # what the energy allows lies inside, if the well is closed by it
    far = np.linspace(-20, 20, 40001)
    allowed = np.array([potential(chain, r) <= energy for r in far])
    centre = np.argmin(np.abs(far))
    left = far[centre - np.argmin(allowed[: centre + 1][::-1])]
    right = far[centre + np.argmin(allowed[centre:])]
    passable = np.all(allowed[: centre + 1]) or np.all(allowed[centre:])
    assert passable == escapes
    assert np.all(allowed[: centre + 1]) or least <= left
    assert np.all(allowed[centre:]) or right <= most


# checkpoints

KILLED = """
import sys, numpy as np
from symfpu.chain.chain import Chain
from symfpu.dynamics import orbits
orbits.BLOCK = 8_000_000
start = np.random.default_rng(8).normal(scale=0.1, size=(2, 2, 15))
orbits.integrate(Chain(16, alpha="0.3", beta="0.1"), *start, 1e4, step=0.1, scheme=sys.argv[2], samples=30, file=sys.argv[1], every=0)
"""


@pytest.mark.long
def test_a_killed_run_goes_on_bitwise(tmp_path, monkeypatch):
    """Killed at random moments, also inside a write, and started again until it ends."""
    name = "aba864_modes"
    monkeypatch.setattr("symfpu.dynamics.orbits.BLOCK", 8_000_000)
    start = np.random.default_rng(8).normal(scale=0.1, size=(2, 2, 15))
    run = Chain(16, alpha="0.3", beta="0.1"), *start, 1e4
    keywords = {"step": 0.1, "scheme": name, "samples": 30}
    begun = time.perf_counter()
    whole = integrate(*run, **keywords)
    length = time.perf_counter() - begun
    moments, file, kills = random.Random(4), tmp_path / "orbit.symfpu", 0
    for _ in range(2):
        process = subprocess.Popen([sys.executable, "-c", KILLED, str(file), name])
        old = file.stat().st_mtime_ns if file.exists() else 0
        while process.poll() is None and not (file.exists() and file.stat().st_mtime_ns > old):
            time.sleep(0.002)
        time.sleep(moments.uniform(0.0, 0.5) * length)
        process.send_signal(signal.SIGKILL)
        kills += process.wait() == -signal.SIGKILL
    assert kills
    assert file.exists()
    first = []
    resumed = integrate(*run, **keywords, file=file, progress=lambda label, fraction: first.append(fraction))
    assert not first or first[0] > 1 / 100_000
    assert np.array_equal(resumed.Q, whole.Q)
    assert np.array_equal(resumed.P, whole.P)
    again = integrate(*run, **keywords, file=file, progress=lambda *told: pytest.fail("it was finished"))
    assert np.array_equal(again.P, whole.P)


class Stopped(Exception):
    pass


def stopped_at(count):
    def progress(label, fraction):
        nonlocal count
        count -= 1
        if count == 0:
            raise Stopped

    return progress


@EVERY
def test_an_interrupted_run_goes_on_bitwise_from_every_block(name, tmp_path, state, monkeypatch):
    monkeypatch.setattr("symfpu.dynamics.orbits.BLOCK", 10_000)
    keywords = {"step": 0.1, "scheme": name, "samples": 4}
    whole = integrate(MIXED, *state, 200.0, **keywords)
    file, runs = tmp_path / "orbit", 0
    while True:
        runs += 1
        try:
            resumed = integrate(MIXED, *state, 200.0, **keywords, file=file, every=0, progress=stopped_at(2))
            break
        except Stopped:
            pass
    assert runs >= 5
    assert np.array_equal(resumed.Q, whole.Q)
    assert np.array_equal(resumed.P, whole.P)


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"chain": Chain(7, alpha="0.31", beta="0.2")}, "alpha"),
        ({"Q": np.zeros(6)}, "start"),
        ({"T": 9.0}, "steps"),
        ({"step": 0.05}, "step"),
        ({"scheme": "aba864"}, "scheme"),
        ({"samples": 7}, "sampled steps"),
    ],
)
def test_a_checkpoint_of_other_parameters_is_refused(change, name, tmp_path, state):
    file = tmp_path / "orbit"
    arguments = {"chain": MIXED, "Q": state[0], "P": state[1], "T": 10.0, "step": 0.1, "scheme": "kahan_li8", "samples": 4, "file": file}
    integrate(**arguments)
    before = file.read_bytes()
    with pytest.raises(InputError, match=rf"a checkpoint of the same orbit \({name} is .* in it, .* here\)"):
        integrate(**arguments | change)
    assert file.read_bytes() == before


def test_files_that_are_no_checkpoint_are_refused_and_kept(tmp_path, state):
    text, bundle, cut = tmp_path / "notes.txt", tmp_path / "series.symfpu", tmp_path / "cut"
    text.write_text("mine")
    save(bundle, lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2))
    integrate(MIXED, *state, 10.0, step=0.1, file=cut)
    cut.write_bytes(cut.read_bytes()[:-300])
    for file in (text, bundle, cut):
        before = file.read_bytes()
        with pytest.raises(BundleError, match="checkpoint of an orbit"):
            integrate(MIXED, *state, 10.0, step=0.1, file=file)
        assert file.read_bytes() == before
    for path in (tmp_path, tmp_path / "missing" / "orbit", 7):
        with pytest.raises(InputError, match=r"^file = "):
            integrate(MIXED, *state, 10.0, step=0.1, file=path)


def test_a_full_disk_loses_nothing_already_written(tmp_path, state, monkeypatch):
    """The system itself refuses to let the file grow; the earlier checkpoint is still there, and the run goes on from it."""
    monkeypatch.setattr("symfpu.dynamics.orbits.BLOCK", 100_000)
    keywords = {"step": 0.1, "samples": 100, "file": tmp_path / "orbit", "every": 0}
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (8_000, limits[1]))
    try:
        with pytest.raises(InputError, match=os.strerror(errno.EFBIG)):
            integrate(MIXED, *state, 1000.0, **keywords)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)
    assert [path.name for path in tmp_path.iterdir()] == ["orbit"]
    seen = []
    resumed = integrate(MIXED, *state, 1000.0, **keywords, progress=lambda label, fraction: seen.append(fraction))
    assert seen[0] > 20 / 10_000
    assert np.array_equal(resumed.Q, integrate(MIXED, *state, 1000.0, step=0.1, samples=100).Q)


def press(label, fraction):
    """The interrupt key, pressed again at every look."""
    os.kill(os.getpid(), signal.SIGINT)


def interrupt(label, fraction):
    raise KeyboardInterrupt


@pytest.mark.parametrize("key", [press, interrupt])
@pytest.mark.parametrize("workers", [1, 2])
def test_the_interrupt_key_keeps_a_run_and_says_how_to_go_on(key, workers, tmp_path, state, monkeypatch):
    """Long before the first checkpoint is due; the run ends in the bits of one that was not interrupted."""
    monkeypatch.setattr("symfpu.dynamics.orbits.BLOCK", 10_000)
    before, file, said = signal.getsignal(signal.SIGINT), tmp_path / "orbit", []
    start = [np.stack([part, 0.5 * part]) for part in state]
    keywords = {"step": 0.1, "samples": 4, "averages": True, "workers": workers}
    whole = integrate(MIXED, *start, 200.0, **keywords)
    while True:
        try:
            resumed = integrate(MIXED, *start, 200.0, **keywords, file=file, every=3600, progress=key)
            break
        except RunInterrupted as stop:
            said.append(str(stop))
    assert len(said) >= 3
    assert said[-1] == f"at t = 200 of 200; kept in {file}: the same call, or command, goes on from there"
    for name in ("Q", "P", "averages"):
        assert np.array_equal(getattr(resumed, name), getattr(whole, name))
    assert signal.getsignal(signal.SIGINT) is before


def test_without_a_file_and_beside_the_main_thread_the_interrupt_key_is_left_alone(tmp_path, state):
    with pytest.raises(KeyboardInterrupt) as stop:
        integrate(MIXED, *state, 200.0, step=0.1, progress=press)
    assert not isinstance(stop.value, RunInterrupted)
    with ThreadPoolExecutor(1) as pool:
        pool.submit(integrate, MIXED, *state, 20.0, step=0.1, file=tmp_path / "orbit").result()


# longer runs


@EVERY
@pytest.mark.parametrize("averages", [False, True])
def test_a_finished_run_is_made_longer_bitwise_where_its_times_permit(name, averages, tmp_path, state):
    keywords = {"step": 0.1, "scheme": name, "averages": averages}
    file, times = tmp_path / "orbit", np.arange(0.0, 61.0, 5.0)
    integrate(MIXED, *state, 30.0, samples=times[times <= 30], file=file, **keywords)
    seen = []
    longer = integrate(MIXED, *state, 60.0, samples=times, file=file, **keywords, progress=lambda label, fraction: seen.append(fraction))
    whole = integrate(MIXED, *state, 60.0, samples=times, **keywords)
    assert min(seen) > 0.5
    assert np.array_equal(longer.times, whole.times)
    assert np.array_equal(longer.Q, whole.Q)
    assert np.array_equal(longer.P, whole.P)
    assert not averages or np.array_equal(longer.averages, whole.averages)


def test_a_longer_run_keeps_its_samples_and_lays_out_later_ones(tmp_path, state, monkeypatch):
    """Log-spaced ones: those to the old end, then those of the new time; interrupted on the way, it ends in the same bits."""
    monkeypatch.setattr("symfpu.dynamics.orbits.BLOCK", 10_000)
    keywords = {"step": 0.1, "samples": 20}
    short = integrate(MIXED, *state, 30.0, file=tmp_path / "orbit", **keywords)
    shutil.copy(tmp_path / "orbit", tmp_path / "copy")
    with pytest.raises(RunInterrupted):
        integrate(MIXED, *state, 300.0, file=tmp_path / "orbit", **keywords, progress=press)
    longer, other = (integrate(MIXED, *state, 300.0, file=tmp_path / name, **keywords) for name in ("orbit", "copy"))
    assert np.array_equal(longer.Q, other.Q)
    whole = integrate(MIXED, *state, 300.0, **keywords)
    assert longer.times == pytest.approx(np.append(short.times, whole.times[whole.times > 30]))
    assert np.array_equal(longer.Q[: len(short.Q)], short.Q)
    assert longer.Q[-1] == pytest.approx(whole.Q[-1], abs=ORBIT)


def test_what_a_longer_run_cannot_have_is_refused(tmp_path, state):
    file = tmp_path / "orbit"
    integrate(MIXED, *state, 30.0, step=0.1, samples=[10.0, 20.0], file=file)
    for change, name in (({"T": 20.0}, "steps"), ({"T": 60.05}, "step"), ({"T": 60.0, "samples": [5.0, 50.0]}, "none after 50 steps")):
        with pytest.raises(InputError, match=name):
            integrate(**{"chain": MIXED, "Q": state[0], "P": state[1], "step": 0.1, "samples": [20.0], "file": file} | change)


def test_a_checkpoint_is_json_and_arrays(tmp_path, state):
    import zipfile

    integrate(MIXED, *state, 10.0, step=0.1, samples=4, file=tmp_path / "orbit")
    with zipfile.ZipFile(tmp_path / "orbit") as archive:
        body = json.loads(archive.read("bundle.json"))
    assert (body["kind"], body["steps"], body["parameters"]["alpha"]) == ("orbit", 100, "0.3")


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"chain": 7}, "chain"),
        ({"Q": [0.1]}, "Q"),
        ({"P": [[0.1] * 6]}, "P"),
        ({"Q": [np.nan] * 6}, "Q, P"),
        ({"Q": [1e90] * 6}, "Q, P"),
        ({"Q": np.zeros((0, 6)), "P": np.zeros((0, 6))}, "Q, P"),
        ({"T": np.inf}, "T"),
        ({"T": 0}, "T"),
        ({"T": "1"}, "T"),
        ({"step": 0.0}, "step"),
        ({"step": -0.1}, "step"),
        ({"step": True}, "step"),
        ({"T": 1e200}, "T"),
        ({"scheme": "euler"}, "scheme"),
        ({"scheme": None}, "scheme"),
        ({"samples": 0}, "samples"),
        ({"samples": "many"}, "samples"),
        ({"samples": [11.0]}, "samples"),
        ({"workers": 0}, "workers"),
        ({"every": -1}, "every"),
    ],
)
def test_bad_input_is_refused(change, name, state):
    arguments = {"chain": MIXED, "Q": state[0], "P": state[1], "T": 10.0, "step": 0.1}
    with pytest.raises(InputError, match=rf"^{name} = "):
        integrate(**arguments | change)
