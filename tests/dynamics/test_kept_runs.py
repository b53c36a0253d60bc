"""Runs that are kept in a file, orbits and alignment indices alike: killed, interrupted, made longer, refused, on a full disk."""

import errno
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from symfpu import BundleError, Chain, InputError, alignment_indices, integrate, lindstedt, load, random_state, save
from symfpu.errors import RunInterrupted
from tests.system import files_up_to
from tests.tolerances import CUT_VOLUME, ORBIT

ROOT = Path(__file__).parents[2]
CHAIN = Chain(7, alpha="0.3", beta="0.2")
LONG = Chain(16, alpha="0.3", beta="0.1")


class Kept(NamedTuple):
    """A kind of run.

    portion : what limits the steps between two looks at the file, and its values: small, and for a run that is killed.
    short, killed : arguments of runs. bytes : of a disk on which the first checkpoint has room and a later one has not.
    answers : the arrays of the result, whose last rows differ by `apart` where the time was laid out otherwise.
    """

    words: str
    function: object
    portion: tuple
    short: dict
    killed: dict
    bytes: int
    answers: tuple
    apart: float


def start(modes, *more, size=0.3, seed=3):
    draws = np.random.default_rng(seed)
    return {"Q": draws.normal(scale=size, size=(*more, modes)), "P": draws.normal(scale=size, size=(*more, modes))}


KINDS = {
    "orbit": Kept(
        "an orbit",
        integrate,
        ("symfpu.dynamics.orbits.BLOCK", 10_000, 8_000_000),
        {"chain": CHAIN, "T": 200.0, "step": 0.1, "samples": 100, "averages": True, "workers": 2, **start(6, 2)},
        {"chain": LONG, "T": 1e4, "step": 0.1, "scheme": "aba864_modes", "samples": 30, "averages": True, **start(15, 2, size=0.1, seed=8)},
        12_000,
        ("Q", "P", "averages"),
        ORBIT,
    ),
    "indices": Kept(
        "alignment indices",
        partial(alignment_indices, frames=1),
        ("symfpu.dynamics.frame_run.PORTION", 1, None),
        {"chain": CHAIN, "T": 150.0, "samples": 64, "vectors": 4, "step": 0.25, "block": 16, **start(6)},
        {"chain": LONG, "T": 1e5, "samples": 80, **start(15, seed=8)},
        4_500,
        ("times", "log10_gali", "lyapunov"),
        CUT_VOLUME,
    ),
}


@pytest.fixture(params=KINDS)
def kind(request, monkeypatch):
    """With a look at the file after every few steps."""
    found = KINDS[request.param]
    name, small, _ = found.portion
    monkeypatch.setattr(name, small)
    return found


def same(kind, one, other):
    assert all(np.array_equal(getattr(one, name), getattr(other, name)) for name in kind.answers)
    assert one.energy_error == other.energy_error


def unasked(label, fraction):
    pytest.fail("it was finished")


def press(label, fraction):
    """The interrupt key."""
    os.kill(os.getpid(), signal.SIGINT)


def interrupt(label, fraction):
    raise KeyboardInterrupt


RUN = "import sys; from tests.dynamics.test_kept_runs import run_to_be_killed; run_to_be_killed(*sys.argv[1:])"


def run_to_be_killed(name, file):
    """In a process of its own: every block is written."""
    kind = KINDS[name]
    module, constant = kind.portion[0].rsplit(".", 1)
    if kind.portion[2]:
        setattr(sys.modules[module], constant, kind.portion[2])
    kind.function(**kind.killed, file=file, every=0)


