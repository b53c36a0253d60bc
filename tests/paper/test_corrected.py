"""Exact tori of the printed frequencies: amplitudes by two routes, errors of the series by order and by mu, what a verdict says."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import symfpu
from symfpu import Chain, lindstedt, refine, solve_amplitudes
from symfpu.paper import corrected, series_errors
from symfpu.paper.corrected import HEAVY_ROWS, CorrectedRow, corrected_row, corrected_rows, left_out
from symfpu.paper.corrected_page import corrected_line, corrected_record, corrected_text
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS
from symfpu.paper.series_errors import ScalingStudy, SeriesErrors, decay, scaling_study
from tests.tolerances import CONVERGED_DIGITS, LAST_DIGIT, PROMISED_RESIDUAL, RATE_OF_MU, SLOPE, SMALL_CHANGE, TEN_ROUNDINGS, TWELVE_DIGITS

BY_LABEL = {row.label: row for row in (TWO_TORUS, *APPENDIX_F)}
SMALL = replace(BY_LABEL["Fig. 7"], order=20)


@pytest.fixture(scope="module")
def pair():
    """The row of Fig. 1, to order 12."""
    return corrected_row(replace(TWO_TORUS, order=12))


@pytest.fixture(scope="module")
def breather():
    return corrected_row(SMALL)


@pytest.fixture(scope="module")
def study(breather):
    return scaling_study(breather.torus, "Fig. 7")


@pytest.mark.long
@pytest.mark.parametrize("label", ["Fig. 7", "Fig. 8", "Fig. 9"])
def test_a_breather_is_the_periodic_orbit(label):
    """Two solvers: long doubles with Krylov steps, and harmonic balance in doubles."""
    printed = replace(BY_LABEL[label], order=4)
    row = corrected_row(printed)
    orbit = symfpu.torus(printed.chain, (printed.seeds[0],), frequencies=(printed.frequencies[0],))
    (amplitude,) = row.torus.amplitudes.values()
    assert amplitude == pytest.approx(orbit.amplitude, rel=CONVERGED_DIGITS)
    assert row.energies["H"] == pytest.approx(orbit.energy(), rel=CONVERGED_DIGITS)
    assert row.energies["harmonic energy at t = 0"] == pytest.approx(orbit.harmonic_energies().sum(), rel=CONVERGED_DIGITS)
    assert row.energies["harmonic energy, time average"] == pytest.approx(orbit.average_spectrum().sum(), rel=CONVERGED_DIGITS)
    assert row.residual < PROMISED_RESIDUAL
    assert row.digits == 12
    assert row.deviations == {printed.seeds[0]: float(printed.amplitudes[0]) / amplitude - 1}
    if label == "Fig. 9":  # docs/convergence.md, question (ii)
        assert amplitude == pytest.approx(1.27153895251, rel=TWELVE_DIGITS)


def test_energies_have_the_digits_in_which_two_refinements_agree(monkeypatch):
    """N = 32, s = 1: a second torus whose energies are moved by 3e-10 leaves nine; their amplitude keeps its twelve."""
    exact = corrected._energies
    moved = iter([1 + 3e-10])
    monkeypatch.setattr(corrected, "_energies", lambda torus: {name: E * next(moved, 1) for name, E in exact(torus).items()})
    row = corrected_row(SMALL)
    assert (row.digits, row.energy_digits) == (12, 9)
    assert "H = 0.000170128387, residual" in corrected_line(row)
    assert "| 0.00016635 | 0.000170128387 |" in "\n".join(corrected_text([row], []))


def test_the_amplitudes_of_fig_1_do_not_depend_on_the_guess(pair):
    """12 digits: another series as the guess, and another choice of harmonics."""
    series = lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, 12)
    other = refine(solve_amplitudes(series), tolerance=1e-12)
    assert len(other.harmonics) != len(pair.torus.harmonics)
    assert pair.digits == 12
    for q, a in pair.torus.amplitudes.items():
        assert other.amplitudes[q] == pytest.approx(a, rel=CONVERGED_DIGITS)


def test_errors_are_those_of_the_truncated_torus(pair):
    """The table of all orders against positions of one truncated torus, at times of its own."""
    series = lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, 12)
    cut = solve_amplitudes(series, frequency_order=8, order=8)
    cut = replace(cut.origin, amplitudes=tuple(pair.torus.amplitudes.values())).torus(cut.phases)
    t = np.linspace(0, 500, 400)
    linear = TWO_TORUS.chain.frequencies()
    apart = float((linear * np.abs(cut.Q(t) - pair.torus.Q(t))).max())
    size = float((linear * np.abs(pair.torus.cosines)).max())
    assert 1.0 <= apart / size / pair.errors.given[8] < 20  # a sum of coefficients in the place of the largest


def test_errors_do_not_depend_on_the_sign_of_a_harmonic(pair):
    """One of each pair +-nu is listed, whichever."""
    series = lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, 4)
    signs = np.where(np.arange(len(pair.torus.harmonics)) % 2, -1, 1)[:, None]
    turned = series_errors.series_errors(series, replace(pair.torus, harmonics=signs * pair.torus.harmonics))
    assert turned == series_errors.series_errors(series, pair.torus)
    assert turned.given[4] == pytest.approx(pair.errors.given[4], rel=CONVERGED_DIGITS)


def test_an_exact_series_has_no_error():
    """Fig. 8 at order 8: the torus is the series, all coefficients to rounding."""
    row = corrected_row(replace(BY_LABEL["Fig. 8"], order=8))
    assert row.errors.given[8] < LAST_DIGIT
    assert row.errors.solved[8] < TEN_ROUNDINGS
    assert row.decays["given"].rounding
    assert 1e-3 < row.decays["given"].factor < 1e-2


def test_errors_of_the_amplitudes_are_those_of_the_history(breather):
    series = lindstedt(SMALL.chain, SMALL.seeds, SMALL.frequencies, SMALL.order)
    for K in (2, 6):
        value = solve_amplitudes(series, frequency_order=K).amplitudes[1]
        assert breather.errors.amplitudes[K] == abs(value / breather.torus.amplitudes[1] - 1)
    assert 1 not in breather.errors.solved
    assert breather.errors.solved[7] == pytest.approx(breather.errors.solved[6], rel=SMALL_CHANGE)  # omega^(7) is zero


def test_fig_1_falls_to_order_9_and_then_grows(pair):
    given = pair.decays["given"]
    assert given.last == 9
    assert given.least == pair.errors.given[9] < 1e-3
    assert pair.errors.given[12] > given.least
    assert "at order 9" in pair.verdict


@pytest.mark.parametrize("K", [1, 2, 3, 4])
def test_the_error_of_a_breather_falls_as_mu_to_the_next_order(study, K):
    given, solved = study.rates[K]
    assert given == pytest.approx(K + 1, abs=RATE_OF_MU)
    if K == 1:
        assert math.isnan(solved)
    else:
        assert solved == pytest.approx(K - K % 2, abs=RATE_OF_MU)


def test_the_error_of_fig_1_falls_as_mu_to_the_next_order(pair, monkeypatch):
    monkeypatch.setattr(series_errors, "HALVINGS", 3)
    rates = scaling_study(pair.torus, "Fig. 1").rates
    assert [given for given, _ in rates.values()] == pytest.approx([2, 3, 4, 5], abs=SLOPE)
    assert [rates[K][1] for K in (2, 3, 4)] == pytest.approx([2, 2, 4], abs=SLOPE)


def test_a_beta_chain_is_compared_too():
    """Its frequency series gains a term at every order."""
    series = lindstedt(Chain(18, beta="0.6"), (3,), ("0.5251",), 6)
    errors = series_errors.series_errors(series, refine(solve_amplitudes(series)))
    assert sorted(errors.solved) == sorted(errors.given) == sorted(errors.amplitudes) == list(range(1, 7))
    assert errors.given[6] < errors.given[1] / 100


GEOMETRIC = {k: 0.25**k for k in range(1, 9)}


@pytest.mark.parametrize(
    ("errors", "words"),
    [
        (GEOMETRIC, "falls by 0.25 an order to 1.5e-05 at order 8; the longest is 8"),
        (
            GEOMETRIC | {k: 0.25**8 * 2.0 ** (k - 8) for k in range(9, 21)},
            "falls by 0.25 an order to 1.5e-05 at order 8, then grows, to 6.2e-02",
        ),
        (GEOMETRIC | dict.fromkeys(range(9, 21), 1.01 * 0.25**8), "falls by 0.25 an order to 1.5e-05 at order 8, then stays (order 20)"),
        ({k: max(0.01**k, 1e-16) for k in range(1, 21)}, "falls by 0.01 an order and reaches rounding, 1e-16, at order 8"),
        ({k: max(0.01**k, 1e-8 * 0.5**k) for k in range(1, 9)}, "falls by 0.061 an order (0.5 in the second half) to 3.9e-11 at order 8"),
        ({k: 0.99**k for k in range(1, 9)}, "falls by 0.990 an order to 9.3e-01 at order 7; the longest is 8"),
    ],
    ids=["falling", "growing", "level", "rounding", "slower", "slow"],
)
def test_a_decay_says_how_far_it_goes(errors, words):
    assert str(decay(errors)).startswith(words)


def test_one_order_has_no_rate():
    assert math.isnan(decay({2: 0.5}).factor)


def test_a_rate_ignores_rounding():
    scales = (1.0, 0.5, 0.25, 0.125)
    given = {3: (1e-8, 1e-8 / 16, 1e-8 / 256, 5e-16), 4: (5e-16,) * 4}
    rates = ScalingStudy("test", scales, given, {}).rates
    assert rates[3][0] == pytest.approx(4.0)
    assert math.isnan(rates[3][1])
    assert math.isnan(rates[4][0])


def test_a_row_that_takes_too_long_says_so(monkeypatch):
    monkeypatch.setattr(corrected, "LIMIT", 0.0)
    row = corrected_row(SMALL)
    assert (row.torus, row.errors) == (None, None)
    assert row.verdict.startswith("not refined: more than 0 s, the last step being: periodic orbit")


def test_a_second_refinement_that_fails_leaves_the_first(monkeypatch):
    monkeypatch.setattr(corrected, "TOLERANCES", (1e-10, 2.0))
    row = corrected_row(SMALL)
    assert row.torus is not None
    assert row.digits == corrected.LEAST_DIGITS
    assert "to a residual of" in row.verdict
    assert "tolerance" in row.verdict


def test_a_torus_above_its_tolerance_is_not_an_exact_one(monkeypatch):
    monkeypatch.setattr(corrected, "refine", lambda torus, **_: replace(refine(torus), warnings=("too few harmonics",)))
    assert corrected_row(SMALL).verdict == "not refined: too few harmonics"


def test_heavy_rows_are_computed_in_full_only(monkeypatch):
    asked = []
    monkeypatch.setattr(
        corrected, "corrected_row", lambda printed, progress, *, series: asked.append(printed.label) or left_out(printed, "")
    )
    known = dict.fromkeys(BY_LABEL.values())
    rows = list(corrected_rows(known))
    assert [row.printed.label for row in rows] == list(BY_LABEL)
    assert set(asked) == set(BY_LABEL) - set(HEAVY_ROWS)
    assert all("--full" in row.verdict for row in rows if row.printed.label in HEAVY_ROWS)
    asked.clear()
    list(corrected_rows(known, full=True))
    assert asked == list(BY_LABEL)


@pytest.fixture
def two_rows(breather):
    return [breather, left_out(BY_LABEL["Fig. 5b"], "more than 5 s")]


def test_the_record_is_strict_json(two_rows, study):
    record = json.loads(json.dumps([corrected_record(two_rows[0], study), corrected_record(two_rows[1])], allow_nan=False))
    assert record[1] == {"refined": False, "verdict": "not refined: more than 5 s"}
    assert record[0]["amplitudes"] == {"1": "0.185736029576"}
    assert float(record[0]["energies"]["H"]) == two_rows[0].energies["H"]
    assert record[0]["errors"]["given"]["3"] == pytest.approx(two_rows[0].errors.given[3], rel=TEN_ROUNDINGS)
    assert record[0]["exponents_of_mu"]["1"]["solved"] is None
    assert record[0]["decays"]["given"]["last_falling_order"] == two_rows[0].decays["given"].last


@pytest.mark.long
@pytest.mark.parametrize("label", [row.label for row in APPENDIX_F if len(row.seeds) > 2 and row.label not in HEAVY_ROWS])
def test_the_series_tend_to_the_exact_tori(label):
    row = corrected_row(BY_LABEL[label])
    assert row.residual < PROMISED_RESIDUAL
    assert row.digits >= 10
    solved, given = row.decays["solved"], row.decays["given"]
    assert given.rounding or given.last >= 0.9 * row.printed.order - 1
    assert solved.least < 1e-4
    assert min(row.errors.amplitudes.values()) < 1e-4


def test_a_row_without_torus_has_no_numbers():
    row = left_out(TWO_TORUS, "reason")
    assert isinstance(row, CorrectedRow)
    assert row.decays == row.energy_deviations == {}
    assert corrected_line(row) == "  corrected: not refined: reason"


def test_the_largest_deviation_is_named(breather):
    row = replace(breather, deviations={1: 1e-9, 2: -3e-5}, errors=SeriesErrors({2: 0.5}, {1: 0.25}, {}))
    assert row.verdict.startswith("printed amplitudes differ by up to 3.0e-05; the error of the series")
