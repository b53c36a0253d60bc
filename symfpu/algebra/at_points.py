"""Polynomials in the last seed by their values at points: products there cost one for each point.

A residue is exact however it was reached, so what doubles may not do, residues may: the part of a
series in z, conj z of the last seed, degree e, is a polynomial of e + 1 coefficients. It is known
by its values at e + 1 points, and a product needs one multiply-add for each point, where
coefficients need one for each pair. Factors are evaluated once, each result is interpolated once.

One seed: the coefficients are those of z^p conj z^n and conj z^p z^n alike, so the polynomial is a
sum of cosines cos(nu theta), nu of one parity. It is evaluated at theta_k = (2k + 1) pi / 2M, k <
M / 2, M even and above all degrees. Cosines modulo a prime are half of r^j + r^-j, r a root of
unity of order 4M; sums over all theta_k tell them from each other, as those of real cosines do.

Two seeds: blocks of one outer monomial are polynomials in z / conj z of the last one, at the points
0, 1, 2, ...; as many of them as a product with this block can need. Interpolation is Lagrange's.
"""

from __future__ import annotations

from functools import cached_property
from math import factorial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Grading, Ints

Residues = NDArray[np.float64]


class PointRows(NamedTuple):
    """Where values lie: of outer monomial X at point k, degree e in the last seed, it is row
    first[k] + offset[X] + e. What a sum of products takes lies together.

    counts : (X,) points of an outer monomial, no more than any before. first : (points + 1,).
    offset : (X,).
    """

    counts: Ints
    first: Ints
    offset: Ints


class Places(NamedTuple):
    """Matrices, one for each degree of a polynomial, whose entries are places in a table.

    flat : all of them, row by row. start : (degree + 1,) where each begins. columns : of each.
    """

    flat: Ints
    start: Ints
    columns: Ints


