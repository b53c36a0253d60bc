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
    assert "no proof of a stay of 1e+12: at most" in capsys.readouterr().err


def test_options_of_a_torus_are_refused_for_a_breather(saved, torus, capsys):
    assert main(["certify", saved, "--time", "10"]) == 2
    assert main(["certify", saved, "--residual"]) == 2
    assert main(["certify", torus, "--residual", "--time", "10"]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 3
