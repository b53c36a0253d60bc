"""Fig. 9: verdicts with both outcomes, and the figure with a shorter series and a shorter time."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu.files.progress import unheard
from symfpu.paper import fig9
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.dimensions import FigureIndices
from symfpu.paper.starts import printed_row
from tests.paper.cases import alignment, growth_at, shorter_figure_9

ROW = printed_row("Fig. 9")


def returning(period, back=1.0):
    """Energy that goes from one mode to another and comes back, in part."""
    t = np.linspace(0.0, 1.5 * period, 301)
    away = 0.5 * (1 - np.cos(2 * np.pi * t / period)) * np.where(t > period / 2, back, 1.0) + np.where(t > period / 2, 1 - back, 0.0)
    E = np.stack([1 - away, away], axis=-1)
    return SimpleNamespace(times=t, energies=np.full(301, 0.0149), harmonic_energies=lambda: E)


@pytest.mark.parametrize(("period", "back", "verdict"), [(12100, 1.0, HOLDS), (14000, 1.0, FAILS), (12000, 0.8, FAILS)])
def test_recurrence_has_a_time_and_a_completeness(period, back, verdict):
    claim = fig9.recurrence_claim(ROW, {"printed E": returning(period, back), "printed A_1": returning(14000)})
    assert claim.verdict == verdict
    assert f"t = {period}" in claim.ours


@pytest.mark.parametrize(("swing", "verdict"), [(2.0, HOLDS), (4.0, FAILS)])
def test_breathers_are_almost_constant(swing, verdict):
    breather = np.full((10, 31), 1e-3)
    breather[::2, 3] *= swing
    orbit = SimpleNamespace(averages=np.full((2, 31), 1e-3), energies=np.ones(2))
    assert fig9.constancy_claim(breather, orbit).verdict == verdict


@pytest.mark.parametrize(
    ("seen", "verdict"), [pytest.param(5, HOLDS, marks=pytest.mark.long), (4, PARTLY), pytest.param(3, FAILS, marks=pytest.mark.long)]
)
def test_five_frequencies(seen, verdict):
    """By what the torus shows at the paper's time; the indices to a shorter one are said beside it."""
    growth = growth_at([1e-4] * seen + [1e-15])
    claim = fig9.frequencies_claim(FigureIndices(alignment(3, vectors=7, T=1e7)), growth)
    assert claim.verdict == verdict
    assert f"dimension {seen} at 1e+09" in claim.ours
    assert "integrated: slopes" in claim.ours


def test_widths_of_natural_packets():
    assert [claim.verdict for claim in fig9.packet_claims(ROW)] == [HOLDS, HOLDS]
    assert [claim.verdict for claim in fig9.packet_claims(replace(ROW, energy="0.0164"))] == [FAILS, FAILS]  # a tenth more


@dataclass(frozen=True)
class Series:
    """With a residual for each coordinate order."""

    order: int
    residuals: dict

    def residual(self):
        return self.residuals[self.order]


@pytest.mark.parametrize(("late", "verdict"), [(1e-3, HOLDS), (4e-3, HOLDS), (2e-4, PARTLY), (1e-5, FAILS)])
def test_gain_after_order_50(late, verdict):
    claim = fig9.gain_claim(Series(242, {50: 2e-3, 100: 2e-3, 150: late, 200: 2e-3, 242: 2e-3}))
    assert claim.verdict == verdict
    assert "50: 2.0e-03, 100: 2.0e-03, 150:" in claim.ours


@pytest.mark.long
def test_figure_9_with_a_short_series(monkeypatch, tmp_path):
    shorter_figure_9(monkeypatch)
    figure = fig9.figure9(tmp_path, unheard)
    assert [panel.name for panel in figure.panels] == ["fig9a", "fig9b", "fig9c", "fig9d"]
    first, still, *_ = figure.claims
    assert (first.verdict, still.verdict) == (HOLDS, HOLDS)
    assert "(H = 0.014915) returns to 98" in first.ours
    assert "(H = 0.008149)" in first.ours
    assert list(tmp_path.iterdir()) == []  # no checkpoint without --full
