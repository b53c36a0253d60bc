"""What every language is given of a series with free amplitudes: Q_q(t; A, phi), omega(A) and its Jacobian.

Small series become straight-line code (symfpu.codegen.straight_line); large ones tables. In a table, Q_q is a sum over
harmonics nu and powers e of c x^e cos(nu.theta) with scaled amplitudes x_i = scale_i A_i, whose coefficients stay within the
range of doubles at any order. At given amplitudes the powers of one harmonic are summed first; what is left is a torus.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from symfpu.algebra.grading import Ints
from symfpu.algebra.polynomials import Polynomial, square_root
from symfpu.codegen.straight_line import STRAIGHT_LINE, StraightLine, numeric_statements, universal_statements
from symfpu.codegen.torus_program import EXTRA_DIGITS, number
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers, mpf, text
from symfpu.numbers.typed import decimal
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import order_argument

CHECK_TIMES = ("0.0", "2.75", "-13.0625", "160.5")
DOUBLE_DIGITS = 17


@dataclass(frozen=True, eq=False)
class SeriesBlock:
    """Harmonics of one parity. modes : (M,). harmonics : (H, s). starts : (H+1,), rows of harmonic h are starts[h] .. starts[h+1]-1.
    powers : (R,), which row of SeriesProgram.powers. coefficients : (R, M), of x^e cos(nu.theta) in every mode."""

    modes: tuple[int, ...]
    harmonics: Ints
    starts: Ints
    powers: Ints
    coefficients: Numbers


@dataclass(frozen=True, eq=False)
class SeriesCheck:
    """Test vectors as decimal text: amplitudes, phases, frequencies (s,), times (T,), positions and momenta (T, N-1),
    corrected frequencies omega(A) (s,) and their Jacobian (s, s). Amplitudes, frequencies and times are exact in doubles."""

    amplitudes: tuple[str, ...]
    phases: tuple[str, ...]
    frequencies: tuple[str, ...]
    times: tuple[str, ...]
    positions: tuple[tuple[str, ...], ...]
    momenta: tuple[tuple[str, ...], ...]
    corrected: tuple[str, ...]
    jacobian: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, eq=False)
class SeriesTables:
    """Coefficients of scaled amplitudes. scales : (s,), x_i = scales[i] A_i. powers : (E, s), the exponents e.

    linear : Omega of the seeds, (s,). frequency_powers : (F, s). frequency_coefficients : (F, s);
    omega_i(A) = linear_i + sum_F frequency_coefficients[F, i] prod x_j^(2 frequency_powers[F, j]).
    """

    scales: Numbers
    powers: Ints = field(repr=False)
    blocks: tuple[SeriesBlock, ...] = field(repr=False)
    linear: Numbers
    frequency_powers: Ints = field(repr=False)
    frequency_coefficients: Numbers = field(repr=False)

    @property
    def highest(self) -> tuple[int, ...]:
        """Largest |nu_i| of every seed."""
        return tuple(max((int(np.abs(b.harmonics[:, i]).max(initial=0)) for b in self.blocks), default=0) for i in range(len(self.scales)))

    @property
    def coefficient_count(self) -> int:
        """Coefficients that are not zero."""
        return sum(int(np.count_nonzero(b.coefficients)) for b in self.blocks)


@dataclass(frozen=True, eq=False)
class SeriesProgram:
    """A series as data for an emitter: either statements or tables, the other is None.

    facts : what the header says, in order. universal : whether the frequencies are a parameter of the divisors too.
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
    series: LindstedtSeries, name: str, facts: Mapping[str, str], *, order: int | None = None, frequency_order: int | None = None
) -> SeriesProgram:
    """Order the numbers of a series for code; facts come first in the header.

    order : of the coordinates, frequency_order : of the frequencies; each at most series.order, which is the default.
    Raises InputError for orders out of range, a series of residues, and a universal series too large for straight-line code.
    """
    cuts = order_argument("order", order, series), order_argument("frequency_order", frequency_order, series)
    if series.point is not None:
        raise InputError("series", "residues", "a series of numbers or in universal form", "compute it with lindstedt")
    straight: StraightLine | None
    if series.symbolic:
        straight = universal_statements(series, *cuts)
        known = lindstedt(series.chain, series.seeds, _near_linear(series), max(cuts), digits=DOUBLE_DIGITS + EXTRA_DIGITS)
        tables = series_tables(known, *cuts)
        rates = [float(w) for w in known.frequencies or ()]
    else:
        tables = series_tables(series, *cuts)
        small = 2 * tables.coefficient_count <= STRAIGHT_LINE  # a product and a sum each
        straight = numeric_statements(series, cuts[0], tables.scales, _unscaled(tables, series.digits)) if small else None
        if straight is not None and straight.operations > STRAIGHT_LINE:
            straight = None
        rates = [_rounded(float(w)) + (i + 1) / 1024 for i, w in enumerate(series.frequencies or ())]
    check = series_check(tables, series.chain.N, rates, series.digits)
    return SeriesProgram(
        name=name,
        facts=dict(facts) | {"hash of the series": _hash(tables, straight)},
        N=series.chain.N,
        seeds=series.seeds,
        digits=series.digits,
        universal=series.symbolic,
        straight=straight,
        tables=None if straight else tables,
        check=check,
    )


