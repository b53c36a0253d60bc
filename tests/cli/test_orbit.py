"""The verb orbit, and orbits and indices from a state of one's own: what they print, write and refuse."""

import csv
from shlex import split

import numpy as np
import pytest

from symfpu import Chain, integrate, lindstedt, packet_state, particle_state, random_state, refine, save, solve_amplitudes
from tests.cli.running import answer, shown
from tests.tolerances import ENERGY_SHORT_STEPS, ORBIT


@pytest.fixture(scope="module")
def torus():
    return refine(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3902",), 6)))


@pytest.fixture(scope="module")
def saved(torus, tmp_path_factory):
    return str(save(tmp_path_factory.mktemp("orbit") / "torus.symfpu", torus))


def test_json_says_how_far_the_orbit_stays_from_the_torus(capsys, saved, torus):
    record = answer(capsys, "orbit", saved, "--time", "1e3")
    assert record["energy"] == repr(float(torus.energy()))
    assert (record["time"], record["step"], record["scheme"]) == (1000.0, 0.2, "kahan_li8")
    assert record["energy_error"] < ENERGY_SHORT_STEPS
    assert 0 < record["largest_deviation"] < ORBIT
    assert record["torus_average_spectrum"] == pytest.approx(torus.average_spectrum().tolist())
    assert len(record["average_spectrum"]) == 7
    # the trapezoid rule with looks at 0.4: 0.4^2/12 of dE/dt, over the time; dE/dt is no larger than E
    step, time = 0.4, 1000.0
    assert record["average_spectrum"][:2] == pytest.approx(torus.average_spectrum(time)[:2].tolist(), rel=step**2 / 12 / time)


def test_a_series_that_is_cut_early_leaves_its_orbit(capsys, tmp_path):
    file = save(tmp_path / "torus", solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.393",), 2)))
    assert 1e-4 < answer(capsys, "orbit", file, "--time", "1000")["largest_deviation"] < 1


def test_samples_are_written_as_csv_and_npz(capsys, saved, tmp_path):
    table, arrays = tmp_path / "orbit.csv", tmp_path / "orbit.npz"
    for target in (table, arrays):
        out = shown(capsys, "orbit", saved, "--time", "50", "--samples", "20", "-o", str(target))
        assert out.splitlines()[-1] == f"written: {target}"
    with table.open(newline="") as stream:
        header, *rows = csv.reader(stream)
    assert header == ["t", "H", *(f"E{q}" for q in range(1, 8))]
    held = np.load(arrays)
    values = np.array(rows, dtype=float)
    assert np.array_equal(values, np.column_stack([held["t"], held["H"], held["E"]]))
    assert held["Q"].shape == held["P"].shape == (len(rows), 7)
    assert values[-1, 0] == 50
    assert sorted(path.name for path in tmp_path.iterdir()) == ["orbit.csv", "orbit.npz"]


CHAINS = {
    "fixed": (Chain(4, alpha="0.3"), ["-N", "4", "--alpha", "0.3"]),
    "ring": (Chain(4, potential="toda:1/2", ends="periodic"), split("-N 4 --potential toda:1/2 --ends periodic")),
}
PACKET = ["--packet", "1,2", "--energy", "0.1"]


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
        record = answer(capsys, "orbit", "--time", "10", *words, *typed)
        orbit = integrate(chain, *state, 10, step=0.2, averages=True)
        assert record["energy"] == repr(float(orbit.energies[0]))
        assert record["average_spectrum"] == pytest.approx(orbit.averages[-1].tolist())
        assert record["start"]["kind"] == kind
        assert record["largest_deviation"] is record["torus_average_spectrum"] is None
        assert record["N"] == 4


@pytest.mark.long
def test_alignment_indices_start_there(capsys, case):
    _, words, starts = case
    for kind, (typed, _) in starts.items():
        record = answer(capsys, "gali", "--time", "100", "--samples", "64", *words, *typed, quiet=False)
        assert (record["seeds"], record["start"]["kind"]) == (None, kind)
