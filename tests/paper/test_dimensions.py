"""Alignment indices of figures: integrated in stages until they confirm what is foretold."""

import numpy as np
import pytest

from symfpu.files.progress import unheard
from symfpu.localization.profiles import fpu_trajectory
from symfpu.paper import dimensions
from symfpu.paper.dimensions import FULL_TIME, Foretold, figure_alignment
from symfpu.paper.starts import printed_row
from tests.tolerances import ROUNDING


@pytest.fixture
def start():
    return fpu_trajectory(printed_row("Fig. 1").chain, {1: "0.3", 2: "0.1"})


@pytest.fixture
def stages(monkeypatch):
    monkeypatch.setattr(dimensions, "STAGES", (500.0, 1000.0))
    monkeypatch.setattr(dimensions, "TIME", 2000.0)


def flat(times):
    return Foretold(times, np.zeros((len(times), 4)), np.log(times))


@pytest.mark.parametrize(("at", "last"), [(500.0, 500.0), (1000.0, 1000.0), (np.inf, 2000.0)])
def test_what_is_foretold_ends_the_integration_where_it_is_confirmed(at, last, start, stages, monkeypatch, tmp_path):
    looked = []

    def confirms(found, foretold):
        looked.append(float(found.times[-1]))
        assert foretold.times.tolist() == found.times.tolist()
        return found.times[-1] >= at - 1

    monkeypatch.setattr(dimensions, "confirms", confirms)
    seen = figure_alignment("fig1", start, unheard, tmp_path, flat, full=False)
    assert seen.found.times[-1] == pytest.approx(last, abs=dimensions.CONFIRMING_STEP)
    assert looked == sorted(looked)
    assert len(set(looked)) == [500.0, 1000.0, 2000.0].index(last) + 1
    assert seen.confirmed == np.isfinite(at)
    assert seen.beyond.times[-1] == pytest.approx(FULL_TIME, rel=ROUNDING)
    assert not list(tmp_path.iterdir())


def test_a_whole_run_foretells_nothing_and_keeps_its_file(start, stages, monkeypatch, tmp_path):
    monkeypatch.setattr(dimensions, "FULL_TIME", 1000.0)

    def unasked(times):
        raise AssertionError(times)

    seen = figure_alignment("fig1", start, unheard, tmp_path, unasked, full=True)
    assert (seen.there, seen.beyond, seen.confirmed) == (None, None, False)
    assert [path.name for path in tmp_path.iterdir()] == ["fig1-gali.checkpoint"]