class AtPoints:
    """Values at points of all degrees of a grading whose inner monomials are of one seed."""

    def __init__(self, grading: Grading) -> None:
        self.grading = grading
        self.alone = grading.seeds == 1

    @staticmethod
    def fits(grading: Grading) -> bool:
        """Whether the inner monomials are of one seed."""
        return grading.seeds <= 2

    @property
    def divisor(self) -> int:
        """Of p - 1 for every prime p that is computed with: F_p has a root of that order."""
        return 4 * self._nodes if self.alone else 2

    def divide(self, primes: tuple[int, ...]) -> bool:
        """Whether there are such roots modulo all of these primes."""
        return all(p % self.divisor == 1 for p in primes)

    @property
    def _nodes(self) -> int:
        """M: the number of nodes theta_k on the half circle."""
        return self.grading.degree + 1 + (self.grading.degree + 1) % 2

    @cached_property
    def rows(self) -> PointRows:
        """Rows of degrees that are factors: all but the last one."""
        outer, degree = self.grading.tables.outer_degree, self.grading.degree
        most = self._nodes // 2 if self.alone else degree + 1
        lengths = np.maximum(degree - outer, 0)
        offset = np.cumsum(lengths) - lengths
        counts = most - outer
        totals = [int(lengths[counts > k].sum()) for k in range(most)]
        first = np.concatenate([[0], np.cumsum(totals)])
        return PointRows(counts, first.astype(np.int64), offset)

    def rows_of(self, degree: int) -> Ints:
        """All rows of a degree."""
        outer, rows = self.grading.tables.outer_degree, self.rows
        own = np.flatnonzero(outer <= degree)
        places = rows.offset[own] + degree - outer[own]
        there = rows.counts[own] > np.arange(len(rows.first) - 1)[:, None]
        return np.asarray((rows.first[:-1, None] + places)[there])

    def powers(self, primes: tuple[int, ...]) -> Residues:
        """What coefficients are times to give values, (entries, primes)."""
        if self.alone:
            cosines = self._doubled_cosines(primes)
            return np.vstack([cosines, np.ones(len(primes))])
        n = self.grading.degree + 1
        table = np.ones((n, n, len(primes)), dtype=np.int64)
        moduli, points = np.array(primes), np.arange(n)[:, None]
        for p in range(1, n):
            table[:, p] = table[:, p - 1] * points % moduli
        return _centred(table.reshape(n * n, -1), moduli)

    def inverse_powers(self, primes: tuple[int, ...]) -> Residues:
        """What values are times to give coefficients, (entries, primes)."""
        moduli = np.array(primes)
        if self.alone:
            shares = np.array([pow(self._nodes, -1, p) for p in primes])
            whole = self._doubled_cosines(primes).astype(np.int64) * shares
            return _centred(whole, moduli)
        sizes = range(1, self.grading.degree + 2)
        return np.vstack([_lagrange(n, moduli) for n in sizes])

    def _doubled_cosines(self, primes: tuple[int, ...]) -> Residues:
        """2 cos(j pi / 2M) modulo every prime, j = 0 .. 4M - 1; shape (4M, primes)."""
        turn = self.divisor
        columns = []
        for p in primes:
            root = _root_of_unity(turn, p)
            powers = np.ones(turn, dtype=np.int64)
            for j in range(1, turn):
                powers[j] = powers[j - 1] * root % p
            columns.append(powers + powers[-np.arange(turn)])
        return _centred(np.array(columns).T, np.array(primes))

    def places(self, degree: int) -> Places:
        """Entries of `powers`, point by point, for the polynomials that a degree can have."""
        return _joined([self._entries(e) for e in self._inner(degree)], degree)

    def inverse_places(self, degree: int) -> Places:
        """Entries of `inverse_powers`, coefficient by coefficient."""
        return _joined([self._inverse_entries(e) for e in self._inner(degree)], degree)

    def _inner(self, degree: int) -> range:
        """Degrees of the last seed within a degree."""
        return range(degree if self.alone else 0, degree + 1)

    def _entries(self, degree: int) -> Ints:
        """By point and coefficient; of canonical coefficients, nu >= 0, where there is one seed."""
        if not self.alone:
            n = self.grading.degree + 1
            return n * np.arange(n)[:, None] + np.arange(degree + 1)
        nu = np.arange(degree % 2, degree + 1, 2)
        return np.where(nu, self._angles(nu), self.divisor)

    def _inverse_entries(self, degree: int) -> Ints:
        """By coefficient and point."""
        if not self.alone:
            n = degree + 1
            before = sum(m * m for m in range(1, n))
            return before + np.arange(n * n, dtype=np.int64).reshape(n, n)
        nu = np.arange(degree % 2, degree + 1, 2)
        return self._angles(nu).T

    def _angles(self, nu: Ints) -> Ints:
        """nu theta_k in units of pi / 2M, by point and harmonic."""
        odd = 2 * np.arange(self._nodes // 2) + 1
        return np.asarray(np.outer(odd, nu) % self.divisor)


def _centred(whole: Any, moduli: Any) -> Residues:
    """Residues in -p/2 .. p/2 of integers; the primes are the last axis."""
    least = whole % moduli
    return np.asarray(
        np.where(least > moduli // 2, least - moduli, least), dtype=np.float64
    )


def _root_of_unity(order: int, prime: int) -> int:
    """An element of just this order, which divides prime - 1."""
    factors = [q for q in range(2, order + 1) if order % q == 0 and _is_prime(q)]
    for base in range(2, prime):
        root = pow(base, (prime - 1) // order, prime)
        if all(pow(root, order // q, prime) != 1 for q in factors):
            return root
    raise ArithmeticError(f"no root of unity of order {order} modulo {prime}")


def _is_prime(number: int) -> bool:
    return all(number % q for q in range(2, int(number**0.5) + 1))


def _lagrange(n: int, moduli: Any) -> Residues:
    """Coefficients of the polynomials that are one at one of the points 0 .. n - 1.

    Shape (n n, primes): coefficient by coefficient, point by point.
    """
    whole = [1]  # x (x - 1) ... (x - n + 1), highest coefficient first
    for point in range(n):
        lower = [-point * c for c in whole]
        whole = _plus([*whole, 0], [0, *lower])
    rows = np.array([[c % p for p in moduli.tolist()] for c in whole[:n]], dtype=np.int64)
    points = np.arange(n)[:, None]
    table = np.empty((n, n, len(moduli)), dtype=np.int64)
    quotient = np.zeros((n, len(moduli)), dtype=np.int64)
    for p in range(n):  # Horner's rule: the product over x - point, by falling powers
        quotient = (quotient * points + rows[p]) % moduli
        table[n - 1 - p] = quotient
    scales = [(-1) ** (n - 1 - k) * factorial(k) * factorial(n - 1 - k) for k in range(n)]
    inverses = [[pow(s, -1, p) for p in moduli.tolist()] for s in scales]
    shares = np.array(inverses, dtype=np.int64)
    return _centred((table * shares % moduli).reshape(n * n, -1), moduli)


def _plus(a: list[int], b: list[int]) -> list[int]:
    return [x + y for x, y in zip(a, b, strict=True)]


def _joined(matrices: list[Ints], degree: int) -> Places:
    """The matrices of polynomials up to a degree; of lower ones than are given there are none."""
    missing = degree + 1 - len(matrices)
    sizes = np.array([0] * missing + [m.size for m in matrices])
    columns = np.array([0] * missing + [m.shape[1] for m in matrices])
    flat = np.concatenate([m.ravel() for m in matrices]).astype(np.int64)
    return Places(flat, np.cumsum(sizes) - sizes, columns)
