"""mpmath: one module with coefficients of all digits, which evaluates at any mp.dps."""

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


class _BondPrinter(_Printer):
    """With all functions of mpmath."""

    def _module_format(self, fqn: str, register: bool = True) -> str:
        return f"mp.{fqn.rpartition('.')[2]}"


def _torus(program: TorusProgram) -> Words:
    words = _precision(program)
    digits = words["digits"]
    phases = [text(p, digits) for p in program.phases]
    words["frequency_texts"] = tuple(map(decimal, program.frequencies))
    words["phase_texts"] = tuple(phases)
    return words


def _series(program: SeriesProgram) -> Words:
    words = _precision(program)
    words["kept"] = kept(program)
    words["places"] = words["digits"] + 3
    return words


def _precision(program: TorusProgram | SeriesProgram) -> Words:
    """Two digits are left to the self-test."""
    digits = program.digits
    if digits is None:
        return {"digits": DOUBLE_DIGITS, "tolerance": TOLERANCE}
    return {"digits": digits, "tolerance": f"1e-{digits - 2}"}


MPMATH = Language(
    extension="py",
    templates="mpmath.py",
    filters=filters(_Printer(), lambda constant: constant[1])
    | {"bond_code": _BondPrinter().doprint, "decimal": decimal},
    torus_words=_torus,
    series_words=_series,
    reserved=frozenset({"mpmath"}),
)
