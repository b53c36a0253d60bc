"""Fortran 2008: one module that needs nothing but a compiler.

Blocks of times go together. Powers of e^(i theta) of every seed are tabled, a harmonic costs
one complex product with the leading factors of its neighbour, and what remains is two matrix
products a parity, which `matmul` of the compiler's library does. Tables are DATA statements in
chunks: compilers read those in linear time, and constructors of this length not at all.

Of a series, statements of the amplitudes run once a call, waves and their sums once a time.
Tables are summed over the powers of the amplitudes once a call; the times then go through the
kernel of a torus.

Procedures have the same names in every module, to be renamed on use where two modules meet.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from numbers import Integral
from typing import Any

import mpmath
import numpy as np
import sympy
from sympy.printing.fortran import FCodePrinter
from sympy.printing.precedence import precedence

from symfpu.chain.chain import linear_frequencies
from symfpu.codegen.constants import WORK_DIGITS, bond_cosines, bond_norm, rates
from symfpu.codegen.series_program import SeriesProgram
from symfpu.codegen.series_tables import SeriesTables
from symfpu.codegen.straight_line import StraightLine
from symfpu.codegen.templating import Language, Words, packed
from symfpu.codegen.torus_program import TorusProgram
from symfpu.errors import InputError

WIDTH = 120  # columns of a line; the standard allows 132
LINES = 200  # of a DATA statement; the standard allows 255 continuations
TERMS = 100  # of a sum in one statement
TIMES = 64  # evaluated together
TILE = 256  # harmonics of one matrix product: cosines and sines of 64 times are 256 kB
WORD = (
    24  # bits of the leading parts of omega / 2 pi: times halves of a time they are exact
)
INTEGERS = {"byte": 7, "short": 15, "long": 31}  # bits besides the sign
EXACT_INTEGERS = 2**53  # integers below are doubles
BREAKS = re.compile(
    r"(?<=[ (])|(?<=[^*]\*)(?!\*)|(?<=/)"
)  # after blank, bracket, star, slash
PLACEHOLDER = "\N{WHITE SQUARE}"  # stands for the module's name, and occurs nowhere else
REPLACEMENTS = {"\\": "/", "*/": "* /", "/*": "/ *"}  # in comments
TABLES = {"default_phases"}
TABLES |= {"nu_even", "nu_odd", "rates_even", "rates_odd", "c_even", "c_odd"}


def comment(text: str) -> str:
    """A fact as lines of a comment, without what the preprocessor takes for comments of C."""
    one_line = " ".join(text.split())
    text = one_line.encode("ascii", "backslashreplace").decode()
    for sign, harmless in REPLACEMENTS.items():
        text = text.replace(sign, harmless)
    lines = textwrap.wrap(
        text,
        WIDTH - 4,
        initial_indent="  ",
        subsequent_indent="      ",
        break_on_hyphens=False,
    )
    return "\n".join(f"!{line}" for line in lines)


def listed(numbers: str) -> str:
    """Numbers as lines of a comment."""
    lines = textwrap.wrap(numbers, WIDTH - 10)
    return "\n".join(f"!     {line}" for line in lines)


def literal(value: Any) -> str:
    """A number that no compiler rounds to single precision, or warns of.

    Numbers below the normal doubles are zero.
    """
    if isinstance(value, Integral):
        return str(value)
    value = float(value)
    if abs(value) < np.finfo(float).tiny:
        return "0d0"
    text = repr(value).removesuffix(".0")
    return text.replace("e", "d") if "e" in text else f"{text}d0"


def columns(rows: Iterable[Iterable[Any]], name: str) -> str:
    """DATA statements for name(i, 1), name(i, 2) and so on."""
    statements = []
    for j, column in enumerate(zip(*rows, strict=True), 1):
        element = f"{name}(i, {j})"
        statements.append(data(column, element))
    return "\n".join(statements)


def data(values: Iterable[Any], element: str, first: int = 1) -> str:
    """DATA statements for an element of an array, its index i running from first."""
    statements = []
    for lines in _chunks(map(literal, values)):
        body = " &\n    ".join(lines)
        last = first + body.count(",") - 1
        numbers = body.removesuffix(",")
        statements.append(f"  data ({element}, i = {first}, {last}) / &\n    {numbers} /")
        first = last + 1
    return "\n".join(statements)


def _chunks(numbers: Iterable[str]) -> Iterator[list[str]]:
    """Lines of numbers with commas behind them, as many together as one statement may have."""
    pieces = (f"{number}," for number in numbers)
    lines = packed(pieces, WIDTH - 7)
    for first in range(0, len(lines), LINES):
        yield lines[first : first + LINES]


def parity(modes: Sequence[int]) -> str:
    """The name of a block."""
    return "odd" if modes[0] % 2 else "even"


def kind(values: Iterable[int]) -> str:
    """The narrowest kind of integers that holds all values, as the module calls it."""
    numbers = np.asarray(values)
    largest = max(-int(numbers.min()) - 1, int(numbers.max()))
    return next(kind for kind, bits in INTEGERS.items() if largest < 2**bits)


def matching(pattern: str, names: Iterable[str]) -> str:
    """A pattern filled in for every name, as often as it asks for one, with commas between."""
    return ", ".join(pattern.replace("%s", name) for name in names)


def declared(names: Iterable[str]) -> str:
    """Declarations of doubles."""
    wrapped = textwrap.wrap(", ".join(names), WIDTH - 20)
    lines = [line.removesuffix(",") for line in wrapped]
    return "\n".join(f"    real(rk) :: {line}" for line in lines)


def assigned(expression: sympy.Expr, name: str, indent: int) -> str:
    """Statements name = expression; a long sum takes several."""
    terms = expression.as_ordered_terms()
    lines: list[str] = []
    for first in range(0, len(terms), TERMS):
        part = terms[first : first + TERMS]
        value = _PRINTER.doprint(sympy.Add(*part))
        if first:
            value = _added(name, value)
        lines += _continued(f"{name} = {value}")
    return textwrap.indent("\n".join(lines), " " * indent)


def _added(name: str, value: str) -> str:
    if value.startswith("-"):
        return f"{name} - {value[1:]}"
    return f"{name} + {value}"


def _continued(statement: str) -> list[str]:
    lines = []
    line = ""
    for piece in BREAKS.split(statement):
        size = len(line) + len(piece)
        if size > WIDTH - 14:
            lines.append(f"{line.rstrip()} &")
            line = "  "
        line += piece
    return [*lines, line]


class _Printer(FCodePrinter):  # type: ignore[misc]
    """Every number is the nearest double; lines are wrapped elsewhere."""

    def _format_code(self, lines: list[str]) -> list[str]:
        return lines

    def _print_Float(self, number: sympy.Float) -> str:
        return literal(float(number))

    def _print_Integer(self, number: sympy.Integer) -> str:
        return literal(float(number))

    def _print_Rational(self, number: sympy.Rational) -> str:
        if max(abs(number.p), number.q) > EXACT_INTEGERS:
            return literal(float(number))
        p, q = float(number.p), float(number.q)
        return f"{literal(p)}/{literal(q)}"

    def _print_Pow(self, power: sympy.Pow) -> str:
        base, exponent = power.as_base_exp()
        written = self.parenthesize(base, precedence(power), strict=False)
        if not exponent.is_Integer:
            return f"{written}**({self._print(exponent)})"
        n = int(exponent)
        if abs(n) != 1:
            written = f"{written}**{abs(n)}"
        return written if n > 0 else f"1d0/{written}"


_PRINTER = _Printer({"standard": 2008, "source_format": "free", "name_mangling": False})


class Modules(Language):
    """Of the names in a file, the module must have one that nothing in it has."""

    def filled(self, kind: str, words: Words) -> str:
        """Raises InputError for a name that the module needs itself."""
        name = words["name"]
        macro = f"{name.upper()}_SELF_TEST"
        code = super().filled(kind, words | {"name": PLACEHOLDER, "macro": macro})
        own = _identifiers(code) | TABLES
        legal = re.fullmatch(r"[a-z][a-z0-9_]{0,49}", name.lower(), re.ASCII)
        if not legal or name.lower() in own:
            allowed = (
                "a file name that is a Fortran identifier the module does not use itself"
            )
            raise InputError("path", name, allowed, "rename the file")
        return code.replace(PLACEHOLDER, name)


def _identifiers(code: str) -> set[str]:
    """Names outside strings and comments, but for those that begin with the module's."""
    bare = re.sub(r"'[^'\n]*'|!.*", "", code)
    names = re.findall(rf"(?<![\w{PLACEHOLDER}])[a-z]\w*", bare.lower())
    return set(names)


