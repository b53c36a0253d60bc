"""The verb certify: a saved breather becomes a theorem and a certificate, or an honest failure of one line and code 1."""

import json

import pytest

from symfpu.breathers.balance import breather_at_amplitude
from symfpu.bundles.bundle import save
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes


@pytest.fixture
def saved(tmp_path):
    return str(save(tmp_path / "breather", breather_at_amplitude(Chain(2, beta=1), 1, "0.3")))


def test_a_saved_breather_becomes_a_certificate_that_verify_accepts(saved, tmp_path, capsys):
    certificate = str(tmp_path / "proof.json")
    assert main(["certify", saved, "-o", certificate]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].endswith("proved")
    assert lines[-1] == f"certificate: {certificate}"
    assert main(["verify", certificate]) == 0
    checked = capsys.readouterr().out.splitlines()
    assert checked[0].startswith("theorem: the chain of N = 2 bonds")
    assert checked[-1] == "the certificate is valid"


def test_json_has_the_radii_and_the_bounds(saved, capsys):
    assert main(["certify", saved, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["proved"] is True
    assert 0 < found["radius"] < found["unique"] < 1
    assert 0 < found["bounds"]["Z1"] < 1


def test_stability_is_a_certificate_that_verify_accepts(tmp_path, capsys):
    saved = str(save(tmp_path / "breather", breather_at_amplitude(Chain(4, alpha="0.3"), 1, "0.2")))
    certificate = str(tmp_path / "proof.json")
    assert main(["certify", saved, "--stability", "-o", certificate]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].endswith("linearly stable, proved")
    assert lines[-1] == f"certificate: {certificate}"
    assert main(["verify", certificate]) == 0
    checked = capsys.readouterr().out.splitlines()
    assert checked[0].startswith("theorem: the periodic orbit of the next line is linearly stable")
    assert checked[-1] == "the certificate is valid"


def test_json_says_stable_or_unstable(tmp_path, capsys):
    for chain, seed, amplitude, stable in ((Chain(4, alpha="0.3"), 1, "0.2", True), (Chain(6, beta=1), 4, "0.6", False)):
        saved = str(save(tmp_path / f"{stable}", breather_at_amplitude(chain, seed, amplitude)))
        assert main(["certify", saved, "--stability", "--json"]) == 0
        found = json.loads(capsys.readouterr().out)
        assert found["stable"] is stable
        assert ("linearly stable" in found["theorem"]) is stable
        assert all(0 < least < most for least, most in found["gaps"])
        assert bool(found["gaps"]) is stable
        assert (found["growth"][0] > 0) is not stable


@pytest.mark.long
def test_what_cannot_be_proved_is_one_line_and_code_1(tmp_path, capsys):
    """A root of a truncated series that is no orbit."""
    series = lindstedt(Chain(8, beta="0.5"), (3,), ("1.14",), 8)
    file = save(tmp_path / "spurious", solve_amplitudes(series, guess={3: 2.09}))
    assert main(["certify", str(file)]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert "the Newton step, Y = " in err
    assert len(err.splitlines()) == 1


@pytest.mark.long
def test_a_torus_of_two_angles_is_refused(tmp_path, capsys):
    torus = solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3905", "0.7663"), 2))
    assert main(["certify", str(save(tmp_path / "torus", torus))]) == 2
    assert "2 angles" in capsys.readouterr().err
