"""The verb atlas: borders and power laws printed, a file that is gone on with, and what it refuses."""

import json

import pytest

from symfpu.borders.atlas import atlas
from symfpu.cli import atlas as verb
from symfpu.cli.main import main
from symfpu.saved.results import load
from symfpu.sweeps.this_process import ThisProcess

ONE = ("--beta", "1", "--lengths", "8", "--packets", "high:1", "--order", "4", "--borders", "poles")


def run(capsys, *argv):
    code = main(["atlas", *argv])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


@pytest.fixture
def here(monkeypatch):
    """Columns in this process: others take seconds to start."""
    monkeypatch.setattr(verb, "available_cores", lambda: 1)


def test_borders_and_their_law_are_printed_saved_and_gone_on_with(here, capsys, tmp_path):
    file, saved = str(tmp_path / "atlas.jsonl"), str(tmp_path / "atlas.symfpu")
    words = ("--beta", "1", "--lengths", "4,6,8", "--packets", "high:1", "--order", "4", "--borders", "poles", "--file", file)
    code, out, _ = run(capsys, *words, "--save", saved)
    assert code == 0
    kept = load(saved).result
    lines = [line.split() for line in out.splitlines()]
    assert [line[:4] for line in lines[1:4]] == [[N, "high:1", "4", "poles"] for N in "468"]
    assert [float(line[4]) for line in lines[1:4]] == [float(f"{b.energy:.4g}") for b in kept.borders]
    assert all("mode" in line for line in lines[1:4])
    law = kept.law("high:1", "poles")
    assert f"N^({law.exponent:.3f} +- {law.error:.2g})" in out
    code, out, _ = run(capsys, *words, "--json")
    assert (code, json.loads(out)) == (0, kept.record())
    assert len((tmp_path / "atlas.jsonl").read_text().splitlines()) == 4


def test_a_column_that_fails_is_said_and_others_are_there(here, capsys):
    words = ("--lengths", "1,4", "--packets", "low:1", "--order", "2,3", "--borders", "newton", "--places", "0.01")
    code, out, _ = run(capsys, *words, "--beta", "1", "--reach", "1")
    assert code == 1
    assert out.count("N = 1, packet low:1: InputError: N = 1") == 2
    assert "followed as far as asked" in out


def test_what_is_asked_for_reaches_the_function(here, capsys, monkeypatch):
    asked = {}

    def heard(chains, packets, order, **how):
        asked.update(how, chains=chains, packets=packets, order=order)
        return atlas([{"N": 1}], ["1"], 1, executor=ThisProcess())

    monkeypatch.setattr(verb, "atlas", heard)
    words = (
        "--potential",
        "toda:1/2",
        "--lengths",
        "8,16",
        "--packets",
        "1,2 low:1/8",
        "--order",
        "4,6",
        "--places",
        "1e-3,0.1",
        "--per-particle",
    )
    words += ("--time", "1e4", "--draws", "3")
    run(capsys, *words, "--by", "amplitude", "--most-harmonics", "50", "--reach", "3", "--borders", "ratio,newton")
    assert [chain["N"] for chain in asked["chains"]] == [8, 16]
    assert {chain["potential"] for chain in asked["chains"]} == {"toda:1/2"}
    assert (asked["packets"], asked["order"], asked["places"]) == (["1,2", "low:1/8"], [4, 6], ["1e-3", "0.1"])
    assert (asked["by"], asked["per_particle"], asked["borders"]) == ("amplitude", True, ["ratio", "newton"])
    assert (asked["most_harmonics"], asked["reach"], asked["retry"]) == (50, 3.0, True)
    assert (asked["time"], asked["draws"]) == (1e4, 3)


def test_chaos_is_said_with_its_time_and_the_spread_of_draws(here, capsys):
    words = ("--beta", "1", "--lengths", "8", "--packets", "low:2", "--order", "1", "--time", "3e3", "--draws", "2")
    code, out, _ = run(capsys, *words, "--borders", "chaos")
    assert code == 0
    line = next(line for line in out.splitlines() if "chaos" in line)
    code, out, _ = run(capsys, *words, "--borders", "chaos", "--json")
    details = json.loads(out)["borders"][0]["details"]
    lowest, highest = details["between"]
    assert line.endswith(f"chaos by t = 3000, {lowest:.3g} .. {highest:.3g}")
    assert (details["time"], details["draws"]) == (3000.0, 2)


def test_an_interrupted_run_says_that_it_goes_on(here, capsys, monkeypatch, tmp_path):
    file = tmp_path / "atlas.jsonl"

    def pressed(*words, **how):
        file.write_text("a row\n")
        raise KeyboardInterrupt

    monkeypatch.setattr(verb, "atlas", pressed)
    code, out, err = run(capsys, *ONE, "--file", str(file))
    assert (code, out) == (130, "")
    assert "the same command goes on from them" in err


WRONG = {
    "lengths": ("--lengths", "8,x"),
    "no lengths": ("--lengths", ""),
    "order": ("--order", "0"),
    "borders": ("--borders", "radius"),
    "by": ("--by", "frequency"),
    "places": ("--places", "-1"),
    "reach": ("--reach", "0.1"),
    "beta": ("--beta", "x"),
    "packets": ("--packets", ""),
    "file": ("--file", "/no/such/folder/atlas.jsonl"),
    "most-harmonics": ("--most-harmonics", "x"),
    "time": ("--time", "x"),
    "draws": ("--draws", "1.5"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_words_are_refused_in_one_line(name, here, capsys):
    code, out, err = run(capsys, *ONE, *WRONG[name])
    assert (code, out) == (2, "")
    assert len(err.splitlines()) == 1
    assert name.removeprefix("no ") in err
