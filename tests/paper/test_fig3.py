"""Fig. 3: verdicts with both outcomes, and the figure computed over a short time."""

from types import SimpleNamespace

import numpy as np
import pytest

from symfpu import Chain, GroupGrowth
from symfpu.paper import fig3
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.starts import printed_row
from tests.paper.cases import exponential, unheard


def groups(*means, spread=0.1, times=(100.0, 200.0)):
    return [GroupGrowth(k, tuple(range(4 * k + 1, 4 * k + 5)), mean, spread, times) for k, mean in enumerate(means, 1)]


def test_groups_grow_alike_and_apart():
    assert fig3.alike_claim(groups(1.5, 3.0, 4.5)).verdict == HOLDS
    assert fig3.alike_claim(groups(1.5, 3.0, 4.5, spread=0.4)).verdict == PARTLY
    assert fig3.alike_claim(groups(1.5, 3.0, 3.3)).verdict == FAILS
    assert "D_1 = 5..8: 1.50 +- 0.10" in fig3.alike_claim(groups(1.5, 3.0)).ours


def test_exponents_of_three_halves():
    right, wrong, early = groups(1.5, 3.0, 4.5), groups(2.0, 4.0, 6.0), groups(1.55, 2.9, 6.0)
    assert fig3.exponents_claim(right, right).verdict == HOLDS
    assert fig3.exponents_claim(wrong, right).verdict == PARTLY
    assert fig3.exponents_claim(wrong, early).verdict == PARTLY
    assert fig3.exponents_claim(wrong, wrong).verdict == FAILS
    assert fig3.exponents_claim(right, wrong).verdict == FAILS
    assert "2.00, 2.00, 2.00 from pi/Omega_1" in fig3.exponents_claim(wrong, right).ours


@pytest.mark.parametrize(("slow", "fast", "verdict"), [(900, 110, HOLDS), (900, 320, PARTLY), (100, 110, PARTLY), (100, 1000, FAILS)])
def test_arrival_times_are_powers_of_ten(slow, fast, verdict):
    first, second = groups(1.5, 3.0)
    ended = [GroupGrowth(g.order, g.modes, g.mean, g.spread, (10.0, float(t))) for g, t in ((first, slow), (second, fast))]
    assert fig3.arrival_claim(ended).verdict == verdict


@pytest.mark.parametrize(("change", "verdict"), [(1e-4, HOLDS), (1e-2, FAILS), (1e-6, FAILS)])
def test_averages_of_seeds_vary_by_a_ten_thousandth(change, verdict):
    shares = np.zeros((2, 31))
    shares[:, :4] = 0.25
    shares[1, 2] -= change
    assert fig3.seeds_claim(shares, printed_row("Fig. 2")).verdict == verdict


@pytest.mark.parametrize(("decades", "verdict"), [(0.05, HOLDS), (0.9, PARTLY), (1.1, FAILS)])
def test_a_spectrum_persists_from_a_hundredth_of_the_time_on(decades, verdict):
    e = exponential(16, 1)
    moved = e * 10 ** np.where(np.arange(15) == 4, decades, 0.0)
    found = fig3.persistence_claim(np.array([1.0, 1e2, 1e4, 1e6]), np.array([10 * e, 10 * e, moved, e]))
    assert found.verdict == verdict
    assert "from t = 1e+04 to 1e+06" in found.ours


@pytest.mark.long
def test_figure_3_over_a_short_time(monkeypatch, tmp_path):
    """2e4, in place of 1e6: the first stage is over by then."""
    monkeypatch.setattr(fig3, "TIME", 2e4)
    figure = fig3.figure3(tmp_path, unheard)
    a, b = figure.panels
    assert [a.name, b.name] == ["fig3a", "fig3b"]
    names = {row[0] for row in a.table()[1]}
    assert len(names) == 31
    assert {"D_0 q=1", "D_1 q=5", "D_7 q=31"} <= names
    distance, alike, exponents, _, seeds, *_, profile, apart = figure.claims
    assert [alike.verdict, exponents.verdict, seeds.verdict, profile.verdict, apart.verdict] == [HOLDS, PARTLY, FAILS, HOLDS, HOLDS]
    assert {claim.section for claim in figure.claims} == {"4.1"}
    assert distance.verdict == HOLDS
    assert "mu = 0.04125" in distance.ours


@pytest.mark.parametrize(("off", "alpha", "verdict"), [(0.1, "0.33", HOLDS), (0.1, "0.5", PARTLY), (0.5, "0.33", FAILS)])
def test_the_initial_distance_is_of_the_order_of_mu(off, alpha, verdict):
    torus = SimpleNamespace(chain=Chain(32, alpha=alpha), Q=lambda t: np.array([2.0, 2.0 * off]))
    assert fig3.distance_claim(torus, np.array([2.0, 0.0])).verdict == verdict
