"""Pictures take axes, return them, and leave the style of others alone."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from symfpu.figures.drawing import plot_spectrum, save_panel


@pytest.fixture
def ax():
    return Figure().add_subplot()


def test_spectrum_leaves_out_what_a_logarithm_cannot_show(ax):
    assert plot_spectrum(np.array([1.0, 0.0, 1e-8]), ax, label="order 4") is ax
    (line,) = ax.get_lines()
    assert line.get_xdata().tolist() == [1, 3]
    assert line.get_ydata().tolist() == [1.0, 1e-8]
    assert line.get_label() == "order 4"
    assert (ax.get_xlabel(), ax.get_yscale()) == ("$q$", "log")


def test_modes_below_the_floor_are_not_drawn(ax):
    plot_spectrum(np.array([1.0, 1e-8, 1e-16]), ax, floor=np.array([1e-20, 1e-8, 1e-20]))
    assert ax.get_lines()[0].get_xdata().tolist() == [1, 3]
    plot_spectrum(np.array([1.0, 1e-8, 1e-16]), ax, floor=1e-10)
    assert ax.get_lines()[1].get_xdata().tolist() == [1, 2]


def test_a_panel_is_written_as_png_and_pdf(tmp_path):
    paths = save_panel(lambda ax: plot_spectrum(np.array([1.0, 0.1]), ax), "title", tmp_path / "panel")
    assert [path.suffix for path in paths] == [".png", ".pdf"]
    assert paths[0].read_bytes().startswith(b"\x89PNG")
    assert paths[1].read_bytes().startswith(b"%PDF")


def test_the_style_does_not_leak(tmp_path):
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    save_panel(lambda ax: ax, "title", tmp_path / "panel")
    assert dict(mpl.rcParams) == before
