"""Fig. 2: verdicts with both outcomes."""

from types import SimpleNamespace

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.paper import fig2
from symfpu.paper.captions import law_of, printed_line
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from tests.paper.cases import exponential, record


@pytest.mark.parametrize(("late", "verdict"), [([1e-5, 1e-5], HOLDS), ([1e-5, 1e-2], PARTLY), ([1e-2, 1e-5], FAILS), ([1e-2, 1e-2], FAILS)])
def test_orbits_are_identical_while_a_picture_cannot_tell(late, verdict):
    times = np.array([0.0, 1.0, 1e3, 1e6])
    torus = SimpleNamespace(positions=lambda t: np.tile([1.0, 0.0], (len(t), 1)))
    Q = np.array([[1.0, 0.0], [1.0, 1e-9], [1.0, late[0]], [1.0, late[1]]])
    assert fig2.identical_claim(torus, record(times, Q)).verdict == verdict


def test_the_line_of_the_caption_is_off_where_its_law_is_not():
    """A spectrum on Eq. eksa2: the printed -2 log kappa is off by up to -4 log kappa, 2.9 decades at mode 6."""
    line = printed_line("Fig. 2a")
    kappa = np.arange(1.0, 32) / 32
    on_the_law = 10 ** law_of(line, line.chains[0])(kappa)
    found = fig2.line_claim(line, on_the_law)
    assert found.verdict == PARTLY
    assert "off by up to 2.9 decades as printed, 0 from" in found.ours
    assert fig2.line_claim(line, on_the_law * kappa**-4).verdict == HOLDS
    assert fig2.line_claim(line, 100 * on_the_law).verdict == FAILS


def test_sums_that_both_fall():
    down, up = 0.5 ** np.arange(12.0), 2.0 ** np.arange(12.0)
    assert [fig2.falling_sums_claim(pair, 11).verdict for pair in ((down, down), (up, down), (up, up))] == [HOLDS, PARTLY, FAILS]


@pytest.mark.parametrize(("residual", "verdict"), [(1e-14, FAILS), (1e-6, HOLDS)])
def test_a_torus_found_by_root_finding_refutes_that_it_cannot_be(residual, verdict):
    assert fig2.root_finding_claim(SimpleNamespace(residual=lambda: residual)).verdict == verdict


@pytest.mark.parametrize(("decades", "verdict"), [(1, HOLDS), (-0.1, FAILS)])
def test_exponential_decay_beyond_the_seeds(decades, verdict, monkeypatch):
    monkeypatch.setattr(fig2, "spectrum_floor", lambda exact: 0.0)
    exact = SimpleNamespace(chain=Chain(32, alpha="0.33"), seeds=(1, 2, 3, 4), average_spectrum=lambda: exponential(32, decades))
    assert fig2.exponential_claim(exact).verdict == verdict