def split(value: Any) -> list[float]:
    """A number as a sum of two doubles of WORD bits and a full one."""
    parts = []
    for _ in range(2):
        mantissa, exponent = mpmath.frexp(value)
        leading = mpmath.nint(mpmath.ldexp(mantissa, WORD))
        part = float(mpmath.ldexp(leading, exponent - WORD))
        parts.append(part)
        value -= part
    return [*parts, float(value)]


def _torus(program: TorusProgram) -> Words:
    N = program.N
    words = _kernel(program.highest)
    words["turns"] = [_turns(w) for w in program.frequencies]
    words["radian"] = _turns(Fraction(1))
    words["linear"] = linear_frequencies(N).tolist()
    words["cosines"] = bond_cosines(N)
    words["norm"] = bond_norm(N)
    return words


def _turns(frequency: Fraction) -> list[float]:
    """omega / 2 pi in three parts."""
    with mpmath.workdps(WORK_DIGITS):
        exact = mpmath.mpf(frequency.numerator) / frequency.denominator
        return split(exact / (2 * mpmath.pi))


def _kernel(highest: Sequence[int]) -> Words:
    """Sizes in the sums over harmonics. highest : numbers in these, of every seed."""
    largest = max(2, *highest)  # compilers warn of a loop from 2 to 1
    return {"highest": largest, "times": TIMES, "tile": TILE}


