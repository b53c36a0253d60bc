"""The verb frequencies: one orbit, a map with its file and picture, and what it refuses."""

import json

import pytest

from symfpu.cli.main import main
from symfpu.saved.results import load
from tests.tolerances import MAP_FREQUENCY

CHAIN = ("-N", "4", "--beta", "1", "--time", "500", "--step", "0.1")
MAP = (*CHAIN, "--energies", "0.01:0.1:3")


def run(capsys, *argv):
    code = main(["frequencies", *argv])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_lines_of_one_orbit(capsys):
    code, out, _ = run(capsys, *CHAIN, "--packet", "1", "--energy", "0.1", "--level", "1e-2")
    assert code == 0
    assert "independent frequencies above 0.01 of the strongest: 2" in out
    assert "mode  frequency" in out


def test_a_map_is_printed_drawn_saved_and_goes_on(capsys, tmp_path):
    rows, picture, saved = (str(tmp_path / name) for name in ("map.jsonl", "map.png", "map.symfpu"))
    code, out, _ = run(capsys, *MAP, "--file", rows, "--plot", picture, "--save", saved)
    assert code == 0
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    table = [line.split() for line in out.splitlines() if line[:2] == "0."]
    assert [(row[0], row[1]) for row in table] == [("0.01", "2"), ("0.03162", "2"), ("0.1", "2")]
    code, out, _ = run(capsys, *MAP, "--file", rows, "--json")
    record = json.loads(out)
    kept = load(saved).result
    first = [float(x) for x in record["columns"]["frequency"][::3]]
    assert first == pytest.approx(kept.frequencies[:, 0], rel=MAP_FREQUENCY)
    assert (code, record["kind"], record["about"]["packet"]) == (0, "FrequencyMap", "1")


def test_a_map_with_an_energy_that_fails_says_which_and_keeps_the_others(capsys, tmp_path):
    """Energy 1000 is above the barrier of the cubic potential."""
    rows, chain = tmp_path / "map.jsonl", ("-N", "4", "--alpha", "0.3", "--time", "500", "--step", "0.1")
    code, out, err = run(capsys, *chain, "--energies", "0.01,1000", "--file", str(rows))
    assert (code, out) == (1, "")
    assert "the first H = 1000 (EscapedOrbit: " in err
    code, out, _ = run(capsys, *chain, "--energies", "0.01", "--file", str(rows))
    assert (code, out[:12]) == (0, "FrequencyMap")


def test_the_torus_near_an_orbit_is_written_for_newton(capsys, tmp_path):
    near, refined = str(tmp_path / "near.symfpu"), str(tmp_path / "refined.symfpu")
    words = ("-N", "4", "--alpha", "0.3", "--packet", "1", "--energy", "0.01", "--time", "5e3", "--step", "0.1")
    code, out, _ = run(capsys, *words, "-o", near, "--angles", "2")
    assert (code, f"written: {near}" in out) == (0, True)
    assert main(["refine", near, "-o", refined]) == 0
    found = load(refined).result
    assert (found.verdict, found.seeds) == ("torus", (1, 2))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((*MAP, "--energy", "0.1"), "nothing beside --energies"),
        ((*MAP, "--random", "1"), "nothing beside --energies"),
        ((*CHAIN, "--energies", "0.1:0.01:3"), "FROM < TO"),
        ((*CHAIN, "--energies", "0.1:1"), "FROM:TO:NUMBER"),
        (("--time", "500", "--energies", "0.1"), "give -N"),
        ((*CHAIN, "--packet", "1", "--energy", "0.1", "--file", "x.jsonl"), "nothing without --energies"),
        ((*CHAIN, "--packet", "1", "--energy", "0.1", "--angles", "2"), "nothing without -o"),
        ((*CHAIN, "--packet", "1", "--energy", "0.1", "-o", "x.symfpu", "--angles", "9"), "independent frequencies"),
        ((*MAP, "-o", "x.symfpu"), "nothing beside --energies"),
    ],
)
def test_what_does_not_go_together_is_refused(capsys, words, said):
    code, out, err = run(capsys, *words)
    assert (code, out) == (2, "")
    assert said in err


@pytest.mark.parametrize("more", [["--energy", "0.1"], ["--energies", "0.1,0.2"]])
@pytest.mark.parametrize("level", ["2", "1", "0", "-1"])
def test_a_level_is_a_part_of_the_strongest(capsys, level, more):
    code, out, err = run(capsys, *CHAIN, "--packet", "1", *more, f"--level={level}")
    assert (code, out) == (2, "")
    assert "allowed is a number between 0 and 1" in err
