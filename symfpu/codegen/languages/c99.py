"""A torus as one C99 file that needs nothing but the standard library.

Sixteen times go together. Powers of e^(i theta) of every seed are tabled, a harmonic costs one complex product with its
neighbour's leading factors, and what remains is two matrix products a parity block, done in tiles of four modes by two vectors.
Vectors are those of GCC and Clang, as wide as the machine that is compiled for; other compilers get plain doubles.
Half of this file is the C text itself, kept beside the Python that fills it.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from string import Template
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import linear_frequencies
from symfpu.codegen.languages.c99_text import DECLARATIONS, DEVIATION, FUNCTIONS, HEADER, KERNEL, LOOP, SELF_TEST
from symfpu.codegen.torus_program import SPLIT_DIGITS, TOLERANCE, Block, Check, TorusProgram, turns

EXTENSION = "c"

WIDTH = 116  # columns of a line
TIMES = 16  # evaluated together: two vectors of AVX-512
CHUNK = 32  # harmonics between two accumulations: cosines and sines of 16 times are 8 kB
TILE = 4  # modes of a register tile


def emit_torus(program: TorusProgram) -> str:
    """The C99 source of a torus: Q(t), P(t), E_q(t) and H(t) for arrays of times, with adjustable phases.

    Deterministic: the same program gives the same bytes. program.name must be an identifier that C leaves to the user, which
    whoever makes the program checks; it begins all external names (name_positions, name_momenta, name_orbit,
    name_harmonic_energies, name_energy) and the macro name_SELF_TEST that adds a main.
    """
    if not program.blocks:
        program = replace(program, blocks=(_silent(program),))
    blocks = program.blocks
    rows = sum(padded(block.modes) for block in blocks)
    powers = sum(2 * n + 1 for n in program.highest)
    words = {
        "name": program.name,
        "bonds": program.N,
        "modes": program.N - 1,
        "seeds": len(program.seeds),
        "rows": rows,
        "powers": powers,
        "times": TIMES,
        "chunk": CHUNK,
        "tile": TILE,
        "tolerance": TOLERANCE,
        "stack": 8 * TIMES * (2 * (rows + 1) + 2 * (powers + len(program.seeds)) + 2 * CHUNK + 2 * program.N),
        "given": "",
        "loop": Template(LOOP).substitute(passed=""),
        "calls": _calls(blocks),
    }
    parts = (DECLARATIONS, KERNEL, FUNCTIONS)
    declarations, kernel, functions = (Template(part).substitute(words) for part in parts)
    test = Template(SELF_TEST).substitute(words, tables=_check_tables(program.check), deviation=DEVIATION, checks=len(program.check.times))
    return "".join((_header(program, words), declarations, _tables(program, blocks), kernel, functions, test))


def _silent(program: TorusProgram) -> Block:
    """What stands for a torus without a coefficient."""
    return Block((1,), np.zeros((1, len(program.seeds)), dtype=np.int64), np.zeros((1, 1)))


def padded(modes: Sequence[int]) -> int:
    """Sums of a block: its modes, filled up to whole tiles."""
    return -(-len(modes) // TILE) * TILE


def _calls(blocks: Sequence[Block]) -> str:
    lines, row = [], 0
    for k, block in enumerate(blocks):
        where = f"q + {row} * TIMES, p ? p + {row} * TIMES : NULL"
        lines.append(f"    add_block({len(block.harmonics)}, {padded(block.modes)}, &harmonics_{k}[0][0], rates_{k},")
        lines.append(f"              &coefficients_{k}[0][0], powers, {where});")
        row += padded(block.modes)
    return "\n".join(lines)


def _header(program: TorusProgram, words: dict[str, Any]) -> str:
    default = ", ".join(repr(float(x)) for x in program.phases)
    return Template(HEADER).substitute(words, facts=fact_lines(program.facts), default=default)


def fact_lines(facts: Mapping[str, str]) -> str:
    """Facts as lines of a comment, which they cannot end."""
    lines: list[str] = []
    for key, value in facts.items():
        text = f"{key}: {value}".replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?")
        lines += textwrap.wrap(text, WIDTH - 4, initial_indent="  ", subsequent_indent="      ", break_on_hyphens=False)
    return "\n".join(f" *{line}" for line in lines)


def _tables(program: TorusProgram, blocks: Sequence[Block]) -> str:
    """All numbers of the torus and of its chain, the rates nu.omega correctly rounded."""
    N, highest = program.N, program.highest
    starts = np.cumsum([0, *(2 * n + 1 for n in highest)])
    high, low = zip(*turns(program), strict=True)
    with mpmath.workdps(SPLIT_DIGITS):
        cosines = [float(mpmath.cospi(mpmath.mpf(k) / (2 * N))) for k in range(4 * N)]
        norm = float(mpmath.sqrt(mpmath.mpf(2) / N))
    parts = [
        "\n/* Turns per time omega / (2 pi) of every seed, as sums of two doubles. */\n",
        vector("turns", high),
        vector("turns_low", low),
        vector("default_phases", map(float, program.phases)),
        vector("highest", highest, "int"),
        vector("zeroth", (int(a) + n for a, n in zip(starts, highest, strict=False)), "int"),
        "\n/* Row of every mode among the sums; the last row is zero. */\n",
        vector("row", mode_rows(N, [block.modes for block in blocks]), "int"),
        "\n/* Linear frequencies Omega_q, cos(k pi / 2N), sqrt(2/N), and the couplings alpha/3 and beta/4. */\n",
        vector("linear", linear_frequencies(N).tolist()),
        vector("cosines", cosines),
        f"static const double norm = {norm!r};\n",
        f"static const double cubic = {float(program.alpha / 3)!r};\n",
        f"static const double quartic = {float(program.beta / 4)!r};\n",
    ]
    for k, block in enumerate(blocks):
        rates = [float(sum(int(n) * w for n, w in zip(nu, program.frequencies, strict=True))) for nu in block.harmonics]
        parts.append(f"\n/* Modes {', '.join(map(str, block.modes[:3]))}{', ...' if len(block.modes) > 3 else ''}: ")
        parts.append("harmonics nu, rates nu.omega, and coefficients of cos(nu.theta) in every mode. */\n")
        parts.append(matrix(f"harmonics_{k}", block.harmonics.tolist(), len(program.seeds), "short"))
        parts.append(vector(f"rates_{k}", rates))
        parts.append(matrix(f"coefficients_{k}", ([float(c) for c in row] for row in block.coefficients), padded(block.modes)))
    return "".join(parts)


def mode_rows(N: int, blocks: Sequence[tuple[int, ...]]) -> list[int]:
    """Row of every mode among the sums of blocks with these modes; the row after the last for a mode of none."""
    row: dict[int, int] = {}
    start = 0
    for modes in blocks:
        row |= {q: start + i for i, q in enumerate(modes)}
        start += padded(modes)
    return [row.get(q, start) for q in range(1, N)]


def vector(name: str, values: Iterable[Any], kind: str = "double") -> str:
    numbers = [_literal(x) for x in values]
    return f"static const {kind} {name}[{len(numbers)}] = {{\n{wrapped(numbers)}\n}};\n"


def matrix(name: str, rows: Iterable[list[Any]], width: int, kind: str = "double") -> str:
    """Rows shorter than the width end in zeros, by the rules of C."""
    texts = ["{" + ",".join(map(_literal, row)) + "}" for row in rows]
    return f"static const {kind} {name}[{len(texts)}][{width}] = {{\n{wrapped(texts)}\n}};\n"


def _literal(value: Any) -> str:
    return repr(value) if value else "0"


def wrapped(items: Sequence[str]) -> str:
    """Items with commas between them, in lines of at most WIDTH columns broken at commas."""
    lines, line = [], ""
    for piece in ",".join(items).split(","):
        if len(line) + len(piece) + 1 > WIDTH:
            lines.append(line)
            line = ""
        line += piece + ","
    return "\n".join([*lines, line[:-1]])


def text_matrix(name: str, rows: Sequence[Sequence[str]]) -> str:
    """Numbers given as decimal text."""
    return matrix(name, ([float(x) for x in row] for row in rows), len(rows[0]))


def _check_tables(check: Check) -> str:
    return "".join(
        (
            vector("test_times", map(float, check.times)),
            text_matrix("test_positions", check.positions),
            text_matrix("test_momenta", check.momenta),
            vector("test_energies", map(float, check.energies)),
        )
    )
