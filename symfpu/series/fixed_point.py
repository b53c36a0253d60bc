"""The series to any number of digits: fixed-point numbers with proved error bounds."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.fixedpoint import FixedPointRing, Precision
from symfpu.algebra.majorant import MajorantRing
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.words import LIMB_BITS, TooFewPrimes, whole_places
from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import Progress
from symfpu.series.divisors import (
    Divisors,
    EnlargedMultipliers,
    FixedPointDivisors,
    Float64Divisors,
)
from symfpu.series.force import positive_growths, scaled_growths
from symfpu.series.memory import check_size
from symfpu.series.monomials import monomial_space
from symfpu.series.recursion import named_series, ring_series, run_recursion
from symfpu.series.rings import FLOAT64, Frequencies, chosen_frequencies
from symfpu.series.series import LindstedtSeries
from symfpu.series.tables import LOG10_2

SPARE_DIGITS = 6  # beyond the promised ones, for what is computed from the coefficients
ATTEMPTS = 4
# of the moduli of doubles, which those of many digits are to stay below
ENLARGED, ENLARGED_BY_LARGEST = 2.0**-20, 2.0**-36
LEAST_BITS = 100  # below any divisor that doubles, which come first, let pass


def fixed_point_series(
    chain: Chain,
    seeds: tuple[int, ...],
    frequencies: Frequencies,
    order: int,
    digits: int,
    progress: Progress | None,
    *,
    phantom: bool = False,
) -> LindstedtSeries:
    """The series in fixed-point numbers of as many binary places as its digits need.

    Doubles come first: their moduli, a little enlarged, bound the rounding errors, and so say how
    many places. That holds if the moduli of the result are below them, one by one. Where they are
    not, the errors are bounded again with those of the result; if doubles had misled, the work is
    repeated with more places.
    """
    _require_known(chain, digits)
    chosen = chosen_frequencies(frequencies, "fixed-point")
    check_size(chain, seeds, order, "fixedpoint", digits, phantom=phantom)
    space = monomial_space(chain, seeds, order, phantom=phantom)

    def stage(number: int) -> Progress | None:
        if progress is None:
            return None
        before = min(number, 3)
        return lambda label, fraction: progress(label, (before + fraction) / 4)

    known = named_series(FLOAT64, chain, space, chosen, order, stage(0))
    unit = _fitting_unit(known)
    doubles = Float64Divisors(chain, space, chosen)
    multipliers = EnlargedMultipliers(doubles)
    expected = _enlarged(_moduli(known, unit), space)
    bounds = _bounds(chain, space, expected, unit, multipliers, 2.0**-LEAST_BITS, stage(1))
    lost, grown = _lost(bounds, expected, order), bool(scaled_growths(chain))
    least = min((divisor.size for divisor in known.smallest_divisors), default=0.0)
    for attempt in range(ATTEMPTS):
        bits = _places(digits, lost, whole_limbs=grown)
        headroom = math.ceil(math.log2(bounds.largest)) + 3
        precision = Precision(bits, headroom, unit)
        divisors = FixedPointDivisors(chain, space, chosen, bits, least=least)
        try:
            ring = FixedPointRing(space, precision)
            result = ring_series(chain, chosen, order, ring, divisors, stage(2 + attempt))
        except OverflowError:  # sums larger than doubles had made them
            bounds = bounds._replace(largest=bounds.largest * 2.0**LIMB_BITS)
            continue
        except TooFewPrimes:
            allowed = f"fewer, since order {order} loses {math.ceil(lost)} bits beside them"
            raise InputError("digits", digits, allowed, "or take a lower order") from None
        smallest = known.smallest_divisors
        result = replace(result, smallest_divisors=smallest, digits=digits, bits=bits)
        found = _moduli(result, unit)
        if not (_cover(expected, found) and multipliers.cover(divisors)):
            proved, place = divisors.moduli(), 2.0**-bits
            bounds = _bounds(chain, space, found, unit, proved, place, stage(3))
        lost = _lost(bounds, found, order)
        fits = math.log2(bounds.largest) <= precision.headroom
        if fits and lost <= bits - digits / LOG10_2:
            if progress is not None:
                progress("series", 1.0)
            return replace(result, radii=bounds.radii)
    errors = f"the rounding errors of order {order} stay above 10^-{digits}"
    raise SymfpuError(f"{errors} at {bits} binary places; take a lower order")


def _require_known(chain: Chain, digits: int) -> None:
    """InputError for a potential whose Taylor series is rounded to fewer digits."""
    known = chain.potential.digits
    if known is not None and digits > known:
        allowed = f"at most {known}, the digits of the Taylor series of {chain.potential!r}"
        advice = f"give the potential more: from_expression(..., digits={digits})"
        raise InputError("digits", digits, allowed, advice)


def _places(digits: int, lost_bits: float, *, whole_limbs: bool) -> int:
    """Binary places for so many digits where so many bits are lost; whole limbs for growths."""
    wanted = math.ceil((digits + SPARE_DIGITS) / LOG10_2 + lost_bits)
    enough = max(LEAST_BITS, whole_places(wanted))
    return LIMB_BITS * -(-enough // LIMB_BITS) if whole_limbs else enough


class _Moduli(NamedTuple):
    """Moduli of the coordinates and corrections of a series, by degree, in a common unit."""

    tables: dict[int, NDArray[np.float64]]
    corrections: dict[int, NDArray[np.float64]]


class _RoundingBounds(NamedTuple):
    """How far the coefficients of a series can be off.

    radii : as LindstedtSeries has them. largest : as of MajorantRing.
    """

    radii: tuple[tuple[float, NDArray[np.float64]], ...]
    largest: float


def _moduli(series: LindstedtSeries, unit: Fraction) -> _Moduli:
    """Those of a series, scaled to another unit."""
    ratio = math.log2(series.unit) - math.log2(unit)
    tables, corrections = {}, {}
    for k in range(series.order + 1):
        degree = series.degree(k)
        factor = 2.0 ** (ratio * (degree - 1))
        coordinates = series.tables.doubles(series.coordinates[k])
        diagonal = series.tables.doubles(series.corrections[k])
        tables[degree] = np.abs(coordinates) * factor
        corrections[degree - 1] = np.abs(diagonal) * factor
    return _Moduli(tables, corrections)


def _enlarged(moduli: _Moduli, space: CosineModes) -> _Moduli:
    """More than doubles are off by: relative to each, and to the largest of its degree."""
    tables = {
        degree: np.where(space.mask(degree), _above(table), 0.0)
        for degree, table in moduli.tables.items()
    }
    corrections = {degree: _above(table) for degree, table in moduli.corrections.items()}
    return _Moduli(tables, corrections)


def _above(table: NDArray[np.float64]) -> NDArray[np.float64]:
    largest = table.max(initial=0.0)
    return np.asarray(table * (1 + ENLARGED) + largest * ENLARGED_BY_LARGEST)


def _cover(expected: _Moduli, found: _Moduli) -> bool:
    """Whether all that was expected is above what was found."""
    pairs = [
        (own[degree], table)
        for own, other in zip(expected, found, strict=True)
        for degree, table in other.items()
    ]
    return all(bool((b * (1 + ENLARGED / 2) <= a).all()) for a, b in pairs)


def _fitting_unit(series: LindstedtSeries) -> Fraction:
    """The unit in which the largest coefficients of all orders are alike, about."""
    unit_bits = math.log2(series.unit)
    degrees, grown = [], []
    for k, table in enumerate(series.coordinates):
        largest = float(np.abs(table).max(initial=0.0))
        if largest:
            degree = series.degree(k) - 1
            degrees.append(degree)
            grown.append(math.log2(largest) + unit_bits * degree)
    if len(degrees) < 2:
        return Fraction(1)
    slope = np.polyfit(degrees, grown, 1)[0]
    unit = Fraction(2.0 ** float(slope))
    return unit.limit_denominator(64) or Fraction(1, 64)


def _bounds(
    chain: Chain,
    space: CosineModes,
    moduli: _Moduli,
    unit: Fraction,
    multipliers: Divisors,
    place: float,
    progress: Progress | None,
) -> _RoundingBounds:
    """How far coefficients of these moduli can be off, in units of the last place.

    place : no less than that unit.
    """
    order = len(moduli.tables) - 1
    positive = positive_growths(chain, space.grading.degree)
    ring = MajorantRing(space, *moduli, unit, place, positive=positive)
    with np.errstate(over="ignore", invalid="ignore"):
        run_recursion(ring, multipliers, chain, order, progress)
    modes, diagonal, _ = ring.results()
    none = np.zeros((0, len(space.seeds)))
    pairs = zip(modes, [none, *diagonal], strict=True)
    radii = tuple((float(errors.max(initial=0.0)), others) for errors, others in pairs)
    return _RoundingBounds(radii, ring.largest)


def _lost(bounds: _RoundingBounds, moduli: _Moduli, order: int) -> float:
    """The bits of the errors of the worst order, relative to its largest coefficient."""
    lost = 0.0
    for (radius, errors), degree in zip(bounds.radii, moduli.tables, strict=True):
        lost = max(lost, _lost_bits(radius, moduli.tables[degree]))
        largest = float(errors.max(initial=0.0))
        lost = max(lost, _lost_bits(largest, moduli.corrections[degree - 1]))
    if not math.isfinite(lost) or not math.isfinite(bounds.largest):
        allowed = "an order whose rounding errors can be bounded"
        raise InputError("order", order, allowed, "take a lower one, or leave digits out")
    return lost


def _lost_bits(radius: float, moduli: NDArray[np.float64]) -> float:
    """The bits of an error relative to the largest of these moduli; 0 where either is zero.

    Infinite where the error is no number.
    """
    size = moduli.max(initial=0.0)
    if not size or not radius:
        return 0.0
    return math.log2(radius / size) if math.isfinite(radius) else math.inf
