"""The verdict: its word for cases that are known, and each piece of its evidence against another way to compute it."""

import itertools
import math
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest

from symfpu import Chain, InputError, assess, lindstedt, solve_amplitudes
from symfpu.paper.printed import APPENDIX_F, FIG9_BREATHER, TWO_TORUS
from symfpu.tori.best_order import best_order
from symfpu.tori.verdict import RATIO_ORDERS, LargestTerm, growth_of, root_uncertainty_of
from tests import tolerances
from tests.tolerances import DIFFERENCE_OF_DOUBLES, LAST_DIGIT, RESIDUAL_ROUNDING, ROUNDING, SAME_AS_DOUBLES, SEQUENCE_LIMIT, SUMMED_FIG1


def solved(printed, highest, *, digits=None, **options):
    return solve_amplitudes(lindstedt(printed.chain, printed.seeds, printed.frequencies, highest, digits=digits), **options)


def small_torus(digits=None):
    """The torus of Fig. 1 with both frequencies a thousand times nearer to the linear ones."""
    return solve_amplitudes(lindstedt(Chain(16, alpha="0.33"), (1, 2), ("0.1960345", "0.3901810"), 8, digits=digits))


def beta_torus():
    return solve_amplitudes(lindstedt(Chain(8, beta="0.3"), (1, 2), ("0.3925", "0.7695"), 5))


def mixed_torus():
    return solve_amplitudes(lindstedt(Chain(8, alpha="0.2", beta="0.3"), (1, 2), ("0.3925", "0.7695"), 6), phases={1: 0.3})


CASES = {
    "breather of Fig. 7": (lambda: solved(APPENDIX_F[-3], 30), "converged"),
    "breather of Fig. 8": (lambda: solved(APPENDIX_F[-2], 30), "converged"),
    "breather of Fig. 8, digits": (lambda: solved(APPENDIX_F[-2], 10, digits=30), "converged"),
    "small torus": (small_torus, "converged"),
    "small torus, digits": (lambda: small_torus(20), "converged"),
    "torus of Fig. 1": (lambda: solved(TWO_TORUS, 30, frequency_order=24), "asymptotic, best at order 12"),
    "torus of Fig. 1, whole series": (lambda: solved(TWO_TORUS, 30), "asymptotic, best at order 12"),
    "torus of Fig. 1, digits": (lambda: solved(TWO_TORUS, 16, digits=20), "asymptotic, best at order 12"),
    "order 2": (lambda: solved(TWO_TORUS, 2), "undecided"),
    "order 2, digits": (lambda: solved(TWO_TORUS, 2, digits=20), "undecided"),
    "order 1 of beta": (lambda: solve_amplitudes(lindstedt(Chain(8, beta="0.3"), (1,), ("0.3925",), 1)), "undecided"),
    "coordinates cut at order 0": (lambda: solved(TWO_TORUS, 8, order=0), "undecided"),
    "coordinates cut at order 1": (lambda: solved(APPENDIX_F[-2], 8, order=1), "undecided"),
    "beta": (beta_torus, None),
    "mixed": (mixed_torus, None),
}


@cache
def judged(name):
    """Torus and assessment of a case, made once."""
    torus = CASES[name][0]()
    return torus, assess(torus.origin.series, torus)


@pytest.mark.long
@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.long] * n.startswith("torus of Fig. 1,")) for n in CASES if CASES[n][1]]
)
def test_the_word_for_a_known_case(name):
    _, assessment = judged(name)
    assert assessment.verdict == CASES[name][1]
    assert assessment.word == CASES[name][1].split(",")[0]
    assert repr(assessment).startswith(f"Assessment({assessment.verdict}: residual of the equations of motion")


@pytest.mark.long
def test_the_breather_of_fig_9_is_not_a_torus():
    """Its series ends below the printed amplitude, at A = 1.287: the root at order 242 is one of the polynomial only."""
    torus = solved(FIG9_BREATHER, FIG9_BREATHER.order)
    assessment = assess(torus.origin.series, torus)
    assert assessment.verdict == "not a torus"
    assert "does not settle" in assessment.reasons[-2]
    assert assessment.root_uncertainty > 1e-3
    assert assessment.record()["verdict"] == "not a torus"
    assert 0.99 < assessment.growth < 1.3009149 / 1.2869859  # terms grow by A / (end of the series), times k^-3/2 of a square root
    assert assessment.pole_radius < 1.0


@pytest.mark.parametrize("change", [1.01, 0.99])
def test_other_amplitudes_are_not_those_of_a_torus(change):
    torus, _ = judged("breather of Fig. 8")
    moved = replace(torus.origin, amplitudes=(change * torus.amplitudes[25],)).torus(torus.phases)
    assessment = assess(torus.origin.series, moved)
    assert assessment.word == "not a torus"
    assert "refine may find one" in assessment.reasons[-1]
    assert assessment.root_uncertainty == pytest.approx(abs(1 / change - 1), rel=DIFFERENCE_OF_DOUBLES)


