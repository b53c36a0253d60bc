"""Figs. 7 and 8: verdicts with both outcomes, and both figures over a short time."""

from types import SimpleNamespace

import numpy as np
import pytest

from symfpu.figures.panels import Curve
from symfpu.paper import breather_profiles, fig7, fig8, starts
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.starts import printed_row
from tests.paper.cases import exponential, unheard
from tests.tolerances import PICTURE

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together

SEQUENCE = [25, 14, 11, 28, 3, 22, 17]


def moving(decades, modes=8):
    """E_q(t) swinging by so many decades in all modes about the same mean of logarithms."""
    swing = np.array([0.5, -0.5] * 20)[:, None]
    return exponential(16, 1)[None, :modes] * 10 ** (swing * decades)


@pytest.mark.parametrize(("still", "swing", "verdict"), [(0.1, 2.0, HOLDS), (0.6, 2.0, PARTLY), (0.1, 0.5, PARTLY), (0.6, 0.5, FAILS)])
def test_constant_on_the_breather_and_not_on_the_trajectory(still, swing, verdict):
    assert fig7.constancy_claim(moving(still), moving(swing)).verdict == verdict


def test_variation_is_the_largest_over_the_smallest():
    assert breather_profiles.variation(np.array([[1.0, 2.0], [10.0, 2.0]])).tolist() == [1.0, 0.0]


def test_means_that_follow_the_breather():
    breather = moving(0.1)
    high = np.where(np.arange(8) > 5, 10.0, 1.0)
    low = np.where(np.arange(8) == 2, 0.1, 1.0)
    assert fig7.means_claim(breather, breather * 1.5).verdict == HOLDS
    assert fig7.means_claim(breather, breather * high).verdict == PARTLY
    assert fig7.means_claim(breather, breather * low).verdict == FAILS


@pytest.mark.parametrize(("off", "verdict"), [(0.0, HOLDS), (1e-11, HOLDS), (1e-9, FAILS)])
def test_return_after_a_period_in_digits(monkeypatch, off, verdict):
    orbit = SimpleNamespace(Q=np.array([[0.5, 0.0], [0.5, 0.5 * off]]), P=np.zeros((2, 2)))
    monkeypatch.setattr(starts, "integrated_orbit", lambda *given, **options: orbit)
    assert fig7.return_claim(printed_row("Fig. 7"), None).verdict == verdict


@pytest.mark.parametrize(("first", "decades", "verdict"), [(1, 0.0, HOLDS), (10, 2.0, PARTLY), (5, 2.0, FAILS)])
def test_the_law_in_the_low_modes_and_in_all(first, decades, verdict):
    spectrum = exponential(32, 2)
    law = Curve("law", np.arange(1.0, 32), spectrum * np.where(np.arange(1, 32) >= first, 10**decades, 1.0), "law")
    assert breather_profiles.law_claim("6.4.1", spectrum, law).verdict == verdict


@pytest.mark.parametrize(("level", "verdict"), [(1e-15, HOLDS), (1e-24, PARTLY), (0.0, FAILS)])
def test_rounding_shows_below_its_level(level, verdict):
    """Modes at 1e-3, 1e-6, ... of the energy; rounding doubles those at the level and below."""
    series = np.tile(10.0 ** (-3.0 * np.arange(1, 11)), (4, 1))
    paper = np.where(series <= 1.01 * level, 2 * series, series)
    claim = fig8.rounding_claim({"PLn, Yoshida 4": paper, "PLn, mode space": series, "PL": series}, tuple(range(1, 11)))
    assert claim.verdict == verdict
    assert "PLn, mode space: nowhere down to 1e-30" in claim.ours


def test_means_of_the_second_half_alone_are_compared():
    series = np.ones((4, 2))
    early = series * np.array([5, 5, 1, 1])[:, None]
    assert "Yoshida 4: nowhere" in fig8.rounding_claim({"PLn, Yoshida 4": early, "PL": series}, (1, 2)).ours


def spectra(ratios):
    """Seven modes in the order of excitation, three decades apart, and a trajectory off by so many decades."""
    breather = np.full(31, 1e-40)
    breather[np.array(SEQUENCE) - 1] = 10.0 ** (-3.0 * np.arange(7))
    fpu = breather.copy()
    fpu[np.array(SEQUENCE) - 1] *= 10.0 ** np.array(ratios)
    return {"PL": breather, "FPU-trajectory": fpu}


def test_a_trajectory_leaves_the_breather_at_later_modes():
    assert breather_profiles.hierarchy_claim(spectra([0, 0.2, 0.5, 1, 2, 3, 4]), SEQUENCE).verdict == HOLDS
    assert breather_profiles.hierarchy_claim(spectra([0, -0.2, -0.5, -1, -2, -3, -4]), SEQUENCE).verdict == HOLDS  # below is off as well
    assert (
        breather_profiles.hierarchy_claim(spectra([4, 3, 2, 1, 0.5, 0.2, 0]), SEQUENCE).verdict == PARTLY
    )  # the order stays, the early modes are off
    assert breather_profiles.hierarchy_claim(spectra([0, 0, 0, 0, 0, 0, 4]), SEQUENCE).verdict == PARTLY  # the last two change places
    assert breather_profiles.hierarchy_claim(spectra([0, 0, 4, 0, 0, 0, 0]), SEQUENCE).verdict == FAILS


def test_figure_7_over_a_short_time(monkeypatch, tmp_path):
    monkeypatch.setattr(fig7, "TIME", 2e3)
    figure = fig7.figure7(tmp_path, unheard)
    assert [panel.name for panel in figure.panels] == ["fig7a", "fig7b", "fig7c", "fig7d"]
    a, b, c, d = figure.panels
    assert a.bottom == b.bottom == c.bottom
    assert [curve.name for curve in a.curves] == [f"q={q}" for q in range(1, 9)]
    assert [curve.label for curve in d.curves] == ["PL", "PLn", "FPU-trajectory", "Newton", "Eq. brelaw"]
    by_text = {claim.text: claim.verdict for claim in figure.claims}
    assert all(verdict == HOLDS for text, verdict in by_text.items() if "not stated" in text or "returns" in text or "constant" in text)
    assert c.curves[1].y[0] == 0.0  # mode 2 of the trajectory begins without energy
    assert np.abs(a.curves[0].y / b.curves[0].y - 1).max() < PICTURE  # PLn follows PL; the step leaves 1e-6


def test_figure_8_over_a_short_time(monkeypatch, tmp_path):
    """Times of samples are those of the nearest steps, of each integration its own."""
    monkeypatch.setattr(fig8, "TIME", 100.0)
    monkeypatch.setattr(fig8, "AVERAGING_TIME", 1e3)
    figure = fig8.figure8(tmp_path, unheard)
    a, b = figure.panels
    curves = {curve.name: curve for curve in a.curves}
    assert len(curves) == 3 * 7
    deep, series = curves["PLn, mode space q=14"], curves["PL q=14"]
    assert np.array_equal(deep.x, series.x)
    assert np.abs(np.log10(deep.y / series.y)).max() < 1e-2  # at the same times; off by half a step they differ by a tenth
    assert [curve.label for curve in b.curves] == ["PL", "PLn", "FPU-trajectory"]
    assert figure.claims[-1].verdict == HOLDS
