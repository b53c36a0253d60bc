"""Pictures of families: axes with labels, and the numbers of the members in their lines."""

from functools import lru_cache

import numpy as np
import pytest
from matplotlib.figure import Figure

from symfpu.breathers.floquet import ELLIPTIC, TRIVIAL
from symfpu.chain.chain import Chain
from symfpu.families.family import family
from symfpu.figures.family import draw_family, plot_amplitudes, plot_multipliers, plot_shifts, plot_spectra
from tests.tolerances import LAST_DIGIT


@lru_cache
def unstable():
    return family(Chain(6, beta=1), (5,), "3", from_energy="0.05", multipliers=True)


@lru_cache
def pair():
    """A fold of omega_2 is on its way."""
    return family(Chain(8, alpha="0.3"), (1, 2), "0.005", from_energy="0.001")


@pytest.fixture
def ax():
    return Figure().add_subplot()


def energies(found):
    return [m.energy for m in found.members]


def test_shifts_have_a_line_for_each_seed_and_one_for_each_fold(ax):
    assert plot_shifts(pair(), ax) is ax
    first, second, fold = ax.get_lines()
    for i, line in enumerate((first, second)):
        shifts = [float(m.torus.frequencies[i]) / pair().chain.frequencies()[i] - 1 for m in pair().members]
        assert line.get_xdata() == pytest.approx(shifts, abs=LAST_DIGIT)
        assert list(line.get_ydata()) == energies(pair())
    assert set(fold.get_ydata()) == {e.energy for e in pair().events if e.kind == "fold"}
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_yscale()) == (r"$\omega_q / \Omega_q - 1$", "$H$", "log")


def test_amplitudes_are_those_of_the_members(ax):
    assert plot_amplitudes(unstable(), ax) is ax
    line, *marks = ax.get_lines()
    assert list(line.get_xdata()) == energies(unstable())
    assert list(line.get_ydata()) == [m.amplitudes[5] for m in unstable().members]
    assert sorted(mark.get_xdata()[0] for mark in marks) == sorted(e.energy for e in unstable().events if e.kind != "fold")
    assert marks
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$H$", "$A_q$")


def test_multipliers_are_angles_and_moduli_off_the_circle(ax):
    assert plot_multipliers(unstable(), ax) is ax
    lines = ax.get_lines()
    assert [line.get_xdata()[0] for line in lines] == energies(unstable())
    for line, m in zip(lines, unstable().members, strict=True):
        assert list(line.get_ydata()) == list(np.abs(np.angle(m.multipliers.pairs[:, 0])))
    (right,) = [other for other in ax.figure.axes if other is not ax]
    (off,) = right.get_lines()
    expected = [
        abs(pair_[0])
        for m in unstable().members
        for pair_, kind in zip(m.multipliers.pairs, m.multipliers.kinds, strict=True)
        if kind not in (TRIVIAL, ELLIPTIC)
    ]
    assert list(off.get_ydata()) == expected
    assert min(expected) > 1
    assert all(label for label in (ax.get_xlabel(), ax.get_ylabel(), right.get_ylabel()))


def test_a_stable_family_needs_no_second_axis(ax):
    stable = family(Chain(6, beta=1), (5,), "0.05", from_energy="0.03", multipliers=True)
    plot_multipliers(stable, ax)
    assert ax.figure.axes == [ax]


def test_spectra_are_of_members_from_the_first_to_the_last(ax):
    assert plot_spectra(pair(), ax) is ax
    lines = ax.get_lines()
    for line, m in ((lines[0], pair().members[0]), (lines[-1], pair().members[-1])):
        spectrum = m.torus.average_spectrum()
        assert list(line.get_xdata()) == list(range(1, 8))
        assert line.get_ydata() == pytest.approx(spectrum / spectrum.sum(), rel=LAST_DIGIT)
    assert all(label for label in (ax.get_xlabel(), ax.get_ylabel()))
    assert len(ax.get_legend().get_texts()) == len(lines) <= 6


def test_there_is_a_panel_more_with_multipliers(tmp_path, monkeypatch):
    """Drawn, and not written: tests of the command line do that."""

    def drawn(panel, title, stem):
        ax = Figure().add_subplot()
        assert panel(ax) is ax
        titles.append(title)
        return [stem.with_suffix(".png"), stem.with_suffix(".pdf")]

    monkeypatch.setattr("symfpu.figures.family.save_panel", drawn)
    titles: list[str] = []
    names = {"shifts", "amplitudes", "spectra"}
    for found, panels in ((pair(), names), (unstable(), names | {"multipliers"})):
        paths = draw_family(found, tmp_path, stem=f"seeds-{len(found.seeds)}")
        expected = {f"seeds-{len(found.seeds)}-{panel}.{suffix}" for panel in panels for suffix in ("png", "pdf")}
        assert {path.name for path in paths} == expected
    assert titles[0] == "Energy against relative frequency shift (N=8, alpha=0.3, seeds 1, 2)"
    assert len(set(titles)) == 7
