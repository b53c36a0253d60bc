"""Test vectors that a file of a series carries.

They are evaluated with more digits than the coefficients have.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from symfpu.codegen.series_tables import (
    SeriesTables,
    series_frequencies,
    series_orbit,
)
from symfpu.codegen.torus_program import DOUBLE_DIGITS, EXTRA_DIGITS, texts
from symfpu.numbers.arithmetic import MULTIPRECISION
from symfpu.numbers.typed import decimal

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
