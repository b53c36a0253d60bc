"""mpmath: one module whose coefficients carry the digits of the solution and which evaluates at any mp.dps."""

from __future__ import annotations

import sympy
from sympy.printing.pycode import MpmathPrinter

from symfpu.codegen.languages.numpy import Waves, filters, kept
from symfpu.codegen.series_program import SeriesProgram
from symfpu.codegen.templating import Language, Words
from symfpu.codegen.torus_program import DOUBLE_DIGITS, TOLERANCE, TorusProgram
from symfpu.numbers.arithmetic import text
from symfpu.numbers.typed import decimal


class _Printer(Waves, MpmathPrinter):  # type: ignore[misc]
    """mpmath by its context `mp`; numbers as decimal text."""

    module = "mp"

    def __init__(self) -> None:
        super().__init__({"fully_qualified_modules": False})

    def _print_Float(self, value: sympy.Float) -> str:
        return f'mp.mpf("{value!s}")'

    def _print_Rational(self, value: sympy.Rational) -> str:
        return f"(mp.mpf({value.p}) / {value.q})"


def _torus(program: TorusProgram) -> Words:
    precision = _precision(program)
    phases = tuple(text(p, precision["digits"]) for p in program.phases)
    return precision | {
        "frequency_texts": tuple(map(decimal, program.frequencies)),
        "phase_texts": phases,
    }


def _series(program: SeriesProgram) -> Words:
    precision = _precision(program)
    return precision | {
        "kept": kept(program),
        "places": precision["digits"] + 3,
    }


def _precision(program: TorusProgram | SeriesProgram) -> Words:
    """Two digits are left to the self-test."""
    if program.digits is None:
        return {"digits": DOUBLE_DIGITS, "tolerance": TOLERANCE}
    return {"digits": program.digits, "tolerance": f"1e-{program.digits - 2}"}


MPMATH = Language(
    extension="py",
    templates="mpmath.py",
    filters=filters(_Printer(), lambda constant: constant[1]) | {"decimal": decimal},
    torus_words=_torus,
    series_words=_series,
    reserved=frozenset({"mpmath"}),
)
