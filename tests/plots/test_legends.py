"""Legends that cover nothing, pictures that are not cut, and the words above them that say of what they are."""

from functools import cache

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from symfpu import Chain, plots
from symfpu.plots.style import picture_bytes, subject, write_picture
from tests.plots import cases
from tests.plots.pictures import PICTURES, THREE

QUICK = ("multipliers-unstable", "residuals", "section-breather")
EACH = [pytest.param(name, marks=[] if name in QUICK else [pytest.mark.long]) for name in PICTURES]


@cache
def drawn(name, size=(6.0, 4.2)):
    figure = Figure(figsize=size, layout="constrained")
    ax = PICTURES[name](figure.add_subplot(projection="3d" if name in THREE else None))
    figure.draw_without_rendering()
    return ax


def points_of(ax):
    """On the screen, of the axes and of a second scale."""
    axes = [other for other in ax.figure.axes if other.bbox.bounds == ax.bbox.bounds]
    curves = [line for other in axes for line in other.lines]
    return np.concatenate([line.get_transform().transform(line.get_xydata()) for line in curves])


@pytest.mark.parametrize("size", [(6.0, 4.2), (4.2, 2.9)])
@pytest.mark.parametrize("name", [case for case in EACH if case.values[0] not in THREE])
def test_a_legend_covers_no_point_and_no_word(name, size):
    ax = drawn(name, size)
    if ax.get_legend() is None:
        return
    box = ax.get_legend().get_window_extent()
    assert box.count_contains(points_of(ax)) == 0
    assert not any(text.get_window_extent().overlaps(box) for text in ax.texts)


# of what a picture is; that every picture says it: tests/plots/test_pictures.py


def test_the_subject_has_chain_seeds_and_energy():
    torus = cases.torus()
    said = torus.plot(Figure().add_subplot()).figure.get_suptitle()
    assert said == f"N=16, alpha=0.33, seeds 1, 2, H={torus.energy():.6g}"
    assert subject(Chain(4, beta=1), (3,)) == "N=4, beta=1, seed 3"
    assert all(len(line) <= 84 for line in subject(Chain(128, beta=1), range(1, 65)).split("\n"))
    history = cases.history().plot(Figure().add_subplot()).figure.get_suptitle()
    assert history == "N=16, alpha=0.33, seeds 1, 2"


def test_a_second_result_in_the_same_axes_is_named_below_the_first():
    ax = Figure().add_subplot()
    for result in (cases.torus(), cases.refined(), cases.torus()):
        result.plot(ax)
    first, second = (result.plot(Figure().add_subplot()).figure.get_suptitle() for result in (cases.torus(), cases.refined()))
    assert ax.figure.get_suptitle() == f"{first}\n{second}"


def test_titles_and_figures_of_the_reader_stay_as_they_are():
    figure = Figure()
    figure.suptitle("Mine")
    cases.torus().plot(figure.add_subplot())
    assert figure.get_suptitle() == "Mine"
    several = Figure()
    cases.torus().plot(several.subplots(1, 2)[0])
    assert several.get_suptitle() == ""


# figures that stay open


def test_pictures_in_files_and_pages_leave_no_figure_open(tmp_path):
    before = plt.get_fignums()
    write_picture(cases.torus().plot, tmp_path / "torus.png")
    picture_bytes(cases.unstable().plot, ".svg")
    cases.torus()._repr_html_()
    assert plt.get_fignums() == before
    ax = plots.spectrum(cases.torus())
    assert plt.get_fignums() != before
    plt.close(ax.figure)
