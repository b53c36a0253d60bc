"""C99: one file that needs nothing but the standard library.

Sixteen times go together. Powers of e^(i theta) of every seed are tabled, a harmonic costs
one complex product with its neighbour's leading factors, and what remains is two matrix
products a parity block, done in tiles of four modes by two vectors. Vectors are those of
GCC and Clang, as wide as the machine that is compiled for; other compilers get doubles.

Of a series, statements of the amplitudes run once a call, those of the angles once a time.
In tables the powers of the amplitudes are summed once a call, and what is left is a torus
and runs through its kernel.
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
CHUNK = 32  # harmonics between two accumulations: their waves are 8 kB
TILE = 4  # modes of a register tile
LARGEST_PRODUCT = 4  # highest power written as a product
EXACT_INTEGERS = 2**53  # integers below are exact in doubles
INT = 2**31
INTEGERS = {
    "signed char": 7,
    "short": 15,
    "int": 31,
    "long long": 63,
}  # bits besides the sign
REPLACEMENTS = {"*/": "* /", "/*": "/ *", "??": "? ?"}  # in comments


def comment(text: str) -> str:
    """A fact as lines of a comment, which it cannot end."""
    for sign, harmless in REPLACEMENTS.items():
        text = text.replace(sign, harmless)
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
    size = f"[{len(numbers)}]"
    return _definition(f"{kind} {name}{size}", numbers)


def fitting(values: Iterable[int], name: str) -> str:
    """The definition of an array of the narrowest integers that hold all values."""
    numbers = np.asarray(values)
    low, high = int(numbers.min()), int(numbers.max())
    kind = next(kind for kind, bits in INTEGERS.items() if max(-low - 1, high) < 2**bits)
    return vector(numbers.tolist(), name, kind)


def matrix(
    rows: Iterable[Iterable[Any]],
    name: str,
    width: int,
    kind: str = "double",
) -> str:
    """Rows shorter than the width end in zeros, by the rules of C."""
    literals = [_literals(row, kind) for row in rows]
    items = ["{" + ",".join(row) + "}" for row in literals]
    size = f"[{len(items)}][{width}]"
    return _definition(f"{kind} {name}{size}", items)


def _literals(values: Iterable[Any], kind: str) -> list[str]:
    number = float if kind == "double" else int
    return [repr(x) if x else "0" for x in map(number, values)]


def _definition(declared: str, items: Sequence[str]) -> str:
    """Items with commas between them, broken at commas."""
    pieces = ",".join(items).split(",")
    lines = packed((f"{piece}," for piece in pieces), WIDTH)
    body = "\n".join(lines).removesuffix(",")
    return f"static const {declared} = {{\n{body}\n}};"


def line(statement: str, depth: int) -> str:
    """One statement, broken after an operator or a blank."""
    pieces = re.findall(r"[^ */]+[ */]*", statement)
    start, indent = "    " * depth, "    " * (depth + 1)
    lines = packed(pieces, WIDTH, start=start, indent=indent)
    return "\n".join(lines)


class _Printer(C99CodePrinter):  # type: ignore[misc]
    """Numbers as nearest doubles, quotients of integers as doubles, small powers as products."""

    def _print_Float(self, expr: sympy.Float) -> str:
        return repr(float(expr))

    def _print_Integer(self, expr: sympy.Integer) -> str:
        n = int(expr)
        return str(n) if abs(n) < INT else repr(float(n))

    def _print_Rational(self, expr: sympy.Rational) -> str:
        p, q = int(expr.p), int(expr.q)
        if max(abs(p), q) > EXACT_INTEGERS:
            return repr(p / q)
        return f"{p}.0/{q}.0"

    def _print_Pow(self, expr: sympy.Pow) -> str:
        small = expr.exp.is_Integer and 1 < abs(int(expr.exp)) <= LARGEST_PRODUCT
        if not small:
            return str(super()._print_Pow(expr))
        n = int(expr.exp)
        base = self._print(expr.base)
        factor = base if expr.base.is_Symbol else f"({base})"
        product = "*".join([factor] * abs(n))
        return f"({product})" if n > 0 else f"(1.0/({product}))"


def _torus(program: TorusProgram) -> Words:
    blocks = blocks_or_zero(program)
    words = _layout(program.N, blocks, program.highest)
    for block in words["blocks"]:
        block["rates"] = rates(block["harmonics"], program.frequencies)
    pairs = turns(program.frequencies)
    words["turns"], words["turns_low"] = zip(*pairs, strict=True)
    orbit = 2 * TIMES * program.N
    words["stack"] = 8 * (words["kernel_doubles"] + orbit)
    return words | _bonds(program)


def _bonds(program: TorusProgram) -> Words:
    """What energies need."""
    N = program.N
    return {
        "linear": linear_frequencies(N).tolist(),
        "cosines": bond_cosines(N),
        "norm": bond_norm(N),
        **_couplings(program),
    }


def _couplings(program: TorusProgram) -> Words:
    if program.couplings is None:
        return {}
    alpha, beta = program.couplings
    return {"cubic": float(alpha / 3), "quartic": float(beta / 4)}


def _series(program: SeriesProgram) -> Words:
    tables = program.tables
    if tables is None:
        return {}
    words = _layout(program.N, tables.blocks, tables.highest)
    words |= _amplitude_powers(tables)
    if program.operations:
        words["frequency_signs"] = [*program.operations.frequency_signs, 1][
            : len(words["frequency_powers"])
        ]
    work = 0
    for block in words["blocks"]:
        block["start"] = work
        work += block["count"] * (1 + block["width"])
    words["work"] = work + len(tables.powers)
    words["stack"] = 8 * (words["kernel_doubles"] + words["amplitude_powers"])
    return words


def _amplitude_powers(tables: SeriesTables) -> Words:
    """Powers of the amplitudes; a frequency without a correction gets one of zero."""
    powers: Any = tables.frequency_powers
    coefficients = tables.frequency_coefficients
    degrees = np.concatenate([tables.powers, 2 * powers]).max(axis=0)
    place = np.cumsum([0, *(degrees + 1)])
    if not len(powers):
        powers = coefficients = np.zeros((1, len(degrees)))
    return {
        "degrees": degrees,
        "place": place[:-1],
        "amplitude_powers": place[-1],
        "frequency_powers": powers,
        "frequency_coefficients": coefficients,
    }


def _layout(
    N: int,
    blocks: Sequence[Block | SeriesBlock],
    highest: Sequence[int],
) -> Words:
    """Where sums and powers stand in the arrays of the kernel."""
    placed, rows = _placed(blocks)
    sizes = [2 * n + 1 for n in highest]
    powers = sum(sizes)
    starts = accumulate(sizes, initial=0)
    zeroth = [start + n for start, n in zip(starts, highest, strict=False)]
    waves = 2 * (rows + 1) + 2 * (powers + len(highest)) + 2 * CHUNK
    return {
        "blocks": placed,
        "row": _mode_rows(N, placed, rows),
        "rows": rows,
        "powers": powers,
        "highest": highest,
        "zeroth": zeroth,
        "times": TIMES,
        "chunk": CHUNK,
        "tile": TILE,
        "kernel_doubles": TIMES * waves,
    }


def _placed(blocks: Sequence[Block | SeriesBlock]) -> tuple[list[Words], int]:
    """Blocks with count harmonics, width sums in whole tiles and the first of these; all sums."""
    placed: list[Words] = []
    first = 0
    for block in blocks:
        count = len(block.harmonics)
        tiles = -(-len(block.modes) // TILE)
        width = tiles * TILE
        own = vars(block)
        placed.append({**own, "count": count, "width": width, "first": first})
        first += width
    return placed, first


def _mode_rows(N: int, blocks: Sequence[Words], last: int) -> list[int]:
    """Row of every mode among the sums of the blocks; the last for a mode of none."""
    rows: dict[int, int] = {}
    for block in blocks:
        own = enumerate(block["modes"], block["first"])
        rows |= {q: row for row, q in own}
    return [rows.get(q, last) for q in range(1, N)]


RESERVED_WORDS = """
    auto break case char const continue default do double else enum extern float for goto
    if inline int long main register restrict return short signed sizeof static struct
    switch typedef union unsigned void volatile while
"""

C = Language(
    extension="c",
    templates="c",
    filters={
        "code": _Printer().doprint,
        "comment": comment,
        "fitting": fitting,
        "line": line,
        "matrix": matrix,
        "vector": vector,
    },
    torus_words=_torus,
    series_words=_series,
    reserved=frozenset(RESERVED_WORDS.split()),
)
