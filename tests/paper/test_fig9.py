"""Fig. 9: verdicts with both outcomes, its alignment indices, the tori that it is near, and the figure over a shorter time."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu import Chain, fpu_trajectory, packet_state, refine
from symfpu.action_angle.foretold import flow_of, growth_rates
from symfpu.paper import dimensions, fig9
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.dimensions import FULL_TIME, FigureIndices, Foretold, TorusForecast, figure_alignment, foretold_dimension
from symfpu.paper.fig9_tori import Approach, approach, distance_from, five_angles, tori_claim
from symfpu.paper.starts import printed_row
from tests.paper.cases import Cut, alignment, foretold, shorter_figure_9, unheard
from tests.tolerances import AT_THE_START, KEPT_RATES, ROUNDING

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


@pytest.mark.parametrize(("seen", "verdict"), [(5, HOLDS), (4, PARTLY), (3, FAILS)])
def test_five_frequencies(seen, verdict):
    """By what the torus shows at the paper's time; the indices to a shorter one are said beside it."""
    claim = fig9.frequencies_claim(FigureIndices(alignment(3, vectors=7, T=1e7)), foretold(seen), 1.1e-4)
    assert claim.verdict == verdict
    assert f"dimension {seen} at 1e+09" in claim.ours
    assert f"as dimension {seen} from 1e+05" in claim.ours
    assert "a torus of 5 angles by Newton's method, which starts 1.1e-04 of the largest" in claim.ours
    assert "integrated: slopes" in claim.ours


def test_widths_of_natural_packets():
    assert [claim.verdict for claim in fig9.packet_claims(ROW)] == [HOLDS, HOLDS]
    assert [claim.verdict for claim in fig9.packet_claims(replace(ROW, energy="0.0164"))] == [FAILS, FAILS]  # a tenth more


@pytest.mark.parametrize(("late", "verdict"), [(1e-3, HOLDS), (4e-3, HOLDS), (2e-4, PARTLY), (1e-5, FAILS)])
def test_gain_after_order_50(late, verdict):
    claim = fig9.gain_claim(Cut(242, {50: 2e-3, 100: 2e-3, 150: late, 200: 2e-3, 242: 2e-3}))
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


def test_an_angle_more_brings_the_torus_nearer():
    found = approach(Chain(8, alpha="0.3"), "0.001", unheard, angles=(1, 2))
    assert found.angles == (1, 2)
    assert all(np.diff(found.distances) < 0)
    assert found.falls == pytest.approx(np.divide(found.distances[:-1], found.distances[1:]))
    assert max(found.residuals) < found.distances[-1]


@pytest.mark.parametrize(
    ("distances", "verdict", "words"),
    [
        ((0.4, 0.14, 0.02), "holds in part", "none of these is the last"),
        ((0.4, 0.02, 0.019), "holds", "by 20, 1.1"),
        ((0.4, 0.3, 0.2), "does not hold", "by 1.3, 1.5"),
    ],
)
def test_the_claim_says_what_was_found(distances, verdict, words):
    claim = tori_claim(Approach((1, 2, 3), distances, (1e-9,) * 3, (10, 20, 30)))
    assert claim.verdict == verdict
    assert words in claim.ours
    assert ("last" in claim.ours) == (verdict == "holds in part")


def start_of_the_trajectory():
    row = printed_row("Fig. 9")
    return packet_state(row.chain, (1,), row.energy)[0]


def test_the_kept_torus_of_five_angles_starts_where_the_trajectory_does():
    """Its seeds; the other modes say how far it is off. Its residual is below that."""
    torus, start = five_angles(), start_of_the_trajectory()
    assert torus.seeds == (1, 2, 3, 4, 5)
    assert torus.chain == printed_row("Fig. 9").chain
    left = np.abs(torus.Q(0.0) - start) / start[0]
    assert left[:5].max() < AT_THE_START
    assert left.max() == distance_from(torus, start)
    assert torus.residual() < left.max() < 2e-4


@pytest.mark.long
def test_more_harmonics_change_neither_rates_nor_the_dimension_that_is_foretold():
    torus, start = five_angles(), start_of_the_trajectory()
    finer = refine(torus, start={q: float(start[q - 1]) for q in torus.seeds}, most_harmonics=4000)
    assert finer.residual() < torus.residual() / 2
    rates, other = (growth_rates(flow_of(one))[:4] for one in (torus, finer))
    assert rates == pytest.approx(other, rel=KEPT_RATES)
    for one in (torus, finer):
        assert foretold_dimension(TorusForecast(one, 7).frames(), FULL_TIME).value == 4


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
