"""What Toda teaches: the statements of docs/toda.md, single ones at reduced size; the whole study behind `long`."""

import json
from functools import partial

import numpy as np
import pytest

import symfpu
from symfpu import Chain, toda, toda_torus
from symfpu.paper import toda_fig1, toda_orbits
from symfpu.paper.claims_page import figure_markdown, figure_record
from symfpu.paper.convergence_fig9 import series_end
from symfpu.paper.printed import FIG9_BREATHER, TWO_TORUS
from symfpu.paper.toda import toda_page
from symfpu.paper.toda_fig1 import (
    SCANS,
    _pole_of,
    _residue,
    chains_of,
    detuning,
    refined_two_torus,
    resonance_scan,
    resonant_coefficient,
    series_study,
    toda_resonance,
)
from symfpu.paper.toda_orbits import trajectory_study
from symfpu.paper.toda_tori import excited_groups, gap_energies, group_study, torus_study, vanishing_terms
from tests.tolerances import (
    CLOSED_GAP_OF_A_TORUS,
    DRIFT_OF_TODA,
    FIVE_DIGITS,
    FOUR_DIGITS,
    NO_RESIDUE,
    RECURRENCE_TIME,
    ROUNDING,
    SAME_TAIL,
    SCAN_FIT,
    SERIES_END,
    SIX_PLACES,
    SMOOTH_SCAN,
    TERM_RATIO,
)

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together

RATIOS = {"alpha": 1.494248, "alpha and beta": -2.106769, "Toda": -2.104606}  # of terms two orders apart
TODA_ENERGY = 0.0202615057699360800  # of the torus of Fig. 1's frequencies, by the spectral curve
RETURNS = {"alpha": 12172.356, "alpha and beta": 12171.333, "Toda": 12171.303}  # of energies every 0.2, kahan_li8, step 0.1
TODA_END = 1.2731275  # amplitude at which the series of Toda's breather ends


@pytest.fixture(scope="module")
def chains():
    return chains_of(TWO_TORUS.chain)


@pytest.fixture(scope="module")
def torus(chains):
    return refined_two_torus(chains["Toda"], TWO_TORUS.frequencies[1])


def test_chains_of_the_same_cubic_term(chains):
    coefficients = [[chain.potential.coefficient(n) for n in (3, 4)] for chain in chains.values()]
    (c3, c4), both, integrable = coefficients
    assert c4 == 0
    assert both == integrable == [c3, 2 * c3**2 / 3]


@pytest.mark.parametrize("name", RATIOS)
def test_the_series_of_every_chain_has_its_pole(chains, name):
    study = series_study(chains[name], 24)
    assert study.ratios[24] == pytest.approx(RATIOS[name], rel=20 * TERM_RATIO)
    assert 1 / study.pole == pytest.approx(RATIOS[name], rel=TERM_RATIO)
    assert study.assessment.best_order < 14


def test_the_torus_of_toda_exists_although_its_series_diverges(torus):
    assert float(torus.energy()) == pytest.approx(TODA_ENERGY, rel=10 * ROUNDING)


def test_toda_s_torus_passes_its_resonance(chains):
    """On both sides of it the detuning changes its sign, and the coefficient hardly changes."""
    second = ("0.390472", "0.390474")
    below, above = (detuning(chains["Toda"], omega) for omega in second)
    assert below > 0 > above
    lower, upper = (resonant_coefficient(refined_two_torus(chains["Toda"], omega)) for omega in second)
    assert upper == pytest.approx(lower, rel=SMOOTH_SCAN)


def test_alpha_s_torus_is_torn_at_its_resonance(chains):
    lower, upper = (resonant_coefficient(refined_two_torus(chains["alpha"], omega)) for omega in ("0.390450", "0.390453"))
    assert lower < 0
    assert upper > -20 * lower


@pytest.mark.parametrize(("pole", "residue"), [(0.3904515, 3e-11), (0.390472, -5e-12)])
def test_a_pole_with_a_smooth_background_is_found(pole, residue):
    omega = pole + 1e-6 * np.array([-12.0, -7.0, -4.0, -2.0, 1.5, 3.0, 6.0, 11.0])
    x = omega - pole
    coefficients = residue / x + 1e-5 + 0.3 * x
    found = _pole_of(omega, coefficients)
    assert found - pole == pytest.approx(0, abs=SCAN_FIT)
    assert _residue(omega, coefficients, found) == pytest.approx(residue, rel=FOUR_DIGITS)


def test_scans_have_both_sides_of_every_resonance(chains):
    for name, omega in (("alpha", 0.390451579), ("alpha and beta", 0.390472711), ("Toda", 0.390472732)):
        sides = [float(second) > omega for second in SCANS[name]]
        assert 4 <= sum(sides) <= len(sides) - 4


def test_excited_groups_are_found():
    """Seed 1 of five bonds: its products at every order."""
    assert excited_groups(Chain(5, alpha=1), (1,), 3) == [(1,), (2,), (3,), (4,)]
    assert excited_groups(Chain(5, beta=1), (1,), 2) == [(1,), (3,), ()]


