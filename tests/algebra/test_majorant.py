"""The proved radii hold: no coefficient is further from the one of many more digits than its radius says."""

from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest

from symfpu.algebra import majorant
from symfpu.algebra.fixedpoint import FixedPointRing, Modes, Precision
from symfpu.algebra.majorant import MajorantRing
from symfpu.algebra.words import LIMB_BITS, IntegerTable, words_of
from symfpu.chain.chain import Chain
from symfpu.series.divisors import FixedPointDivisors, Float64Divisors
from symfpu.series.fixed_point import _moduli
from symfpu.series.lindstedt import lindstedt
from symfpu.series.monomials import monomial_space
from symfpu.series.recursion import run_recursion
from tests.oracles.cases import CASES, Case
from tests.tolerances import NEAREST, RADIUS_ROUNDING

DIGITS = 30
MORE_BITS = 80  # with them the other run is exact, as far as 30 digits can see
HEADROOM = 60

LONG = (
    Case("alpha, order 30", 32, "0.33", "0", (1,), ("0.0984",), 30),
    Case("alpha, small divisors", 16, "0.33", "0", (1, 2), ("0.19626", "0.39046"), 10),
    Case("alpha, nearly resonant", 8, "0.3", "0", (1,), ("0.382683433",), 6),
    Case("beta, large", 16, "0", "100", (2, 3), ("0.401", "0.592"), 4),
    Case("both, uneven", 12, "0.001", "10", (5,), ("1.28",), 6),
)


class Compared(NamedTuple):
    """A series at 30 digits, the errors of its tables and their radii, all in units of the last place, by table."""

    series: object
    errors: list
    radii: list


def tables(space, series, precision):
    """All coordinates and corrections of a fixed-point run, as integers."""
    ring = FixedPointRing(space, precision)
    divisors = FixedPointDivisors(series.chain, series.seeds, series.frequencies, precision.bits)
    run_recursion(ring, divisors, series.chain, series.order, None)
    coordinates, corrections, _ = ring.results()
    return [table.integers() for table in (*coordinates, *corrections)]


def compared(case):
    series = lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order, digits=DIGITS)
    space = monomial_space(series.chain, series.seeds, series.order)
    ours = [table.integers() for table in (*series.coordinates, *series.corrections[1:])]
    exact = tables(space, series, Precision(series.bits + MORE_BITS, HEADROOM, series.unit))
    bound = MajorantRing(space, *_moduli(series, series.unit), series.unit, 2.0**-series.bits)
    moduli = FixedPointDivisors(series.chain, series.seeds, series.frequencies, series.bits).moduli()
    run_recursion(bound, moduli, series.chain, series.order, None)
    coordinates, corrections, _ = bound.results()
    errors = [_in_units((a << MORE_BITS) - b) for a, b in zip(ours, exact, strict=True)]
    return Compared(series, errors, [*coordinates, *corrections])


def _in_units(differences):
    floats = [float(Fraction(int(x), 2**MORE_BITS)) for x in differences.ravel()]
    return np.abs(np.array(floats)).reshape(differences.shape)


@pytest.fixture(scope="module")
def all_compared():
    return Cases()


class Cases(dict):
    """Compared when they are first asked for."""

    def __missing__(self, name):
        self[name] = compared(next(case for case in CASES + LONG if case.name == name))
        return self[name]


ALL = [*CASES, *(pytest.param(case, marks=pytest.mark.long) for case in LONG)]


@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_no_coefficient_is_off_by_more_than_its_radius(case, all_compared):
    """Measured: the largest radius of a table is 5 to 1100 times its largest error, mostly 10 to 100, growing with the order:
    signs cancel in the errors, moduli do not. That costs one to three guard digits."""
    _, errors, radii = all_compared[case.name]
    for error, radius in zip(errors, radii, strict=True):
        assert error.shape == radius.shape
        assert (error <= radius).all()


@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_the_series_carries_these_radii(case, all_compared):
    """For the coordinates the largest of each order, for the corrections each one."""
    series, errors, radii = all_compared[case.name]
    orders = series.order + 1
    for k, (coordinate, correction) in enumerate(series.radii):
        assert errors[k].max() <= coordinate == radii[k].max()
        if k:
            assert (correction == radii[orders + k - 1]).all()
            assert (errors[orders + k - 1] <= correction).all()