@pytest.mark.long
@pytest.mark.parametrize("name", KINDS)
def test_a_killed_run_goes_on_bitwise(name, tmp_path, monkeypatch):
    """Killed at random moments, also inside a write, and started again until it ends."""
    kind = KINDS[name]
    if kind.portion[2]:
        monkeypatch.setattr(kind.portion[0], kind.portion[2])
    begun = time.perf_counter()
    whole = kind.function(**kind.killed)
    length = time.perf_counter() - begun
    moments, file, kills = random.Random(4), tmp_path / "run", 0
    for _ in range(2):
        process = subprocess.Popen([sys.executable, "-c", RUN, name, str(file)], cwd=ROOT)
        old = file.stat().st_mtime_ns if file.exists() else 0
        while process.poll() is None and not (file.exists() and file.stat().st_mtime_ns > old):
            time.sleep(0.002)
        time.sleep(moments.uniform(0.0, 0.4) * length)
        process.send_signal(signal.SIGKILL)
        kills += process.wait() == -signal.SIGKILL
    assert kills
    first = []
    same(kind, kind.function(**kind.killed, file=file, progress=lambda label, done: first.append(done)), whole)
    assert not first or first[0] > 1 / 100_000
    same(kind, kind.function(**kind.killed, file=file, progress=unasked), whole)


@pytest.mark.parametrize("key", [press, interrupt])
def test_the_interrupt_key_keeps_a_run_and_says_how_to_go_on(kind, key, tmp_path):
    """Long before the first checkpoint is due; the run ends in the bits of one that was not interrupted."""
    before, file, said = signal.getsignal(signal.SIGINT), tmp_path / "run", []
    while True:
        try:
            resumed = kind.function(**kind.short, file=file, every=3600, progress=key)
            break
        except RunInterrupted as stop:
            said.append(str(stop))
    T = f"{kind.short['T']:g}"
    assert len(said) >= 3
    assert said[-1] == f"at t = {T} of {T}; kept in {file}: the same call, or command, goes on from there"
    same(kind, resumed, kind.function(**kind.short))
    assert signal.getsignal(signal.SIGINT) is before


def test_a_longer_run_goes_on_from_the_end_of_a_shorter_one(kind, tmp_path):
    """It keeps the samples there are and lays out those of the new time; interrupted on the way, it ends in the same bits."""
    T, longer, seen = kind.short["T"], kind.short | {"T": 3 * kind.short["T"]}, []
    short = kind.function(**kind.short, file=tmp_path / "run")
    shutil.copy(tmp_path / "run", tmp_path / "copy")
    with pytest.raises(RunInterrupted):
        kind.function(**longer, file=tmp_path / "run", progress=press)
    one = kind.function(**longer, file=tmp_path / "run", progress=lambda label, done: seen.append(done))
    assert min(seen) > 1 / 3
    same(kind, one, kind.function(**longer, file=tmp_path / "copy"))
    whole = kind.function(**longer)
    assert one.times == pytest.approx(np.append(short.times, whole.times[whole.times > T]))
    for name in kind.answers:
        found, at_once = getattr(one, name), getattr(whole, name)
        assert np.array_equal(found[: len(short.times)], getattr(short, name))
        assert found[-1] == pytest.approx(at_once[-1], abs=kind.apart)


CHANGED = {
    "orbit": [
        ({"chain": Chain(7, alpha="0.31", beta="0.2")}, "alpha"),
        ({"Q": np.zeros((2, 6))}, "start"),
        ({"T": 9.0}, "steps"),
        ({"step": 0.05}, "step"),
        ({"scheme": "aba864"}, "scheme"),
        ({"samples": 7}, "sampled steps"),
        ({"averages": False}, "steps between looks"),
    ],
    "indices": [
        ({"chain": Chain(7, alpha="0.31", beta="0.2")}, "alpha"),
        ({"Q": np.full(6, 0.1)}, "start"),
        ({"T": 140.0}, "steps"),
        ({"step": 0.125}, "step"),
        ({"scheme": "kahan_li8"}, "scheme"),
        ({"vectors": 5}, "vectors"),
        ({"samples": 70}, "sampled steps"),
        ({"seed": 1}, "seed"),
        ({"block": 8}, "block"),
    ],
}


