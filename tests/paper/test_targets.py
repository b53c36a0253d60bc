"""Targets of `symfpu reproduce`: pages, data files and pictures of the convergence study, from studies written by hand."""

import csv
import json
import math
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu.breathers.balance import orbit_of
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.families.continuation import Member
from symfpu.families.family import Family
from symfpu.files.progress import NO_FRACTION
from symfpu.paper.claims_page import draw_panels, figure_markdown, figure_record, write_panel_csv
from symfpu.paper.convergence import breather_text, cancellation_text, convergence_figure
from symfpu.paper.convergence_fig1 import CancellationStudy, Variant
from symfpu.paper.convergence_fig9 import BreatherStudy, SchemeLimit
from symfpu.paper.targets import TARGETS, reproduced
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.verdict import assess

NAMES = ("doubles", "40 digits", "rounded amplitudes", "other frequencies")
FILES = [f"convergence-{panel}" for panel in "abcde"]


@pytest.fixture(scope="module")
def assessment():
    torus = solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3905", "0.7663"), 8))
    return assess(torus.series, torus)


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
    assert tables["convergence-a"][0] == ["k", *NAMES]
    assert [[int(k), *map(float, values)] for k, *values in tables["convergence-a"][1:]] == [
        [k, *(3 * 10.0**-k * scale for scale in (1, 2, 3, 4))] for k in range(2, 31, 2)
    ]
    assert tables["convergence-b"][0] == ["k", *NAMES]
    assert [[int(k), *map(float, values)] for k, *values in tables["convergence-b"][1:]] == [
        [k, *(0.5**k * scale for scale in (1, 2, 3, 4))] for k in range(31)
    ]
    assert tables["convergence-c"] == [["order", "truncated", "resummed"], ["12", str(0.5**12), "1e-05"], ["30", str(0.5**30), "2e-07"]]
    assert tables["convergence-e"] == [["omega", "A", "A at the end of the series"], ["0.391", "0.75", "0.875"], ["0.393", "1.125", "1.25"]]
    assert tables["convergence-d"] == [["K", "A"], ["2", "1.5"], ["4", "1.4375"], ["10", "1.40625"], ["37", "1.3125"]]


def test_the_page_on_fig_1_names_every_number(cancellation, assessment):
    page = "\n".join(cancellation_text(cancellation))
    assert "| doubles | 3.00e-14 | 3.00e-20 | 3.00e-24 | 3.00e-28 | 6.10e-05 | 9.31e-10 | 8.7e-19 |" in page
    assert all(f"| {name} |" in page for name in NAMES)
    assert "13 omega_1 -7 omega_2 = 0, at order 19" in page
    assert "divisor 3.1250e-05, grows every two orders by: 20: 1.250000, 22: 1.500000." in page
    assert "at 0.62500 of the actual mu^2: a pole there makes terms grow by 1.60000 every two orders" in page
    assert "| 30 | 9.3e-10 | 2.0e-07 | 0.7500000000 | 0.8750000000 | 0.3750000000 | 0.4375000000 |" in page
    assert f"Verdict: {assessment.headline} ({assessment.reasons[0]}" in page


def test_the_page_on_fig_9_names_every_number(breather, assessment):
    page = "\n".join(breather_text(breather))
    assert "| printed frequency | 0.39050000000000 | 1.25000000000 |" in page
    assert "| printed amplitude | 0.39070000000000 | 1.37500000000 |" in page
    orbit = breather.orbit
    energies = f"{orbit.energy():.10f} | {orbit.harmonic_energies().sum():.10f}"
    assert f"{energies} | {orbit.residual():.0e} |" in page
    assert "A(K) of the truncated series: 2: 1.50000000, 10: 1.40625000, 37: 1.31250000." in page
    assert "ends at A = 1.281250000 (spread of the fit 2e-08) in a singularity of exponent 0.5000" in page
    assert f"Verdict: {assessment.headline}" in page


def test_the_page_links_every_picture_once(cancellation, breather):
    page = figure_markdown(convergence_figure(cancellation, breather))
    assert page.index("Question (i)") < page.index("Question (ii)") < page.index("![")
    assert all(page.count(f"]({name}.png)") == 1 for name in FILES)
    assert page.endswith(")\n")


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
def test_pictures_are_written_as_png_and_pdf(cancellation, breather, tmp_path):
    paths = draw_panels(convergence_figure(cancellation, breather), tmp_path)
    assert [path.name for path in paths] == [f"{name}.{suffix}" for name in FILES for suffix in ("png", "pdf")]
    for path in paths:
        assert path.read_bytes().startswith(b"\x89PNG" if path.suffix == ".png" else b"%PDF")
        assert path.stat().st_size > 5000


@pytest.mark.long
def test_reproduce_convergence_writes_page_data_and_pictures(cancellation, breather, monkeypatch, capsys, tmp_path):
    steps = []
    monkeypatch.setattr("symfpu.paper.convergence.cancellation_study", lambda progress: progress("first", NO_FRACTION) or cancellation)
    monkeypatch.setattr("symfpu.paper.convergence.breather_study", lambda progress: progress("second", NO_FRACTION) or breather)
    with monkeypatch.context() as unseen:
        unseen.setattr("symfpu.paper.targets.draw_panels", lambda *given: [])
        figure = reproduced("convergence", tmp_path, lambda label, fraction: steps.append(label))
    assert steps == ["convergence", "first", "second", "convergence: pictures"]
    code = main(["reproduce", "convergence", "-o", str(tmp_path / "out"), "--json"])
    captured = capsys.readouterr()
    assert (code, captured.err) == (0, "")
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written == {"report.md", "report.json"} | {f"{name}.{suffix}" for name in FILES for suffix in ("png", "pdf", "csv")}
    found = json.loads(captured.out)
    assert found == json.loads((tmp_path / "out" / "report.json").read_text())
    assert found["figures"] == {"convergence": figure_record(figure)}
    assert figure_markdown(figure) in (tmp_path / "out" / "report.md").read_text()


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


def test_targets_are_named_in_the_help(capsys):
    assert main(["reproduce", "--help"]) == 0
    words = capsys.readouterr().out
    assert list(TARGETS) == ["table", "section5", "statements", *(f"fig{i}" for i in range(1, 10)), "convergence", "toda"]
    assert all(name in words for name in (*TARGETS, "all"))
