"""The command line's exact verbs: prove, verify, sweep, reproduce fig6."""

import json

import pytest

from symfpu.cli.main import main


def run(capsys, *arguments):
    code = main(list(arguments))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_prove_writes_a_certificate_that_verify_accepts(capsys, tmp_path):
    path = str(tmp_path / "c.json")
    code, out, _ = run(capsys, "prove", "-N", "8", "--model", "beta", "--seeds", "1,4", "--order", "3", "-o", path)
    assert code == 0
    assert "mode 7: predicted at order 1, actually 2" in out
    assert "verdict: refuted" in out
    code, out, err = run(capsys, "verify", path)
    assert (code, err) == (0, "")
    assert "the certificate is valid" in out
    code, out, _ = run(capsys, "verify", path, "--json")
    assert json.loads(out)["valid"] is True


def test_prove_json_has_the_fixed_keys(capsys):
    code, out, _ = run(capsys, "prove", "-N", "12", "--seeds", "1,5", "--order", "2", "--json")
    record = json.loads(out)
    assert code == 0
    assert record["verdict"] == "proved"
    assert record["exceptions"] == []
    assert record["rule"] == record["actual"]
    assert record["rule"][0] == [1, 5]


def test_undecided_is_an_honest_failure(capsys):
    code, out, _ = run(capsys, "prove", "-N", "8", "--seeds", "1", "--order", "2", "--points", "0")
    assert code == 1
    assert "verdict: undecided" in out


def test_altered_certificate_is_refused_in_one_line(capsys, tmp_path):
    path = tmp_path / "c.json"
    run(capsys, "prove", "-N", "6", "--model", "beta", "--seeds", "2,3", "--order", "2", "-o", str(path))
    path.write_text(path.read_text().replace('"residue": ', '"residue": 1', 1))
    code, out, err = run(capsys, "verify", str(path))
    assert (code, out) == (2, "")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["prove", "-N", "8", "--seeds", "1", "--order", "2", "--model", "gamma"], "model"),
        (["prove", "-N", "8", "--seeds", "1", "--order", "2", "--points", "-1"], "points"),
        (["prove", "-N", "8", "--seeds", "9", "--order", "2"], "seeds"),
        (["prove", "-N", "8", "--seeds", "1", "--order", "x"], "order"),
        (["prove", "-N", "8", "--seeds", "1", "--order", "2", "-o", "/nowhere/c.json"], "output"),
        (["verify", "/nowhere/c.json"], "certificate"),
        (["sweep", "--longest", "1", "--order", "2"], "longest"),
        (["sweep", "--longest", "4", "--largest", "0", "--order", "2"], "largest_set"),
        (["sweep", "--longest", "4", "--order", "1", "--model", "gamma"], "model"),
        (["sweep", "--longest", "3", "--order", "1", "--file", "/nowhere/s.jsonl"], "file"),
    ],
)
def test_bad_input_is_one_line_and_code_two(capsys, arguments, named):
    code, out, err = run(capsys, *arguments)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert err.startswith(f"symfpu: {named} = ")


@pytest.mark.long
def test_sweep_prints_exceptions_and_writes_its_summary(capsys, tmp_path):
    file, summary = tmp_path / "s.jsonl", tmp_path / "s.md"
    arguments = ["sweep", "--model", "beta", "--longest", "6", "--largest", "2", "--order", "2", "--file", str(file), "-o", str(summary)]
    code, out, _ = run(capsys, *arguments)
    assert code == 0
    assert "N=6 seeds (2, 3): mode 4 at 2, predicted 1" in out
    assert "4: 1 -> 2" in summary.read_text()
    code, out, _ = run(capsys, *arguments, "--json")
    assert len(json.loads(out)["exceptions"]) == 2
    assert len(file.read_text().splitlines()) == 36


@pytest.mark.long
def test_figure_6_is_written(capsys, tmp_path):
    code, _, _ = run(capsys, "reproduce", "fig6", "-o", str(tmp_path))
    assert code == 0
    names = {path.name for path in tmp_path.iterdir()}
    assert {f"fig6{panel}.{kind}" for panel in "abc" for kind in ("png", "pdf", "csv")} <= names
    first = (tmp_path / "fig6b.csv").read_text().splitlines()
    assert first[0] == "q,kappa,order"
    orders = {int(line.split(",")[0]): int(line.split(",")[2]) for line in first[1:]}
    assert orders[128] == 0
    assert orders[1] == orders[255] == 1
    assert orders[120] == 2
