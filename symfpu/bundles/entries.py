"""Exact numbers and SymEngine expressions as text, and back without executing anything."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import symengine as se
from mpmath import libmp
from numpy.typing import NDArray

from symfpu.errors import InputError
from symfpu.numbers.arithmetic import text
from symfpu.numbers.typed import decimal, rational

Array = NDArray[Any]
LONGEST_DECIMAL = 3000  # bits; longer fractions are written in hexadecimal, which no limit of Python concerns
COMPOUND = {"sum": se.Add, "product": se.Mul, "power": se.Pow}


def fraction_text(value: Fraction) -> str:
    if value.numerator.bit_length() + value.denominator.bit_length() <= LONGEST_DECIMAL:
        return decimal(value)
    return f"{value.numerator:#x}/{value.denominator:#x}"


def fraction(written: str) -> Fraction:
    if re.fullmatch(r"-?0x[0-9a-f]+/0x[0-9a-f]+", written, re.ASCII):
        numerator, denominator = written.split("/")
        return Fraction(int(numerator, 16), int(denominator, 16))
    if re.fullmatch(r"-?\d+(\.\d+|/\d+)?", written, re.ASCII):
        return Fraction(written)
    raise ValueError(f"{written!r:.40} is no exact number")


def number_entry(value: Any) -> str | dict[str, str]:
    """A double as its shortest decimal; an mpf as hexadecimal mantissa and binary exponent, with a decimal to read."""
    if not isinstance(value, mpmath.mpf):
        if float(value) != value:
            raise InputError("result", value, "doubles and mpf as its numbers", "convert them")
        return repr(float(value))
    if not mpmath.isfinite(value):
        raise InputError("result", value, "finite numbers", "solve for the amplitudes again")
    sign, mantissa, exponent, bits = value._mpf_
    return {"exact": f"{'-' if sign else ''}{int(mantissa):#x}p{exponent}", "decimal": text(value, max(1, bits * 3 // 10))}


def number(entry: Any) -> Any:
    if isinstance(entry, str):
        return float(entry)
    found = re.fullmatch(r"(-?0x[0-9a-f]+)p(-?\d{1,18})", entry["exact"], re.ASCII)
    if not found:
        raise ValueError(f"{entry['exact']!r:.40} is no binary number")
    return mpmath.mp.make_mpf(libmp.from_man_exp(int(found[1], 16), int(found[2])))


class ExpressionNodes:
    """SymEngine expressions as a list of nodes, each after its parts and each once."""

    def __init__(self) -> None:
        self.nodes: list[list[Any]] = []
        self._place: dict[Any, int] = {}

    def places(self, table: Array) -> Array:
        return np.array([self._placed(se.sympify(entry)) for entry in table.ravel()], dtype=np.int64)

    def _placed(self, expression: Any) -> int:
        stack = [expression]
        while stack:
            if missing := [part for part in stack[-1].args if part not in self._place]:
                stack += missing
            elif (done := stack.pop()) not in self._place:
                self._place[done] = len(self.nodes)
                self.nodes.append(self._node(done))
        return self._place[expression]

    def _node(self, expression: Any) -> list[Any]:
        if isinstance(expression, se.Symbol):
            return ["symbol", expression.name]
        if isinstance(expression, se.Rational):
            return ["number", fraction_text(Fraction(int(expression.p), int(expression.q)))]
        for name, kind in COMPOUND.items():
            if isinstance(expression, kind):
                return [name, *(self._place[part] for part in expression.args)]
        raise InputError("result", f"{expression!s:.40}", "sums, products and powers of symbols and rational numbers", "compute it again")


def expressions_of(nodes: Iterable[Sequence[Any]]) -> Array:
    """The expressions of a list of nodes, rebuilt by SymEngine's constructors."""
    made: list[Any] = []
    for kind, *parts in nodes:
        if kind == "symbol":
            made.append(se.Symbol(str(parts[0])))
        elif kind == "number":
            made.append(rational(fraction(parts[0])))
        elif not all(type(part) is int and 0 <= part < len(made) for part in parts):
            raise ValueError("an expression comes before its parts")
        else:
            made.append(COMPOUND[kind](*(made[part] for part in parts)))
    array = np.empty(len(made), dtype=object)
    array[:] = made
    return array
