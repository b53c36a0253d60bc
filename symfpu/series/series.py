"""A Poincare-Lindstedt series: what is asked of it, as numbers and as SymEngine expressions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.algebra.formulas import NodeTable, expressions, named_expressions
from symfpu.algebra.grading import Ints
from symfpu.chain.chain import Chain, require_fixed_ends
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import (
    with_digits,
)
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number
from symfpu.results.attributes import attributes
from symfpu.results.field import (
    Field,
    chain_fields,
    exact_by_seed,
    listed,
    seeds_field,
    shown_frequency,
)
from symfpu.results.result import Tabled
from symfpu.results.table import Table
from symfpu.series.arguments import digits_of, frequencies_of
from symfpu.series.coefficient_table import (
    COORDINATE,
    Part,
    coefficient_table,
    harmonics_and_powers,
    of_amplitudes,
    of_frequency,
)
from symfpu.series.divisors import Float64Divisors
from symfpu.series.monomials import monomial_space
from symfpu.series.named_parts import NamedParts
from symfpu.series.rings import FIXED_POINT, FLOAT64, RESIDUE
from symfpu.series.substitution import (
    certified_tables,
    leaves_in_doubles,
    tables_in_doubles,
)
from symfpu.series.sums import SeriesSums

Floats = NDArray[np.float64]


FORMS = ("expanded", "factored", "cse")
RING_TERMS = "the waves of a ring have coefficients(q, order) and to_frame()"


@public
@dataclass(frozen=True, eq=False)
class LindstedtSeries(SeriesSums, Tabled):
    """The series Q_q = sum mu^k Q_q^(k) and omega_q = Omega_q + sum mu^k omega_q^(k).

    The amplitudes are free.

    Made by `lindstedt` (Eqs. qser, omeser); all quantities dimensionless, phases in radians. The
    tables are in the ring's variables w_i = Omega_i z_i, z_i = (A_i/2) exp(i theta_i), and in
    u_q = Omega_q Q_q, [omega_q^2]^(k) = Omega_q^2 W_q^(k), without mu; degree d carries the
    factor unit^-(d-1).

    On a ring of N (ours) every seed q is a travelling wave,

        x_j = N^(-1/2) A_q sin(2 pi |q| j / N - sgn(q) theta_q),  theta_q = omega_q t + phi_q,

    which runs to higher j for q > 0. A harmonic nu of the angles lives in one mode, that of nu.q
    modulo N. So the tables have one column, the real u of
    r_j = N^(-1/2) sum u cos(nu.(2 pi q (j + 1/2)/N - theta)).

    chain, seeds, order : as given. frequencies : omega of every seed, exact, shape (s,); None in
        universal form.
    ring : 'float64', 'fixedpoint', 'residue', 'symbolic' or 'nested'. grading : which monomials
        stand in which row.
    coordinates : for each order 0 .. order, u_q^(k); shape (canonical monomials, C), C = N-1 modes,
        or 1 on a ring.
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
    >>> lindstedt(Chain(N=8, alpha="0.3", ends="periodic"), (1,), ("0.766",), 6)
    LindstedtSeries(N=8, alpha=0.3, ends='periodic', seeds=1, order 6, 19 coefficients (float64),
    smallest divisor 0.35 at mode 2, harmonic (2), order 1)
    """

    def _require_whole(self) -> None:
        """What reads its tables cuts them to the shapes that they must have."""
        repr(self)

    def _answer(self) -> str:
        return f"order {self.order}, {counted(self.coefficient_count, 'coefficient')}"

    def _fields(self) -> Iterator[Field]:
        yield from chain_fields(self.chain)
        yield seeds_field(self.seeds)
        if self.frequencies is None:
            yield Field("frequencies")
        else:
            shown = listed(map(shown_frequency, self.frequencies))
            yield Field("frequencies", exact_by_seed(self.omega), "frequencies", shown)
        yield Field("order", self.order)
        yield Field("digits", self.digits)
        yield Field("", label="ring", shown=self.precision)
        divisors = self.smallest_divisors
        yield Field("smallest_divisors", [divisor.entry() for divisor in divisors])
        for smallest in divisors[:1]:
            yield Field("", label="smallest divisor", shown=repr(smallest))

    def __repr__(self) -> str:
        chain = self.chain.label
        smallest = (
            f", smallest divisor {self.smallest_divisors[0]}"
            if self.smallest_divisors
            else ""
        )
        return (
            f"LindstedtSeries({chain}, seeds={','.join(map(str, self.seeds))}, order {self.order}, "
            f"{counted(self.coefficient_count, 'coefficient')} ({self.precision}){smallest})"
        )

    def at(
        self,
        frequencies: Sequence[Number],
        *,
        alpha: Number | None = None,
        beta: Number | None = None,
        digits: int | None = None,
    ) -> LindstedtSeries:
        """The numeric series at chosen frequencies, by the program of a universal series.

        frequencies : omega of every seed, shape (s,), in the order of `seeds`, exact as in
            `lindstedt`. alpha, beta : couplings other than the chain's, not zero where the
            chain's are not. digits : to so many digits of the largest coefficient of an order,
            proved by balls; None for doubles.

        Ours. For many points at once see `sample_series`. Raises InputError, ResonantDivisor for
        frequencies that make a multiplier infinite.

        >>> from symfpu import Chain, lindstedt
        >>> universal = lindstedt(Chain(N=8, alpha="0.3"), (1,), order=6)
        >>> universal.at(("0.3905",))
        LindstedtSeries(N=8, alpha=0.3, seeds=1, order 6, 133 coefficients (float64),
        smallest divisor 0.024 at mode 2, harmonic (2), order 1)
        """
        tables = self.node_tables()
        chain = self._chain_with(alpha, beta)
        none = self.corrections[0]
        chosen = frequencies_of(frequencies, self.seeds)
        if digits is not None:
            found = certified_tables(tables, chain, self.seeds, chosen, digits_of(digits))
            radii = self._radii(found.radii, none)
            numeric = {"ring": FIXED_POINT.name, "digits": digits, "bits": found.bits}
            return self._with(
                chain, found.tables, none, frequencies=chosen, radii=radii, **numeric
            )
        space = monomial_space(chain, self.seeds, self.order)
        divisors = Float64Divisors(chain, space, chosen)
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
        require_fixed_ends(self.chain, RING_TERMS)
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


def require_series(series: object) -> None:
    """InputError for what is no LindstedtSeries of a chain with fixed ends.

    What takes that of a ring too asks `require_any_series`.
    """
    chain = require_any_series(series).chain
    if chain.periodic:
        allowed = "the series of a chain with fixed ends: this is not known on a ring"
        advice = "waves of a ring have solve_amplitudes(series)"
        raise InputError("series", f"of {chain!r}", allowed, advice)


def require_any_series(series: object) -> LindstedtSeries:
    """InputError for what is no LindstedtSeries, whatever the ends of its chain."""
    if not isinstance(series, LindstedtSeries):
        advice = "pass what lindstedt gave"
        raise InputError("series", type(series).__name__, "a LindstedtSeries", advice)
    return series


def _monomial(variables: list[Any], powers: list[int]) -> Any:
    """A product of powers of symbols."""
    return se.Mul(*(x**e for x, e in zip(variables, powers, strict=True)))
