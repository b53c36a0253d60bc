"""A torus as one module of Fortran 2008 that needs nothing but a compiler.

Blocks of times go together. Powers of e^(i theta) of every seed are tabled, a harmonic costs one complex product with the leading
factors of its neighbour, and what remains is two matrix products a parity, which `matmul` of the compiler's library does.
Tables are DATA statements in chunks: compilers read those in linear time, and constructors of this length not at all.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from string import Template
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import linear_frequencies
from symfpu.codegen.languages.fortran_text import ANGLES, END, EVALUATE, FUNCTIONS, HARMONICS, HEADER, MODULE, SELF_TEST
from symfpu.codegen.torus_program import TOLERANCE, Block, TorusProgram
from symfpu.errors import InputError

EXTENSION = "F90"  # the capital lets compilers run the preprocessor

WIDTH = 120  # columns of a line; the standard allows 132
LINES = 200  # of a DATA statement; the standard allows 255 continuations
TIMES = 64  # evaluated together
TILE = 256  # harmonics of one matrix product: cosines and sines of 64 times are 256 kB
WORD = 24  # bits of the leading parts of omega / 2 pi: their products with halves of a time are exact
WORK_DIGITS = 60
PARITIES = {0: "even", 1: "odd"}  # of the modes of a block
KERNEL = EVALUATE + ANGLES + HARMONICS + END


def emit_torus(program: TorusProgram) -> str:
    """The Fortran source of a torus: Q(t), P(t), E_q(t) and H(t) for arrays of times, with adjustable phases.

    Deterministic: the same program gives the same bytes. program.name becomes the module; its procedures are positions,
    momenta, orbit, harmonic_energies and energy, to be renamed on use where two modules meet. The macro NAME_SELF_TEST, in
    capitals, adds a main program. Raises InputError for a name that the module needs itself.
    """
    words = _words(program)
    parts = (MODULE, FUNCTIONS, KERNEL, SELF_TEST)
    module, functions, kernel, test = (Template(part).substitute(words) for part in parts)
    tables = "".join((_chain_tables(program), *(_block_tables(block, program.frequencies) for block in program.blocks)))
    test = test.replace("@DATA@\n", _check_tables(program))
    return "".join((_header(program, words), module, tables, functions, kernel, test))


def _words(program: TorusProgram) -> dict[str, Any]:
    return {
        "name": _module_name(program.name),
        "macro": f"{program.name.upper()}_SELF_TEST",
        "bonds": program.N,
        "modes": program.N - 1,
        "seeds": len(program.seeds),
        "highest": max(2, *program.highest),  # compilers warn of a loop from 2 to 1
        "times": TIMES,
        "tile": TILE,
        "tolerance": literal(TOLERANCE),
        "cubic": literal(float(program.alpha / 3)),
        "quartic": literal(float(program.beta / 4)),
        "checks": len(program.check.times),
        "arguments": "phases",
        "declarations": "    real(rk) :: phi(seeds)",
        "start": "    phi = default_phases",
        "calls": "\n".join(_call(block.modes) for block in program.blocks),
    }


def _module_name(name: str) -> str:
    tables = ["default_phases", *(f"{kind}_{parity}" for kind in ("nu", "rates", "c") for parity in PARITIES.values())]
    return module_name(name, " ".join((MODULE, FUNCTIONS, KERNEL, SELF_TEST, *tables)))


def module_name(name: str, code: str) -> str:
    """The name, if it can be that of a module with this code; InputError otherwise."""
    code = re.sub(r"'[^'\n]*'|!.*", "", code)
    own = set(re.findall(r"(?<![${\w])[a-z]\w*", code.lower()))
    if not re.fullmatch(r"[a-z][a-z0-9_]{0,49}", name.lower(), re.ASCII) or name.lower() in own:
        raise InputError("path", name, "a file name that is a Fortran identifier the module does not use itself", "rename the file")
    return name


def _call(modes: Sequence[int]) -> str:
    return add_harmonics(modes, "nu_{0}, rates_{0}, c_{0}".format(PARITIES[modes[0] % 2]))


def add_harmonics(modes: Sequence[int], tables: str) -> str:
    """The call that adds the harmonics of these modes, all those of one parity."""
    first = modes[0]
    return f"      call add_harmonics({tables}, re, im, &\n        cosine_sums(1:n, {first}::2), sine_sums(1:n, {first}::2), moving)"


def _header(program: TorusProgram, words: dict[str, Any]) -> str:
    phases = ", ".join(repr(float(x)) for x in program.phases)
    default = textwrap.fill(phases, WIDTH - 4, initial_indent="!     ", subsequent_indent="!     ")
    return Template(HEADER).substitute(words, facts=fact_lines(program.facts), default=default)


def fact_lines(facts: Mapping[str, str]) -> str:
    """The facts of a header as lines of comment."""
    lines = []
    for key, value in facts.items():
        text = " ".join(f"{key}: {value}".split()).encode("ascii", "backslashreplace").decode().replace("\\", "/")
        text = text.replace("*/", "* /").replace("/*", "/ *")  # the preprocessor takes these for comments of C
        lines += textwrap.wrap(text, WIDTH - 4, initial_indent="  ", subsequent_indent="      ", break_on_hyphens=False)
    return "\n".join(f"!{line}" for line in lines)


def _chain_tables(program: TorusProgram) -> str:
    """Frequencies in turns, phases, and what the energies need; correctly rounded."""
    with mpmath.workdps(WORK_DIGITS):
        turns = [split(mpmath.mpf(w.numerator) / w.denominator / (2 * mpmath.pi)) for w in program.frequencies]
        radian = split(1 / (2 * mpmath.pi))
        cosines = [float(mpmath.cospi(mpmath.mpf(k) / (2 * program.N))) for k in range(4 * program.N)]
        norm = float(mpmath.sqrt(mpmath.mpf(2) / program.N))
    seeds = range(1, len(turns) + 1)
    return "".join(
        (
            "\n  ! omega / (2 pi) of every seed and 1 / (2 pi), in three parts each, exact in doubles\n",
            f"  real(rk), save :: turns(3, seeds), radian(3), default_phases(seeds), norm, omega({program.N - 1})\n",
            f"  real(rk), save :: cosines(0:{4 * program.N - 1})\n",
            *(data("turns", f"i, {i}", parts, 1) for i, parts in zip(seeds, turns, strict=True)),
            data("radian", "i", radian, 1),
            data("default_phases", "i", map(float, program.phases), 1),
            "  ! sqrt(2/N), linear frequencies Omega_q, cos(k pi / 2N)\n",
            f"  data norm / {literal(norm)} /\n",
            data("omega", "i", linear_frequencies(program.N).tolist(), 1),
            data("cosines", "i", cosines, 0),
        )
    )


def split(value: Any) -> list[float]:
    """A number as a sum of two doubles of WORD bits and a full one."""
    parts = []
    for _ in range(2):
        mantissa, exponent = mpmath.frexp(value)
        parts.append(float(mpmath.ldexp(mpmath.nint(mpmath.ldexp(mantissa, WORD)), exponent - WORD)))
        value -= parts[-1]
    return [*parts, float(value)]


def _block_tables(block: Block, frequencies: Sequence[Fraction]) -> str:
    parity = PARITIES[block.modes[0] % 2]
    count, seeds = block.harmonics.shape
    rates = [float(sum(n * w for n, w in zip(nu, frequencies, strict=True))) for nu in block.harmonics.tolist()]
    name = {kind: f"{kind}_{parity}" for kind in ("nu", "rates", "c")}
    return "".join(
        (
            f"\n  ! Harmonics of the {parity} modes: nu, rates nu.omega, and coefficients of cos(nu.theta)\n",
            f"  integer, save :: {name['nu']}({count}, seeds)\n",
            f"  real(rk), save :: {name['rates']}({count}), {name['c']}({count}, {len(block.modes)})\n",
            *(data(name["nu"], f"i, {i + 1}", block.harmonics[:, i].tolist(), 1) for i in range(seeds)),
            data(name["rates"], "i", rates, 1),
            *(data(name["c"], f"i, {m + 1}", map(float, block.coefficients[:, m]), 1) for m in range(len(block.modes))),
        )
    )


def data(name: str, index: str, values: Iterable[Any], first: int) -> str:
    """DATA statements for name(index), the index i running from first."""
    return "".join(_statements(name, index, [literal(x) for x in values], first))


def _statements(name: str, index: str, items: Sequence[str], first: int) -> Iterator[str]:
    lines: list[str] = []
    line, start, end = "", 0, 0
    for item in items:
        if len(line) + len(item) + 8 > WIDTH:
            lines.append(line)
            line = ""
        if len(lines) == LINES:
            yield _statement(name, index, lines, first + start, first + end - 1)
            lines, start = [], end
        line += item + ","
        end += 1
    if line:
        yield _statement(name, index, [*lines, line], first + start, first + end - 1)


def _statement(name: str, index: str, lines: list[str], first: int, last: int) -> str:
    body = " &\n    ".join(lines)
    return f"  data ({name}({index}), i = {first}, {last}) / &\n    {body[:-1]} /\n"


def literal(value: Any) -> str:
    """A number that no compiler rounds to single precision or warns of: numbers below the normal doubles are zero."""
    if isinstance(value, int):
        return str(value)
    if abs(value) < np.finfo(float).tiny:
        return "0d0"
    text = repr(float(value)).removesuffix(".0")
    return text.replace("e", "d") if "e" in text else f"{text}d0"


def _check_tables(program: TorusProgram) -> str:
    check = program.check
    return "".join(
        (
            data("t", "i", map(float, check.times), 1),
            *(data("positions_of_t", f"i, {k}", map(float, row), 1) for k, row in enumerate(check.positions, 1)),
            *(data("momenta_of_t", f"i, {k}", map(float, row), 1) for k, row in enumerate(check.momenta, 1)),
            data("energies_of_t", "i", map(float, check.energies), 1),
        )
    )
