"""The verb stability: normal frequencies of a saved breather, as text and JSON, and what it refuses."""

import json

import pytest

from symfpu.breathers.balance import breather_at_amplitude
from symfpu.bundles.bundle import save
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.normal.search import normal_modes
from tests.tolerances import NORMAL_CONVERGED


@pytest.fixture
def saved(tmp_path):
    breather = breather_at_amplitude(Chain(4, beta=1), 2, "0.1")
    return breather, str(save(tmp_path / "breather", breather))


def test_json_has_the_frequencies_as_they_are(saved, capsys):
    breather, file = saved
    assert main(["stability", file, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    expected = normal_modes(breather).frequencies
    assert found["normal_frequencies"] == {str(q): repr(w) for q, w in expected.items()}
    assert found["stable"] is True
    assert found["signatures"] == {"1": 1, "3": 1}


def test_text_says_the_verdict_first(saved, capsys):
    assert main(["stability", saved[1], "--modes", "3"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "N=4, beta=1, seeds 2: stable"
    assert lines[2].split()[0] == "3"


def test_a_seed_is_no_normal_mode(saved, capsys):
    assert main(["stability", saved[1], "--modes", "2"]) == 2
    assert "no seeds" in capsys.readouterr().err


def test_series_stand_beside_the_frequencies(saved, capsys):
    breather, file = saved
    assert main(["stability", file, "--series", "6", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    for q, sigma in normal_modes(breather).frequencies.items():
        one = found["series"][str(q)]
        assert float(one["sigma"]) == pytest.approx(sigma, abs=NORMAL_CONVERGED)
        assert sum(map(float, one["terms"])) == pytest.approx(sigma, abs=NORMAL_CONVERGED)
        assert "A2**2" in one["closed_shift"]
    assert main(["stability", file, "--series", "6", "--modes", "3"]) == 0
    assert "orders 1..6" in capsys.readouterr().out


def test_a_line_of_tori_is_kept_drawn_and_gone_on_with(saved, tmp_path, capsys):
    file, folder, kept, picture = saved[1], tmp_path / "line", tmp_path / "kept.symfpu", tmp_path / "line.png"
    line = ["stability", file, "--to-amplitudes", "0.2", "--members", "2", "-o", str(folder)]
    assert main([*line, "--save", str(kept), "--plot", str(picture)]) == 0
    out = capsys.readouterr().out
    assert out.startswith("N=4, beta=1, seeds 2: 2 tori, stable")
    assert "no events" in out
    assert picture.exists()
    assert main([*line, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    breather = breather_at_amplitude(Chain(4, beta=1), 2, "0.2")
    sigma = {str(q): pytest.approx(w, abs=NORMAL_CONVERGED) for q, w in normal_modes(breather).frequencies.items()}
    assert {q: float(w) for q, w in record["members"][1]["normal_frequencies"].items()} == sigma
    assert record["events"] == []
    assert main(["show", str(kept), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["members"] == record["members"]


@pytest.mark.parametrize("options", [["--members", "3"], ["-o", "folder"], ["--series", "3", "--to-amplitudes", "0.2"]])
def test_options_that_say_nothing_are_refused(saved, options, capsys):
    assert main(["stability", saved[1], *options]) == 2
    assert options[0].lstrip("-")[:1] in capsys.readouterr().err
