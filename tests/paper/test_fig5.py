"""Fig. 5: where the series and its integration part, mirror pairs, and one example over a short time."""

from types import SimpleNamespace

import numpy as np
import pytest

from symfpu.paper import fig5
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from tests.paper.cases import exponential, unheard


def parted(level):
    """Twenty decades a mode; the two differ by a factor 10 in the mode at a level."""
    a = 10.0 ** (-10.0 * np.arange(12))
    return {"PL": a, "PLn": np.where(a <= level, a / 10, a)}


@pytest.mark.parametrize(("level", "verdict"), [(0.0, HOLDS), (1e-20, PARTLY), (1.0, FAILS)])
def test_agreement_of_series_and_integration(level, verdict):
    claim = fig5.agreement_claim("Fig. 5a", parted(level))
    assert claim.verdict == verdict
    assert "not stated" not in claim.text
    assert "not stated" in fig5.agreement_claim("Fig. 5b", parted(level)).text  # the paper says so of Example 1 alone


@pytest.mark.parametrize(("level", "verdict"), [(1e-60, HOLDS), (1e-70, FAILS), (1e-50, FAILS), (0.0, FAILS)])
def test_agreement_down_to_a_printed_level(level, verdict):
    claim = fig5.agreement_claim("Fig. 5c", parted(level))
    assert (claim.verdict, claim.printed) == (verdict, "1e-60")


def test_mirror_pairs():
    e = exponential(32, 1)
    assert fig5.mirror_claim(e).verdict == FAILS
    e[[11, 12, 21, 22]] = e[[9, 8, 19, 18]]
    assert fig5.mirror_claim(e).verdict == HOLDS


def peaked(*places):
    """A decade a mode from the nearest of the places."""
    q = np.arange(1, 32)
    return 10.0 ** -np.min([abs(q - place) for place in places], axis=0)


@pytest.mark.parametrize(("places", "verdict"), [((1, 11, 21, 31), HOLDS), ((1, 6, 11, 21, 31), PARTLY), ((1, 16, 31), FAILS)])
def test_peaks_of_a_spectrum(places, verdict):
    assert fig5.peaks_claim("Fig. 5a", peaked(*places)).verdict == verdict


def test_sides_of_a_peak_are_lines():
    e = peaked(1, 11, 21, 31)
    assert fig5.sides_claim(e).verdict == HOLDS
    e[11] *= 100  # mode 12
    assert fig5.sides_claim(e).verdict == PARTLY
    assert fig5.sides_claim(1 / e).verdict == FAILS


def test_branches_of_a_spectrum():
    q = np.arange(1, 64)
    e = 10.0 ** -np.minimum(q, 64 - q).astype(float)
    assert fig5.branches_claim(e).verdict == HOLDS
    assert fig5.branches_claim(1 / e).verdict == FAILS
    e[9] *= 1e6
    assert fig5.branches_claim(e).verdict == PARTLY


@pytest.mark.parametrize(("level", "verdict"), [(1e-32, FAILS), (1e-60, HOLDS), (0.0, HOLDS)])
def test_the_level_of_the_paper_s_integrator(level, verdict):
    series = 10.0 ** (-10.0 * np.arange(12))
    torus = SimpleNamespace(average_spectrum=lambda: series, energy=lambda: 1.0)
    claim = fig5.scheme_level_claim("Fig. 5c", torus, np.where(series <= level, 100 * series, series))
    assert claim.verdict == verdict


def test_one_example_over_a_short_time(monkeypatch, tmp_path):
    monkeypatch.setattr(fig5, "TIME", 1e3)
    monkeypatch.setattr(fig5, "EXAMPLES", {"Fig. 5a": "evenly spread seeds"})
    figure = fig5.figure5(tmp_path, unheard)
    (panel,) = figure.panels
    assert (panel.name, panel.axes[0]) == ("fig5a", "q")
    assert [curve.label for curve in panel.curves] == ["PL", "PLn"]
    assert 0.95 < panel.curves[0].y[[0, 10, 20, 30]].sum() < 1  # of the seeds; the cubic terms have a percent of H
    assert [claim.verdict for claim in figure.claims] == [HOLDS, PARTLY, HOLDS, PARTLY, HOLDS]
    assert "t = 1e+03" in figure.remarks[0]
