"""C99: one file that needs nothing but the standard library.

Sixteen times go together. Powers of e^(i theta) of every seed are tabled, a harmonic costs one complex product with its
neighbour's leading factors, and what remains is two matrix products a parity block, done in tiles of four modes by two vectors.
Vectors are those of GCC and Clang, as wide as the machine that is compiled for; other compilers get plain doubles.

Of a series, statements of the amplitudes run once a call, those of the angles once a time. In tables the powers of the amplitudes are
summed once a call, and what is left is a torus and runs through its kernel.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from itertools import accumulate
from typing import Any

import numpy as np
import sympy
from sympy.printing.c import C99CodePrinter

from symfpu.chain.chain import linear_frequencies
from symfpu.codegen.constants import bond_cosines, bond_norm, rates, turns
from symfpu.codegen.series_program import SeriesProgram
from symfpu.codegen.series_tables import SeriesBlock, SeriesTables
from symfpu.codegen.templating import Language, Words, packed
from symfpu.codegen.torus_program import Block, TorusProgram, blocks_or_zero

WIDTH = 116  # columns of a line
TIMES = 16  # evaluated together: two vectors of AVX-512
CHUNK = 32  # harmonics between two accumulations: cosines and sines of 16 times are 8 kB
TILE = 4  # modes of a register tile
LARGEST_PRODUCT = 4  # highest power written as a product
EXACT = 2**53  # integers below are exact in doubles
INT = 2**31


def comment(text: str) -> str:
    """A fact as lines of a comment, which it cannot end."""
    text = text.replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?")
    lines = textwrap.wrap(
        text,
        WIDTH - 4,
        initial_indent="  ",
        subsequent_indent="      ",
        break_on_hyphens=False,
    )
    return "\n".join(f" *{line}" for line in lines)


def vector(values: Iterable[Any], name: str, kind: str = "double") -> str:
    """The definition of an array."""
    numbers = _literals(values, kind)
    return f"static const {kind} {name}[{len(numbers)}] = {{\n{_wrapped(numbers)}\n}};"


def matrix(rows: Iterable[Iterable[Any]], name: str, width: int, kind: str = "double") -> str:
    """Rows shorter than the width end in zeros, by the rules of C."""
    texts = ["{" + ",".join(_literals(row, kind)) + "}" for row in rows]
    return f"static const {kind} {name}[{len(texts)}][{width}] = {{\n{_wrapped(texts)}\n}};"


def _literals(values: Iterable[Any], kind: str) -> list[str]:
    numbers = map(float if kind == "double" else int, values)
    return [repr(x) if x else "0" for x in numbers]


def _wrapped(items: Sequence[str]) -> str:
    """Items with commas between them, broken at commas."""
    pieces = ",".join(items).split(",")
    lines = packed((f"{piece}," for piece in pieces), WIDTH)
    return "\n".join(lines).removesuffix(",")


def line(statement: str, depth: int) -> str:
    """One statement, broken after an operator or a blank."""
    pieces = re.findall(r"[^ */]+[ */]*", statement)
    lines = packed(pieces, WIDTH, start="    " * depth, indent="    " * (depth + 1))
    return "\n".join(lines)


class _Printer(C99CodePrinter):  # type: ignore[misc]
    """Numbers as the nearest doubles, quotients of integers as doubles, small powers as products."""

    def _print_Float(self, expr: sympy.Float) -> str:
        return repr(float(expr))

    def _print_Integer(self, expr: sympy.Integer) -> str:
        n = int(expr)
        return str(n) if abs(n) < INT else repr(float(n))

    def _print_Rational(self, expr: sympy.Rational) -> str:
        p, q = int(expr.p), int(expr.q)
        exact = max(abs(p), q) <= EXACT
        return f"{p}.0/{q}.0" if exact else repr(p / q)

    def _print_Pow(self, expr: sympy.Pow) -> str:
        if not expr.exp.is_Integer or not 1 < abs(int(expr.exp)) <= LARGEST_PRODUCT:
            return str(super()._print_Pow(expr))
        base = self._print(expr.base)
        factor = base if expr.base.is_Symbol else f"({base})"
        factors = [factor] * abs(int(expr.exp))
        product = f"({'*'.join(factors)})"
        return product if int(expr.exp) > 0 else f"(1.0/{product})"


def _torus(program: TorusProgram) -> Words:
    blocks = blocks_or_zero(program)
    highest = program.highest
    layout = _layout(program.N, blocks, highest)
    for block in layout["blocks"]:
        block["rates"] = rates(block["harmonics"], program.frequencies)
    high, low = zip(*turns(program.frequencies), strict=True)
    return {
        **layout,
        **_bonds(program),
        "turns": high,
        "turns_low": low,
        "stack": 8 * (layout["kernel_doubles"] + 2 * TIMES * program.N),
    }


def _bonds(program: TorusProgram) -> Words:
    """What energies need."""
    return {
        "linear": linear_frequencies(program.N).tolist(),
        "cosines": bond_cosines(program.N),
        "norm": bond_norm(program.N),
        "cubic": float(program.alpha / 3),
        "quartic": float(program.beta / 4),
    }


def _series(program: SeriesProgram) -> Words:
    if program.tables is None:
        return {}
    tables = program.tables
    layout = _layout(program.N, tables.blocks, tables.highest)
    powers = _amplitude_powers(tables)
    sizes = [block["count"] * (1 + block["width"]) for block in layout["blocks"]]
    starts = accumulate(sizes, initial=0)
    for block, start in zip(layout["blocks"], starts, strict=False):
        block["start"] = start
    return {
        **layout,
        **powers,
        "work": sum(sizes) + len(tables.powers),
        "stack": 8 * (layout["kernel_doubles"] + powers["amplitude_powers"]),
    }


def _amplitude_powers(tables: SeriesTables) -> Words:
    """Powers of the amplitudes; a frequency without a correction gets one of zero."""
    s = len(tables.scales)
    every = np.concatenate([tables.powers, 2 * tables.frequency_powers])
    degrees = every.max(axis=0)
    place = np.cumsum([0, *(degrees + 1)])
    zero = np.zeros((1, s), dtype=int)
    corrected = len(tables.frequency_powers) > 0
    return {
        "degrees": degrees,
        "place": place[:-1],
        "amplitude_powers": place[-1],
        "frequency_powers": tables.frequency_powers if corrected else zero,
        "frequency_coefficients": tables.frequency_coefficients if corrected else zero,
    }


def _layout(N: int, blocks: Sequence[Block | SeriesBlock], highest: Sequence[int]) -> Words:
    """Where sums and powers stand in the arrays of the kernel; blocks as mappings, count harmonics and width sums each."""
    widths = [-(-len(block.modes) // TILE) * TILE for block in blocks]  # whole tiles
    firsts = list(accumulate(widths, initial=0))
    starts = np.cumsum([0, *(2 * n + 1 for n in highest)])
    rows, powers = firsts[-1], int(starts[-1])
    waves = 2 * (rows + 1) + 2 * (powers + len(highest)) + 2 * CHUNK
    placed = [
        {**vars(block), "count": len(block.harmonics), "width": width, "first": first}
        for block, width, first in zip(blocks, widths, firsts, strict=False)
    ]
    return {
        "blocks": placed,
        "row": _mode_rows(N, placed, rows),
        "rows": rows,
        "powers": powers,
        "highest": highest,
        "zeroth": starts[:-1] + highest,
        "times": TIMES,
        "chunk": CHUNK,
        "tile": TILE,
        "kernel_doubles": TIMES * waves,
    }


def _mode_rows(N: int, blocks: Sequence[Words], last: int) -> list[int]:
    """Row of every mode among the sums of the blocks; the last for a mode of none."""
    rows = {q: row for block in blocks for row, q in enumerate(block["modes"], block["first"])}
    return [rows.get(q, last) for q in range(1, N)]


RESERVED = """
    auto break case char const continue default do double else enum extern float for goto if inline int long main register restrict
    return short signed sizeof static struct switch typedef union unsigned void volatile while
"""

C = Language(
    extension="c",
    templates="c",
    filters={"comment": comment, "vector": vector, "matrix": matrix, "line": line, "code": _Printer().doprint},
    torus_words=_torus,
    series_words=_series,
    reserved=frozenset(RESERVED.split()),
)
