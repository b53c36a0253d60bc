"""NumPy: one module that needs nothing but numpy; dense matrix products over blocks of times."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import sympy
from sympy.printing.codeprinter import CodePrinter
from sympy.printing.numpy import NumPyPrinter

from symfpu.codegen.constants import inverse_turn, turns
from symfpu.codegen.nested import Slice, nest
from symfpu.codegen.series_program import SeriesProgram
from symfpu.codegen.templating import Filter, Language, Words, double
from symfpu.codegen.torus_program import TorusProgram, number

WIDTH = 118  # columns of a line
LARGEST_PRODUCT = 4  # powers up to it are written as products
PRODUCT = 100  # binds more tightly than any operator of SymPy's printers: all but names and numbers get parentheses


def words(values: Any) -> str:
    """Integers or decimal text, of arrays row by row, in short lines."""
    every = " ".join(map(str, np.ravel(values)))
    lines = textwrap.wrap(every, WIDTH, break_long_words=False, break_on_hyphens=False)
    return "\n".join(lines)


def numbers(values: Any, digits: int | None = None) -> str:
    """Numbers of so many digits, default those of doubles, in short lines."""
    every = np.ravel(values)
    return words([double(x) if digits is None else number(x, digits) for x in every])


def named(seeds: Sequence[int], letter: str) -> str:
    """A variable for each seed."""
    return ", ".join(f"{letter}{q}" for q in seeds)


def statement(text: str, start: str) -> str:
    """One statement in short lines, broken at spaces inside parentheses."""
    if len(start) + len(text) + 4 <= WIDTH:
        return f"    {start}{text}"
    lines = textwrap.wrap(text, WIDTH - 8, break_long_words=False, break_on_hyphens=False)
    return "\n".join([f"    {start}(", *(f"        {line}" for line in lines), "    )"])


class Waves:
    """Cosines and sines of a module under its short name, for SymPy's printers."""

    module = "np"

    def _print_cos(self, expression: sympy.Expr) -> str:
        return f"{self.module}.cos({self._print(expression.args[0])})"  # type: ignore[attr-defined]

    def _print_sin(self, expression: sympy.Expr) -> str:
        return f"{self.module}.sin({self._print(expression.args[0])})"  # type: ignore[attr-defined]


class _Printer(Waves, NumPyPrinter):  # type: ignore[misc]
    """NumPy with its short name; a Float is the double next to it."""

    def __init__(self) -> None:
        super().__init__({"fully_qualified_modules": False})

    def _print_Float(self, value: sympy.Float) -> str:
        return repr(float(value))

    def _print_Rational(self, value: sympy.Rational) -> str:
        return f"({value.p} / {value.q})"

    def _print_Pow(self, power: sympy.Pow, rational: bool = False) -> str:
        base, exponent = power.as_base_exp()
        if not exponent.is_Integer or not 1 < abs(exponent) <= LARGEST_PRODUCT:
            return str(super()._print_Pow(power, rational=rational))
        factors = [self.parenthesize(base, PRODUCT)] * abs(int(exponent))
        product = " * ".join(factors)
        return f"({product})" if exponent > 0 else f"(1 / ({product}))"


def filters(printer: CodePrinter, constant: Callable[[tuple[Any, str]], str]) -> dict[str, Filter]:
    """Those of Python files. constant : of straight-line code as text, from its value and its expression in mpmath."""

    def row(values: Iterable[sympy.Expr]) -> str:
        return "[" + ", ".join(map(printer.doprint, values)) + "]"

    def matrix(rows: Iterable[Iterable[sympy.Expr]]) -> str:
        return "[" + ", ".join(map(row, rows)) + "]"

    return {
        "code": printer.doprint,
        "constant": constant,
        "matrix": matrix,
        "named": named,
        "numbers": numbers,
        "row": row,
        "statement": statement,
        "words": words,
    }


def kept(program: SeriesProgram) -> str:
    """The coefficients that a call computes once, of cosines c and of sines d; other statements only lead to them."""
    if program.straight is None:
        return ""
    names = [name for name, _ in program.straight.coefficients]
    return "".join(f"{name}, " for name in names if name[0] in "cd" and name[1].isdigit())


def _torus(program: TorusProgram) -> Words:
    nested = nest(program)
    return {
        "turns": turns(program.frequencies),
        "leading": nested.leading,
        "trailing": nested.trailing,
        "nested": [_nested_words(slices) for slices in nested.slices],
    }


def _nested_words(slices: Sequence[Slice]) -> Words:
    return {
        "layout": [(part.leading, part.start, len(part.coefficients)) for part in slices],
        "coefficients": np.concatenate([part.coefficients.ravel() for part in slices]),
    }


def _series(program: SeriesProgram) -> Words:
    return {
        "inverse": inverse_turn(),
        "kept": kept(program),
        "places": None,
    }


NUMPY = Language(
    extension="py",
    templates="numpy.py",
    filters=filters(_Printer(), lambda constant: double(constant[0])),
    torus_words=_torus,
    series_words=_series,
    reserved=frozenset({"numpy"}),
)
