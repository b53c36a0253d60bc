"""Panels of the paper draw the numbers that they are given."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from symfpu.figures.drawing import plot_panel
from symfpu.paper.convergence import by_order_panel, roots_panel
from symfpu.paper.fig1 import differences_panel
from symfpu.paper.judgements import sums_panel


@pytest.fixture
def ax():
    return Figure().add_subplot()


def test_differences_have_a_line_for_each_seed(ax):
    panel = differences_panel("fig1b", {2: (0.1, 0.3), 4: (0.01, 0.03)}, (1, 5))
    assert plot_panel(panel, ax) is ax
    assert [line.get_ydata().tolist() for line in ax.get_lines()] == [[0.1, 0.01], [0.3, 0.03]]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [r"$\Delta A_{1}$", r"$\Delta A_{5}$"]


def test_sums_are_two_lines_over_the_order(ax):
    panel = sums_panel("fig1c", "", 1, (np.array([1.0, 0.0, 0.5]), np.array([1.0, 0.0, 0.1])))
    assert plot_panel(panel, ax) is ax
    upper, lower = ax.get_lines()
    assert list(upper.get_xdata()) == list(lower.get_xdata()) == [0, 2]
    assert list(lower.get_ydata()) == [1.0, 0.1]


def test_variants_are_rings_over_each_other_without_zeros(ax):
    """More than nine of them begin the markers anew."""
    curves = {f"case {i}": {2: 0.5 / (i + 1), 3: 0.0, 4: 0.25} for i in range(10)}
    assert plot_panel(by_order_panel("convergence-a", "", "size", curves), ax) is ax
    lines = ax.get_lines()
    assert [line.get_label() for line in lines] == list(curves)
    for i, line in enumerate(lines):
        assert list(line.get_xdata()) == [2, 4]
        assert list(line.get_ydata()) == [0.5 / (i + 1), 0.25]
        assert line.get_markerfacecolor() == "none"
    sizes = [line.get_markersize() for line in lines]
    assert sizes == sorted(sizes, reverse=True)
    assert min(sizes) > 0
    assert lines[0].get_marker() == lines[9].get_marker() != lines[1].get_marker()
    assert (ax.get_ylabel(), ax.get_yscale()) == ("size", "log")


def test_breather_roots_are_beside_the_orbit_and_the_end(ax):
    panel = roots_panel({2: 1.5, 4: 1.4}, 1.271538, 1.286986)
    assert plot_panel(panel, ax) is ax
    roots, orbit, end = ax.get_lines()
    assert (list(roots.get_xdata()), list(roots.get_ydata())) == ([2, 4], [1.5, 1.4])
    assert (set(orbit.get_ydata()), set(end.get_ydata())) == ({1.271538}, {1.286986})
    assert orbit.get_label().endswith("1.271538")
    assert end.get_label().endswith("1.286986")