@pytest.mark.parametrize("name", KINDS)
def test_a_checkpoint_of_other_parameters_is_refused(name, tmp_path):
    kind, file = KINDS[name], tmp_path / "run"
    kind.function(**kind.short, file=file)
    before = file.read_bytes()
    for change, parameter in CHANGED[name]:
        said = rf"a checkpoint of the same {kind.words.removeprefix('an ')} \({parameter} is .* in it, .* here\)"
        with pytest.raises(InputError, match=said):
            kind.function(**kind.short | change, file=file)
        assert file.read_bytes() == before


PLAIN, TODA = Chain(7, alpha="0.3"), Chain(7, potential="toda:1/2")
RING = Chain(7, alpha="0.3", ends="periodic")


@pytest.mark.parametrize(
    ("kept", "asked", "words"),
    [
        (TODA, Chain(7, potential="toda:1/3"), "potential is toda:0.5 in it, toda:1/3 here"),
        (TODA, Chain(7, alpha="1/2"), "alpha is None in it, 0.5 here"),
        (RING, PLAIN, "ends is periodic in it, fixed here"),
        (PLAIN, RING, "ends is fixed in it, periodic here"),
    ],
)
def test_a_checkpoint_of_another_chain_is_refused_by_name(kind, kept, asked, words, tmp_path):
    def run(chain):
        Q, P = random_state(chain, "0.01", 1)
        return kind.function(**kind.short | {"chain": chain, "Q": Q, "P": P, "file": tmp_path / "run"})

    same(kind, run(kept), run(kept))
    with pytest.raises(InputError, match=words):
        run(asked)


def test_a_second_run_on_one_file_is_refused(kind, tmp_path):
    """Begun while the first goes on, which ends as if nothing had been."""
    refused, run = [], partial(kind.function, **kind.short)

    def second(label, done):
        with pytest.raises(InputError, match=r"^file = .*process [0-9]+ on .*wait for the other") as caught:
            run(file=tmp_path / "run")
        refused.append(caught)

    same(kind, run(file=tmp_path / "run", progress=second), run())
    assert refused
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_load_says_what_a_checkpoint_is_and_what_goes_on_from_it(kind, tmp_path):
    kind.function(**kind.short, file=tmp_path / "run")
    name = getattr(kind.function, "func", kind.function).__name__
    with pytest.raises(BundleError, match=rf"is a checkpoint of {kind.words}, .*; go on from it with {name}\(.*file="):
        load(tmp_path / "run")


def test_files_that_are_no_such_checkpoint_are_refused_and_kept(kind, tmp_path):
    text, series, cut, other = (tmp_path / name for name in ("notes.txt", "series", "cut", "other"))
    text.write_text("mine")
    save(series, lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2))
    kind.function(**kind.short, file=cut)
    cut.write_bytes(cut.read_bytes()[:-300])
    [another] = [one for one in KINDS.values() if one.words != kind.words]
    another.function(**another.short, file=other)
    for file in (text, series, cut, other):
        before = file.read_bytes()
        with pytest.raises(BundleError, match=f"checkpoint of {kind.words}"):
            kind.function(**kind.short, file=file)
        assert file.read_bytes() == before
    for path in (tmp_path, tmp_path / "missing" / "run", 7):
        with pytest.raises(InputError, match=r"^file = "):
            kind.function(**kind.short, file=path)
    with pytest.raises(InputError, match=r"^every = "):
        kind.function(**kind.short, every=-1)


def test_a_full_disk_loses_nothing_already_written(kind, tmp_path):
    """The system itself refuses to let the file grow; the earlier checkpoint is still there, and the run goes on from it."""
    file, seen = tmp_path / "run", []
    with files_up_to(kind.bytes), pytest.raises(InputError, match=os.strerror(errno.EFBIG)):
        kind.function(**kind.short, file=file, every=0)
    assert [path.name for path in tmp_path.iterdir()] == ["run"]
    resumed = kind.function(**kind.short, file=file, progress=lambda label, done: seen.append(done))
    assert seen[0] > 1 / 500
    same(kind, resumed, kind.function(**kind.short))