@pytest.mark.parametrize(("N", "seeds"), [(5, (1,)), (6, (2, 3)), (8, (1, 6))])
def test_groups_of_toda_are_those_of_alpha(N, seeds):
    assert excited_groups(Chain(N, potential=toda(1)), seeds, 3) == excited_groups(Chain(N, alpha=1), seeds, 3)


def test_the_series_of_toda_s_breather_ends_before_it():
    (omega,) = FIG9_BREATHER.frequencies
    chain = Chain(FIG9_BREATHER.chain.N, potential=toda(FIG9_BREATHER.chain.alpha))
    end, reached = series_end(chain, 1, omega)
    orbit = symfpu.torus(chain, (1,), frequencies=(omega,))
    assert end == pytest.approx(TODA_END, abs=SERIES_END)
    assert reached < float(omega)
    assert orbit.amplitude < end
    exact = toda_torus(chain, (1,), frequencies=(omega,), digits=15)
    assert float(orbit.energy()) == pytest.approx(float(exact.energy), rel=100 * ROUNDING)


def test_gaps_drift_in_alpha_and_not_in_toda():
    chains = chains_of(FIG9_BREATHER.chain)
    alpha, exact = (trajectory_study(name, chains[name], T=1e3) for name in ("alpha", "Toda"))
    assert exact.drift().max() < DRIFT_OF_TODA
    assert (alpha.drift()[:12] > 100 * DRIFT_OF_TODA).all()
    assert (alpha.drift()[:4] / alpha.gaps[0, :4]).max() < 1.3e-4  # the largest to t = 1e5


def test_tails_are_toda_s_and_open_gaps_alpha_s():
    study = torus_study(TWO_TORUS)
    tori = study.tori()
    assert tori["Toda, same amplitudes"].amplitudes == pytest.approx(study.alpha.amplitudes, abs=ROUNDING)
    ours, theirs = (np.asarray(t.average_spectrum() / t.energy(), dtype=float)[2:13] for t in (study.alpha, study.same_amplitudes))
    assert np.abs(np.log10(ours / theirs)).max() < SAME_TAIL
    for name in ("Toda, same frequencies", "Toda, same amplitudes"):
        assert study.gaps[name][:, 2:].max() < CLOSED_GAP_OF_A_TORUS
    energies = gap_energies(study.alpha, study.gaps["alpha"].max(axis=0))
    assert (energies[2:10] < theirs[:8] / 20).all()
    assert energies[13] > 50 * study.same_amplitudes.average_spectrum()[13] / study.same_amplitudes.energy()
    assert study.exact_energy == pytest.approx(TODA_ENERGY, rel=ROUNDING)


def test_all_groups_are_alike_and_cross_terms_are_alpha_s():
    study = group_study()
    assert (study.cases, study.differing) == (83, ())
    assert vanishing_terms() == (184, 0)
    assert study.cross_terms["Toda"] == pytest.approx(0, abs=ROUNDING)
    assert study.cross_terms["alpha"] == pytest.approx(0.278803, rel=FIVE_DIGITS)


@pytest.fixture(scope="module")
def scans(chains):
    known = {"alpha": None, "alpha and beta": None, "Toda": toda_resonance(chains["Toda"])}
    return {name: resonance_scan(chain, SCANS[name], known[name]) for name, chain in chains.items()}


def test_residues_at_the_resonance(scans):
    alpha, both, exact = scans["alpha"], scans["alpha and beta"], scans["Toda"]
    assert alpha.residue > -4 * both.residue > 0
    assert abs(exact.residue) < NO_RESIDUE * alpha.residue
    assert both.resonance == pytest.approx(exact.resonance, rel=SIX_PLACES)


def test_reproduce_toda(scans, tmp_path, monkeypatch):
    """The scans of the test above, orbits as long as the recurrence, two of the breathers."""
    monkeypatch.setattr(toda_fig1, "_scan", lambda name, chain, progress: scans[name])
    monkeypatch.setattr(toda_orbits, "trajectory_study", partial(trajectory_study, T=1e3))
    monkeypatch.setattr(toda_orbits, "RECURRENCE_TIME", 1.25e4)
    monkeypatch.setattr(toda_orbits, "RECURRENCE_LOOKS", 25001)
    monkeypatch.setattr(toda_orbits, "BREATHER_FREQUENCIES", toda_orbits.BREATHER_FREQUENCIES[-2:])
    labels = set()
    figure = toda_page(tmp_path, lambda label, fraction: labels.add(label))
    assert len(labels) >= 10
    assert [panel.name for panel in figure.panels] == [f"toda-{letter}" for letter in "abcdefghi"]
    record = json.loads(json.dumps(figure_record(figure), allow_nan=False))["numbers"]
    for name, time in RETURNS.items():
        assert record["returns"][name][0] == pytest.approx(time, abs=RECURRENCE_TIME)
    assert record["series_ends"]["Toda"] == pytest.approx(TODA_END, abs=SERIES_END)
    page = figure_markdown(figure)
    assert "| Toda | 12171.30 | 98.5143 % |" in page
    assert page.count("](toda-") == 9
