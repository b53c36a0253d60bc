"""The ring of doubles against the symbolic ring and against the slow mode-space series, coefficient by coefficient."""

from fractions import Fraction

import numpy as np
import pytest
import symengine as se

from symfpu import Chain, SymfpuError, lindstedt
from symfpu.algebra.dense import predicted_bytes
from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes
from symfpu.series.divisors import Float64Divisors
from symfpu.series.recursion import run_recursion
from tests.oracles.cases import CASES, SHALLOW
from tests.tolerances import COEFFICIENT, HIGH_ORDER

# C_qlmn = 0 although the sum q + l + m + n is 2N and another is 0: two opposite terms, which only exact arithmetic sees.
CANCELLING = ("beta, three seeds",)


def fast(case):
    return lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order)


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
        assert case.name in CANCELLING or (ours[zero] == 0).all()
        assert (ours[~space.mask(doubles.degree(k))] == 0).all()
        assert np.abs(ours[zero]).max(initial=0) <= COEFFICIENT * np.abs(ours).max()


def test_threads_change_nothing_but_the_last_digits():
    """The same series with 2 and with 1 worker; the sums are cut differently only between blocks, so they are equal."""
    chain, seeds = Chain(N=32, alpha="0.33"), (1, 2, 3)
    frequencies = [Fraction(w) for w in ("0.0982", "0.1961", "0.2935")]
    results = []
    for workers in (1, 2):
        space = CosineModes(32, seeds, Grading(3, 7))
        ring = Float64Ring(space, workers=workers)
        run_recursion(ring, Float64Divisors(chain, space, frequencies), chain, 6, None)
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
    grading = Grading(1, 450)
    for size, exponent in ((190, 0), (210, 0), (-210, 0), (300, 1), (-300, -1)):
        ring = Float64Ring(CosineModes(8, (1,), grading))
        ring.put(1, ring.seed_terms())
        modes = np.zeros((226, 7))
        modes[-1, 0] = np.ldexp(0.5, size)
        ring.put(450, modes)
        tables, _, unit = ring.results()
        assert unit == Fraction(2) ** exponent
        assert tables[1][-1, 0] == np.ldexp(0.5, size - 449 * exponent)


@pytest.mark.parametrize("case", [CASES[2], CASES[7], CASES[-2]], ids=lambda c: c.name)
def test_predicted_bytes_bound_the_arrays(case):
    series = fast(case)
    stored = sum(table.nbytes for table in (*series.coordinates, *series.corrections))
    assert stored <= predicted_bytes(case.N, len(case.seeds), series.grading.degree, powers=1 + (case.beta != "0"))


@pytest.mark.parametrize(("N", "seeds"), [(6, (2, 3)), (4, (1, 2, 3)), (8, (1, 2, 6))])
def test_cancelling_couplings_are_exact_zeros_of_the_first_order(N, seeds):
    """Where l + m = N, couplings C of a third seed cancel; the doubles show the zeros of the universal form there."""
    chain = Chain(N, beta="0.3")
    doubles = lindstedt(chain, seeds, [str(w) for w in chain.frequencies()[np.array(seeds) - 1] * 1.01], 1)
    universal = lindstedt(chain, seeds, order=1)
    assert ((doubles.coordinates[1] == 0) == (universal.coordinates[1] == 0)).all()


def test_subnormal_numbers_are_kept_as_zero():
    """Products of them take a processor a hundred times as long, and they have lost digits."""
    ring = Float64Ring(CosineModes(8, (1,), Grading(1, 3)))
    ring.put(1, ring.seed_terms() * 2.0**-1030)
    assert not ring._bonds.any()
    ring = Float64Ring(CosineModes(8, (1,), Grading(1, 3)))
    ring.put(1, ring.seed_terms() * 2.0**-1000)
    assert ring._bonds.any()


@pytest.mark.parametrize("model", [{"alpha": "0.33"}, {"beta": "1"}, {"alpha": "0.2", "beta": "0.7"}, {"potential": "toda:1/2"}], ids=str)
def test_high_orders_agree_with_fixed_point_numbers(model):
    """A frequency next to a resonance: small harmonics are amplified, and keep their own last digits."""
    chain, omega = Chain(N=32, **model), "0.0990"
    doubles = lindstedt(chain, (1,), (omega,), 40)
    digits = lindstedt(chain, (1,), (omega,), 40, digits=20)
    for k in range(41):
        units = float(digits.unit / doubles.unit) ** (digits.degree(k) - 1)
        expected = digits.coordinates[k].floats(-digits.bits) * units
        difference = np.abs(doubles.coordinates[k] - expected)
        assert difference.max() <= HIGH_ORDER * np.abs(expected).max()
