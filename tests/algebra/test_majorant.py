"""The proved radii hold: no coefficient is further from the one of many more digits than its radius says."""

from fractions import Fraction
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from symfpu import Chain, lindstedt
from symfpu.algebra import majorant
from symfpu.algebra.fixedpoint import FixedPointRing, Modes, Precision
from symfpu.algebra.majorant import MajorantRing
from symfpu.algebra.words import LIMB_BITS, IntegerTable, divided, words_of
from symfpu.series import fixed_point
from symfpu.series.divisors import EnlargedMultipliers, FixedPointDivisors, Float64Divisors
from symfpu.series.fixed_point import _moduli
from symfpu.series.force import positive_growths
from symfpu.series.monomials import monomial_space
from symfpu.series.recursion import run_recursion
from tests.oracles.cases import CASES, Case
from tests.tolerances import NEAREST, RADIUS_ENLARGED, RADIUS_OF_GROWTHS, RADIUS_ROUNDING

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
    divisors = FixedPointDivisors(series.chain, space, series.frequencies, precision.bits)
    run_recursion(ring, divisors, series.chain, series.order, None)
    coordinates, corrections, _ = ring.results()
    return [table.integers() for table in (*coordinates, *corrections)]


@cache
def compared(case):
    series = lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order, digits=DIGITS)
    space = monomial_space(series.chain, series.seeds, series.order)
    ours = [table.integers() for table in (*series.coordinates, *series.corrections[1:])]
    exact = tables(space, series, Precision(series.bits + MORE_BITS, HEADROOM, series.unit))
    errors = [_in_units((a << MORE_BITS) - b) for a, b in zip(ours, exact, strict=True)]
    return Compared(series, errors, bounds_of(series, space))


def _in_units(differences):
    floats = [float(Fraction(int(x), 2**MORE_BITS)) for x in differences.ravel()]
    return np.abs(np.array(floats)).reshape(differences.shape)


ALL = [*CASES, *(pytest.param(case, marks=pytest.mark.long) for case in LONG)]


@pytest.mark.long
@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_no_coefficient_is_off_by_more_than_its_radius(case):
    """Measured: the largest radius of a table is 5 to 1100 times its largest error, mostly 10 to 100, growing with the order:
    signs cancel in the errors, moduli do not. That costs one to three guard digits."""
    _, errors, radii = compared(case)
    for error, radius in zip(errors, radii, strict=True):
        assert error.shape == radius.shape
        assert (error <= radius).all()


@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_the_series_carries_these_radii(case):
    """For the coordinates the largest of each order, for the corrections each one; of moduli that doubles gave, enlarged."""
    series, errors, radii = compared(case)
    orders = series.order + 1
    for k, (coordinate, correction) in enumerate(series.radii):
        own = radii[k].max()
        assert errors[k].max() <= own <= coordinate <= own * RADIUS_ENLARGED
        if k:
            own = radii[orders + k - 1]
            assert (errors[orders + k - 1] <= own).all()
            assert (own <= correction).all()
            assert (correction <= own * RADIUS_ENLARGED).all()


@pytest.mark.parametrize("misled", ["_cover", "multipliers"])
@pytest.mark.parametrize("case", CASES[::4], ids=lambda c: c.name)
def test_where_doubles_do_not_cover_the_result_its_own_moduli_do(case, misled, monkeypatch):
    """The same integers; radii are then just those of the moduli that were found."""
    series, _, radii = compared(case)
    if misled == "_cover":
        monkeypatch.setattr(fixed_point, "_cover", lambda *_: False)
    else:
        monkeypatch.setattr(EnlargedMultipliers, "enlarged", 1 - 2.0**-30)
    again = lindstedt(series.chain, series.seeds, series.frequencies, series.order, digits=DIGITS)
    assert all((a.words == b.words).all() for a, b in zip(series.coordinates, again.coordinates, strict=True))
    assert [coordinate for coordinate, _ in again.radii] == [radius.max() for radius in radii[: series.order + 1]]


@pytest.mark.parametrize("change", ["coordinate", "correction"])
def test_one_coefficient_above_what_doubles_say_is_seen(change):
    chain, seeds = Chain(8, "0.3"), (1, 2)
    series = lindstedt(chain, seeds, ("0.39", "0.77"), 4, digits=DIGITS)
    found = _moduli(series, series.unit)
    expected = fixed_point._enlarged(found, monomial_space(chain, seeds, 4))
    assert fixed_point._cover(expected, found)
    table = found.tables[5] if change == "coordinate" else found.corrections[4]
    table.flat[np.argmax(table)] *= 1 + 2.0**-19
    assert not fixed_point._cover(expected, found)


