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
from symfpu.algebra.words import LIMB_BITS
from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import Progress
from symfpu.series.divisors import Divisors, FixedPointDivisors, Float64Divisors
from symfpu.series.force import positive_growths
from symfpu.series.memory import check_size
from symfpu.series.monomials import monomial_space
from symfpu.series.recursion import named_series, ring_series, run_recursion
from symfpu.series.rings import FLOAT64, Frequencies, chosen_frequencies
from symfpu.series.series import LindstedtSeries
from symfpu.series.tables import LOG10_2

SPARE_DIGITS = 6  # beyond the promised ones, for what is computed from the coefficients
ATTEMPTS = 4
LEAST_LIMBS = 5  # 100 bits: below any divisor that doubles, which come first, let pass


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

    Doubles come first: their moduli bound the rounding errors, and so say how many places. The
    errors are bounded again with the result; if doubles had misled, the work is repeated with
    more places.
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
    doubles = Float64Divisors(chain, seeds, chosen, space.grading.degree)
    bounds = _rounding_bounds(known, space, unit, doubles, stage(1))
    for attempt in range(ATTEMPTS):
        bits = _places(digits, bounds.lost_bits)
        headroom = math.ceil(math.log2(bounds.largest)) + 3
        precision = Precision(bits, headroom, unit)
        divisors = FixedPointDivisors(chain, seeds, chosen, bits)
        try:
            ring = FixedPointRing(space, precision)
            result = ring_series(chain, chosen, order, ring, divisors, stage(2 + attempt))
        except OverflowError:  # sums larger than doubles had made them
            bounds = bounds._replace(largest=bounds.largest * 2.0**LIMB_BITS)
            continue
        smallest = known.smallest_divisors
        result = replace(result, smallest_divisors=smallest, digits=digits, bits=bits)
        bounds = _rounding_bounds(result, space, unit, divisors.moduli(), stage(3))
        fits = math.log2(bounds.largest) <= precision.headroom
        if fits and bounds.lost_bits <= bits - digits / LOG10_2:
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


def _places(digits: int, lost_bits: float) -> int:
    """Binary places, in whole limbs, for so many digits where so many bits are lost."""
    wanted = (digits + SPARE_DIGITS) / LOG10_2 + lost_bits
    limbs = math.ceil(wanted / LIMB_BITS)
    return LIMB_BITS * max(LEAST_LIMBS, limbs)


class _RoundingBounds(NamedTuple):
    """How far the coefficients of a series can be off.

    radii : as LindstedtSeries has them. lost_bits : of the worst order, relative to its largest
        coefficient.
    """

    radii: tuple[tuple[float, NDArray[np.float64]], ...]
    lost_bits: float
    largest: float


def _moduli(
    series: LindstedtSeries, unit: Fraction
) -> tuple[dict[int, NDArray[np.float64]], dict[int, NDArray[np.float64]]]:
    """Moduli of the tables of coordinates and corrections by degree, scaled to another unit."""
    ratio = math.log2(series.unit) - math.log2(unit)
    tables, corrections = {}, {}
    for k in range(series.order + 1):
        degree = series.degree(k)
        factor = 2.0 ** (ratio * (degree - 1))
        coordinates = series.tables.doubles(series.coordinates[k])
        diagonal = series.tables.doubles(series.corrections[k])
        tables[degree] = np.abs(coordinates) * factor
        corrections[degree - 1] = np.abs(diagonal) * factor
    return tables, corrections


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


def _rounding_bounds(
    series: LindstedtSeries,
    space: CosineModes,
    unit: Fraction,
    divisors: Divisors,
    progress: Progress | None,
) -> _RoundingBounds:
    """How far the coefficients can be off, in units of the last place."""
    chain, order = series.chain, series.order
    tables, corrections = _moduli(series, unit)
    place = 2.0**-series.bits if series.bits else 0.0
    positive = positive_growths(chain, space.grading.degree)
    ring = MajorantRing(space, tables, corrections, unit, place, positive=positive)
    with np.errstate(over="ignore", invalid="ignore"):
        run_recursion(ring, divisors, chain, order, progress)
    modes, diagonal, _ = ring.results()
    none = np.zeros((0, len(space.seeds)))
    radii = []
    lost = 0.0
    for errors, correction_errors, degree in zip(
        modes, [none, *diagonal], tables, strict=True
    ):
        radius = float(errors.max(initial=0.0))
        radii.append((radius, correction_errors))
        lost = max(lost, _lost_bits(radius, tables[degree]))
        correction_radius = correction_errors.max(initial=0.0)
        lost = max(lost, _lost_bits(correction_radius, corrections[degree - 1]))
    if not math.isfinite(lost) or not math.isfinite(ring.largest):
        allowed = "an order whose rounding errors can be bounded"
        raise InputError("order", order, allowed, "take a lower one, or leave digits out")
    return _RoundingBounds(tuple(radii), lost, ring.largest)


def _lost_bits(radius: float, moduli: NDArray[np.float64]) -> float:
    """The bits of an error relative to the largest of these moduli; 0 where either is zero."""
    size = moduli.max(initial=0.0)
    if not size or not radius:
        return 0.0
    return math.log2(radius / size) if math.isfinite(radius) else math.inf
