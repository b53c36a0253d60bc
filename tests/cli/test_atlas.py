"""The verb atlas: borders and power laws printed, a file that is gone on with, and what it refuses."""

from shlex import split

import pytest

from symfpu import atlas, load
from symfpu.cli import atlas as verb
from tests.cli.running import answer, run, shown


@pytest.fixture(autouse=True)
def here(monkeypatch):
    """Columns in this process: others take seconds to start."""
    monkeypatch.setattr(verb, "available_cores", lambda: 1)


def test_borders_and_their_law_are_printed_saved_and_gone_on_with(capsys, tmp_path):
    file, saved = tmp_path / "atlas.jsonl", tmp_path / "atlas.symfpu"
    words = split("atlas --beta 1 --lengths 4,6,8 --packets low:1 --order 3 --by amplitude --borders ratio --reach 1 --file")
    out = shown(capsys, *words, file, "--save", saved, quiet=False)
    kept = load(saved)
    lines = [line.split() for line in out.splitlines()]
    assert [line[:4] for line in lines[1:4]] == [[N, "low:1", "3", "ratio"] for N in "468"]
    assert [float(line[4]) for line in lines[1:4]] == [float(f"{b.energy:.4g}") for b in kept.borders]
    assert all("mode" in line for line in lines[1:4])
    law = kept.law("low:1", "ratio")
    assert f"N^({law.exponent:.3f} +- {law.error:.2g})" in out
    assert answer(capsys, *words, file) == kept.record()
    assert len(file.read_text().splitlines()) == 4


def test_a_column_that_fails_is_said_and_others_are_there(capsys):
    words = "atlas --lengths 1,4 --packets low:1 --order 2,3 --borders newton --places 0.01 --beta 1 --reach 1"
    code, out, _ = run(capsys, *words.split())
    assert code == 1
    assert out.count("N = 1, packet low:1: InputError: N = 1") == 2
    assert "followed as far as asked" in out


def test_what_is_asked_for_reaches_the_function(capsys, monkeypatch, threads):
    asked = {}

    def heard(chains, packets, order, **how):
        asked.update(how, chains=chains, packets=packets, order=order)
        return atlas([{"N": 1}], ["1"], 1, executor=threads)

    monkeypatch.setattr(verb, "atlas", heard)
    words = "atlas --potential toda:1/2 --lengths 8,16 --order 4,6 --places 1e-3,0.1 --per-particle --time 1e4 --draws 3"
    more = "--by amplitude --most-harmonics 50 --reach 3 --borders ratio,newton"
    run(capsys, *words.split(), "--packets", "1,2 low:1/8", *more.split())
    assert [chain["N"] for chain in asked["chains"]] == [8, 16]
    assert {chain["potential"] for chain in asked["chains"]} == {"toda:1/2"}
    assert (asked["packets"], asked["order"], asked["places"]) == (["1,2", "low:1/8"], [4, 6], ["1e-3", "0.1"])
    assert (asked["by"], asked["per_particle"], asked["borders"]) == ("amplitude", True, ["ratio", "newton"])
    assert (asked["most_harmonics"], asked["reach"], asked["retry"]) == (50, 3.0, True)
    assert (asked["time"], asked["draws"]) == (1e4, 3)


@pytest.mark.long
def test_chaos_is_said_with_its_time_and_the_spread_of_draws(capsys):
    words = split("atlas --beta 1 --lengths 8 --packets low:2 --order 1 --time 3e3 --draws 2 --borders chaos")
    line = next(line for line in shown(capsys, *words).splitlines() if "chaos" in line)
    details = answer(capsys, *words)["borders"][0]["details"]
    lowest, highest = details["between"]
    assert line.endswith(f"chaos by t = 3000, {lowest:.3g} .. {highest:.3g}")
    assert (details["time"], details["draws"]) == (3000.0, 2)


def test_an_interrupted_run_says_that_it_goes_on(capsys, monkeypatch, tmp_path):
    file = tmp_path / "atlas.jsonl"

    def pressed(*words, **how):
        file.write_text("a row\n")
        raise KeyboardInterrupt

    monkeypatch.setattr(verb, "atlas", pressed)
    code, out, err = run(capsys, *split("atlas --beta 1 --lengths 8 --packets high:1 --order 4 --borders poles --file"), file)
    assert (code, out) == (130, "")
    assert "the same command goes on from them" in err
