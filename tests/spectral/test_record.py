"""Sums of exponentials are found as they were made."""

import numpy as np
import pytest

from symfpu.spectral.record import LINE_WIDTH, Record
from tests.tolerances import LINE_OF_RECORD

INTERVAL = 0.5
N = 2048
BAND = (-np.pi / INTERVAL, np.pi / INTERVAL)


def made(frequencies, coefficients):
    t = (np.arange(N) - (N - 1) / 2) * INTERVAL
    return sum(c * np.exp(1j * f * t) for f, c in zip(frequencies, coefficients, strict=True))


def test_complex_lines_of_both_signs():
    frequencies, coefficients = [-1.3, 0.7, 0.75], [0.5, 1j, 0.01]
    record = Record(made(frequencies, coefficients), INTERVAL)
    found = record.settle(record.lines(3, 1e-9, BAND))
    order = np.argsort([x.frequency for x in found])
    for place, f, c in zip(order, frequencies, coefficients, strict=True):
        assert found[place].frequency == pytest.approx(f, abs=LINE_OF_RECORD)
        assert found[place].coefficient == pytest.approx(c, abs=LINE_OF_RECORD)


def test_a_real_line_and_a_constant():
    y = 0.3 + 2 * made([0.9], [0.4 - 0.1j]).real
    record = Record(y, INTERVAL)
    found = record.settle(record.lines(2, 1e-9, (0.0, BAND[1])))
    assert [x.frequency for x in found] == pytest.approx([0.9, 0.0], abs=LINE_OF_RECORD)
    assert found[1].coefficient == pytest.approx(0.3, abs=LINE_OF_RECORD)
    assert found[0].coefficient == pytest.approx(0.4 - 0.1j, abs=LINE_OF_RECORD)


def test_lines_at_the_least_distance_are_told_apart():
    turn = 2 * np.pi / (N * INTERVAL)
    frequencies = [1.0, 1.0 + 1.5 * LINE_WIDTH * turn]
    record = Record(made(frequencies, [1.0, 0.5]), INTERVAL)
    found = record.settle(record.lines(2, 1e-9, BAND))
    assert sorted(x.frequency for x in found) == pytest.approx(frequencies, abs=LINE_OF_RECORD)


def test_nothing_is_no_line():
    assert Record(np.zeros(N), INTERVAL).lines(3, 1e-9, BAND) == []
