"""The command line: JSON, exit codes, one line for each kind of bad input, help with examples, files written."""

import json
import subprocess
import sys

import mpmath
import pytest

from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from tests.reference import TWO_TORUS as REFERENCE
from tests.tolerances import AMPLITUDE, SERIES_RESIDUAL

SOLVE = {"-N": "16", "--alpha": "0.33", "--seeds": "1,2", "--omega": "0.19626,0.39046", "--order": "12"}
PROPAGATE = {"-N": "32", "--seeds": "3,5", "--order": "2"}


def arguments(verb, options, **changes):
    merged = options | {("-N" if name == "N" else "--" + name.replace("_", "-")): value for name, value in changes.items()}
    return [verb, *(part for name, value in merged.items() if value is not None for part in (name, value))]


def run(capsys, *argv):
    code = main(list(argv))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_propagate_prints_the_sequence(capsys):
    code, out, err = run(capsys, *arguments("propagate", PROPAGATE))
    assert (code, err) == (0, "")
    assert out.splitlines() == ["D_0 = {3, 5}", "D_1 = {2, 6, 8, 10}", "D_2 = {1, 7, 9, 11, 13, 15}"]


def test_propagate_json(capsys):
    code, out, err = run(capsys, *arguments("propagate", PROPAGATE, model="beta"), "--json")
    record = json.loads(out)
    assert (code, err) == (0, "")
    assert record["excitation_sequence"][0] == [3, 5]
    assert record["excitation_sequence"][1] == [1, 7, 9, 11, 13, 15]
    assert (record["N"], record["model"], record["seeds"], record["order"]) == (32, "beta", [3, 5], 2)


def test_solve_json_has_the_fixed_keys_and_the_reference_amplitudes(capsys):
    code, out, err = run(capsys, *arguments("solve", SOLVE), "--json")
    record = json.loads(out)
    assert (code, err) == (0, "")
    assert {"amplitudes", "order", "frequency_order", "residual", "energy", "harmonic_energy", "warnings"} <= set(record)
    assert (record["order"], record["frequency_order"]) == (12, 12)
    for q, expected in zip(("1", "2"), REFERENCE.amplitudes[12], strict=True):
        assert isinstance(record["amplitudes"][q], str)
        assert float(record["amplitudes"][q]) == pytest.approx(float(expected), rel=AMPLITUDE)
    assert isinstance(record["energy"], str)
    assert record["frequencies"] == {"1": "0.19626", "2": "0.39046"}


def test_frequency_order_is_its_own_option(capsys):
    _, out, _ = run(capsys, *arguments("solve", SOLVE, frequency_order="4"), "--json")
    record = json.loads(out)
    assert (record["order"], record["frequency_order"]) == (12, 4)
    assert float(record["amplitudes"]["1"]) == pytest.approx(float(REFERENCE.amplitudes[4][0]), rel=AMPLITUDE)


BREATHER = {"-N": "32", "--alpha": "0.33", "--seeds": "25", "--omega": "1.8830741847088537", "--order": "8"}


@pytest.mark.long
def test_solve_with_digits_is_certified_and_judged(capsys):
    code, out, err = run(capsys, *arguments("solve", BREATHER, digits="30"), "--json")
    record = json.loads(out)
    assert (code, err) == (0, "")
    assert (record["digits"], record["certified"], record["verdict"]) == (30, True, "converged")
    text = record["amplitudes"]["25"]
    series = lindstedt(Chain(32, alpha="0.33"), (25,), ("1.8830741847088537",), 8, digits=40)
    with mpmath.workdps(50):
        assert mpmath.nstr(solve_amplitudes(series).amplitudes[25], 30) == text
    assert record["assessment"]["verdict"] == "converged"
    assert len(record["assessment"]["residuals"]) == 9
    assert record["assessment"]["residuals"][-1] < SERIES_RESIDUAL
    assert record["residual"] < SERIES_RESIDUAL


@pytest.mark.long
def test_solve_prints_the_verdict_first_and_its_evidence_last(capsys):
    code, out, err = run(capsys, *arguments("solve", BREATHER, digits="30"))
    lines = out.splitlines()
    assert (code, err) == (0, "")
    assert lines[0] == "verdict: converged"
    assert any(line.startswith("exactly one root within") and line.endswith("certified") for line in lines)
    evidence = next(i for i, line in enumerate(lines) if line.startswith("  residual of the equations of motion"))
    assert all(line.startswith("  ") for line in lines[evidence:])
    assert lines[-10].split()[:2] == ["order", "A_25(k)"]
    assert [line.split()[0] for line in lines[-9:]] == [str(k) for k in range(9)]
    _, out, _ = run(capsys, *arguments("solve", SOLVE, order="16"))
    assert out.startswith("verdict: asymptotic, best at order 12\n")


