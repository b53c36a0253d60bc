"""A universal series at many points at once, with its derivatives.

The program is run once for all points, and once more for each derivative: of the multipliers
    d L_q(nu) / d omega_j = L_q(nu)^2 / Omega_q^2 (2 (nu.omega) nu_j - 2 omega_q delta_qj),
carried through products and sums; none is a difference.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import psutil
from numpy.typing import ArrayLike, NDArray

from symfpu.algebra.formulas import Multiplier
from symfpu.algebra.program import Program
from symfpu.algebra.program_values import tabled, tangents_in_doubles, values_in_doubles
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.results.attributes import attributes
from symfpu.results.grid import Grid, Variable
from symfpu.results.result import Gridded, Tabled
from symfpu.results.table import Column, Table
from symfpu.series.coefficient_table import (
    COORDINATE,
    Part,
    coefficient_table,
    harmonics_and_powers,
    of_amplitudes,
    of_frequency,
)
from symfpu.series.series import LindstedtSeries, require_series
from symfpu.series.substitution import sampled_leaves

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Tables = tuple[Floats, ...]


@dataclass(frozen=True)
class FrequencyChanges(Gridded):
    """The frequencies that amplitudes give, and their derivatives, at each of P points.

    Made by `SampledSeries`; dimensionless. Ours.

    omega : Omega_q + sum mu^k omega_q^(k) of every seed (Eq. omeser), (P, s). by_amplitudes :
        d omega_i / d A_j, (P, s, s). by_frequencies : d omega_i / d omega_j through the divisors,
        (P, s, s).

    >>> from symfpu import Chain, lindstedt, sample_series
    >>> series = lindstedt(Chain(N=8, beta=1), (1,), order=1)
    >>> sample_series(series, [[0.4], [0.41]]).frequencies_at([0.1])
    FrequencyChanges(2 points, omega of the first 0.39022241...)
    >>> sample_series(series, [[0.4], [0.41]]).frequencies_at([0.1]).to_frame().shape
    (2, 6)
    """

    omega: Floats
    by_amplitudes: Floats
    by_frequencies: Floats

    def __repr__(self) -> str:
        first = ", ".join(f"{w:.12g}" for w in self.omega[0])
        return f"FrequencyChanges({counted(len(self.omega), 'point')}, omega of the first {first})"

    def _grid(self) -> Grid:
        changes = "derivative of omega by"
        both = ("point", "frequency", "by")
        numbers = range(1, self.omega.shape[1] + 1)
        return Grid(
            axes={"point": range(len(self.omega)), "frequency": numbers, "by": numbers},
            variables={
                "omega": Variable(both[:2], self.omega, "frequency of a seed"),
                "by_amplitude": Variable(
                    both, self.by_amplitudes, f"{changes} an amplitude"
                ),
                "by_frequency": Variable(
                    both, self.by_frequencies, f"{changes} a frequency of the divisors"
                ),
            },
            attributes=attributes(self),
            rows=both,
        )


@public
@dataclass(frozen=True, eq=False)
class SampledSeries(Tabled):
    """A universal series at P points: tables of numbers with the point as last axis.

    Made by `sample_series`; dimensionless. Variables and factors are those of `LindstedtSeries`
    with unit 1: u_q = Omega_q Q_q in w_i = Omega_i z_i, without mu (Eqs. qser, omeser).

    series : the universal one. frequencies : (P, s). relative : the second coupling in units of
        the first, (P,); ones where there is none. values : of all nodes, (nodes, P).

    >>> from symfpu import Chain, lindstedt, sample_series
    >>> sampled = sample_series(lindstedt(Chain(N=8, alpha=1), (1,), order=2), [[0.4], [0.41]])
    >>> sampled
    SampledSeries(2 points of LindstedtSeries(N=8, alpha=1, seeds=1, order 2, ...))
    >>> tables, _ = sampled.derivatives_by_frequency(1)
    >>> tables[2].shape
    (2, 7, 2)
    >>> sampled.to_frame().point.unique().tolist()
    [0, 1]
    """

    series: LindstedtSeries
    frequencies: Floats
    relative: Floats | None
    values: Floats = field(repr=False)

    def __repr__(self) -> str:
        return (
            f"SampledSeries({counted(len(self.frequencies), 'point')} of {self.series!r})"
        )

    @property
    def coordinates(self) -> Tables:
        """u_q^(k) for k = 0 .. K; shapes (canonical monomials, N-1, P)."""
        return self._tables(self.values)[0]

    @property
    def corrections(self) -> Tables:
        """W_q^(k) for k = 1 .. K; shapes (diagonal monomials, s, P)."""
        return self._tables(self.values)[1]

    def _tables(self, values: Floats) -> tuple[Tables, Tables]:
        found = [tabled(values, table.nodes) for table in self.series.node_tables()]
        count = self.series.order + 1
        return tuple(found[:count]), tuple(found[count:])

    def derivatives_by_frequency(self, q: int) -> tuple[Tables, Tables]:
        """Derivatives of `coordinates` and of `corrections` by omega_q.

        q : a seed; InputError for other modes.
        """
        return self._tables(self._by_frequency[self._place(q)])

    def _place(self, q: int) -> int:
        if q not in self.series.seeds:
            allowed = f"a seed, one of {self.series.seeds}"
            raise InputError("q", q, allowed, "only seeds have chosen frequencies")
        return self.series.seeds.index(q)

    @property
    def _program(self) -> Program:
        return self.series.node_tables()[0].program

    @cached_property
    def _leaves(self) -> Floats:
        return np.asarray(self.values[self._program.leaves])

    @cached_property
    def _by_frequency(self) -> list[Floats]:
        """Derivatives of all nodes by the frequency of each seed."""
        chain, seeds = self.series.chain, self.series.seeds
        squares = chain.frequencies() ** 2
        found = []
        for j, omega in enumerate(self.frequencies.T):
            leaves = np.zeros_like(self._leaves)
            for number, symbol in enumerate(self._program.symbols):
                if not isinstance(symbol, Multiplier):
                    continue
                drive = self.frequencies @ np.array(symbol.harmonic)
                slope = 2 * drive * symbol.harmonic[j]
                if symbol.mode == seeds[j]:
                    slope = slope - 2 * omega
                leaves[number] = (
                    self._leaves[number] ** 2 / squares[symbol.mode - 1] * slope
                )
            found.append(tangents_in_doubles(self._program, self.values, leaves))
        return found

    def frequencies_at(self, amplitudes: ArrayLike) -> FrequencyChanges:
        """The frequencies of these amplitudes (Eq. omeser), and their derivatives.

        amplitudes : (s,), or (P, s), in the order of the seeds. Raises InputError.
        """
        chain, s = self.series.chain, len(self.series.seeds)
        A = self._amplitudes(amplitudes)
        linear = chain.frequencies()[np.array(self.series.seeds) - 1]
        kappa = abs(chain.mu) ** (1 / chain.degree_step)
        slope = (kappa * linear / 2) ** 2
        y = _Monomials(self.series, slope * A**2)
        terms = _roots(linear, y.sums(self.corrections))
        by_amplitudes = []
        for j in range(s):
            changes = y.slopes(self.corrections, j)
            moved = _root_changes(linear, terms, changes)
            by_amplitudes.append(moved.sum(axis=0) * (2 * slope[j] * A[:, j])[:, None])
        by_frequencies = []
        for values in self._by_frequency:
            _, corrections = self._tables(values)
            moved = _root_changes(linear, terms, y.sums(corrections))
            by_frequencies.append(moved.sum(axis=0))
        return FrequencyChanges(
            terms.sum(axis=0),
            np.stack(by_amplitudes, axis=2),
            np.stack(by_frequencies, axis=2),
        )

    def _amplitudes(self, amplitudes: ArrayLike) -> Floats:
        """One row for every point; InputError for other shapes."""
        given, s = DOUBLES.array(amplitudes), self.frequencies.shape[1]
        if given.shape not in ((s,), self.frequencies.shape):
            allowed = f"the shape {(s,)} or {self.frequencies.shape}"
            raise InputError(
                "amplitudes", given.shape, allowed, "pass one row for every point"
            )
        return np.broadcast_to(given, self.frequencies.shape)

    def _table(self) -> Table:
        """One row for each coefficient at each point, of coordinates and of omega^2."""
        series, points = self.series, range(len(self.frequencies))
        tables = [
            coefficient_table(self._parts(point), series.seeds, {}).columns
            for point in points
        ]
        counts = [len(table["value"]) for table in tables]
        columns: dict[str, Column] = {"point": np.repeat(points, counts)}
        for name in tables[0]:
            columns[name] = np.concatenate([table[name] for table in tables])
        known = attributes(self, series.chain, seeds=series.seeds, order=series.order)
        return Table(columns, known)

    def _parts(self, point: int) -> Iterator[Part]:
        """The coefficients at one point, as in the table of a numeric series."""
        chain, seeds, grading = self.series.chain, self.series.seeds, self.series.grading
        linear = chain.frequencies()
        own = linear[np.array(seeds) - 1]
        for k, table in enumerate(self.coordinates):
            degree = self.series.degree(k)
            rows = grading.canonical(degree)
            harmonics, powers = harmonics_and_powers(grading.exponents(degree)[rows])
            factors = np.prod(own**powers, axis=1)
            for q in chain.mode_numbers:
                values = table[:, q - 1, point] / linear[q - 1] * factors
                at = values != 0
                found = of_amplitudes(values[at], harmonics[at], degree)
                yield Part(COORDINATE, k, q, harmonics[at], powers[at], found)
        for k, table in enumerate(self.corrections, start=1):
            exponents = 2 * grading.diagonal(chain.degree_step * k)
            factors = np.prod((own / 2) ** exponents, axis=1)
            for i, q in enumerate(seeds):
                values = own[i] ** 2 * table[:, i, point] * factors
                yield of_frequency(k, q, exponents, values, squared=True)


class _Monomials:
    """Sums of tables of corrections over the monomials y^e, order by order, with mu^k's sign."""

    def __init__(self, series: LindstedtSeries, y: Floats) -> None:
        step, order = series.chain.degree_step, series.order
        self.y, self.negative = y, series.chain.mu < 0
        self.exponents = [series.grading.diagonal(step * k) for k in range(1, order + 1)]
        self.linear = series.chain.frequencies()[np.array(series.seeds) - 1]

    def sums(self, tables: Tables) -> list[Floats]:
        """Omega^2 W^(k), (P, s), for k = 1 .. K."""
        return [self._sum(k, e, table) for k, (e, table) in self._orders(tables)]

    def slopes(self, tables: Tables, j: int) -> list[Floats]:
        """Their derivatives by y_j."""
        found = []
        for k, (e, table) in self._orders(tables):
            lowered = e.copy()
            lowered[:, j] = np.maximum(e[:, j] - 1, 0)
            found.append(self._sum(k, lowered, table * e[:, j, None, None]))
        return found

    def _orders(self, tables: Tables) -> Iterator[tuple[int, tuple[Ints, Floats]]]:
        return enumerate(zip(self.exponents, tables, strict=True), start=1)

    def _sum(self, k: int, exponents: Ints, table: Floats) -> Floats:
        monomials = np.prod(self.y[:, None, :] ** exponents, axis=2)
        sign = -1.0 if self.negative and k % 2 else 1.0
        return np.asarray(sign * self.linear**2 * np.einsum("pd,dip->pi", monomials, table))


