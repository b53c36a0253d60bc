"""Targets side by side: which is begun first, that the failure of one costs no other, and the time that is left."""

import math
import threading

import pytest

from symfpu import InputError
from symfpu.paper import side_by_side as module
from symfpu.paper import targets
from symfpu.paper.claims import PaperFigure
from symfpu.paper.side_by_side import TargetsFailed, in_turn, side_by_side
from symfpu.paper.targets import FIRST_PICTURE, SECONDS, TARGETS
from symfpu.paper.time_left import ENDING, TRUSTED, TimeLeft
from tests.tolerances import ROUNDING


def unheard(label, fraction):
    assert math.isnan(fraction) or 0 <= fraction <= 1


def test_every_target_has_its_seconds():
    assert SECONDS.keys() == TARGETS.keys()
    assert all(seconds > 0 for seconds in SECONDS.values())


def test_a_picture_is_first_and_then_what_takes_longest():
    order = in_turn(SECONDS)
    assert order[0] == FIRST_PICTURE
    assert [SECONDS[target] for target in order[1:]] == sorted((SECONDS[target] for target in order[1:]), reverse=True)
    assert in_turn({"a": 1.0, "b": 2.0}) == ["b", "a"]


def test_a_failure_in_this_process_is_the_answer_of_its_target(monkeypatch, tmp_path):
    def lost(folder, progress, *, full=False):
        raise InputError("N", 1, "2", "more")

    page = PaperFigure("fig6", "Page", (), ())
    monkeypatch.setitem(targets.TARGETS, "fig9", lost)
    monkeypatch.setitem(targets.TARGETS, "fig6", lambda folder, progress, *, full=False: page)
    monkeypatch.setattr(module, "available_cores", lambda: 1)
    found = dict(side_by_side(["fig6", "fig9"], tmp_path, unheard))
    assert found["fig6"] is page
    assert isinstance(found["fig9"], InputError)


@pytest.mark.long
def test_a_failure_in_a_worker_process_is_the_answer_of_its_target(monkeypatch, tmp_path):
    """Nothing replaced: a folder is where a table of Fig. 6 goes, and section 5 has no table."""
    (tmp_path / "fig6a.csv").mkdir()
    monkeypatch.setattr(module, "available_cores", lambda: 2)
    steps = []
    found = dict(side_by_side(["section5", "fig6"], tmp_path, lambda label, fraction: steps.append(label)))
    assert isinstance(found["fig6"], InputError)
    assert found["section5"].claims
    assert any("section5: proofs" in label for label in steps)
    assert any("fig6: spectra" in label for label in steps)


@pytest.mark.long
def test_what_is_at_work_ends_when_nobody_waits_for_it(monkeypatch, tmp_path):
    """As the interrupt key does: the second target takes minutes, and is not waited for."""
    monkeypatch.setattr(module, "available_cores", lambda: 2)
    coming = side_by_side(["fig6", "convergence"], tmp_path, unheard)
    assert next(coming)[0] == "fig6"
    coming.close()
    assert not list(tmp_path.glob("convergence*"))


def test_failures_are_named_by_target():
    error = TargetsFailed({"fig9": InputError("N", 1, "2", "more")})
    assert str(error).startswith("no figures of fig9 (InputError: N = 1")
    assert error.failures.keys() == {"fig9"}


class Clock:
    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def heard():
    return []


def left_of(seconds, workers, heard, clock):
    return TimeLeft(seconds, workers, lambda label, fraction: heard.append((label, fraction)), clock)


def test_the_rest_is_shared_by_the_workers_but_no_shorter_than_its_longest(clock, heard):
    left = left_of({"a": 40.0, "b": 20.0, "c": 20.0}, 2, heard, clock)
    left.of("a")("a", math.nan)
    left.of("b")("b", math.nan)
    assert left.seconds_left() == 40.0
    clock.now += 10.0
    assert left.seconds_left() == 30.0
    clock.now += 20.0  # b is late: a little of it is left
    assert left.seconds_left() == pytest.approx((10.0 + ENDING * 20.0 + 20.0) / 2 + (20.0 - 31.0 / 2), rel=ROUNDING)


def test_a_slow_machine_is_seen_by_what_is_done(clock, heard):
    left = left_of({"a": 40.0, "b": 40.0}, 1, heard, clock)
    left.of("a")("a", math.nan)
    clock.now += 80.0
    left.ended("a")
    assert left.seconds_left() == pytest.approx(40.0 * (TRUSTED + 80.0) / (TRUSTED + 40.0), rel=ROUNDING)


def test_lines_have_every_step_at_work_and_the_part_never_falls(clock, heard):
    left = left_of({"a": 10.0, "b": 10.0, "c": 100.0}, 2, heard, clock)
    left.of("a")("a: orbit", 0.25)
    left.of("b")("b: series", math.nan)
    clock.now += 5.0
    left.ended("a")
    left.of("b")("b: torus", math.nan)
    assert [label for label, _ in heard] == [
        "0 of 3 done; a: orbit (25%)",
        "0 of 3 done; a: orbit (25%); b: series",
        "1 of 3 done; b: torus",
    ]
    clock.now += 40.0
    left.ended("b")  # four times slower than it should be: more is left than before
    left.of("c")("c", math.nan)
    parts = [part for _, part in heard]
    assert parts == sorted(parts)
    assert 0.0 <= parts[0] < parts[-1] < 1.0


def test_one_target_alone_counts_no_others(clock, heard):
    left = left_of({"a": 10.0}, 1, heard, clock)
    left.of("a")("a: orbit", math.nan)
    clock.now += 5.0
    left.of("a")("a: orbit", 0.5)
    assert heard == [("a: orbit", 0.0), ("a: orbit (50%)", 0.5)]


def test_silent_steps_do_not_stop_the_time_left(clock, heard):
    left = left_of({"a": 10.0}, 1, heard, clock)
    told = threading.Event()
    left._tell = lambda label, fraction: told.set() if fraction == 0.5 else None
    left.of("a")("a: series", math.nan)
    threads = threading.active_count()
    with left.ticking(0.01):
        assert not told.wait(0.05)
        clock.now += 5.0
        assert told.wait(10.0)
    assert threading.active_count() == threads
