"""What every language is given of a series with free amplitudes.

These are Q_q(t; A, phi), omega(A) and its Jacobian. Small series become straight-line code
(symfpu.codegen.straight_line); large ones tables (symfpu.codegen.series_tables), and those in
universal form tables of operations (symfpu.codegen.operation_tables).
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

from symfpu.codegen.operation_tables import (
    Operations,
    described,
    operation_tables,
    operations_digest,
)
from symfpu.codegen.series_check import SeriesCheck, SlopeCheck, series_check, slope_check
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
from symfpu.errors import InputError, ResonantDivisor
from symfpu.numbers.typed import decimal
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.orders import order_argument

NEARBY = 8  # choices of frequencies for test vectors, until one is not resonant


@dataclass(frozen=True, eq=False)
class SeriesProgram:
    """A series as data for a language: either statements or tables, the other is None.

    facts : what the header says, in order. universal : whether the frequencies are a parameter
    of the divisors too. operations : of a universal series in tables, whose coefficients are
    then numbers of nodes; slopes : the test vectors of its derivatives by the frequencies.
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
    operations: Operations | None = field(repr=False, default=None)
    slopes: SlopeCheck | None = field(repr=False, default=None)
    fpu: bool = True


def series_program(
    series: LindstedtSeries,
    name: str,
    facts: Mapping[str, str],
    *,
    order: int | None = None,
    frequency_order: int | None = None,
    derivatives: bool = False,
    straight_line: int = STRAIGHT_LINE,
) -> SeriesProgram:
    """Order the numbers of a series for code; facts come first in the header.

    order : of the coordinates, frequency_order : of the frequencies; each at most series.order,
    which is the default. derivatives : of a universal series, by the frequencies; it then becomes
    tables however small it is. straight_line : of a numeric series, the most operations that
    become statements; more become tables. Raises InputError for orders out of range, a series of
    residues, derivatives of a series with chosen frequencies, and tables too large for a file.
    """
    cuts = _cuts(series, order, frequency_order)
    _refuse_residues(series)
    if series.symbolic:
        forms = _universal(series, cuts, derivatives=derivatives)
    else:
        _refuse_derivatives(derivatives)
        forms = _numeric(series, cuts, straight_line)
    return SeriesProgram(
        name=name,
        facts={**facts, **forms.facts},
        N=series.chain.N,
        seeds=series.seeds,
        digits=series.digits,
        universal=series.symbolic,
        straight=forms.straight,
        tables=forms.tables,
        check=forms.check,
        operations=forms.operations,
        slopes=forms.slopes,
        fpu=series.chain.fpu,
    )


def _refuse_residues(series: LindstedtSeries) -> None:
    if series.point is not None:
        allowed = "a series of numbers or in universal form"
        raise InputError("series", "residues", allowed, "compute it with lindstedt")


def _refuse_derivatives(derivatives: bool) -> None:
    if derivatives:
        allowed = "a series in universal form, whose frequencies are parameters"
        raise InputError(
            "derivatives", True, allowed, "make it by lindstedt without frequencies"
        )


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


class Forms(NamedTuple):
    """What a series is written as, with its test vectors and its own lines of the header."""

    facts: dict[str, str]
    straight: StraightLine | None
    tables: SeriesTables | None
    check: SeriesCheck
    operations: Operations | None = None
    slopes: SlopeCheck | None = None


def _cuts(series: LindstedtSeries, order: int | None, frequency_order: int | None) -> Cuts:
    cut = order_argument("order", order, series.order)
    return cut, order_argument("frequency_order", frequency_order, series.order)


def _universal(series: LindstedtSeries, cuts: Cuts, *, derivatives: bool) -> Forms:
    """Statements, or tables of operations; test vectors are those near the linear frequencies."""
    straight = None if derivatives else universal_statements(series, *cuts)
    if straight:
        _, check = _near_linear(series, cuts)
        return Forms(_hashed(straight.digest), straight, None, check)
    tables, operations = operation_tables(series, *cuts)
    known, check = _near_linear(series, cuts)
    digest = operations_digest(tables, operations)
    facts = {"program": described(tables, operations), **_hashed(digest)}
    return Forms(facts, None, tables, check, operations, slope_check(known, cuts, check))


def _numeric(series: LindstedtSeries, cuts: Cuts, straight_line: int) -> Forms:
    """Tables, or statements where these are short; angles turn with other frequencies."""
    tables = series_tables(series, *cuts)
    straight = _short_statements(series, tables, cuts[0], straight_line)
    rates = []
    for i, w in enumerate(series.frequencies or ()):
        shift = (i + 1) / 1024
        rates.append(_rounded(float(w)) + shift)
    check = series_check(tables, series.chain.N, rates, series.digits)
    digest = straight.digest if straight else _hash(tables)
    return Forms(_hashed(digest), straight, None if straight else tables, check)


def _hashed(digest: str) -> dict[str, str]:
    return {"hash of the series": digest}


def _short_statements(
    series: LindstedtSeries,
    tables: SeriesTables,
    order: int,
    most: int,
) -> StraightLine | None:
    """Statements of at most so many operations, or None."""
    least = 2 * tables.coefficient_count  # a product and a sum each
    if least > most:
        return None
    frequencies = frequency_polynomials(tables, series.digits)
    straight = numeric_statements(series, order, tables.scales, frequencies)
    return straight if straight.operations <= most else None


def _near_linear(
    series: LindstedtSeries, cuts: Cuts
) -> tuple[LindstedtSeries, SeriesCheck]:
    """The series at frequencies near the linear ones, and test vectors there."""
    known = _not_resonant(series, max(cuts))
    rates = [float(w) for w in known.frequencies or ()]
    tables = series_tables(known, *cuts)
    return known, series_check(tables, series.chain.N, rates, series.digits)


def _not_resonant(series: LindstedtSeries, order: int) -> LindstedtSeries:
    """The series at the first of a few choices of frequencies that makes no divisor zero."""
    digits = DOUBLE_DIGITS + EXTRA_DIGITS
    for choice in range(NEARBY):
        frequencies = _above_linear(series, choice)
        try:
            return lindstedt(series.chain, series.seeds, frequencies, order, digits=digits)
        except ResonantDivisor as resonance:
            refusal = resonance
    raise refusal


def _above_linear(series: LindstedtSeries, choice: int) -> list[Fraction]:
    """Frequencies a little above the linear ones, exact in doubles."""
    values = []
    for i, q in enumerate(series.seeds):
        linear = float(series.chain.linear_frequency(q))
        above = 1 / (64 + 8 * i + choice)
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
