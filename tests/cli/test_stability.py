"""The verb stability: normal frequencies of a saved breather, as text and JSON, and what it refuses."""

import pytest

import symfpu
from symfpu import Chain, normal_modes, save
from tests.cli.running import answer, shown
from tests.tolerances import NORMAL_CONVERGED


@pytest.fixture
def saved(tmp_path):
    breather = symfpu.torus(Chain(4, beta=1), (2,), amplitudes={2: "0.1"})
    return breather, str(save(tmp_path / "breather", breather))


def test_json_has_the_frequencies_as_they_are(saved, capsys):
    breather, file = saved
    found = answer(capsys, "stability", file)
    expected = normal_modes(breather).frequencies
    assert found["normal_frequencies"] == {str(q): repr(w) for q, w in expected.items()}
    assert found["stable"] is True
    assert found["signatures"] == {"1": 1, "3": 1}


def test_series_stand_beside_the_frequencies(saved, capsys):
    breather, file = saved
    found = answer(capsys, "stability", file, "--series", "6")
    for q, sigma in normal_modes(breather).frequencies.items():
        one = found["series"][str(q)]
        assert float(one["sigma"]) == pytest.approx(sigma, abs=NORMAL_CONVERGED)
        assert sum(map(float, one["terms"])) == pytest.approx(sigma, abs=NORMAL_CONVERGED)
        assert "A2**2" in one["closed_shift"]
    assert "orders 1..6" in shown(capsys, "stability", file, "--series", "6", "--modes", "3")


def test_a_line_of_tori_is_kept_drawn_and_gone_on_with(saved, tmp_path, capsys):
    file, folder, kept, picture = saved[1], tmp_path / "line", tmp_path / "kept.symfpu", tmp_path / "line.png"
    line = ["stability", file, "--to-amplitudes", "0.2", "--members", "2", "-o", str(folder)]
    out = shown(capsys, *line, "--save", str(kept), "--plot", str(picture))
    assert out.startswith("N=4, beta=1, seeds 2: 2 tori, stable")
    assert "no events" in out
    assert picture.exists()
    record = answer(capsys, *line)
    breather = symfpu.torus(Chain(4, beta=1), (2,), amplitudes={2: "0.2"})
    sigma = {str(q): pytest.approx(w, abs=NORMAL_CONVERGED) for q, w in normal_modes(breather).frequencies.items()}
    assert {q: float(w) for q, w in record["members"][1]["normal_frequencies"].items()} == sigma
    assert record["events"] == []
    assert answer(capsys, "show", kept)["members"] == record["members"]
