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
        counts = [np.count_nonzero(block.coefficients) for block in self.blocks]
        return int(sum(counts))


def series_tables(
    series: LindstedtSeries, order: int, frequency_order: int
) -> SeriesTables:
    """The tables of a series with chosen frequencies, rows without a coefficient left out."""
    terms = [series.amplitude_terms(k) for k in range(order + 1)]
    nu, e, values = map(np.concatenate, zip(*terms, strict=True))
    powers, which = np.unique(e, axis=0, return_inverse=True)
    blocks = row_blocks(series, nu, which.reshape(-1), values)
    linear = _linear(series)
    frequencies = _frequencies(series, linear, frequency_order)
    with MULTIPRECISION.context(series.digits or DOUBLE_DIGITS):
        factors = [mpf(x) for x in series.seed_factors]
    scales = np.array(factors, dtype=object)
    return SeriesTables(scales, powers, blocks, linear, *frequencies)


def row_blocks(
    series: LindstedtSeries,
    nu: Ints,
    which: Ints,
    values: Numbers,
) -> tuple[SeriesBlock, ...]:
    """Rows in the order of harmonics, by parity.

    nu : (R, s). which : (R,), rows of the powers. values : (R, N-1).
    """
    parities = nu @ np.array(series.seeds) % 2
    modes = np.arange(1, series.chain.N)
    by_harmonic = np.lexsort((which, *nu.T[::-1]))
    blocks = []
    for parity in (0, 1):
        own_modes = modes[modes % 2 == parity]
        rows = by_harmonic[parities[by_harmonic] == parity]
        coefficients = values[np.ix_(rows, own_modes - 1)]
        audible = (coefficients != 0).any(axis=1)
        if not audible.any():
            continue
        rows = rows[audible]
        harmonics, starts = np.unique(nu[rows], axis=0, return_index=True)
        block = SeriesBlock(
            tuple(own_modes.tolist()),
            harmonics,
            starts=np.append(starts, len(rows)),
            powers=which[rows],
            coefficients=coefficients[audible],
        )
        blocks.append(block)
    return tuple(blocks)


def _linear(series: LindstedtSeries) -> Numbers:
    """Omega of the seeds, in multiprecision whatever the series has."""
    with MULTIPRECISION.context(series.digits or DOUBLE_DIGITS):
        frequencies = [series.chain.linear_frequency(q) for q in series.seeds]
    return np.array(frequencies, dtype=object)


def _frequencies(
    series: LindstedtSeries,
    linear: Numbers,
    order: int,
) -> tuple[Ints, Numbers]:
    """Powers of x^2, (F, s), and coefficients, (F, s), of omega - Omega in multiprecision."""
    s = len(series.seeds)
    with MULTIPRECISION.context(series.digits or DOUBLE_DIGITS):
        polynomials = [_frequency(series, i, w, order) for i, w in enumerate(linear)]
        zero = mpmath.mpf(0)
    every = set().union(*polynomials)
    powers = sorted(every, key=lambda e: (sum(e), e))
    table = [[p.get(e, zero) for p in polynomials] for e in powers]
    exponents = np.array(powers, dtype=np.int64)
    coefficients = np.array(table, dtype=object)
    return exponents.reshape(-1, s), coefficients.reshape(-1, s)


def _frequency(series: LindstedtSeries, i: int, linear: Any, order: int) -> Polynomial:
    """omega_i - Omega_i in powers of x^2; the series may have its own Omega, rounded to doubles."""
    known = series.chain.frequencies(series.numbers)
    own = known[series.seeds[i] - 1]
    ratio = (linear / mpf(own)) ** 2
    known_squares = [series.squared_polynomial(i, k) for k in range(order + 1)]
    squares = [_scaled(polynomial, ratio) for polynomial in known_squares]
    _, *roots = square_root(squares, linear)
    sign = -1 if series.chain.mu < 0 else 1
    result: Polynomial = {}
    for k, root in enumerate(roots, 1):
        factor = sign**k
        result |= {e: factor * c for e, c in root.items() if c != 0}
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
            powers = tuple(e)
            factor = monomial(tables.scales, powers)
            for polynomial, c in zip(polynomials, row, strict=True):
                if c != 0:
                    polynomial[powers] = c * factor
    return polynomials


def monomial(x: Iterable[Any], exponents: Iterable[int]) -> Any:
    """The product of powers, at the working precision of mpmath."""
    powers = [v**n for v, n in zip(x, exponents, strict=True)]
    return mpmath.fprod(powers)


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
    omega = exact_numbers(rates)
    phi = exact_numbers(phases)
    angles = [omega * mpmath.mpf(t) + phi for t in times]
    shape = len(times), N - 1
    Q = MULTIPRECISION.zeros(shape)
    P = MULTIPRECISION.zeros(shape)
    monomials = [monomial(x, e) for e in tables.powers.tolist()]
    for block in tables.blocks:
        columns = np.array(block.modes) - 1
        harmonics = block.harmonics.astype(object)
        turning = harmonics @ omega
        cosines = _cosines(block, np.array(monomials, dtype=object))
        for i, theta in enumerate(angles):
            along = harmonics @ theta
            cosine = MULTIPRECISION.cos(along)
            slope = MULTIPRECISION.sin(along) * turning
            Q[i, columns] += cosine @ cosines
            P[i, columns] -= slope @ cosines
    return Q, P


def _cosines(block: SeriesBlock, monomials: Numbers) -> Numbers:
    """Coefficients of cos(nu.theta), (H, M), at the values of the monomials, (E,)."""
    coefficients = exact_numbers(block.coefficients)
    factors = monomials[block.powers]
    rows = coefficients * factors[:, None]
    cosines: Numbers = np.add.reduceat(rows, block.starts[:-1], axis=0)
    return cosines


def series_frequencies(
    tables: SeriesTables,
    amplitudes: Sequence[Any],
) -> tuple[Numbers, Numbers]:
    """omega(A) (s,) and d omega_i / d A_j (s, s) at the working precision of mpmath."""
    s = len(tables.scales)
    x = tables.scales * exact_numbers(amplitudes)
    omega = tables.linear.copy()
    jacobian = MULTIPRECISION.zeros((s, s))
    exponents = 2 * tables.frequency_powers
    for e, row in zip(exponents, tables.frequency_coefficients, strict=True):
        value = monomial(x, e.tolist())
        omega = omega + row * value
        for j in np.flatnonzero(e).tolist():
            lowered = e.tolist()
            lowered[j] -= 1
            slope = monomial(x, lowered)
            power = int(e[j])
            jacobian[:, j] += row * slope * power * tables.scales[j]
    return omega, jacobian
