"""A series with free amplitudes as tables, for files and for their test vectors.

Q_q is a sum over harmonics nu and powers e of c x^e cos(nu.theta) with scaled amplitudes
x_i = scale_i A_i, whose coefficients stay within the range of doubles at any order. At given
amplitudes the powers of one harmonic are summed first; what is left is a torus.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import mpmath
import numpy as np

from symfpu.algebra.grading import Ints
from symfpu.algebra.polynomials import Polynomial, square_root
from symfpu.codegen.torus_program import DOUBLE_DIGITS, exact_numbers, highest_numbers
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers, mpf
from symfpu.series.series import LindstedtSeries


@dataclass(frozen=True, eq=False)
class SeriesBlock:
    """Harmonics of one parity, each with a run of rows.

    modes : (M,). harmonics : (H, s). starts : (H+1,), harmonic h has the rows starts[h] up to
    starts[h+1]. powers : (R,), rows of SeriesTables.powers. coefficients : (R, M), of
    x^e cos(nu.theta) in every mode.
    """

    modes: tuple[int, ...]
    harmonics: Ints
    starts: Ints
    powers: Ints
    coefficients: Numbers


@dataclass(frozen=True, eq=False)
class SeriesTables:
    """Coefficients of scaled amplitudes.

    scales : (s,), x_i = scales[i] A_i. powers : (E, s), the exponents e. linear : (s,), Omega of
    the seeds. frequency_powers : (F, s). frequency_coefficients : (F, s); omega_i(A) is linear_i
    + sum over f of frequency_coefficients[f, i] prod x_j^(2 frequency_powers[f, j]).
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
        harmonics = [block.harmonics for block in self.blocks]
        return highest_numbers(harmonics, len(self.scales))

    @property
    def coefficient_count(self) -> int:
        """Coefficients that are not zero."""
        return sum(int(np.count_nonzero(block.coefficients)) for block in self.blocks)


def series_tables(series: LindstedtSeries, order: int, frequency_order: int) -> SeriesTables:
    """The tables of a series with chosen frequencies, rows without a coefficient left out."""
    terms = [series.amplitude_terms(k) for k in range(order + 1)]
    nu, e, values = (np.concatenate(parts) for parts in zip(*terms, strict=True))
    powers, which = np.unique(e, axis=0, return_inverse=True)
    blocks = _blocks(series, nu, which.reshape(-1), values)
    linear = _linear(series)
    frequency_powers, coefficients = _frequencies(series, linear, frequency_order)
    with MULTIPRECISION.context(series.digits or DOUBLE_DIGITS):
        scales = np.array([mpf(x) for x in series.seed_factors], dtype=object)
    return SeriesTables(scales, powers, blocks, linear, frequency_powers, coefficients)


def _blocks(
    series: LindstedtSeries,
    nu: Ints,
    which: Ints,
    values: Numbers,
) -> tuple[SeriesBlock, ...]:
    """Rows in the order of harmonics, by parity. nu : (R, s). which : (R,). values : (R, N-1)."""
    parities = nu @ np.array(series.seeds) % 2
    modes = np.arange(1, series.chain.N)
    by_harmonic = np.lexsort((which, *nu.T[::-1]))
    blocks = []
    for parity in (0, 1):
        columns = np.flatnonzero(modes % 2 == parity)
        rows = by_harmonic[parities[by_harmonic] == parity]
        silent = (values[np.ix_(rows, columns)] == 0).all(axis=1)
        rows = rows[~silent]
        if not len(rows):
            continue
        harmonics, starts = np.unique(nu[rows], axis=0, return_index=True)
        block = SeriesBlock(
            modes=tuple(modes[columns].tolist()),
            harmonics=harmonics,
            starts=np.append(starts, len(rows)),
            powers=which[rows],
            coefficients=values[np.ix_(rows, columns)],
        )
        blocks.append(block)
    return tuple(blocks)


def _linear(series: LindstedtSeries) -> Numbers:
    """Omega of the seeds, in multiprecision whatever the series has."""
    with MULTIPRECISION.context(series.digits or DOUBLE_DIGITS):
        frequencies = [series.chain.linear_frequency(q) for q in series.seeds]
    return np.array(frequencies, dtype=object)


