"""The recursion of the Poincare-Lindstedt series (Eqs. moda, modb), written once for every ring and both models.

With u_q = Omega_q Q_q and multipliers L_q(nu), degree by degree in the seed amplitudes:
    u_q[nu] = L_q(nu) (sum_n W_q^(n) u_q^(k-n) - a sum B u u - b sum C u u u)[nu],
and W_q^(k) makes the bracket vanish at the secular harmonic nu = e_q of a seed, where u_q gets no term (the gauge of A_q).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import psutil
from numpy.typing import NDArray

from symfpu.algebra.dense import predicted_bytes
from symfpu.algebra.fixedpoint import FixedPointRing, Precision
from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.grading import Grading
from symfpu.algebra.majorant import MajorantRing
from symfpu.algebra.residue import PRIME_BITS, ResidueRing
from symfpu.algebra.ring import Ring
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.symbolic import SymbolicRing
from symfpu.algebra.words import LIMB_BITS, IntegerTable
from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError, TooLarge
from symfpu.numbers.typed import Number, exact, integer, seed_modes
from symfpu.series.divisors import FixedPointDivisors, Float64Divisors, ResidueDivisors, UniversalDivisors
from symfpu.series.series import LOG10_2, LindstedtSeries, ResiduePoint

Progress = Callable[[int, int], None]
Frequencies = tuple[Fraction, ...] | None
MOST_DIGITS = 10_000
SPARE_DIGITS = 6  # beyond the promised ones, for what is computed from the coefficients
EXPECTED_GUARD, EXPECTED_LOSS, MOST_EXPECTED = 20, 0.7, 60  # digits, an order and at most, for the prediction of memory only
OTHER_STAGES = 6  # series in doubles that the stages before and after a fixed-point series hold, with their radii
CONSTANT_BYTES = 2**24
ATTEMPTS = 4
LEAST_LIMBS = 5  # 100 bits: below any divisor that doubles, which come first, let pass
SYMBOLIC_GROWTH = 4  # factor by which an expanded coefficient grows with the order, about


def _float64(chain: Chain, space: CosineModes, frequencies: Frequencies, order: int, progress: Progress | None) -> LindstedtSeries:
    """Coefficients as doubles."""
    divisors = Float64Divisors(chain, space.seeds, _chosen(frequencies, "float64"), space.grading.degree)
    return _series(chain, frequencies, order, Float64Ring(space), divisors, progress)


def _symbolic(chain: Chain, space: CosineModes, _: Frequencies, order: int, progress: Progress | None) -> LindstedtSeries:
    """Coefficients as expanded polynomials in the multipliers."""
    return _series(chain, None, order, SymbolicRing(space), UniversalDivisors(chain, space.seeds), progress)


def _nested(chain: Chain, space: CosineModes, _: Frequencies, order: int, progress: Progress | None) -> LindstedtSeries:
    """Coefficients as nested expressions in the multipliers."""
    return _series(chain, None, order, SymbolicRing(space, nested=True), UniversalDivisors(chain, space.seeds), progress)


RINGS: dict[str, Callable[[Chain, CosineModes, Frequencies, int, Progress | None], LindstedtSeries]] = {
    "float64": _float64,
    "symbolic": _symbolic,
    "nested": _nested,
}


def _chosen(frequencies: Frequencies, ring: str) -> tuple[Fraction, ...]:
    if frequencies is None:
        advice = "give frequencies=, or ring='symbolic'"
        raise InputError("frequencies", None, f"one number for each seed in the {ring} ring", advice)
    return frequencies


def lindstedt(
    chain: Chain,
    seeds: Sequence[int],
    frequencies: Sequence[Number] | None = None,
    order: int = 0,
    *,
    ring: str | None = None,
    digits: int | None = None,
    progress: Progress | None = None,
) -> LindstedtSeries:
    """The Poincare-Lindstedt series of a q-torus with free seed amplitudes (Eqs. qser, omeser).

    chain : the model. seeds : distinct modes D_0. frequencies : omega_q of each seed, exact numbers; None gives the
    universal form with symbols L_q(nu). order : K of the coordinates and of the frequency corrections, from 0 up; order
    k has degree k+1 in the amplitudes (2k+1 if alpha = 0, and with both couplings beta enters two orders up).
    ring : 'float64', or in universal form 'symbolic' (expanded) or 'nested'; default by whether frequencies are given.
    digits : every coefficient to so many digits of the largest one of its order, proved (fixed-point numbers); None for
    doubles. Frequencies and couplings given as floats are read by their shortest decimals, so 0.33 is exactly 33/100.
    progress : called as (steps done, steps).

    Raises InputError for arguments out of range, TooLarge before allocating what would not fit into memory,
    ResonantDivisor at the first divisor that is zero.

    >>> series = lindstedt(Chain(N=8, alpha="0.25"), seeds=(1,), order=1)
    >>> series.coordinates[1][-1, 1], series.coordinates[1][-1, 0]
    (-L_{2}(2), 0)
    """
    seeds = seed_modes(seeds, chain.N)
    order = integer(order, "order", 0)
    exact_frequencies = None if frequencies is None else _frequencies(frequencies, seeds)
    seeds, exact_frequencies = _ascending(seeds, exact_frequencies)
    if digits is not None:
        return _fixed_point(chain, seeds, exact_frequencies, order, _digits(digits, ring), progress)
    ring = ring or ("symbolic" if frequencies is None else "float64")
    if ring not in RINGS:
        raise InputError("ring", ring, f"one of {', '.join(RINGS)}", "name a ring or leave it out")
    check_size(chain, seeds, order, ring)
    space = _space(chain, seeds, order)
    return RINGS[ring](chain, space, exact_frequencies, order, progress)


def _digits(digits: int, ring: str | None) -> int:
    if integer(digits, "digits", 1) > MOST_DIGITS:
        raise InputError("digits", digits, f"1..{MOST_DIGITS}", "take fewer")
    if ring is not None:
        raise InputError("ring", ring, "none where digits are given: they have their own, of fixed-point numbers", "leave one of them out")
    return int(digits)


def _fixed_point(
    chain: Chain, seeds: tuple[int, ...], frequencies: Frequencies, order: int, digits: int, progress: Progress | None
) -> LindstedtSeries:
    """Doubles first: their moduli bound the rounding errors, and so say how many binary places the digits need. The errors are
    bounded again with the result; if doubles had misled, with more places once more."""
    chosen = _chosen(frequencies, "fixed-point")
    check_size(chain, seeds, order, "fixedpoint", digits)
    space = _space(chain, seeds, order)

    def stage(number: int) -> Progress | None:
        return None if progress is None else lambda done, _: progress(min(number, 3) * order + done, 4 * order)

    known = _float64(chain, space, chosen, order, stage(0))
    unit = _fitting_unit(known)
    bounds = _rounding_bounds(known, space, unit, Float64Divisors(chain, seeds, chosen, space.grading.degree), stage(1))
    for attempt in range(ATTEMPTS):
        bits = LIMB_BITS * max(LEAST_LIMBS, math.ceil(((digits + SPARE_DIGITS) / LOG10_2 + bounds.lost_bits) / LIMB_BITS))
        precision = Precision(bits, math.ceil(math.log2(bounds.largest)) + 3, unit)
        divisors = FixedPointDivisors(chain, seeds, chosen, bits)
        try:
            result = _series(chain, chosen, order, FixedPointRing(space, precision), divisors, stage(2 + attempt))
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
        doubles = [t.floats(-series.bits) if isinstance(t, IntegerTable) else t for t in (series.coordinates[k], series.corrections[k])]
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
    series: LindstedtSeries, space: CosineModes, unit: Fraction, divisors: Any, progress: Progress | None
) -> _RoundingBounds:
    """How far the coefficients can be off, in units of the last place."""
    chain, order = series.chain, series.order
    tables, corrections = _moduli(series, unit)
    ring = MajorantRing(space, tables, corrections, unit, 2.0**-series.bits if series.bits else 0.0)
    with np.errstate(over="ignore", invalid="ignore"):
        _run(ring, divisors, chain, order, progress)
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


def residue_series(
    chain: Chain, seeds: Sequence[int], point: ResiduePoint, order: int, *, workers: int | None = None, progress: Progress | None = None
) -> LindstedtSeries:
    """The same series modulo a prime: `coordinates` and `corrections` hold residues in -p/2 .. p/2, as doubles.

    workers : threads; default one for each core. Raises VanishingResidue where a divisor vanishes modulo the prime,
    TooLarge as `lindstedt` does.
    """
    seeds = tuple(sorted(seed_modes(seeds, chain.N)))
    check_size(chain, seeds, integer(order, "order", 0), "residue")
    space = _space(chain, seeds, order)
    ring = ResidueRing(space, point.prime, point.root, workers=workers)
    series = _series(chain, None, order, ring, ResidueDivisors(chain, seeds, ring, point.frequencies), progress)
    return replace(series, point=point)


@lru_cache(maxsize=4)
def shared_grading(seeds: int, degree: int) -> Grading:
    """The grading of so many seeds; kept, because tables do not depend on the chain."""
    return Grading(seeds, degree)


def _space(chain: Chain, seeds: tuple[int, ...], order: int) -> CosineModes:
    """Modes and monomials of a series; its first order is a plain product of the seeds."""
    return CosineModes(chain.N, seeds, shared_grading(len(seeds), 1 + chain.degree_step * order), 1 + chain.degree_step)


def _series(
    chain: Chain, frequencies: tuple[Fraction, ...] | None, order: int, arithmetic: Ring, divisors: Any, progress: Progress | None
) -> LindstedtSeries:
    """Run the recursion and collect what the ring holds."""
    _run(arithmetic, divisors, chain, order, progress)
    modes, corrections, unit = arithmetic.results()
    seeds = arithmetic.space.seeds
    return LindstedtSeries(
        chain=chain,
        seeds=seeds,
        frequencies=frequencies,
        order=order,
        ring=arithmetic.name,
        grading=arithmetic.space.grading,
        coordinates=tuple(modes),
        corrections=(np.zeros((0, len(seeds))), *corrections),
        unit=unit,
        smallest_divisors=divisors.smallest(),
        multiply_adds=getattr(arithmetic, "multiply_adds", 0),
    )


def _run(ring: Ring, divisors: Any, chain: Chain, order: int, progress: Progress | None) -> None:
    """The recursion itself: fills the ring degree by degree."""
    quadratic, cubic = chain.relative_couplings
    ring.put(1, ring.seed_terms())
    for k in range(1, order + 1):
        degree = 1 + chain.degree_step * k
        parts = []
        if quadratic:
            parts.append((ring.number(quadratic), ring.square(degree)))
        if cubic and degree >= 3:
            parts.append((ring.number(cubic), ring.cube(degree)))
        force = ring.project(degree, parts)
        ring.correct(degree - 1, ring.secular(degree, force))
        harmonics, _ = ring.space.grading.harmonics(degree)
        multipliers = divisors.multipliers(harmonics, ring.space.mask_by_harmonic(degree), k)
        ring.put(degree, ring.solve(degree, ring.corrected(degree), force, multipliers))
        if progress:
            progress(k, order)


def _frequencies(frequencies: Sequence[Number], seeds: tuple[int, ...]) -> tuple[Fraction, ...]:
    if isinstance(frequencies, (str, Mapping)) or not isinstance(frequencies, Iterable):
        raise InputError("frequencies", frequencies, "a sequence, one positive number for each seed", "list them in the order of the seeds")
    frequencies = list(frequencies)
    values = tuple(exact(w, "frequencies") for w in frequencies)
    if len(values) != len(seeds):
        raise InputError("frequencies", tuple(map(str, frequencies)), f"one number for each of the seeds {seeds}", "add or drop some")
    for q, w, typed in zip(seeds, values, frequencies, strict=True):
        if not Fraction(1, 10**6) <= w <= 10**6:
            allowed = "a positive finite number (1e-6 to 1e6)"
            raise InputError(f"frequencies, omega_{q}", str(typed), allowed, "take one near the linear frequency")
    return values


def _ascending(seeds: tuple[int, ...], frequencies: tuple[Fraction, ...] | None) -> tuple[tuple[int, ...], tuple[Fraction, ...] | None]:
    """Seeds in ascending order, each with its own frequency."""
    order = sorted(range(len(seeds)), key=lambda i: seeds[i])
    return tuple(seeds[i] for i in order), None if frequencies is None else tuple(frequencies[i] for i in order)


def check_size(chain: Chain, seeds: tuple[int, ...], order: int, ring: str, digits: int = 0) -> None:
    """Refuse an order whose arrays would not fit, before anything is allocated."""
    free = psutil.virtual_memory().available
    if _needed(chain, len(seeds), order, ring, digits) <= free:
        return
    largest = -1
    while _needed(chain, len(seeds), largest + 1, ring, digits) <= free:
        largest += 1
    raise TooLarge(order, _needed(chain, len(seeds), order, ring, digits), free, largest)


def _needed(chain: Chain, seeds: int, order: int, ring: str, digits: int) -> int:
    size = predicted_bytes(chain.N, seeds, 1 + chain.degree_step * order, cubic=chain.beta != 0)
    if ring == "fixedpoint":
        guard = EXPECTED_GUARD + min(EXPECTED_LOSS * order, MOST_EXPECTED)
        primes = math.ceil((digits + guard) / LOG10_2 * 2 / (PRIME_BITS - 2))
        return CONSTANT_BYTES + size * (primes + OTHER_STAGES)
    return size * SYMBOLIC_GROWTH ** min(order, 100) if ring in ("symbolic", "nested") else size
