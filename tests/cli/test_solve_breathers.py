"""The verb breather: one orbit from frequency, amplitude or energy, kept, with digits and multipliers."""

from shlex import split

import numpy as np
import pytest

import symfpu
from symfpu import Chain, HarmonicBalance, IterativeRefinement, floquet, load
from tests.cli.running import answer, shown
from tests.tolerances import FIXED_ENERGY, PROMISED_RESIDUAL, RELATIVE_SHIFT

CHAIN = Chain(8, alpha="0.3")
WORDS = split("solve -N 8 --alpha 0.3 --seeds 1")


def test_by_frequency(capsys, tmp_path):
    found = answer(capsys, *WORDS, "--omega", "0.3905", "-o", tmp_path / "orbit")
    orbit = symfpu.torus(CHAIN, (1,), frequencies=("0.3905",))
    assert found["frequencies"] == {"1": "0.3905"}
    assert found["amplitudes"] == {"1": repr(orbit.amplitude)}
    assert found["energy"] == repr(float(orbit.energy()))
    assert found["harmonic_energy"] == repr(float(orbit.harmonic_energies().sum()))
    assert found["residual"] < PROMISED_RESIDUAL
    assert (found["seeds"], found["digits"], found["warnings"]) == ([1], None, [])
    assert "multipliers" not in found
    kept = symfpu.saved_file(tmp_path / "orbit")
    assert type(kept.result.origin) is HarmonicBalance
    assert (kept.result.cosines == orbit.cosines).all()
    assert kept.provenance["command"].startswith("symfpu solve -N 8")


def test_by_amplitude_and_by_energy(capsys):
    by_amplitude = answer(capsys, *WORDS, "--amplitudes", "0.4")
    assert float(by_amplitude["amplitudes"]["1"]) == 0.4
    by_energy = answer(capsys, *WORDS, "--energy", by_amplitude["energy"])
    assert float(by_energy["amplitudes"]["1"]) == pytest.approx(0.4, rel=RELATIVE_SHIFT)
    assert float(by_energy["energy"]) == pytest.approx(float(by_amplitude["energy"]), rel=FIXED_ENERGY)


@pytest.mark.long
@pytest.mark.parametrize("verb", ["solve --seeds 1"])
def test_an_energy_that_the_family_passes_twice_is_a_warning(verb, capsys, tmp_path):
    """N = 16, beta = 1: the energy turns at 0.8127. The file keeps it as the reason of its verdict."""
    file = tmp_path / "breather.symfpu"
    found = answer(capsys, *split(f"{verb} -N 16 --beta 1 --energy 0.79"), "-o", str(file))
    assert symfpu.saved_file(file).verdict["reasons"] == found["warnings"]
    assert [w.partition(":")[0] for w in found["warnings"]] == [
        "A = 4.83023 is the first orbit of this energy, the family from rest passes it again near A = 4.57684"
    ]


def test_many_digits(capsys, tmp_path):
    found = answer(capsys, *WORDS, "--amplitudes", "0.4", "--digits", "30", "-o", tmp_path / "orbit")
    assert found["digits"] == 30
    assert len(found["energy"]) > 30
    assert (found["amplitudes"]["1"], found["warnings"]) == ("0.4", [])
    assert type(load(tmp_path / "orbit").origin) is IterativeRefinement
    found = answer(capsys, *WORDS, "--energy", "0.01", "--digits", "20")
    assert (found["energy"], found["warnings"]) == ("0.01", [])
    wave = answer(capsys, *WORDS, "--ends", "periodic", "--energy", "0.01", "--digits", "20")
    assert (wave["energy"], wave["digits"], wave["ends"]) == ("0.01", 20, "periodic")


def test_multipliers(capsys):
    found = answer(capsys, *WORDS, "--amplitudes", "0.4", "--multipliers")
    expected = floquet(symfpu.torus(CHAIN, (1,), amplitudes={1: "0.4"}))
    values = np.array([complex(float(x), float(y)) for x, y in found["multipliers"]])
    assert (values == expected.multipliers).all()
    assert (found["stable"], found["instabilities"], found["largest_multiplier"]) == (True, {}, 1.0)


def test_an_unstable_breather_says_how(capsys):
    text = shown(capsys, *split("solve -N 6 --beta 1 --seeds 5 --amplitudes 1 --multipliers"), quiet=False)
    assert "unstable: 1 real > 0, the largest |multiplier| 1.201" in text
    assert "seed 5" in text
