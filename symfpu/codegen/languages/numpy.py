"""NumPy: one module that needs nothing but numpy; dense matrix products over blocks of times."""

from __future__ import annotations

import re
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
from symfpu.codegen.torus_program import TorusProgram, blocks_or_zero, number

WIDTH = 118  # columns of a line
LARGEST_PRODUCT = 4  # powers up to it are written as products
PRODUCT = 100  # binds more tightly than any operator of SymPy's printers


def words(values: Any) -> str:
    """Integers or decimal text, of arrays row by row, in short lines."""
    every = map(str, np.ravel(values))
    lines = _wrapped(" ".join(every), WIDTH)
    return "\n".join(lines)


def numbers(values: Any, digits: int | None = None) -> str:
    """Numbers of so many digits, default those of doubles, in short lines."""
    every = np.ravel(values)
    if digits is None:
        return words([double(x) for x in every])
    return words([number(x, digits) for x in every])


def named(seeds: Sequence[int], letter: str) -> str:
    """A variable for each seed."""
    return ", ".join(f"{letter}{q}" for q in seeds)


def statement(text: str, start: str) -> str:
    """One statement in short lines, broken at spaces inside parentheses."""
    size = len(start) + len(text) + 4
    if size <= WIDTH:
        return f"    {start}{text}"
    lines = [f"    {start}("]
    lines += [f"        {line}" for line in _wrapped(text, WIDTH - 8)]
    return "\n".join([*lines, "    )"])


def _wrapped(text: str, width: int) -> list[str]:
    """Lines broken at blanks only."""
    return textwrap.wrap(
        text,
        width,
        break_long_words=False,
        break_on_hyphens=False,
    )


class Waves:
    """Cosines and sines of a module under its short name, for SymPy's printers."""

    module = "np"

    def _print_cos(self, expression: sympy.Expr) -> str:
        return self._called("cos", expression)

    def _print_sin(self, expression: sympy.Expr) -> str:
        return self._called("sin", expression)

    def _called(self, function: str, expression: sympy.Expr) -> str:
        (angle,) = expression.args
        text = self._print(angle)  # type: ignore[attr-defined]
        return f"{self.module}.{function}({text})"


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
        small = exponent.is_Integer and 1 < abs(exponent) <= LARGEST_PRODUCT
        if not small:
            return str(super()._print_Pow(power, rational=rational))
        n = int(exponent)
        factor = self.parenthesize(base, PRODUCT)
        product = " * ".join([factor] * abs(n))
        return f"({product})" if n > 0 else f"(1 / ({product}))"


class _BondPrinter(_Printer):
    """With all functions of NumPy."""

    def _module_format(self, fqn: str, register: bool = True) -> str:
        return f"np.{fqn.rpartition('.')[2]}"


def filters(
    printer: CodePrinter,
    constant: Callable[[tuple[Any, str]], str],
) -> dict[str, Filter]:
    """Those of Python files.

    constant : of straight-line code as text, from its value and its expression in mpmath.
    """

    def row(values: Iterable[sympy.Expr]) -> str:
        items = map(printer.doprint, values)
        return f"[{', '.join(items)}]"

    def matrix(rows: Iterable[Iterable[sympy.Expr]]) -> str:
        items = map(row, rows)
        return f"[{', '.join(items)}]"

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
    """The coefficients of cosines, c.., and of sines, d..; other statements lead to them."""
    if program.straight is None:
        return ""
    statements = program.straight.coefficients
    names = [name for name, _ in statements if re.match(r"[cd]\d", name)]
    return "".join(f"{name}, " for name in names)


def _torus(program: TorusProgram) -> Words:
    blocks = blocks_or_zero(program)
    nested = nest(blocks, program.seeds)
    words: Words = {"blocks": blocks, "turns": turns(program.frequencies)}
    words["leading"] = nested.leading
    words["trailing"] = nested.trailing
    words["nested"] = list(map(_nested_words, nested.slices))
    return words


def _nested_words(slices: Sequence[Slice]) -> Words:
    """The slices of a block behind each other."""
    layout: list[int] = []
    coefficients = []
    for part in slices:
        layout += part.leading, part.start, len(part.coefficients)
        coefficients.append(part.coefficients)
    return {"layout": layout, "coefficients": np.concatenate(coefficients)}


def _series(program: SeriesProgram) -> Words:
    return {
        "inverse": inverse_turn(),
        "kept": kept(program),
        "places": None,
    }


NUMPY = Language(
    extension="py",
    templates="numpy.py",
    filters=filters(_Printer(), lambda constant: double(constant[0]))
    | {"bond_code": _BondPrinter().doprint},
    torus_words=_torus,
    series_words=_series,
    reserved=frozenset({"numpy"}),
)
