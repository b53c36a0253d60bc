"""Targets side by side: which is begun first, and that the failure of one costs no other."""

import math

import pytest

from symfpu.errors import InputError
from symfpu.paper import side_by_side as module
from symfpu.paper import targets
from symfpu.paper.claims import PaperFigure
from symfpu.paper.side_by_side import TargetsFailed, in_turn, side_by_side
from symfpu.paper.targets import FIRST_PICTURE, SECONDS, TARGETS


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
    assert isinstance(found["fig6"], OSError)
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
