"""The tables of a series, and its coefficients by mode, order and monomial."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Grading, Ints
from symfpu.algebra.polynomials import (
    Polynomial,
    square_root,
)
from symfpu.algebra.selection import Modes
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import (
    Arithmetic,
    with_digits,
)
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, order_of
from symfpu.series.divisors import SmallDivisor
from symfpu.series.monomials import modes_of
from symfpu.series.rings import RINGS
from symfpu.series.tables import LOG10_2, Exponents, Tables

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ResiduePoint:
    """A prime p = 1 mod 4N, an element of order 4N and the chosen frequencies, all modulo p."""

    prime: int
    root: int
    frequencies: tuple[int, ...]


@public
@dataclass(frozen=True, eq=False)
class SeriesCoefficients:
    """What a series consists of; its fields are those of `LindstedtSeries`."""

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...] | None
    order: int
    ring: str
    grading: Grading = field(repr=False)
    coordinates: tuple[Any, ...] = field(repr=False)
    corrections: tuple[Any, ...] = field(repr=False)
    unit: Fraction
    smallest_divisors: tuple[SmallDivisor, ...]
    multiply_adds: int = 0
    digits: int | None = None
    bits: int = 0
    radii: tuple[tuple[float, Floats], ...] = field(repr=False, default=())
    point: ResiduePoint | None = None

    @property
    def omega(self) -> dict[int, Fraction]:
        """The frequencies by seed, as the amplitudes are; exact, and none where none are chosen."""
        return dict(zip(self.seeds, self.frequencies or (), strict=False))

    @property
    def modes(self) -> Sequence[int]:
        """The modes that it has coordinates of."""
        return self.chain.mode_numbers

    @cached_property
    def space(self) -> Modes:
        """The modes that the columns of its tables are."""
        return modes_of(self.chain, self.seeds, self.grading)

    @cached_property
    def tables(self) -> Tables:
        """What the tables hold, and in which arithmetic."""
        return RINGS[self.ring].tables(self.digits, self.bits)

    @property
    def symbolic(self) -> bool:
        """Whether the coefficients are expressions in the symbols L_q(nu) (the universal form)."""
        return self.tables.symbolic

    @property
    def precision(self) -> str:
        """The ring of the coefficients, and how many digits it was asked for and carries."""
        if self.digits is None:
            return self.ring
        return f"{self.digits} digits, {self.guard_digits} guard digits"

    @property
    def guard_digits(self) -> int:
        """Decimal places carried beyond the promised ones, from divisors and order.

        As many as the recursion can lose.
        """
        return int(self.bits * LOG10_2) - (self.digits or 0)

    @property
    def numbers(self) -> Arithmetic:
        """The arithmetic of numeric results."""
        return self.tables.numbers

    def _context(self) -> Any:
        return self.numbers.context(self.digits)

    @property
    def coefficient_count(self) -> int:
        """Coefficients stored: one for each canonical monomial and mode."""
        return sum(table.size for table in self.coordinates)

    def degree(self, order: int) -> int:
        """Degree of order k in the amplitudes: k + 1, or 2k + 1 where only beta acts."""
        return 1 + self.chain.degree_step * self._order(order)

    def _order(self, order: int) -> int:
        if order_of(order) > self.order:
            raise InputError(
                "order",
                order,
                f"0..{self.order}, the series' order",
                "compute a longer series",
            )
        return int(order)

    def _mode(self, q: int) -> int:
        modes = self.chain.mode_numbers
        if integer(q, "q", modes[0]) not in modes:
            without = " without 0" if self.chain.periodic else ""
            allowed = f"{modes[0]}..{modes[-1]}{without}"
            raise InputError("q", q, allowed, "name a mode of the chain")
        return int(q)

    def _seed(self, q: int) -> int:
        if q not in self.seeds:
            raise InputError(
                "q",
                q,
                f"a seed, one of {self.seeds}",
                "only seeds have frequency corrections",
            )
        return self.seeds.index(q)

    def _linear(self, q: int) -> Any:
        return self.tables.linear(self.chain, q)

    def _scaled(
        self, values: NDArray[Any], powers: Ints, units: int, halves: int = 0
    ) -> NDArray[Any]:
        """values times prod Omega_i^powers unit^units 2^-halves, in numbers or in symbols."""
        linear = [self._linear(q) for q in self.seeds]
        return self.tables.scaled(
            values, linear, powers, Exponents(self.unit, units, halves)
        )

    def coefficients(self, q: int, order: int) -> tuple[Ints, NDArray[Any]]:
        """Q_q^(k) without mu^k, a polynomial in z_i = (A_i/2) exp(i theta_i), conj z_i.

        Eq. qser.

        Returns exponents (count, 2s) = (p_1, n_1, ..., p_s, n_s) and coefficients (count,) of its
        canonical monomials, zero coefficients left out. The conjugate of a monomial has the same
        coefficient and is not listed again; on a ring it is the same wave, seen from -q.
        Raises InputError for a mode or an order outside the series, SymfpuError where a coefficient
        exceeds doubles.
        """
        self._order(order)
        column, own = self._place(q, order)
        with self._context():
            values = self.tables.entries(self.coordinates[order], [column])[:, 0]
            if own is not None:
                values = np.where(own, values, 0)
            return self._coefficients_of(q, order, values)

    def _place(self, q: int, order: int) -> tuple[int, NDArray[np.bool_] | None]:
        """The column of a mode, and which rows of it are its own; None for all."""
        return self.space.column(self._mode(q), self.degree(order))

    def _coefficients_of(
        self, q: int, order: int, values: NDArray[Any]
    ) -> tuple[Ints, NDArray[Any]]:
        """The coefficients of Q_q^(k) from a column of the table of coordinates."""
        degree = self.degree(order)
        at = np.flatnonzero(values != 0)
        rows = self.grading.canonical(degree)[at]
        exponents = self.grading.exponents(degree)[rows]
        powers = self.grading.powers(degree)[at]
        coordinates = values[at] / self._linear(q)
        result = self._scaled(coordinates, powers, degree - 1)
        found = self.tables.finite(result, f"Q_{q}^({order})")
        return exponents, with_digits(found, self.digits)

    def frequency_coefficients(
        self, q: int, order: int, *, squared: bool = False
    ) -> tuple[Ints, NDArray[Any]]:
        """omega_q^(k) without mu^k, as a polynomial in the amplitudes (Eq. omeser).

        If squared, [omega_q^2]^(k).

        Returns exponents (count, s) of A_1 .. A_s and coefficients (count,), zero coefficients
        left out. Order 0 is Omega_q (its square). omega^(k) = ([omega^2]^(k) - sum_{0<j<k}
        omega^(j) omega^(k-j)) / (2 Omega).
        """
        i = self._seed(q)
        order = self._order(order)
        degree = self.chain.degree_step * order
        with self._context():
            polynomials = [self.squared_polynomial(i, k) for k in range(order + 1)]
            if not squared:
                polynomials = square_root(polynomials, self._linear(q))
            chosen = {e: c for e, c in polynomials[order].items() if c != 0}
            by_square = np.array(list(chosen), dtype=np.int64)
            exponents = by_square.reshape(len(chosen), len(self.seeds)) * 2
            values = np.array(list(chosen.values()), dtype=self.tables.kind)
            simplified = self.tables.simplified(values)
            result = self._scaled(simplified, exponents, degree, degree)
            found = self.tables.finite(result, f"omega_{q}^({order})")
            return exponents, with_digits(found, self.digits)

    def squared_polynomial(self, i: int, order: int) -> Polynomial:
        """[omega_q^2]^(k) as {powers of w_i^2: coefficient}, scaled as the tables are."""
        if not 0 <= i < len(self.seeds):
            allowed = f"an integer in 0..{len(self.seeds) - 1}, the place of a seed"
            raise InputError("i", i, allowed, "count the seeds from 0")
        if not 0 <= order <= self.order:
            allowed = f"an integer in 0..{self.order}, up to the order of the series"
            raise InputError("order", order, allowed, "compute a longer series")
        linear = self._linear(self.seeds[i])
        if order == 0:
            constant = (0,) * len(self.seeds)
            return {constant: linear**2}
        diagonal = self.grading.diagonal(self.chain.degree_step * order)
        if len(diagonal) == 0:
            return {}
        column = self.tables.entries(self.corrections[order], [i])[:, 0]
        polynomial = {}
        for monomial, coefficient in zip(diagonal, column, strict=True):
            exponents = tuple(map(int, monomial))
            polynomial[exponents] = linear**2 * coefficient
        return polynomial
