"""The universal series of chains of every length at once.

Why one graph serves every N. Seeds are modes q (low) or N - b (high); q and b are their labels.
A term of degree d is made of cosines whose wave numbers are signed sums of d seeds, w N + m:
w counts the high seeds with their signs, m adds the labels with theirs. On the points of the
bonds T_N = 0 and T_(2N-q) = -T_q, hence
    T_(wN+m) = +-T_|m| for even w,     T_(wN+m) = +-T_(N-|m|) or 0 for odd w,
and as long as |m| < N the sign depends on w and on the sign of m alone. So a cosine is its label
|m| and the parity of w, which the monomial fixes; a product of cosines adds and subtracts labels
by rules without N.

Let `low` be the largest label of a mode m that signed sums of the seeds reach in a degree of the
series, `high` that of a mode N - m. From N = low + high + 1 on
  - all labels are below N, so that the rules above hold for every product;
  - a mode m <= low is no mode N - m', m' <= high: no two of the symbols L_q(nu) become one, and
    no mode counted from one end is a seed counted from the other.
Then the recursion does the same step by step, and a sum of products cancels for one N if it does
for all: N is in the symbols alone. For low seeds the bound says degree times largest seed < N.
It is sharp there: at equality the highest wave number is N, which is no mode. Ours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, NoReturn

import numpy as np

from symfpu.algebra.formulas import Multiplier, NodeTable
from symfpu.algebra.program import Ints, Program
from symfpu.chain.chain import Chain
from symfpu.chain.length import HighMode, mode_label, mode_of, seed_labels
from symfpu.chain.symbols import amplitude_symbol, linear_symbol, phase_symbol
from symfpu.errors import InputError
from symfpu.files.progress import Progress
from symfpu.numbers.typed import length_of, order_of
from symfpu.series.memory import check_size
from symfpu.series.monomials import monomial_space
from symfpu.series.recursion import named_series
from symfpu.series.rings import RINGS
from symfpu.series.series import LindstedtSeries

ADVICE = "put a number for N: chain.at(N=32), or series.at_length(N=32)"


@dataclass(frozen=True, eq=False, repr=False)
class SeriesForAllN(LindstedtSeries):
    """A universal series whose N is a symbol, as `lindstedt(Chain("N", ...), ...)` gives it.

    It is a LindstedtSeries, with modes named q from the start of the spectrum, or "N-1", "N-2",
    ... from its end. seeds : labels, int or N-b. valid_from : the N from which on the series of
    every chain is this one, term by term (the proof stands in symfpu/series/all_lengths.py).
    low, high : modes 1 .. low and N-high .. N-1 are the columns of `coordinates`, in this order;
    no other mode is excited up to this order.

    Ours, dimensionless. Whatever asks for a number of the chain raises InputError.

    >>> from symfpu.series.lindstedt import lindstedt
    >>> series = lindstedt(Chain("N", alpha=1), (1, "N-1"), order=2)
    >>> series
    LindstedtSeries(N='N', alpha=1, seeds=1,N-1, order 2, 108 coefficients (symbolic), for N >= 7)
    >>> series.modes
    (1, 2, 3, N-3, N-2, N-1)
    >>> sorted(map(str, series.term("N-2", 1).free_symbols))[2:5]
    ['L_{N-2}(1,-1)', 'L_{N-2}(1,1)', 'Omega_1']
    """

    low: int = 0
    high: int = 0
    valid_from: int = 2

    def __repr__(self) -> str:
        return f"{super().__repr__().removesuffix(')')}, for N >= {self.valid_from})"

    @property
    def modes(self) -> tuple[int, ...]:
        """The modes of the columns of `coordinates`."""
        ends = [HighMode(-m) for m in range(self.high, 0, -1)]
        return (*range(1, self.low + 1), *ends)

    def at_length(self, N: int) -> LindstedtSeries:
        """The series of a chain of N bonds, without running the recursion again.

        N : from valid_from up; InputError below.

        >>> from symfpu.series.lindstedt import lindstedt
        >>> series = lindstedt(Chain("N", alpha=1), (1,), order=2)
        >>> series.at_length(N=32)
        LindstedtSeries(N=32, alpha=1, seeds=1, order 2, 155 coefficients (symbolic))
        """
        if length_of(N) < self.valid_from:
            allowed = f"from {self.valid_from} up"
            advice = "lower the order, or run lindstedt on the chain itself"
            raise InputError("N", N, allowed, advice)
        program = _renamed(
            self.coordinates[0].program, {q: mode_of(q, N) for q in self.modes}
        )
        columns = np.array([mode_of(q, N) - 1 for q in self.modes])
        coordinates = []
        for table in self.coordinates:
            nodes = np.full((len(table), N - 1), -1, dtype=np.int64)
            nodes[:, columns] = table.nodes
            coordinates.append(_table(program, nodes, self.ring))
        return LindstedtSeries(
            **_shared(self),
            chain=self.chain.at(N=N),
            seeds=tuple(mode_of(q, N) for q in self.seeds),
            coordinates=tuple(coordinates),
            corrections=_corrections(self.corrections, program, self.ring),
        )

    def _place(self, q: Any, order: int) -> tuple[int, None]:
        return self._mode(q) - 1, None

    def _mode(self, q: Any) -> int:
        """The column of a mode, counted from one."""
        label = mode_label(q, "q")
        if label not in self.modes:
            ends = f"1..{self.low}" if self.low else ""
            if self.high:
                ends = f"{ends}{' or ' if ends else ''}'N-{self.high}'..'N-1'"
            advice = "terms of other modes are zero to this order"
            raise InputError("q", q, f"one of {ends}", advice)
        return self.modes.index(label) + 1

    def _seed(self, q: Any) -> int:
        return super()._seed(mode_label(q, "q"))

    def _linear(self, q: Any) -> Any:
        return linear_symbol(mode_label(q, "q"))

    def _amplitude_symbols(self) -> tuple[list[Any], list[Any]]:
        return list(map(amplitude_symbol, self.seeds)), list(map(phase_symbol, self.seeds))

    def _numeric(self) -> NoReturn:
        raise InputError("N", "N", "a number where something is computed with it", ADVICE)


def series_for_all_lengths(
    chain: Chain,
    seeds: Sequence[int | str],
    order: int,
    ring: str,
    progress: Progress | None,
) -> SeriesForAllN:
    """The universal series of a chain whose N is a symbol, from its shortest representative.

    Raises InputError for seeds that are no labels or are repeated, for an order out of range, and
    for rings of numbers.
    """
    order = order_of(order)
    labels = in_order(seed_labels(seeds))
    ends = ends_reached(chain, labels, order)
    N, low = ends.valid_from, ends.low
    representative, modes = chain.at(N=N), tuple(mode_of(q, N) for q in labels)
    check_size(representative, modes, order, ring)
    space = monomial_space(representative, modes, order)
    series = named_series(RINGS[ring], representative, space, None, order, progress)
    names = {q: q if q <= low else HighMode(q - N) for q in range(1, N)}
    program = _renamed(series.coordinates[0].program, names)
    return SeriesForAllN(
        **_shared(series),
        chain=chain,
        seeds=labels,
        coordinates=tuple(_table(program, t.nodes, ring) for t in series.coordinates),
        corrections=_corrections(series.corrections, program, ring),
        **ends._asdict(),
    )


class Ends(NamedTuple):
    """Modes 1 .. low and N-high .. N-1, which a series excites from N = valid_from on."""

    low: int
    high: int
    valid_from: int


def in_order(labels: Sequence[int]) -> tuple[int, ...]:
    """Labels as their modes ascend.

    >>> in_order((HighMode(-1), 2, HighMode(-3), 1))
    (1, 2, N-3, N-1)
    """
    return tuple(sorted(labels, key=lambda q: (q < 0, q)))


def ends_reached(chain: Chain, labels: Sequence[int], order: int) -> Ends:
    """The modes that the series of these seeds excites up to an order, for every large N."""
    low, high = reach(chain.degree_step, labels, order)
    return Ends(low, high, low + high + 1)


def reach(degree_step: int, labels: Sequence[int], order: int) -> tuple[int, int]:
    """The largest m such that signed sums of the seeds reach the mode m, or the mode N - m.

    degree_step : of the orders; labels : of the seeds, negative for N - b. 0 where none is
    reached.

    >>> reach(1, (1, 3), 2), reach(2, (HighMode(-2),), 1)
    ((9, 0), (0, 6))
    """
    largest = [max((q for q in labels if q > 0), default=0)]
    largest.append(max((-q for q in labels if q < 0), default=0))
    reached = [0, 0]
    # one more seed adds its label: the last degrees reach farthest, by one kind of seeds but one
    last = 1 + degree_step * order
    for degree in {max(1, last - degree_step), last}:
        for high in {0, 1, degree - 1, degree}:
            counts = degree - high, high
            if all(q or not count for q, count in zip(largest, counts, strict=True)):
                m = sum(q * count for q, count in zip(largest, counts, strict=True))
                reached[high % 2] = max(reached[high % 2], m)
    low, high = reached
    return low, high


def _renamed(program: Program, names: dict[int, int]) -> Program:
    """The same nodes with other names of the modes."""
    symbols = []
    for symbol in program.symbols:
        if isinstance(symbol, Multiplier):
            symbol = Multiplier(names[symbol.mode], symbol.harmonic)
        symbols.append(symbol)
    return Program.of_arrays(symbols, program.start, program.terms)


def _table(program: Program, nodes: Ints, ring: str) -> NodeTable:
    return NodeTable(program, nodes, expanded=ring == "symbolic")


def _corrections(tables: Sequence[Any], program: Program, ring: str) -> tuple[Any, ...]:
    """The tables of corrections; the one of order 0 has no rows."""
    first, *others = tables
    return (first, *(_table(program, table.nodes, ring) for table in others))


def _shared(series: LindstedtSeries) -> dict[str, Any]:
    """What does not depend on N."""
    apart = {"chain", "seeds", "coordinates", "corrections"}
    names = {f.name for f in fields(LindstedtSeries)} - apart
    return {name: getattr(series, name) for name in names}
