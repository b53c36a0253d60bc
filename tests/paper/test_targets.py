"""Targets of `symfpu reproduce`: pages, data files and pictures of the convergence study, from studies written by hand."""

import csv
import json
import math
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu import Chain, Family, Member, assess, lindstedt, solve_amplitudes
from symfpu.breathers.balance import orbit_of
from symfpu.cli.main import main
from symfpu.paper.claims_page import figure_record, write_panel_csv
from symfpu.paper.convergence import breather_text, cancellation_text, convergence_figure
from symfpu.paper.convergence_fig1 import CancellationStudy, Variant
from symfpu.paper.convergence_fig9 import BreatherStudy, SchemeLimit

NAMES = ("doubles", "40 digits", "rounded amplitudes", "other frequencies")
FILES = [f"convergence-{panel}" for panel in "abcde"]


@pytest.fixture(scope="module")
def assessment():
    torus = solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3905", "0.7663"), 8))
    return assess(torus.origin.series, torus)


@pytest.fixture
def cancellation(assessment):
    orders = range(2, 31, 2)
    return CancellationStudy(
        variants=tuple(
            Variant(
                name,
                {k: (10.0**-k * scale, 3 * 10.0**-k * scale) for k in orders},
                scale * 0.5 ** np.arange(31.0),
                scale * 0.25 ** np.arange(31.0),
            )
            for scale, name in enumerate(NAMES, 1)
        ),
        coincidence=(13, -7),
        ratios={18: 9.0, 20: 1.25, 22: 1.5},
        divisor=3.125e-5,
        pole=0.625,
        residuals=0.5 ** np.arange(31.0),
        resummed={12: 1e-5, 30: 2e-7},
        amplitudes={12: ((0.25, 0.5), (0.125, 0.0625)), 30: ((0.75, 0.875), (0.375, 0.4375))},
        assessment=assessment,
    )


def orbit(omega, amplitude):
    cosines = np.zeros((3, 7))
    cosines[1, 0] = amplitude
    return orbit_of(Chain(8, alpha="0.3"), 1, Fraction(omega), cosines, iterations=5, sigma=1e-3)


@pytest.fixture
def breather(assessment):
    return BreatherStudy(
        orbit=orbit("0.3905", 1.25),
        at_printed=orbit("0.3907", 1.375),
        amplitudes={2: 1.5, 4: 1.4375, 10: 1.40625, 37: 1.3125},
        singularity=1.28125,
        spread=2e-8,
        exponent=0.5,
        assessment=assessment,
        limit=SchemeLimit(orbit("0.392", 1.0), (0.391, 0.393), (0.75, 1.125), (0.875, 1.25), one_member()),
    )


def one_member():
    """A family as far as the report asks: the energy of its last member."""
    torus = SimpleNamespace(seeds=(1,), frequencies=(Fraction("0.393"),))
    member = Member(torus, {1: 1.125}, energy=0.25, harmonic_energy=0.24, residual=1e-14)
    return Family(Chain(8, alpha="0.3"), (1,), (member,), (), "reached the energy asked for")


def rows_of(path):
    return list(csv.reader(path.read_text().splitlines()))


def test_data_files_hold_what_the_pictures_show(cancellation, breather, tmp_path):
    paths = write_panel_csv(convergence_figure(cancellation, breather), tmp_path)
    tables = {path.stem: rows_of(path) for path in paths}
    assert list(tables) == FILES
    for panel, orders, value in (("a", range(2, 31, 2), lambda k: 3 * 10.0**-k), ("b", range(31), lambda k: 0.5**k)):
        header, *rows = tables[f"convergence-{panel}"]
        assert header == ["k", *NAMES]
        assert [[float(x) for x in row] for row in rows] == [[k, *(value(k) * scale for scale in (1, 2, 3, 4))] for k in orders]
    assert tables["convergence-c"] == [["order", "truncated", "resummed"], ["12", str(0.5**12), "1e-05"], ["30", str(0.5**30), "2e-07"]]
    assert tables["convergence-e"] == [["omega", "A", "A at the end of the series"], ["0.391", "0.75", "0.875"], ["0.393", "1.125", "1.25"]]
    assert tables["convergence-d"] == [["K", "A"], ["2", "1.5"], ["4", "1.4375"], ["10", "1.40625"], ["37", "1.3125"]]


def test_pages_have_every_variant_and_order(cancellation, breather, assessment):
    page = "\n".join([*cancellation_text(cancellation), *breather_text(breather)])
    assert all(f"| {name} |" in page for name in NAMES)
    assert page.count(f"Verdict: {assessment.verdict}") == 2
    numbers = [1 / cancellation.pole, *cancellation.amplitudes[30][0], breather.orbit.energy(), *breather.amplitudes.values()]
    assert [x for x in numbers if f"{x:.5f}"[:-1] not in page] == [1.4375]  # of the amplitudes some orders are shown


def test_the_record_is_strict_json_with_the_numbers(cancellation, breather, assessment):
    record = json.loads(json.dumps(figure_record(convergence_figure(cancellation, breather)), allow_nan=False))["numbers"]
    assert (record["coincidence"], record["divisor"], record["pole"]) == ([13, -7], 3.125e-5, 0.625)
    assert record["ratios"] == {"18": 9.0, "20": 1.25, "22": 1.5}
    assert record["resummed_residuals"] == {"12": 1e-5, "30": 2e-7}
    assert record["orbit"] == {"frequency": "0.3905", "amplitude": "1.25"}
    assert float(record["orbit_energy"]) == breather.orbit.energy()
    assert record["singularity"] == 1.28125
    assert record["torus"] == record["breather"] == json.loads(json.dumps(assessment.record()))


def test_a_study_without_a_pole_still_has_a_record(cancellation, breather, assessment):
    endless = replace(cancellation, assessment=replace(assessment, pole_radius=math.inf, growth=0.0))
    record = json.loads(json.dumps(figure_record(convergence_figure(endless, breather)), allow_nan=False))["numbers"]
    assert record["torus"]["radius_by_poles"] is record["torus"]["radius_by_ratio"] is None


@pytest.mark.long
def test_reproduce_fig6_writes_its_orders(capsys, tmp_path):
    """The whole target, nothing replaced: packets excite every mode, the seeds at order 0."""
    assert main(["reproduce", "fig6", "-o", str(tmp_path)]) == 0
    captured = capsys.readouterr()
    assert captured.out.splitlines()[-1] == f"written: {tmp_path / 'report.md'}, report.json, fig6a..c as PNG, PDF and CSV"
    assert captured.out.count("holds: section 6.3, ") == 6
    record = json.loads((tmp_path / "report.json").read_text())["figures"]["fig6"]["numbers"]
    for panel in "abc":
        header, *rows = rows_of(tmp_path / f"fig6{panel}.csv")
        assert header == ["q", "kappa", "order"]
        assert [int(q) for q, _, _ in rows] == list(range(1, 256))
        assert [int(q) for q, _, k in rows if k == "0"] == record[panel]["seeds"]
        assert {q: int(k) for q, _, k in rows} == record[panel]["orders"]
        assert all(float(kappa) == int(q) / 256 for q, kappa, _ in rows)
        assert (tmp_path / f"fig6{panel}.png").stat().st_size > 5000
