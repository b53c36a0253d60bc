"""Sums over the terms of a series at given amplitudes, in doubles or in many digits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import mpmath
import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.algebra.grading import Ints
from symfpu.algebra.polynomials import (
    Polynomial,
    evaluate,
    powers_of,
    roots_by_order,
)
from symfpu.chain.chain import linear_by_wave
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import (
    DOUBLES,
    MULTIPRECISION,
    Arithmetic,
    Numbers,
    integers,
    with_digits,
)
from symfpu.numbers.mpfr import MPFR, at_the_face, in_mpf, scaled_integers
from symfpu.numbers.public import public
from symfpu.series.coefficients import SeriesCoefficients

Floats = NDArray[np.float64]


@public
@dataclass(frozen=True, eq=False)
class SeriesSums(SeriesCoefficients):
    """A series whose frequencies are chosen, summed."""

    def _numeric(self) -> None:
        require_frequencies(self)

    @cached_property
    def _kappa(self) -> Any:
        """The factor |mu|^(1/step) unit of the variables w_i, before the scaled tables apply."""
        mu = abs(self.chain.small_parameter(self.numbers))
        root = mu ** (1 / self.chain.degree_step)
        return root * self.numbers.number(self.unit)

    def _sign(self, order: int) -> float:
        return -1.0 if self.chain.mu < 0 and order % 2 else 1.0

    @cached_property
    def seed_factors(self) -> Numbers:
        """kappa Omega_i / 2: the scaled variables x_i at unit amplitudes; shape (s,)."""
        factors = self._kappa / 2 * self._linear_of_seeds(self.numbers)
        return with_digits(np.asarray(factors), self.digits)

    def scaled_seeds(self, amplitudes: ArrayLike) -> Numbers:
        """The variables of the scaled tables, kappa Omega_i A_i / 2; shapes (s,)."""
        with self._context():
            scaled = self.seed_factors * self.numbers.array(amplitudes)
            return with_digits(np.asarray(scaled), self.digits)

    def amplitude_terms(self, order: int) -> tuple[Ints, Ints, Numbers]:
        """mu^k Q_q^(k) with free amplitudes, by canonical monomials.

        The sum over rows of value[., q] x^e cos(nu.theta), x = scaled_seeds(A).

        The summands of Eq. serabs1, for any seeds. Returns harmonics nu (R, s), exponents e (R,
        s) and values (R, C), one row for each canonical monomial, columns as `harmonic_terms` has.
        """
        self._numeric()
        degree = self.degree(order)
        nu, index = self.grading.harmonics(degree)
        with self._context():
            factor = self._sign(order) / self._kappa
            linear = self._linear_of(nu[index], self.numbers)
            values = self.tables.entries(self.coordinates[order]) * factor / linear
            oscillates = (nu != 0).any(axis=1)
            values[oscillates[index]] *= 2
        return nu[index], self.grading.powers(degree), with_digits(values, self.digits)

    def harmonic_terms(
        self, amplitudes: ArrayLike, order: int, *, absolute: bool = False
    ) -> tuple[Ints, Numbers]:
        """mu^k Q_q^(k) at these seed amplitudes as cosine coefficients.

        The sum over rows of value[., q] cos(nu.theta).

        The sums in brackets of Eq. serabs1, for any seeds. amplitudes : (s,) in the order of the
        seeds.
        Returns harmonics (H, s), one of each pair +-nu, and values (H, C), C = N-1 modes, or 1 on a
        ring: c of the wave of wave number m = nu.seeds, which moves the particles by
        x_j = N^(-1/2) c sgn(sin(pi m/N)) sin(2 pi m j/N - nu.theta).
        absolute : take the modulus of every monomial before they are summed (for S_1 of Eq.
        serabs2); always doubles.
        """
        nu, values = self.harmonic_sums(amplitudes, order, absolute=absolute)
        return nu, with_digits(at_the_face(values), self.digits)

    def harmonic_sums(
        self, amplitudes: ArrayLike, order: int, *, absolute: bool = False
    ) -> tuple[Ints, Numbers]:
        """`harmonic_terms` for further sums: with digits, values are MPFR's numbers.

        Raises InputError for amplitudes that do not fit the seeds.
        """
        self._numeric()
        shape = np.shape(amplitudes)
        if shape != (len(self.seeds),):
            allowed = f"one for each of the seeds {self.seeds}"
            raise InputError("amplitudes", shape, allowed, "pass a sequence in their order")
        nu, index = self.grading.harmonics(self.degree(order))
        oscillates = (nu != 0).any(axis=1)
        with self._context():
            factor = self._sign(order) / self._kappa
            if absolute or self.digits is None:
                table = self._doubles(amplitudes, order)
                summands = np.abs(table) if absolute else table
                values = _summed(summands, index, len(nu))
                values = values * float(factor) / self._linear_of(nu, DOUBLES)
            else:
                whole, exponent = self._integers(amplitudes, order)
                sums = _summed(whole, index, len(nu))
                linear = MPFR.array(self._linear_of(nu, MULTIPRECISION))
                values = scaled_integers(sums, exponent) * MPFR.array(factor)[()] / linear
            values[oscillates] *= 2
        return nu, np.abs(values) if absolute else values

    def _linear_of(self, harmonics: Ints, numbers: Arithmetic) -> Numbers:
        """Omega of every coefficient at harmonics (H, s), (H | 1, C); 1 where nothing moves."""
        waves = self.space.wave_numbers(harmonics)
        if numbers is DOUBLES:
            return self._divided_by[waves]
        moving = [self.chain.linear_frequency(m) for m in range(1, self.chain.N)]
        return np.asarray(np.array([mpmath.mpf(1), *moving])[waves])

    @cached_property
    def _divided_by(self) -> Floats:
        """Omega by wave number in doubles; 1 for the one that does not move."""
        linear = linear_by_wave(self.chain.N, self.chain.ends)
        return np.where(linear == 0, 1.0, linear)

    def _linear_of_seeds(self, numbers: Arithmetic) -> Numbers:
        """Omega of the seeds, (s,)."""
        waves = np.array(self.seeds) % self.chain.N
        if numbers is DOUBLES:
            return np.asarray(linear_by_wave(self.chain.N, self.chain.ends)[waves])
        return numbers.array([self.chain.linear_frequency(q) for q in self.seeds])

    def _doubles(self, amplitudes: ArrayLike, order: int) -> Floats:
        """Every coefficient of an order times its monomial, as doubles."""
        values = self.tables.doubles(self.coordinates[order])
        seeds = self.scaled_seeds(amplitudes).astype(float)
        powers = self.grading.powers(self.degree(order))
        monomials = np.prod(seeds**powers, axis=1)
        return np.asarray(values * monomials[:, None])

    def _integers(
        self, amplitudes: ArrayLike, order: int
    ) -> tuple[NDArray[np.object_], NDArray[np.int64]]:
        """The same as integers, and the power of two of their unit."""
        powers = self.grading.powers(self.degree(order))
        seeds = self.scaled_seeds(amplitudes)
        highest = int(powers.max())
        table = powers_of(list(seeds), highest, mpmath.mpf(1))
        first = np.array(table[0], dtype=object)
        monomials = first[powers[:, 0]]
        for i in range(1, len(seeds)):
            powers_of_seed = np.array(table[i], dtype=object)
            monomials = monomials * powers_of_seed[powers[:, i]]
        whole, exponent = integers(monomials[:, None])
        products = self.coordinates[order].integers() * whole
        return products, exponent - self.bits

    def absolute_sums(
        self, q: int, amplitudes: ArrayLike, *, with_mu: bool = False
    ) -> tuple[Floats, Floats]:
        """S_1(k) and S_2(k) of Eqs. serabs2 and serabs3 for Q_q^(k), as doubles.

        k = 0 .. order; shapes (order + 1,) each. On a ring of the waves q and -q.

        S_1 adds the moduli of all coefficients, S_2 those of the cosines after the monomials of
        one harmonic are summed.
        with_mu : sums of mu^k Q_q^(k) instead, which cannot leave the range of doubles.
        """
        mode, sums = self._mode(q), np.empty((2, self.order + 1))
        for k in range(self.order + 1):
            unit = 1.0 if with_mu else abs(self.chain.mu) ** -float(k)
            for row, absolute in enumerate((True, False)):
                nu, values = self.harmonic_terms(amplitudes, k, absolute=absolute)
                moduli = np.abs(values[self.space.in_mode(mode, nu)])
                sums[row, k] = unit * float(moduli.sum())
        return sums[0], sums[1]

    def frequency_terms(
        self, squared_amplitudes: ArrayLike, order: int | None = None
    ) -> tuple[Numbers, Numbers]:
        """mu^k omega_q^(k) for k = 0 .. order (default all) at A^2, and the derivatives by A^2.

        squared_amplitudes : (s,). Returns terms (order + 1, s), order 0 being Omega_q, and
        derivatives (order + 1, s, s) with the last axis for the variable.
        Beyond the range of doubles they are infinite or NaN.
        """
        self._numeric()
        top = self.order if order is None else self._order(order)
        if self.digits is None:
            squares = one_of_each(self.seeds, squared_amplitudes, "squared_amplitudes")
            return self._frequency_doubles(squares, top)
        with self._context():
            point = list(MPFR.array(self.numbers.array(squared_amplitudes)))
            highest = self.chain.degree_step * top // 2
            powers = powers_of(point, highest, MPFR.number(Fraction(1)))
            values, gradients = [], []
            for polynomials in self._summed_polynomials[: top + 1]:
                parts = [evaluate(p, powers) for p in polynomials]
                values.append([value for value, _ in parts])
                gradients.append([gradient for _, gradient in parts])
            terms, slopes = in_mpf(MPFR.array(values)), in_mpf(MPFR.array(gradients))
        return with_digits(terms, self.digits), with_digits(slopes, self.digits)

    @cached_property
    def _summed_polynomials(self) -> list[list[Polynomial]]:
        """The same in MPFR's numbers."""
        return [
            [{e: MPFR.array(c)[()] for e, c in polynomial.items()} for polynomial in row]
            for row in self._frequency_polynomials
        ]

    @cached_property
    def _frequency_polynomials(self) -> list[list[Polynomial]]:
        """mu^k omega_q^(k) as polynomials in A^2, by order and seed, in mpf."""
        slopes = [f**2 for f in self.seed_factors]
        squares = [
            [self.squared_polynomial(i, k) for k in range(self.order + 1)]
            for i in range(len(self.seeds))
        ]
        linear = list(map(self._linear, self.seeds))
        return roots_by_order(squares, linear, slopes, negative=self.chain.mu < 0)

    def _frequency_doubles(self, squares: Floats, top: int) -> tuple[Floats, Floats]:
        linear = self._linear_of_seeds(DOUBLES)
        slope = self.seed_factors**2
        diagonals, tables = self._frequency_tables
        return frequency_sums(linear, slope, squares, diagonals[:top], tables[:top])

    @cached_property
    def _frequency_tables(self) -> tuple[list[Ints], list[Floats]]:
        """Exponents and coefficients of W by order from 1 on, as `frequency_sums` takes them."""
        orders = range(1, self.order + 1)
        diagonals = [self.grading.diagonal(self.chain.degree_step * k) for k in orders]
        return diagonals, [self._sign(k) * self.corrections[k] for k in orders]


