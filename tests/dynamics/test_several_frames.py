"""Several frames of deviation vectors along one orbit, and what they say together."""

from functools import cache

import numpy as np
import pytest

from symfpu import Chain, alignment_indices
from symfpu.dynamics.dimension import TorusDimension
from symfpu.dynamics.several_frames import together

BETA = Chain(4, beta=1)
RUN = BETA, [0, 0.4, 0], [0, 0, 0], 2e3
TWO = TorusDimension("regular, dimension 2", 2, 0.0, {2: 1.0}, "as t", 2, (2,))
THREE = TorusDimension("regular, dimension 3", 3, 0.0, {3: 1.0}, "as t", 3, (3,))
OPEN = TorusDimension("undecided", None, 0.5, {2: 0.5, 3: 0.5}, "take a longer time", 2)
NOTHING = TorusDimension("undecided", None, 0.5, {2: 0.5, 3: 0.5}, "take a longer time")
CHAOS = TorusDimension("chaotic", None, 0.0, {}, "|v| has grown")


@cache
def found(frames, seed=0):
    return alignment_indices(*RUN, vectors=3, samples=100, frames=frames, seed=seed)


def test_each_frame_is_that_of_its_own_seed():
    several = found(3)
    assert len(several.frames) == 3
    for i, one in enumerate(several.frames):
        alone = found(1, i)
        assert np.array_equal(one.log10_gali, alone.log10_gali)
        assert np.array_equal(one.lyapunov, alone.lyapunov)
        assert one.others == ()
    assert several.energy_error == found(1).energy_error


def test_slopes_are_the_mean_and_their_errors_tell_the_spread():
    values = np.array([[s.value for s in one.slopes()] for one in found(3).frames])
    slopes = found(3).slopes()
    assert [s.value for s in slopes] == pytest.approx(values.mean(axis=0))
    assert all(s.error >= e for s, e in zip(slopes, values.std(axis=0, ddof=1) / 3**0.5, strict=True))


def test_four_frames_by_default():
    several = alignment_indices(BETA, [0, 0.4, 0], [0, 0, 0], 200.0, vectors=2, samples=64)
    assert len(several.frames) == len(several.dimension().frames) == 4
    assert "by 4 frames" in repr(several)


def test_files_of_further_frames_are_beside_the_first_and_go_on(tmp_path):
    file = tmp_path / "gali.zip"
    shorter = (*RUN[:3], 500.0)
    short = {"vectors": 3, "samples": 100, "file": file}
    alignment_indices(*shorter, frames=1, **short)
    alignment_indices(*shorter, frames=2, **short)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["gali-2.zip", "gali.zip"]
    seen = []
    again = alignment_indices(*shorter, frames=2, **short, progress=lambda label, done: seen.append(label))
    assert seen == []
    longer = alignment_indices(*RUN, frames=2, **short)
    for one, other in zip(longer.frames, again.frames, strict=True):
        assert np.array_equal(one.log10_gali[: len(other.times)], other.log10_gali)


def test_progress_is_that_of_all_frames():
    told = []
    alignment_indices(*RUN, vectors=2, samples=64, frames=2, progress=lambda label, done: told.append((label, done)))
    fractions = [done for _, done in told]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert told[-1][0].startswith("frame 2 of 2, t = ")


@pytest.mark.parametrize(
    ("frames", "verdict", "supported"),
    [
        ([TWO, TWO, TWO, TWO], "regular, dimension 2", 2),
        ([TWO, OPEN, TWO, OPEN], "regular, dimension 2", 2),
        ([TWO, OPEN, OPEN, OPEN], "undecided", 2),
        ([TWO, THREE, TWO, TWO], "undecided", 2),
        ([NOTHING, NOTHING, NOTHING], "undecided", None),
        ([NOTHING, OPEN], "undecided", 2),
        ([TWO, CHAOS, TWO, TWO], "chaotic", None),
    ],
)
def test_what_frames_say_together(frames, verdict, supported):
    said = together(frames)
    assert (said.verdict, said.supported) == (verdict, supported)
    assert said.frames == tuple(one.value for one in frames)
    assert (said.value is None) == (not verdict.startswith("regular"))
    if verdict == "undecided":
        assert "take a longer time" in said.reason


def test_the_spread_is_that_of_the_mean_weights():
    said = together([TWO, OPEN])
    assert said.weights == {2: 0.75, 3: 0.25}
    assert said.error == pytest.approx(0.5)
