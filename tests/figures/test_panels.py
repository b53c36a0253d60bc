"""Panels and curves: what they refuse, how they are drawn."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from symfpu.errors import InputError
from symfpu.figures.drawing import plot_panel
from symfpu.figures.panels import Curve, Panel

X = np.array([1.0, 2.0, 4.0])


def panel(*curves, **changes):
    return replace(Panel("figXa", "Fig. X(a): test", r"$x$", r"$y$", curves, ("x_word", "y_word")), **changes)


@pytest.fixture
def ax():
    return Figure().add_subplot()


@pytest.mark.parametrize("y", [X[:2], np.ones((3, 1)), np.ones((1, 3))])
def test_a_curve_has_a_y_for_each_x(y):
    with pytest.raises(InputError, match="y ="):
        Curve("a", X, y)


def test_unknown_styles_are_refused():
    with pytest.raises(InputError, match="style"):
        Curve("a", X, X, "wavy")


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


def test_in_a_group_each_style_has_a_label_of_its_own(ax):
    curves = [Curve(f"{style} {i}", X, X, style, group=0) for style in ("marks", "line") for i in range(2)]
    plot_panel(panel(*curves), ax)
    assert len({line.get_color() for line in ax.get_lines()}) == 1
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["marks 0", "line 0"]


def test_a_curve_without_a_label_is_not_in_the_legend(ax):
    plot_panel(panel(Curve("", X, X, name="order")), ax)
    assert ax.get_legend() is None
    assert len(ax.get_lines()) == 1


def test_a_legend_goes_where_the_panel_says():
    curves = [Curve(f"q = {i}", X, X * (i + 1)) for i in range(8)]
    beside, inside = Figure().add_subplot(), Figure().add_subplot()
    plot_panel(panel(*curves), beside)
    plot_panel(panel(*curves, legend="lower right", legend_columns=2), inside)
    assert beside.get_legend().get_bbox_to_anchor().x0 >= beside.bbox.x1
    assert inside.get_legend().get_bbox_to_anchor().x0 < inside.bbox.x1
    assert (beside.get_legend()._ncols, inside.get_legend()._ncols) == (1, 2)


def test_limits_of_a_panel_are_those_of_its_axes(ax):
    plot_panel(panel(Curve("a", X, X), log_y=False, bottom=-1.0, top=7.0, x_limits=(0.5, 9.0)), ax)
    assert (ax.get_ylim(), ax.get_xlim()) == ((-1.0, 7.0), (0.5, 9.0))


def test_a_falling_axis_has_small_values_on_top(ax):
    plot_panel(panel(Curve("a", X, X), log_y=False, falling=True), ax)
    bottom, top = ax.get_ylim()
    assert bottom > top


@pytest.mark.parametrize(("log_x", "middle"), [(True, 2.0), (False, 2.5)])
def test_a_span_is_shaded_and_named_in_its_middle(ax, log_x, middle):
    span = Curve("out of reach", X[[0, 2]], X[[1, 1]], "span")
    plot_panel(panel(Curve("a", X, X), span, log_x=log_x), ax)
    (text,) = ax.texts
    assert (text.get_text(), text.get_position()) == ("out of reach", (middle, 2.0))
    assert [patch.get_extents().width > 0 for patch in ax.patches] == [True]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["a"]
    assert len(ax.get_lines()) == 1


def test_beads_differ_in_marker_and_keep_their_size(ax):
    plot_panel(panel(*(Curve(f"row {i}", X, X, "beads") for i in range(7))), ax)
    lines = ax.get_lines()
    assert len({line.get_marker() for line in lines}) == 7
    assert len({line.get_markersize() for line in lines}) == 1
    assert [line.get_linestyle() for line in lines] == ["-"] * 5 + ["--"] * 2  # where colours come round


def test_of_points_on_each_other_the_first_are_the_largest(ax):
    plot_panel(panel(*(Curve(str(i), X, X, "points") for i in range(3))), ax)
    sizes = [line.get_markersize() for line in ax.get_lines()]
    assert sizes == sorted(sizes, reverse=True)
    assert len(set(sizes)) == 3
