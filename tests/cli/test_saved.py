"""Verbs that read a file take any saved solution: show, refine, orbit, gali, export."""

import json

import pytest

from symfpu.bundles.bundle import load, save
from symfpu.cli.main import main
from symfpu.saved import results
from tests.tolerances import COARSE_STEP_ERROR, NEWTON_RESIDUAL, TEN_ROUNDINGS
from tests.tori.solutions import CASES


@pytest.fixture(scope="module", params=CASES)
def saved(request, tmp_path_factory):
    """A file, and the solution in it."""
    solution = CASES[request.param]()
    return save(tmp_path_factory.mktemp("saved") / "solution.symfpu", solution), solution


def record(capsys, *words):
    assert main([*map(str, words), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_show(capsys, saved):
    file, solution = saved
    found = record(capsys, "show", file)
    assert found["seeds"] == list(solution.seeds)
    assert set(found["amplitudes"]) == set(map(str, solution.seeds))
    assert float(found["energy"]) == pytest.approx(float(solution.energy()), rel=TEN_ROUNDINGS)
    assert {"frequencies", "harmonic_energy", "residual", "warnings", "provenance"} <= set(found)
    assert main(["show", str(file)]) == 0
    text = capsys.readouterr().out
    assert "energy H" in text
    assert "created" in text


def test_refine(capsys, saved, tmp_path):
    file, solution = saved
    found = record(capsys, "refine", file, "-o", tmp_path / "refined.symfpu")
    assert found["residual"] < NEWTON_RESIDUAL
    assert load(tmp_path / "refined.symfpu").torus.frequencies == solution.frequencies


def test_orbit(capsys, saved):
    file, _ = saved
    assert record(capsys, "orbit", file, "--time", "10", "--step", "0.05")["largest_deviation"] < COARSE_STEP_ERROR


def test_gali(capsys, saved):
    file, solution = saved
    found = record(capsys, "gali", file, "--time", "100", "--vectors", "2", "--samples", "64")
    assert found["seeds"] == list(solution.seeds)


def test_export(capsys, saved, tmp_path):
    file, _ = saved
    assert main(["export", str(file), "--lang", "numpy", "-o", str(tmp_path / "mode")]) == 0
    assert "def positions(" in (tmp_path / "mode.py").read_text()


STEPS = {
    "orbit": ("Orbit", ["--packet", "1", "--energy", "0.1", "-N", "4", "--alpha", "1", "--time", "5"]),
    "gali": ("AlignmentIndices", ["--packet", "1", "--energy", "0.1", "-N", "4", "--alpha", "1", "--time", "100", "--vectors", "2"]),
    "family": ("Family", ["-N", "4", "--beta", "1", "--seeds", "1", "--to-energy", "0.01", "--from-energy", "0.009"]),
    "sweep": ("Sweep", ["--order", "1", "--longest", "3", "--largest", "1"]),
}


@pytest.mark.long
@pytest.mark.parametrize("verb", STEPS)
def test_verbs_keep_their_results(capsys, verb, tmp_path):
    kind, words = STEPS[verb]
    file = tmp_path / "kept.symfpu"
    printed = record(capsys, verb, *words, "--save", file)
    bundle = results.load(file)
    assert type(bundle.result).__name__ == kind
    assert bundle.provenance["command"].startswith(f"symfpu {verb} ")
    shown = record(capsys, "show", file)
    assert shown["kind"] == kind
    assert all(shown[key] == printed[key] for key in shown.keys() & printed.keys())
    assert main([verb, *words, "--save", str(tmp_path / "none" / "file")]) == 2
    assert "save" in capsys.readouterr().err
