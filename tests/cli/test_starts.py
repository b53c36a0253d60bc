"""symfpu orbit and gali from a state of one's own: files, packets, random states; refusals."""

import json

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.starts import packet_state, particle_state, random_state

CHAINS = {
    "fixed": (Chain(4, alpha="0.3"), ["-N", "4", "--alpha", "0.3"]),
    "ring": (Chain(4, potential="toda:1/2", ends="periodic"), ["-N", "4", "--potential", "toda:1/2", "--ends", "periodic"]),
}
PACKET = ["--packet", "1,2", "--energy", "0.1"]


def run(capsys, *argv):
    code = main(list(argv))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


@pytest.fixture(params=["fixed", pytest.param("ring", marks=pytest.mark.long)])
def case(request, tmp_path):
    """A chain as typed, and the starts by name, each with its words and its state."""
    chain, words = CHAINS[request.param]
    n = chain.kind_of_ends.particles
    x, p = np.linspace(0.1, 0.2, n), np.zeros(n)
    file = tmp_path / "state.csv"
    file.write_text("x,p\n" + "".join(f"{a!r},0\n" for a in x.tolist()))
    starts = {
        "state": (["--state", str(file)], particle_state(chain, x, p)),
        "packet": (PACKET, packet_state(chain, (1, 2), "0.1")),
        "random": (["--random", "3", "--energy", "0.1"], random_state(chain, "0.1", 3)),
    }
    return chain, words, starts


def test_orbits_start_there(capsys, case):
    chain, words, starts = case
    for kind, (typed, state) in starts.items():
        code, out, err = run(capsys, "orbit", "--time", "10", *words, *typed, "--json")
        record = json.loads(out)
        assert (code, err) == (0, "")
        orbit = integrate(chain, *state, 10, step=0.2, averages=True)
        assert record["energy"] == repr(float(orbit.energies[0]))
        assert record["average_spectrum"] == pytest.approx(orbit.averages[-1].tolist())
        assert record["start"]["kind"] == kind
        assert record["largest_deviation"] is record["torus_average_spectrum"] is None
        assert record["N"] == 4


def test_the_text_compares_with_no_torus(capsys):
    _, out, _ = run(capsys, "orbit", "--time", "10", *CHAINS["fixed"][1], *PACKET)
    assert "torus" not in out
    assert "mode  time average of E_q" in out.splitlines()


@pytest.mark.long
def test_alignment_indices_start_there(capsys, case):
    _, words, starts = case
    for kind, (typed, _) in starts.items():
        code, out, err = run(capsys, "gali", "--time", "100", "--samples", "64", *words, *typed, "--json")
        record = json.loads(out)
        assert (code, record["seeds"], record["start"]["kind"]) == (0, None, kind), err


@pytest.mark.parametrize("verb", ["orbit", "gali"])
@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "exactly one of FILE, --state, --packet and --random; give one of them"),
        (["file", *PACKET], "leave the others out"),
        ([*PACKET, "--random", "1"], "leave the others out"),
        (["file", "-N", "8"], "N = '8': allowed is nothing beside FILE"),
        (["file", "--energy", "1"], "energy = '1': allowed is nothing beside FILE"),
        (["--packet", "1", "-N", "4", "--alpha", "1"], "give --energy E"),
        (["--state", "s", "--energy", "1", "-N", "4"], "nothing beside --state"),
        (PACKET, "give -N, and --alpha, --beta or --potential"),
        (["--random", "x", "--energy", "1", "-N", "4", "--alpha", "1"], "random = 'x'"),
        (["--packet", "1,9", "--energy", "1", "-N", "4", "--alpha", "1"], "seeds"),
        (["--state", "none.txt", "-N", "4", "--alpha", "1"], "none.txt: No such file"),
    ],
)
def test_refusals(capsys, verb, words, said):
    code, out, err = run(capsys, verb, "--time", "100", *words)
    assert (code, out) == (2, "")
    assert said in err
