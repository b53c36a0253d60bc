"""Alignment indices that are kept on disk: killed, interrupted, refused; and the time they will take."""

import errno
import os
import pickle
import random
import resource
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from symfpu.bundles.bundle import load
from symfpu.chain.chain import Chain
from symfpu.dynamics import alignment
from symfpu.dynamics.alignment import alignment_indices, seconds_needed
from symfpu.dynamics.orbits import integrate
from symfpu.errors import InputError, RunInterrupted
from symfpu.files.archive import BundleError
from tests.tolerances import CUT_VOLUME, FIRST_PORTION, SECONDS

CHAIN = Chain(6, alpha="0.3", beta="0.2")
PORTION = "symfpu.dynamics.frame_run.PORTION"
SHORT = {"T": 150.0, "samples": 64, "vectors": 4, "step": 0.25, "block": 16}

KILLED = """
import sys, numpy as np
from symfpu.chain.chain import Chain
from symfpu.dynamics.alignment import alignment_indices
start = np.random.default_rng(8).normal(scale=0.3, size=(2, 15))
alignment_indices(Chain(16, alpha="0.3", beta="0.1"), *start, 1e5, samples=80, frames=1, file=sys.argv[1], every=0)
"""


@pytest.fixture(scope="module")
def state():
    draws = np.random.default_rng(3)
    return {"Q": draws.normal(scale=0.3, size=5), "P": draws.normal(scale=0.3, size=5)}


def same(one, other):
    assert np.array_equal(one.times, other.times)
    assert np.array_equal(one.log10_gali, other.log10_gali)
    assert np.array_equal(one.lyapunov, other.lyapunov)
    assert one.energy_error == other.energy_error


@pytest.mark.long
def test_a_killed_run_goes_on_bitwise(tmp_path):
    """Killed at random moments, also inside a write, and started again until it ends."""
    run = Chain(16, alpha="0.3", beta="0.1"), *np.random.default_rng(8).normal(scale=0.3, size=(2, 15)), 1e5
    begun = time.perf_counter()
    whole = alignment_indices(*run, samples=80, frames=1)
    length = time.perf_counter() - begun
    moments, file, kills = random.Random(4), tmp_path / "gali.symfpu", 0
    for _ in range(2):
        process = subprocess.Popen([sys.executable, "-c", KILLED, str(file)])
        old = file.stat().st_mtime_ns if file.exists() else 0
        while process.poll() is None and not (file.exists() and file.stat().st_mtime_ns > old):
            time.sleep(0.002)
        time.sleep(moments.uniform(0.0, 0.4) * length)
        process.send_signal(signal.SIGKILL)
        kills += process.wait() == -signal.SIGKILL
    assert kills
    first = []
    same(alignment_indices(*run, samples=80, file=file, progress=lambda label, done: first.append(done), frames=1), whole)
    assert not first or first[0] > FIRST_PORTION
    same(alignment_indices(*run, samples=80, file=file, progress=lambda label, done: pytest.fail("it was finished"), frames=1), whole)


class Stopped(Exception):
    pass


def stopped_at(count):
    def progress(label, done):
        nonlocal count
        count -= 1
        if count == 0:
            raise Stopped

    return progress


@pytest.mark.parametrize(("T", "block", "scale"), [(150.0, 16, 1.0), (2500.0, 2048, 4.0)])
def test_an_interrupted_run_goes_on_bitwise_from_marks_and_between_them(T, block, scale, tmp_path, state, monkeypatch):
    """Every loop ends on a whole portion, here a block, or on a mark. Blocks of 2048 are too long for ten vectors of a chaotic orbit: they
    are halved on the way, and that is kept too."""
    monkeypatch.setattr(PORTION, 1)
    run, ends = SHORT | {"T": T, "block": block, "vectors": 4 if scale == 1 else 10}, []
    start = {name: scale * values for name, values in state.items()}
    whole = alignment_indices(CHAIN, **start, **run, progress=lambda label, done: ends.append(round(4 * T * done)), frames=1)
    marks = set((whole.times / 0.25).round().astype(int).tolist())
    assert any(end not in marks for end in ends)
    assert all(end in marks or end % block == 0 for end in ends)
    file, runs = tmp_path / "gali", 0
    while True:
        runs += 1
        try:
            resumed = alignment_indices(CHAIN, **start, **run, file=file, every=0, progress=stopped_at(1), frames=1)
            break
        except Stopped:
            pass
    assert runs == len(ends) + 1
    same(resumed, whole)


