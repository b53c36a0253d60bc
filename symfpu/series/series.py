"""A Poincare-Lindstedt series: its arrays, read as numbers and as SymEngine expressions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import mpmath
import numpy as np
import symengine as se
from numpy.typing import ArrayLike, NDArray

from symfpu.algebra.formulas import NodeTable, expressions, named_expressions
from symfpu.algebra.grading import Grading, Ints
from symfpu.algebra.polynomials import (
    Polynomial,
    evaluate,
    powers_of,
    rescaled,
    square_root,
)
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.frames.attributes import attributes
from symfpu.frames.table import Table
from symfpu.frames.tabled import Tabled
from symfpu.notebook import Shown
from symfpu.numbers.arithmetic import (
    DOUBLES,
    MULTIPRECISION,
    Arithmetic,
    Numbers,
    from_integers,
    integers,
    with_digits,
)
from symfpu.numbers.counted import counted
from symfpu.numbers.typed import Number, integer
from symfpu.series.arguments import digits_of, frequencies_of
from symfpu.series.coefficient_table import (
    COORDINATE,
    Part,
    coefficient_table,
    harmonics_and_powers,
    of_amplitudes,
    of_frequency,
)
from symfpu.series.divisors import Float64Divisors, SmallDivisor
from symfpu.series.monomials import monomial_space
from symfpu.series.named_parts import NamedParts
from symfpu.series.rings import FIXED_POINT, FLOAT64, RESIDUE, RINGS
from symfpu.series.substitution import (
    certified_tables,
    leaves_in_doubles,
    tables_in_doubles,
    tables_of_residues,
)
from symfpu.series.tables import LOG10_2, Exponents, Tables

Floats = NDArray[np.float64]


FORMS = ("expanded", "factored", "cse")


@dataclass(frozen=True)
class ResiduePoint:
    """A prime p = 1 mod 4N, an element of order 4N and the chosen frequencies, all modulo p."""

    prime: int
    root: int
    frequencies: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class LindstedtSeries(Shown, Tabled):
    """The series Q_q = sum mu^k Q_q^(k) and omega_q = Omega_q + sum mu^k omega_q^(k).

    The amplitudes are free.

    Made by `lindstedt` (Eqs. qser, omeser); all quantities dimensionless, phases in radians. The
    tables are in the ring's variables w_i = Omega_i z_i, z_i = (A_i/2) exp(i theta_i), and in
    u_q = Omega_q Q_q, [omega_q^2]^(k) = Omega_q^2 W_q^(k), without mu; degree d carries the
    factor unit^-(d-1).

    chain, seeds, order : as given. frequencies : omega of every seed, exact, shape (s,); None in
        universal form.
    ring : 'float64', 'fixedpoint', 'residue', 'symbolic' or 'nested'. grading : which monomials
        stand in which row.
    coordinates : for each order 0 .. order, u_q^(k); shape (canonical monomials, N-1).
    corrections : for each order 0 .. order, W_q^(k); shape (diagonal monomials, s); no rows where
        none exist.
    unit : the exact unit of amplitudes, which keeps coefficients in the range of doubles.
    smallest_divisors : the smallest |lambda_q - (nu.omega)^2|, ascending, with mode, harmonic and
        order.
    multiply_adds : operations on coefficients that the recursion took.
    digits, bits : with digits, both tables are IntegerTables in units of 2^-bits, and results are
        mpf: every entry of these tables is correct to `digits` digits of the largest one of its
        order, proved; sums at given amplitudes keep the absolute error of their order. None and 0
        otherwise.
    radii : for each order, the largest error of u_q^(k), and the errors of W_q^(k) by monomial
        and seed, in the same units.
    point : where a series of residues was taken. Its methods raise InputError for orders and
        modes it does not have.

    >>> from symfpu.chain.chain import Chain
    >>> from symfpu.series.lindstedt import lindstedt
    >>> lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)
    LindstedtSeries(N=8, alpha=0.3, seeds=1, order 6, 133 coefficients (float64),
    smallest divisor 0.024 at mode 2, harmonic (2), order 1)
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), order=1)
    >>> series.term(q=2, order=1)
    (-1/2)*A1**2*Omega_1**2*L_{2}(0)/Omega_2
    + (-1/2)*A1**2*Omega_1**2*cos(2*theta1)*L_{2}(2)/Omega_2
    >>> numeric = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 2)
    >>> list(numeric.to_frame())
    ['quantity', 'order', 'mode', 'nu_1', 'power_1', 'value']
    """

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

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        smallest = (
            f", smallest divisor {self.smallest_divisors[0]}"
            if self.smallest_divisors
            else ""
        )
        return (
            f"LindstedtSeries({chain}, seeds={','.join(map(str, self.seeds))}, order {self.order}, "
            f"{counted(self.coefficient_count, 'coefficient')} ({self.precision}){smallest})"
        )

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
        if integer(order, "order", 0) > self.order:
            raise InputError(
                "order",
                order,
                f"0..{self.order}, the series' order",
                "compute a longer series",
            )
        return int(order)

    def _mode(self, q: int) -> int:
        if integer(q, "q", 1) >= self.chain.N:
            raise InputError("q", q, f"1..{self.chain.N - 1}", "name a mode of the chain")
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
        coefficient and is not listed again. Raises InputError for a mode or an order outside the
        series, SymfpuError where a coefficient exceeds doubles.
        """
        column = self._mode(q) - 1
        self._order(order)
        with self._context():
            values = self.tables.entries(self.coordinates[order], [column])[:, 0]
            return self._coefficients_of(q, order, values)

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

    def at(
        self,
        frequencies: Sequence[Number],
        *,
        alpha: Number | None = None,
        beta: Number | None = None,
        digits: int | None = None,
        point: ResiduePoint | None = None,
    ) -> LindstedtSeries:
        """The numeric series at chosen frequencies, by the program of a universal series.

        frequencies : omega of every seed, shape (s,), in the order of `seeds`, exact as in
            `lindstedt`. alpha, beta : couplings other than the chain's, not zero where the
            chain's are not. digits : to so many digits of the largest coefficient of an order,
            proved by balls; None for doubles. point : a point modulo a prime instead, then
            frequencies are its own.

        Ours. For many points at once see `sample_series`. Raises InputError, ResonantDivisor for
        frequencies that make a multiplier infinite, VanishingResidue.

        >>> from symfpu import Chain, lindstedt
        >>> universal = lindstedt(Chain(N=8, alpha="0.3"), (1,), order=6)
        >>> universal.at(("0.3905",))
        LindstedtSeries(N=8, alpha=0.3, seeds=1, order 6, 133 coefficients (float64),
        smallest divisor 0.024 at mode 2, harmonic (2), order 1)
        """
        tables = self.node_tables()
        chain = self._chain_with(alpha, beta)
        none = self.corrections[0]
        if point is not None:
            prime, root, omega = point.prime, point.root, point.frequencies
            values = tables_of_residues(tables, chain, self.seeds, prime, root, omega)
            return self._with(chain, values, none, ring=RESIDUE.name, point=point)
        chosen = frequencies_of(frequencies, self.seeds)
        if digits is not None:
            found = certified_tables(tables, chain, self.seeds, chosen, digits_of(digits))
            radii = self._radii(found.radii, none)
            numeric = {"ring": FIXED_POINT.name, "digits": digits, "bits": found.bits}
            return self._with(
                chain, found.tables, none, frequencies=chosen, radii=radii, **numeric
            )
        divisors = Float64Divisors(chain, self.seeds, chosen, self.grading.degree)
        space = monomial_space(chain, self.seeds, self.order)
        leaves = leaves_in_doubles(tables[0].program, chain, space, divisors, self.order)
        values = [table[..., 0] for table in tables_in_doubles(tables, leaves)]
        smallest = divisors.smallest()
        return self._with(
            chain,
            values,
            none,
            ring=FLOAT64.name,
            frequencies=chosen,
            smallest_divisors=smallest,
        )

    def node_tables(self) -> list[NodeTable]:
        """The tables of a program: coordinates of orders 0 .. K, corrections of 1 .. K.

        Raises InputError for series that have none.
        """
        tables = [*self.coordinates, *self.corrections[1:]]
        if not all(isinstance(table, NodeTable) for table in tables):
            allowed = "a universal series that was made by this version"
            raise InputError(
                "series", self.ring, allowed, "make it by lindstedt without frequencies"
            )
        return tables

    def _chain_with(self, alpha: Number | None, beta: Number | None) -> Chain:
        if alpha is None and beta is None:
            return self.chain
        alpha = self.chain.alpha if alpha is None else alpha
        beta = self.chain.beta if beta is None else beta
        chain = Chain(self.chain.N, alpha, beta)
        if chain.model != self.chain.model:
            allowed = f"couplings of the same model, {self.chain.model}"
            raise InputError(
                "alpha, beta", (alpha, beta), allowed, "make a series of that model"
            )
        return chain

    def _with(
        self, chain: Chain, values: list[Any], none: Any, **numeric: Any
    ) -> LindstedtSeries:
        """This series with numbers in its tables, coordinates first."""
        count = self.order + 1
        coordinates, corrections = tuple(values[:count]), (none, *values[count:])
        return replace(
            self, chain=chain, coordinates=coordinates, corrections=corrections, **numeric
        )

    def _radii(self, radii: list[Floats], none: Any) -> tuple[tuple[float, Floats], ...]:
        count = self.order + 1
        largest = [float(table.max(initial=0.0)) for table in radii[:count]]
        return tuple(zip(largest, [none, *radii[count:]], strict=True))

    def term(self, q: int, order: int, *, form: str | None = None) -> Any:
        """Q_q^(k), without mu^k, as a SymEngine expression in A_i and theta_i (Eq. qser).

        It prints as LaTeX in a notebook.

        form : of the coefficients of a universal series: "expanded", polynomials in the symbols
            L_q(nu) and Omega_q; "factored", sums of products as the recursion has them; "cse",
            the same with the parts that occur more than once named, then a `NamedParts` is
            returned. None for that of its ring.

        Coefficients of other series are numbers. `sympy.sympify` makes SymPy's expression of any.
        Raises InputError, and ExpansionTooLarge before an expansion that would not fit.

        >>> from symfpu import Chain, lindstedt
        >>> series = lindstedt(Chain(N=8, alpha=1), (1,), order=4)
        >>> parts = series.term(5, 4, form="cse")
        >>> len(parts.names), parts.names[1]
        (4, (x1, 2*L_{3}(3)*L_{2}(2)))
        """
        if form is None:
            return self._term(*self.coefficients(q, order))
        if form not in FORMS:
            raise InputError("form", form, f"one of {', '.join(FORMS)}", "leave it out")
        self.node_tables()
        column = self._mode(q) - 1
        self._order(order)
        table = self.coordinates[order]
        nodes = table.nodes[:, column]
        if form == "cse":
            names, values = named_expressions(table.program, nodes)
            return NamedParts(
                tuple(names), self._term(*self._coefficients_of(q, order, values))
            )
        values = expressions(table.program, nodes, expanded=form == "expanded")
        return self._term(*self._coefficients_of(q, order, values))

    def _term(self, exponents: Ints, values: NDArray[Any]) -> Any:
        A, theta = self._amplitude_symbols()
        terms = []
        for row, value in zip(exponents, values, strict=True):
            plus, minus = row[0::2], row[1::2]
            nu = [int(n) for n in plus - minus]
            powers = [int(n) for n in plus + minus]
            pair = se.Integer(2 if any(nu) else 1)
            scalar = pair / se.Integer(2) ** sum(powers)
            amplitude = _monomial(A, powers)
            phases = [n * angle for n, angle in zip(nu, theta, strict=True)]
            cosine = se.cos(se.Add(*phases))
            terms.append(scalar * self.tables.symbol(value) * amplitude * cosine)
        return se.Add(*terms)

    def frequency_correction(self, q: int, order: int) -> Any:
        """omega_q^(k), without mu^k, as a SymEngine expression in the amplitudes (Eq. omeser)."""
        exponents, values = self.frequency_coefficients(q, order)
        return self._amplitude_polynomial(exponents, values)

    def squared_frequency_correction(self, q: int, order: int) -> Any:
        """[omega_q^2]^(k), without mu^k, as a SymEngine expression in the amplitudes."""
        exponents, values = self.frequency_coefficients(q, order, squared=True)
        return self._amplitude_polynomial(exponents, values)

    def _amplitude_polynomial(self, exponents: Ints, values: NDArray[Any]) -> Any:
        A, _ = self._amplitude_symbols()
        terms = []
        for row, value in zip(exponents, values, strict=True):
            powers = [int(e) for e in row]
            terms.append(self.tables.symbol(value) * _monomial(A, powers))
        return se.Add(*terms)

    def _amplitude_symbols(self) -> tuple[list[Any], list[Any]]:
        amplitudes = [se.Symbol(f"A{q}") for q in self.seeds]
        phases = [se.Symbol(f"theta{q}") for q in self.seeds]
        return amplitudes, phases

    def _numeric(self) -> None:
        if self.frequencies is None:
            allowed = "a series with chosen frequencies"
            raise InputError(
                "series", "universal form", allowed, "give frequencies= to lindstedt"
            )

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
        linear = self.chain.frequencies(self.numbers)[np.array(self.seeds) - 1]
        factors = self._kappa / 2 * linear
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
        s) and values (R, N-1), one row for each canonical monomial.
        """
        self._numeric()
        degree = self.degree(order)
        nu, index = self.grading.harmonics(degree)
        with self._context():
            factor = self._sign(order) / self._kappa
            linear = self.chain.frequencies(self.numbers)
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
        Returns harmonics (H, s), one of each pair +-nu, and values (H, N-1).
        absolute : take the modulus of every monomial before they are summed (for S_1 of Eq.
        serabs2); always doubles.
        """
        self._numeric()
        shape = np.shape(amplitudes)
        if shape != (len(self.seeds),):
            allowed = f"one for each of the seeds {self.seeds}"
            raise InputError("amplitudes", shape, allowed, "pass a sequence in their order")
        nu, index = self.grading.harmonics(self.degree(order))
        by_harmonic = np.argsort(index, kind="stable")
        starts = np.searchsorted(index[by_harmonic], np.arange(len(nu)))
        doubles = absolute or self.digits is None
        with self._context():
            factor = self._sign(order) / self._kappa
            if doubles:
                table = self._doubles(amplitudes, order)[by_harmonic]
                summands = np.abs(table) if absolute else table
                sums = np.add.reduceat(summands, starts, axis=0)
                values = sums * float(factor)
            else:
                whole, exponent = self._integers(amplitudes, order)
                sums = np.add.reduceat(whole[by_harmonic], starts, axis=0)
                values = from_integers(sums, exponent) * factor
            numbers = DOUBLES if doubles else MULTIPRECISION
            values = values / self.chain.frequencies(numbers)
            oscillates = (nu != 0).any(axis=1)
            values[oscillates] *= 2
        return nu, np.abs(values) if absolute else with_digits(values, self.digits)

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

        k = 0 .. order; shapes (order + 1,) each.

        S_1 adds the moduli of all coefficients, S_2 those of the cosines after the monomials of
        one harmonic are summed.
        with_mu : sums of mu^k Q_q^(k) instead, which cannot leave the range of doubles.
        """
        column = self._mode(q) - 1
        sums = np.empty((2, self.order + 1))
        for k in range(self.order + 1):
            unit = 1.0 if with_mu else abs(self.chain.mu) ** -float(k)
            for row, absolute in enumerate((True, False)):
                _, values = self.harmonic_terms(amplitudes, k, absolute=absolute)
                moduli = np.abs(values[:, column])
                sums[row, k] = unit * float(moduli.sum())
        return sums[0], sums[1]

    def frequency_terms(
        self, squared_amplitudes: ArrayLike, order: int | None = None
    ) -> tuple[Numbers, Numbers]:
        """mu^k omega_q^(k) for k = 0 .. order (default all) at A^2, and the derivatives by A^2.

        squared_amplitudes : (s,). Returns terms (order + 1, s), order 0 being Omega_q, and
        derivatives (order + 1, s, s) with the last axis for the variable.
        """
        self._numeric()
        top = self.order if order is None else self._order(order)
        if self.digits is None:
            squares = np.asarray(squared_amplitudes, dtype=float)
            return self._frequency_doubles(squares, top)
        with self._context():
            point = list(self.numbers.array(squared_amplitudes))
            highest = self.chain.degree_step * top // 2
            powers = powers_of(point, highest, mpmath.mpf(1))
            values, gradients = [], []
            for polynomials in self._frequency_polynomials[: top + 1]:
                parts = [evaluate(p, powers) for p in polynomials]
                values.append([mpmath.mpf(value) for value, _ in parts])
                gradients.append([list(map(mpmath.mpf, gradient)) for _, gradient in parts])
            terms = np.array(values, dtype=object)
            slopes = np.array(gradients, dtype=object)
        return with_digits(terms, self.digits), with_digits(slopes, self.digits)

    @cached_property
    def _frequency_polynomials(self) -> list[list[Polynomial]]:
        """mu^k omega_q^(k) as polynomials in A^2, by order and seed, in mpf."""
        slopes = [f**2 for f in self.seed_factors]
        by_seed = []
        for i, q in enumerate(self.seeds):
            squares = [self.squared_polynomial(i, k) for k in range(self.order + 1)]
            roots = square_root(squares, self._linear(q))
            by_seed.append(
                [rescaled(p, slopes, self._sign(k)) for k, p in enumerate(roots)]
            )
        return [list(row) for row in zip(*by_seed, strict=True)]

    def _frequency_doubles(self, squares: Floats, top: int) -> tuple[Floats, Floats]:
        linear = self.chain.frequencies()[np.array(self.seeds) - 1]
        slope = self.seed_factors**2
        diagonals, tables = self._frequency_tables
        return frequency_sums(linear, slope, squares, diagonals[:top], tables[:top])

    @cached_property
    def _frequency_tables(self) -> tuple[list[Ints], list[Floats]]:
        """Exponents and coefficients of W by order from 1 on, as `frequency_sums` takes them."""
        orders = range(1, self.order + 1)
        diagonals = [self.grading.diagonal(self.chain.degree_step * k) for k in orders]
        return diagonals, [self._sign(k) * self.corrections[k] for k in orders]

    def _table(self) -> Table:
        """One row for each coefficient of the coordinates and of the frequencies, without mu^k."""
        if self.ring == RESIDUE.name:
            advice = "its `coordinates` are residues"
            raise InputError("series", "of residues", "one of numbers or symbols", advice)
        coordinates = [
            self._coordinate_part(q, k)
            for k in range(self.order + 1)
            for q in self.chain.mode_numbers
        ]
        frequencies = [
            of_frequency(k, q, *self.frequency_coefficients(q, k))
            for k in range(self.order + 1)
            for q in self.seeds
        ]
        known = attributes(
            self,
            self.chain,
            seeds=self.seeds,
            frequencies=self.frequencies,
            order=self.order,
            ring=self.ring,
            digits=self.digits,
        )
        return coefficient_table([*coordinates, *frequencies], self.seeds, known)

    def _coordinate_part(self, q: int, order: int) -> Part:
        exponents, values = self.coefficients(q, order)
        harmonics, powers = harmonics_and_powers(exponents)
        with self._context():
            found = of_amplitudes(values, harmonics, self.degree(order))
        shown = with_digits(found, self.digits)
        return Part(COORDINATE, order, q, harmonics, powers, shown)


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
    s, top = len(linear), len(tables)
    y = slope * squares
    terms = np.zeros((top + 1, s))
    jacobian = np.zeros((top + 1, s, s))
    terms[0] = linear
    for k, (e, corrections) in enumerate(zip(diagonals, tables, strict=True), 1):
        if len(e) == 0:
            continue
        table = corrections * linear**2
        square, square_slope = _polynomial(y, e, table)
        # [omega^2]^(k) = 2 Omega omega^(k) + sum of omega^(j) omega^(k-j), 0 < j < k
        earlier = terms[1:k]
        square -= np.einsum("jq,jq->q", earlier, terms[k - 1 : 0 : -1])
        products = np.einsum("jq,jqi->qi", earlier, jacobian[k - 1 : 0 : -1])
        square_slope = square_slope * slope - 2 * products
        terms[k] = square / (2 * linear)
        jacobian[k] = square_slope / (2 * linear)[:, None]
    return terms, jacobian


def require_series(series: object) -> None:
    """InputError for what is no LindstedtSeries."""
    if not isinstance(series, LindstedtSeries):
        advice = "pass what lindstedt gave; waves of a ring have travelling_torus(series)"
        raise InputError("series", type(series).__name__, "a LindstedtSeries", advice)


def _monomial(variables: list[Any], powers: list[int]) -> Any:
    """A product of powers of symbols."""
    return se.Mul(*(x**e for x, e in zip(variables, powers, strict=True)))


def _polynomial(y: Floats, exponents: Ints, table: Floats) -> tuple[Floats, Floats]:
    """Values (s,) and derivatives (s, variables) of the polynomials sum_e table[e] y^e."""
    powers = y**exponents
    square = np.prod(powers, axis=1) @ table
    slopes = []
    for j in range(len(y)):
        exponent = exponents[:, j]
        lowered = powers.copy()
        lowered[:, j] = exponent * y[j] ** np.maximum(exponent - 1, 0)
        slopes.append(np.prod(lowered, axis=1) @ table)
    return square, np.stack(slopes, axis=1)
