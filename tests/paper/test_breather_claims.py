"""Breathers beside their figures: real verdicts of what is cheap, and others of what is not so."""

from dataclasses import replace

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.paper import breather_claims
from symfpu.paper.breather_claims import Closing
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.starts import printed_row, printed_torus
from tests.tolerances import THOUSAND_ROUNDINGS


def test_the_saddle_of_a_mode_that_moves_alone():
    """At Q = -2a/(3c) of V = a Q^2 + c Q^3 the force vanishes, and V is the depth."""
    chain = Chain(3, alpha="0.25")
    Q = np.array([[0.0, 1.0], [0.0, -1.0]])
    plus, minus = chain.energy(Q, np.zeros((2, 2)))
    top = -(plus + minus) / 3 / ((plus - minus) / 2)
    saddle = np.array([0.0, top])
    assert chain.accelerations(saddle) == pytest.approx(np.zeros(2), abs=THOUSAND_ROUNDINGS)
    depth = chain.energy(saddle, np.zeros(2))
    assert breather_claims.saddle_energy(chain, 2) == pytest.approx(depth, rel=THOUSAND_ROUNDINGS)


@pytest.mark.parametrize(
    ("answers", "verdict"),
    [((True, False, True), PARTLY), ((True, True, True), HOLDS), ((True, True, False), FAILS)],
)
def test_breathers_of_every_energy(monkeypatch, answers, verdict):
    """Below and above the saddle in alpha, and in beta."""
    left = list(answers)
    monkeypatch.setattr(breather_claims, "_exists", lambda chain, energy: left.pop(0))
    assert breather_claims.existence_claim().verdict == verdict


@pytest.mark.long
def test_newton_finds_no_breather_above_the_saddle():
    claim = breather_claims.existence_claim()
    assert claim.verdict == PARTLY
    assert "a breather at 0.9 of it, none at 1.1" in claim.ours


def test_the_start_lacks_the_factor_of_the_modes(monkeypatch):
    """Q_1(0) = A_1 (N/2)^(1/2): 4 A_1, sixteen times the energy."""
    row = printed_row("Fig. 7")
    claim = breather_claims.start_claim(row)
    assert claim.verdict == FAILS
    assert "Q_1(0) = 4 A_1" in claim.ours
    two = replace(row, chain=Chain(2, alpha=1), amplitudes=("1",))  # where the factor is 1
    assert breather_claims.start_claim(two).verdict == HOLDS


def closings(printed, own, excess=1e-5):
    return {"Fig. 7": Closing(printed, own, excess)}


@pytest.mark.parametrize(("printed", "own", "verdict"), [(12, 12, HOLDS), (8.7, 14.8, PARTLY), (2.0, 14.8, FAILS)])
def test_pairs_that_close(printed, own, verdict):
    claim = breather_claims.pairs_claim(closings(printed, own))
    assert claim.verdict == verdict
    assert ("was not solved" in claim.ours) == (own > printed + 1)


@pytest.mark.parametrize(("own", "verdict"), [(5.0, HOLDS), (14.8, PARTLY), (2.0, FAILS)])
def test_digits_of_initial_conditions(own, verdict):
    assert breather_claims.precision_claim(closings(own, own)).verdict == verdict


@pytest.mark.parametrize(("orders", "verdict"), [((60, 52), HOLDS), ((20, 60), PARTLY), ((20, 6), FAILS)])
def test_orders_beyond_which_little_is_gained(orders, verdict):
    arrivals = {f"Fig. {7 + i}": (order, 1e-14) for i, order in enumerate(orders)}
    assert breather_claims.orders_claim(arrivals).verdict == verdict


@pytest.mark.long
def test_the_breather_of_figure_8():
    """Six orders are enough; the printed amplitude is 4e-5 of itself too large, and closes to eight digits."""
    row = printed_row("Fig. 8")
    torus = printed_torus(row)
    found = breather_claims.closing(row, torus)
    assert found.own > 13
    assert 7.5 < found.printed < 9
    assert round(found.excess * 1e5) == 4
    assert breather_claims.arrival(torus)[0] <= 8
