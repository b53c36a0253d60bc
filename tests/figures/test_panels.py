"""Panels, curves and pictures: what they refuse, how they are drawn, and which panels a family has."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from symfpu import InputError
from symfpu.figures.drawing import plot_panel, save_panel
from symfpu.figures.family import draw_family
from symfpu.figures.panels import Curve, Panel
from tests.plots.cases import pair, unstable

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


def test_limits_of_a_panel_are_those_of_its_axes(ax):
    plot_panel(panel(Curve("a", X, X), log_y=False, bottom=-1.0, top=7.0, x_limits=(0.5, 9.0)), ax)
    assert (ax.get_ylim(), ax.get_xlim()) == ((-1.0, 7.0), (0.5, 9.0))


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


@pytest.mark.long
def test_there_is_a_panel_more_with_multipliers(tmp_path, monkeypatch):
    """Drawn, and not written: tests of the command line do that."""

    def drawn(panel, title, stem):
        ax = Figure().add_subplot()
        assert panel(ax) is ax
        titles.append((title, ax.figure.get_suptitle()))
        return [stem.with_suffix(".png"), stem.with_suffix(".pdf")]

    monkeypatch.setattr("symfpu.figures.family.save_panel", drawn)
    titles: list[tuple[str, str]] = []
    names = {"shifts", "amplitudes", "spectra"}
    for found, panels in ((pair(), names), (unstable(), names | {"multipliers"})):
        paths = draw_family(found, tmp_path, stem=f"seeds-{len(found.seeds)}")
        expected = {f"seeds-{len(found.seeds)}-{panel}.{suffix}" for panel in panels for suffix in ("png", "pdf")}
        assert {path.name for path in paths} == expected
    assert titles[0] == ("Energy against relative frequency shift", "N=8, alpha=0.3, seeds 1, 2, H=0.001 .. 0.005")
    assert len(set(titles)) == 7


def test_a_panel_is_written_as_png_and_pdf(tmp_path):
    paths = save_panel(lambda ax: ax.semilogy([1.0, 0.1]), "title", tmp_path / "panel")
    assert [path.suffix for path in paths] == [".png", ".pdf"]
    assert paths[0].read_bytes().startswith(b"\x89PNG")
    assert paths[1].read_bytes().startswith(b"%PDF")


def test_the_style_does_not_leak(tmp_path):
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    save_panel(lambda ax: ax, "title", tmp_path / "panel")
    assert dict(mpl.rcParams) == before