def _series(program: SeriesProgram) -> Words:
    words: Words = {"radian": _turns(Fraction(1))}
    if program.straight:
        words |= _names(program.straight, program.seeds)
    if program.tables:
        words |= _kernel(program.tables.highest)
        words |= _corrections(program.tables)
    if program.operations:
        count = len(words["even_powers"])
        words["even_signs"] = [*program.operations.frequency_signs, 1][:count]
        words["correction"] = np.asarray(words["correction"], dtype=np.int64)
    return words


def _names(straight: StraightLine, seeds: Sequence[int]) -> Words:
    """What is to be declared."""
    given = [f"A{q}" for q in seeds]
    given += [f"omega{q}" for q in seeds]
    names = [name for name in given if name in straight.coefficient_symbols]
    names += [name for name, _ in straight.coefficients]
    names += [f"theta{q}" for q in seeds]
    names += [name for name, _ in straight.waves]
    of_frequencies = [name for name in given if name in straight.frequency_symbols]
    of_frequencies += [name for name, _ in straight.frequency_statements]
    return {"names": names, "frequency_names": of_frequencies}


def _corrections(tables: SeriesTables) -> Words:
    """Corrections of the frequencies; where there are none, one of zero: a table has a row."""
    powers = 2 * tables.frequency_powers
    coefficients = tables.frequency_coefficients
    if not len(powers):
        powers = np.zeros((1, len(tables.scales)), dtype=np.int64)
        coefficients = np.zeros(powers.shape)
    degree = max(2, tables.powers.max(), powers.max())
    return {
        "blocks": tables.blocks,
        "degree": degree,
        "even_powers": powers,
        "correction": coefficients,
    }


FORTRAN = Modules(
    extension="F90",  # the capital lets compilers run the preprocessor
    templates="F90",
    filters={
        "assigned": assigned,
        "columns": columns,
        "comment": comment,
        "data": data,
        "declared": declared,
        "kind": kind,
        "listed": listed,
        "literal": literal,
        "matching": matching,
        "parity": parity,
        "rates": rates,
    },
    torus_words=_torus,
    series_words=_series,
    reserved=frozenset(
        {"program", "module", "end", "subroutine", "function", "real", "integer"}
    ),
)
