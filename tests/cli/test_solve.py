"""symfpu solve from a wish: an energy, shares of it, amplitudes; what is said of the shares; refusals."""

import json

import pytest

from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.tori.at_energy import torus_at_energy
from symfpu.tori.frequencies import torus_at_amplitudes
from tests.tolerances import FIXED_ENERGY

CHAIN = Chain(4, alpha="0.3")
WORDS = ["solve", "-N", "4", "--alpha", "0.3", "--seeds", "2,1", "--order", "2"]


def run(capsys, *argv):
    code = main([*WORDS, *argv])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def record(capsys, *argv):
    code, out, _ = run(capsys, *argv, "--json")
    assert code == 0
    return json.loads(out)


def by_seed(values):
    return {str(q): repr(float(value)) for q, value in values.items()}


@pytest.mark.parametrize("harmonic", [False, pytest.param(True, marks=pytest.mark.long)])
def test_an_energy_is_met_with_equal_shares(capsys, harmonic):
    found = record(capsys, "--energy", "0.01", *["--harmonic"] * harmonic)
    torus = torus_at_energy(CHAIN, (1, 2), "0.01", harmonic=harmonic, order=2)
    assert float(found["harmonic_energy" if harmonic else "energy"]) == pytest.approx(0.01, rel=FIXED_ENERGY)
    assert found["amplitudes"] == by_seed(torus.amplitudes)
    assert found["energy_shares"] == {"1": "1", "2": "1"}


def test_shares_are_by_seed_as_the_seeds_are_typed(capsys):
    found = record(capsys, "--energy", "0.01", "--shares", "3,1")
    torus = torus_at_energy(CHAIN, (1, 2), "0.01", order=2, energy_ratio={2: 3, 1: 1})
    assert found["amplitudes"] == by_seed(torus.amplitudes)
    assert found["energy_shares"] == {"1": "1", "2": "3"}


def test_amplitudes_are_by_seed_as_the_seeds_are_typed(capsys):
    found = record(capsys, "--amplitudes", "0.2,0.1")
    assert found["amplitudes"] == {"1": "0.1", "2": "0.2"}
    torus = torus_at_amplitudes(CHAIN, {1: "0.1", 2: "0.2"}, 2)
    assert [float(w) for w in found["frequencies"].values()] == [float(w) for w in torus.frequencies]
    assert "energy_shares" not in found


def test_the_text_says_how_the_energy_is_shared(capsys):
    _, out, _ = run(capsys, "--energy", "0.01")
    assert "energy shared      equal time averages of E_q of the seeds; --shares S,S,... for others" in out.splitlines()
    _, out, _ = run(capsys, "--energy", "0.01", "--shares", "3,1")
    assert "energy shared      time averages of E_q of the seeds as 1: 1, 2: 3" in out.splitlines()
    _, out, _ = run(capsys, "--amplitudes", "0.2,0.1")
    assert "energy shared" not in out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "exactly one of --omega, --energy and --amplitudes; give one of them"),
        (["--energy", "1", "--omega", "1,2"], "leave the others out"),
        (["--omega", "0.7,1.4", "--shares", "1,1"], "shares = '1,1'"),
        (["--amplitudes", "0.1,0.1", "--harmonic"], "harmonic = True"),
        (["--energy", "1", "--shares", "1"], "shares = '1': allowed is a number for each of the seeds (2, 1)"),
        (["--energy", "-1"], "energy = '-1'"),
        (["--energy", "1", "--ends", "periodic"], "give --omega and -o FILE, then symfpu refine FILE --energy E"),
        (["--amplitudes", "1,1", "--ends", "periodic"], "give --omega and -o FILE, then symfpu refine FILE --amplitudes A,A,..."),
        (["--omega", "1,2", "--digits", "30", "--ends", "periodic"], "digits = 30: allowed is none with --ends periodic"),
    ],
)
def test_refusals(capsys, words, said):
    code, out, err = run(capsys, *words)
    assert (code, out) == (2, "")
    assert said in err
