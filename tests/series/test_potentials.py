"""Series of any potential: every ring gives the same, and differential equations give what powers give."""

import random

import numpy as np
import pytest

from symfpu import Chain, lindstedt
from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.residue import ResidueRing
from symfpu.proofs.certificates import random_point
from symfpu.series.residues import residue_series
from tests.tolerances import ROUNDING

POTENTIALS = ["toda:1/2", "toda:-2", "lj:12,6", "lj:5/2,1", "morse:2/3", "poly:1/3,0,1/5", "poly:0,0,1", "poly:0,1,0,1", "poly:0,0,0,1"]
CASES = [(8, (1, 2), ("0.392", "0.768")), (7, (3,), ("1.25",)), (2, (1,), ("1.42",)), (6, (2, 4), ("1.01", "1.75"))]


@pytest.fixture(params=CASES, ids=str)
def case(request):
    return request.param


def tables(series):
    """Coordinates and corrections in one unit, as doubles."""
    scale = float(series.unit)
    found = []
    for k in range(series.order + 1):
        factor = scale ** (series.degree(k) - 1)
        found.append(factor * np.asarray(series.tables.doubles(series.coordinates[k])))
        found.append(factor * np.asarray(series.tables.doubles(series.corrections[k])))
    return found


def assert_same(a, b, rounding):
    for x, y in zip(tables(a), tables(b), strict=True):
        assert np.abs(x - y).max(initial=0.0) <= rounding * np.abs(y).max(initial=0.0)


@pytest.mark.long
@pytest.mark.parametrize("text", POTENTIALS)
def test_all_rings_agree(text, case):
    N, seeds, frequencies = case
    chain = Chain(N, potential=text)
    doubles = lindstedt(chain, seeds, frequencies, order=5)
    assert_same(doubles, lindstedt(chain, seeds, frequencies, order=5, digits=25), 1e3 * ROUNDING)
    universal = lindstedt(chain, seeds, order=4, ring="nested").at(frequencies=frequencies)
    assert_same(universal, lindstedt(chain, seeds, frequencies, order=4), 1e3 * ROUNDING)


@pytest.mark.parametrize("text", ["toda:1/2", "lj:12,6", "lj:5/2,1", "morse:2/3"])
def test_differential_equations_give_what_powers_give(text, case, monkeypatch):
    N, seeds, frequencies = case
    chain = Chain(N, potential=text)
    grown = lindstedt(chain, seeds, frequencies, order=12)
    monkeypatch.setattr(Float64Ring, "grows", False)
    powers = lindstedt(chain, seeds, frequencies, order=12)
    assert_same(grown, powers, 1e3 * ROUNDING)


@pytest.mark.parametrize("text", ["toda:1/2", "lj:12,6", "lj:5/2,1", "morse:2/3"])
def test_differential_equations_give_what_powers_give_modulo_a_prime(text, monkeypatch):
    chain, seeds, order = Chain(8, potential=text), (1, 2), 7
    point = random_point(8, len(seeds), order + 1, random.Random(3))
    grown = residue_series(chain, seeds, point, order)
    monkeypatch.setattr(ResidueRing, "grows", False)
    powers = residue_series(chain, seeds, point, order)
    for table, other in zip(grown.coordinates, powers.coordinates, strict=True):
        assert np.array_equal((table - other) % point.prime, np.zeros_like(table))
    assert all(np.any(table) for table in grown.coordinates)


def test_the_fpu_chain_is_the_polynomial():
    chain = Chain(8, alpha="1/3", beta="1/7")
    assert Chain(8, potential="poly:1/3,1/7") == chain
    long = lindstedt(Chain(8, potential="poly:1/3,1/7,1e-45"), (1,), ("0.392",), order=6)
    assert_same(long, lindstedt(chain, (1,), ("0.392",), order=6), ROUNDING)


def test_one_product_a_degree_and_function():
    """Toda multiplies less than alpha + beta, and Morse and Lennard-Jones not twice what Toda does."""
    counts = {}
    for text in ("toda:1/4", "morse:1/4", "lj:12,6", "poly:1/4,1/24"):
        counts[text] = lindstedt(Chain(16, potential=text), (1, 2), ("0.197", "0.391"), order=9).multiply_adds
    assert counts["toda:1/4"] < counts["poly:1/4,1/24"]
    assert max(counts["lj:12,6"], counts["morse:1/4"]) <= 2 * counts["toda:1/4"]
