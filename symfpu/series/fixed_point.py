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
from symfpu.series.divisors import Divisors, FixedPointDivisors, Float64Divisors
from symfpu.series.memory import check_size
from symfpu.series.recursion import Progress, monomial_space, named_series, ring_series, run_recursion
from symfpu.series.rings import FLOAT64, Frequencies, chosen_frequencies
from symfpu.series.series import LindstedtSeries
from symfpu.series.tables import LOG10_2

SPARE_DIGITS = 6  # beyond the promised ones, for what is computed from the coefficients
ATTEMPTS = 4
LEAST_LIMBS = 5  # 100 bits: below any divisor that doubles, which come first, let pass


def fixed_point_series(
    chain: Chain, seeds: tuple[int, ...], frequencies: Frequencies, order: int, digits: int, progress: Progress | None
) -> LindstedtSeries:
    """Doubles first: their moduli bound the rounding errors, and so say how many binary places the digits need. The errors are
    bounded again with the result; if doubles had misled, with more places once more."""
    chosen = chosen_frequencies(frequencies, "fixed-point")
    check_size(chain, seeds, order, "fixedpoint", digits)
    space = monomial_space(chain, seeds, order)

    def stage(number: int) -> Progress | None:
        return None if progress is None else lambda done, _: progress(min(number, 3) * order + done, 4 * order)

    known = named_series(FLOAT64, chain, space, chosen, order, stage(0))
    unit = _fitting_unit(known)
    bounds = _rounding_bounds(known, space, unit, Float64Divisors(chain, seeds, chosen, space.grading.degree), stage(1))
    for attempt in range(ATTEMPTS):
        bits = LIMB_BITS * max(LEAST_LIMBS, math.ceil(((digits + SPARE_DIGITS) / LOG10_2 + bounds.lost_bits) / LIMB_BITS))
        precision = Precision(bits, math.ceil(math.log2(bounds.largest)) + 3, unit)
        divisors = FixedPointDivisors(chain, seeds, chosen, bits)
        try:
            result = ring_series(chain, chosen, order, FixedPointRing(space, precision), divisors, stage(2 + attempt))
        except OverflowError:  # sums larger than doubles had made them
            bounds = bounds._replace(largest=bounds.largest * 2.0**LIMB_BITS)
            continue
        result = replace(result, smallest_divisors=known.smallest_divisors, digits=digits, bits=bits)
        bounds = _rounding_bounds(result, space, unit, divisors.moduli(), stage(3))
        if math.log2(bounds.largest) <= precision.headroom and bounds.lost_bits <= bits - digits / LOG10_2:
            return replace(result, radii=bounds.radii)
    raise SymfpuError(f"the rounding errors of order {order} stay above 10^-{digits} at {bits} binary places; take a lower order")


class _RoundingBounds(NamedTuple):
    """radii : as LindstedtSeries has them. lost_bits : of the worst order, relative to its largest coefficient."""

    radii: tuple[tuple[float, NDArray[np.float64]], ...]
    lost_bits: float
    largest: float


def _moduli(series: LindstedtSeries, unit: Fraction) -> tuple[dict[int, NDArray[np.float64]], dict[int, NDArray[np.float64]]]:
    """Moduli of the tables of coordinates and corrections by degree, scaled to another unit."""
    ratio = math.log2(series.unit) - math.log2(unit)
    tables, corrections = {}, {}
    for k in range(series.order + 1):
        degree = series.degree(k)
        doubles = [series.tables.doubles(table) for table in (series.coordinates[k], series.corrections[k])]
        tables[degree], corrections[degree - 1] = (np.abs(t) * 2.0 ** (ratio * (degree - 1)) for t in doubles)
    return tables, corrections


def _fitting_unit(series: LindstedtSeries) -> Fraction:
    """The unit in which the largest coefficients of all orders are alike, about."""
    largest = [float(np.abs(t).max(initial=0.0)) for t in series.coordinates]
    orders = [k for k, size in enumerate(largest) if size]
    degrees = [series.degree(k) - 1 for k in orders]
    if len(orders) < 2:
        return Fraction(1)
    grown = [math.log2(largest[k]) + math.log2(series.unit) * d for k, d in zip(orders, degrees, strict=True)]
    return Fraction(2.0 ** float(np.polyfit(degrees, grown, 1)[0])).limit_denominator(64) or Fraction(1, 64)


def _rounding_bounds(
    series: LindstedtSeries, space: CosineModes, unit: Fraction, divisors: Divisors, progress: Progress | None
) -> _RoundingBounds:
    """How far the coefficients can be off, in units of the last place."""
    chain, order = series.chain, series.order
    tables, corrections = _moduli(series, unit)
    ring = MajorantRing(space, tables, corrections, unit, 2.0**-series.bits if series.bits else 0.0)
    with np.errstate(over="ignore", invalid="ignore"):
        run_recursion(ring, divisors, chain, order, progress)
    modes, diagonal, _ = ring.results()
    radii = [(float(r.max(initial=0.0)), w) for r, w in zip(modes, [np.zeros((0, len(space.seeds))), *diagonal], strict=True)]
    lost = 0.0
    for (coordinate, correction), table, known in zip(radii, tables.values(), corrections.values(), strict=True):
        for radius, size in ((coordinate, table.max(initial=0.0)), (correction.max(initial=0.0), known.max(initial=0.0))):
            if size and radius:
                lost = max(lost, math.log2(radius / size) if math.isfinite(radius) else math.inf)
    if not math.isfinite(lost) or not math.isfinite(ring.largest):
        raise InputError("order", order, "an order whose rounding errors can be bounded", "take a lower one, or leave digits out")
    return _RoundingBounds(tuple(radii), lost, ring.largest)
