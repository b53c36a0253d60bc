"""The option --ends: what it makes, what takes the file of a ring, and what refuses it in one line."""

import json

import numpy as np
import pytest

from symfpu import Chain, travelling_torus, travelling_waves
from symfpu.cli.main import main
from tests.tolerances import COARSE_STEP_ERROR, PROMISED_RESIDUAL

SOLVE = ["solve", "-N", "16", "--ends", "periodic"]
WAVES = [*SOLVE, "--beta", "1", "--seeds=1,-3", "--omega", "0.3904,1.1116", "--order", "4"]


def run(capsys, *arguments):
    code = main([str(argument) for argument in arguments])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


@pytest.fixture
def saved(capsys, tmp_path):
    file = tmp_path / "ring.symfpu"
    code, _, err = run(capsys, *WAVES, "-o", file)
    assert (code, err.count("symfpu: ")) == (0, 0)
    return file


def made():
    return travelling_torus(travelling_waves(Chain(16, beta=1, ends="periodic"), (1, -3), ("0.3904", "1.1116"), 4))


def test_solve_gives_amplitudes_energy_residual_and_a_verdict(capsys):
    toda = ["--potential", "toda:1/2", "--seeds", "1,3", "--omega", "0.392,1.1125", "--order", "8"]
    code, out, err = run(capsys, *SOLVE, *toda)
    assert (code, err) == (0, "")
    for word in ("verdict: undecided", "toda:0.5, ends=periodic", "amplitude", "energy H", "residual", "radius of convergence"):
        assert word in out


def test_the_json_of_a_ring_names_its_ends(capsys):
    record = json.loads(run(capsys, *WAVES, "--json")[1])
    assert (record["ends"], record["kind"], record["verdict"]) == ("periodic", "RingTorus", "converged")
    assert record["amplitudes"] == {str(q): repr(float(a)) for q, a in made().amplitudes.items()}
    fixed = json.loads(run(capsys, "solve", "-N", "8", "--beta", "1", "--seeds", "1", "--omega", "0.391", "--order", "2", "--json")[1])
    assert "ends" not in fixed


@pytest.mark.long
def test_show_orbit_and_gali_take_the_file(capsys, saved, tmp_path):
    code, out, _ = run(capsys, "show", saved)
    assert code == 0
    assert out.startswith("verdict: converged")
    record = json.loads(run(capsys, "orbit", saved, "--time", 100, "-o", tmp_path / "orbit.npz", "--json")[1])
    assert record["modes"] == list(Chain(16, beta=1, ends="periodic").mode_numbers)
    assert record["largest_deviation"] < COARSE_STEP_ERROR
    with np.load(tmp_path / "orbit.npz") as arrays:
        assert (arrays["Q"].dtype, arrays["E"].dtype) == (complex, float)
    code, out, _ = run(capsys, "orbit", saved, "--time", 20)
    assert "\n-3    " in out
    run(capsys, "orbit", saved, "--time", 20, "-o", tmp_path / "orbit.csv")
    assert (tmp_path / "orbit.csv").read_text().startswith("t,H,E-7,E-6")
    record = json.loads(run(capsys, "gali", saved, "--time", 200, "--vectors", 2, "--json")[1])
    assert record["ends"] == "periodic"


def test_refine_takes_the_file_and_show_what_it_made(capsys, saved, tmp_path):
    kept = tmp_path / "refined.symfpu"
    record = json.loads(run(capsys, "refine", saved, "-o", kept, "--json")[1])
    assert (record["ends"], record["verdict"], record["warnings"]) == ("periodic", "torus", [])
    assert record["residual"] < PROMISED_RESIDUAL
    assert record["energy_error"] < PROMISED_RESIDUAL
    code, out, err = run(capsys, "show", kept)
    assert (code, err) == (0, "")
    for word in ("verdict: torus", "ends               periodic", "seed -3", "smallest divisors"):
        assert word in out


def test_breather_finds_a_wave_with_its_multipliers(capsys, tmp_path):
    kept = tmp_path / "wave.symfpu"
    words = ["breather", "-N", 5, "--potential", "toda:1/2", "--ends", "periodic", "--seed=-2", "--amplitude", "0.5", "--multipliers"]
    record = json.loads(run(capsys, *words, "-o", kept, "--json")[1])
    assert (record["ends"], record["seeds"], record["stable"], record["kind"]) == ("periodic", [-2], True, "RefinedRingTorus")
    assert record["amplitudes"] == {"-2": "0.5"}
    code, out, _ = run(capsys, "show", kept)
    assert (code, "seed -2" in out) == (0, True)


def test_family_follows_waves(capsys):
    words = ["family", "-N", 8, "--beta", 1, "--ends", "periodic", "--seeds=1,-3", "--amplitude-ratio", "1,2"]
    code, out, _ = run(capsys, *words, "--from-energy", "0.01", "--to-energy", "0.012", "--json")
    record = json.loads(out)
    assert (code, record["ends"], record["seeds"]) == (0, "periodic", [-3, 1])
    assert [float(m["amplitudes"]["-3"]) / float(m["amplitudes"]["1"]) for m in record["members"]] == pytest.approx(
        [2] * len(record["members"])
    )


def test_propagate(capsys):
    code, out, _ = run(capsys, "propagate", "-N", 16, "--ends", "periodic", "--seeds=1,-3", "--order", 2)
    assert (code, out) == (0, "D_0 = {1, 3}\nD_1 = {2, 4, 6}\nD_2 = {5, 7}\n")
    record = json.loads(run(capsys, "propagate", "-N", 16, "--ends", "periodic", "--seeds=-3,1", "--order", 1, "--json")[1])
    assert (record["ends"], record["seeds"]) == ("periodic", [-3, 1])


REFUSED = {
    "export FILE --lang c -o exported.c": "docs/chains.md",
    "breather -N 8 --seed 1 --amplitude 0.1 --alpha 1 --ends periodic --digits 30": "docs/chains.md",
    "family -N 8 --seeds 1 --to-energy 0.1 --alpha 1 --ends periodic --method appendix-a --order 4": "docs/chains.md",
    "prove -N 8 --seeds 1 --order 2 --ends periodic": "--ends",
    "sweep --order 1 --ends periodic": "--ends",
    "solve -N 8 --seeds 1 --order 2 --alpha 1 --omega 0.77 --ends round": "'fixed' or 'periodic'",
    "solve -N 8 --seeds 1 --order 2 --alpha 1 --omega 0.77 --ends periodic --digits 30": "docs/chains.md",
    "solve -N 8 --seeds 5 --order 2 --alpha 1 --omega 0.77 --ends periodic": "-3..4 without 0",
    "solve -N 8 --seeds=-1 --order 2 --alpha 1 --omega 0.77": "1..7",
    "propagate -N 8 --seeds 0 --order 2 --ends periodic": "-3..4 without 0",
    "orbit FILE --time 10 --scheme aba864_modes": "not for ends='periodic'",
}


@pytest.mark.parametrize("typed", REFUSED)
def test_what_does_not_take_a_ring_says_so_in_one_line_and_code_two(capsys, typed, saved):
    words = [str(saved) if word == "FILE" else word for word in typed.split()]
    code, out, err = run(capsys, *words)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert REFUSED[typed] in err


def test_a_resonance_is_named_with_its_way_out(capsys):
    code, _, err = run(capsys, *SOLVE, "--beta", "1", "--seeds=4,-4", "--omega", "1.42,1.42", "--order", "2")
    assert (code, err.count("\n")) == (2, 1)
    assert "resonance" in err
