"""The page, the record and the data files of Fig. 1, from data made by hand."""

import csv
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu import Chain, assess, lindstedt, solve_amplitudes
from symfpu.paper.claims_page import write_panel_csv
from symfpu.paper.fig1 import figure1_numbers, figure1_panels, figure1_text
from symfpu.paper.fig1_data import Figure1
from tests.tolerances import LAST_DIGIT


@pytest.fixture(scope="module")
def torus():
    return solve_amplitudes(lindstedt(Chain(8, alpha="1/3", beta="0.1"), (1, 2), ("0.3905", "0.7663"), 4))


def figure_of(torus):
    times = np.linspace(0.0, 3.0, 4)
    error = np.array([0.0, 1e-3, -2e-3, 0.1])
    return Figure1(
        torus=torus,
        assessment=replace(
            assess(torus.origin.series, torus),
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
    paths = write_panel_csv(SimpleNamespace(panels=figure1_panels(data)), tmp_path)
    tables = {path.stem: list(csv.reader(path.read_text().splitlines())) for path in paths}
    assert set(tables) == {"fig1a", "fig1b", "fig1c", "fig1d"}
    assert tables["fig1a"][1:] == [[str(q), str(float(q))] for q in range(1, 8)]
    assert tables["fig1b"] == [["k", "delta_A1", "delta_A2"], ["2", "0.125", "0.0625"]]
    assert tables["fig1c"][1:] == [["0", "1.0", "1.0"], ["1", "0.5", "0.25"]]
    assert [float(row[0]) for row in tables["fig1d"][1:]] == data.times.tolist()
    assert [float(row[2]) for row in tables["fig1d"][1:]] == data.errors[4][1].tolist()


def test_figure_1_reads_its_evidence_from_the_verdict(torus):
    """The class keeps no second copy of residuals, sums and differences."""
    data = figure_of(torus)
    assert data.residuals == {2: 0.5, 3: 0.375, 4: 0.25}
    assert data.best_order == 4
    assert data.differences == {2: (0.125, 0.0625)}
    assert [s.tolist() for s in data.sums] == [[1.0, 0.5], [1.0, 0.25]]


def test_page_and_record_have_the_claims_as_computed(torus, monkeypatch):
    monkeypatch.setattr("symfpu.paper.fig1_data.FIG1_CANCELLATION_ORDER", 1)
    data = figure_of(torus)
    page, record = "\n".join(figure1_text(data)), figure1_numbers(data)
    assert all(claim["computed"] in page for claim in record["claims"].values())
    assert (record["best_order"], record["rounding_of_doubles"], record["digits"]) == (4, 2.5e-13, None)
    assert record["claims"]["energy_error"]["computed"] == "1.0e-02 at order 4, 1.0e-03 at order 24"
    assert record["assessment"]["verdict"] == "asymptotic, best at order 4"


def test_errors_in_time_are_drawn_as_moduli_after_the_start(torus):
    data = figure_of(torus)
    *_, panel = figure1_panels(data)
    harmonic, total = panel.curves[:2]
    assert harmonic.y.tolist() == [1e-3, 2e-3, 0.1]
    assert total.y.tolist() == pytest.approx([1e-4, 2e-4, 1e-2], rel=LAST_DIGIT)
    assert all(min(curve.x) > 0 for curve in panel.curves)
    assert [curve.group for curve in panel.curves] == [0, 0, 1, 1]
