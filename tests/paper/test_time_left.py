"""Time left of targets side by side, by a clock that goes when it is told to."""

import math
import threading

import pytest

from symfpu.paper.time_left import ENDING, TRUSTED, TimeLeft
from tests.tolerances import ROUNDING


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