def test_a_torus_of_another_series_is_refused():
    torus, _ = judged("order 2")
    with pytest.raises(InputError, match="of another series"):
        assess(replace(torus.origin.series), torus)


@pytest.mark.parametrize("name", ["torus of Fig. 1", "breather of Fig. 8, digits", "beta", "mixed"])
def test_sums_are_those_of_the_series(name):
    torus, assessment = judged(name)
    assert tuple(assessment.sums) == torus.seeds
    for q, ours in assessment.sums.items():
        theirs = torus.origin.series.absolute_sums(q, list(torus.amplitudes.values()), with_mu=True)
        for row, expected in zip(ours, theirs, strict=True):
            assert row.shape == (torus.origin.order + 1,)
            assert row == pytest.approx(expected, rel=ROUNDING, abs=0)


@pytest.mark.parametrize(("name", "points"), [("torus of Fig. 1", 23), ("beta", 23), ("mixed", 23), ("breather of Fig. 7", 64)])
def test_residuals_are_those_of_the_torus_cut_at_every_order(name, points):
    torus, assessment = judged(name)
    assert assessment.residuals.shape == (torus.origin.order + 1,)
    for k in range(0, torus.origin.order + 1, 1 if torus.origin.order < 10 else 5):
        expected = torus.origin.cut_at(k).torus(torus.phases).residual(points)
        assert assessment.residuals[k] == pytest.approx(expected, rel=RESIDUAL_ROUNDING, abs=ROUNDING)
    assert assessment.best_order == int(np.argmin(assessment.residuals))
    if assessment.residuals.min() > RESIDUAL_ROUNDING:
        assert best_order(torus) == assessment.best_order


def test_with_digits_residuals_go_on_where_doubles_end():
    torus, assessment = judged("breather of Fig. 8, digits")
    for k in (0, 3, 6, 10):
        points = 16 if k > 3 else 64
        assert assessment.residuals[k] == pytest.approx(torus.origin.cut_at(k).torus(torus.phases).residual(points), rel=RESIDUAL_ROUNDING)
    assert (assessment.residuals[1:] < assessment.residuals[:-1]).all()
    assert assessment.residuals[-1] < tolerances.LONG_SERIES_RESIDUAL
    assert "certified" not in " ".join(assessment.reasons)
    assert assessment.record()["certified"] is True


@pytest.mark.parametrize("name", ["breather of Fig. 7", "breather of Fig. 8, digits"])
def test_energy_errors_are_the_range_of_the_energy_along_the_orbit(name):
    """One seed: the angles of the grid are times."""
    torus, assessment = judged(name)
    angles = 2 * np.pi * (3 * np.arange(64) + 1) / (3 * 64)
    times = angles / float(torus.frequencies[0])
    for k in range(5):
        energies = torus.origin.cut_at(k).torus(torus.phases).energy(times).astype(float)
        expected = (energies.max() - energies.min()) / energies.mean()
        assert assessment.energy_errors[k] == pytest.approx(expected, rel=DIFFERENCE_OF_DOUBLES, abs=16 * ROUNDING)


@pytest.mark.parametrize("name", ["torus of Fig. 1", "beta", "mixed", "small torus, digits"])
def test_largest_terms_are_the_largest_and_have_their_divisors(name):
    torus, assessment = judged(name)
    amplitudes, chain = [torus.amplitudes[q] for q in torus.seeds], torus.chain
    for term in assessment.terms:
        nu, values = torus.origin.series.harmonic_terms(amplitudes, term.order)
        sizes = np.abs(values.astype(float)) * chain.frequencies()
        row = int(np.flatnonzero((nu == term.harmonic).all(axis=1))[0])
        assert term.size == sizes.max() == sizes[row, term.mode - 1]
        with mpmath.workdps(40):
            omega = [mpmath.mpf(w.numerator) / w.denominator for w in torus.frequencies]
            linear = 2 * mpmath.sin(term.mode * mpmath.pi / (2 * chain.N))
            base = dict(zip(torus.seeds, omega, strict=True)).get(term.mode, linear)
            expected = base**2 - mpmath.fsum(n * w for n, w in zip(term.harmonic, omega, strict=True)) ** 2
        assert term.divisor == pytest.approx(float(expected), rel=LAST_DIGIT, abs=0)
    assert [term.order for term in assessment.terms] == list(range(torus.origin.order + 1))
    assert (assessment.terms[0].mode, assessment.terms[0].harmonic, assessment.terms[0].divisor) in [(1, (1, 0), 0.0), (2, (0, 1), 0.0)]


def test_the_torus_of_fig_1_is_undone_by_one_small_divisor():
    _, assessment = judged("torus of Fig. 1")
    last = assessment.terms[-1]
    assert (last.mode, last.harmonic) == (3, (5, -4))
    assert "mode 3, harmonic (5,-4), divisor 3.4e-05" in " ".join(assessment.reasons)
    assert assessment.growth**2 == pytest.approx(1.494248, rel=tolerances.GROWTH_OF_TERMS)  # tests/paper/test_convergence.py
    assert assessment.radius == 1 / assessment.growth
    assert assessment.resummed_residual < SUMMED_FIG1 < assessment.residuals.min()