def press(label, done):
    """The interrupt key."""
    os.kill(os.getpid(), signal.SIGINT)


def interrupt(label, done):
    raise KeyboardInterrupt


@pytest.mark.parametrize("key", [press, interrupt])
def test_the_interrupt_key_keeps_a_run_and_says_how_to_go_on(key, tmp_path, state, monkeypatch):
    """Long before the first checkpoint is due; the run ends in the bits of one that was not interrupted."""
    monkeypatch.setattr(PORTION, 100)
    file, said = tmp_path / "gali", []
    while True:
        try:
            resumed = alignment_indices(CHAIN, **state, **SHORT, file=file, every=3600, progress=key, frames=1)
            break
        except RunInterrupted as stop:
            said.append(str(stop))
    assert len(said) > 5
    assert str(pickle.loads(pickle.dumps(RunInterrupted("at t = 1 of 2", "there")))).startswith("at t = 1 of 2; kept in there")
    assert said[-1] == f"at t = 150 of 150; kept in {file}: the same call, or command, goes on from there"
    same(resumed, alignment_indices(CHAIN, **state, **SHORT, frames=1))


def test_a_longer_run_goes_on_from_the_end_of_a_shorter_one(tmp_path, state):
    """It keeps the samples there are, and ends in the same bits where it is interrupted."""
    short = alignment_indices(CHAIN, **state, **SHORT, file=tmp_path / "gali", frames=1)
    shutil.copy(tmp_path / "gali", tmp_path / "copy")
    longer, seen = SHORT | {"T": 400.0}, []
    with pytest.raises(RunInterrupted):
        alignment_indices(CHAIN, **state, **longer, file=tmp_path / "gali", progress=press, frames=1)
    one = alignment_indices(CHAIN, **state, **longer, file=tmp_path / "gali", progress=lambda label, done: seen.append(done), frames=1)
    assert min(seen) > 150 / 400
    same(one, alignment_indices(CHAIN, **state, **longer, file=tmp_path / "copy", frames=1))
    whole = alignment_indices(CHAIN, **state, **longer, frames=1)
    assert np.array_equal(one.times, np.append(short.times, whole.times[whole.times > 150]))
    assert np.array_equal(one.log10_gali[: len(short.times)], short.log10_gali)
    assert one.log10_gali[-1] == pytest.approx(whole.log10_gali[-1], abs=CUT_VOLUME)


def test_a_run_is_written_every_so_many_seconds_and_at_the_end(tmp_path, state, monkeypatch):
    monkeypatch.setattr(PORTION, 1)
    file = tmp_path / "gali"
    there = []
    alignment_indices(CHAIN, **state, **SHORT, file=file, every=3600.0, progress=lambda label, done: there.append(file.exists()), frames=1)
    assert there[-1]
    assert not any(there[:-1])


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"chain": Chain(6, alpha="0.31", beta="0.2")}, "alpha"),
        ({"Q": np.full(5, 0.1)}, "start"),
        ({"T": 140.0}, "steps"),
        ({"step": 0.125}, "step"),
        ({"scheme": "kahan_li8"}, "scheme"),
        ({"vectors": 5}, "vectors"),
        ({"samples": 70}, "sampled steps"),
        ({"seed": 1}, "seed"),
        ({"block": 8}, "block"),
    ],
)
def test_a_checkpoint_of_other_parameters_is_refused(change, name, tmp_path, state):
    arguments = {"chain": CHAIN, "file": tmp_path / "gali"} | state | SHORT
    alignment_indices(**arguments, frames=1)
    before = arguments["file"].read_bytes()
    with pytest.raises(InputError, match=rf"a checkpoint of the same alignment indices \({name} is .* in it, .* here\)"):
        alignment_indices(**arguments | change, frames=1)
    assert arguments["file"].read_bytes() == before


