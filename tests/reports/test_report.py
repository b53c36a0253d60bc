"""Results as text: no digit is lost, and every number of a row is there."""

import csv
import json
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.files.writing import output_file, output_folder
from symfpu.paper.fig1 import Figure1
from symfpu.paper.pages import figure1_markdown, figure1_record, write_figure1_csv
from symfpu.reports.tables import markdown_table
from symfpu.reports.torus import assessment_text, torus_record
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.verdict import assess


@pytest.fixture(scope="module")
def torus():
    return solve_amplitudes(lindstedt(Chain(8, alpha="1/3", beta="0.1"), (1, 2), ("0.3905", "0.7663"), 4))


def test_a_record_survives_json_without_losing_a_digit(torus):
    record = json.loads(json.dumps(torus_record(torus)))
    assert {int(q): float(a) for q, a in record["amplitudes"].items()} == torus.amplitudes
    assert float(record["energy"]) == float(torus.energy())
    assert float(record["harmonic_energy"]) == torus.harmonic_energies().sum()
    assert float(record["average_harmonic_energy"]) == torus.average_spectrum().sum()
    assert {int(k): tuple(map(float, values)) for k, values in record["history"].items()} == torus.history
    assert (record["alpha"], record["beta"], record["seeds"]) == ("1/3", "0.1", [1, 2])
    assert record["residual"] == float(f"{torus.residual():.15g}")
    assert record["warnings"] == list(torus.warnings)
    assert len(record["smallest_divisors"]) == len(torus.series.smallest_divisors)


def test_markdown_table():
    assert markdown_table(["a", "b"], [["1", "2"]]) == "| a | b |\n| --- | --- |\n| 1 | 2 |"


def test_output_folder_is_made_with_its_parents(tmp_path):
    assert output_folder(tmp_path / "a" / "b").is_dir()
    assert output_folder(tmp_path / "a" / "b").is_dir()


def test_a_file_is_no_output_folder(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="output"):
        output_folder(tmp_path / "file")


def test_an_output_file_is_refused_before_anything_is_computed(tmp_path):
    assert output_file(tmp_path / "new") == tmp_path / "new"
    assert list(tmp_path.iterdir()) == []
    for path in (tmp_path, tmp_path / "none" / "new"):
        with pytest.raises(InputError, match="output"):
            output_file(path)


def test_the_evidence_has_a_line_for_some_orders(torus):
    """The best and the last order are among them, with the numbers of the assessment."""
    assessment = assess(torus.series, torus)
    *reasons, radii, head, zero, one, two, three, four = assessment_text(assessment).splitlines()
    assert reasons == [f"  {reason}" for reason in assessment.reasons]
    assert f"{assessment.radius:.3g} by ratio of terms" in radii
    assert head.split()[:3] == ["order", "A_1(k)", "dA(k)"]
    assert [line.split()[0] for line in (zero, one, two, three, four)] == list("01234")
    term = assessment.terms[4]
    assert f"{assessment.amplitudes[4][0]:.10g}" in four
    assert f" {assessment.residuals[4]:.1e} " in four
    assert f" {assessment.energy_errors[4]:.1e} " in four
    assert four.endswith(f"{term.size:.1e}: {term.mode}, ({','.join(map(str, term.harmonic))}), {term.divisor:.1e}")
    assert f"{max(assessment.differences[2]):.1e}" in two
    endless = assessment_text(replace(assessment, growth=0.0, pole_radius=float("inf")))
    assert "inf by ratio of terms, no pole by Pade poles" in endless


def test_the_evidence_of_a_long_series_is_short_and_has_its_best_order(torus):
    assessment = assess(torus.series, torus)
    values = np.full(243, 0.5)
    sums = dict.fromkeys((1, 2), (values, values))
    long = replace(assessment, order=242, best_order=157, residuals=values, energy_errors=values, sums=sums)
    orders = [line.split()[0] for line in assessment_text(long).splitlines()[len(assessment.reasons) + 2 :]]
    assert {"0", "157", "242"} <= set(orders)
    assert len(orders) < 15


def figure_of(torus):
    times = np.linspace(0.0, 3.0, 4)
    error = np.array([0.0, 1e-3, -2e-3, 0.1])
    return Figure1(
        torus=torus,
        assessment=replace(
            assess(torus.series, torus),
            word="asymptotic",
            best_order=4,
            differences={2: (0.125, 0.0625)},
            sums={1: (np.array([1.0, 0.5]), np.array([1.0, 0.25]))},
            residuals=np.array([1.0, 0.75, 0.5, 0.375, 0.25]),
        ),
        spectra={4: np.arange(1.0, 8.0)},
        times=times,
        errors={4: (error / 10, error), 24: (error / 100, error)},
        rounding=2.5e-13,
    )