@pytest.mark.parametrize("rate", [0.25, 1.5])
@pytest.mark.parametrize("step", [1, 2])
def test_growth_of_a_geometric_sequence_is_its_rate(rate, step):
    """With alpha, orders of the other parity may be of another size: only those of the last one's parity count."""
    terms = [LargestTerm(k, rate**k * (7 if step == 2 and k % 2 else 3), 1, (1,), 1.0) for k in range(24)]
    assert growth_of(terms, step) == pytest.approx(rate, rel=SEQUENCE_LIMIT)
    bent = [*terms, *(replace(terms[-1], order=23 + j, size=terms[-1].size * 2.0**j) for j in range(1, step * RATIO_ORDERS + 1))]
    assert growth_of(bent, step) == pytest.approx(2.0, rel=SEQUENCE_LIMIT)


def test_growth_needs_two_orders_beyond_the_seeds_own():
    one = LargestTerm(1, 0.5, 1, (1,), 1.0)
    assert growth_of([], 1) == growth_of([one], 1) == growth_of([replace(one, order=0), one], 1) == 0.0
    assert growth_of([one, replace(one, order=2)], 2) == 0.0
    assert growth_of([one, replace(one, order=2, size=0.125)], 1) == pytest.approx(0.25)
    assert replace(judged("order 2")[1], growth=0.0).radius == math.inf


@pytest.mark.parametrize("rate", [0.5, 0.1, -0.3])
@pytest.mark.parametrize("count", [3, 6, 12])
def test_the_root_uncertainty_bounds_the_error_of_geometric_amplitudes(rate, count):
    """A(k) = 1 + rate^k / 100, whose limit is 1."""
    history = {2 * k: (1 + 0.01 * rate**k,) for k in range(1, count + 1)}
    orders = list(history)
    differences = {a: (abs(history[b][0] - history[a][0]),) for a, b in itertools.pairwise(orders)}
    torus = SimpleNamespace(amplitudes={1: history[orders[-1]][0]}, history=history)
    error = abs(torus.amplitudes[1] - 1)
    assert error < root_uncertainty_of(torus.amplitudes, torus.history, differences) < 40 * error


def test_amplitudes_that_move_apart_are_as_uncertain_as_their_least_change():
    differences = {2: (0.1, 0.1), 4: (0.001, 0.002), 6: (0.02, 0.01)}
    torus = SimpleNamespace(amplitudes={1: 1.0, 2: 0.5}, history={4: (1.0, 0.5)})
    assert root_uncertainty_of(torus.amplitudes, torus.history, differences) == pytest.approx(0.004)
    assert root_uncertainty_of(torus.amplitudes, torus.history, {2: (0.1, 0.1)}) == math.inf
    growing = {2: (0.1, 0.1), 4: (0.2, 0.3), 6: (0.3, 0.4)}
    assert root_uncertainty_of(torus.amplitudes, torus.history, growing) == pytest.approx(0.2)


@pytest.mark.parametrize(("doubles", "digits"), [("small torus", "small torus, digits"), ("order 2", "order 2, digits")])
def test_digits_change_no_word_and_no_evidence(doubles, digits):
    plain, precise = judged(doubles)[1], judged(digits)[1]
    assert (plain.word, plain.frequency_order) == (precise.word, precise.frequency_order)
    assert [(t.order, t.mode, t.harmonic) for t in plain.terms] == [(t.order, t.mode, t.harmonic) for t in precise.terms]
    visible = plain.residuals > 1e-9
    assert plain.residuals[visible] == pytest.approx(precise.residuals[visible], rel=tolerances.DOUBLE_RESIDUAL)
    for K, amplitudes in plain.amplitudes.items():
        assert amplitudes == pytest.approx(tuple(map(float, precise.amplitudes[K])), rel=SAME_AS_DOUBLES)


def test_every_sentence_states_one_residual():
    """Warnings, verdict and repr have the residual of the torus, whatever fewer angles would give."""
    series = lindstedt(Chain(32, alpha="0.33"), (1, 2), ("0.0985", "0.1965"), 6)
    torus = solve_amplitudes(series)
    stated = f"{torus.residual():.2g}"
    large, grows = [line for line in torus.warnings if "equations of motion" in line]
    assert large == f"the equations of motion are met only to {stated} of the largest acceleration"
    assert "times from order 4 to 6" in grows
    assert f"residual {stated}, " in repr(torus)
    found = assess(series, torus)
    assert found.reasons[0].startswith(f"residual of the equations of motion {stated} at order 6")
    assert found.residuals[-1] != torus.residual(points=64)  # the grids differ, and so would the sentences
