"""Tori as records and text: no digit is lost, and every number of a line is there."""

import json
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from symfpu import Chain, assess, lindstedt, solve_amplitudes


@pytest.fixture(scope="module")
def torus():
    return solve_amplitudes(lindstedt(Chain(8, alpha="1/3", beta="0.1"), (1, 2), ("0.3905", "0.7663"), 4))


def test_a_record_survives_json_without_losing_a_digit(torus):
    record = json.loads(json.dumps(torus.record()))
    assert {int(q): float(a) for q, a in record["amplitudes"].items()} == torus.amplitudes
    assert float(record["energy"]) == float(torus.energy())
    assert float(record["harmonic_energy"]) == torus.harmonic_energies().sum()
    assert float(record["average_harmonic_energy"]) == torus.average_spectrum().sum()
    assert {int(k): tuple(map(float, values)) for k, values in record["history"].items()} == torus.origin.history
    assert (record["alpha"], record["beta"], record["seeds"]) == ("1/3", "0.1", [1, 2])
    assert record["residual"] == float(f"{torus.residual():.15g}")
    assert record["warnings"] == list(torus.warnings)
    assert len(record["smallest_divisors"]) == len(torus.origin.series.smallest_divisors)


def test_the_evidence_has_a_line_for_every_order_of_a_short_series(torus):
    """With the numbers of the assessment."""
    assessment = assess(torus.origin.series, torus)
    *_, two, _, four = assessment.text().splitlines()
    term = assessment.terms[4]
    shown = (f"{assessment.amplitudes[4][0]:.10g}", f"{assessment.residuals[4]:.1e}", f"{assessment.energy_errors[4]:.1e}")
    assert four.split()[0] == "4"
    assert all(number in four for number in (*shown, f"{term.size:.1e}", f"{term.divisor:.1e}"))
    assert f"{max(assessment.differences[2]):.1e}" in two
    endless = replace(assessment, growth=0.0, pole_radius=float("inf")).text()
    assert "inf by ratio of terms, no pole" in endless


def test_the_evidence_of_a_long_series_is_short_and_has_its_best_order(torus):
    assessment = assess(torus.origin.series, torus)
    values = np.full(243, 0.5)
    sums = dict.fromkeys((1, 2), (values, values))
    long = replace(assessment, order=242, best_order=157, residuals=values, energy_errors=values, sums=sums)
    orders = [line.split()[0] for line in long.text().splitlines()[len(assessment.reasons) + 2 :]]
    assert {"0", "157", "242"} <= set(orders)
    assert len(orders) < 15


def test_a_record_of_many_digits_keeps_them():
    torus = solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (3,), ("1.1125",), 6, digits=30))
    record = json.loads(json.dumps(torus.record()))
    assert (record["digits"], record["certified"]) == (30, True)
    assert record["guard_digits"] == torus.origin.series.guard_digits
    with mpmath.workdps(45):
        for text, number in ((record["amplitudes"]["3"], torus.amplitudes[3]), (record["energy"], torus.energy())):
            assert abs(mpmath.mpf(text) / number - 1) < mpmath.mpf(10) ** -29
            assert abs(mpmath.mpf(text) / number - 1) > 0