def test_csv_files_hold_the_data_of_the_panels(torus, tmp_path):
    data = figure_of(torus)
    tables = {path.stem: list(csv.reader(path.read_text().splitlines())) for path in write_figure1_csv(data, tmp_path)}
    assert set(tables) == {"fig1a", "fig1b", "fig1c", "fig1d"}
    assert tables["fig1a"][1:] == [[str(q), str(float(q))] for q in range(1, 8)]
    assert tables["fig1b"] == [["k", "delta_A1", "delta_A2"], ["2", "0.125", "0.0625"]]
    assert tables["fig1c"][1:] == [["0", "1.0", "1.0"], ["1", "0.5", "0.25"]]
    assert [float(row[0]) for row in tables["fig1d"][1:]] == data.times.tolist()
    assert [float(row[2]) for row in tables["fig1d"][1:]] == data.errors[4][1].tolist()


def test_json_numbers_have_at_most_fifteen_digits(torus):
    """More digits are written as strings, so that no reader rounds them."""
    record = json.loads(json.dumps(torus_record(torus)))

    def numbers(value):
        if isinstance(value, dict | list):
            for inner in value.values() if isinstance(value, dict) else value:
                yield from numbers(inner)
        elif isinstance(value, float):
            yield value

    found = list(numbers(record))
    assert len(found) > 5
    assert all(float(f"{value:.15g}") == value for value in found)


def test_a_record_with_a_verdict_says_so(torus):
    assessment = assess(torus.series, torus)
    record = json.loads(json.dumps(torus_record(torus, assessment), allow_nan=False))
    assert record["verdict"] == assessment.headline
    assert record["assessment"] == json.loads(json.dumps(assessment.record()))
    plain = torus_record(torus)
    assert set(record) - set(plain) == {"verdict", "assessment"}
    assert record["certified"] is None


def test_a_record_of_many_digits_keeps_them():
    torus = solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (3,), ("1.1125",), 6, digits=30))
    record = json.loads(json.dumps(torus_record(torus)))
    assert (record["digits"], record["certified"]) == (30, True)
    assert record["guard_digits"] == torus.series.guard_digits
    with mpmath.workdps(45):
        for text, number in ((record["amplitudes"]["3"], torus.amplitudes[3]), (record["energy"], torus.energy())):
            assert abs(mpmath.mpf(text) / number - 1) < mpmath.mpf(10) ** -29
            assert abs(mpmath.mpf(text) / number - 1) > 0


def test_figure_1_reads_its_evidence_from_the_verdict(torus):
    """The class keeps no second copy of residuals, sums and differences."""
    data = figure_of(torus)
    assert data.residuals == {2: 0.5, 3: 0.375, 4: 0.25}
    assert data.best_order == 4
    assert data.differences == {2: (0.125, 0.0625)}
    assert [s.tolist() for s in data.sums] == [[1.0, 0.5], [1.0, 0.25]]


def test_the_page_on_fig_1_has_claims_verdict_and_pictures(torus, monkeypatch):
    monkeypatch.setattr("symfpu.paper.fig1.FIG1_CANCELLATION_ORDER", 1)
    data = figure_of(torus)
    page, record = figure1_markdown(data), figure1_record(data)
    assert "| energy error | about 1e-4 | 1.0e-02 at order 4, 1.0e-03 at order 24 |" in page
    assert "| cancellation | four orders of magnitude at k = 14 | 0.3 orders of magnitude at k = 1 |" in page
    assert "by coordinate order: 2: 5.0e-01, 4: 2.5e-01." in page
    assert "The least is at order 4." in page
    assert "Verdict on the series: asymptotic, best at order 4 (residual" in page
    assert "the same to 2.5e-13" in page
    assert all(page.count(f"![Fig. 1({panel})](fig1{panel}.png)") == 1 for panel in "abcd")
    assert (record["best_order"], record["rounding_of_doubles"], record["digits"]) == (4, 2.5e-13, None)
    assert record["claims"]["energy_error"]["computed"] == "1.0e-02 at order 4, 1.0e-03 at order 24"
    assert record["assessment"]["verdict"] == "asymptotic, best at order 4"