def series_facts(series: LindstedtSeries, *, order: int | None = None, frequency_order: int | None = None) -> dict[str, str]:
    """The header of a series: chain, seeds, frequencies of its divisors, orders."""
    cut, frequency_cut = order_argument("order", order, series), order_argument("frequency_order", frequency_order, series)
    return {
        "chain": repr(series.chain),
        "seeds": ", ".join(map(str, series.seeds)),
        "frequencies of the divisors": ", ".join(map(decimal, series.frequencies)) if series.frequencies else "those given at a call",
        "orders": f"frequencies {frequency_cut}, coordinates {cut}",
        "precision": "exact" if series.symbolic else "doubles" if series.digits is None else f"{series.digits} digits",
    }


def series_tables(series: LindstedtSeries, order: int, frequency_order: int) -> SeriesTables:
    """The tables of a series with chosen frequencies, rows without a coefficient left out."""
    parts = [series.amplitude_terms(k) for k in range(order + 1)]
    nu, e, values = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    powers, which = np.unique(e, axis=0, return_inverse=True)
    parity, modes = nu @ np.array(series.seeds) % 2, np.arange(1, series.chain.N)
    by_harmonic = np.lexsort((which.reshape(-1), *nu.T[::-1]))
    blocks = []
    for p in (0, 1):
        columns = np.flatnonzero(modes % 2 == p)
        rows = by_harmonic[parity[by_harmonic] == p]
        rows = rows[(values[np.ix_(rows, columns)] != 0).any(axis=1)] if len(columns) else rows[:0]
        if len(rows):
            harmonics, starts = np.unique(nu[rows], axis=0, return_index=True)
            ends, monomials = np.append(starts, len(rows)), which.reshape(-1)[rows]
            blocks.append(SeriesBlock(tuple(map(int, columns + 1)), harmonics, ends, monomials, values[np.ix_(rows, columns)]))
    linear, frequency_powers, coefficients = _frequencies(series, frequency_order)
    with MULTIPRECISION.context(series.digits or DOUBLE_DIGITS):
        scales = np.array([mpf(x) for x in series.seed_factors], dtype=object)
    return SeriesTables(scales, powers, tuple(blocks), linear, frequency_powers, coefficients)


