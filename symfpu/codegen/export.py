"""A torus as source code in a file: the languages there are, legal names, and the file itself."""

from __future__ import annotations

import keyword
import re
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

from symfpu.arithmetic import text
from symfpu.certificates import write_text
from symfpu.codegen import c99, fortran, mpmath_source, numpy_source
from symfpu.codegen.program import TorusProgram, torus_facts, torus_program
from symfpu.errors import InputError
from symfpu.fourier import QuasiPeriodic
from symfpu.series import LindstedtSeries
from symfpu.torus import QTorus

LONGEST_NAME = 40  # with a suffix it stays below the 63 characters of Fortran


class Language(NamedTuple):
    """extension : of the file. emit : the program as text."""

    extension: str
    emit: Callable[[TorusProgram], str]


LANGUAGES = {
    "c": Language(c99.EXTENSION, c99.emit_torus),
    "fortran": Language(fortran.EXTENSION, fortran.emit_torus),
    "numpy": Language(numpy_source.EXTENSION, numpy_source.emit_torus),
    "mpmath": Language(mpmath_source.EXTENSION, mpmath_source.emit_torus),
}


def export(torus: QuasiPeriodic, language: str, path: str | Path, *, force: bool = False, command: str | None = None) -> Path:
    """Write a torus as a source file that needs nothing of this package; returns its path.

    language : one of LANGUAGES. path : the file; its name without the extension names the functions or the module, and the
    extension may be left out. force : replace an existing file. command : what the header says made it.
    Raises InputError for an unknown language, a series without amplitudes, a name that is no identifier, an existing file.
    """
    if language not in LANGUAGES:
        raise InputError("language", language, f"one of {', '.join(LANGUAGES)}", "name one of these")
    if isinstance(torus, LindstedtSeries):
        raise InputError("torus", "a series without amplitudes", "a torus", "call solve_amplitudes(series) first")
    extension, emit = LANGUAGES[language]
    file = Path(path)
    file = file if file.suffix else file.with_suffix(f".{extension}")
    name = legal_name(file.stem)
    if file.exists() and not force:
        raise InputError("path", str(file), "a file that does not exist yet", "choose another, or replace it with force (--force)")
    made = {"written by": f"symfpu {version('symfpu')}"}
    facts = {**made, "made by": command or f"symfpu.export(torus, {language!r}, {file.name!r})", **_orders(torus), **torus_facts(torus)}
    write_text(file, emit(torus_program(torus, name, facts)))
    return file


def legal_name(name: str) -> str:
    """The name, if it is an identifier in every language; InputError otherwise."""
    allowed = f"a lower-case letter, then letters, digits and underscores, at most {LONGEST_NAME}"
    if not re.fullmatch(rf"[a-z][a-z0-9_]{{0,{LONGEST_NAME - 1}}}", name, re.ASCII) or keyword.iskeyword(name) or name in RESERVED:
        raise InputError("path", name, f"a file name that is also an identifier: {allowed}, no reserved word", "rename the file")
    return name


RESERVED = frozenset(
    [
        "auto",
        "break",
        "case",
        "char",
        "const",
        "continue",
        "default",
        "do",
        "double",
        "else",
        "enum",
        "extern",
        "float",
        "for",
        "goto",
        "if",
        "inline",
        "int",
        "long",
        "main",
        "register",
        "restrict",
        "return",
        "short",
        "signed",
        "sizeof",
        "static",
        "struct",
        "switch",
        "typedef",
        "union",
        "unsigned",
        "void",
        "volatile",
        "while",
        "program",
        "module",
        "end",
        "subroutine",
        "function",
        "real",
        "integer",
        "numpy",
        "mpmath",
    ]
)


def _orders(torus: QuasiPeriodic) -> dict[str, str]:
    if not isinstance(torus, QTorus):
        return {}
    amplitudes = ", ".join(f"A_{q} = {text(a, torus.digits or 17)}" for q, a in torus.amplitudes.items())
    return {"orders": f"frequencies {torus.frequency_order}, coordinates {torus.order}", "amplitudes": amplitudes}
