"""Results as text: no digit is lost, and every number of a row is there."""

import csv
import json

import numpy as np
import pytest

from symfpu.amplitudes import solve_amplitudes
from symfpu.chain import Chain
from symfpu.errors import InputError
from symfpu.lindstedt import lindstedt
from symfpu.report import markdown_table, output_folder, torus_record, write_figure1_csv
from symfpu.reproduction import Figure1


@pytest.fixture(scope="module")
def torus():
    return solve_amplitudes(lindstedt(Chain(8, alpha="1/3", beta="0.1"), (1, 2), ("0.3905", "0.7663"), 4))


def test_a_record_survives_json_without_losing_a_digit(torus):
    record = json.loads(json.dumps(torus_record(torus)))
    assert {int(q): float(a) for q, a in record["amplitudes"].items()} == torus.amplitudes
    assert float(record["energy"]) == float(torus.energy())
    assert float(record["harmonic_energy"]) == torus.harmonic_energies().sum()
    assert float(record["average_harmonic_energy"]) == torus.average_spectrum().sum()
    assert {int(k): tuple(map(float, values)) for k, values in record["history"].items()} == torus.history
    assert (record["alpha"], record["beta"], record["seeds"]) == ("1/3", "0.1", [1, 2])
    assert record["residual"] == float(f"{torus.residual():.15g}")
    assert record["warnings"] == list(torus.warnings)
    assert len(record["smallest_divisors"]) == len(torus.series.smallest_divisors)


def test_markdown_table():
    assert markdown_table(["a", "b"], [["1", "2"]]) == "| a | b |\n| --- | --- |\n| 1 | 2 |"


def test_output_folder_is_made_with_its_parents(tmp_path):
    assert output_folder(tmp_path / "a" / "b").is_dir()
    assert output_folder(tmp_path / "a" / "b").is_dir()


def test_a_file_is_no_output_folder(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="output"):
        output_folder(tmp_path / "file")


def figure_of(torus):
    times = np.linspace(0.0, 3.0, 4)
    error = np.array([0.0, 1e-3, -2e-3, 0.1])
    return Figure1(
        torus=torus,
        residuals={2: 0.5, 4: 0.25},
        spectra={4: np.arange(1.0, 8.0)},
        differences={2: (0.125, 0.0625)},
        sums=(np.array([1.0, 0.5]), np.array([1.0, 0.25])),
        times=times,
        errors={4: (error / 10, error)},
    )


def test_csv_files_hold_the_data_of_the_panels(torus, tmp_path):
    data = figure_of(torus)
    tables = {path.stem: list(csv.reader(path.read_text().splitlines())) for path in write_figure1_csv(data, tmp_path)}
    assert set(tables) == {"fig1a", "fig1b", "fig1c", "fig1d"}
    assert tables["fig1a"][1:] == [[str(q), str(float(q))] for q in range(1, 8)]
    assert tables["fig1b"] == [["k", "delta_A1", "delta_A2"], ["2", "0.125", "0.0625"]]
    assert tables["fig1c"][1:] == [["0", "1.0", "1.0"], ["1", "0.5", "0.25"]]
    assert [float(row[0]) for row in tables["fig1d"][1:]] == data.times.tolist()
    assert [float(row[2]) for row in tables["fig1d"][1:]] == data.errors[4][1].tolist()


def test_json_numbers_have_at_most_fifteen_digits(torus):
    """More digits are written as strings, so that no reader rounds them."""
    record = json.loads(json.dumps(torus_record(torus)))

    def numbers(value):
        if isinstance(value, dict | list):
            for inner in value.values() if isinstance(value, dict) else value:
                yield from numbers(inner)
        elif isinstance(value, float):
            yield value

    found = list(numbers(record))
    assert len(found) > 5
    assert all(float(f"{value:.15g}") == value for value in found)