def _frequencies(series: LindstedtSeries, order: int) -> tuple[Numbers, Ints, Numbers]:
    """Omega of the seeds and omega - Omega as polynomials in x_i^2, in multiprecision whatever the series has."""
    with MULTIPRECISION.context(series.digits or DOUBLE_DIGITS):
        linear = [series.chain.linear_frequency(q) for q in series.seeds]
        polynomials: list[Polynomial] = []
        for i, w in enumerate(linear):
            ratio = (w / mpf(series.chain.frequencies(series.numbers)[series.seeds[i] - 1])) ** 2
            squares = [{e: ratio * mpf(c) for e, c in series.squared_polynomial(i, k).items()} for k in range(order + 1)]
            roots = square_root(squares, w)[1:]
            sign = -1 if series.chain.mu < 0 else 1
            polynomials.append({e: sign**k * c for k, p in enumerate(roots, 1) for e, c in p.items() if c != 0})
        powers = sorted({e for p in polynomials for e in p}, key=lambda e: (sum(e), e))
        table = [[p.get(e, mpmath.mpf(0)) for p in polynomials] for e in powers]
    s = len(series.seeds)
    return np.array(linear, dtype=object), np.array(powers, dtype=np.int64).reshape(-1, s), np.array(table, dtype=object).reshape(-1, s)


def _unscaled(tables: SeriesTables, digits: int | None) -> list[Polynomial]:
    """omega_i(A) as polynomials {powers of A: coefficient}, order 0 included."""
    polynomials: list[Polynomial] = [{(0,) * len(tables.scales): w} for w in tables.linear]
    with MULTIPRECISION.context(digits or DOUBLE_DIGITS):
        for e, row in zip(tables.frequency_powers.tolist(), tables.frequency_coefficients, strict=True):
            factor = mpmath.fprod(x ** (2 * n) for x, n in zip(tables.scales, e, strict=True))
            for polynomial, c in zip(polynomials, row, strict=True):
                if c != 0:
                    polynomial[tuple(2 * n for n in e)] = c * factor
    return polynomials


def _near_linear(series: LindstedtSeries) -> list[Fraction]:
    """Frequencies a little above the linear ones, where test vectors of a universal form are taken; exact in doubles."""
    linear = [float(series.chain.linear_frequency(q)) for q in series.seeds]
    return [Fraction(_rounded(w * (1 + 1 / (64 + 8 * i)))) for i, w in enumerate(linear)]


def _rounded(value: float) -> float:
    """To 20 binary places: the same number in decimal and in binary, its decimal short."""
    return round(value * 2**20) / 2**20


def _hash(tables: SeriesTables, straight: StraightLine | None) -> str:
    """SHA-256 of the statements, or of harmonics, powers and coefficients as decimal text."""
    digest = hashlib.sha256()
    if straight is not None:
        digest.update(repr(straight.described).encode())
        return digest.hexdigest()
    for block in tables.blocks:
        digest.update(repr((block.modes, block.harmonics.tolist(), tables.powers[block.powers].tolist(), block.starts.tolist())).encode())
        digest.update("\n".join(number(c) for c in block.coefficients.flat).encode())
    digest.update("\n".join(number(c) for c in tables.frequency_coefficients.flat).encode())
    return digest.hexdigest()


def series_check(tables: SeriesTables, N: int, rates: Sequence[float], digits: int | None) -> SeriesCheck:
    """Test vectors of the tables, evaluated with more digits than these have."""
    places = DOUBLE_DIGITS if digits is None else digits
    s = len(tables.scales)
    size = _moderate(tables)
    amplitudes = [_short(min(1.0, size / float(x)) * (1 - i / (2 * s))) for i, x in enumerate(tables.scales)]
    phases = [0.5 - 0.375 * i for i in range(s)]
    with MULTIPRECISION.context(places + EXTRA_DIGITS):
        Q, P = series_orbit(tables, N, amplitudes, phases, rates, [float(t) for t in CHECK_TIMES])
        corrected, jacobian = series_frequencies(tables, amplitudes)

        def row(values: Any) -> tuple[str, ...]:
            return tuple(text(mpmath.mpf(x), places + 2) for x in values)

        return SeriesCheck(
            amplitudes=tuple(decimal(Fraction(a)) for a in amplitudes),
            phases=tuple(decimal(Fraction(p)) for p in phases),
            frequencies=tuple(decimal(Fraction(w)) for w in rates),
            times=CHECK_TIMES,
            positions=tuple(map(row, Q)),
            momenta=tuple(map(row, P)),
            corrected=row(corrected),
            jacobian=tuple(map(row, jacobian)),
        )


