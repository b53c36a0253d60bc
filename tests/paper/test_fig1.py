"""Claims on Fig. 1, each true and not, from data made by hand; the real ones are in tests/paper/test_table.py."""

from types import SimpleNamespace

import numpy as np
import pytest

from symfpu import Chain
from symfpu.paper import fig1_claims
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from tests.paper.cases import Cut, exponential

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together


def data(**changes):
    """Of a series that does all that the text says."""
    lower = 1e-5 * 0.5 ** (np.arange(31.0) - 14)
    upper = 1e-1 * 2.0 ** np.minimum(0.1 * (np.arange(31.0) - 14), 0) * np.where(np.arange(31) > 14, lower / lower[14], 1.0)
    errors = {k: (np.array([0.0, -1e-4]), np.array([0.0, 1e-2])) for k in (12, 24)}
    differences = {k: (10.0**-k, 1e-12) for k in range(2, 8, 2)} | {k: (1e-7 * (1 + abs(k - 24)), 1e-12) for k in range(8, 30, 2)}
    words = SimpleNamespace(word="converged", verdict="converged")
    texts = dict.fromkeys(("best_difference", "cancellation", "term_size", "harmonic_error", "energy_error"), "ours")
    torus = Cut(30, {12: 0.023451, 30: 0.023451})
    given = {"sums": (upper, lower), "errors": errors, "differences": differences, "assessment": words, "best_order": 12, "torus": torus}
    return SimpleNamespace(**given | {"residuals": {2: 1e-2, 12: 1e-5, 30: 1e-4}, "claims": lambda: texts} | changes)


def scaled(values, k, factor):
    values = values.copy()
    values[k] *= factor
    return values


def test_a_series_as_the_text_has_it():
    good = data()
    exact = SimpleNamespace(residual=lambda: 1e-14)
    judged = [
        fig1_claims.settling_claim(good),
        fig1_claims.convergence_claim(good, exact),
        fig1_claims.residual_terms_claim(good),
        fig1_claims.parallel_claim(good),
    ]
    judged += [fig1_claims.size_claim(good), fig1_claims.energy_claim(good), fig1_claims.errors_claim(good)]
    assert [claim.verdict for claim in judged] == [HOLDS] * 7
    assert {claim.section for claim in judged} == {"3.2"}


@pytest.mark.parametrize(
    ("best", "level", "verdict"), [(24, 2e-7, HOLDS), (22, 2e-7, PARTLY), (24, 4e-7, FAILS), (24, 2e-9, FAILS), (22, 2e-9, FAILS)]
)
def test_settling_has_an_order_and_a_level(best, level, verdict):
    differences = {k: (level * (1 + abs(k - best)), 0.0) for k in range(2, 30, 2)}
    assert fig1_claims.settling_claim(data(differences=differences)).verdict == verdict


def test_an_asymptotic_series_does_not_behave_as_a_convergent_one():
    words = SimpleNamespace(word="asymptotic", verdict="asymptotic, best at order 12")
    found = fig1_claims.convergence_claim(data(assessment=words), SimpleNamespace(residual=lambda: 1e-14))
    assert found.verdict == FAILS
    assert "residual 1e-05 there, 1e-04 at order 30" in found.ours


def test_terms_of_increasing_size_leave_a_residual_that_decreases():
    upper, lower = data().sums
    assert fig1_claims.residual_terms_claim(data(sums=(upper, scaled(lower, 20, 1e3)))).verdict == PARTLY  # rises after order 14
    assert fig1_claims.residual_terms_claim(data(sums=(upper, scaled(lower, 12, 1e-30)))).verdict == FAILS  # least before order 14
    assert fig1_claims.residual_terms_claim(data(sums=(scaled(upper, 2, 1e3), lower))).verdict == FAILS


def test_curves_in_parallel_beyond_order_14():
    upper, lower = data().sums
    assert fig1_claims.parallel_claim(data(sums=(scaled(upper, 30, 0.2), lower))).verdict == PARTLY
    assert fig1_claims.parallel_claim(data(sums=(scaled(upper, 30, 2), lower))).verdict == FAILS


@pytest.mark.parametrize(("size", "verdict"), [(1.0, HOLDS), (0.34, HOLDS), (0.33, PARTLY), (5.0, PARTLY), (0.09, FAILS), (11, FAILS)])
def test_a_size_is_its_power_of_ten(size, verdict):
    upper, lower = data().sums
    assert fig1_claims.size_claim(data(sums=(upper, scaled(lower, 14, size)))).verdict == verdict


@pytest.mark.parametrize(
    ("last", "best", "verdict"), [((1e-4, 1e-2), (1, 1), HOLDS), ((2e-3, 1e-2), (1e-4, 1e-2), PARTLY), ((2e-3, 1e-2), (1e-4, 1), FAILS)]
)
def test_both_energies_fluctuate_as_printed(last, best, verdict):
    errors = {k: tuple(np.array([0.0, -value]) for value in pair) for k, pair in ((24, last), (12, best))}
    assert fig1_claims.errors_claim(data(errors=errors)).verdict == verdict


@pytest.mark.parametrize(("late", "verdict"), [(0.02345, HOLDS), (0.0236, PARTLY)])
def test_the_energy_is_that_of_its_coordinate_order(late, verdict):
    assert fig1_claims.energy_claim(data(torus=Cut(30, {12: 0.02345, 30: late}))).verdict == verdict
    assert fig1_claims.energy_claim(data(torus=Cut(30, {12: 0.0236, 30: 0.0236}))).verdict == FAILS


def test_amplitudes_of_order_24():
    rows = {22: (0.58488971, 0.41155524), 24: (0.58488972, 0.41155523)}

    def verdict(history):
        return fig1_claims.amplitudes_claim(
            SimpleNamespace(origin=SimpleNamespace(history=history), amplitudes={1: 0.58488971, 2: 0.41155524})
        ).verdict

    assert verdict(rows) == HOLDS
    assert verdict(rows | {24: (0.5849, 0.4116)}) == PARTLY
    assert verdict({24: (0.5849, 0.4116)}) == FAILS


@pytest.mark.parametrize(("decades", "wave", "verdict"), [(2, 0.1, HOLDS), (-0.1, 0.0, FAILS), (2, 1.5, FAILS)])
def test_exponential_decay_is_a_line(decades, wave, verdict):
    e = exponential(16, decades) * 10 ** (wave * (-1.0) ** np.arange(15))
    exact = SimpleNamespace(chain=Chain(16, alpha="0.33"), seeds=(1, 2), average_spectrum=lambda: e)
    assert fig1_claims.localized_claim(exact, lambda exact: 0.0).verdict == verdict
