"""Nodes of a program as SymEngine expressions: as the recursion has them, or expanded."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
import symengine as se
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.typing import NDArray

from symfpu.algebra.expansion import Expansion
from symfpu.algebra.program import ZERO, Ints, Program
from symfpu.algebra.program_values import ancestors, terms_of, values_in

Objects = NDArray[np.object_]


class Multiplier(NamedTuple):
    """The symbol L_q(nu)."""

    mode: int
    harmonic: tuple[int, ...]


class Coupling(NamedTuple):
    """The coupling of the force r^power, relative to that of the lowest power."""

    power: int
    value: Fraction


def multiplier_symbol(mode: int, harmonic: Sequence[int]) -> Any:
    """The symbol L_q(nu); its name reads as LaTeX."""
    nu = ",".join(map(str, harmonic))
    return se.Symbol(f"L_{{{mode}}}({nu})")


def expression_of_leaf(symbol: Hashable) -> Any:
    """What a leaf stands for: a multiplier, a coupling's value, or any other symbol by name."""
    if isinstance(symbol, Multiplier):
        return multiplier_symbol(*symbol)
    if isinstance(symbol, Coupling):
        return se.Integer(symbol.value.numerator) / se.Integer(symbol.value.denominator)
    return se.Symbol(str(symbol))


class NodeTable(NDArrayOperatorsMixin):
    """A table of nodes of one program, which are expressions when they are looked at.

    nodes : (rows, columns). expanded : whether expressions are expanded; else they are sums of
    products as the recursion makes them.

    A table is read as an array of SymEngine expressions: `table[i, j]`, `np.asarray(table)`; what
    NumPy does with it, it does with that array.
    """

    def __init__(self, program: Program, nodes: Ints, *, expanded: bool) -> None:
        self.program, self.nodes, self.expanded = program, nodes, expanded

    @property
    def shape(self) -> tuple[int, ...]:
        """Rows and columns."""
        return self.nodes.shape

    @property
    def size(self) -> int:
        """Entries."""
        return self.nodes.size

    @property
    def nonzero(self) -> NDArray[np.bool_]:
        """Which entries are not zero."""
        return np.asarray(self.nodes != ZERO)

    def __len__(self) -> int:
        return len(self.nodes)

    def __getitem__(self, places: Any) -> Any:
        found = expressions(
            self.program, np.asarray(self.nodes[places]), expanded=self.expanded
        )
        return found[()]

    def rows(self, places: Sequence[int]) -> NodeTable:
        """A table of some of the rows."""
        return NodeTable(self.program, self.nodes[list(places)], expanded=self.expanded)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        arrays = [np.asarray(x) if isinstance(x, NodeTable) else x for x in inputs]
        return getattr(ufunc, method)(*arrays, **options)

    def values(
        self, multiplier: Callable[[Multiplier], Any], coupling: Callable[[Fraction], Any]
    ) -> Objects:
        """The nodes in any arithmetic that adds and multiplies, by integers too.

        multiplier, coupling : what stands for a symbol; asked for those that are needed alone.
        """
        program = self.program
        needed = set(ancestors(program, self.nodes.ravel()).tolist())
        leaves: list[Any] = []
        for leaf, symbol in zip(program.leaves, program.symbols, strict=True):
            if leaf not in needed:
                leaves.append(None)
            elif isinstance(symbol, Multiplier):
                leaves.append(multiplier(symbol))
            else:
                assert isinstance(symbol, Coupling)
                leaves.append(coupling(symbol.value))
        return values_in(program, leaves, self.nodes)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Objects:
        return expressions(self.program, self.nodes, expanded=self.expanded)


def expressions(program: Program, nodes: Ints, *, expanded: bool) -> Objects:
    """Expressions of nodes, in the same shape.

    Raises ExpansionTooLarge before allocating what would not fit.
    """
    wanted = np.unique(nodes[nodes != ZERO])
    made = _expanded(program, wanted) if expanded else _nested(program, wanted)
    return _gathered(nodes, made)


def _gathered(nodes: Ints, made: Mapping[int, Any]) -> Objects:
    found = np.full(nodes.size, se.Integer(0), dtype=object)
    for place, node in enumerate(nodes.ravel().tolist()):
        if node != ZERO:
            found[place] = made[node]
    return found.reshape(nodes.shape)


def named_expressions(
    program: Program, nodes: Ints
) -> tuple[list[tuple[Any, Any]], Objects]:
    """Names x0, x1, ... of the sums that occur more than once, and the nodes in these names.

    Returns (name, expression) in the order of their use, each after its parts; and expressions in
    the shape of nodes.
    """
    wanted = np.unique(nodes[nodes != ZERO])
    needed = ancestors(program, wanted).tolist()
    uses = dict.fromkeys(needed, 0)
    for node in needed:
        for left, right, _ in terms_of(program, node):
            for part in (left, right):
                uses[part] = uses.get(part, 0) + 1
    made: dict[int, Any] = {0: se.Integer(1)}
    names: list[tuple[Any, Any]] = []
    for node in needed:
        if node in made:
            continue
        terms = [f * made[a] * made[b] for a, b, f in terms_of(program, node)]
        made[node] = se.Add(*terms) if terms else _of_leaf(program, node)
        if uses[node] > 1 and made[node].args and _operations(made[node]) > 1:
            name = se.Symbol(f"x{len(names)}")
            names.append((name, made[node]))
            made[node] = name
    return names, _gathered(nodes, made)


def _operations(expression: Any) -> int:
    """Products and sums of parts that are no numbers, at the top and one level below."""
    count = 0
    for part in expression.args:
        count += not part.is_Number
        count += sum(not piece.is_Number for piece in part.args[1:])
    return count


def _nested(program: Program, wanted: Ints) -> dict[int, Any]:
    made: dict[int, Any] = {0: se.Integer(1)}
    for node in ancestors(program, wanted).tolist():
        if node in made:
            continue
        terms = [f * made[a] * made[b] for a, b, f in terms_of(program, node)]
        made[node] = se.Add(*terms) if terms else _of_leaf(program, node)
    return made


def _of_leaf(program: Program, node: int) -> Any:
    return expression_of_leaf(program.symbols[program.leaf_number(node)])


def _expanded(program: Program, wanted: Ints) -> dict[int, Any]:
    expansion = Expansion(program, wanted)
    symbols = np.array([expression_of_leaf(s) for s in program.symbols], dtype=object)
    made = {}
    for node in wanted.tolist():
        polynomial = expansion.polynomial(node)
        terms = []
        for row, coefficient in zip(*(part.tolist() for part in polynomial), strict=True):
            factors = [symbols[i] for i in row if i >= 0]
            terms.append(se.Mul(se.Integer(coefficient), *factors))
        made[node] = se.Add(*terms)
    return made