def _moderate(tables: SeriesTables) -> float:
    """A scaled amplitude at which higher powers are smaller than lower ones."""
    degrees = tables.powers.sum(axis=1)
    largest: dict[int, float] = {}
    for block in tables.blocks:
        of_row = np.abs(block.coefficients.astype(float)).max(axis=1)
        for d in np.unique(degrees[block.powers]).tolist():
            largest[d] = max(largest.get(d, 0.0), float(of_row[degrees[block.powers] == d].max()))
    growth = [(largest[d] / largest[1]) ** (1 / (d - 1)) for d in largest if d > 1]
    return float(1 / (4 * len(tables.scales) * max([1e-3, *growth])))


def _short(value: float) -> float:
    """Rounded to 10 binary digits."""
    mantissa, exponent = math.frexp(value)
    return math.ldexp(round(mantissa * 1024) / 1024, exponent)


def series_orbit(
    tables: SeriesTables, N: int, amplitudes: Sequence[Any], phases: Sequence[Any], rates: Sequence[Any], times: Sequence[Any]
) -> tuple[Numbers, Numbers]:
    """Q and P (T, N-1) of the tables at the working precision of mpmath: what emitted code is held against."""
    x = [c * mpmath.mpf(a) for c, a in zip(tables.scales, amplitudes, strict=True)]
    monomials = np.array([mpmath.fprod(v**n for v, n in zip(x, e, strict=True)) for e in tables.powers.tolist()], dtype=object)
    omega = np.array([mpmath.mpf(w) for w in rates], dtype=object)
    theta = [omega * mpmath.mpf(t) + np.array([mpmath.mpf(p) for p in phases], dtype=object) for t in times]
    Q, P = (np.full((len(times), N - 1), mpmath.mpf(0), dtype=object) for _ in range(2))
    for block in tables.blocks:
        columns = np.array(block.modes) - 1
        rows = _EXACT(block.coefficients) * monomials[block.powers][:, None]
        cosines = np.add.reduceat(rows, block.starts[:-1], axis=0)
        for i, angles in enumerate(theta):
            along = block.harmonics.astype(object) @ angles
            Q[i, columns] += MULTIPRECISION.cos(along) @ cosines
            P[i, columns] -= (MULTIPRECISION.sin(along) * (block.harmonics.astype(object) @ omega)) @ cosines
    return Q, P


def series_frequencies(tables: SeriesTables, amplitudes: Sequence[Any]) -> tuple[Numbers, Numbers]:
    """omega(A) (s,) and d omega_i / d A_j (s, s) of the tables at the working precision of mpmath."""
    s = len(tables.scales)
    x = [c * mpmath.mpf(a) for c, a in zip(tables.scales, amplitudes, strict=True)]
    omega, jacobian = tables.linear.copy(), np.full((s, s), mpmath.mpf(0), dtype=object)
    for e, row in zip(tables.frequency_powers.tolist(), tables.frequency_coefficients, strict=True):
        omega = omega + row * mpmath.fprod(v ** (2 * n) for v, n in zip(x, e, strict=True))
        for j in range(s):
            if e[j]:
                slope = mpmath.fprod(v ** (2 * n - (i == j)) for i, (v, n) in enumerate(zip(x, e, strict=True)))
                jacobian[:, j] += row * slope * (2 * e[j]) * tables.scales[j]
    return omega, jacobian


_EXACT = np.frompyfunc(mpmath.mpf, 1, 1)  # a double is the number it is here, not its shortest decimal
