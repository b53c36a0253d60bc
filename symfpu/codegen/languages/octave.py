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
from symfpu.codegen.operation_tables import Operations
from symfpu.codegen.series_program import SeriesProgram
from symfpu.codegen.series_tables import SeriesBlock, SeriesTables
from symfpu.codegen.templating import Language, Words, double
from symfpu.codegen.torus_program import Block, TorusProgram

WIDTH = 100  # columns of a line of numbers or comments, before what begins and ends it
CHUNK = 200  # lines of text in one statement
INDENT = "    "
BLOCK = 128  # times evaluated together
STRAIGHT_BLOCK = 1024  # times together: statements are interpreted once for them all


def comment(text: str, indent: int) -> str:
    """Lines of a comment, whatever characters the text has."""
    encoded = text.encode("ascii", "backslashreplace")
    lines = textwrap.wrap(
        encoded.decode(),
        WIDTH,
        subsequent_indent=INDENT,
        break_on_hyphens=False,
    )
    start = "%" + indent * " "
    return "\n".join(start + line for line in lines)


def doubles(values: Any) -> list[str]:
    """Numbers of an array, row by row, as text."""
    return [double(x) for x in np.ravel(values)]


def chunks(numbers: Any) -> list[list[str]]:
    """Lines of numbers, as many together as one statement has."""
    every = map(str, np.ravel(numbers))
    lines = _wrapped(" ".join(every))
    starts = range(0, len(lines), CHUNK)
    return [lines[i : i + CHUNK] for i in starts]


def vector(values: Iterable[Any]) -> str:
    """A short row of numbers, continued in further lines."""
    words = [str(x) if isinstance(x, int) else double(x) for x in values]
    lines = textwrap.wrap(", ".join(words), WIDTH - 20, break_on_hyphens=False)
    body = f" ...\n{2 * INDENT}".join(lines)
    return f"[{body}]"


def cells(items: Iterable[str]) -> str:
    """A cell array in a row."""
    body = f", ...\n{INDENT}".join(items)
    return f"{{{body}}}"


def of_each(blocks: Sequence[Block | SeriesBlock], pattern: str) -> list[str]:
    """A pattern filled in for every block: {k} from 1, {s} seeds, {modes} how many."""
    texts = []
    for k, block in enumerate(blocks, 1):
        s, modes = block.harmonics.shape[1], len(block.modes)
        texts.append(pattern.format(k=k, s=s, modes=modes))
    return texts


def owners(starts: Ints) -> Ints:
    """Of every row of a block the harmonic that it belongs to, counted from 1."""
    counts = np.diff(starts)
    return np.repeat(np.arange(1, len(starts)), counts)


def statement(expression: str, name: str, indent: int = 0) -> str:
    """One statement, continued in further lines; broken between operators."""
    spaced = re.sub(r"(\.[*/])", r" \1 ", expression)
    lines = _wrapped(f"{name} = {spaced};")
    margin = " " * indent
    body = f" ...\n{margin}{INDENT}".join(lines)
    return margin + body


def _wrapped(text: str) -> list[str]:
    """Lines broken at blanks only."""
    return textwrap.wrap(
        text,
        WIDTH,
        break_long_words=False,
        break_on_hyphens=False,
    )


class _Printer(OctaveCodePrinter):  # type: ignore[misc]
    """A Float is the double next to it, a Rational a quotient of doubles."""

    def _print_Float(self, value: sympy.Float) -> str:
        return repr(float(value))

    def _print_Rational(self, value: sympy.Rational) -> str:
        return f"({value.p}/{value.q})"


def _torus(program: TorusProgram) -> Words:
    return {"turns": turns(program.frequencies), "times": BLOCK}


def _series(program: SeriesProgram) -> Words:
    words: Words = {"inverse": inverse_turn(), "times": STRAIGHT_BLOCK}
    if program.tables:
        words["times"] = BLOCK
        words["corrected"] = len(program.tables.frequency_powers) > 0
    if program.tables and program.operations:
        words["node_tables"] = _node_tables(program.tables, program.operations)
    return words


def _node_tables(tables: SeriesTables, operations: Operations) -> dict[str, Ints]:
    """Integers of a universal series by the functions that return them; places count from 1."""
    found = {
        "multiplierModes": operations.modes,
        "multiplierHarmonics": operations.harmonics,
        "startTable": operations.starts + 1,
        "leftTable": operations.left + 1,
        "rightTable": operations.right + 1,
        "factorTable": operations.factor,
        "levelTable": operations.levels + 1,
        "exponentTable": tables.powers,
        "signTable": operations.signs,
    }
    for k, block in enumerate(tables.blocks, 1):
        found[f"harmonicTable{k}"] = block.harmonics
        found[f"ownerTable{k}"] = owners(block.starts)
        found[f"powerTable{k}"] = block.powers + 1
        found[f"nodeTable{k}"] = block.coefficients + 1
    if len(tables.frequency_powers):
        found["frequencyExponentTable"] = tables.frequency_powers
        found["frequencySigns"] = operations.frequency_signs
        found["frequencyNodes"] = tables.frequency_coefficients + 1
    return found


RESERVED_WORDS = """
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
    reserved=frozenset(RESERVED_WORDS.split()),
)
