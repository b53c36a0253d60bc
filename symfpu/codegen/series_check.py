"""Test vectors that a file of a series carries, evaluated with more digits than its coefficients have."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from symfpu.codegen.series_tables import (
    SeriesTables,
    series_frequencies,
    series_orbit,
)
from symfpu.codegen.torus_program import DOUBLE_DIGITS, EXTRA_DIGITS
from symfpu.numbers.arithmetic import MULTIPRECISION, text
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
        corrected, jacobian = series_frequencies(tables, amplitudes)

        def row(values: Iterable[Any]) -> tuple[str, ...]:
            return tuple(text(mpmath.mpf(x), places + 2) for x in values)

        return SeriesCheck(
            amplitudes=_decimals(amplitudes),
            phases=_decimals(phases),
            frequencies=_decimals(rates),
            times=TIMES,
            positions=tuple(map(row, Q)),
            momenta=tuple(map(row, P)),
            corrected=row(corrected),
            jacobian=tuple(map(row, jacobian)),
        )


def _decimals(values: Iterable[float]) -> tuple[str, ...]:
    return tuple(decimal(Fraction(x)) for x in values)


def _amplitudes(tables: SeriesTables) -> list[float]:
    """Different for every seed, with few binary digits."""
    s = len(tables.scales)
    size = _moderate(tables)
    largest = [min(1.0, size / float(x)) for x in tables.scales]
    return [_short(a * (1 - i / (2 * s))) for i, a in enumerate(largest)]


def _moderate(tables: SeriesTables) -> float:
    """A scaled amplitude at which higher powers are smaller than lower ones."""
    largest = _largest_of_degrees(tables)
    growth = [(c / largest[1]) ** (1 / (d - 1)) for d, c in largest.items() if d > 1]
    steepest = max([1e-3, *growth])
    return 1 / (4 * len(tables.scales) * steepest)


def _largest_of_degrees(tables: SeriesTables) -> dict[int, float]:
    """The largest coefficient of every degree."""
    degrees = tables.powers.sum(axis=1)
    largest: dict[int, float] = {}
    for block in tables.blocks:
        of_row = np.abs(block.coefficients.astype(float)).max(axis=1)
        for d, c in zip(degrees[block.powers].tolist(), of_row.tolist(), strict=True):
            largest[d] = max(largest.get(d, 0.0), c)
    return largest


def _short(value: float) -> float:
    """Rounded to 10 binary digits."""
    mantissa, exponent = math.frexp(value)
    return math.ldexp(round(mantissa * 1024) / 1024, exponent)
