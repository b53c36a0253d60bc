"""A universal series of any size as tables of operations, for files and a short loop in them.

The coefficients of the series are nodes of its program. At given frequencies the loop computes
all nodes, one after the other; the coefficients picked from them make the tables of a series
with chosen frequencies (symfpu.codegen.series_tables), which are summed in the same way.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import mpmath
import numpy as np

from symfpu.algebra.formulas import Coupling, Multiplier, NodeTable
from symfpu.algebra.grading import Ints
from symfpu.algebra.program import ONE, Program, Terms, ranges
from symfpu.algebra.program_values import ancestors
from symfpu.chain.chain import Chain
from symfpu.codegen.series_tables import SeriesTables, row_blocks
from symfpu.codegen.torus_program import DOUBLE_DIGITS, EXTRA_DIGITS
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers
from symfpu.series.series import LindstedtSeries

LARGEST_FILE = 50_000_000  # bytes of tables as text: minutes of compiling

NODE_OF_ZERO = 0
NODE_OF_ONE = 1
FIRST_LEAF = 2


@dataclass(frozen=True, eq=False)
class Operations:
    """The operations that make the coefficients of a universal series out of its frequencies.

    Node 0 is the number zero and node 1 the number one. After them come the multipliers L_q(nu),
    the couplings if there are any, and the sums; a sum is factor left right added over its terms,
    which are those of earlier nodes.

    modes, harmonics : of the multipliers, (L,), (L, s). couplings : of powers of the stretch,
    where they are not one in units of mu, (C,).
    starts : sum i has the terms starts[i] to starts[i+1], (S+1,).
    left, right, factor : of the terms, (T,). levels : sums levels[v] to levels[v+1] need sums of
    earlier levels only, (V+1,). signs, frequency_signs : of mu^k for every row of powers and of
    powers of the frequencies. order_starts : order k of the frequencies has the rows
    order_starts[k-1] to order_starts[k], (K+1,); one order without a row where there is none.
    linear : Omega_q of every mode, (N-1,).
    weights : 1 / (kappa Omega_q), which take scaled coordinates to Q_q, (N-1,). kappa : the
    factor |mu|^(1/step) of amplitudes as an expression of mpmath.
    """

    modes: Ints
    harmonics: Ints = field(repr=False)
    couplings: tuple[Fraction, ...]
    starts: Ints = field(repr=False)
    left: Ints = field(repr=False)
    right: Ints = field(repr=False)
    factor: Ints = field(repr=False)
    levels: Ints = field(repr=False)
    signs: Ints = field(repr=False)
    frequency_signs: Ints = field(repr=False)
    order_starts: Ints
    linear: Numbers = field(repr=False)
    weights: Numbers = field(repr=False)
    kappa: str

    @property
    def first_sum(self) -> int:
        """The node of the first sum."""
        return FIRST_LEAF + len(self.modes) + len(self.couplings)

    @property
    def nodes(self) -> int:
        """Nodes, those of zero and one included."""
        return self.first_sum + len(self.starts) - 1


def operation_tables(
    series: LindstedtSeries, order: int, frequency_order: int
) -> tuple[SeriesTables, Operations]:
    """The tables of a universal series, whose coefficients are numbers of nodes, and its nodes.

    Raises InputError for a series without a program, and where the tables take more than
    LARGEST_FILE.
    """
    tables = series.node_tables()
    count = series.order + 1
    coordinates = tables[: order + 1]
    corrections = tables[count : count + frequency_order]
    wanted = np.concatenate([table.nodes.ravel() for table in (*coordinates, *corrections)])
    program, s = tables[0].program, len(series.seeds)
    numbering = _Numbering(program, wanted)
    orders, nu, e, values = _coordinate_rows(series, coordinates, numbering)
    powers, first, which = np.unique(e, axis=0, return_index=True, return_inverse=True)
    blocks = row_blocks(series, nu, which.reshape(-1), values)
    frequency_orders, frequency_powers, frequency_nodes = _frequency_rows(
        series, corrections, numbering
    )
    modes, harmonics = numbering.multipliers(s)
    starts, terms, levels = numbering.sums()
    linear, scales, weights = _constants(series)
    seeds = np.array(series.seeds) - 1
    operations = Operations(
        modes=modes,
        harmonics=harmonics,
        couplings=numbering.couplings,
        starts=starts,
        left=terms.left,
        right=terms.right,
        factor=terms.factor,
        levels=levels,
        signs=_signs(series.chain, orders[first]),
        frequency_signs=_signs(series.chain, frequency_orders),
        order_starts=np.searchsorted(
            frequency_orders, np.arange(1, max(1, frequency_order) + 2)
        ),
        linear=linear,
        weights=weights,
        kappa=_kappa_expression(series.chain),
    )
    placed = SeriesTables(
        scales, powers, blocks, linear[seeds], frequency_powers, frequency_nodes
    )
    _refuse_large(written_bytes(placed, operations))
    return placed, operations


class _Numbering:
    """Numbers of the nodes that are needed: constants, leaves, then sums level by level."""

    def __init__(self, program: Program, wanted: Ints) -> None:
        self.program = program
        needed = ancestors(program, wanted)
        counts = np.diff(program.start)[needed]
        sums = needed[counts > 0]
        of_level = _levels(program, needed)[sums]
        by_level = np.argsort(of_level, kind="stable")
        self.chosen = sums[by_level]
        self._sizes = np.bincount(of_level[by_level], minlength=2)[1:]
        leaves = needed[(counts == 0) & (needed != ONE)].tolist()
        symbols = {leaf: program.symbols[program.leaf_number(leaf)] for leaf in leaves}
        self._multipliers = {i: x for i, x in symbols.items() if isinstance(x, Multiplier)}
        couplings = {i: x for i, x in symbols.items() if isinstance(x, Coupling)}
        self.couplings = tuple(x.value for x in couplings.values())
        self._numbers = np.full(program.size + 1, NODE_OF_ZERO)  # the last for ZERO = -1
        self._numbers[ONE] = NODE_OF_ONE
        first = FIRST_LEAF
        nodes = [*self._multipliers]
        self._padded = not nodes  # files have no empty tables
        self._numbers[nodes] = first + np.arange(len(nodes))
        first += max(1, len(nodes))
        self._numbers[[*couplings]] = first + np.arange(len(couplings))
        first += len(couplings)
        self._numbers[self.chosen] = first + np.arange(len(self.chosen))

    def __call__(self, nodes: Ints) -> Ints:
        """Numbers in the file; ZERO becomes NODE_OF_ZERO."""
        return np.asarray(self._numbers[nodes])

    def multipliers(self, s: int) -> tuple[Ints, Ints]:
        """Modes (L,) and harmonics (L, s); one that nobody needs where there is none."""
        if self._padded:
            return np.ones(1, dtype=np.int64), np.zeros((1, s), dtype=np.int64)
        modes, harmonics = zip(*self._multipliers.values(), strict=True)
        return np.array(modes), np.array(harmonics)

    def sums(self) -> tuple[Ints, Terms, Ints]:
        """Starts (S+1,), terms in these numbers, levels (V+1,); one zero where there is none."""
        if not len(self.chosen):
            nothing = np.array([NODE_OF_ZERO])
            return (
                np.array([0, 1]),
                Terms(nothing, nothing, np.array([1])),
                np.array([0, 1]),
            )
        found = self.program.terms.at(ranges(self.program.start, self.chosen))
        counts = np.diff(self.program.start)[self.chosen]
        starts = np.concatenate([[0], np.cumsum(counts)])
        terms = Terms(self(found.left), self(found.right), found.factor)
        return starts, terms, np.concatenate([[0], np.cumsum(self._sizes)])


def _levels(program: Program, needed: Ints) -> Ints:
    """Of every needed node one more than of the highest of its parts, 0 for leaves; (nodes,)."""
    levels = np.zeros(program.size, dtype=np.int64)
    start, terms = program.start, program.terms
    for node in needed.tolist():
        own = slice(start[node], start[node + 1])
        left, right = terms.left[own], terms.right[own]
        if len(left):
            levels[node] = 1 + max(levels[left].max(), levels[right].max())
    return levels


def _coordinate_rows(
    series: LindstedtSeries, tables: Sequence[NodeTable], numbering: _Numbering
) -> tuple[Ints, Ints, Ints, Ints]:
    """Order (R,), harmonic (R, s), powers (R, s) and nodes (R, N-1) of all monomials."""
    rows = []
    for k, table in enumerate(tables):
        degree = series.degree(k)
        nu, index = series.grading.harmonics(degree)
        orders = np.full(len(index), k)
        rows.append(
            (orders, nu[index], series.grading.powers(degree), numbering(table.nodes))
        )
    orders, harmonics, powers, nodes = map(np.concatenate, zip(*rows, strict=True))
    return orders, harmonics, powers, nodes


def _frequency_rows(
    series: LindstedtSeries, tables: Sequence[NodeTable], numbering: _Numbering
) -> tuple[Ints, Ints, Ints]:
    """Order (F,), powers of x^2 (F, s) and nodes (F, s) of the squared frequencies."""
    s, step = len(series.seeds), series.chain.degree_step
    empty = np.zeros((0, s), dtype=np.int64)
    rows = [(empty[:, 0], empty, empty)]
    for k, table in enumerate(tables, 1):
        diagonal = series.grading.diagonal(step * k).reshape(-1, s)
        orders = np.full(len(diagonal), k)
        rows.append((orders, diagonal, numbering(table.nodes).reshape(-1, s)))
    orders, powers, nodes = map(np.concatenate, zip(*rows, strict=True))
    return orders, powers, nodes


def _signs(chain: Chain, orders: Ints) -> Ints:
    """Of mu^k."""
    return np.where(orders % 2 == 1, -1 if chain.mu < 0 else 1, 1)


def _constants(series: LindstedtSeries) -> tuple[Numbers, Numbers, Numbers]:
    """Omega_q (N-1,), scales kappa Omega_i / 2 (s,), and 1 / (kappa Omega_q) (N-1,)."""
    chain = series.chain
    with MULTIPRECISION.context(DOUBLE_DIGITS + EXTRA_DIGITS):
        size = abs(chain.small_parameter(MULTIPRECISION))
        kappa = size ** (mpmath.mpf(1) / chain.degree_step)
        linear = chain.frequencies(MULTIPRECISION)
        seeds = linear[np.array(series.seeds) - 1]
        return linear, seeds * kappa / 2, 1 / (kappa * linear)


def _kappa_expression(chain: Chain) -> str:
    """kappa = |mu|^(1/step) for mpmath."""
    twice = 2 * chain.N
    if chain.degree_step == 1:
        coupling = abs(chain.unit_coupling)
        return f"mp.mpf({coupling.numerator}) / {coupling.denominator} / mp.sqrt({twice})"
    coupling = abs(chain.unit_coupling) / twice
    return f"mp.sqrt(mp.mpf({coupling.numerator}) / {coupling.denominator})"


def written_bytes(tables: SeriesTables, operations: Operations) -> int:
    """Bytes of all tables as decimal text with a separator behind each number."""
    arrays = list(_arrays(tables, operations))
    return sum(_text_bytes(array) for array in arrays)


def _arrays(tables: SeriesTables, operations: Operations) -> list[Ints]:
    """All integers of a file."""
    found = [
        operations.modes,
        operations.harmonics,
        operations.starts,
        operations.left,
        operations.right,
        operations.factor,
        tables.powers,
        tables.frequency_powers,
        tables.frequency_coefficients,
    ]
    for block in tables.blocks:
        found += [block.harmonics, block.starts, block.powers, block.coefficients]
    return found


def _text_bytes(array: Ints) -> int:
    """Digits, minus signs, and a separator behind each number."""
    values = np.abs(array.ravel())
    total = 2 * values.size + int(np.count_nonzero(array < 0))
    power = 10
    while (values >= power).any():
        total += int(np.count_nonzero(values >= power))
        power *= 10
    return total


def _refuse_large(size: int) -> None:
    if size > LARGEST_FILE:
        raise InputError(
            "series",
            f"{size / 1e6:.0f} MB of operations",
            f"at most {LARGEST_FILE / 1e6:.0f} MB in a file",
            "lower the orders, or give lindstedt frequencies: numbers take less room",
        )


def described(tables: SeriesTables, operations: Operations) -> str:
    """The size of a program, for the header of its file."""
    nodes, terms = operations.nodes, len(operations.left)
    size = written_bytes(tables, operations)
    return f"{nodes:,} nodes, {terms:,} terms, {size:,} bytes of tables"


def operations_digest(tables: SeriesTables, operations: Operations) -> str:
    """SHA-256 of all integers of a file, and of the couplings."""
    couplings = operations.couplings
    single = couplings[0] if len(couplings) == 1 else None
    digest = hashlib.sha256(repr(couplings if len(couplings) > 1 else single).encode())
    for array in _arrays(tables, operations):
        digest.update(repr(array.shape).encode())
        digest.update(array.astype("<i8").tobytes())
    return digest.hexdigest()
