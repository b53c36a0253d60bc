"""The option --ends: what it makes, what takes the file of a ring, and what refuses it in one line."""

from shlex import split

import numpy as np
import pytest

from symfpu import Chain
from tests.cli.running import answer, run, shown
from tests.tolerances import COARSE_STEP_ERROR, PROMISED_RESIDUAL

SOLVE = ["solve", "-N", "16", "--ends", "periodic"]
WAVES = [*SOLVE, "--beta", "1", "--seeds=1,-3", "--omega", "0.3904,1.1116", "--order", "4"]


@pytest.fixture
def saved(capsys, tmp_path):
    file = tmp_path / "ring.symfpu"
    code, _, err = run(capsys, *WAVES, "-o", file)
    assert (code, err.count("symfpu: ")) == (0, 0)
    return file


@pytest.mark.long
def test_show_orbit_and_gali_take_the_file(capsys, saved, tmp_path):
    out = shown(capsys, "show", saved)
    assert out.startswith("verdict: converged")
    record = answer(capsys, "orbit", saved, "--time", 100, "-o", tmp_path / "orbit.npz")
    assert record["modes"] == list(Chain(16, beta=1, ends="periodic").mode_numbers)
    assert record["largest_deviation"] < COARSE_STEP_ERROR
    with np.load(tmp_path / "orbit.npz") as arrays:
        assert (arrays["Q"].dtype, arrays["E"].dtype) == (complex, float)
    assert "\n-3    " in shown(capsys, "orbit", saved, "--time", 20)
    run(capsys, "orbit", saved, "--time", 20, "-o", tmp_path / "orbit.csv")
    assert (tmp_path / "orbit.csv").read_text().startswith("t,H,E-7,E-6")
    record = answer(capsys, "gali", saved, "--time", 200, "--vectors", 2)
    assert record["ends"] == "periodic"


def test_refine_takes_the_file_and_show_what_it_made(capsys, saved, tmp_path):
    kept = tmp_path / "refined.symfpu"
    record = answer(capsys, "refine", saved, "-o", kept)
    assert (record["ends"], record["verdict"], record["warnings"]) == ("periodic", "torus", [])
    assert record["residual"] < PROMISED_RESIDUAL
    assert record["energy_error"] < PROMISED_RESIDUAL
    out = shown(capsys, "show", kept)
    for word in ("verdict: torus", "ends='periodic'", "seed -3", "smallest divisors"):
        assert word in out


def test_breather_finds_a_wave_with_its_multipliers(capsys, tmp_path):
    kept = tmp_path / "wave.symfpu"
    words = split("solve -N 5 --potential toda:1/2 --ends periodic --seeds=-2 --amplitudes 0.5 --multipliers")
    record = answer(capsys, *words, "-o", kept)
    assert (record["ends"], record["seeds"], record["stable"], record["origin"]) == ("periodic", [-2], True, "Newton")
    assert record["amplitudes"] == {"-2": "0.5"}
    assert "seed -2" in shown(capsys, "show", kept)


def test_family_follows_waves(capsys):
    words = "family -N 8 --beta 1 --ends periodic --seeds=1,-3 --amplitude-ratio 1,2 --from-energy 0.01 --to-energy 0.012"
    record = answer(capsys, *words.split())
    assert (record["ends"], record["seeds"]) == ("periodic", [-3, 1])
    for member in record["members"]:
        assert float(member["amplitudes"]["-3"]) == pytest.approx(2 * float(member["amplitudes"]["1"]))


def test_propagate(capsys):
    out = shown(capsys, "propagate", "-N", 16, "--ends", "periodic", "--seeds=1,-3", "--order", 2)
    assert out == "D_0 = {1, 3}\nD_1 = {2, 4, 6}\nD_2 = {5, 7}\n"
    record = answer(capsys, "propagate", "-N", 16, "--ends", "periodic", "--seeds=-3,1", "--order", 1)
    assert (record["ends"], record["seeds"]) == ("periodic", [-3, 1])
