"""The verb certify: a saved breather becomes a theorem and a certificate, or an honest failure of one line and code 1."""

import json

import pytest

from symfpu.breathers.balance import breather_at_amplitude
from symfpu.bundles.bundle import save
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from tests.test_pickle import two_angles


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


def test_an_amplitude_and_a_segment_are_given_in_words(saved, tmp_path, capsys):
    certificate = str(tmp_path / "proof.json")
    assert main(["certify", saved, "--amplitude", "0.3", "-o", certificate]) == 0
    assert "seed 1, A=0.3: proved" in capsys.readouterr().out
    assert main(["certify", saved, "--amplitude", "0.3", "--half-width", "1e-4", "-o", certificate, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["fixed"], found["value"], found["half_width"]) == ("amplitude", "0.3", "0.0001")
    assert found["frequency_radius"] > 0
    assert main(["verify", certificate]) == 0
    assert "for every amplitude A from 2999/10000 to 3001/10000" in capsys.readouterr().out


def test_a_segment_too_long_is_one_line_and_code_1(saved, capsys):
    assert main(["certify", saved, "--half-width", "0.5"]) == 1
    assert "a shorter segment can" in capsys.readouterr().err
    assert main(["certify", saved, "--amplitude", "0.2"]) == 2
    assert "breather_at_amplitude" in capsys.readouterr().err


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


@pytest.fixture
def torus(tmp_path):
    return str(save(tmp_path / "torus", two_angles()))


def test_a_torus_stays_for_a_time_and_its_residual_is_a_theorem(torus, tmp_path, capsys):
    certificate = str(tmp_path / "proof.json")
    assert main(["certify", torus, "--time", "1000", "-o", certificate]) == 0
    assert "stays within" in capsys.readouterr().out
    assert main(["verify", certificate]) == 0
    assert "every orbit that starts on this torus stays" in capsys.readouterr().out
    assert main(["certify", torus, "--residual", "-o", certificate]) == 0
    assert main(["verify", certificate, "--json"]) == 0
    assert '"kind": "ResidualProof"' in capsys.readouterr().out


def test_too_long_a_stay_is_one_line_and_code_1(torus, capsys):
    assert main(["certify", torus, "--time", "1e12"]) == 1
    assert "no proof of a stay of 1.0e+12: at most" in capsys.readouterr().err


def test_options_of_a_torus_are_refused_for_a_breather(saved, torus, capsys):
    assert main(["certify", saved, "--time", "10"]) == 2
    assert main(["certify", saved, "--residual"]) == 2
    assert main(["certify", torus, "--residual", "--time", "10"]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 3
