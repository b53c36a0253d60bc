"""The command line: JSON, exit codes, one line for each kind of bad input, help with examples, files written."""

import json
from shlex import split

import mpmath
import pytest

from symfpu import Chain, lindstedt, solve_amplitudes
from symfpu.paper.printed import APPENDIX_F
from tests.cli.running import answer, run, shown
from tests.reference import TWO_TORUS as REFERENCE
from tests.tolerances import AMPLITUDE, SERIES_RESIDUAL

SOLVE = split("solve -N 16 --alpha 0.33 --seeds 1,2 --omega 0.19626,0.39046 --order 12")
BREATHER = split("solve -N 32 --alpha 0.33 --seeds 25 --omega 1.8830741847088537 --order 8")


def test_propagate_prints_the_sequence(capsys):
    out = shown(capsys, *split("propagate -N 32 --seeds 3,5 --order 2"))
    assert out.splitlines() == ["D_0 = {3, 5}", "D_1 = {2, 6, 8, 10}", "D_2 = {1, 7, 9, 11, 13, 15}"]


def test_solve_json_has_the_fixed_keys_and_the_reference_amplitudes(capsys):
    record = answer(capsys, *SOLVE)
    assert {"amplitudes", "order", "frequency_order", "residual", "energy", "harmonic_energy", "warnings"} <= set(record)
    assert (record["order"], record["frequency_order"]) == (12, 12)
    for q, expected in zip(("1", "2"), REFERENCE.amplitudes[12], strict=True):
        assert isinstance(record["amplitudes"][q], str)
        assert float(record["amplitudes"][q]) == pytest.approx(float(expected), rel=AMPLITUDE)
    assert isinstance(record["energy"], str)
    assert record["frequencies"] == {"1": "0.19626", "2": "0.39046"}


def test_frequency_order_is_its_own_option(capsys):
    record = answer(capsys, *SOLVE, "--frequency-order", "4")
    assert (record["order"], record["frequency_order"]) == (12, 4)
    assert float(record["amplitudes"]["1"]) == pytest.approx(float(REFERENCE.amplitudes[4][0]), rel=AMPLITUDE)


@pytest.mark.long
def test_solve_with_digits_is_certified_and_judged(capsys):
    record = answer(capsys, *BREATHER, "--digits", "30")
    assert (record["digits"], record["certified"], record["verdict"]) == (30, True, "converged")
    text = record["amplitudes"]["25"]
    series = lindstedt(Chain(32, alpha="0.33"), (25,), ("1.8830741847088537",), 8, digits=40)
    with mpmath.workdps(50):
        assert mpmath.nstr(solve_amplitudes(series).amplitudes[25], 30) == text
    assert record["assessment"]["verdict"] == "converged"
    assert len(record["assessment"]["residuals"]) == 9
    assert record["assessment"]["residuals"][-1] < SERIES_RESIDUAL
    assert record["residual"] < SERIES_RESIDUAL


def test_coordinates_are_cut_at_their_own_order(capsys):
    """The amplitudes are those of the whole series, the residual that of the shorter coordinates."""
    whole, cut = (answer(capsys, *SOLVE, *order) for order in ([], ["--coordinate-order", "6"]))
    assert (cut["order"], cut["frequency_order"]) == (6, 12)
    assert cut["amplitudes"] == whole["amplitudes"]
    assert cut["assessment"]["residuals"] == whole["assessment"]["residuals"][:7]
    assert cut["residual"] > whole["residual"]


def test_show_json_is_the_record_of_solve(capsys, tmp_path):
    file = str(tmp_path / "torus.symfpu")
    solved = answer(capsys, *BREATHER, "--output", file)
    shown = answer(capsys, "show", file)
    assert {key: shown[key] for key in solved if key != "verdict"} == {key: solved[key] for key in solved if key != "verdict"}
    assert shown["assessment"]["verdict"] == solved["verdict"]
    assert set(shown) - set(solved) == {"provenance", "test_vectors"}
    assert shown["provenance"]["command"].startswith("symfpu ")
    assert len(shown["test_vectors"]) > 0


def small_rows(monkeypatch):
    """Two cheap rows in place of the paper's nine: one that is met at order 22, and a breather that is met nowhere; the first is
    one of those that only --full refines."""
    monkeypatch.setattr("symfpu.paper.table.APPENDIX_F", tuple(row for row in APPENDIX_F if row.label == "Fig. 8"))
    monkeypatch.setattr("symfpu.paper.corrected.HEAVY_ROWS", {"Fig. 1": ((1e-8, 1e-9), 4)})


@pytest.mark.long
def test_reproduce_full_refines_every_row(capsys, monkeypatch, tmp_path):
    small_rows(monkeypatch)
    monkeypatch.setattr("symfpu.paper.table_page.SCALED_ROWS", ("Fig. 8",))
    monkeypatch.setattr("symfpu.paper.series_errors.HALVINGS", 1)
    assert run(capsys, "reproduce", "table", "--full", "-o", str(tmp_path))[0] == 0
    rows = json.loads((tmp_path / "report.json").read_text())["figures"]["table"]["numbers"]
    assert [row["corrected"]["refined"] for row in rows] == [True, True]
    assert rows[0]["corrected"]["exponents_of_mu"] is None
    assert list(rows[1]["corrected"]["exponents_of_mu"]) == ["1", "2", "3", "4"]
    assert (tmp_path / "corrected-c.png").is_file()