def _roots(linear: Floats, squares: list[Floats]) -> Floats:
    """The terms of omega from those of omega^2, (K + 1, P, s); order 0 is Omega."""
    terms = [np.broadcast_to(linear, squares[0].shape)] if squares else [linear[None]]
    for k, square in enumerate(squares, start=1):
        products = [terms[j] * terms[k - j] for j in range(1, k)]
        terms.append((square - sum(products)) / (2 * linear))
    return np.stack(terms)


def _root_changes(linear: Floats, terms: Floats, changes: list[Floats]) -> Floats:
    """The changes of the terms of omega by those of omega^2; (K + 1, P, s)."""
    moved = [np.zeros_like(terms[0])]
    for k, change in enumerate(changes, start=1):
        products = [2 * terms[j] * moved[k - j] for j in range(1, k)]
        moved.append((change - sum(products)) / (2 * linear))
    return np.stack(moved)


@public
def sample_series(
    series: LindstedtSeries, frequencies: ArrayLike, relative: ArrayLike | None = None
) -> SampledSeries:
    """A universal series at many points at once, in doubles.

    series : without frequencies, of order 1 or more. frequencies : omega of every seed at every
        point, (P, s), as binary doubles. relative : of both couplings, beta / alpha^2 at every
        point, a number or (P,); None for the chain's. All dimensionless.

    Multipliers are rounded from long doubles. Ours. Raises InputError; ResonantDivisor where a
    multiplier is infinite.

    >>> import numpy as np
    >>> from symfpu import Chain, lindstedt, sample_series
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), order=4)
    >>> sampled = sample_series(series, np.linspace(0.39, 0.391, 1000)[:, None])
    >>> sampled.coordinates[4].shape, sampled.frequencies_at([0.1]).by_frequencies.shape
    ((3, 7, 1000), (1000, 1, 1))
    """
    require_series(series)
    tables = series.node_tables()
    chosen = DOUBLES.array(frequencies)
    shape = ("P", len(series.seeds))
    if chosen.ndim != 2 or chosen.shape[1] != shape[1] or not len(chosen):
        advice = "pass a row for every point, a column for every seed"
        raise InputError("frequencies", chosen.shape, f"the shape {shape}", advice)
    if not (np.isfinite(chosen).all() and (chosen > 0).all()):
        raise InputError(
            "frequencies", chosen, "positive finite numbers", "leave others out"
        )
    points = len(chosen)
    _require_room(tables[0].program.size, points)
    couplings = _relative(series, relative, points)
    program, chain = tables[0].program, series.chain
    leaves = sampled_leaves(program, chain, series.seeds, chosen, couplings)
    values = values_in_doubles(program, leaves)
    return SampledSeries(series, chosen, couplings, values)


def _relative(
    series: LindstedtSeries, relative: ArrayLike | None, points: int
) -> Floats | None:
    """The second coupling of an FPU chain at every point; None stands for those of the chain."""
    chain = series.chain
    both = chain.fpu and chain.alpha and chain.beta
    if relative is None:
        return np.full(points, float(chain.relative_couplings(3)[3])) if both else None
    if not both:
        allowed = "None: the chain has one coupling"
        raise InputError("relative", relative, allowed, "leave it out")
    return np.array(np.broadcast_to(DOUBLES.array(relative), (points,)))


def _require_room(nodes: int, points: int) -> None:
    needed, free = 3 * 8 * nodes * points, psutil.virtual_memory().available
    if needed > free:
        most = free // (3 * 8 * nodes)
        allowed = (
            f"at most {most} (of {nodes} nodes each, in {free:.3g} bytes of free memory)"
        )
        raise InputError("frequencies", f"{points} points", allowed, "take them in parts")
