"""The ring of doubles against the symbolic ring and against the slow mode-space series, coefficient by coefficient."""

import math
from fractions import Fraction
from itertools import pairwise

import mpmath
import numpy as np
import pytest
import symengine as se

from symfpu.algebra.dense import predicted_bytes
from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes
from symfpu.chain.chain import Chain
from symfpu.errors import SymfpuError
from symfpu.numbers.typed import exact
from symfpu.series.divisors import Float64Divisors
from symfpu.series.lindstedt import lindstedt
from symfpu.series.recursion import run_recursion
from tests.oracles.cases import CASES, SHALLOW
from tests.oracles.mode_space import ModeSpaceSeries
from tests.oracles.trigonometric import from_amplitudes, from_monomials
from tests.oracles.universal import DIGITS, Numbers, evaluate
from tests.tolerances import COEFFICIENT

# C_qlmn = 0 although the sum q + l + m + n is 2N and another is 0: two opposite terms, which only exact arithmetic sees.
CANCELLING = ("beta, three seeds",)


def fast(case):
    return lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order)


def numbers_for(case, series):
    return Numbers(case, [nu for d in range(series.degree(case.order) + 1) for nu in series.grading.harmonics(d)[0].tolist()])


@pytest.mark.parametrize("case", SHALLOW, ids=lambda c: c.name)
def test_tables_are_those_of_the_symbolic_ring(case):
    doubles = fast(case)
    symbols = lindstedt(doubles.chain, case.seeds, order=case.order)
    assert doubles.grading.degree == symbols.grading.degree
    with mpmath.workdps(DIGITS):
        numbers = numbers_for(case, doubles)
        for kind in ("coordinates", "corrections"):
            for ours, entries in zip(getattr(doubles, kind), getattr(symbols, kind), strict=True):
                expected = np.array([float(evaluate(entry, numbers)) for entry in np.ravel(entries)]).reshape(entries.shape)
                assert ours.shape == expected.shape
                assert np.abs(ours - expected).max(initial=0) <= COEFFICIENT * np.abs(expected).max(initial=0)


@pytest.mark.parametrize("case", SHALLOW, ids=lambda c: c.name)
def test_zeros_are_exact(case):
    """A coefficient is exactly zero where the selection rules, the gauge or the parity say so, and nowhere else.

    Exact arithmetic finds further zeros, where couplings of both signs cancel; there the doubles leave rounding.
    """
    doubles = fast(case)
    symbols = lindstedt(doubles.chain, case.seeds, order=case.order)
    space = CosineModes(case.N, case.seeds, doubles.grading)
    for k, (ours, entries) in enumerate(zip(doubles.coordinates, symbols.coordinates, strict=True)):
        zero = np.array([se.expand(value) == 0 for value in np.ravel(entries)]).reshape(entries.shape)
        assert zero[ours == 0].all()
        assert (ours[~space.mask(doubles.degree(k))] == 0).all()
        assert np.abs(ours[zero]).max(initial=0) <= COEFFICIENT * np.abs(ours).max()


@pytest.mark.parametrize("case", [case for case in SHALLOW if case.name not in CANCELLING], ids=lambda c: c.name)
def test_zeros_agree_with_the_symbolic_ring(case):
    doubles = fast(case)
    symbols = lindstedt(doubles.chain, case.seeds, order=case.order)
    for ours, entries in zip(doubles.coordinates, symbols.coordinates, strict=True):
        assert ((ours == 0) == (entries == 0)).all()


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_series_is_that_of_mode_space(case):
    series = fast(case)
    oracle = ModeSpaceSeries(case.N, case.alpha, case.beta, case.seeds, case.frequencies, case.order)
    for k in range(case.order + 1):
        compare({q: from_monomials(*series.coefficients(q, k)) for q in range(1, case.N)}, {q: oracle.Q[q][k] for q in oracle.Q})
        for squared, theirs in ((True, oracle.omega_squared), (False, oracle.omega)):
            ours = {q: from_amplitudes(*series.frequency_coefficients(q, k, squared=squared)) for q in case.seeds}
            compare(ours, {q: theirs[q][k] for q in case.seeds})


def compare(ours, theirs):
    """All coefficients of one order, relative to the largest of them."""
    scale = max((abs(value) for terms in theirs.values() for value in terms.values()), default=0)
    for q, terms in theirs.items():
        for key in terms.keys() | ours[q].keys():
            assert abs(ours[q].get(key, 0.0) - terms.get(key, 0.0)) <= COEFFICIENT * scale