def test_coordinates_are_cut_at_their_own_order(capsys):
    """The amplitudes are those of the whole series, the residual that of the shorter coordinates."""
    _, whole, _ = run(capsys, *arguments("solve", SOLVE), "--json")
    code, cut, err = run(capsys, *arguments("solve", SOLVE, coordinate_order="6"), "--json")
    whole, cut = json.loads(whole), json.loads(cut)
    assert (code, err) == (0, "")
    assert (cut["order"], cut["frequency_order"]) == (6, 12)
    assert cut["amplitudes"] == whole["amplitudes"]
    assert cut["assessment"]["residuals"] == whole["assessment"]["residuals"][:7]
    assert cut["residual"] > whole["residual"]


@pytest.mark.parametrize("digits", [None, "30"])
def test_show_prints_what_solve_has_written(capsys, tmp_path, digits):
    file = str(tmp_path / "a torus.symfpu")
    solve = arguments("solve", BREATHER, digits=digits, output=file, coordinate_order="5")
    code, out, _ = run(capsys, *solve)
    assert code == 0
    assert out.splitlines()[-1] == f"written: {file}"
    code, shown, err = run(capsys, "show", file)
    assert (code, err) == (0, "")
    assert shown.splitlines()[0] == out.splitlines()[0] == "verdict: converged"
    torus = [line for line in out.splitlines()[:-1] if not line.startswith("  ")]
    assert shown.splitlines()[: len(torus)] == torus
    assert any(line.startswith("created") for line in shown.splitlines())


def test_show_json_is_the_record_of_solve(capsys, tmp_path):
    file = str(tmp_path / "torus.symfpu")
    _, out, _ = run(capsys, *arguments("solve", BREATHER, output=file), "--json")
    solved = json.loads(out)
    code, out, err = run(capsys, "show", file, "--json")
    shown = json.loads(out)
    assert (code, err) == (0, "")
    assert {key: shown[key] for key in solved if key != "verdict"} == {key: solved[key] for key in solved if key != "verdict"}
    assert shown["assessment"]["verdict"] == solved["verdict"]
    assert set(shown) - set(solved) == {"provenance", "test_vectors"}
    assert shown["provenance"]["command"].startswith("symfpu ")
    assert len(shown["test_vectors"]) > 0


FOREIGN = {"empty": b"", "text": b"hello\n", "json": b'{"amplitudes": {}}', "zip": b"PK\x03\x04 no archive"}


@pytest.mark.parametrize("content", FOREIGN.values(), ids=FOREIGN)
def test_a_foreign_file_is_one_line_and_no_traceback(capsys, tmp_path, content):
    file = tmp_path / "foreign"
    file.write_bytes(content)
    for options in ([], ["--json"]):
        code, out, err = run(capsys, "show", str(file), *options)
        assert (code, out) == (2, "")
        assert len(err.splitlines()) == 1
        assert "foreign" in err
        assert "Traceback" not in err


def test_an_output_file_that_cannot_be_written_is_bad_input(capsys, tmp_path):
    code, out, err = run(capsys, *arguments("solve", BREATHER, output=str(tmp_path / "none" / "torus.symfpu")))
    assert (code, out) == (2, "")
    assert len(err.splitlines()) == 1
    assert "torus.symfpu" in err


def test_solve_prints_numbers_and_warnings(capsys):
    code, out, err = run(capsys, *arguments("solve", SOLVE, frequency_order="4"))
    assert code == 0
    assert "0.598073740743" in out
    assert "frequency order 4, coordinate order 12" in out
    assert "energy H" in out
    assert "differ by" in err
    assert "differ by" not in out


