"""Claims that were judged by hand once, each with both outcomes; cheap ones by their own numbers."""

from types import SimpleNamespace

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.paper import appendix_a_claims, fig4
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.convergence_claims import commensurable_claim, digits_claim, incommensurable_claim
from symfpu.paper.convergence_fig1 import Variant
from symfpu.paper.table_claims import amplitudes_claim, energies_claim
from tests.tolerances import RELATIVE_SHIFT


def variant(name, settling=1.0, sums=1.0):
    return Variant(name, {14: (1e-5, settling * 2e-5)}, sums * np.array([0.0, 1e-3, 1e-6]), np.ones(3))


def study(*, coincidence=(19523, -9813), appended=1.0, rounded=1.0, grown=1.49425):
    cases = [variant("doubles"), variant("40 digits"), variant("rounded", sums=rounded), variant("appended", settling=appended)]
    return SimpleNamespace(variants=(*cases, variant("detuned")), coincidence=coincidence, ratios={40: 1.0, 42: grown}, pole=0.66928)


def test_the_first_harmonic_at_rest_decides_on_commensurability():
    assert incommensurable_claim(study()).verdict == HOLDS
    assert "order 29335" in incommensurable_claim(study()).ours
    assert incommensurable_claim(study(coincidence=(15, -14))).verdict == FAILS


@pytest.mark.parametrize(("changed", "grown", "verdict"), [(1.0, 1.49425, FAILS), (1.0, 1.3, PARTLY), (0.5, 1.49425, HOLDS)])
def test_a_reason_that_is_taken_away_without_effect_is_none(changed, grown, verdict):
    """But where the pole does not explain the curves either, it is not refuted."""
    assert commensurable_claim(study(appended=changed, grown=grown)).verdict == verdict
    assert digits_claim(study(rounded=changed, grown=grown)).verdict == verdict


def test_the_right_bracket_is_the_frequency_shift_and_the_printed_one_misses_roots():
    from symfpu.chain.frequency_shift import frequency_shift

    chain, trial = Chain(9, alpha="0.3"), {1: 0.2, 3: 0.1}
    linear = dict(enumerate(chain.frequencies().tolist(), 1))
    right = appendix_a_claims.bracket(chain, trial, linear, printed=False)
    assert list(right.values()) == pytest.approx(list(frequency_shift(chain, trial).values()), rel=RELATIVE_SHIFT)
    claim = appendix_a_claims.algorithm_claim()
    assert claim.verdict == PARTLY
    right, wrong = claim.ours.split("; as Eqs.")
    assert "no real root" not in right
    assert "Fig. 5a: no real root" in wrong


@pytest.mark.parametrize(("errors", "verdict"), [((0.01, 0.02), HOLDS), ((0.01, None), PARTLY), ((None, None), FAILS)])
def test_the_algorithm_by_its_roots(monkeypatch, errors, verdict):
    right, wrong = errors
    monkeypatch.setattr(appendix_a_claims, "_error", lambda chain, trial, *, printed: wrong if printed else right)
    assert appendix_a_claims.algorithm_claim().verdict == verdict


def row(label, met=(), matches=(), orders=()):
    return SimpleNamespace(
        printed=SimpleNamespace(label=label), met=met, best=4, digits={4: 7.5}, energy_matches=matches, energy_orders=dict.fromkeys(orders)
    )


def test_amplitudes_of_the_table():
    assert amplitudes_claim([row("a", met=(4,))]).verdict == HOLDS
    assert amplitudes_claim([row("a", met=(4,)), row("b")]).verdict == PARTLY
    assert "not by b (7.5 digits" in amplitudes_claim([row("a", met=(4,)), row("b")]).ours
    assert amplitudes_claim([row("b")]).verdict == FAILS


def test_energies_of_the_table():
    total, harmonic = row("a", matches=("H(0)",)), row("b", matches=("harmonic energy at t = 0",))
    cut, none = row("c", orders=("H(0)",)), row("d")
    assert energies_claim([total]).verdict == HOLDS
    mixed = energies_claim([total, harmonic, cut, none])
    assert mixed.verdict == PARTLY
    assert "another energy of the printed order in b; an energy of another coordinate order in c; none of ours in d" in mixed.ours
    assert energies_claim([harmonic]).verdict == FAILS


@pytest.mark.parametrize(("weak", "strong", "verdict"), [(1.0, 0.7, HOLDS), (1.0, 1.0, FAILS), (0.7, 0.7, PARTLY)])
def test_where_slopes_leave_the_law(weak, strong, verdict):
    """Slopes so many times those of the law: near at small lambda, off at large, is what the paper says."""
    factor = fig4.SLOPE_CHAIN / fig4.SLOPE_SEEDS
    shares = {"weak": weak, "strong": strong}
    trends = {name: SimpleNamespace(y=shares[name] * factor * np.log10(values)) for name, values in fig4.LAMBDAS.items()}
    assert fig4.validity_claim(trends).verdict == verdict