def test_multiply_adds_are_counted():
    """Each order adds products; the count does not depend on the couplings."""
    counts = [lindstedt(Chain(N=8, alpha=a), (1,), ("0.4",), order).multiply_adds for a in ("0.1", "1") for order in (1, 2, 3)]
    assert 0 < counts[0] < counts[1] < counts[2]
    assert counts[:3] == counts[3:]


def test_threads_change_nothing_but_the_last_digits():
    """The same series with 2 and with 1 worker; the sums are cut differently only between blocks, so they are equal."""
    chain, seeds = Chain(N=32, alpha="0.33"), (1, 2, 3)
    frequencies = [exact(w, "w") for w in ("0.0982", "0.1961", "0.2935")]
    results = []
    for workers in (1, 2):
        space = CosineModes(32, seeds, Grading(3, 7))
        ring = Float64Ring(space, workers=workers)
        run_recursion(ring, Float64Divisors(chain, seeds, frequencies, 7), chain, 6, None)
        results.append(ring.results()[0])
    assert all((one == two).all() for one, two in zip(*results, strict=True))
    assert np.abs(results[0][-1]).max() > 0


def test_high_orders_do_not_overflow():
    """Order 250 of a breather: its unscaled coefficients exceed doubles, its terms at a small amplitude do not."""
    series = lindstedt(Chain(N=32, alpha="0.33"), (1,), ("0.0984",), 250)
    assert all(np.isfinite(table).all() and np.abs(table).max() > 0 for table in series.coordinates)
    with pytest.raises(SymfpuError, match="beyond the range of doubles"):
        series.coefficients(1, 250)
    terms = [np.abs(series.harmonic_terms([0.2], k)[1]).max() for k in range(251)]
    assert 0 < terms[250] < terms[100] < terms[1]


def test_a_degree_is_moved_only_nearer_to_one():
    """A step of the exponent moves degree 450 by 449 powers: 2^210 stays, 2^300 becomes 2^-149."""
    for size, exponent in ((190, 0), (210, 0), (-210, 0), (300, 1), (-300, -1)):
        ring = Float64Ring(CosineModes(8, (1,), Grading(1, 450)))
        ring.put(1, ring.seed_terms())
        modes = np.zeros((226, 7))
        modes[-1, 0] = np.ldexp(0.5, size)
        ring.put(450, modes)
        tables, _, unit = ring.results()
        assert unit == Fraction(2) ** exponent
        assert tables[1][-1, 0] == np.ldexp(0.5, size - 449 * exponent)


@pytest.mark.parametrize("cubic", [False, True])
def test_predicted_bytes_grow_with_the_order(cubic):
    sizes = [predicted_bytes(32, 3, degree, powers=2 if cubic else 1) for degree in range(1, 20)]
    assert all(a < b for a, b in pairwise(sizes))


@pytest.mark.parametrize("case", [CASES[2], CASES[7], CASES[-2]], ids=lambda c: c.name)
def test_predicted_bytes_bound_the_arrays(case):
    series = fast(case)
    stored = sum(table.nbytes for table in (*series.coordinates, *series.corrections))
    assert stored <= predicted_bytes(case.N, len(case.seeds), series.grading.degree, powers=1 + (case.beta != "0"))


def test_higher_orders_change_no_digit_of_the_lower_ones():
    """Scaling is by powers of two and multipliers do not depend on the top order: the series to 120 begins with that to 20."""
    short, long = (lindstedt(Chain(32, "0.33"), (1,), ("0.0984",), order) for order in (20, 120))
    for k in range(21):
        shift = round(math.log2(long.unit / short.unit)) * (long.degree(k) - 1)
        assert (np.ldexp(long.coordinates[k], shift) == short.coordinates[k]).all()


@pytest.mark.parametrize(("N", "seeds"), [(6, (2, 3)), (4, (1, 2, 3)), (8, (1, 2, 6))])
def test_cancelling_couplings_are_exact_zeros_of_the_first_order(N, seeds):
    """Where l + m = N, couplings C of a third seed cancel; the doubles show the zeros of the universal form there."""
    chain = Chain(N, beta="0.3")
    doubles = lindstedt(chain, seeds, [str(w) for w in chain.frequencies()[np.array(seeds) - 1] * 1.01], 1)
    universal = lindstedt(chain, seeds, order=1)
    assert ((doubles.coordinates[1] == 0) == (universal.coordinates[1] == 0)).all()
