"""What every language is given of a series with free amplitudes.

These are Q_q(t; A, phi), omega(A) and its Jacobian. Small series become straight-line code
(symfpu.codegen.straight_line); large ones tables (symfpu.codegen.series_tables).
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from symfpu.codegen.series_check import SeriesCheck, series_check
from symfpu.codegen.series_tables import (
    SeriesTables,
    frequency_polynomials,
    series_tables,
)
from symfpu.codegen.straight_line import (
    STRAIGHT_LINE,
    StraightLine,
    numeric_statements,
    universal_statements,
)
from symfpu.codegen.torus_program import (
    DOUBLE_DIGITS,
    EXTRA_DIGITS,
    hashed_numbers,
    precision_text,
)
from symfpu.errors import InputError
from symfpu.numbers.typed import decimal
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import order_argument


@dataclass(frozen=True, eq=False)
class SeriesProgram:
    """A series as data for a language: either statements or tables, the other is None.

    facts : what the header says, in order. universal : whether the frequencies are a parameter
    of the divisors too.
    """

    name: str
    facts: Mapping[str, str]
    N: int
    seeds: tuple[int, ...]
    digits: int | None
    universal: bool
    straight: StraightLine | None = field(repr=False)
    tables: SeriesTables | None = field(repr=False)
    check: SeriesCheck = field(repr=False)


def series_program(
    series: LindstedtSeries,
    name: str,
    facts: Mapping[str, str],
    *,
    order: int | None = None,
    frequency_order: int | None = None,
) -> SeriesProgram:
    """Order the numbers of a series for code; facts come first in the header.

    order : of the coordinates, frequency_order : of the frequencies; each at most series.order,
    which is the default. Raises InputError for orders out of range, a series of residues, and a
    universal series too large for straight-line code.
    """
    cuts = _cuts(series, order, frequency_order)
    _refuse_residues(series)
    forms = _universal if series.symbolic else _numeric
    straight, tables, rates = forms(series, cuts)
    digest = straight.digest if straight else _hash(tables)
    N, digits = series.chain.N, series.digits
    return SeriesProgram(
        name=name,
        facts={**facts, "hash of the series": digest},
        N=N,
        seeds=series.seeds,
        digits=digits,
        universal=series.symbolic,
        straight=straight,
        tables=None if straight else tables,
        check=series_check(tables, N, rates, digits),
    )


def _refuse_residues(series: LindstedtSeries) -> None:
    if series.point is not None:
        allowed = "a series of numbers or in universal form"
        raise InputError("series", "residues", allowed, "compute it with lindstedt")


def series_facts(
    series: LindstedtSeries,
    *,
    order: int | None = None,
    frequency_order: int | None = None,
) -> dict[str, str]:
    """The header of a series: chain, seeds, frequencies of its divisors, orders."""
    cut, frequency_cut = _cuts(series, order, frequency_order)
    seeds = map(str, series.seeds)
    frequencies = ", ".join(map(decimal, series.frequencies or ()))
    precision = "exact" if series.symbolic else precision_text(series.digits)
    return {
        "chain": repr(series.chain),
        "seeds": ", ".join(seeds),
        "frequencies of the divisors": frequencies or "those given at a call",
        "orders": f"frequencies {frequency_cut}, coordinates {cut}",
        "precision": precision,
    }


Cuts = tuple[int, int]  # of the coordinates and of the frequencies
Forms = tuple[StraightLine | None, SeriesTables, list[float]]  # and frequencies for test vectors


def _cuts(series: LindstedtSeries, order: int | None, frequency_order: int | None) -> Cuts:
    cut = order_argument("order", order, series)
    return cut, order_argument("frequency_order", frequency_order, series)


def _universal(series: LindstedtSeries, cuts: Cuts) -> Forms:
    """Statements, and tables near the linear frequencies for the test vectors."""
    straight = universal_statements(series, *cuts)
    frequencies = _near_linear(series)
    digits = DOUBLE_DIGITS + EXTRA_DIGITS
    known = lindstedt(series.chain, series.seeds, frequencies, max(cuts), digits=digits)
    rates = [float(w) for w in frequencies]
    return straight, series_tables(known, *cuts), rates


def _numeric(series: LindstedtSeries, cuts: Cuts) -> Forms:
    """Tables, and statements where these are short; angles turn with other frequencies."""
    tables = series_tables(series, *cuts)
    straight = _short_statements(series, tables, cuts[0])
    rates = []
    for i, w in enumerate(series.frequencies or ()):
        shift = (i + 1) / 1024
        rates.append(_rounded(float(w)) + shift)
    return straight, tables, rates


def _short_statements(
    series: LindstedtSeries,
    tables: SeriesTables,
    order: int,
) -> StraightLine | None:
    """Statements of at most STRAIGHT_LINE operations, or None."""
    least = 2 * tables.coefficient_count  # a product and a sum each
    if least > STRAIGHT_LINE:
        return None
    frequencies = frequency_polynomials(tables, series.digits)
    straight = numeric_statements(series, order, tables.scales, frequencies)
    return straight if straight.operations <= STRAIGHT_LINE else None


def _near_linear(series: LindstedtSeries) -> list[Fraction]:
    """Frequencies a little above the linear ones, exact in doubles."""
    values = []
    for i, q in enumerate(series.seeds):
        linear = float(series.chain.linear_frequency(q))
        above = 1 / (64 + 8 * i)
        shifted = _rounded(linear * (1 + above))
        values.append(Fraction(shifted))
    return values


def _rounded(value: float) -> float:
    """To 20 binary places: the same number in decimal and in binary, its decimal short."""
    return round(value * 2**20) / 2**20


def _hash(tables: SeriesTables) -> str:
    """SHA-256 of harmonics, powers and coefficients as decimal text."""
    digest = hashlib.sha256()
    for block in tables.blocks:
        powers = tables.powers[block.powers]
        arrays = block.harmonics, powers, block.starts
        places = block.modes, *(array.tolist() for array in arrays)
        digest.update(repr(places).encode())
        digest.update(hashed_numbers(block.coefficients))
    digest.update(hashed_numbers(tables.frequency_coefficients))
    return digest.hexdigest()
