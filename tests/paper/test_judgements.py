"""Verdicts that several figures need, each with every outcome it can have."""

import numpy as np
import pytest

import symfpu
from symfpu import Chain, refine
from symfpu.dynamics.dimension import DECADES
from symfpu.figures.alignment import alignment_panel
from symfpu.paper.claims import FAILS, HOLDS, OPEN, PARTLY
from symfpu.paper.dimensions import (
    FigureIndices,
    Foretold,
    TorusForecast,
    confirms,
    indices_panel,
)
from symfpu.paper.judgements import (
    cancellation_claim,
    dimension_claim,
    falls,
    foretold_claim,
    groups_claim,
    parting_level,
    runs,
    same_profile,
)
from tests.paper.cases import alignment, exponential
from tests.tolerances import WHOLE_NUMBERS


def decades_off(mode, decades):
    """A profile over thirty decades, and the same with one mode raised."""
    e = exponential(16, 2)
    other = e.copy()
    other[mode - 1] *= 10**decades
    return {"A": e, "B": other}


@pytest.mark.parametrize(
    ("mode", "decades", "verdict"),
    [(14, 0.09, HOLDS), (14, 0.11, PARTLY), (3, 0.11, FAILS), (3, -0.11, FAILS), (14, 20.0, FAILS), (16, 0.0, HOLDS)],
)
def test_profiles_agree_everywhere_or_high_up_or_not(mode, decades, verdict):
    """Modes 1 to 8 of this profile lie above 1e-14, the others between it and 1e-28."""
    profiles = decades_off(min(mode, 15), decades)
    found = same_profile("4", "they agree", profiles, "A", "B")
    assert found.verdict == verdict
    assert (f"(mode {mode})" in found.ours) == (mode < 16)


def test_a_wider_tolerance_is_asked_for_by_name():
    profiles = decades_off(3, 0.9)
    assert same_profile("4", "", profiles, "A", "B").verdict == FAILS
    assert same_profile("4", "", profiles, "A", "B", within=1.0).verdict == HOLDS
    assert same_profile("4", "", decades_off(12, 5.0), "A", "B", floor=1e-16).verdict == HOLDS  # below the floor


@pytest.mark.parametrize(
    ("dimension", "verdict"), [(2, HOLDS), (3, FAILS), (5, FAILS)], ids=["as printed", "another", "as many as there are vectors, or more"]
)
def test_dimension(dimension, verdict):
    found = dimension_claim("3.2", "a 2-torus", 2, alignment(dimension))
    assert (found.verdict, found.printed) == (verdict, "dimension 2")
    assert f"dimension {dimension}" in found.ours


def test_as_many_dimensions_as_vectors_decide_nothing():
    """All indices constant: s = 5 or more is not s = 5."""
    assert dimension_claim("3.2", "", 5, alignment(5)).verdict == FAILS
    assert "or more" in dimension_claim("3.2", "", 5, alignment(5)).ours


@pytest.mark.long
@pytest.mark.parametrize(("printed", "after", "verdict"), [(2, None, HOLDS), (2, 1.0, PARTLY), (3, None, FAILS)])
def test_a_dimension_foretold(printed, after, verdict):
    """From the exact torus; the time at which G_3 settles is one of the frames' or not."""
    torus = refine(symfpu.torus(Chain(8, alpha="0.3"), (1, 2), amplitudes={1: "0.3", 2: "0.2"}, method="series", order=6))
    frames = TorusForecast(torus, 4).frames()
    settled = after or frames[0].settling()[3] / 10**DECADES
    claim = foretold_claim("4", "a torus", printed, frames, FigureIndices(alignment(2, vectors=4)), (3, settled))
    assert claim.verdict == verdict
    assert "regular, dimension 2 at 1e+09 (by frame 2, 2, 2, 2" in claim.ours


def test_before_the_orbit_shears_nothing_is_decided():
    found = dimension_claim("3.2", "", 5, alignment(5, growth=0.0))
    assert found.verdict == OPEN
    assert "take a longer time" in found.ours


def test_another_dimension_before_the_paper_s_window_decides_nothing():
    early = {"shown_after": 3e7, "whole": 1e9}
    assert dimension_claim("4", "", 4, alignment(5), **early).verdict == OPEN
    assert "after 3e+07" in dimension_claim("4", "", 4, alignment(5), **early).ours
    assert dimension_claim("4", "", 4, alignment(5, T=1e9), **early).verdict == FAILS
    same = dimension_claim("4", "", 4, alignment(4), **early)
    assert same.verdict == HOLDS
    assert "the paper goes to 1e+09" in same.ours
    assert "the paper goes" not in dimension_claim("4", "", 4, alignment(4, T=1e9), **early).ours


