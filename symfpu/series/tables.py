"""What the tables of a series hold, by ring.

The numbers they denote, in which arithmetic, and how a file keeps them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

import mpmath
import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.algebra.formulas import NodeTable
from symfpu.algebra.grading import Ints
from symfpu.algebra.program import ZERO
from symfpu.algebra.words import IntegerTable
from symfpu.chain.chain import Chain, linear_by_wave
from symfpu.errors import SymfpuError
from symfpu.numbers.arithmetic import (
    DOUBLES,
    MULTIPRECISION,
    Arithmetic,
    Numbers,
    from_integers,
)
from symfpu.numbers.typed import integer
from symfpu.series.programs import Member, program_entries, program_from, program_members

Array = NDArray[Any]
Floats = NDArray[np.float64]
Json = dict[str, Any]
Shapes = list[tuple[int, ...]]
Parts = dict[str, tuple[Any, ...]]  # tables by order: "coordinates" and "corrections"
Members = Mapping[str, Array]

LOG10_2 = 0.30102999566398120
SYMBOL_DIGITS = 2  # of a number in an expression, beyond the promised ones


@dataclass(frozen=True)
class Exponents:
    """The power of a table's unit, and how many halvings, that all its coefficients share."""

    unit: Fraction
    units: int
    halves: int


@dataclass(frozen=True)
class Tables(ABC):
    """The arithmetic of the tables of one series; its methods are those of plain arrays.

    digits : promised; None for doubles and symbols. bits : binary places.

    symbolic : whether coefficients are expressions in the symbols L_q(nu). dtype : of the array
    that a file keeps. numbers : the arithmetic of numeric results. kind : the dtype of an array of
    coefficients.
    """

    digits: int | None = None
    bits: int = 0

    symbolic: ClassVar[bool] = False
    dtype: ClassVar[str] = "<i8"
    numbers: ClassVar[Arithmetic] = DOUBLES
    kind: ClassVar[Any] = object

    @abstractmethod
    def linear(self, chain: Chain, q: int) -> Any:
        """Omega_q, as a number or as a symbol."""

    def entries(self, table: Any, columns: Any = slice(None)) -> Array:
        """Entries of a table as the numbers they denote: doubles, mpf or expressions."""
        return np.asarray(table[:, columns])

    def doubles(self, table: Any) -> Floats:
        """Entries of a table as doubles. Raises SymEngine's RuntimeError for symbols."""
        return np.asarray(table, dtype=np.float64)

    def nonzero(self, table: Any) -> NDArray[np.bool_]:
        """Which entries of a table are not zero."""
        return np.asarray(table != 0)

    @abstractmethod
    def scaled(
        self, values: Array, linear: Sequence[Any], powers: Ints, exponents: Exponents
    ) -> Array:
        """values times prod linear^powers, unit and halves; powers (count, s)."""

    def simplified(self, values: Array) -> Array:
        """Coefficients in the normal form of the ring."""
        return values

    def finite(self, values: Array, what: str) -> Array:
        """The values; raises SymfpuError where they exceed the range of doubles."""
        return values

    @abstractmethod
    def symbol(self, value: Any) -> Any:
        """A coefficient as a SymEngine number."""

    def pack(self, parts: Parts) -> tuple[Parts, Json]:
        """Arrays that a file keeps, by name and order, and what else is needed to read them."""
        return parts, {}

    def shapes(self, name: str, shapes: Shapes, body: Json) -> Shapes:
        """Shapes of the arrays of a file, from those of the tables."""
        return shapes

    def members(self, body: Json) -> dict[str, Member]:
        """Further arrays of a file, by name. Raises ValueError."""
        return {}

    @abstractmethod
    def unpack(self, arrays: Sequence[Array], body: Json, members: Members) -> list[Any]:
        """Tables from the arrays of a file. Raises ValueError."""


@dataclass(frozen=True)
class DoubleTables(Tables):
    """Arrays of doubles; residues modulo a prime are kept as such, too."""

    dtype: ClassVar[str] = "<f8"
    kind: ClassVar[Any] = float

    def linear(self, chain: Chain, q: int) -> Any:
        """Omega_q."""
        return linear_by_wave(chain.N, chain.ends)[q % chain.N]

    def scaled(
        self, values: Array, linear: Sequence[Any], powers: Ints, exponents: Exponents
    ) -> Array:
        """By logarithms to base two, whose whole part cannot overflow."""
        logarithm = powers @ np.log2(np.array(linear))
        logarithm = (
            logarithm + exponents.units * np.log2(float(exponents.unit)) - exponents.halves
        )
        whole = np.floor(logarithm).astype(int)
        with np.errstate(over="ignore", under="ignore"):
            return np.asarray(np.ldexp(values * np.exp2(logarithm - whole), whole))

    def finite(self, values: Array, what: str) -> Array:
        """The values, if doubles hold them."""
        if not np.isfinite(values).all():
            advice = "evaluate at amplitudes (harmonic_terms) instead"
            raise SymfpuError(
                f"{what} has coefficients beyond the range of doubles; {advice}"
            )
        return values

    def symbol(self, value: Any) -> Any:
        """A double."""
        return se.RealDouble(float(value))

    def unpack(self, arrays: Sequence[Array], body: Json, members: Members) -> list[Any]:
        """As they are, and finite."""
        if not all(np.isfinite(array).all() for array in arrays):
            raise ValueError("a coefficient is not finite")
        return list(map(np.asarray, arrays))