@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_radii_are_not_absurd(case):
    """Half a thousand thousand is far above what was measured; a bound without cancellation of a long series may get there."""
    _, errors, radii = compared(case)
    for error, radius in zip(errors, radii, strict=True):
        assert radius.max(initial=0) <= 1e6 * max(error.max(initial=0), 0.5)


@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_radii_keep_the_promise(case):
    """Every radius is below 10^-digits of the largest coefficient of its order, unless all of them vanish."""
    series, _, radii = compared(case)
    for table, radius in zip((*series.coordinates, *series.corrections[1:]), radii, strict=True):
        size = np.abs(table.floats()).max(initial=0.0)
        assert radius.max(initial=0.0) <= size * 10.0**-DIGITS or size == 0


@pytest.mark.parametrize("case", ALL, ids=lambda c: c.name)
def test_zero_radii_are_exact_coefficients(case):
    """Seeds, and what the selection rules and the gauge forbid; everything else was rounded at least once."""
    series, errors, radii = compared(case)
    for k, (error, radius) in enumerate(zip(errors[: series.order + 1], radii, strict=False)):
        assert not error[radius == 0].any()
        values = series.coordinates[k].words.any(axis=-1)
        assert k == 0 or (radius[values] >= 0.5).all()


@pytest.mark.parametrize("case", CASES[::4], ids=lambda c: c.name)
def test_sums_stay_below_the_headroom(case):
    """Where the primes do not reach, the ring says so instead of wrapping around."""
    series = compared(case).series
    space = monomial_space(series.chain, series.seeds, series.order)
    with pytest.raises(OverflowError):
        tables(space, series, Precision(series.bits, -40, series.unit))


GROWN = (
    (Chain(8, potential="toda:1/2"), (1, 2), ("0.392", "0.768"), 5),
    (Chain(7, potential="lj:12,6"), (3,), ("1.25",), 8),
    (Chain(2, potential="morse:-2/3"), (1,), ("1.42",), 8),
    (Chain(6, potential="lj:6.0001,6"), (2, 4), ("1.01", "1.75"), 4),  # a small difference of its powers
    (Chain(5, potential="expr:(exp(r)-1-r)/2+(exp(-2*r)-1+2*r)/8"), (3,), ("1.63",), 6),  # exponentials of both directions
)


def names(case):
    return f"{case[0].potential}, N={case[0].N}"


@pytest.mark.parametrize("case", [GROWN[2], *(pytest.param(case, marks=pytest.mark.long) for case in GROWN)], ids=names)
def test_radii_of_grown_forces_hold_against_powers(case, monkeypatch):
    """No coefficient is further than its radius from that of plain powers with many more bits.

    Nor is a radius above the one of powers, but by what is lost where functions cancel.
    """
    chain, seeds, frequencies, order = case
    series = lindstedt(chain, seeds, frequencies, order, digits=DIGITS)
    space = monomial_space(chain, series.seeds, order)
    ours = [table.integers() for table in (*series.coordinates, *series.corrections[1:])]
    grown = bounds_of(series, space)
    monkeypatch.setattr(FixedPointRing, "grows", False)
    monkeypatch.setattr(MajorantRing, "grows", False)
    exact = tables(space, series, Precision(series.bits + MORE_BITS, HEADROOM, series.unit))
    powers = bounds_of(series, space)
    lost = float(sum(abs(growth.weight * growth.rate) for growth in chain.potential.growths()))
    for a, b, radius, other in zip(ours, exact, grown, powers, strict=True):
        assert (_in_units((a << MORE_BITS) - b) <= radius).all()
        assert radius.max(initial=0.0) <= RADIUS_OF_GROWTHS * lost * other.max(initial=0.0)


def bounds_of(series, space):
    positive = positive_growths(series.chain, space.grading.degree)
    bound = MajorantRing(space, *_moduli(series, series.unit), series.unit, 2.0**-series.bits, positive=positive)
    moduli = FixedPointDivisors(series.chain, space, series.frequencies, series.bits).moduli()
    run_recursion(bound, moduli, series.chain, series.order, None)
    coordinates, corrections, _ = bound.results()
    return [*coordinates, *corrections]


