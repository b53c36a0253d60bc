"""Panels, curves and claims: what they refuse, how they are drawn, and that tables, pages and records hold what they were given."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from symfpu.errors import InputError
from symfpu.figures.drawing import plot_panel
from symfpu.figures.panels import Curve, Panel
from symfpu.paper.claims import FAILS, HOLDS, OPEN, PARTLY, Claim, PaperFigure, judged
from symfpu.paper.claims_page import claims_markdown, claims_table, figure_markdown, figure_record, write_panel_csv
from symfpu.paper.drawings import draw_panels

X = np.array([1.0, 2.0, 4.0])


def panel(*curves, **changes):
    return replace(Panel("figXa", "Fig. X(a): test", r"$x$", r"$y$", curves, ("x_word", "y_word")), **changes)


def claim(verdict=HOLDS, **changes):
    return replace(Claim("4.1", "it is so", "1.5", "1.48", verdict), **changes)


@pytest.fixture
def figure():
    curves = (Curve("$a$", X, 10 * X, name="a q=1"), Curve("b", X, 1 / X, "points"))
    claims = (claim(), claim(FAILS), claim(FAILS, text="|eps_q| << 1", printed=""))
    return PaperFigure("figX", "Fig. X: a test", (panel(*curves), panel(curves[1], name="figXb")), claims, ("Made by hand.",))


@pytest.fixture
def ax():
    return Figure().add_subplot()


@pytest.mark.parametrize(
    ("holds", "partly", "verdict"), [(True, False, HOLDS), (True, True, HOLDS), (False, True, PARTLY), (False, False, FAILS)]
)
def test_verdicts(holds, partly, verdict):
    assert judged(holds, partly) == verdict


@pytest.mark.parametrize("y", [X[:2], np.ones((3, 1)), np.ones((1, 3))])
def test_a_curve_has_a_y_for_each_x(y):
    with pytest.raises(InputError, match="y ="):
        Curve("a", X, y)


def test_unknown_styles_and_verdicts_are_refused():
    with pytest.raises(InputError, match="style"):
        Curve("a", X, X, "wavy")
    with pytest.raises(InputError, match="verdict"):
        claim("probably")


def test_a_table_has_every_point_under_the_name_of_its_curve(figure):
    header, rows = figure.panels[0].table()
    assert header == ["curve", "x_word", "y_word"]
    assert list(rows) == [["a q=1", x, 10 * x] for x in X] + [["b", x, 1 / x] for x in X]


def test_csv_files_hold_all_points_also_those_not_drawn(figure, tmp_path):
    dark = replace(figure, panels=(panel(Curve("a", X, np.array([1.0, 0.0, np.nan]))),))
    (path,) = write_panel_csv(dark, tmp_path)
    assert path.name == "figXa.csv"
    assert list(csv.reader(path.read_text().splitlines())) == [
        ["curve", "x_word", "y_word"],
        ["a", "1.0", "1.0"],
        ["a", "2.0", "0.0"],
        ["a", "4.0", "nan"],
    ]


def test_points_that_an_axis_cannot_show_are_left_out(ax):
    y = np.array([0.1, -1.0, np.inf])
    assert plot_panel(panel(Curve("a", X, y)), ax) is ax
    assert ax.get_lines()[0].get_xdata().tolist() == [1.0]
    linear = Figure().add_subplot()
    plot_panel(panel(Curve("a", np.array([-1.0, 0.0, 1.0]), y), log_y=False), linear)
    assert linear.get_lines()[0].get_xdata().tolist() == [-1.0, 0.0]
    both = Figure().add_subplot()
    plot_panel(panel(Curve("a", np.array([-1.0, 0.0, 1.0]), X), log_x=True), both)
    assert both.get_lines()[0].get_xdata().tolist() == [1.0]
    assert [(a.get_xscale(), a.get_yscale()) for a in (ax, linear, both)] == [("linear", "log"), ("linear", "linear"), ("log", "log")]


def test_axes_bear_the_labels_and_the_bottom(ax):
    plot_panel(panel(Curve("a", X, X), bottom=1e-5), ax)
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_ylim()[0]) == ("$x$", "$y$", 1e-5)


def test_curves_of_a_group_share_colour_and_label(ax):
    plot_panel(panel(*(Curve(f"D_{g}", X, X * (i + 1), group=g) for i, g in enumerate((0, 0, 1, 1)))), ax)
    colours = [line.get_color() for line in ax.get_lines()]
    assert colours[0] == colours[1] != colours[2] == colours[3]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["D_0", "D_1"]


def test_curves_without_a_group_differ_in_look(ax):
    plot_panel(panel(*(Curve(f"q = {i}", X, X * (i + 1)) for i in range(8)), Curve("law", X, X, "law")), ax)
    lines = ax.get_lines()
    assert len({(line.get_color(), line.get_linestyle()) for line in lines}) == 9
    assert lines[-1].get_color() == "black"
    assert len(ax.get_legend().get_texts()) == 9


def test_of_points_on_each_other_the_first_are_the_largest(ax):
    plot_panel(panel(*(Curve(str(i), X, X, "points") for i in range(3))), ax)
    sizes = [line.get_markersize() for line in ax.get_lines()]
    assert sizes == sorted(sizes, reverse=True)
    assert len(set(sizes)) == 3


def test_every_panel_is_written_as_png_and_pdf(figure, tmp_path):
    paths = draw_panels(figure, tmp_path)
    assert [path.name for path in paths] == ["figXa.png", "figXa.pdf", "figXb.png", "figXb.pdf"]
    assert all(path.read_bytes().startswith(b"\x89PNG" if path.suffix == ".png" else b"%PDF") for path in paths)


def test_the_page_has_every_claim_remark_and_picture(figure):
    page = figure_markdown(figure)
    assert page.startswith("## Fig. X: a test\n\nMade by hand.\n\n| section |")
    assert "| 4.1 | it is so | 1.5 | 1.48 | **holds** |" in page
    assert page.count("**does not hold**") == 2
    assert page.endswith("![Fig. X(a): test](figXa.png)\n\n![Fig. X(a): test](figXb.png)\n")
    assert "| section |" not in figure_markdown(replace(figure, claims=()))


def test_moduli_do_not_end_the_cells_of_a_table():
    row = claims_table([claim(text="|eps_q| << 1", printed="", ours="|v| grows")]).splitlines()[-1]
    assert row == r"| 4.1 | \|eps_q\| << 1 | - | \|v\| grows | **holds** |"
    assert row.replace(r"\|", "").count("|") == 6


def test_the_summary_counts_by_verdict_and_figure(figure):
    other = PaperFigure("figY", "Fig. Y", (), (claim(PARTLY), claim(OPEN), claim()))
    page = claims_markdown([figure, other])
    assert "2 holds, 1 holds in part, 2 does not hold, 1 undecided." in page
    assert "| Fig. X: a test | 1 |  | 2 |  |" in page
    assert "| Fig. Y | 1 | 1 |  | 1 |" in page


def test_the_record_is_strict_json(figure):
    record = json.loads(json.dumps(figure_record(figure), allow_nan=False))
    assert record["panels"] == {"figXa": ["$a$", "b"], "figXb": ["b"]}
    assert record["claims"][0] == {"section": "4.1", "text": "it is so", "printed": "1.5", "ours": "1.48", "verdict": "holds"}
    assert (record["title"], record["remarks"]) == ("Fig. X: a test", ["Made by hand."])


def test_a_figure_prints_its_verdicts(figure):
    assert repr(figure) == "PaperFigure(figX, panels figXa, figXb; claims: 1 holds, 2 does not hold)"
    assert repr(replace(figure, claims=())).endswith("claims: none)")
