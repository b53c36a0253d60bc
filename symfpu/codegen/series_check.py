"""Test vectors that a file of a series carries.

They are evaluated with more digits than the coefficients have.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import mpmath
import numpy as np

from symfpu.codegen.series_tables import (
    SeriesTables,
    series_frequencies,
    series_orbit,
    series_tables,
)
from symfpu.codegen.torus_program import DOUBLE_DIGITS, EXTRA_DIGITS, texts
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers
from symfpu.numbers.typed import decimal
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries

SLOPE_DIGITS = 70  # of the series at both ends of a difference
STEP = Fraction(1, 2**80)  # of a frequency: differences are off by its square

TIMES = ("0.0", "2.75", "-13.0625", "160.5")


@dataclass(frozen=True, eq=False)
class SeriesCheck:
    """Test vectors as decimal text; amplitudes, frequencies and times are exact in doubles.

    amplitudes, phases, frequencies : (s,). times : (T,). positions, momenta : (T, N-1).
    corrected : (s,), omega(A). jacobian : (s, s), its derivatives by the amplitudes.
    """

    amplitudes: tuple[str, ...]
    phases: tuple[str, ...]
    frequencies: tuple[str, ...]
    times: tuple[str, ...]
    positions: tuple[tuple[str, ...], ...]
    momenta: tuple[tuple[str, ...], ...]
    corrected: tuple[str, ...]
    jacobian: tuple[tuple[str, ...], ...]


def series_check(
    tables: SeriesTables,
    N: int,
    rates: Sequence[float],
    digits: int | None,
) -> SeriesCheck:
    """Test vectors at moderate amplitudes. rates : (s,), frequencies of the angles."""
    places = DOUBLE_DIGITS if digits is None else digits
    amplitudes = _amplitudes(tables)
    phases = [0.5 - 0.375 * i for i in range(len(rates))]
    times = [float(t) for t in TIMES]
    with MULTIPRECISION.context(places + EXTRA_DIGITS):
        Q, P = series_orbit(tables, N, amplitudes, phases, rates, times)
        omega, slopes = series_frequencies(tables, amplitudes)
        positions = texts(Q, places + 2)
        momenta = texts(P, places + 2)
        corrected = texts(omega[None], places + 2)
        jacobian = texts(slopes, places + 2)
    return SeriesCheck(
        amplitudes=_decimals(amplitudes),
        phases=_decimals(phases),
        frequencies=_decimals(rates),
        times=TIMES,
        positions=positions,
        momenta=momenta,
        corrected=corrected[0],
        jacobian=jacobian,
    )


@dataclass(frozen=True, eq=False)
class SlopeCheck:
    """Derivatives by the frequencies at the vectors of a `SeriesCheck`, as decimal text.

    positions, momenta : (s, T, N-1), by the frequency of every seed at fixed times and phases.
    corrected : (s, s), d omega_i / d omega_j with the seed j of the frequency first.
    """

    positions: tuple[tuple[tuple[str, ...], ...], ...]
    momenta: tuple[tuple[tuple[str, ...], ...], ...]
    corrected: tuple[tuple[str, ...], ...]


def slope_check(
    series: LindstedtSeries, cuts: tuple[int, int], check: SeriesCheck
) -> SlopeCheck:
    """Derivatives as central differences of the recursion at SLOPE_DIGITS digits.

    Nothing of the program is used. series : with the frequencies of the check.
    """
    found = []
    for j in range(len(series.seeds)):
        ends = [
            _at_moved_frequency(series, cuts, check, j, sign * STEP) for sign in (1, -1)
        ]
        with MULTIPRECISION.context(SLOPE_DIGITS):
            slopes = [(a - b) / (2 * exact(STEP)) for a, b in zip(*ends, strict=True)]
            found.append([texts(slope, DOUBLE_DIGITS + 2) for slope in slopes])
    positions, momenta, corrected = zip(*found, strict=True)
    return SlopeCheck(positions, momenta, tuple(rows[0] for rows in corrected))


def _at_moved_frequency(
    series: LindstedtSeries,
    cuts: tuple[int, int],
    check: SeriesCheck,
    j: int,
    step: Fraction,
) -> tuple[Numbers, Numbers, Numbers]:
    """Q, P (T, N-1) and omega(A) (1, s) with one frequency moved."""
    frequencies = list(series.frequencies or ())
    frequencies[j] += step
    chain = series.chain
    moved = lindstedt(chain, series.seeds, frequencies, max(cuts), digits=SLOPE_DIGITS)
    with MULTIPRECISION.context(SLOPE_DIGITS):
        tables = series_tables(moved, *cuts)
        amplitudes, phases, rates, times = (
            list(map(exact, values))
            for values in (check.amplitudes, check.phases, frequencies, check.times)
        )
        Q, P = series_orbit(tables, chain.N, amplitudes, phases, rates, times)
        omega, _ = series_frequencies(tables, amplitudes)
        return Q, P, omega[None]


def exact(value: str | Fraction) -> mpmath.mpf:
    """A number as mpf at the working precision."""
    fraction = Fraction(value)
    return mpmath.mpf(fraction.numerator) / fraction.denominator


def _decimals(values: Iterable[float]) -> tuple[str, ...]:
    fractions = map(Fraction, values)
    return tuple(map(decimal, fractions))


def _amplitudes(tables: SeriesTables) -> list[float]:
    """Different for every seed, with few binary digits."""
    s = len(tables.scales)
    size = _moderate(tables)
    amplitudes = []
    for i, scale in enumerate(tables.scales):
        largest = min(1.0, size / float(scale))
        part = 1 - i / (2 * s)
        amplitudes.append(_short(largest * part))
    return amplitudes


def _moderate(tables: SeriesTables) -> float:
    """A scaled amplitude at which higher powers are smaller than lower ones."""
    largest = _largest_of_degrees(tables)
    steepest = 1e-3
    for degree, coefficient in largest.items():
        if degree > 1:
            ratio = coefficient / largest[1]
            growth: float = ratio ** (1 / (degree - 1))
            steepest = max(steepest, growth)
    return 1 / (4 * len(tables.scales) * steepest)


def _largest_of_degrees(tables: SeriesTables) -> dict[int, float]:
    """The largest coefficient of every degree."""
    degrees = tables.powers.sum(axis=1)
    largest: dict[int, float] = {}
    for block in tables.blocks:
        values = np.abs(block.coefficients.astype(float))
        of_row = values.max(axis=1).tolist()
        row_degrees = degrees[block.powers].tolist()
        for degree, value in zip(row_degrees, of_row, strict=True):
            known = largest.get(degree, 0.0)
            largest[degree] = max(known, value)
    return largest


def _short(value: float) -> float:
    """Rounded to 10 binary digits."""
    mantissa, exponent = math.frexp(value)
    digits = round(mantissa * 1024)
    return math.ldexp(digits / 1024, exponent)
