"""Fig. 5: where the series and its integration part, mirror pairs, and one example over a short time."""

import numpy as np
import pytest

from symfpu.files.progress import unheard
from symfpu.paper import fig5
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from tests.paper.cases import exponential


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


def test_one_example_over_a_short_time(monkeypatch, tmp_path):
    monkeypatch.setattr(fig5, "TIME", 1e3)
    monkeypatch.setattr(fig5, "EXAMPLES", {"Fig. 5a": "evenly spread seeds"})
    figure = fig5.figure5(tmp_path, unheard)
    (panel,) = figure.panels
    assert (panel.name, panel.axes[0]) == ("fig5a", "q")
    assert [curve.label for curve in panel.curves] == ["PL", "PLn"]
    assert 0.95 < panel.curves[0].y[[0, 10, 20, 30]].sum() < 1  # of the seeds; the cubic terms have a percent of H
    assert [claim.verdict for claim in figure.claims] == [HOLDS, PARTLY, HOLDS]
    assert "t = 1e+03" in figure.remarks[0]
