"""Pictures of families: axes with labels, and the numbers of the members in their lines."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from symfpu.breathers.floquet import ELLIPTIC, TRIVIAL
from symfpu.plots.families import family_amplitudes, family_frequencies, family_multipliers, family_spectra
from tests.plots.cases import pair, stable_family, unstable
from tests.tolerances import LAST_DIGIT


@pytest.fixture
def ax():
    return Figure().add_subplot()


def energies(found):
    return [m.energy for m in found.members]


def test_shifts_have_a_line_for_each_seed_and_one_for_each_fold(ax):
    assert family_frequencies(pair(), ax) is ax
    first, second, fold = ax.get_lines()
    for i, line in enumerate((first, second)):
        shifts = [float(m.torus.frequencies[i]) / pair().chain.frequencies()[i] - 1 for m in pair().members]
        assert line.get_xdata() == pytest.approx(shifts, abs=LAST_DIGIT)
        assert list(line.get_ydata()) == energies(pair())
    assert set(fold.get_ydata()) == {e.energy for e in pair().events if e.kind == "fold"}


def test_amplitudes_are_those_of_the_members(ax):
    assert family_amplitudes(unstable(), ax) is ax
    line, *marks = ax.get_lines()
    assert list(line.get_xdata()) == energies(unstable())
    assert list(line.get_ydata()) == [m.amplitudes[5] for m in unstable().members]
    assert sorted(mark.get_xdata()[0] for mark in marks) == sorted(e.energy for e in unstable().events if e.kind != "fold")
    assert marks


def test_multipliers_are_angles_on_the_circle_and_moduli_off_it(ax):
    assert family_multipliers(unstable(), ax) is ax
    lines = ax.get_lines()[: len(unstable().members)]
    assert [line.get_xdata()[0] for line in lines] == energies(unstable())
    off = []
    for line, m in zip(lines, unstable().members, strict=True):
        on = [pair_[0] for pair_, kind in zip(m.multipliers.pairs, m.multipliers.kinds, strict=True) if kind == ELLIPTIC]
        assert list(line.get_ydata()) == list(np.abs(np.angle(on)))
        kinds = zip(m.multipliers.pairs, m.multipliers.kinds, strict=True)
        off += [abs(pair_[0]) for pair_, kind in kinds if kind not in (TRIVIAL, ELLIPTIC)]
    (right,) = [other for other in ax.figure.axes if other is not ax]
    (crosses,) = right.get_lines()
    assert list(crosses.get_ydata()) == off
    assert min(off) > 1


def test_a_stable_family_needs_no_second_axis(ax):
    family_multipliers(stable_family(), ax)
    assert ax.figure.axes == [ax]


def test_spectra_are_of_members_from_the_first_to_the_last(ax):
    assert family_spectra(pair(), ax) is ax
    lines = ax.get_lines()
    for line, m in ((lines[0], pair().members[0]), (lines[-1], pair().members[-1])):
        spectrum = m.torus.average_spectrum()
        assert list(line.get_xdata()) == list(range(1, 8))
        assert line.get_ydata() == pytest.approx(spectrum / spectrum.sum(), rel=LAST_DIGIT)
    assert len(ax.get_legend().get_texts()) == len(lines) <= 6
