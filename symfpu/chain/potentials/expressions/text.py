"""Expressions in the stretch r, from text and from SymPy: nothing is evaluated but arithmetic."""

from __future__ import annotations

import ast
import math
import operator
import sys
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from numbers import Real
from typing import Any

import mpmath
import symengine as se

from symfpu.chain.potentials.expressions import sizes
from symfpu.errors import InputError
from symfpu.numbers.typed import exact

FUNCTIONS = (
    "exp", "log", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan",
    "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
)  # fmt: skip
CONSTANTS = ("pi", "E")
SMALLEST_DOUBLE = sys.float_info.min
GROWING = ("exp", "sinh", "cosh")
ALLOWED = (
    f"an expression in r of {', '.join(FUNCTIONS)}, {', '.join(CONSTANTS)} and numbers"
)
ADVICE = "write it such as 'cosh(r) - 1'"
LONGEST_TEXT, LARGEST_POWER = 2000, sizes.HIGHEST_POWER
_OPERATORS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}


def refused(value: object, allowed: str = ALLOWED, advice: str = ADVICE) -> InputError:
    """What is said of an expression that is no potential."""
    return InputError("V", value, allowed, advice)


def stretch() -> Any:
    """The symbol r of all expressions here."""
    import sympy

    return sympy.Symbol("r")


@lru_cache(maxsize=256)
def parsed(text: str, name: str = "r") -> Any:
    """The expression of SymPy that a text denotes, the stretch by its name; else InputError.

    Decimals are exact numbers. Only names that are listed above are known, nothing is called but
    those functions. Constants are bounded as they are built.
    """
    if len(text) > LONGEST_TEXT:
        raise refused(text, f"at most {LONGEST_TEXT} characters")
    try:
        tree = ast.parse(text.strip(), mode="eval")
        return _Builder(text.strip(), name).built(tree.body)
    except InputError:
        raise
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise refused(text) from error


class _Builder:
    """Builds the expression of a text from Python's syntax tree, and checks every part of it."""

    def __init__(self, text: str, name: str) -> None:
        self.text, self.name = text, name

    def built(self, node: ast.expr) -> Any:
        """The expression of a node."""
        expression = self.combined(node)
        if not sizes.small(expression):
            raise refused(self.text, sizes.ALLOWED, sizes.ADVICE)
        return expression

    def combined(self, node: ast.expr) -> Any:
        """The same before it is checked, from parts that were."""
        match node:
            case ast.Constant(value=int() | float()):
                return _number(ast.get_source_segment(self.text, node) or "")
            case ast.Name(id=name):
                return self.named(name)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self.built(operand)
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self.built(operand)
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self.power(self.built(left), self.built(right))
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
                return _OPERATORS[type(op)](self.built(left), self.built(right))
            case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]):
                return self.called(name, self.built(argument))
        raise refused(self.text)

    def named(self, name: str) -> Any:
        """The stretch, or a constant."""
        import sympy

        if name == self.name:
            return stretch()
        if name in CONSTANTS:
            return getattr(sympy, name)
        raise refused(self.text)

    def called(self, name: str, argument: Any) -> Any:
        """A function of an argument, whose value is a double where it is a constant."""
        import sympy

        if name not in FUNCTIONS:
            raise refused(self.text)
        if name in GROWING and argument.is_number and not sizes.has_exponential(argument):
            raise refused(self.text, sizes.ALLOWED, sizes.ADVICE)
        return getattr(sympy, name)(argument)

    def power(self, base: Any, exponent: Any) -> Any:
        """A power that is not too large."""
        if exponent.is_number and not abs(exponent) <= LARGEST_POWER:
            raise refused(self.text, f"powers up to {LARGEST_POWER}")
        if not sizes.has_power(base, exponent):
            raise refused(self.text, sizes.ALLOWED, sizes.ADVICE)
        return base**exponent


def _number(text: str) -> Any:
    import sympy

    value = exact(text, "V")
    return sympy.Rational(value.numerator, value.denominator)


def named_stretch(symbol: object) -> str:
    """The name of the symbol of the stretch, given as such or as text."""
    import sympy

    name = str(symbol).strip() if isinstance(symbol, (str, sympy.Symbol, se.Symbol)) else ""
    if not name.isidentifier() or name in (*FUNCTIONS, *CONSTANTS):
        raise InputError(
            "r", symbol, "the symbol of the stretch", "pass it, or its name 'r'"
        )
    return name


def text_of(expression: object, symbol: object) -> str:
    """An expression of SymPy or SymEngine in a symbol as text that `parsed` reads.

    Its floats become the numbers that their shortest decimals say.
    """
    import sympy

    V, r = expression_of(expression), sympy.Symbol(named_stretch(symbol))
    others = {x for x in V.free_symbols if str(x) != str(r)}
    if others:
        names = ", ".join(sorted(map(str, others)))
        advice = f"put numbers for {names}"
        raise refused(expression, f"an expression in {r} alone", advice)
    floats = {x: _of_float(x) for x in V.atoms(sympy.Float)}
    symbols = dict.fromkeys(V.free_symbols, stretch())
    return _settled(sympy.sstr(V.xreplace(floats | symbols)))


def expression_of(value: object) -> Any:
    """A number or an expression of SymEngine as one of SymPy; InputError for anything else.

    Nothing is called that reads text as a program.
    """
    import sympy

    try:
        if isinstance(value, se.Basic):
            value = value._sympy_()
        elif isinstance(value, Real | Decimal) and not isinstance(value, sympy.Basic):
            number = exact(value, "V")
            value = sympy.Rational(number.numerator, number.denominator)
        if not isinstance(value, sympy.Expr):
            raise refused(value)
        if not sizes.short(value):
            raise refused(str(type(value)), sizes.ALLOWED, sizes.ADVICE)
    except (RecursionError, ValueError, RuntimeError, NotImplementedError) as error:
        if isinstance(error, InputError):
            raise
        raise refused(str(type(value))) from error
    return value


def _of_float(value: Any) -> Any:
    import sympy

    shortest = exact(float(value), "V") if _is_double(value) else _decimal(value)
    return sympy.Rational(shortest.numerator, shortest.denominator)


def _is_double(value: Any) -> bool:
    """Whether a float has a double's digits, and its range."""
    size = abs(float(value))
    return bool(value._prec <= mpmath.fp.prec and SMALLEST_DOUBLE <= size < math.inf)


def _decimal(value: Any) -> Fraction:
    """A float of many digits, by its digits."""
    import sympy

    return exact(sympy.sstr(value, full_prec=True), "V")


def _settled(text: str) -> str:
    """The text of what the text denotes: SymPy may put terms together as it reads them."""
    import sympy

    return str(sympy.sstr(parsed(text)))
