"""The verb stability: normal frequencies of a saved breather, as text and JSON, and what it refuses."""

import json

import pytest

from symfpu.breathers.balance import breather_at_amplitude
from symfpu.bundles.bundle import save
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.normal.search import normal_modes


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