def test_a_checkpoint_is_taken_on_by_a_machine_that_rounds_otherwise(tmp_path, state, monkeypatch):
    arguments = {"chain": CHAIN, "file": tmp_path / "gali"} | state | SHORT
    first = alignment_indices(**arguments, frames=1)
    drawn = alignment.random_frame

    def rounded_otherwise(*sizes):
        return tuple(np.nextafter(rows, 1) for rows in drawn(*sizes))

    monkeypatch.setattr(alignment, "random_frame", rounded_otherwise)
    assert np.array_equal(alignment_indices(**arguments, frames=1).log10_gali, first.log10_gali)


def test_files_that_are_no_such_checkpoint_are_refused_and_kept(tmp_path, state):
    text, orbit, cut = tmp_path / "notes.txt", tmp_path / "orbit", tmp_path / "cut"
    text.write_text("mine")
    integrate(CHAIN, state["Q"], state["P"], 10.0, step=0.1, file=orbit)
    alignment_indices(CHAIN, **state, **SHORT, file=cut, frames=1)
    cut.write_bytes(cut.read_bytes()[:-300])
    for file in (text, orbit, cut):
        before = file.read_bytes()
        with pytest.raises(BundleError, match="is not a checkpoint of alignment indices"):
            alignment_indices(CHAIN, **state, **SHORT, file=file, frames=1)
        assert file.read_bytes() == before
    for path in (tmp_path, tmp_path / "missing" / "gali", 7):
        with pytest.raises(InputError, match=r"^file = "):
            alignment_indices(CHAIN, **state, **SHORT, file=path, frames=1)
    with pytest.raises(InputError, match=r"^every = "):
        alignment_indices(CHAIN, **state, **SHORT, every=-1, frames=1)


def test_a_full_disk_loses_nothing_already_written(tmp_path, state, monkeypatch):
    """The system itself refuses to let the file grow; the earlier checkpoint is still there, and the run goes on from it."""
    monkeypatch.setattr(PORTION, 1)
    file = tmp_path / "gali"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4_500, limits[1]))
    try:
        with pytest.raises(InputError, match=os.strerror(errno.EFBIG)):
            alignment_indices(CHAIN, **state, **SHORT, file=file, every=0, frames=1)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)
    assert [path.name for path in tmp_path.iterdir()] == ["gali"]
    seen = []
    resumed = alignment_indices(CHAIN, **state, **SHORT, file=file, progress=lambda label, done: seen.append(done), frames=1)
    assert seen[0] > 0.05
    same(resumed, alignment_indices(CHAIN, **state, **SHORT, frames=1))


def test_load_says_what_a_checkpoint_is_and_what_goes_on_from_it(tmp_path, state):
    orbit, gali = tmp_path / "orbit", tmp_path / "gali"
    integrate(CHAIN, state["Q"], state["P"], 10.0, step=0.1, file=orbit)
    alignment_indices(CHAIN, **state, **SHORT, file=gali, frames=1)
    with pytest.raises(BundleError, match=r"is a checkpoint of an orbit, .*; go on from it with integrate\(\.\.\., file=\.\.\.\)"):
        load(orbit)
    with pytest.raises(BundleError, match=r"is a checkpoint of alignment indices, .*; go on from it with alignment_indices\("):
        load(gali)


def test_the_time_a_run_takes_is_known_before():
    """Against a run of a tenth of a second or more; both on a machine that may be busy."""
    chain, Q = Chain(32, alpha="0.33"), np.where(np.arange(31) == 0, 0.5, 0.0)
    alignment_indices(chain, Q, 0 * Q, 100.0, samples=64, frames=1)
    begun = time.thread_time()
    alignment_indices(chain, Q, 0 * Q, 2e4, samples=64, frames=1)
    taken = time.thread_time() - begun
    assert taken / 3 < seconds_needed(chain, 2e4, frames=1) < 3 * taken
    assert seconds_needed(chain, 2e9) == pytest.approx(1e5 * seconds_needed(chain, 2e4), rel=SECONDS)


@pytest.mark.parametrize(("changes", "name"), [({"T": 1.0}, "T"), ({"vectors": 11}, "vectors"), ({"step": 0.0}, "step")])
def test_the_time_of_a_run_that_cannot_be_is_refused(changes, name):
    with pytest.raises(InputError, match=rf"^{name} = "):
        seconds_needed(CHAIN, **{"T": 1000.0} | changes)
