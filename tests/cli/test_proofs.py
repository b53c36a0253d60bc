"""The command line's exact verbs: prove, verify, sweep, reproduce fig6."""

from shlex import split

import pytest

from tests.cli.running import answer, run, shown
from tests.system import read_from


def test_prove_writes_a_certificate_that_verify_accepts(capsys, tmp_path):
    path = str(tmp_path / "c.json")
    out = shown(capsys, "prove", "-N", "8", "--model", "beta", "--seeds", "1,4", "--order", "3", "-o", path)
    assert "mode 7: predicted at order 1, actually 2" in out
    assert "verdict: refuted" in out
    out = shown(capsys, "verify", path)
    assert "the certificate is valid" in out
    assert answer(capsys, "verify", path)["valid"] is True


def test_undecided_is_an_honest_failure(capsys):
    code, out, _ = run(capsys, "prove", "-N", "8", "--seeds", "1", "--order", "2", "--points", "0")
    assert code == 1
    assert "verdict: undecided" in out


@pytest.mark.long
def test_sweep_prints_exceptions_and_writes_its_summary(capsys, tmp_path):
    file, summary = tmp_path / "s.jsonl", tmp_path / "s.md"
    arguments = ["sweep", "--model", "beta", "--longest", "6", "--largest", "2", "--order", "2", "--file", str(file), "-o", str(summary)]
    out = shown(capsys, *arguments)
    assert "N=6 seeds (2, 3): mode 4 at 2, predicted 1" in out
    assert "4: 1 -> 2" in summary.read_text()
    assert len(answer(capsys, *arguments)["exceptions"]) == 2
    assert len(file.read_text().splitlines()) == 36


def test_a_certificate_goes_through_a_link_and_into_a_pipe(capsys, tmp_path):
    prove = split("prove -N 6 --seeds 1,2 --order 2 -o")
    link, pipe = tmp_path / "link", tmp_path / "pipe"
    link.symlink_to(tmp_path / "certificate")
    assert run(capsys, *prove, str(link))[0] == 0
    assert link.is_symlink()
    with read_from(pipe) as heard:
        assert run(capsys, *prove, str(pipe))[0] == 0
    assert pipe.is_fifo()
    assert heard == [(tmp_path / "certificate").read_bytes()]
    assert run(capsys, "verify", str(link))[0] == 0
