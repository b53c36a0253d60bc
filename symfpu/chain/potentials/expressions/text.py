"""Expressions in the stretch r, from text and from SymPy: nothing is evaluated but arithmetic."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache
from typing import Any

import mpmath

from symfpu.errors import InputError
from symfpu.numbers.typed import exact

FUNCTIONS = (
    "exp", "log", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan",
    "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
)  # fmt: skip
CONSTANTS = ("pi", "E")
ALLOWED = (
    f"an expression in r of {', '.join(FUNCTIONS)}, {', '.join(CONSTANTS)} and numbers"
)
ADVICE = "write it such as 'cosh(r) - 1'"
LONGEST_TEXT, LARGEST_POWER = 2000, 1000
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
def parsed(text: str) -> Any:
    """The expression of SymPy that a text denotes; InputError where it is none.

    Decimals are exact numbers. Only names that are listed above are known, nothing is called but
    those functions.
    """
    if len(text) > LONGEST_TEXT:
        raise refused(f"{text[:40]}...", f"at most {LONGEST_TEXT} characters")
    try:
        tree = ast.parse(text.strip(), mode="eval")
        return _built(tree.body, text.strip())
    except InputError:
        raise
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise refused(text) from error


def _built(node: ast.expr, text: str) -> Any:
    """The expression of a node of Python's syntax tree."""
    match node:
        case ast.Constant(value=int() | float()):
            return _number(ast.get_source_segment(text, node) or "")
        case ast.Name(id=name):
            return _named(name, text)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_built(operand, text)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _built(operand, text)
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            return _power(_built(left, text), _built(right, text), text)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_built(left, text), _built(right, text))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]):
            return _called(name, _built(argument, text), text)
    raise refused(text)


def _number(text: str) -> Any:
    import sympy

    value = exact(text, "V")
    return sympy.Rational(value.numerator, value.denominator)


def _named(name: str, text: str) -> Any:
    import sympy

    if name == "r":
        return stretch()
    if name in CONSTANTS:
        return getattr(sympy, name)
    raise refused(text)


def _called(name: str, argument: Any, text: str) -> Any:
    import sympy

    if name not in FUNCTIONS:
        raise refused(text)
    return getattr(sympy, name)(argument)


def _power(base: Any, exponent: Any, text: str) -> Any:
    if exponent.is_number and abs(exponent) > LARGEST_POWER:
        raise refused(text, f"powers up to {LARGEST_POWER}")
    return base**exponent


def text_of(expression: object, symbol: object) -> str:
    """An expression of SymPy or SymEngine in a symbol as text that `parsed` reads.

    Its floats become the numbers that their shortest decimals say.
    """
    import sympy

    try:
        V, r = sympy.sympify(expression), sympy.sympify(symbol)
    except (sympy.SympifyError, TypeError, AttributeError) as error:
        raise refused(expression) from error
    if not (isinstance(V, sympy.Expr) and isinstance(r, sympy.Symbol)):
        raise refused(expression)
    if V.free_symbols - {r}:
        others = ", ".join(sorted(map(str, V.free_symbols - {r})))
        advice = f"put numbers for {others}"
        raise refused(expression, f"an expression in {r} alone", advice)
    floats = {x: _of_float(x) for x in V.atoms(sympy.Float)}
    return _settled(sympy.sstr(V.xreplace({**floats, r: stretch()})))


def _of_float(value: Any) -> Any:
    import sympy

    shortest = (
        exact(float(value), "V") if value._prec <= mpmath.fp.prec else _decimal(value)
    )
    return sympy.Rational(shortest.numerator, shortest.denominator)


def _decimal(value: Any) -> Fraction:
    """A float of many digits, by its digits."""
    import sympy

    return exact(sympy.sstr(value, full_prec=True), "V")


def _settled(text: str) -> str:
    """The text of what the text denotes: SymPy may put terms together as it reads them."""
    import sympy

    return str(sympy.sstr(parsed(text)))
