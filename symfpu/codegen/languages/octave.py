"""GNU Octave and MATLAB: one function file; dense real matrix products over blocks of times.

A harmonic is a multiple of the first seed's angle and a trailing part, so that the sums of
products of cosines and of sines serve nu = (a, b) and (a, -b) at once: with a reference BLAS half
the multiplications of complex sums, and few cosines. Long tables are text read by sscanf, which
Octave parses in half the time of a matrix of literals.

Names of files are in lower case: local functions have names in mixed case.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import sympy
from sympy.printing.octave import OctaveCodePrinter

from symfpu.algebra.grading import Ints
from symfpu.codegen.constants import inverse_turn, turns
from symfpu.codegen.series_program import SeriesProgram
from symfpu.codegen.series_tables import SeriesBlock
from symfpu.codegen.templating import Language, Words, double
from symfpu.codegen.torus_program import Block, TorusProgram

WIDTH = 100  # columns of a line of numbers or comments, before what begins and ends it
CHUNK = 200  # lines of text in one statement
INDENT = "    "
BLOCK = 128  # times evaluated together
STRAIGHT_BLOCK = 1024  # times together: statements are interpreted once for them all


def comment(text: str, indent: int) -> str:
    """Lines of a comment, whatever characters the text has."""
    ascii_text = text.encode("ascii", "backslashreplace").decode()
    lines = textwrap.wrap(ascii_text, WIDTH, subsequent_indent=INDENT, break_on_hyphens=False)
    return "\n".join(f"%{indent * ' '}{line}" for line in lines)


def doubles(values: Any) -> list[str]:
    """Numbers of an array, row by row, as text."""
    return [double(x) for x in np.ravel(values)]


def chunks(numbers: Any) -> list[list[str]]:
    """Lines of numbers, as many together as one statement has."""
    text = " ".join(map(str, np.ravel(numbers)))
    lines = textwrap.wrap(text, WIDTH, break_long_words=False, break_on_hyphens=False)
    return [lines[i : i + CHUNK] for i in range(0, len(lines), CHUNK)]


def vector(values: Iterable[Any]) -> str:
    """A short row of numbers, continued in further lines."""
    words = ", ".join(str(x) if isinstance(x, int) else double(x) for x in values)
    lines = textwrap.wrap(words, WIDTH - 20, break_on_hyphens=False)
    return "[" + f" ...\n{2 * INDENT}".join(lines) + "]"


def cells(items: Iterable[str]) -> str:
    """A cell array in a row."""
    return "{" + f", ...\n{INDENT}".join(items) + "}"


def of_each(blocks: Sequence[Block | SeriesBlock], pattern: str) -> list[str]:
    """A pattern filled in for every block: {k} from 1, {s} seeds, {modes} how many."""
    return [pattern.format(k=k, s=block.harmonics.shape[1], modes=len(block.modes)) for k, block in enumerate(blocks, 1)]


def owners(starts: Ints) -> Ints:
    """Of every row of a block the harmonic that it belongs to, counted from 1."""
    counts = np.diff(starts)
    return np.repeat(np.arange(1, len(starts)), counts)


def statement(expression: str, name: str, indent: int = 0) -> str:
    """One statement, continued in further lines; broken between operators."""
    spaced = re.sub(r"(\.[*/])", r" \1 ", expression)
    lines = textwrap.wrap(
        f"{name} = {spaced};",
        WIDTH,
        break_long_words=False,
        break_on_hyphens=False,
    )
    margin = " " * indent
    return margin + f" ...\n{margin}{INDENT}".join(lines)


class _Printer(OctaveCodePrinter):  # type: ignore[misc]
    """A Float is the double next to it, a Rational a quotient of doubles."""

    def _print_Float(self, value: sympy.Float) -> str:
        return repr(float(value))

    def _print_Rational(self, value: sympy.Rational) -> str:
        return f"({value.p}/{value.q})"


def _torus(program: TorusProgram) -> Words:
    return {"turns": turns(program.frequencies), "times": BLOCK}


def _series(program: SeriesProgram) -> Words:
    tables = program.tables
    return {
        "inverse": inverse_turn(),
        "times": BLOCK if tables else STRAIGHT_BLOCK,
        "corrected": tables is not None and len(tables.frequency_powers) > 0,
    }


RESERVED = """
    catch classdef elseif end_try_catch end_unwind_protect endarguments endclassdef endenumeration
    endevents endfor endfunction endif endmethods endparfor endproperties endspmd endswitch endwhile
    global otherwise parfor persistent spmd try until unwind_protect unwind_protect_cleanup
    arguments enumeration events methods properties import
    abs any cell cos error find fprintf full imag isa ischar isempty isnan isnumeric isreal max min
    nargin nargout numel ones pi prod reshape round sin size sparse sprintf sqrt sscanf strcmp sum
    unique vertcat zeros ans eps exp inf nan i j e clear disp eval exit feval help isargout load log
    path plot quit save test version who whos
"""

OCTAVE = Language(
    extension="m",
    templates="m",
    filters={
        "cells": cells,
        "chunks": chunks,
        "code": _Printer().doprint,
        "comment": comment,
        "doubles": doubles,
        "of_each": of_each,
        "owners": owners,
        "statement": statement,
        "vector": vector,
    },
    torus_words=_torus,
    series_words=_series,
    reserved=frozenset(RESERVED.split()),
)
