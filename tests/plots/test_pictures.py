"""Every picture is the one that was looked at: its curves, its colours, its words."""

import numpy as np
import pytest

from symfpu import plots
from tests.plots import cases
from tests.plots.pictures import BASELINE, PICTURES, distance, drawn, kept
from tests.tolerances import DRAWING


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_the_one_that_was_looked_at(name):
    words, pixels = drawn(name)
    expected_words, expected = kept(name)
    assert words == expected_words
    assert distance(pixels, expected) < DRAWING, "look at it; python -m tests.plots.pictures keeps it"


def test_there_is_a_kept_picture_for_each_and_no_other():
    assert {path.stem for path in BASELINE.glob("*.png")} == set(PICTURES)
    assert all(path.stat().st_size < 30_000 for path in BASELINE.glob("*.png"))


def test_every_function_but_the_animation_has_a_picture():
    source = [draw.__code__.co_names for draw in PICTURES.values()]
    drawn_names = {name for names in source for name in names}
    public = {name for name in vars(plots) if callable(getattr(plots, name))}
    assert public - drawn_names == {"animation"}


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("spectrum", lambda ax: plots.spectrum(cases.refined(), ax)),
        ("spectrum", lambda ax: plots.spectrum(cases.torus(), ax, groups=3)),
        ("small-divisors", lambda ax: plots.small_divisors(cases.series(8), ax)),
        ("torus-breather", lambda ax: plots.torus(cases.breather(), ax, modes=(2, 6))),
        ("proof", lambda ax: plots.propagation(cases.proof().rule, ax, N=8)),
        ("family-multipliers", lambda ax: plots.family_multipliers(cases.stable_family(), ax)),
    ],
)
def test_another_result_is_another_picture(name, other):
    """Seen also where a few points differ."""
    _, pixels = drawn(name, other)
    assert distance(pixels, kept(name)[1]) > 2 * DRAWING


def test_another_font_is_the_same_picture():
    style = {"font.family": "DejaVu Serif", "font.size": 12}
    for name in ("spectrum", "multipliers"):
        assert distance(drawn(name, **style)[1], kept(name)[1]) < DRAWING


def test_pixels_are_averaged():
    black, white = np.zeros((8, 8, 3)), np.ones((8, 8, 3))
    assert distance(black, white) == 1
    assert distance(black, black) == 0
