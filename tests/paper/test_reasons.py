"""Claims beside the figures, each with every outcome; cheap ones by their own numbers."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu import Chain
from symfpu.paper import appendix_a_claims, breather_claims, fig4
from symfpu.paper import conclusion_claims as claims
from symfpu.paper.breather_claims import Closing
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.convergence_claims import commensurable_claim, digits_claim, incommensurable_claim
from symfpu.paper.convergence_fig1 import Variant
from symfpu.paper.natural_slopes import natural_slopes, natural_slopes_claim, tail_slope
from symfpu.paper.starts import printed_row, printed_torus
from symfpu.paper.table_claims import amplitudes_claim, energies_claim
from tests.tolerances import LEAST_SQUARES, RELATIVE_SHIFT, THOUSAND_ROUNDINGS


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
    from symfpu import frequency_shift

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
def test_the_algorithm_by_its_roots(errors, verdict):
    right, wrong = errors
    claim = appendix_a_claims.algorithm_claim(lambda chain, trial, *, printed: wrong if printed else right)
    assert claim.verdict == verdict


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


@pytest.mark.long
def test_what_is_quick_as_it_is():
    distance = claims.distance_claim(*claims.distances())
    assert (distance.verdict, "0.631 at H = 0.01" in distance.ours) == (HOLDS, True)
    slope = claims.similar_slope_claim(*claims.slopes())
    assert (slope.verdict, "seed 4: -98.27, by Eq. eksa2 -98.16" in slope.ours) == (HOLDS, True)
    products = claims.products_claim(*claims.products())
    assert (products.verdict, "k = 1: 4, 12, 24, 40; k = 2: 6, 21, 48, 90" in products.ours) == (PARTLY, True)


@pytest.mark.parametrize(("found", "verdict"), [((0.1, 0.2, 0.3), HOLDS), ((0.1, 0.3, 0.2), PARTLY), ((0.3, 0.2, 0.1), FAILS)])
def test_a_distance_that_grows(found, verdict):
    assert claims.distance_claim(("1", "2", "3"), found).verdict == verdict


@pytest.mark.parametrize(("counts", "verdict"), [((2, 5), HOLDS), ((2, 1, 5), PARTLY), ((2, 2), FAILS)])
def test_a_number_that_increases(counts, verdict):
    energies, chain = np.arange(1.0, len(counts) + 1), SimpleNamespace(N=4)
    found = SimpleNamespace(counts=np.array(counts), energies=energies, level=0.01, T=1.0, chain=chain)
    assert claims.number_claim(found).verdict == verdict


@pytest.mark.parametrize(("own", "verdict"), [((-10, -20), HOLDS), ((-10, -22), PARTLY), ((-11, -22), FAILS)])
def test_slopes_that_are_similar(own, verdict):
    assert claims.similar_slope_claim(own, (-10, -20)).verdict == verdict


@pytest.mark.parametrize(("counts", "verdict"), [((10, 200, 3000), HOLDS), ((10, 30, 90), PARTLY), ((10, 10, 30), FAILS)])
def test_numbers_of_terms(counts, verdict):
    assert claims.terms_claim(counts).verdict == verdict


def test_products_by_both_formulas():
    once, second = [2 * s * (s - 1) for s in claims.PACKETS], [4 * s**2 * (s - 1) for s in claims.PACKETS]
    assert claims.products_claim(once, second, once).verdict == HOLDS
    assert claims.products_claim(second, second, second).verdict == FAILS


@pytest.mark.long
def test_frequencies_and_terms_as_they_are():
    number = claims.number_claim(claims.numbers_of_frequencies())
    assert (number.verdict, "by frequency analysis" in number.ours) == (HOLDS, True)
    assert claims.terms_claim(claims.numbers_of_terms()).verdict == HOLDS


def test_the_slope_is_that_of_the_tail():
    """Level in the packet, exp(-20 kappa) beyond."""
    kappa = np.arange(1, 64) / 64
    spectrum = np.where(kappa < 16 / 64, 1.0, np.exp(-20 * kappa))
    assert tail_slope(spectrum, 8) == pytest.approx(20, rel=LEAST_SQUARES)


@pytest.mark.parametrize(("power", "verdict"), [(1.0, HOLDS), (1.5, PARTLY), (-1.0, FAILS)])
def test_slopes_go_with_a_power(power, verdict):
    x = np.array([6.0, 9.0, 14.0])
    assert natural_slopes_claim(x, 3.6 * x**power).verdict == verdict


@pytest.mark.long
def test_trajectories_of_one_seed_have_the_linear_law():
    assert natural_slopes_claim(*natural_slopes()).verdict == HOLDS


def test_the_saddle_of_a_mode_that_moves_alone():
    """At Q = -2a/(3c) of V = a Q^2 + c Q^3 the force vanishes, and V is the depth."""
    chain = Chain(3, alpha="0.25")
    Q = np.array([[0.0, 1.0], [0.0, -1.0]])
    plus, minus = chain.energy(Q, np.zeros((2, 2)))
    top = -(plus + minus) / 3 / ((plus - minus) / 2)
    saddle = np.array([0.0, top])
    assert chain.accelerations(saddle) == pytest.approx(np.zeros(2), abs=THOUSAND_ROUNDINGS)
    depth = chain.energy(saddle, np.zeros(2))
    assert breather_claims.saddle_energy(chain, 2) == pytest.approx(depth, rel=THOUSAND_ROUNDINGS)


@pytest.mark.parametrize(
    ("answers", "verdict"),
    [((True, False, True), PARTLY), ((True, True, True), HOLDS), ((True, True, False), FAILS)],
)
def test_breathers_of_every_energy(answers, verdict):
    """Below and above the saddle in alpha, and in beta."""
    left = list(answers)
    assert breather_claims.existence_claim(lambda chain, energy: left.pop(0)).verdict == verdict


@pytest.mark.long
def test_newton_finds_no_breather_above_the_saddle():
    claim = breather_claims.existence_claim()
    assert claim.verdict == PARTLY
    assert "a breather at 0.9 of it, none at 1.1" in claim.ours


def test_the_start_lacks_the_factor_of_the_modes():
    """Q_1(0) = A_1 (N/2)^(1/2): 4 A_1, sixteen times the energy."""
    row = printed_row("Fig. 7")
    claim = breather_claims.start_claim(row)
    assert claim.verdict == FAILS
    assert "Q_1(0) = 4 A_1" in claim.ours
    two = replace(row, chain=Chain(2, alpha=1), amplitudes=("1",))  # where the factor is 1
    assert breather_claims.start_claim(two).verdict == HOLDS


def closings(printed, own, excess=1e-5):
    return {"Fig. 7": Closing(printed, own, excess)}


@pytest.mark.parametrize(("printed", "own", "verdict"), [(12, 12, HOLDS), (8.7, 14.8, PARTLY), (2.0, 14.8, FAILS)])
def test_pairs_that_close(printed, own, verdict):
    claim = breather_claims.pairs_claim(closings(printed, own))
    assert claim.verdict == verdict
    assert ("was not solved" in claim.ours) == (own > printed + 1)


@pytest.mark.parametrize(("own", "verdict"), [(5.0, HOLDS), (14.8, PARTLY), (2.0, FAILS)])
def test_digits_of_initial_conditions(own, verdict):
    assert breather_claims.precision_claim(closings(own, own)).verdict == verdict


@pytest.mark.parametrize(("orders", "verdict"), [((60, 52), HOLDS), ((20, 60), PARTLY), ((20, 6), FAILS)])
def test_orders_beyond_which_little_is_gained(orders, verdict):
    arrivals = {f"Fig. {7 + i}": (order, 1e-14) for i, order in enumerate(orders)}
    assert breather_claims.orders_claim(arrivals).verdict == verdict


@pytest.mark.long
def test_the_breather_of_figure_8():
    """Six orders are enough; the printed amplitude is 4e-5 of itself too large, and closes to eight digits."""
    row = printed_row("Fig. 8")
    torus = printed_torus(row)
    found = breather_claims.closing(row, torus)
    assert found.own > 13
    assert 7.5 < found.printed < 9
    assert round(found.excess * 1e5) == 4
    assert breather_claims.arrival(torus)[0] <= 8
