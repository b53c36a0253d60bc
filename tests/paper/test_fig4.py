"""Fig. 4: verdicts on profiles made by hand, and the whole figure over a short time."""

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu.files.progress import unheard
from symfpu.localization.trials import ProfileInvariance
from symfpu.paper import fig4, torus_laws
from symfpu.paper.captions import caption_curve, printed_line
from symfpu.paper.claims import FAILS, HOLDS, PARTLY

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


def test_the_width_of_the_condition_is_off_by_pi(monkeypatch):
    for line in (ALPHA, BETA):
        claim = fig4.condition_claim(line)
        assert claim.verdict == PARTLY
        assert "3.142 times as much" in claim.ours
    chain = ALPHA.chains[-1]
    width = chain.N * float(chain.alpha) ** 0.5 * ALPHA.specific_energy**0.25
    monkeypatch.setattr(fig4, "least_packet", lambda chain, eps: width)
    assert fig4.condition_claim(ALPHA).verdict == HOLDS
    monkeypatch.setattr(fig4, "least_packet", lambda chain, eps: 100 * width)
    assert fig4.condition_claim(ALPHA).verdict == FAILS


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
