"""Fig. 4: verdicts on profiles and levels made by hand, the laws on tori, and the whole figure over a short time."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu import ProfileInvariance
from symfpu.paper import fig4, torus_laws
from symfpu.paper.captions import caption_curve, printed_line
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from tests.paper.cases import unheard
from tests.tolerances import FOUR_DIGITS, ROUNDING

ALPHA, BETA = printed_line("Fig. 4a"), printed_line("Fig. 4b")


def profiles(line, factor=lambda N, kappa: 1.0):
    """Spectra on the line of the caption for every size, times a factor; the noise is below."""
    spectra = []
    for chain in line.chains:
        kappa = np.arange(1.0, chain.N) / chain.N
        spectra.append((caption_curve(line, kappa).y * factor(chain.N, kappa))[None, :])
    floors = tuple(np.full(rows.shape[1], 1e-60) for rows in spectra)
    return ProfileInvariance(line.fraction, line.specific_energy, 1e6, "equal", line.chains, tuple(spectra), floors, ())


def stairs(N, kappa):
    """From the line to steps that are level within the groups of the alpha model."""
    centre = (np.ceil(kappa * 8 - 1e-9) - 0.5) / 8
    return caption_curve(ALPHA, centre).y / caption_curve(ALPHA, kappa).y


def hump(N, kappa):
    """Steps, and ten times more at their ends for the longest chain alone."""
    end = np.abs(kappa * 8 - np.round(kappa * 8)) < 1e-9
    return stairs(N, kappa) * np.where(end & (N == 512), 10.0, 1.0)


@pytest.mark.parametrize("line", [ALPHA, BETA], ids=["alpha", "beta"])
def test_spectra_on_the_line_fit_it_and_lie_on_each_other(line):
    found = profiles(line)
    assert fig4.line_claim(line, found).verdict == HOLDS
    assert fig4.same_line_claim(line, found).verdict == HOLDS


def test_spectra_off_the_line_do_not_fit_it():
    assert fig4.line_claim(ALPHA, profiles(ALPHA, lambda N, kappa: 100.0)).verdict == FAILS
    one = fig4.line_claim(ALPHA, profiles(ALPHA, lambda N, kappa: 100.0 if N == 512 else 1.0))
    assert one.verdict == PARTLY
    assert "2 for N = 512" in one.ours


def test_spectra_on_another_line_still_lie_on_each_other():
    assert fig4.same_line_claim(ALPHA, profiles(ALPHA, lambda N, kappa: 100.0)).verdict == HOLDS


def test_spectra_that_move_with_the_size():
    law = profiles(ALPHA, lambda N, kappa: stairs(N, kappa) * 64 / N)
    assert fig4.same_line_claim(ALPHA, law).verdict == FAILS  # what the law itself says
    assert fig4.same_line_claim(ALPHA, profiles(ALPHA, stairs)).verdict == HOLDS
    assert fig4.same_line_claim(ALPHA, profiles(ALPHA, hump)).verdict == PARTLY


def test_modes_below_the_noise_do_not_count():
    found = profiles(BETA, lambda N, kappa: np.where(kappa > 0.5, 1e10, 1.0))
    quiet_floor = tuple(np.where(np.arange(1, chain.N) > chain.N / 2, 1.0, 1e-60) for chain in found.chains)
    assert fig4.line_claim(BETA, found).verdict == FAILS
    assert fig4.line_claim(BETA, replace(found, floors=quiet_floor)).verdict == HOLDS


@pytest.mark.parametrize("line", [ALPHA, BETA], ids=["alpha", "beta"])
def test_laws_are_unaltered_in_slope_alone(line):
    assert fig4.unaltered_claim(line).verdict == PARTLY
    assert fig4.unaltered_claim(replace(line, chains=line.chains[:1] * 2)).verdict == HOLDS
    other = replace(line, chains=(line.chains[0], line.chains[1].at(**({"alpha": "0.5"} if line is ALPHA else {"beta": "0.5"}))))
    assert fig4.unaltered_claim(other).verdict == FAILS


@pytest.mark.parametrize(("rate", "verdict"), [(8.0, HOLDS), (8.3, HOLDS), (8.5, PARTLY), (-1.0, FAILS)])
def test_slopes_go_with_the_logarithm_of_the_energy(rate, verdict):
    assert fig4.logarithm_claim("weak", (SimpleNamespace(rate=rate, error=0.1), -60.0, -58.0)).verdict == verdict


def test_the_width_of_the_condition_is_off_by_pi():
    for line in (ALPHA, BETA):
        claim = fig4.condition_claim(line)
        assert claim.verdict == PARTLY
        assert "3.142 times as much" in claim.ours
    chain = ALPHA.chains[-1]
    width = chain.N * float(chain.alpha) ** 0.5 * ALPHA.specific_energy**0.25
    assert fig4.condition_claim(ALPHA, lambda chain, eps: width).verdict == HOLDS
    assert fig4.condition_claim(ALPHA, lambda chain, eps: 100 * width).verdict == FAILS


def test_panels_show_what_lies_above_the_noise():
    found = profiles(ALPHA)
    floors = tuple(np.where(np.arange(1, chain.N) > chain.N / 2, 1.0, 1e-60) for chain in found.chains)
    made = fig4.spectra_panel(ALPHA, replace(found, floors=floors), random=True)
    assert made.name == "fig4a-random"
    assert [curve.label for curve in made.curves] == ["$N = 64$", "$N = 128$", "$N = 256$", "$N = 512$", "line of the caption"]
    assert all(curve.x.max() <= 0.5 for curve in made.curves)


def test_figure_4_over_a_short_time(monkeypatch, tmp_path):
    for name, value in {"TIME": 1e3, "RANDOM_TIME": 1e3, "REALISATIONS": 2, "SLOPE_TIME": 3e2}.items():
        monkeypatch.setattr(fig4, name, value)
    monkeypatch.setattr(torus_laws, "SIZES", dict.fromkeys(("alpha", "beta"), (64, 128, 192, 256)))
    figure = fig4.figure4(tmp_path, unheard)
    assert figure.text[1].count("| alpha |") == 3
    assert "2 draws" in figure.text[1]
    assert [panel.name for panel in figure.panels] == ["fig4a", "fig4b", "fig4a-random", "fig4b-random"]
    assert {claim.section for claim in figure.claims} == {"6.1.1", "6.1.2"}
    assert [claim.verdict for claim in figure.claims if "caption is the law" in claim.text] == [PARTLY, PARTLY]
    assert len([claim for claim in figure.claims if "log(energy)" in claim.text]) == 2
    assert ALPHA.fraction == Fraction(1, 8)
    assert f"{2} realisations" in figure.remarks[0]


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
    assert alpha.factors[0] == pytest.approx([15.98, 40.47, 48.65], rel=FOUR_DIGITS)
    assert beta.factors[1] == pytest.approx([2.684, 0.6279, 0.05283], rel=FOUR_DIGITS)
    assert alpha.steps[0] == pytest.approx([-0.2089, -0.2909, -0.2616], abs=FOUR_DIGITS)
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
