"""Alignment indices that are kept on disk: killed, interrupted, refused; and the time they will take."""

from functools import partial

import numpy as np
import pytest

from symfpu import Chain, InputError, alignment_indices, seconds_needed
from symfpu.dynamics import alignment
from tests.dynamics.cases import resumed
from tests.dynamics.test_kept_runs import KINDS, same
from tests.refusals import each, refused

CHAIN = Chain(6, alpha="0.3", beta="0.2")
PORTION = "symfpu.dynamics.frame_run.PORTION"
SHORT = {"T": 150.0, "samples": 64, "vectors": 4, "step": 0.25, "block": 16}


@pytest.fixture(scope="module")
def state():
    draws = np.random.default_rng(3)
    return {"Q": draws.normal(scale=0.3, size=5), "P": draws.normal(scale=0.3, size=5)}


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
    again = partial(alignment_indices, CHAIN, **start, **run, file=tmp_path / "gali", every=0, frames=1)
    found, begun = resumed(again, 1)
    assert begun == len(ends) + 1
    same(KINDS["indices"], found, whole)


def test_a_run_is_written_every_so_many_seconds_and_at_the_end(tmp_path, state, monkeypatch):
    monkeypatch.setattr(PORTION, 1)
    file = tmp_path / "gali"
    there = []
    alignment_indices(CHAIN, **state, **SHORT, file=file, every=3600.0, progress=lambda label, done: there.append(file.exists()), frames=1)
    assert there[-1]
    assert not any(there[:-1])


def test_a_checkpoint_is_taken_on_by_a_machine_that_rounds_otherwise(tmp_path, state, monkeypatch):
    arguments = {"chain": CHAIN, "file": tmp_path / "gali"} | state | SHORT
    first = alignment_indices(**arguments, frames=1)
    drawn = alignment.random_frame

    def rounded_otherwise(*sizes):
        return tuple(np.nextafter(rows, 1) for rows in drawn(*sizes))

    monkeypatch.setattr(alignment, "random_frame", rounded_otherwise)
    assert np.array_equal(alignment_indices(**arguments, frames=1).log10_gali, first.log10_gali)


def test_a_second_run_on_the_file_of_a_later_frame_is_refused(tmp_path, state):
    """Begun while the first goes on."""
    found = []

    def second(label, done):
        with pytest.raises(InputError, match=r"^file = .*process [0-9]+ on") as caught:
            alignment_indices(CHAIN, **state, **SHORT, file=tmp_path / "gali-2", frames=1)
        found.append(caught)

    alignment_indices(CHAIN, **state, **SHORT, file=tmp_path / "gali", frames=2, progress=second)
    assert found
    assert sorted(path.name for path in tmp_path.iterdir()) == ["gali", "gali-2"]


def test_the_time_of_a_run_is_that_of_its_steps_and_frames(monkeypatch):
    monkeypatch.setattr(alignment, "seconds_a_step", lambda frame, block: 2.0**-10)
    assert seconds_needed(CHAIN, 1024.0, step=0.25, frames=3) == 12.0


@each(T=[1.0], vectors=[11], step=[0.0])
def test_the_time_of_a_run_that_cannot_be_is_refused(name, value):
    refused(seconds_needed, name, value, chain=CHAIN, T=1000.0)
