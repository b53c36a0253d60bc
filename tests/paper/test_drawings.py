"""Pictures of the paper draw the numbers that they are given."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from symfpu.figures.drawing import plot_panel
from symfpu.paper.drawings import plot_amplitude_differences, plot_breather_roots, plot_energy_errors, plot_variants
from symfpu.paper.judgements import sums_panel


@pytest.fixture
def ax():
    return Figure().add_subplot()


def test_differences_have_a_line_for_each_seed(ax):
    assert plot_amplitude_differences({2: (0.1, 0.3), 4: (0.01, 0.03)}, (1, 5), ax) is ax
    assert [line.get_ydata().tolist() if hasattr(line.get_ydata(), "tolist") else list(line.get_ydata()) for line in ax.get_lines()] == [
        [0.1, 0.01],
        [0.3, 0.03],
    ]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [r"$\Delta A_{1}$", r"$\Delta A_{5}$"]


def test_sums_are_two_lines_over_the_order(ax):
    panel = sums_panel("fig1c", "", 1, (np.array([1.0, 0.0, 0.5]), np.array([1.0, 0.0, 0.1])))
    assert plot_panel(panel, ax) is ax
    upper, lower = ax.get_lines()
    assert list(upper.get_xdata()) == list(lower.get_xdata()) == [0, 2]
    assert list(lower.get_ydata()) == [1.0, 0.1]


def test_errors_are_moduli_after_the_start(ax):
    total, harmonic = np.array([0.0, -1e-4, 2e-4]), np.array([0.0, -1e-2, 2e-2])
    assert plot_energy_errors(np.arange(3.0), {12: (total, harmonic)}, ax) is ax
    drawn = sorted(max(line.get_ydata()) for line in ax.get_lines())
    assert drawn == [2e-4, 2e-2]
    assert all(min(line.get_xdata()) > 0 for line in ax.get_lines())


def test_variants_are_rings_over_each_other_without_zeros(ax):
    """More than five of them begin the markers anew."""
    curves = {f"case {i}": {2: 0.5 / (i + 1), 3: 0.0, 4: 0.25} for i in range(6)}
    assert plot_variants(curves, "size", ax) is ax
    lines = ax.get_lines()
    assert [line.get_label() for line in lines] == list(curves)
    for i, line in enumerate(lines):
        assert list(line.get_xdata()) == [2, 4]
        assert list(line.get_ydata()) == [0.5 / (i + 1), 0.25]
        assert line.get_markerfacecolor() == "none"
    sizes = [line.get_markersize() for line in lines]
    assert sizes == sorted(sizes, reverse=True)
    assert min(sizes) > 0
    assert lines[0].get_marker() == lines[5].get_marker() != lines[1].get_marker()
    assert (ax.get_ylabel(), ax.get_yscale()) == ("size", "log")


def test_breather_roots_are_beside_the_orbit_and_the_end(ax):
    data = SimpleNamespace(amplitudes={2: 1.5, 4: 1.4}, orbit=SimpleNamespace(amplitude=1.271538), singularity=1.286986)
    assert plot_breather_roots(data, ax) is ax
    roots, orbit, end = ax.get_lines()
    assert (list(roots.get_xdata()), list(roots.get_ydata())) == ([2, 4], [1.5, 1.4])
    assert (set(orbit.get_ydata()), set(end.get_ydata())) == ({1.271538}, {1.286986})
    assert orbit.get_label().endswith("1.271538")
    assert end.get_label().endswith("1.286986")