@pytest.mark.parametrize(
    ("decades", "verdict"), [(4.0, HOLDS), (3.6, HOLDS), (4.6, PARTLY), (3.0, PARTLY), (2.0, PARTLY), (1.9, FAILS), (0.0, FAILS)]
)
def test_cancellation_is_measured_at_its_order(decades, verdict):
    lower = 0.5 ** np.arange(31.0)
    upper = lower.copy()
    upper[14] *= 10**decades
    found = cancellation_claim("3.2", "", 4.0, (upper, lower), 14)
    assert found.verdict == verdict
    assert f"10^{decades:.2f} at k = 14" in found.ours


def test_a_sum_falls_by_parity():
    zigzag = np.array([8.0, 1.0, 4.0, 0.5, 2.0, 0.25, 3.0])
    assert falls(zigzag, 5)
    assert not falls(zigzag, 6)


def test_groups_lie_below_each_other_wholly_or_by_median():
    e = np.array([1.0, 0.5, 1e-3, 1e-4, 1e-6, 1e-7])
    groups = [(1, 2), (3, 4), (), (5, 6)]
    assert groups_claim("6.2", "", groups, e).verdict == HOLDS
    e[3], e[4] = 2e-6, 4e-6
    assert groups_claim("6.2", "", groups, e).verdict == PARTLY
    e[4:] = 0.1
    found = groups_claim("6.2", "", groups, e)
    assert found.verdict == FAILS
    assert "1 of 2 groups" in found.ours


def test_spectra_part_at_the_highest_level_where_they_differ():
    a = exponential(8, 3)
    b = a.copy()
    assert parting_level(a, b) == (0.0, 0)
    b[[3, 5]] *= 2
    assert parting_level(a, b) == (b[3], 4)
    assert parting_level(a, b, decades=0.31) == (0.0, 0)
    b[6] = 0.0
    a[6] = 1e-3
    assert parting_level(a, b) == (1e-3, 7)


def test_runs_of_modes():
    assert runs((5, 6, 7, 9, 11, 12)) == "5..7, 9, 11..12"
    assert runs(()) == ""


def test_alignment_panels_are_logarithms_already():
    made = alignment_panel("fig1e", "indices", alignment(2))
    assert not made.log_y
    assert [curve.name for curve in made.curves] == ["G_2", "G_3", "G_4", "G_5"]
    assert r"-3.00 \pm 0.00" in made.curves[-1].label
    assert made.curves[-1].y[-1] == pytest.approx(-21, abs=WHOLE_NUMBERS)  # 3 x 7 decades


def as_foretold(found, *, steeper=0.0, higher=0.0, growth=1.0):
    """The same indices, G_5 with another slope and all of them higher."""
    gali = found.log10_gali + higher
    gali[:, -1] -= steeper * np.log10(found.times)
    return Foretold(found.times, gali, growth * found.lyapunov * found.times)


@pytest.mark.parametrize(
    ("off", "same"),
    [({}, True), ({"steeper": 0.3}, True), ({"steeper": -0.4}, False), ({"higher": 2.0}, True), ({"growth": 0.01}, False)],
    ids=["the same", "slopes within a third", "another slope", "another level", "nothing seen yet"],
)
def test_what_is_foretold_is_confirmed_by_slopes_where_growth_is_seen(off, same):
    found = alignment(2)
    assert confirms(found, as_foretold(found, **off)) == same
    assert not confirms(alignment(2, growth=0.01), as_foretold(alignment(2, growth=0.01)))


def test_what_is_foretold_is_drawn_beyond_what_was_integrated():
    found, times = alignment(2, T=1e6), np.geomspace(1.0, 1e9, 91)
    beyond = Foretold(times, np.log10(times)[:, None] * [0.0, -1.0, -2.0, -3.0], times)
    made = indices_panel("fig1e", "indices", FigureIndices(found, beyond, beyond, confirmed=True))
    foretold = {curve.name: curve for curve in made.curves if "foretold" in curve.name}
    assert list(foretold) == ["foretold from", *(f"G_{k} foretold" for k in range(2, 6))]
    assert all(curve.x.min() > 6.0 and curve.x.max() == 9.0 for curve in foretold.values())
    assert {curve.style for name, curve in foretold.items() if name != "foretold from"} == {"dotted"}
    assert indices_panel("fig1e", "", FigureIndices(found)).table()[0] == made.table()[0]
    assert len(indices_panel("fig1e", "", FigureIndices(found)).curves) == 4
