"""The verb certify: a saved breather becomes a theorem and a certificate, or an honest failure of one line and code 1."""

import pytest

import symfpu
from symfpu import Chain, lindstedt, save, solve_amplitudes
from tests.breather import breather_of
from tests.cli.running import answer, refusal, run, shown
from tests.every_result import two_angles


@pytest.fixture
def saved(tmp_path):
    return save(tmp_path / "breather", symfpu.torus(Chain(2, beta=1), (1,), amplitudes={1: "0.3"}))


STABLE = (Chain(4, alpha="0.3"), 1, "0.2")
THEOREMS = {
    "existence": ((Chain(2, beta=1), 1, "0.3"), [], "proved", "the chain of N = 2 bonds"),
    "stability": (STABLE, ["--stability"], "linearly stable, proved", "the periodic orbit of the next line is linearly stable"),
}


@pytest.mark.parametrize("name", THEOREMS)
def test_a_saved_breather_becomes_a_certificate_that_verify_accepts(name, tmp_path, capsys):
    of, options, said, theorem = THEOREMS[name]
    certificate, file = tmp_path / "proof.json", save(tmp_path / "breather", breather_of(*of))
    lines = shown(capsys, "certify", file, *options, "-o", certificate).splitlines()
    assert lines[0].endswith(said)
    assert lines[-1] == f"certificate: {certificate}"
    checked = shown(capsys, "verify", certificate).splitlines()
    assert checked[0].startswith(f"theorem: {theorem}")
    assert checked[-1] == "the certificate is valid"


def test_stability_at_an_amplitude(tmp_path, capsys):
    """Mode N/2 in alpha has one frequency at every amplitude."""
    saved, certificate = save(tmp_path / "breather", symfpu.torus(Chain(4, alpha="1/2"), (2,), amplitudes={2: 1})), tmp_path / "proof.json"
    out = shown(capsys, "certify", saved, "--stability", "--amplitude", "1", "-o", certificate)
    assert "seed 2, A=1, omega = 1.414213562" in out
    assert "linearly unstable" in shown(capsys, "verify", certificate)


def test_json_says_stable_or_unstable(tmp_path, capsys):
    for of, stable in ((STABLE, True), ((Chain(6, beta=1), 4, "0.6"), False)):
        found = answer(capsys, "certify", save(tmp_path / f"{stable}", breather_of(*of)), "--stability")
        assert found["stable"] is stable
        assert ("linearly stable" in found["theorem"]) is stable
        assert all(0 < least < most for least, most in found["gaps"])
        assert bool(found["gaps"]) is stable
        assert (found["growth"][0] > 0) is not stable


def test_an_amplitude_and_a_segment_are_given_in_words(saved, tmp_path, capsys):
    certificate = tmp_path / "proof.json"
    assert "seed 1, A=0.3: proved" in shown(capsys, "certify", saved, "--amplitude", "0.3", "-o", certificate)
    found = answer(capsys, "certify", saved, "--amplitude", "0.3", "--half-width", "1e-4", "-o", certificate)
    assert (found["fixed"], found["value"], found["half_width"]) == ("amplitude", "0.3", "0.0001")
    assert found["frequency_radius"] > 0
    assert "for every amplitude A from 2999/10000 to 3001/10000" in shown(capsys, "verify", certificate)


def test_a_segment_too_long_is_one_line_and_code_1(saved, capsys):
    assert "a shorter segment can" in refusal(capsys, "certify", saved, "--half-width", "0.5", code=1)
    assert "torus" in refusal(capsys, "certify", saved, "--amplitude", "0.2")


@pytest.mark.long
def test_what_cannot_be_proved_is_one_line_and_code_1(tmp_path, capsys):
    """A root of a truncated series that is no orbit."""
    series = lindstedt(Chain(8, beta="0.5"), (3,), ("1.14",), 8)
    file = save(tmp_path / "spurious", solve_amplitudes(series, guess={3: 2.09}))
    assert "the Newton step, Y = " in refusal(capsys, "certify", file, code=1)


def test_a_torus_stays_for_a_time_and_its_residual_is_a_theorem(tmp_path, capsys):
    torus, certificate = save(tmp_path / "torus", two_angles()), tmp_path / "proof.json"
    assert "stays within" in shown(capsys, "certify", torus, "--time", "1000", "-o", certificate)
    assert "every orbit that starts on this torus stays" in shown(capsys, "verify", certificate)
    assert run(capsys, "certify", torus, "--residual", "-o", certificate)[0] == 0
    assert answer(capsys, "verify", certificate)["kind"] == "ResidualProof"
    assert "no proof of a stay of 1.0e+12: at most" in refusal(capsys, "certify", torus, "--time", "1e12", code=1)