BAD_INPUT = {
    "N below 2": (arguments("propagate", PROPAGATE, N="1"), "N"),
    "N no number": (arguments("propagate", PROPAGATE, N="x"), "N"),
    "no seeds": (arguments("propagate", PROPAGATE, seeds=""), "seeds"),
    "repeated seeds": (arguments("propagate", PROPAGATE, seeds="3,3"), "seeds"),
    "seed outside": (arguments("propagate", PROPAGATE, seeds="3,32"), "seeds"),
    "seed no integer": (arguments("propagate", PROPAGATE, seeds="3,4.5"), "seeds"),
    "negative order": (arguments("propagate", PROPAGATE, order="-1"), "order"),
    "unknown model": (arguments("propagate", PROPAGATE, model="gamma"), "model"),
    "solve, N below 2": (arguments("solve", SOLVE, N="1"), "N"),
    "solve, no seeds": (arguments("solve", SOLVE, seeds=""), "seeds"),
    "solve, repeated seeds": (arguments("solve", SOLVE, seeds="1,1"), "seeds"),
    "solve, seed outside": (arguments("solve", SOLVE, seeds="1,16"), "seeds"),
    "solve, seed no integer": (arguments("solve", SOLVE, seeds="1,a"), "seeds"),
    "too few frequencies": (arguments("solve", SOLVE, omega="0.19626"), "frequencies"),
    "too many frequencies": (arguments("solve", SOLVE, omega="0.19626,0.39046,0.5"), "frequencies"),
    "negative frequency": (arguments("solve", SOLVE, omega="-0.19626,0.39046"), "frequencies"),
    "zero frequency": (arguments("solve", SOLVE, omega="0,0.39046"), "frequencies"),
    "frequency nan": (arguments("solve", SOLVE, omega="nan,0.39046"), "frequencies"),
    "frequency inf": (arguments("solve", SOLVE, omega="inf,0.39046"), "frequencies"),
    "frequency no number": (arguments("solve", SOLVE, omega="a,0.39046"), "frequencies"),
    "no coupling": (arguments("solve", SOLVE, alpha="0"), "alpha, beta"),
    "coupling no number": (arguments("solve", SOLVE, alpha="1/0"), "alpha"),
    "solve, negative order": (arguments("solve", SOLVE, order="-1"), "order"),
    "order no integer": (arguments("solve", SOLVE, order="2.5"), "order"),
    "negative frequency order": (arguments("solve", SOLVE, frequency_order="-2"), "frequency_order"),
    "frequency order above the order": (arguments("solve", SOLVE, frequency_order="13"), "frequency_order"),
    "more than fits": (arguments("solve", SOLVE, seeds="1,2,3,4", omega="0.196,0.391,0.581,0.766", order="200"), "bytes"),
    "commensurable frequencies": (arguments("solve", SOLVE, omega="0.2,0.4"), "commensurable"),
    "no digits": (arguments("solve", SOLVE, digits="0"), "digits"),
    "negative digits": (arguments("solve", SOLVE, digits="-3"), "digits"),
    "digits no integer": (arguments("solve", SOLVE, digits="2.5"), "digits"),
    "digits no number": (arguments("solve", SOLVE, digits="abc"), "digits"),
    "coordinate order above the order": (arguments("solve", SOLVE, coordinate_order="13"), "order"),
    "negative coordinate order": (arguments("solve", SOLVE, coordinate_order="-1"), "order"),
    "coordinate order no number": (arguments("solve", SOLVE, coordinate_order="x"), "coordinate-order"),
    "no file to show": (["show"], "FILE"),
    "missing file to show": (["show", "/no such folder/file"], "No such file"),
    "folder to show": (["show", "/"], "Is a directory"),
    "target without a page": (["reproduce", "nosuch"], "nosuch"),
    "unknown option": ([*arguments("solve", SOLVE), "--colour", "red"], "--colour"),
    "missing option": (arguments("solve", SOLVE, omega=None), "--omega"),
    "unknown verb": (["conquer"], "conquer"),
    "nothing with more to it": (["reproduce", "fig6", "--full"], "full"),
    "unknown target": (["reproduce", "fig99"], "fig99"),
    "no target": (["reproduce"], "TARGET"),
}


@pytest.mark.parametrize(("argv", "named"), BAD_INPUT.values(), ids=BAD_INPUT)
def test_bad_input_is_one_line_and_code_2(capsys, argv, named):
    code, out, err = run(capsys, *argv)
    assert code == 2
    assert out == ""
    assert len(err.splitlines()) == 1
    assert err.startswith("symfpu: ")
    assert named in err
    assert "Traceback" not in err


@pytest.mark.parametrize("below", ["", "/deeper"])
def test_an_output_folder_that_cannot_be_written_is_bad_input(capsys, tmp_path, below):
    file = tmp_path / "a file"
    file.write_text("not a folder")
    code, out, err = run(capsys, "reproduce", "table", "-o", f"{file}{below}")
    assert (code, out) == (2, "")
    assert len(err.splitlines()) == 1
    assert "a file" in err
    assert file.read_text() == "not a folder"


@pytest.mark.parametrize(
    "argv",
    [
        arguments("solve", {"-N": "16", "--beta": "0.3", "--seeds": "3", "--omega": "0.57", "--order": "1"}),
        arguments("solve", {"-N": "16", "--alpha": "0.3", "--seeds": "8", "--omega": "1.42", "--order": "4"}),
        arguments("solve", {"-N": "16", "--beta": "0.3", "--seeds": "3", "--omega": "0.9", "--order": "2"}),
    ],
    ids=["no real amplitude", "undetermined", "no root"],
)
def test_honest_failures_are_one_line_and_code_1(capsys, argv):
    for options in ([], ["--json"]):
        code, out, err = run(capsys, *argv, *options)
        assert (code, out) == (1, "")
        assert len(err.splitlines()) == 1


