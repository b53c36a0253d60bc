"""The option --potential: what it makes, what it says of bad input, and that all verbs with couplings have it."""

import json

import pytest

from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes

BREATHER = ["-N", "8", "--seeds", "1", "--omega", "0.392", "--order", "4"]


def run(capsys, *arguments):
    code = main(list(arguments))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


@pytest.fixture
def saved(capsys, tmp_path):
    file = str(tmp_path / "torus.symfpu")
    code, _, err = run(capsys, "solve", *BREATHER, "--potential", "toda:1/2", "-o", file)
    assert (code, err.count("symfpu: ")) == (0, 0)
    return file


def test_solve_with_a_potential_is_the_series_of_that_chain(capsys):
    _, out, _ = run(capsys, "solve", *BREATHER, "--potential", "lj:12,6", "--json")
    record = json.loads(out)
    torus = solve_amplitudes(lindstedt(Chain(8, potential="lj:12,6"), (1,), ("0.392",), 4))
    assert record["potential"] == "lennard_jones:12,6"
    assert "alpha" not in record
    assert record["amplitudes"] == {"1": repr(float(torus.amplitudes[1]))}


def test_a_polynomial_of_fpu_is_the_chain_of_its_couplings(capsys):
    by_potential = run(capsys, "solve", *BREATHER, "--potential", "poly:0.33,1/5", "--json")
    by_couplings = run(capsys, "solve", *BREATHER, "--alpha", "0.33", "--beta", "1/5", "--json")
    assert by_potential == by_couplings


def test_show_and_gali_name_the_potential(capsys, saved):
    code, out, _ = run(capsys, "show", saved)
    assert code == 0
    assert "potential=toda(0.5)" in out
    assert json.loads(run(capsys, "show", saved, "--json")[1])["potential"] == "toda:0.5"


@pytest.mark.parametrize("verb", ["solve", "breather", "family", "propagate", "prove", "sweep"])
def test_verbs_with_couplings_show_how_a_potential_is_typed(capsys, verb):
    code, out, _ = run(capsys, verb, "--help")
    assert code == 0
    assert "--potential" in out
    assert "toda:0.33" in out


BAD = {
    "toda:1/2 --alpha 0.33": "alpha, beta",
    "toda:1/2 --beta 1": "alpha, beta",
    "toda": "potential",
    "toda:1,2": "potential",
    "toda:x": "a",
    "toda:0": "a",
    "lj:6,12": "m, n",
    "poly:0,0": "coefficients",
    "spring:1": "potential",
    ":": "potential",
}


@pytest.mark.parametrize("typed", BAD)
def test_what_is_no_potential_is_one_line_and_code_two(capsys, typed):
    code, out, err = run(capsys, "solve", *BREATHER, "--potential", *typed.split())
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert err.startswith(f"symfpu: {BAD[typed]} = ")