@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_radii_are_not_absurd(case, all_compared):
    """Half a thousand thousand is far above what was measured; a bound without cancellation of a long series may get there."""
    _, errors, radii = all_compared[case.name]
    for error, radius in zip(errors, radii, strict=True):
        assert radius.max(initial=0) <= 1e6 * max(error.max(initial=0), 0.5)


@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_radii_keep_the_promise(case, all_compared):
    """Every radius is below 10^-digits of the largest coefficient of its order, unless all of them vanish."""
    series, _, radii = all_compared[case.name]
    for table, radius in zip((*series.coordinates, *series.corrections[1:]), radii, strict=True):
        size = np.abs(table.floats()).max(initial=0.0)
        assert radius.max(initial=0.0) <= size * 10.0**-DIGITS or size == 0


@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_zero_radii_are_exact_coefficients(case, all_compared):
    """Seeds, and what the selection rules and the gauge forbid; everything else was rounded at least once."""
    series, errors, radii = all_compared[case.name]
    for k, (error, radius) in enumerate(zip(errors[: series.order + 1], radii, strict=False)):
        assert not error[radius == 0].any()
        values = series.coordinates[k].words.any(axis=-1)
        assert k == 0 or (radius[values] >= 0.5).all()


@pytest.mark.parametrize("case", CASES[::4], ids=lambda c: c.name)
def test_sums_stay_below_the_headroom(case, all_compared):
    """Where the primes do not reach, the ring says so instead of wrapping around."""
    series = all_compared[case.name].series
    space = monomial_space(series.chain, series.seeds, series.order)
    with pytest.raises(OverflowError):
        tables(space, series, Precision(series.bits, -40, series.unit))


def test_radii_grow_with_the_size_of_the_multipliers():
    """Nearer to a resonance the errors are larger, and the radii say so."""
    radii = [
        lindstedt(Chain(8, "0.3"), (1,), (w,), 6, digits=DIGITS).radii[1][0] for w in ("0.39", "0.383", "0.3827", "0.38268", "0.38268343")
    ]
    assert all(a < b for a, b in pairwise(radii))


def test_a_bound_for_fewer_bits_is_no_smaller_in_units():
    """epsilon multiplies products of two radii: it can only add."""
    case = CASES[2]
    series = lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order, digits=DIGITS)
    space = monomial_space(series.chain, series.seeds, series.order)
    found = []
    for epsilon in (0.0, 2.0**-100, 2.0**-8):
        ring = MajorantRing(space, *_moduli(series, series.unit), series.unit, epsilon)
        divisors = Float64Divisors(series.chain, series.seeds, series.frequencies, space.grading.degree)
        run_recursion(ring, divisors, series.chain, case.order, None)
        found.append(ring.results()[0])
    for none, few, many in zip(*found, strict=True):
        assert (none <= few).all()
        assert (few <= many).all()
    assert (found[2][-1] > found[0][-1]).any()


def test_radii_of_a_changed_coupling_are_its_own():
    series = lindstedt(Chain(8, "0.3", "0.1"), (1,), ("0.39",), 4, digits=DIGITS)
    other = lindstedt(series.chain.at(beta="0.2"), (1,), ("0.39",), 4, digits=DIGITS)
    assert series.radii[2][0] != other.radii[2][0]