VERBS = ("propagate", "prove", "verify", "sweep", "term", "solve", "show", "reproduce")


@pytest.mark.parametrize("verb", VERBS)
def test_help_has_an_example_of_its_verb(capsys, verb):
    code, out, err = run(capsys, verb, "--help")
    assert (code, err) == (0, "")
    assert f"Example: symfpu {verb}" in out
    assert "--json" in out


def test_examples_of_the_help_run(capsys):
    assert run(capsys, *["propagate", "-N", "32", "--model", "alpha", "--seeds", "3,5", "--order", "4"])[0] == 0
    assert run(capsys, *["solve", "-N", "16", "--alpha", "0.33", "--seeds", "1,2", "--omega", "0.19626,0.39046", "--order", "24"])[0] == 0


def test_help_names_every_verb(capsys):
    code, out, _ = run(capsys, "--help")
    assert code == 0
    assert all(verb in out for verb in VERBS)


def small_rows(monkeypatch):
    """Two cheap rows in place of the paper's nine: one that is met at order 22, and a breather that is met nowhere; the first is
    one of those that only --full refines."""
    monkeypatch.setattr("symfpu.paper.table.APPENDIX_F", tuple(row for row in APPENDIX_F if row.label == "Fig. 8"))
    monkeypatch.setattr("symfpu.paper.corrected.HEAVY_ROWS", {"Fig. 1": ((1e-8, 1e-9), 4)})


@pytest.mark.long
def test_reproduce_writes_the_report(capsys, monkeypatch, tmp_path):
    small_rows(monkeypatch)
    folder = tmp_path / "new" / "out"
    code, out, err = run(capsys, "reproduce", "table", "-o", str(folder))
    assert (code, err) == (0, "")
    pictures = {f"corrected-{panel}.{suffix}" for panel in "ab" for suffix in ("png", "pdf", "csv")}
    assert {path.name for path in folder.iterdir()} == {"report.json", "report.md"} | pictures
    assert "Fig. 8" in out
    assert "not refined: takes half a minute; computed with --full" in out
    assert "exact torus: A_25 = 0.0512121591740, H = 0.00464999936113, residual" in out
    assert "corrected-a..b as PNG, PDF and CSV" in out
    assert "amplitudes met at frequency order 22" in out
    assert "amplitudes met at no frequency order" in out
    assert [row["label"] for row in json.loads((folder / "report.json").read_text())["figures"]["table"]["numbers"]] == ["Fig. 1", "Fig. 8"]
    assert "met at no frequency order" in (folder / "report.md").read_text()


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


@pytest.mark.long
def test_reproduce_table_has_every_row_and_its_verdict(capsys, monkeypatch, tmp_path):
    """Rows of all kinds but the two that take longest (tests/paper/test_errata.py has them); one exact torus, the others take minutes."""
    quick = tuple(row for row in APPENDIX_F if row.label not in ("Fig. 5d", "Fig. 9"))
    monkeypatch.setattr("symfpu.paper.table.APPENDIX_F", quick)
    left_out = {row.label: ((1e-9, 1e-11), 4) for row in (TWO_TORUS, *quick) if row.label != "Fig. 8"}
    monkeypatch.setattr("symfpu.paper.corrected.HEAVY_ROWS", left_out)
    code, out, err = run(capsys, "reproduce", "table", "-o", str(tmp_path), "--json")
    rows = {row["label"]: row for row in json.loads(out)["figures"]["table"]["numbers"]}
    assert (code, err) == (0, "")
    assert list(rows) == ["Fig. 1", "Fig. 2", "Fig. 5a", "Fig. 5b", "Fig. 5c", "Fig. 7", "Fig. 8"]
    assert all(rows[label]["met_at_frequency_orders"] for label in ("Fig. 1", "Fig. 2", "Fig. 5a", "Fig. 5b", "Fig. 5c"))
    assert all(rows[label]["digits"] >= 10 for label in ("Fig. 2", "Fig. 5a", "Fig. 5b"))
    for label in ("Fig. 7", "Fig. 8"):
        assert rows[label]["met_at_frequency_orders"] == []
        assert "met at no frequency order" in rows[label]["verdict"]


@pytest.mark.long
def test_the_console_script_returns_the_code():
    command = [sys.executable, "-c", "import sys; sys.argv = ['symfpu', 'propagate']; from symfpu.cli.main import run; run()"]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    assert finished.returncode == 2
    assert finished.stdout == ""
    assert len(finished.stderr.splitlines()) == 1


def test_version(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("symfpu 0.")
