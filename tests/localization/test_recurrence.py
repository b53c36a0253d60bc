"""Recurrences of signals with known returns, and of the original trajectory of Fermi, Pasta and Ulam."""

import numpy as np
import pytest

from symfpu import NoRecurrence, fpu_trajectory, integrate, packet_amplitudes, recurrence
from symfpu.paper.printed import FIG9_BREATHER
from tests.localization.refusals import refused
from tests.tolerances import FINE_RETURN_VALUE, RETURN_PLACE, RETURN_TIME, RETURN_VALUE, ROUNDING, WIGGLE


def test_recurrence_of_commensurable_signals():
    t = np.arange(0, 20.0, 0.05)
    a, b = 0.4 * (1 - np.cos(2 * t)), 0.1 * (1 - np.cos(t))  # away from mode 1, in modes 2 and 3
    found = recurrence(t, np.stack([1 - a - b, a, b], axis=-1))
    # symmetric to every multiple of pi, so the vertex is exact but for the fourth order in the spacing
    assert found.times == pytest.approx(np.pi * np.arange(1, 7), abs=RETURN_PLACE)
    assert found.returned == pytest.approx([0.8, 1, 0.8, 1, 0.8, 1], abs=RETURN_VALUE)
    assert found.first == (found.times[0], found.returned[0])
    assert found.best[1] == pytest.approx(1, abs=RETURN_VALUE)
    assert found.excursion == pytest.approx(np.max(a + b), rel=ROUNDING)
    assert repr(found).startswith("Recurrence(6 returns, first at t=3.1416 of 80.000")


def test_the_vertex_of_unequal_samples():
    t = np.array([0.0, 1.0, 5.0, 9.0, 9.7, 11.0, 15.0])
    moved = np.where(abs(t - 10) < 2, (t - 10.3) ** 2 / 25, 0.9)
    moved[0] = 0.0
    found = recurrence(t, np.stack([1 - moved, moved], axis=-1))
    assert (found.times[0], found.returned[0]) == pytest.approx((10.3, 1.0), rel=ROUNDING)


def test_wiggles_make_no_returns():
    t = np.arange(0, 100.0, 0.05)
    moved = 0.4 * (1 - np.cos(2 * np.pi * t / 40)) * (1 + 0.2 * np.sin(7 * t))
    found = recurrence(t, np.stack([1 - moved, moved], axis=-1))
    assert found.times == pytest.approx([40, 80], abs=WIGGLE)


@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_recurrence_of_two_modes_that_beat(shift):
    """A linear pair: energies cos^2, sin^2 of half the difference of frequencies; the parabola finds the top between samples."""
    rate, part = 0.013, 0.8
    t = np.concatenate([[0.0], np.arange(1.0, 1300.0, 2.0) + shift])
    moved = part * np.sin(rate * t / 2) ** 2
    found = recurrence(t, np.stack([3 * (1 - moved), 3 * moved], axis=-1))
    assert found.times == pytest.approx([2 * np.pi / rate, 4 * np.pi / rate], rel=RETURN_TIME)
    assert found.returned == pytest.approx(1, abs=FINE_RETURN_VALUE)
    assert found.excursion == pytest.approx(part, abs=RETURN_PLACE)
    assert found.first[0] == found.times[0]


def test_a_record_that_ends_on_its_way_back_has_no_recurrence():
    t = np.linspace(0, 6.0, 50)  # a period is 2 pi
    with pytest.raises(NoRecurrence, match="until t = 6: the energies move 1 of the whole away") as raised:
        recurrence(t, np.stack([1 + np.cos(t), 1 - np.cos(t)], axis=-1))
    assert raised.value.T == 6.0
    with pytest.raises(NoRecurrence, match="move 0 of the whole"):
        recurrence(t, np.ones((50, 3)))
    with pytest.raises(NoRecurrence):
        recurrence(t, np.stack([1 - t / 10, t / 10], axis=-1))


@pytest.mark.long
@pytest.mark.parametrize(("energy", "time", "returned"), [(None, 14004.3, 0.98626), ("0.014915", 12172.3, 0.98423)])
def test_recurrence_of_the_original_fpu_trajectory(energy, time, returned):
    """Fig. 9(b), "nearly complete return at t = 12000": so for the printed E = 0.014915, not for the printed A_1, where E = 0.00815."""
    chain = FIG9_BREATHER.chain
    A = {1: FIG9_BREATHER.amplitudes[0]} if energy is None else packet_amplitudes(chain, (1,), energy)
    orbit = integrate(chain, *fpu_trajectory(chain, A), 15000.0, step=0.25, samples=np.arange(0, 15000.5, 2.0))
    found = recurrence(orbit.times, orbit.harmonic_energies())
    assert found.first[0] == pytest.approx(time, abs=WIGGLE)  # fast wiggles of the energies move a minimum by less than their period
    assert found.first[1] == pytest.approx(returned, abs=RETURN_PLACE)
    assert found.excursion > 0.75


def test_bad_records_of_a_recurrence_are_refused():
    t, E = np.arange(1.0, 11.0), np.ones((10, 3))
    refused("energies", recurrence, t, 0 * E)
    refused("energies", recurrence, t, -E)
    refused("energies", recurrence, t, E[0])
    refused("times", recurrence, t[:2], E[:2])
    refused("times", recurrence, "now", E)
