"""A series with free amplitudes as one C99 file: Q and P at any amplitudes, phases and frequencies, omega(A) and its Jacobian.

Small series are statements: those of the amplitudes run once a call, those of the angles once a time. Large ones are tables:
the powers of the amplitudes are summed once a call, and what is left is a torus and runs through its kernel.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from string import Template
from typing import Any

import numpy as np
import sympy
from sympy.printing.c import C99CodePrinter

from symfpu.codegen.languages.c99 import CHUNK, TILE, TIMES, WIDTH, fact_lines, matrix, mode_rows, padded, text_matrix, vector
from symfpu.codegen.languages.c99_series_text import (
    COLLAPSE,
    DECLARATIONS,
    GIVEN,
    GIVEN_FREQUENCIES,
    HEADER,
    OWN_DEFAULT,
    OWN_FREQUENCIES,
    REQUIRED,
    RETURNS,
    SELF_TEST,
    SHORTCUTS,
    STRAIGHT,
    STRAIGHT_MEMORY,
    TABLE_FUNCTIONS,
    TABLE_MEMORY,
)
from symfpu.codegen.languages.c99_text import DEVIATION, KERNEL, LOOP
from symfpu.codegen.series_program import SeriesBlock, SeriesCheck, SeriesProgram, SeriesTables
from symfpu.codegen.straight_line import Statement, StraightLine
from symfpu.codegen.torus_program import TOLERANCE

EXTENSION = "c"

PRODUCT = 4  # highest power written as a product
EXACT = 2**53  # integers below are exact in doubles
INT = 2**31


def emit_series(program: SeriesProgram) -> str:
    """The C99 source of a series: orbit, positions and momenta for arrays of times, and the corrected frequencies.

    Deterministic: the same program gives the same bytes. program.name must be an identifier that C leaves to the user, which
    whoever makes the program checks; it begins all external names and the macro name_SELF_TEST that adds a main.
    """
    words = {
        "name": program.name,
        "modes": program.N - 1,
        "seeds": len(program.seeds),
        "tolerance": TOLERANCE,
        "divisors": "const double *frequencies, " if program.universal else "",
        "test_divisors": "test_frequencies, " if program.universal else "",
    }
    words |= _form(program)
    body = _tabled(program.N, program.tables, words) if program.tables else _straight(program, words)
    test = {"tables": _check_tables(program.check), "deviation": DEVIATION, "checks": len(program.check.times)}
    return "".join(
        (
            Template(HEADER).substitute(words, facts=fact_lines(program.facts)),
            Template(DECLARATIONS).substitute(words),
            body,
            Template(SHORTCUTS).substitute(words),
            Template(SELF_TEST).substitute(words, **test),
        )
    )


def _form(program: SeriesProgram) -> dict[str, str]:
    """What header and declarations say of the form: frequencies, return codes, memory, and the constants of the file."""
    if program.tables is None:
        frequencies, form = (GIVEN_FREQUENCIES, "universal") if program.universal else (OWN_FREQUENCIES, "straight")
        numbers = f"MODES = {program.N - 1}, SEEDS = {len(program.seeds)}"
        return {"frequencies": frequencies, "returns": RETURNS[form], "memory": STRAIGHT_MEMORY, "numbers": numbers}
    assert not program.universal
    sizes = _sizes(program.N, program.tables)
    memory = Template(TABLE_MEMORY).substitute(work=sizes["WORK"], stack=_stack(sizes))
    return {"frequencies": OWN_FREQUENCIES, "returns": RETURNS["tables"], "memory": memory, "numbers": _enumeration(sizes)}


class _Printer(C99CodePrinter):  # type: ignore[misc]
    """Numbers as the nearest doubles, quotients of integers as doubles, small powers as products."""

    def _print_Float(self, expr: sympy.Float) -> str:
        return repr(float(expr))

    def _print_Integer(self, expr: sympy.Integer) -> str:
        return str(int(expr)) if abs(int(expr)) < INT else repr(float(int(expr)))

    def _print_Rational(self, expr: sympy.Rational) -> str:
        p, q = int(expr.p), int(expr.q)
        return f"{p}.0/{q}.0" if max(abs(p), q) <= EXACT else repr(p / q)

    def _print_Pow(self, expr: sympy.Pow) -> str:
        if not expr.exp.is_Integer or not 1 < abs(int(expr.exp)) <= PRODUCT:
            return str(super()._print_Pow(expr))
        base = self._print(expr.base) if expr.base.is_Symbol else f"({self._print(expr.base)})"
        product = f"({'*'.join([base] * abs(int(expr.exp)))})"
        return product if int(expr.exp) > 0 else f"(1.0/{product})"


def _straight(program: SeriesProgram, words: dict[str, Any]) -> str:
    straight, seeds, write = program.straight, program.seeds, _Printer().doprint
    assert straight is not None
    slopes = [x for row in straight.jacobian for x in row]
    used = _symbols((*straight.frequency_statements, *(("", x) for x in (*straight.corrected, *slopes))))
    correction = [
        *_given("A", seeds, "amplitudes", used),
        *(_given("omega", seeds, "frequencies", used) if program.universal else []),
        *_statements(straight.frequency_statements, write),
        *(f"omega[{i}] = {write(x)};" for i, x in enumerate(straight.corrected)),
    ]
    used = _symbols((*straight.coefficients, *(("", x) for x in (*straight.positions, *straight.momenta))))
    coefficients = [
        *(f"const double phase{q} = phases ? phases[{i}] : 0;" for i, q in enumerate(seeds)),
        *_given("A", seeds, "amplitudes", used),
        *_given("omega", seeds, "frequencies", used),
        *_statements(straight.coefficients, write),
    ]
    angles = (f"const double theta{q} = angle(t[i], turns[{i}], turns_low[{i}], phase{q});" for i, q in enumerate(seeds))
    return Template(STRAIGHT).substitute(
        words,
        constants=_constants(straight),
        correction=_lines(correction, 1),
        jacobian=_lines((f"jacobian[{i}] = {write(x)};" for i, x in enumerate(slopes)), 2),
        own="" if program.universal else "corrected[SEEDS], ",
        default=REQUIRED if program.universal else Template(OWN_DEFAULT).substitute(words),
        coefficients=_lines(coefficients, 1),
        waves=_lines((*angles, *_statements(straight.waves, write)), 2),
        positions=_lines((f"q[{m}] = {write(x)};" for m, x in enumerate(straight.positions)), 3),
        momenta=_lines((f"p[{m}] = {write(x)};" for m, x in enumerate(straight.momenta)), 3),
    )


def _symbols(statements: Iterable[Statement]) -> set[str]:
    return {str(x) for _, e in statements for x in e.free_symbols}


def _given(letter: str, seeds: Sequence[int], array: str, used: set[str]) -> list[str]:
    """The entries of a parameter under the names that statements have for them, or what says that none is needed."""
    lines = [f"const double {letter}{q} = {array}[{i}];" for i, q in enumerate(seeds) if f"{letter}{q}" in used]
    return lines or [f"(void){array};"]


def _statements(statements: Iterable[Statement], write: Any) -> list[str]:
    return [f"const double {name} = {write(e)};" for name, e in statements]


def _constants(straight: StraightLine) -> str:
    results = (*straight.corrected, *(x for row in straight.jacobian for x in row))
    used = _symbols((*straight.coefficients, *straight.frequency_statements, *(("", x) for x in results)))
    lines = [f"static const double {name} = {float(value)!r};\n" for name, (value, _) in straight.constants.items() if name in used]
    return "/* Linear frequencies Omega_q, and the small parameter. */\n" * bool(lines) + "".join(lines)


def _lines(statements: Iterable[str], depth: int) -> str:
    """Statements in lines of at most WIDTH columns, broken after an operator or a blank."""
    lines = []
    for statement in statements:
        line = "    " * depth
        for piece in re.findall(r"[^ */]+[ */]*", statement):
            if len(line) + len(piece.rstrip()) > WIDTH:
                lines.append(line.rstrip())
                line = "    " * (depth + 1)
            line += piece
        lines.append(line.rstrip())
    return "\n".join(lines)


def _sizes(N: int, tables: SeriesTables) -> dict[str, int]:
    """The constants of the file; WORK is what a call allocates."""
    kept = sum(len(block.harmonics) * (1 + padded(block.modes)) for block in tables.blocks)
    return {
        "MODES": N - 1,
        "SEEDS": len(tables.scales),
        "ROWS": sum(padded(block.modes) for block in tables.blocks),
        "POWERS": sum(2 * n + 1 for n in tables.highest),
        "TIMES": TIMES,
        "CHUNK": CHUNK,
        "AMPLITUDE_POWERS": sum(n + 1 for n in _degrees(tables)),
        "MONOMIALS": len(tables.powers),
        "TERMS": max(1, len(tables.frequency_powers)),
        "WORK": kept + len(tables.powers),
    }


def _enumeration(sizes: dict[str, int]) -> str:
    items = [f"{name} = {size}" for name, size in sizes.items()]
    return f"{', '.join(items[:6])},\n       {', '.join(items[6:])}"


def _stack(sizes: dict[str, int]) -> int:
    waves = 2 * (sizes["ROWS"] + 1) + 2 * (sizes["POWERS"] + sizes["SEEDS"]) + 2 * CHUNK
    return 8 * (TIMES * waves + sizes["AMPLITUDE_POWERS"])


def _degrees(tables: SeriesTables) -> list[int]:
    """Highest power of every amplitude."""
    highest = np.concatenate([tables.powers, 2 * tables.frequency_powers]).max(axis=0)
    return [int(n) for n in highest]


def _tabled(N: int, tables: SeriesTables, words: dict[str, Any]) -> str:
    collapses, calls, row, start = [], [], 0, 0
    for k, block in enumerate(tables.blocks):
        count, width = len(block.harmonics), padded(block.modes)
        collapses.append(f"    collapse_block({count}, {len(block.modes)}, {width}, &harmonics_{k}[0][0], starts_{k}, powers_{k},")
        collapses.append(f"                   &coefficients_{k}[0][0], monomials, omega, work + {start});")
        calls.append(f"    add_block({count}, {width}, &harmonics_{k}[0][0], work + {start}, work + {start + count}, powers,")
        calls.append(f"              q + {row} * TIMES, p ? p + {row} * TIMES : NULL);")
        row, start = row + width, start + count * (1 + width)
    default = Template(OWN_DEFAULT).substitute(words)
    loop = Template(LOOP).substitute(passed="turns, turns_low, work, ")
    return "".join(
        (
            _numbers(N, tables),
            Template(KERNEL).substitute(words, tile=TILE, given=GIVEN, calls="\n".join(calls)),
            Template(COLLAPSE).substitute(collapses="\n".join(collapses)),
            Template(TABLE_FUNCTIONS).substitute(words, loop=loop, default=default),
        )
    )


def _numbers(N: int, tables: SeriesTables) -> str:
    """All numbers of the series; where its frequencies have no correction, one of zero."""
    s, degrees, highest = len(tables.scales), _degrees(tables), tables.highest
    zeroth = np.cumsum([0, *(2 * n + 1 for n in highest)])[:-1] + highest
    place = np.cumsum([0, *(n + 1 for n in degrees)])[:-1]
    silent = not len(tables.frequency_powers)
    parts = [
        "\n",
        vector("default_phases", [0.0] * s),
        vector("highest", highest, "int"),
        vector("zeroth", map(int, zeroth), "int"),
        "\n/* Row of every mode among the sums; the last row is zero. */\n",
        vector("row", mode_rows(N, [block.modes for block in tables.blocks]), "int"),
        "\n/* Scales of the amplitudes x_i = scale_i A_i, their highest powers, and the powers that are needed together. */\n",
        vector("scales", map(float, tables.scales)),
        vector("degrees", degrees, "int"),
        vector("place", map(int, place), "int"),
        matrix("exponents", tables.powers.tolist(), s, "short"),
        "\n/* omega_i(A) = linear_i + sum of coefficients times powers of x^2. */\n",
        vector("linear", map(float, tables.linear)),
        matrix("frequency_exponents", [[0] * s] if silent else tables.frequency_powers.tolist(), s, "short"),
        matrix("frequency_coefficients", [[0.0] * s] if silent else _doubles(tables.frequency_coefficients), s),
    ]
    return "".join((*parts, *(_block(k, block) for k, block in enumerate(tables.blocks))))


def _block(k: int, block: SeriesBlock) -> str:
    some = ", ".join(map(str, block.modes[:3])) + (", ..." if len(block.modes) > 3 else "")
    parts = (
        f"\n/* Modes {some}: harmonics nu, the first row of each, powers and coefficients of the rows in every mode. */\n",
        matrix(f"harmonics_{k}", block.harmonics.tolist(), block.harmonics.shape[1], "short"),
        vector(f"starts_{k}", block.starts.tolist(), "int"),
        vector(f"powers_{k}", block.powers.tolist(), "int"),
        matrix(f"coefficients_{k}", _doubles(block.coefficients), len(block.modes)),
    )
    return "".join(parts)


def _doubles(rows: Any) -> list[list[float]]:
    return [[float(x) for x in row] for row in rows]


def _check_tables(check: SeriesCheck) -> str:
    return "".join(
        (
            vector("test_times", map(float, check.times)),
            vector("test_amplitudes", map(float, check.amplitudes)),
            vector("test_phases", map(float, check.phases)),
            vector("test_frequencies", map(float, check.frequencies)),
            text_matrix("test_positions", check.positions),
            text_matrix("test_momenta", check.momenta),
            vector("test_corrected", map(float, check.corrected)),
            text_matrix("test_jacobian", check.jacobian),
        )
    )
