"""How frequencies and actions of a truncated series change with its amplitudes, exactly.

The series says omega = F(A; omega) (Eq. omeser), with omega in the divisors, and I = I(A; omega).
Both are differentiated as they stand, through the program of the universal series, by A and by
the omega of the divisors; then
    domega/dA = (1 - F_omega)^-1 F_A,   dI/dA = I_A + I_omega domega/dA.
"""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

from symfpu.action_angle.actions import half_weighted
from symfpu.action_angle.expanded import ExpandedSeries
from symfpu.algebra.truncated import Truncated, variables
from symfpu.chain.chain import Chain
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers
from symfpu.series.lindstedt import lindstedt
from symfpu.series.sample import CosineSums, SampledSeries, sample_series
from symfpu.tori.torus import QTorus


def changes_of_series(torus: QTorus) -> tuple[Numbers, Numbers]:
    """Derivatives of the frequencies and of the actions by the amplitudes, (s, s), A_j last.

    In doubles, or in mpf at the digits of the torus. Raises TooLarge where the universal series
    does not fit into memory.
    """
    if torus.digits is None:
        return _in_doubles(torus)
    with MULTIPRECISION.context(torus.digits):
        return _in_digits(torus)


def _combined(by_a: list[Numbers], by_omega: list[Numbers]) -> tuple[Numbers, Numbers]:
    """Of F and I by both arguments, the derivatives along the family."""
    frequencies, actions = by_a
    divisors, faster = by_omega
    moved = solved(np.eye(len(frequencies)) - divisors, frequencies)
    return moved, actions + faster @ moved


def solved(matrix: Numbers, right: Numbers) -> Numbers:
    """matrix^-1 right, in doubles or mpf; LinAlgError for a singular matrix."""
    if matrix.dtype != object:
        return np.asarray(np.linalg.solve(matrix, right))
    try:
        inverse = mpmath.matrix(matrix.tolist()) ** -1
    except ZeroDivisionError as failure:
        raise np.linalg.LinAlgError(str(failure)) from failure
    return np.asarray(np.array(inverse.tolist(), dtype=object) @ right)


# doubles: the compiled program


def _in_doubles(torus: QTorus) -> tuple[Numbers, Numbers]:
    chain, seeds = torus.chain, torus.seeds
    A = np.array([float(torus.amplitudes[q]) for q in seeds])
    omega = np.array([[float(w) for w in torus.frequencies]])
    frequencies = _sampled(chain, seeds, torus.frequency_order, omega).frequencies_at(A)
    coordinates = _sampled(chain, seeds, torus.order, omega)
    by_a, by_omega = _actions(coordinates, A, omega)
    return _combined(
        [frequencies.by_amplitudes[0], by_a], [frequencies.by_frequencies[0], by_omega]
    )


def _sampled(
    chain: Chain, seeds: tuple[int, ...], order: int, omega: Numbers
) -> SampledSeries:
    series = lindstedt(chain, seeds, order=max(order, 1), ring="nested")
    return sample_series(series, omega)


def _actions(
    sampled: SampledSeries, amplitudes: Numbers, omega: Numbers
) -> tuple[Numbers, Numbers]:
    """Derivatives of the actions by amplitudes and by frequencies."""
    sums = CosineSums(sampled.series, amplitudes[None])
    cosines = sums.of(sampled.coordinates)[..., 0]
    rates, squares = omega[0], (cosines**2).sum(axis=1)
    by_a, by_omega = [], []
    for j, q in enumerate(sampled.series.seeds):
        moved = sums.of(sampled.coordinates, by_amplitude=j)[..., 0]
        by_a.append(half_weighted(sums.harmonics, rates, 2 * (cosines * moved).sum(axis=1)))
        changed = sums.of(sampled.derivatives_by_frequency(q)[0])[..., 0]
        mixed = 2 * (cosines * changed).sum(axis=1)
        faster = half_weighted(sums.harmonics, np.eye(len(rates))[j], squares)
        by_omega.append(half_weighted(sums.harmonics, rates, mixed) + faster)
    return np.array(by_a).T, np.array(by_omega).T


# many digits: the program on numbers with their derivatives


def _in_digits(torus: QTorus) -> tuple[Numbers, Numbers]:
    chain, seeds, s = torus.chain, torus.seeds, len(torus.seeds)
    amplitudes = [mpmath.mpf(torus.amplitudes[q]) for q in seeds]
    point = [*amplitudes, *map(MULTIPRECISION.number, torus.frequencies)]
    unknowns = variables(point, 1, mpmath.mpf(1))
    A, omega = unknowns[:s], unknowns[s:]
    linear = [chain.linear_frequency(q) for q in seeds]
    unit = chain.unit_coupling ** (2 // chain.degree_step) / chain.turn
    kappa = MULTIPRECISION.number(unit)
    y = [a * a * (kappa * w**2 / 4) for a, w in zip(A, linear, strict=True)]
    squares = {q: chain.linear_frequency(q) ** 2 for q in chain.mode_numbers}
    order = max(torus.order, torus.frequency_order)
    series = lindstedt(chain, seeds, order=order, ring="nested")
    expanded = ExpandedSeries(series, linear, squares, mpmath.mpf(1))
    F = _frequencies(expanded, omega, y, torus.frequency_order)
    I = [part * (1 / kappa) for part in expanded.scaled_actions(omega, y, torus.order)]
    by_a = [_slopes(values, range(s)) for values in (F, I)]
    by_omega = [_slopes(values, range(s, 2 * s)) for values in (F, I)]
    return _combined(by_a, by_omega)


def _frequencies(
    expanded: ExpandedSeries, omega: list[Truncated], y: list[Truncated], order: int
) -> list[Truncated]:
    """sum of omega^(k) to an order, from the terms of omega^2."""
    squares = expanded.squared_frequencies(omega, y, order)
    found = []
    for i, linear in enumerate(expanded.linear):
        terms = [y[0] * 0 + linear]
        for k, row in enumerate(squares, start=1):
            products = [terms[j] * terms[k - j] for j in range(1, k)]
            left = sum((p * -1 for p in products), start=row[i])
            terms.append(left * (1 / (2 * linear)))
        found.append(sum(terms[1:], start=terms[0]))
    return found


def _slopes(values: list[Truncated], places: range) -> Numbers:
    """The derivatives by some of the variables; (values, places)."""
    table: list[list[Any]] = []
    for value in values:
        units = [tuple(int(i == place) for i in range(value.size)) for place in places]
        table.append([mpmath.mpf(value.coefficient(unit)) for unit in units])
    return np.array(table, dtype=object)
