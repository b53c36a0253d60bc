"""A series with free amplitudes as one module of Fortran 2008 that needs nothing but a compiler.

Statements become those of SymPy's printer: coefficients once a call, waves and their sums once a time. Tables are summed over
the powers of the amplitudes once a call; the times then go through the kernel of a torus.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from string import Template
from typing import Any

import mpmath
import sympy
from sympy.printing.fortran import FCodePrinter
from sympy.printing.precedence import precedence

from symfpu.codegen.languages import fortran_series_text as text
from symfpu.codegen.languages.fortran import (
    PARITIES,
    TILE,
    TIMES,
    WIDTH,
    WORK_DIGITS,
    add_harmonics,
    data,
    fact_lines,
    literal,
    module_name,
)
from symfpu.codegen.languages.fortran import split as split_in_three
from symfpu.codegen.languages.fortran_text import ANGLES, CHECKS, DEVIATION, END, EVALUATE, HARMONICS
from symfpu.codegen.series_program import SeriesBlock, SeriesCheck, SeriesProgram, SeriesTables
from symfpu.codegen.straight_line import Statement, StraightLine
from symfpu.codegen.torus_program import TOLERANCE

EXTENSION = "F90"

SELF_TEST = text.SELF_TEST_HEAD + DEVIATION + text.SELF_TEST_END
STRAIGHT = text.STRAIGHT_HEAD + CHECKS + text.STRAIGHT_LOOP
TERMS = 100  # of a sum in one statement
EXACT = 2**53  # integers below are doubles
BREAKS = re.compile(r"(?<=[ (])|(?<=[^*]\*)(?!\*)|(?<=/)")  # where a line may end: after a blank, a bracket, one star, a slash


def emit_series(program: SeriesProgram) -> str:
    """The Fortran source of a series: Q(t; A), P(t; A), omega(A) and its Jacobian, with adjustable phases and frequencies.

    Deterministic: the same program gives the same bytes. program.name becomes the module; its procedures are positions,
    momenta, orbit and corrected_frequencies, to be renamed on use where two modules meet. The macro NAME_SELF_TEST, in
    capitals, adds a main program. Raises InputError for a name that the module needs itself.
    """
    words = _words(program) | _form_words(program)
    parts = (
        text.MODULE,
        "$tables",
        text.FUNCTIONS,
        STRAIGHT if program.straight else EVALUATE,
        ANGLES,
        text.TURNS,
        "$kernel",
        END,
        SELF_TEST,
    )
    code = _filled("".join(parts), words).replace("@DATA@\n", _check_tables(program.check))
    name = module_name(program.name, code)
    whole = _filled(text.HEADER, words) + code
    return Template(whole).substitute(name=name, macro=f"{name.upper()}_SELF_TEST").replace("@FACTS@", fact_lines(program.facts))


def _filled(template: str, words: dict[str, Any]) -> str:
    """Words are filled in twice, as some contain others; the name of the module stays open."""
    named = {"name": "${name}", "macro": "${macro}"}
    return Template(Template(template).safe_substitute(words | named)).substitute(words | named)


def _words(program: SeriesProgram) -> dict[str, Any]:
    with mpmath.workdps(WORK_DIGITS):
        radian = ", ".join(map(literal, split_in_three(1 / (2 * mpmath.pi))))
    universal = program.universal
    return {
        "modes": program.N - 1,
        "seeds": len(program.seeds),
        "radian": radian,
        "tolerance": literal(TOLERANCE),
        "checks": len(program.check.times),
        "arguments": "amplitudes, phases, frequencies",
        "before": "frequencies, " if universal else "",
        "after": "" if universal else ", frequencies",
        "optional": "" if universal else ", optional",
        "given": ", frequencies(:)" if universal else "",
        "given_check": text.GIVEN_CHECK if universal else "",
        "of": "A, omega" if universal else "A",
        "rounded": "" if universal else text.ROUNDED,
        "fixed": ", frequencies kept" if universal else "",
        "examples": text.UNIVERSAL_EXAMPLES if universal else text.NUMERIC_EXAMPLES,
        "frequencies": text.UNIVERSAL_FREQUENCIES if universal else text.NUMERIC_FREQUENCIES,
        "start": text.FREQUENCIES[universal] + text.TURNING + ("" if program.straight else text.TABLE_START),
    }


def _form_words(program: SeriesProgram) -> dict[str, Any]:
    if program.straight is not None:
        return _straight_words(program.straight, program.seeds)
    assert program.tables is not None
    return _table_words(program.tables)


def _straight_words(straight: StraightLine, seeds: Sequence[int]) -> dict[str, Any]:
    coefficients = [*_inputs(seeds, straight.coefficients), *straight.coefficients]
    angles = [f"      theta{q} = angle(t(k), phi({i}), turns(:, {i}))" for i, q in enumerate(seeds, 1)]
    names = [*(name for name, _ in coefficients), *(f"theta{q}" for q in seeds), *(name for name, _ in straight.waves)]
    constants = [f"  real(rk), parameter :: {name} = {literal(value)}\n" for name, (value, _) in straight.constants.items()]
    return {
        "form": text.STRAIGHT_FORM,
        "tables": "".join(constants),
        "kernel": "",
        "declarations": _declarations(names),
        "coefficients": _assignments("    ", coefficients),
        "waves": "\n".join((*angles, _assignments("      ", straight.waves))),
        "positions": _assignments("        ", ((f"Q({q}, k)", e) for q, e in enumerate(straight.positions, 1))),
        "momenta": _assignments("        ", ((f"P({q}, k)", e) for q, e in enumerate(straight.momenta, 1))),
        **_straight_frequencies(straight, seeds),
    }


def _straight_frequencies(straight: StraightLine, seeds: Sequence[int]) -> dict[str, Any]:
    omega = [(f"omega({i})", e) for i, e in enumerate(straight.corrected, 1)]
    slopes = [(f"jacobian({i}, {j})", e) for i, row in enumerate(straight.jacobian, 1) for j, e in enumerate(row, 1)]
    inputs = _inputs(seeds, (*straight.frequency_statements, *omega, *slopes), "frequencies")
    statements = [*inputs, *straight.frequency_statements]
    body = f"{_assignments('    ', (*statements, *omega))}\n    if (present(jacobian)) then\n{_assignments('      ', slopes)}\n    end if"
    return {"locals": _declarations([name for name, _ in statements]), "corrected": body}


def _inputs(seeds: Sequence[int], statements: Iterable[Statement], frequencies: str = "omega") -> list[Statement]:
    """Amplitudes and frequencies under the names that the statements have for them, as far as they need them."""
    used = {str(symbol) for _, e in statements for symbol in e.free_symbols}
    given = [
        (f"{short}{q}", f"{array}({i})") for short, array in (("A", "amplitudes"), ("omega", frequencies)) for i, q in enumerate(seeds, 1)
    ]
    return [(name, sympy.Symbol(element)) for name, element in given if name in used]


def _declarations(names: Sequence[str]) -> str:
    lines = textwrap.wrap(", ".join(names), WIDTH - 20)
    return "\n".join(f"    real(rk) :: {line.removesuffix(',')}" for line in lines)


def _assignments(indent: str, statements: Iterable[Statement]) -> str:
    printer = _Printer({"standard": 2008, "source_format": "free", "name_mangling": False})
    return "\n".join(indent + line for name, e in statements for line in _assignment(printer, name, e))


def _assignment(printer: FCodePrinter, name: str, expression: sympy.Expr) -> list[str]:
    """Statements name = expression; a long sum takes several."""
    terms = expression.as_ordered_terms()
    lines = []
    for first in range(0, len(terms), TERMS):
        value = printer.doprint(sympy.Add(*terms[first : first + TERMS]))
        if first:
            value = f"{name} - {value[1:]}" if value.startswith("-") else f"{name} + {value}"
        lines += _wrapped(f"{name} = {value}")
    return lines


def _wrapped(statement: str) -> list[str]:
    lines, line = [], ""
    for piece in BREAKS.split(statement):
        if len(line) + len(piece) > WIDTH - 14:
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
        if max(abs(number.p), number.q) > EXACT:
            return literal(float(number))
        return f"{literal(float(number.p))}/{literal(float(number.q))}"

    def _print_Pow(self, power: sympy.Pow) -> str:
        base, exponent = power.as_base_exp()
        n = int(exponent)
        factor = self.parenthesize(base, precedence(power), strict=False)
        written = factor if abs(n) == 1 else f"{factor}**{abs(n)}"
        return written if n > 0 else f"1d0/{written}"


def _table_words(tables: SeriesTables) -> dict[str, Any]:
    even_powers = 2 * tables.frequency_powers
    parities = [PARITIES[block.modes[0] % 2] for block in tables.blocks]
    return {
        "form": text.TABLE_FORM,
        "coefficients": tables.coefficient_count,
        "highest": max(2, *tables.highest),  # compilers warn of a loop from 2 to 1
        "degree": max(2, tables.powers.max(), even_powers.max(initial=0)),
        "monomials": len(tables.powers),
        "corrections": max(1, len(even_powers)),
        "times": TIMES,
        "tile": TILE,
        "tables": "".join((text.TABLE_SIZES, _amplitude_tables(tables), *map(_block_tables, tables.blocks))),
        "kernel": text.POWERS + HARMONICS,
        "declarations": text.TABLE_DECLARATIONS,
        "arrays": "\n".join(f"    real(rk), allocatable :: c_{p}(:, :), rates_{p}(:)" for p in parities),
        "collapses": "\n".join(map(_collapse, tables.blocks)),
        "calls": "\n".join(add_harmonics(b.modes, f"nu_{p}, rates_{p}, c_{p}") for b, p in zip(tables.blocks, parities, strict=True)),
        "locals": text.CORRECTED_LOCALS,
        "corrected": text.CORRECTED,
    }


def _collapse(block: SeriesBlock) -> str:
    parity = PARITIES[block.modes[0] % 2]
    return (
        f"    allocate (c_{parity}({len(block.harmonics)}, {len(block.modes)}), rates_{parity}({len(block.harmonics)}))\n"
        f"    call collapse(monomial, starts_{parity}, which_{parity}, a_{parity}, nu_{parity}, omega, c_{parity}, rates_{parity})"
    )


def _amplitude_tables(tables: SeriesTables) -> str:
    """Scales, exponents, and the frequencies; a correction of zero where there is none, as Fortran wants a table to have a row."""
    seeds = len(tables.scales)
    even_powers, corrections = (2 * tables.frequency_powers).tolist(), tables.frequency_coefficients.tolist()
    return "".join(
        (
            "\n  ! x = scales A; exponents of x in the coefficients of harmonics;\n",
            "  ! omega(A) = linear + sum over f of correction(f, :) x^even_powers(f, :)\n",
            "  integer, save :: exponents(monomials, seeds), even_powers(corrections, seeds)\n",
            "  real(rk), save :: scales(seeds), linear(seeds), correction(corrections, seeds)\n",
            data("scales", "i", map(float, tables.scales), 1),
            data("linear", "i", map(float, tables.linear), 1),
            _columns("exponents", tables.powers.tolist()),
            _columns("even_powers", even_powers or [[0] * seeds]),
            _columns("correction", [[*map(float, row)] for row in corrections] or [[0.0] * seeds]),
        )
    )


def _block_tables(block: SeriesBlock) -> str:
    parity = PARITIES[block.modes[0] % 2]
    (count, _), (rows, modes) = block.harmonics.shape, block.coefficients.shape
    return "".join(
        (
            f"\n  ! Harmonics of the {parity} modes: nu; their first rows in a, and the end; monomial of every row; coefficients\n",
            f"  integer, save :: nu_{parity}({count}, seeds), starts_{parity}({count + 1}), which_{parity}({rows})\n",
            f"  real(rk), save :: a_{parity}({rows}, {modes})\n",
            _columns(f"nu_{parity}", block.harmonics.tolist()),
            data(f"starts_{parity}", "i", (block.starts + 1).tolist(), 1),
            data(f"which_{parity}", "i", (block.powers + 1).tolist(), 1),
            _columns(f"a_{parity}", [[*map(float, row)] for row in block.coefficients]),
        )
    )


def _columns(name: str, rows: Sequence[Sequence[Any]]) -> str:
    return "".join(data(name, f"i, {j}", column, 1) for j, column in enumerate(zip(*rows, strict=True), 1))


def _check_tables(check: SeriesCheck) -> str:
    vectors = {
        "t": check.times,
        "amplitudes": check.amplitudes,
        "phases": check.phases,
        "frequencies": check.frequencies,
        "exact_omega": check.corrected,
    }
    return "".join(
        (
            *(data(name, "i", map(float, values), 1) for name, values in vectors.items()),
            *(data("positions_of_t", f"i, {k}", map(float, row), 1) for k, row in enumerate(check.positions, 1)),
            *(data("momenta_of_t", f"i, {k}", map(float, row), 1) for k, row in enumerate(check.momenta, 1)),
            *(data("exact_slopes", f"{k}, i", map(float, row), 1) for k, row in enumerate(check.jacobian, 1)),
        )
    )