class Coarse(FixedPointRing):
    """Many more bits, but one kind of number is rounded to few: its error is the only one. source : which, if any."""

    def __init__(self, space, precision, source):
        self.source, self._inside = source, False
        super().__init__(space, precision)

    def _cosines(self, weights):
        of_integers = self.basis.of_integers
        if self.source == "cosines" and np.ndim(weights) == 1 and (np.asarray(weights) == 1).all():
            self.basis.of_integers = lambda x: of_integers(((x + (1 << (MORE_BITS - 1))) >> MORE_BITS) << MORE_BITS)
        try:
            return super()._cosines(weights)
        finally:
            self.basis.of_integers = of_integers

    def _bonds(self, products, power):
        self._inside = self.source == "bonds"
        try:
            return super()._bonds(products, power)
        finally:
            self._inside = False

    def _rounded(self, residues):
        return self._coarse(residues) if self._inside else super()._rounded(residues)

    def correct(self, degree, corrections):
        if self.source == "corrections" and corrections.table.size:
            residues, words = self._coarse(corrections.residues.reshape(len(self.basis), -1), keep=True)
            table = IntegerTable(words.reshape(*corrections.table.shape, -1))
            corrections = Modes(residues.reshape(corrections.residues.shape), table)
        super().correct(degree, corrections)

    def _coarse(self, residues, keep=False):
        """Rounded at few bits; keep : there are bits 2^-bits already, not twice of them."""
        drop = 0 if keep else self._drop
        limbs = self.basis.limbs(residues.copy(), drop + MORE_BITS // LIMB_BITS)
        limbs = np.vstack([np.zeros((MORE_BITS // LIMB_BITS, limbs.shape[1])), limbs])
        return self.basis.residues(limbs), words_of(limbs)


class CoarseDivisors(FixedPointDivisors):
    """Multipliers of many bits, rounded down to few."""

    def multipliers(self, harmonics, carried, order):
        return (super().multipliers(harmonics, carried, order) >> MORE_BITS) << MORE_BITS


ISOLATED = (
    Case("beta, two bonds", 2, "0", "0.5", (1,), ("1.45",), 8),
    Case("alpha, four bonds", 4, "0.4", "0", (1,), ("0.78",), 8),
    Case("beta, four bonds", 4, "0", "0.4", (3,), ("1.86",), 5),
    Case("both, two seeds", 3, "0.4", "0.2", (1, 2), ("1.02", "1.76"), 5),
    Case("alpha, six bonds", 6, "0.3", "0", (1, 2), ("0.52", "1.01"), 6),
)


@pytest.mark.parametrize("source", ["multipliers", "cosines", "bonds", "corrections"])
@pytest.mark.parametrize("case", ISOLATED, ids=lambda c: c.name)
def test_each_source_of_errors_is_bounded_alone(case, source, monkeypatch):
    """Only one kind of number is rounded, only its terms are in the bound: no other term can hide a missing one."""
    series = lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order, digits=DIGITS)
    space = monomial_space(series.chain, series.seeds, series.order)
    found = []
    for kind in ("", source):
        ring = Coarse(space, Precision(series.bits + MORE_BITS, HEADROOM, series.unit), kind)
        kinds = CoarseDivisors if kind == "multipliers" else FixedPointDivisors
        run_recursion(ring, kinds(series.chain, series.seeds, series.frequencies, ring.precision.bits), series.chain, series.order, None)
        found.append([table.integers() for part in ring.results()[:2] for table in part])
    errors = [_in_units(a - b) for a, b in zip(*found, strict=True)]
    if source != "multipliers":
        monkeypatch.setattr(majorant, "MULTIPLIER", 0.0)
    if source != "bonds":
        monkeypatch.setattr(majorant, "NEAREST_ROUNDING", 1e-15)
    bound = MajorantRing(space, *_moduli(series, series.unit), series.unit, 2.0**-series.bits)
    if source in ("multipliers", "corrections"):
        bound._noise *= 0
    if source == "corrections":
        correct = bound.correct
        monkeypatch.setattr(bound, "correct", lambda degree, radii: correct(degree, radii + NEAREST))
    if source == "bonds":
        monkeypatch.setattr(bound, "put", _without_noise(bound))
    divisors = Float64Divisors(series.chain, series.seeds, series.frequencies, space.grading.degree)
    run_recursion(bound, divisors, series.chain, series.order, None)
    coordinates, corrections, _ = bound.results()
    assert max(error.max(initial=0.0) for error in errors) > 0
    for error, radius in zip(errors, [*coordinates, *corrections], strict=True):
        assert (error <= radius + RADIUS_ROUNDING).all()


def _without_noise(ring):
    put, noise = ring.put, ring._noise

    def quiet(degree, modes):
        ring._noise = 0 * noise
        put(degree, modes)
        ring._noise = noise

    return quiet
