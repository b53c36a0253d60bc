"""Power series of frequencies with polynomial coefficients, in any numbers that can be added,
multiplied and divided.

A polynomial is {exponents: coefficient}; a series is a list of them, by order. The same few lines
serve doubles, mpf, balls and SymEngine expressions.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Polynomial = dict[tuple[int, ...], Any]


def square_root(squares: Sequence[Polynomial], linear: Any) -> list[Polynomial]:
    """omega^(k) from [omega^2]^(k): ([omega^2]^(k) - sum_{0<j<k} omega^(j) omega^(k-j)) / (2
    Omega); order 0 is Omega itself.
    """
    roots: list[Polynomial] = [dict.fromkeys(squares[0], linear)]
    for k in range(1, len(squares)):
        term = dict(squares[k])
        for j in range(1, k):
            for e, a in roots[j].items():
                for f, b in roots[k - j].items():
                    key = tuple(x + y for x, y in zip(e, f, strict=True))
                    term[key] = term.get(key, 0) - a * b
        roots.append({e: c / (2 * linear) for e, c in term.items()})
    return roots


def evaluate(
    polynomial: Polynomial, powers: Sequence[Sequence[Any]]
) -> tuple[Any, list[Any]]:
    """Value and gradient at a point whose powers are given: powers[i][n] = x_i^n."""
    value: Any = 0
    gradient: list[Any] = [0] * len(powers)
    for exponents, coefficient in polynomial.items():
        term = coefficient
        for i, e in enumerate(exponents):
            if e:
                term = term * powers[i][e]
        value = value + term
        for j, n in enumerate(exponents):
            if n:
                slope = coefficient * n * powers[j][n - 1]
                for i, e in enumerate(exponents):
                    if e and i != j:
                        slope = slope * powers[i][e]
                gradient[j] = gradient[j] + slope
    return value, gradient


def powers_of(point: Sequence[Any], highest: int, one: Any) -> list[list[Any]]:
    """The powers 0 .. highest of every coordinate."""
    table = []
    for x in point:
        row = [one]
        for _ in range(highest):
            row.append(row[-1] * x)
        table.append(row)
    return table


def rescaled(polynomial: Polynomial, slopes: list[Any], sign: float) -> Polynomial:
    """The polynomial in the variables y_i / slope_i, times a sign."""
    result = {}
    for exponents, coefficient in polynomial.items():
        factor: Any = int(sign)
        for e, slope in zip(exponents, slopes, strict=True):
            factor = factor * slope**e
        result[exponents] = coefficient * factor
    return result


def roots_by_order(
    squares: Sequence[Sequence[Polynomial]],
    linear: Sequence[Any],
    slopes: list[Any],
    *,
    negative: bool,
) -> list[list[Polynomial]]:
    """mu^k omega^(k) of every seed, by order and seed, in the variables y_i / slope_i.

    squares : [omega^2]^(k) by seed and order. linear : Omega of seeds. negative : whether mu is.
    """
    by_seed = []
    for own, omega in zip(squares, linear, strict=True):
        roots = []
        for k, polynomial in enumerate(square_root(own, omega)):
            sign = -1.0 if negative and k % 2 else 1.0
            roots.append(rescaled(polynomial, slopes, sign))
        by_seed.append(roots)
    return [list(row) for row in zip(*by_seed, strict=True)]
