"""The verb frequencies: one orbit, a map with its file and picture, and what it refuses."""

import pytest

from symfpu import load
from tests.cli.running import answer, run, shown
from tests.tolerances import MAP_FREQUENCY

CHAIN = ("frequencies", "-N", "4", "--beta", "1", "--time", "500", "--step", "0.1")
MAP = (*CHAIN, "--energies", "0.01:0.1:3")
ALPHA = ("frequencies", "-N", "4", "--alpha", "0.3", "--step", "0.1")


def test_lines_of_one_orbit(capsys):
    out = shown(capsys, *CHAIN, "--packet", "1", "--energy", "0.1", "--level", "1e-2")
    assert "independent frequencies above 0.01 of the strongest: 2" in out
    assert "mode  frequency" in out


def test_a_map_is_printed_drawn_saved_and_goes_on(capsys, tmp_path):
    rows, picture, saved = (str(tmp_path / name) for name in ("map.jsonl", "map.png", "map.symfpu"))
    out = shown(capsys, *MAP, "--file", rows, "--plot", picture, "--save", saved)
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    table = [line.split() for line in out.splitlines() if line[:2] == "0."]
    assert [(row[0], row[1]) for row in table] == [("0.01", "2"), ("0.03162", "2"), ("0.1", "2")]
    record, kept = answer(capsys, *MAP, "--file", rows), load(saved)
    first = [float(x) for x in record["columns"]["frequency"][::3]]
    assert first == pytest.approx(kept.frequencies[:, 0], rel=MAP_FREQUENCY)
    assert (record["kind"], record["about"]["packet"]) == ("FrequencyMap", "1")


def test_a_map_with_an_energy_that_fails_says_which_and_keeps_the_others(capsys, tmp_path):
    """Energy 1000 is above the barrier of the cubic potential."""
    words = (*ALPHA, "--time", "500", "--file", tmp_path / "map.jsonl", "--energies")
    code, out, err = run(capsys, *words, "0.01,1000")
    assert (code, out) == (1, "")
    assert "the first H = 1000 (EscapedOrbit: " in err
    assert shown(capsys, *words, "0.01").startswith("FrequencyMap")


def test_the_torus_near_an_orbit_is_written_for_newton(capsys, tmp_path):
    near, refined = tmp_path / "near.symfpu", tmp_path / "refined.symfpu"
    words = (*ALPHA, "--packet", "1", "--energy", "0.01", "--time", "5e3")
    assert f"written: {near}" in shown(capsys, *words, "-o", near, "--angles", "2", quiet=False)
    shown(capsys, "refine", near, "-o", refined)
    found = load(refined)
    assert (found.warnings, found.seeds) == ((), (1, 2))