def _frequencies(series: LindstedtSeries, linear: Numbers, order: int) -> tuple[Ints, Numbers]:
    """Powers of x^2, (F, s), and coefficients, (F, s), of omega - Omega in multiprecision."""
    s = len(series.seeds)
    with MULTIPRECISION.context(series.digits or DOUBLE_DIGITS):
        polynomials = [_frequency(series, i, w, order) for i, w in enumerate(linear)]
        every = {e for polynomial in polynomials for e in polynomial}
        powers = sorted(every, key=lambda e: (sum(e), e))
        zero = mpmath.mpf(0)
        table = [[polynomial.get(e, zero) for polynomial in polynomials] for e in powers]
    exponents = np.array(powers, dtype=np.int64).reshape(-1, s)
    return exponents, np.array(table, dtype=object).reshape(-1, s)


def _frequency(series: LindstedtSeries, i: int, linear: Any, order: int) -> Polynomial:
    """omega_i - Omega_i in powers of x^2; the series may have its own Omega, rounded to doubles."""
    known = series.chain.frequencies(series.numbers)[series.seeds[i] - 1]
    ratio = (linear / mpf(known)) ** 2
    squares = [_scaled(series.squared_polynomial(i, k), ratio) for k in range(order + 1)]
    roots = square_root(squares, linear)
    sign = -1 if series.chain.mu < 0 else 1
    result: Polynomial = {}
    for k, root in enumerate(roots[1:], 1):
        result |= {e: sign**k * c for e, c in root.items() if c != 0}
    return result


def _scaled(polynomial: Polynomial, factor: Any) -> Polynomial:
    return {e: factor * mpf(c) for e, c in polynomial.items()}


def frequency_polynomials(tables: SeriesTables, digits: int | None) -> list[Polynomial]:
    """omega_i(A) of every seed as {powers of A: coefficient}, order 0 included."""
    none = (0,) * len(tables.scales)
    polynomials: list[Polynomial] = [{none: w} for w in tables.linear]
    exponents = (2 * tables.frequency_powers).tolist()
    with MULTIPRECISION.context(digits or DOUBLE_DIGITS):
        for e, row in zip(exponents, tables.frequency_coefficients, strict=True):
            factor = monomial(tables.scales, e)
            for polynomial, c in zip(polynomials, row, strict=True):
                if c != 0:
                    polynomial[tuple(e)] = c * factor
    return polynomials


def monomial(x: Iterable[Any], exponents: Iterable[int]) -> Any:
    """The product of powers, at the working precision of mpmath."""
    return mpmath.fprod(v**n for v, n in zip(x, exponents, strict=True))


def series_orbit(
    tables: SeriesTables,
    N: int,
    amplitudes: Sequence[Any],
    phases: Sequence[Any],
    rates: Sequence[Any],
    times: Sequence[Any],
) -> tuple[Numbers, Numbers]:
    """Q and P (T, N-1) of the tables at the working precision of mpmath."""
    x = tables.scales * exact_numbers(amplitudes)
    monomials = np.array([monomial(x, e) for e in tables.powers.tolist()], dtype=object)
    omega = np.array(exact_numbers(rates), dtype=object)
    phi = np.array(exact_numbers(phases), dtype=object)
    angles = [omega * mpmath.mpf(t) + phi for t in times]
    Q = MULTIPRECISION.zeros((len(times), N - 1))
    P = MULTIPRECISION.zeros((len(times), N - 1))
    for block in tables.blocks:
        columns = np.array(block.modes) - 1
        harmonics = block.harmonics.astype(object)
        rows = exact_numbers(block.coefficients) * monomials[block.powers][:, None]
        cosines = np.add.reduceat(rows, block.starts[:-1], axis=0)
        turning = harmonics @ omega
        for i, theta in enumerate(angles):
            along = harmonics @ theta
            Q[i, columns] += MULTIPRECISION.cos(along) @ cosines
            P[i, columns] -= (MULTIPRECISION.sin(along) * turning) @ cosines
    return Q, P


def series_frequencies(tables: SeriesTables, amplitudes: Sequence[Any]) -> tuple[Numbers, Numbers]:
    """omega(A) (s,) and d omega_i / d A_j (s, s) at the working precision of mpmath."""
    s = len(tables.scales)
    x = tables.scales * exact_numbers(amplitudes)
    omega = tables.linear.copy()
    jacobian = MULTIPRECISION.zeros((s, s))
    exponents = 2 * tables.frequency_powers
    for e, row in zip(exponents, tables.frequency_coefficients, strict=True):
        omega = omega + row * monomial(x, e.tolist())
        for j in np.flatnonzero(e).tolist():
            lowered = e - (np.arange(s) == j)
            slope = monomial(x, lowered.tolist())
            jacobian[:, j] += row * slope * int(e[j]) * tables.scales[j]
    return omega, jacobian
