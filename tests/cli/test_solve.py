"""symfpu solve from a wish: an energy, shares of it, amplitudes; what is said of the shares; any potential."""

from shlex import split

import pytest

import symfpu
from symfpu import Chain, lindstedt, solve_amplitudes
from tests.cli.running import answer, refusal, run, shown
from tests.tolerances import FIXED_ENERGY

CHAIN = Chain(4, alpha="0.3")
WORDS = split("solve -N 4 --alpha 0.3 --seeds 2,1 --order 2")


def record(capsys, *argv):
    return answer(capsys, *WORDS, *argv)


def by_seed(values):
    return {str(q): repr(float(value)) for q, value in values.items()}


@pytest.mark.parametrize("harmonic", [False, pytest.param(True, marks=pytest.mark.long)])
def test_an_energy_is_met_with_equal_shares(capsys, harmonic):
    found = record(capsys, "--energy", "0.01", *["--harmonic"] * harmonic)
    torus = symfpu.torus(CHAIN, (1, 2), energy=symfpu.Energy("0.01", harmonic=harmonic), method="series", order=2)
    assert float(found["harmonic_energy" if harmonic else "energy"]) == pytest.approx(0.01, rel=FIXED_ENERGY)
    assert found["amplitudes"] == by_seed(torus.amplitudes)
    assert found["energy_shares"] == {"1": "1", "2": "1"}


def test_shares_and_amplitudes_are_by_seed_as_the_seeds_are_typed(capsys):
    found = record(capsys, "--energy", "0.01", "--shares", "3,1")
    torus = symfpu.torus(CHAIN, (1, 2), energy=symfpu.Energy("0.01", energy_ratio={2: 3, 1: 1}), method="series", order=2)
    assert found["amplitudes"] == by_seed(torus.amplitudes)
    assert found["energy_shares"] == {"1": "1", "2": "3"}
    found = record(capsys, "--amplitudes", "0.2,0.1")
    assert found["amplitudes"] == {"1": "0.1", "2": "0.2"}
    torus = symfpu.torus(CHAIN, (1, 2), amplitudes={1: "0.1", 2: "0.2"}, method="series", order=2)
    assert [float(w) for w in found["frequencies"].values()] == [float(w) for w in torus.frequencies]
    assert "energy_shares" not in found


def test_the_text_says_how_the_energy_is_shared(capsys):
    out = shown(capsys, *WORDS, "--energy", "0.01", quiet=False)
    assert "energy shared      equal time averages of E_q of the seeds; --shares S,S,... for others" in out.splitlines()
    out = shown(capsys, *WORDS, "--energy", "0.01", "--shares", "3,1", quiet=False)
    assert "energy shared      time averages of E_q of the seeds as 1: 1, 2: 3" in out.splitlines()
    out = shown(capsys, *WORDS, "--amplitudes", "0.2,0.1", quiet=False)
    assert "energy shared" not in out


def test_without_an_order_it_solves_the_equations_of_motion(capsys, tmp_path):
    words = [*split("solve -N 4 --alpha 0.3 --seeds 2,1 --energy 0.01"), "-o", str(tmp_path / "torus.symfpu")]
    found = answer(capsys, *words)
    torus = symfpu.torus(CHAIN, (1, 2), energy="0.01")
    assert (found["verdict"], found["amplitudes"]) == ("torus", by_seed(torus.amplitudes))
    assert symfpu.load(tmp_path / "torus.symfpu").amplitudes == torus.amplitudes
    assert "verdict: torus" in shown(capsys, *words[:-2], quiet=False)


def test_orders_of_a_series_want_a_series(capsys):
    for option in ("--frequency-order", "--coordinate-order"):
        assert "none without --order" in refusal(capsys, *split("solve -N 4 --alpha 0.3 --seeds 1 --energy 0.01"), option, "2")


def test_a_verdict_that_is_not_converged_says_what_to_do_next(capsys):
    assert "without --order: the torus itself" in shown(capsys, *WORDS, "--energy", "0.01", quiet=False)


BREATHER = split("solve -N 8 --seeds 1 --omega 0.392 --order 4")


def test_solve_with_a_potential_is_the_series_of_that_chain(capsys):
    found = answer(capsys, *BREATHER, "--potential", "lj:12,6", quiet=False)
    torus = solve_amplitudes(lindstedt(Chain(8, potential="lj:12,6"), (1,), ("0.392",), 4))
    assert found["potential"] == "lennard_jones:12,6"
    assert "alpha" not in found
    assert found["amplitudes"] == {"1": repr(float(torus.amplitudes[1]))}


def test_a_polynomial_of_fpu_is_the_chain_of_its_couplings(capsys):
    by_potential = run(capsys, *BREATHER, "--potential", "poly:0.33,1/5", "--json")
    assert by_potential == run(capsys, *BREATHER, "--alpha", "0.33", "--beta", "1/5", "--json")
