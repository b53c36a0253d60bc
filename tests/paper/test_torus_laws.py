"""The laws on tori: verdicts on levels made by hand, and both models for short chains."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu.paper import torus_laws
from symfpu.paper.captions import printed_line
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from tests.tolerances import ROUNDING, THREE_DIGITS

ALPHA, BETA = printed_line("Fig. 4a"), printed_line("Fig. 4b")
PAGE = Path(__file__).parents[2] / "docs" / "localization.md"
SIZES = (64, 128, 256, 512, 1024)


def law(levels, factors=1.0, line=ALPHA):
    shape = (len(SIZES), torus_laws.GROUPS)
    return torus_laws.TorusLaw(line, SIZES, np.broadcast_to(levels, shape), np.broadcast_to(factors, shape))


def random(errors=0.1, sizes=4):
    values = np.zeros((sizes, 3))
    trend = SimpleNamespace(rate=0.0)
    chains = [SimpleNamespace(N=N) for N in SIZES[:sizes]]
    return SimpleNamespace(levels=lambda: (values, values + errors), chains=chains, growth=dict.fromkeys((1, 2, 3), trend))


N = np.array(SIZES)[:, None]


@pytest.mark.parametrize(
    ("levels", "verdict"),
    [
        (3 + 8 / N, HOLDS),  # corrections of 1/N
        (np.log10(N) * 0.2, FAILS),  # a power
        (np.log10(N) * 0.04, PARTLY),  # a small one, but it does not fall
        (np.log10(N) * np.array([0.0, 0.2, 0.2]), PARTLY),
    ],
)
def test_exponents_that_vanish_in_long_chains(levels, verdict):
    assert torus_laws.invariance_claim(law(levels), random()).verdict == verdict


def test_exponents_are_slopes():
    found = law(np.log10(N) * np.array([0.0, 0.5, -1.0]))
    assert found.steps == pytest.approx(np.tile([0.0, 0.5, -1.0], (4, 1)), abs=ROUNDING)
    assert found.exponents == pytest.approx([0.0, 0.5, -1.0], abs=ROUNDING)


def test_errors_are_of_the_spread_over_draws():
    """Of a line through log10 N = x: error/sqrt(sum (x - mean)^2)."""
    x = np.log10(SIZES[:4])
    expected = 0.1 / np.sqrt(np.sum((x - x.mean()) ** 2))
    assert torus_laws.draw_errors(random()) == pytest.approx([expected] * 3, rel=ROUNDING)


@pytest.mark.parametrize(("factor", "verdict"), [(1.5, HOLDS), (6.0, PARTLY), (60.0, FAILS)])
def test_factors_beside_the_printed_ones(factor, verdict):
    printed = np.array([torus_laws.printed_factor("alpha", k) for k in (1, 2, 3)])
    assert torus_laws.factor_claim(law(0.0, factor * printed)).verdict == verdict


def test_factors_go_on_to_their_limit():
    """5 + 1/N is half as far at each length; steps that grow have no limit, and the last one stands."""
    found = law(0.0, np.hstack([5 + 1 / N, N / 64.0, np.ones_like(N)]))
    assert found.limits == pytest.approx([5.0, 16.0, 1.0], rel=ROUNDING)


def test_tori_of_both_models(monkeypatch):
    """Figures of docs/localization.md; the factors are those of asymptotic_group_energy with their corrections."""
    monkeypatch.setattr(torus_laws, "SIZES", {"alpha": (64, 128), "beta": (64, 128)})
    alpha, beta = torus_laws.torus_law(ALPHA), torus_laws.torus_law(BETA)
    assert alpha.factors[0] == pytest.approx([15.98, 40.47, 48.65], rel=THREE_DIGITS)
    assert beta.factors[1] == pytest.approx([2.684, 0.6279, 0.05283], rel=THREE_DIGITS)
    assert alpha.steps[0] == pytest.approx([-0.2089, -0.2909, -0.2616], abs=THREE_DIGITS)
    table = torus_laws.factors_table({"alpha": alpha, "beta": beta})
    assert table.count("C_1") == 2


@pytest.mark.long
def test_the_page_has_these_tables():
    laws = {"alpha": torus_laws.torus_law(ALPHA), "beta": torus_laws.torus_law(BETA)}
    page = PAGE.read_text()
    assert torus_laws.factors_table(laws) in page
    for model, found in laws.items():
        for k, (exponent, last) in enumerate(zip(found.exponents, found.steps[-1], strict=True), 1):
            assert f"| {model} | D_{k} | {exponent:.3f} | {last:.3f} |" in page
    verdicts = {model: torus_laws.invariance_claim(found, random()) for model, found in laws.items()}
    assert verdicts["alpha"].verdict == HOLDS
    assert verdicts["beta"].verdict == PARTLY
    assert "but D_3 moves yet" in verdicts["beta"].ours
