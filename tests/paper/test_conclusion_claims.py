"""Claims of section 7 and Appendix E: real verdicts of what is cheap, both outcomes of all."""

from types import SimpleNamespace

import numpy as np
import pytest

from symfpu.paper import conclusion_claims as claims
from symfpu.paper.claims import FAILS, HOLDS, PARTLY


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
