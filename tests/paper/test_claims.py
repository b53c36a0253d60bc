"""Claims: tables, pages and records hold what they were given."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

from symfpu import InputError
from symfpu.figures.panels import Curve
from symfpu.paper.claims import FAILS, HOLDS, OPEN, PARTLY, Claim, PaperFigure, judged
from symfpu.paper.claims_page import (
    claims_markdown,
    figure_record,
    file_names,
    write_panel_csv,
)
from tests.figures.test_panels import X, panel

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together


def claim(verdict=HOLDS, **changes):
    return replace(Claim("4.1", "it is so", "1.5", "1.48", verdict), **changes)


@pytest.fixture
def figure():
    curves = (Curve("$a$", X, 10 * X, name="a q=1"), Curve("b", X, 1 / X, "points"))
    claims = (claim(), claim(FAILS), claim(FAILS, text="|eps_q| << 1", printed=""))
    return PaperFigure("figX", "Fig. X: a test", (panel(*curves), panel(curves[1], name="figXb")), claims, ("Made by hand.",))


@pytest.mark.parametrize(
    ("holds", "partly", "verdict"), [(True, False, HOLDS), (True, True, HOLDS), (False, True, PARTLY), (False, False, FAILS)]
)
def test_verdicts(holds, partly, verdict):
    assert judged(holds, partly) == verdict


def test_unknown_verdicts_are_refused():
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


def test_columns_are_the_table_where_they_are_given(figure, tmp_path):
    columns = {"q": [1, 2], "order": ["", 0.5]}
    (path,) = write_panel_csv(replace(figure, panels=(panel(Curve("a", X, X), columns=columns),)), tmp_path)
    assert list(csv.reader(path.read_text().splitlines())) == [["q", "order"], ["1", ""], ["2", "0.5"]]


@pytest.mark.parametrize("numbers", [{"best": 3}, [1, 2]])
def test_numbers_are_beside_what_is_judged(figure, numbers):
    without = figure_record(figure)
    assert (without["kind"], without["numbers"]) == ("PaperFigure", None)
    assert figure_record(replace(figure, numbers=numbers)) == without | {"numbers": numbers}
    unjudged = figure_record(replace(figure, claims=(), numbers=numbers))
    assert unjudged == without | {"claims": [], "numbers": numbers}


def test_files_that_differ_in_a_last_letter_are_named_together(figure):
    names = ("fig4a", "fig4b", "fig4a-random", "fig4c", "fig4e", "fig4f", "fig4g")
    panels = tuple(panel(name=name) for name in names)
    assert file_names(replace(figure, panels=panels)) == "fig4a..b, fig4a-random, fig4c, fig4e..g"
    assert file_names(replace(figure, panels=())) == ""


def test_the_summary_counts_by_verdict_and_figure(figure):
    other = PaperFigure("figY", "Fig. Y", (), (claim(PARTLY), claim(OPEN), claim()))
    page = claims_markdown([figure, other, PaperFigure("figZ", "Fig. Z", (), ())])
    assert "Fig. Z" not in page  # nothing is judged
    assert "2 holds, 1 holds in part, 2 does not hold, 1 undecided." in page
    assert "| Fig. X: a test | 1 |  | 2 |  |" in page
    assert "| Fig. Y | 1 | 1 |  | 1 |" in page


def test_the_record_is_strict_json(figure):
    record = json.loads(json.dumps(figure_record(figure), allow_nan=False))
    assert record["panels"] == {"figXa": ["$a$", "b"], "figXb": ["b"]}
    assert record["claims"][0] == {"section": "4.1", "text": "it is so", "printed": "1.5", "ours": "1.48", "verdict": "holds"}
    assert (record["title"], record["remarks"]) == ("Fig. X: a test", ["Made by hand."])