@dataclass(frozen=True)
class FixedPointTables(Tables):
    """Tables of integers in units of 2^-bits, whose numbers are mpf of so many digits."""

    numbers: ClassVar[Arithmetic] = MULTIPRECISION

    def linear(self, chain: Chain, q: int) -> Any:
        """Omega_q at the working precision."""
        return chain.linear_frequency(q)

    def entries(self, table: IntegerTable, columns: Any = slice(None)) -> Array:
        """mpf at the working precision."""
        return from_integers(table.integers(columns), np.asarray(-self.bits))

    def doubles(self, table: Any) -> Floats:
        """Rounded; the corrections of order 0 are an array without rows."""
        return (
            table.floats(-self.bits)
            if isinstance(table, IntegerTable)
            else np.asarray(table)
        )

    def nonzero(self, table: Any) -> NDArray[np.bool_]:
        """By their words."""
        return np.asarray(table.words.any(axis=-1))

    def scaled(
        self, values: Array, linear: Sequence[Any], powers: Ints, exponents: Exponents
    ) -> Array:
        """In mpf."""
        scale = (
            MULTIPRECISION.number(exponents.unit) ** exponents.units / 2**exponents.halves
        )
        return multiplied(values, linear, powers, scale)

    def symbol(self, value: Any) -> Any:
        """A number of the promised digits and some more."""
        assert self.digits is not None
        digits = self.digits + SYMBOL_DIGITS
        return se.Float(mpmath.nstr(value, digits), dps=digits)

    def pack(self, parts: Parts) -> tuple[Parts, Json]:
        """Words of integers, and how many words an entry has."""
        words = {
            name: tuple(table.words for table in tables) for name, tables in parts.items()
        }
        counts = {
            name: [int(part.shape[2]) for part in tables] for name, tables in words.items()
        }
        return words, {"words": counts}

    def shapes(self, name: str, shapes: Shapes, body: Json) -> Shapes:
        """With the number of words of each table."""
        counts = [integer(n, "words", 1) for n in body["words"][name]]
        return [(*shape, n) for shape, n in zip(shapes, counts, strict=True)]

    def unpack(self, arrays: Sequence[Array], body: Json, members: Members) -> list[Any]:
        """Tables of integers."""
        return list(map(IntegerTable, arrays))


@dataclass(frozen=True)
class ExpressionTables(Tables):
    """Tables of SymEngine expressions in the symbols L_q(nu).

    Expanded : whether every coefficient is an expanded polynomial.
    """

    symbolic: ClassVar[bool] = True

    expanded: bool = False

    def linear(self, chain: Chain, q: int) -> Any:
        """The symbol Omega_q."""
        return se.Symbol(f"Omega_{q}")

    def nonzero(self, table: Any) -> NDArray[np.bool_]:
        """Those that have a node."""
        present: Any = table.nonzero if isinstance(table, NodeTable) else table != 0
        return np.asarray(present)

    def scaled(
        self, values: Array, linear: Sequence[Any], powers: Ints, exponents: Exponents
    ) -> Array:
        """In symbols; their unit is one."""
        return multiplied(
            values, linear, powers, se.Integer(1) / se.Integer(2) ** exponents.halves
        )

    def simplified(self, values: Array) -> Array:
        """Expanded, if the tables are."""
        return (
            np.array([se.expand(v) for v in values], dtype=object)
            if self.expanded
            else values
        )

    def symbol(self, value: Any) -> Any:
        """The expression."""
        return value

    def pack(self, parts: Parts) -> tuple[Parts, Json]:
        """Nodes, the program that they belong to, and its symbols."""
        tables = {name: tuple(table.nodes for table in row) for name, row in parts.items()}
        first, *_ = parts["coordinates"]
        arrays, layout = program_entries(first.program)
        return tables | {name: (values,) for name, values in arrays.items()}, layout

    def members(self, body: Json) -> dict[str, Member]:
        """Those of the program."""
        return program_members(body)

    def unpack(self, arrays: Sequence[Array], body: Json, members: Members) -> list[Any]:
        """Tables of nodes."""
        program = program_from(body, members)
        for nodes in arrays:
            if nodes.size and not ZERO <= nodes.min() <= nodes.max() < program.size:
                raise ValueError("a coefficient is no node of the program")
        return [NodeTable(program, nodes, expanded=self.expanded) for nodes in arrays]


def multiplied(values: Array, linear: Sequence[Any], powers: Ints, scale: Any) -> Numbers:
    """values times prod linear^powers times scale, one after the other."""
    products = []
    for value, row in zip(values, powers, strict=True):
        factor = np.prod([x ** int(e) for x, e in zip(linear, row, strict=True)]) * scale
        products.append(value * factor)
    return np.array(products, dtype=object)
