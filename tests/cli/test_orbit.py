"""The verb orbit: what it prints and writes, and what it refuses."""

import csv
import json

import numpy as np
import pytest

from symfpu.bundles.bundle import save
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from tests.tolerances import ENERGY_SHORT_STEPS, ORBIT


@pytest.fixture(scope="module")
def torus():
    return refine(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3902",), 6)))


@pytest.fixture(scope="module")
def saved(torus, tmp_path_factory):
    return str(save(tmp_path_factory.mktemp("orbit") / "torus.symfpu", torus))


def run(capsys, *argv):
    code = main(list(argv))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_json_says_how_far_the_orbit_stays_from_the_torus(capsys, saved, torus):
    code, out, err = run(capsys, "orbit", saved, "--time", "1e3", "--json")
    record = json.loads(out)
    assert (code, err) == (0, "")
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
    code, out, _ = run(capsys, "orbit", str(file), "--time", "1000", "--json")
    assert code == 0
    assert 1e-4 < json.loads(out)["largest_deviation"] < 1


def test_text_names_the_largest_modes_first(capsys, saved):
    code, out, _ = run(capsys, "orbit", saved, "--time", "50", "--scheme", "aba864_modes", "--samples", "20")
    lines = out.splitlines()
    assert code == 0
    assert lines[0].startswith("Orbit(N=8, alpha=0.3, T=50, aba864_modes, step 0.2, ")
    assert lines[1].startswith("energy error ")
    assert lines[2].startswith("off the torus ")
    assert [line.split()[0] for line in lines[3:6]] == ["mode", "1", "2"]


def test_samples_are_written_as_csv_and_npz(capsys, saved, tmp_path):
    table, arrays = tmp_path / "orbit.csv", tmp_path / "orbit.npz"
    for target in (table, arrays):
        code, out, _ = run(capsys, "orbit", saved, "--time", "50", "--samples", "20", "-o", str(target))
        assert code == 0
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


def test_a_checkpoint_is_taken_up_and_refused_for_another_run(capsys, saved, tmp_path):
    options = ("orbit", saved, "--checkpoint", str(tmp_path / "run"), "--samples", "9", "--json")
    first, second = (json.loads(run(capsys, *options, "--time", "50")[1]) for _ in range(2))
    assert first["energy_error"] == second["energy_error"]
    longer = json.loads(run(capsys, *options, "--time", "60")[1])
    assert (longer["time"], longer["energy"]) == (60, first["energy"])
    code, out, err = run(capsys, *options, "--time", "50")
    assert (code, out) == (2, "")
    assert "a checkpoint of the same orbit (steps is 300 in it, 250 here)" in err


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        (("--time", "soon"), 2, "time = 'soon'"),
        (("--time", "nan"), 2, "T = nan"),
        (("--time", "10", "--step", "0"), 2, "step = 0.0"),
        (("--time", "10", "--scheme", "euler"), 2, "scheme = 'euler'"),
        (("--time", "10", "--samples", "few"), 2, "samples = 'few'"),
        (("--time", "10", "-o", "orbit.txt"), 2, "ends in .csv or .npz"),
        (("--time", "10", "--step", "2"), 1, "a step of 2 of kahan_li8 is unstable at time 0 in mode "),
    ],
)
def test_bad_input_is_one_line(options, code, said, capsys, saved):
    found, out, err = run(capsys, "orbit", saved, *options)
    assert (found, out) == (code, "")
    assert said in err
    assert len(err.splitlines()) == 1


def test_a_file_without_a_torus_is_refused(capsys, tmp_path):
    file = save(tmp_path / "series", lindstedt(Chain(8, beta="0.1"), (3,), ("1.12",), 2))
    code, _, err = run(capsys, "orbit", str(file), "--time", "10")
    assert code == 2
    assert "a file with a torus or a breather in it" in err