def require_frequencies(series: SeriesCoefficients) -> None:
    """InputError for a series in universal form."""
    if series.frequencies is None:
        allowed = "a series with chosen frequencies"
        advice = "give frequencies= to lindstedt"
        raise InputError("series", "universal form", allowed, advice)


def _summed(table: NDArray[Any], index: Ints, count: int) -> NDArray[Any]:
    """Sums of the rows of a table that have the same index, (count, C)."""
    if table.shape[1] == 1 and table.dtype == float:
        return np.bincount(index, table[:, 0], count)[:, None]
    order = np.argsort(index, kind="stable")
    starts = np.searchsorted(index[order], np.arange(count))
    return np.asarray(np.add.reduceat(table[order], starts, axis=0))


def one_of_each(seeds: tuple[int, ...], values: ArrayLike, argument: str) -> Floats:
    """Doubles in the order of the seeds, shape (s,); InputError for another shape."""
    array = DOUBLES.array(values)
    if array.shape != (len(seeds),):
        allowed = f"one for each of the seeds {seeds}"
        raise InputError(argument, array.shape, allowed, "pass a sequence in their order")
    return array


def frequency_sums(
    linear: Floats,
    slope: Floats,
    squares: Floats,
    diagonals: Sequence[Ints],
    tables: Sequence[Floats],
) -> tuple[Floats, Floats]:
    """Terms of omega by order at A^2 and their derivatives, from the tables of W by order.

    linear, slope, squares : (s,), Omega of the seeds, the factor of A^2 in the tables' variables,
    and A^2. diagonals, tables : of orders 1, 2, ..., exponents and coefficients of W.
    """
    # lazy: numba takes longer to import than all the rest
    from symfpu.series.frequency_loops import frequencies_by_order

    s, top = len(linear), len(tables)
    terms = np.zeros((top + 1, s))
    jacobian = np.zeros((top + 1, s, s))
    terms[0] = linear
    if not top:
        return terms, jacobian
    first = np.cumsum([0, *map(len, diagonals)])
    exponents = np.concatenate(diagonals).reshape(-1, s)
    table = np.concatenate([np.reshape(rows, (-1, s)) for rows in tables]) * linear**2
    rules = first, exponents, table, linear, slope
    frequencies_by_order(slope * squares, *rules, terms, jacobian)
    return terms, jacobian