def test_which_tensions_have_positive_growths():
    found = [positive_growths(case[0], 8) for case in GROWN]
    assert found == [True, True, True, True, False]
    assert not positive_growths(Chain(8, alpha=1), 8)
    assert not positive_growths(Chain(8, potential="expr:2*(1+r)**(5/2)/5*2/3-4/15-2*r/3"), 8)


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

    def _bonds(self, rows, power, degree):
        def values(some):
            return self._coarse(self._image.residues(degree, rows, some, 2.0))

        bonds = super()._bonds(rows, power, degree)
        return bonds._replace(values=values) if self.source == "bonds" else bonds

    def growth(self, *arguments):
        self._inside = self.source == "growths"
        try:
            return super().growth(*arguments)
        finally:
            self._inside = False

    def _rounded(self, residues, divisor=1):
        return self._coarse(residues, divisor=divisor) if self._inside else super()._rounded(residues, divisor)

    def correct(self, degree, corrections):
        if self.source == "corrections" and corrections.table.size:
            residues = self._coarse(np.array(corrections.residues, dtype=float), keep=True)
            words = words_of(self.basis.limbs(residues.reshape(len(self.basis), -1).copy()))
            corrections = Modes(residues, IntegerTable(words.reshape(*corrections.table.shape, -1)))
        super().correct(degree, corrections)

    def _coarse(self, residues, keep=False, divisor=1):
        """Rounded at few bits; keep : there are bits 2^-bits already, not twice of them."""
        shift = MORE_BITS + (0 if keep else self.precision.bits)
        rest = -shift % LIMB_BITS
        flat = residues.reshape(len(self.basis), -1).copy()
        self.basis.scale(flat, np.full(len(self.basis), 2.0**rest))
        limbs = self.basis.limbs(flat, (shift + rest) // LIMB_BITS - (divisor > 1))
        limbs = divided(limbs, divisor) if divisor > 1 else limbs
        limbs = np.vstack([np.zeros((MORE_BITS // LIMB_BITS, limbs.shape[1])), limbs])
        return self.basis.residues(limbs).reshape(residues.shape)


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


ALONE = [(Chain(c.N, c.alpha, c.beta), c.seeds, c.frequencies, c.order, "bonds") for c in ISOLATED]
ALONE += [(*case, "growths") for case in GROWN]
SOURCES = ["multipliers", "cosines", "products", "corrections"]
QUICK = [(case, source) for case in ALONE[: len(ISOLATED)] for source in SOURCES]
QUICK += [(ALONE[-5], "products"), (ALONE[-1], "products")]
ISOLATION = [pytest.param(case, source, marks=() if (case, source) in QUICK else pytest.mark.long) for case in ALONE for source in SOURCES]


@pytest.mark.long
@pytest.mark.parametrize(("case", "source"), ISOLATION, ids=lambda x: x if isinstance(x, str) else names(x))
def test_each_source_of_errors_is_bounded_alone(case, source, monkeypatch):
    """Only one kind of number is rounded, only its terms are in the bound: no other term can hide a missing one."""
    *problem, products = case
    source = products if source == "products" else source
    series = lindstedt(*problem, digits=DIGITS)
    space = monomial_space(series.chain, series.seeds, series.order)
    found = []
    for kind in ("", source):
        ring = Coarse(space, Precision(series.bits + MORE_BITS, HEADROOM, series.unit), kind)
        kinds = CoarseDivisors if kind == "multipliers" else FixedPointDivisors
        run_recursion(ring, kinds(series.chain, space, series.frequencies, ring.precision.bits), series.chain, series.order, None)
        found.append([table.integers() for part in ring.results()[:2] for table in part])
    errors = [_in_units(a - b) for a, b in zip(*found, strict=True)]
    if source != "multipliers":
        monkeypatch.setattr(majorant, "MULTIPLIER", 0.0)
    rounding = majorant.NEAREST_ROUNDING
    if source != "bonds":
        monkeypatch.setattr(majorant, "NEAREST_ROUNDING", 1e-15)
    positive = positive_growths(series.chain, space.grading.degree)
    bound = MajorantRing(space, *_moduli(series, series.unit), series.unit, 2.0**-series.bits, positive=positive)
    if source in ("multipliers", "corrections"):
        bound._noise *= 0
    if source == "corrections":
        correct = bound.correct
        monkeypatch.setattr(bound, "correct", lambda degree, radii: correct(degree, radii + NEAREST))
    if source in ("bonds", "growths"):
        monkeypatch.setattr(bound, "put", _without_noise(bound))
    if source == "growths":
        monkeypatch.setattr(bound, "growth", _with_rounding(bound, rounding, monkeypatch))
    divisors = Float64Divisors(series.chain, space, series.frequencies)
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


def _with_rounding(ring, rounding, monkeypatch):
    growth = ring.growth

    def loud(*arguments):
        with monkeypatch.context() as patch:
            patch.setattr(majorant, "NEAREST_ROUNDING", rounding)
            return growth(*arguments)

    return loud
