"""Rows of the table and Fig. 1: what counts as met, which order is chosen, what the verdict says."""

import json
from fractions import Fraction

import numpy as np
import pytest

from symfpu import Chain
from symfpu.cli.main import main
from symfpu.paper.fig1_data import figure1_data
from symfpu.paper.printed import APPENDIX_F, FIG1_DIGITS, TWO_TORUS, PrintedTorus
from symfpu.paper.table import MET_DIGITS, agreement_digits, amplitude_row, energies, rounds_to
from tests.reference import BETA_BREATHER
from tests.reference import TWO_TORUS as REFERENCE
from tests.tolerances import AMPLITUDE, ROUNDING, THOUSAND_ROUNDINGS, WHOLE_NUMBERS


def printed(amplitude, energy="1", order=12):
    return PrintedTorus(
        label="test",
        printed_label="test",
        chain=Chain(18, beta="0.6"),
        seeds=BETA_BREATHER.seeds,
        frequencies=BETA_BREATHER.frequencies,
        order=order,
        amplitudes=(amplitude,),
        energy=energy,
        energy_source="test",
    )


@pytest.mark.parametrize(
    ("ours", "theirs", "digits"), [((1.001, 2.0), ("1", "2"), 3.0), ((1.0, 2.0002), ("1", "2"), 4.0), ((0.5,), ("0.5",), 16.0)]
)
def test_agreement_is_that_of_the_worst_amplitude(ours, theirs, digits):
    assert agreement_digits(ours, theirs) == pytest.approx(digits, abs=WHOLE_NUMBERS)


@pytest.mark.parametrize(
    ("ours", "text", "rounds"),
    [
        (0.02345, "0.02345", True),
        (0.0234549, "0.02345", True),
        (0.0234551, "0.02345", False),
        (7.634694e-5, "7.63469e-5", True),
        (1.4, "1", True),
        (1.6, "1", False),
    ],
)
def test_a_number_rounds_to_its_printed_digits(ours, text, rounds):
    assert rounds_to(ours, text) is rounds


def test_a_row_met_at_one_order_names_it():
    row = amplitude_row(printed(BETA_BREATHER.amplitudes[6][0][:16]))
    assert row.best == 6
    assert 6 in row.met
    assert row.torus.origin.frequency_order == 6
    assert row.torus.origin.order == 12
    assert f"met at frequency order 6 to {row.digits[6]:.1f} digits" in row.verdict


def test_a_row_met_nowhere_is_unexplained():
    row = amplitude_row(printed("0.5157" + "9"))
    assert row.met == ()
    assert row.torus.origin.frequency_order == 12
    assert "met at no frequency order" in row.verdict
    assert "unexplained" in row.verdict
    assert max(row.digits.values()) < MET_DIGITS


def test_energies_are_total_harmonic_and_average():
    row = amplitude_row(printed("0.51578"))
    values = energies(row.torus)
    assert values["H(0)"] == float(row.torus.energy())
    assert values["harmonic energy at t = 0"] == row.torus.harmonic_energies().sum()
    assert values["harmonic energy, time average"] == row.torus.average_spectrum().sum()
    assert row.energy_matches == ()


def test_a_printed_energy_is_named():
    unknown = amplitude_row(printed("0.51578"))
    total = f"{unknown.energies['H(0)']:.8f}"
    row = amplitude_row(printed("0.51578", energy=total))
    assert "H(0)" in row.energy_matches
    assert "printed E is H(0)" in row.verdict


def test_an_energy_of_another_order_is_found():
    row = amplitude_row(printed("0.51578"))
    first = float(row.torus.origin.cut_at(1).torus(row.torus.phases).energy())
    again = amplitude_row(printed("0.51578", energy=f"{first:.12f}"))
    assert again.energy_orders["H(0)"] == (1,)
    assert "coordinate orders 1" in again.verdict


def test_printed_data_are_consistent():
    for row in (TWO_TORUS, *APPENDIX_F):
        assert len(row.seeds) == len(row.frequencies) == len(row.amplitudes)
        linear = row.chain.frequencies()[np.array(row.seeds) - 1]
        assert np.abs(np.array([float(w) for w in row.frequencies]) / linear - 1).max() < 0.01


@pytest.fixture(scope="module")
def computed():
    """Fig. 1 and the labels of its steps."""
    labels = []
    return figure1_data(lambda label, fraction: labels.append(label)), labels


@pytest.mark.long
def test_figure_1_is_computed_from_the_printed_frequencies(computed):
    data, labels = computed
    assert data.torus.origin.series.frequencies == tuple(Fraction(w) for w in REFERENCE.frequencies)
    assert labels[0].startswith("fig1")
    assert data.residuals[data.best_order] == min(data.residuals.values())
    assert data.assessment.verdict == "asymptotic, best at order 12"
    assert tuple(data.residuals) == tuple(range(2, 31))
    assert data.torus.digits == FIG1_DIGITS
    assert 0 < data.rounding < AMPLITUDE
    assert all(spectrum.shape == (15,) for spectrum in data.spectra.values())
    assert set(data.spectra) == set(data.errors) == {data.best_order, 24}
    for total, harmonic in data.errors.values():
        assert total.shape == harmonic.shape == data.times.shape
        assert max(abs(total[0]), abs(harmonic[0])) < ROUNDING  # one time and many are summed in another order
        assert np.abs(total).max() < np.abs(harmonic).max()
    assert data.sums[0].shape == (31,)
    assert (data.sums[0] >= data.sums[1] * (1 - THOUSAND_ROUNDINGS)).all()


@pytest.mark.long
def test_reproduce_fig1_writes_pictures_data_and_claims(computed, monkeypatch, capsys, tmp_path):
    """The alignment indices end at 1e3, before they confirm what is foretold; the evidence says so."""
    monkeypatch.setattr("symfpu.paper.fig1.figure1_data", lambda step: computed[0])
    monkeypatch.setattr("symfpu.paper.dimensions.TIME", 1e3)
    assert main(["reproduce", "fig1", "-o", str(tmp_path), "--json"]) == 0
    out = capsys.readouterr().out
    expected = {f"fig1{panel}.{suffix}" for panel in "abcde" for suffix in ("png", "pdf", "csv")}
    assert {path.name for path in tmp_path.iterdir()} == expected | {"report.md", "report.json"}
    assert all((tmp_path / name).stat().st_size > 500 for name in expected if not name.endswith("csv"))
    record = json.loads(out)
    assert record == json.loads((tmp_path / "report.json").read_text())
    figure = record["figures"]["fig1"]
    assert set(figure["numbers"]["claims"]) == {"best_difference", "cancellation", "term_size", "harmonic_error", "energy_error"}
    claims = {claim["text"].split(",")[0]: claim for claim in figure["claims"]}
    assert len(claims) == 11
    assert claims["cancellations by four orders of magnitude at k = 14"]["verdict"] == "holds"
    assert claims["the energies E_q fall exponentially with q"]["verdict"] == "holds"
    assert claims["up to k = 24 the behaviour of the series appears as convergent"]["verdict"] == "does not hold"
    assert "the printed digits at order 22, 26" in claims["the amplitudes of order 24 are A_1 = 0.5848897"]["ours"]
    dimension = claims["G_2 stays constant to 1e9"]
    assert dimension["verdict"] == "holds"
    assert "to t = 1e+03" in dimension["ours"]
    assert "slopes are not those foretold" in dimension["ours"]
