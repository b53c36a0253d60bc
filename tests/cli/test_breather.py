"""The verb breather: one orbit from frequency, amplitude or energy, kept, with digits and multipliers."""

import json

import numpy as np
import pytest

from symfpu.breathers.balance import PeriodicOrbit, breather_at_amplitude, periodic_orbit
from symfpu.breathers.digits import PreciseOrbit
from symfpu.breathers.floquet import floquet
from symfpu.bundles.bundle import load
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from tests.tolerances import FIXED_ENERGY, PROMISED_RESIDUAL, RELATIVE_SHIFT

CHAIN = Chain(8, alpha="0.3")
WORDS = ["breather", "-N", "8", "--alpha", "0.3", "--seed", "1"]


def record(capsys, *words):
    assert main([*WORDS, *words, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def refused(capsys, *words):
    code = main([*WORDS, *words])
    captured = capsys.readouterr()
    assert captured.out == ""
    assert len(captured.err.splitlines()) == 1
    return code, captured.err


def test_by_frequency(capsys, tmp_path):
    found = record(capsys, "--omega", "0.3905", "-o", str(tmp_path / "orbit"))
    orbit = periodic_orbit(CHAIN, 1, "0.3905")
    assert found["frequencies"] == {"1": "0.3905"}
    assert found["amplitudes"] == {"1": repr(orbit.amplitude)}
    assert found["energy"] == repr(float(orbit.energy()))
    assert found["harmonic_energy"] == repr(float(orbit.harmonic_energies().sum()))
    assert found["residual"] < PROMISED_RESIDUAL
    assert (found["seeds"], found["digits"], found["warnings"]) == ([1], None, [])
    assert "multipliers" not in found
    kept = load(tmp_path / "orbit")
    assert type(kept.torus) is PeriodicOrbit
    assert (kept.torus.cosines == orbit.cosines).all()
    assert kept.provenance["command"].startswith("symfpu breather -N 8")


def test_by_amplitude_and_by_energy(capsys):
    by_amplitude = record(capsys, "--amplitude", "0.4")
    assert float(by_amplitude["amplitudes"]["1"]) == 0.4
    by_energy = record(capsys, "--energy", by_amplitude["energy"])
    assert float(by_energy["amplitudes"]["1"]) == pytest.approx(0.4, rel=RELATIVE_SHIFT)
    assert float(by_energy["energy"]) == pytest.approx(float(by_amplitude["energy"]), rel=FIXED_ENERGY)


def test_many_digits(capsys, tmp_path):
    found = record(capsys, "--amplitude", "0.4", "--digits", "30", "-o", str(tmp_path / "orbit"))
    assert found["digits"] == 30
    assert len(found["energy"]) > 30
    assert (found["amplitudes"]["1"], found["warnings"]) == ("0.4", [])
    assert type(load(tmp_path / "orbit").torus) is PreciseOrbit
    [warning] = record(capsys, "--energy", "0.01", "--digits", "20")["warnings"]
    assert "met in doubles" in warning


def test_multipliers(capsys):
    found = record(capsys, "--amplitude", "0.4", "--multipliers")
    expected = floquet(breather_at_amplitude(CHAIN, 1, "0.4"))
    values = np.array([complex(float(x), float(y)) for x, y in found["multipliers"]])
    assert (values == expected.multipliers).all()
    assert (found["stable"], found["instabilities"], found["largest_multiplier"]) == (True, {}, 1.0)


def test_an_unstable_breather_says_how(capsys):
    words = ["-N", "6", "--beta", "1", "--seed", "5", "--amplitude", "1", "--multipliers"]
    assert main(["breather", *words]) == 0
    text = capsys.readouterr().out
    assert "unstable: 1 real > 0, the largest |multiplier| 1.201" in text
    assert "seed 5" in text


def test_the_text_names_the_file(capsys, tmp_path):
    assert main([*WORDS, "--omega", "0.3905", "-o", str(tmp_path / "orbit")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "PeriodicOrbit, N=8, alpha=0.3, beta=0"
    assert lines[-1] == f"written: {tmp_path / 'orbit'}"
    assert main(["show", str(tmp_path / "orbit")]) == 0
    assert "verdict: periodic orbit" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "exactly one of --omega, --amplitude and --energy; give one of them"),
        (["--omega", "0.3905", "--energy", "0.01"], "exactly one of"),
        (["--omega", "0.39", "--energy", "0.01", "--amplitude", "1"], "exactly one of"),
        (["--energy", "-0.01"], "energy = '-0.01': allowed is a positive number"),
        (["--energy", "0"], "energy = '0'"),
        (["--omega", "-1"], "frequency = '-1'"),
        (["--amplitude", "0"], "amplitude = '0'"),
        (["--amplitude", "much"], "amplitude = 'much'"),
        (["--omega", "0.3905", "--digits", "0"], "digits = 0"),
        (["--omega", "0.3905", "-o", "none/orbit"], "output = 'none/orbit'"),
        (["--omega", "0.3905", "--seed", "8"], "seeds = 8"),
        (["--omega", "0.3905", "--seed", "one"], "seed = 'one'"),
    ],
)
def test_wrong_arguments(capsys, words, said):
    code, error = refused(capsys, *words)
    assert code == 2
    assert said in error


def test_where_there_is_no_breather_the_exit_code_is_one(capsys):
    code, error = refused(capsys, "--omega", "0.3")
    assert code == 1
    assert "no real amplitude" in error
