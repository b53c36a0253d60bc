"""Notebooks: expressions as LaTeX, and as HTML whose symbols open."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Sequence
from fractions import Fraction
from html import escape
from typing import Any, NamedTuple

import symengine as se

# characters of an expression up to which SymPy's printer is worth its time
LONGEST_EXPRESSION = 20_000


def latex(expression: Any) -> str:
    """LaTeX of a SymEngine expression, in math delimiters.

    A1 is written as A_{1} and theta1 as a Greek letter.
    """
    if len(str(expression)) > LONGEST_EXPRESSION:
        return str(expression._repr_latex_())
    import sympy

    return f"$\\displaystyle {sympy.latex(sympy.sympify(expression))}$"


def latex_lines(expression: Any, width: int = 110) -> list[str]:
    """LaTeX without delimiters, a sum broken into lines of about `width` characters."""
    lines = [""]
    for term in getattr(expression, "args", ()) if expression.is_Add else (expression,):
        text = latex(term).removeprefix("$\\displaystyle ").removesuffix("$")
        sign = "" if text.startswith("-") or lines == [""] else "+ "
        if len(lines[-1]) + len(text) > width and lines[-1]:
            lines.append("")
        lines[-1] += f"{sign}{text} "
    return [line.rstrip() for line in lines]


def init_printing() -> None:
    """Notebooks show SymEngine expressions, such as the terms of a series, as formulas from now on.

    Importing symfpu does it where IPython is loaded already; where IPython comes later the user
    may call it. Harmless outside of notebooks, and a second time. Ours. Raises nothing.

    >>> import symengine
    >>> init_printing()
    >>> print(symengine.sympify("A1**2/2")._repr_latex_())
    $\\frac{A1^2}{2}$
    """
    se.init_printing()
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    if shell is not None and hasattr(shell, "display_formatter"):
        shell.display_formatter.formatters["text/latex"].for_type(se.Basic, latex)


class Meaning(NamedTuple):
    """What a symbol stands for: an expression or words, and its number where there is one."""

    symbol: Any
    stands_for: Any
    number: float | None = None


# one line of a formula; what a click opens hangs below its symbol and is a line again
STYLE = """<style>
.symfpu-line {display: flex; flex-wrap: wrap; align-items: baseline; white-space: pre;
  font-family: serif; line-height: 1.6}
.symfpu-line details > div {border-left: 2px solid; padding-left: 0.5em; margin-right: 1em}
.symfpu-line summary {display: block; list-style: none; cursor: pointer;
  border-bottom: 1px dotted}
.symfpu-line summary::-webkit-details-marker {display: none}
.symfpu-line details[open] > summary {display: inline-block; border-bottom-style: solid}
</style>"""
NAME = re.compile(r"([A-Za-z]+)_?(?:\{([^{}]*)\}|(\d*))(\([^()]*\))?")
GREEK = dict(zip(("theta", "lambda", "pi", "phi", "omega", "Omega"), "θλπφωΩ", strict=True))


class OpenableFormulas:
    """Expressions as HTML in which a click on a symbol opens what it stands for.

    HTML's own element `details` opens and closes, so that it works without a kernel and without
    scripts: in a saved page too. What is opened has symbols to open again.

    meanings : of the symbols that open; no symbol is part of its own meaning.

    >>> x, y = se.symbols("x1 y")
    >>> page = OpenableFormulas([Meaning(x, y**2, 0.25), Meaning(y, "any number")])
    >>> page.openings(x + 2 * x * y)  # x twice, with one y in each, and y
    5
    >>> page.line(y)
    '<div class="symfpu-line"><details><summary><i>y</i></summary>...any number...</details></div>'
    """

    def __init__(self, meanings: Iterable[Meaning]) -> None:
        self._meanings = {str(meaning.symbol): meaning for meaning in meanings}
        self._opened: dict[str, str] = {}
        self._inside: dict[str, int] = {}

    def page(self, title: str, expression: Any) -> str:
        """What it is, such as Q_2^(1), and the expression with one line for each summand."""
        name, _, upper = title.partition("^")
        first, *others = _summands(expression)
        lines = [self._line([f"{_name(name)}{_above(upper)} = ", *first])]
        lines += [self._line(["&#8195;", *summand]) for summand in others]
        return "\n".join([STYLE, "<div>", *lines, "</div>"])

    def line(self, expression: Any) -> str:
        """The expression on a line."""
        return self._line(_pieces(expression))

    def openings(self, expression: Any) -> int:
        """How many symbols there are to open, those within others too, without writing them."""
        powers = [piece for piece in _pieces(expression) if isinstance(piece, _Power)]
        return sum(self._openings(power.name) for power in powers)

    def _openings(self, name: str) -> int:
        if name not in self._inside:
            meaning = self._meanings.get(name)
            inside = 0 if meaning is None else 1
            if meaning and not isinstance(meaning.stands_for, str):
                inside += self.openings(meaning.stands_for)
            self._inside[name] = inside
        return self._inside[name]

    def _line(self, pieces: Sequence[str | _Power]) -> str:
        """Text between symbols is one item of the line, and so is each symbol that opens."""
        items: list[str] = []
        text = ""
        for piece in pieces:
            if isinstance(piece, str):
                text += piece
            elif piece.name not in self._meanings:
                text += piece.html()
            else:
                items += [f"<span>{text}</span>"] if text else []
                items.append(self._openable(piece))
                text = ""
        items += [f"<span>{text}</span>"] if text else []
        return f'<div class="symfpu-line">{"".join(items)}</div>'

    def _openable(self, power: _Power) -> str:
        if power.name not in self._opened:
            self._opened[power.name] = self._line(self._explained(power.name))
        opened = self._opened[power.name]
        return f"<details><summary>{power.html()}</summary><div>{opened}</div></details>"

    def _explained(self, name: str) -> Pieces:
        """What is seen when a symbol is open."""
        _, value, number = self._meanings[name]
        pieces: Pieces = [f"{_name(name)} = "]
        if isinstance(value, str):
            pieces.append(escape(value))
        else:
            pieces += _pieces(value)
            if value.is_Number:
                number = None
        if number is not None:
            pieces.append(f" = {_minus(f'{number:.10g}')}")
        return pieces


class _Power(NamedTuple):
    """A symbol, and the exponent above it; one thing to click on."""

    name: str
    exponent: str = ""

    def html(self) -> str:
        return _name(self.name) + _above(self.exponent)


Pieces = list[str | _Power]


def _above(text: str) -> str:
    return f"<sup>{_minus(escape(text))}</sup>" if text else ""


def _minus(text: str) -> str:
    return text.replace("-", "&#8722;")


def _name(name: str) -> str:
    """A symbol's name with its index below; any other text as it is."""
    parts = NAME.fullmatch(name)
    if parts is None:
        return escape(name)
    letter, braced, digits, argument = parts.groups("")
    index = _minus(escape(braced or digits))
    below = f"<sub>{index}</sub>" if index else ""
    return f"<i>{GREEK.get(letter, letter)}</i>{below}{_minus(escape(argument))}"


def _pieces(expression: Any) -> Pieces:
    """An expression from left to right: HTML as strings, and powers of symbols."""
    if expression.is_Symbol:
        return [_Power(str(expression))]
    if expression.is_Add:
        return [piece for summand in _summands(expression) for piece in summand]
    if expression.is_Mul or expression.is_Number or _below(expression):
        negative, pieces = _product(expression)
        return ["&#8722;", *pieces] if negative else pieces
    if expression.is_Pow:
        base, exponent = expression.args
        if base.is_Symbol:
            return [_Power(str(base), str(exponent))]
        return [*_factor(base), _above(str(exponent))]
    if expression.args:
        function = escape(str(expression).partition("(")[0])
        return [f"{function}(", *_pieces(expression.args[0]), ")"]
    return [_name(str(expression))]


def _summands(expression: Any) -> list[Pieces]:
    """The pieces of each summand with its sign, those with a plus first."""
    terms = sorted(expression.args, key=str) if expression.is_Add else [expression]
    signed = sorted(map(_product, terms), key=lambda product: product[0])
    found: list[Pieces] = []
    for negative, pieces in signed:
        sign = "&#8722;" if negative else "+"
        if found:
            found.append([f" {sign} ", *pieces])
        else:
            found.append([sign, *pieces] if negative else pieces)
    return found


def _product(expression: Any) -> tuple[bool, Pieces]:
    """Whether the coefficient is negative, and the pieces without its sign."""
    coefficient = Fraction(1)
    above, below = [], []
    for factor in expression.args if expression.is_Mul else (expression,):
        if factor.is_Number:
            coefficient *= Fraction(str(factor))
        elif _below(factor):
            below.append(1 / factor)
        else:
            above.append(factor)
    numerator, denominator = abs(coefficient.numerator), coefficient.denominator
    pieces = _joined(numerator, above)
    if below or denominator > 1:
        several = len(below) + (denominator > 1) > 1
        divisor = _joined(denominator, below)
        pieces += [" / ", *(["(", *divisor, ")"] if several else divisor)]
    return coefficient < 0, pieces


def _below(factor: Any) -> bool:
    """Whether it is a factor below the line."""
    return bool(factor.is_Pow and factor.args[1].is_Number and factor.args[1] < 0)


def _joined(number: int, factors: Sequence[Any]) -> Pieces:
    """A product, numbers and symbols before sums and functions; a thin space between factors."""
    ordered = sorted(factors, key=lambda factor: (_rank(factor), str(factor)))
    parts: list[Pieces] = [_factor(factor) for factor in ordered]
    if number != 1 or not parts:
        parts.insert(0, [str(number)])
    pieces = parts[0]
    for part in parts[1:]:
        pieces = [*pieces, "&#8201;", *part]
    return pieces


def _rank(factor: Any) -> int:
    """0 for powers of symbols, 1 for functions and powers of sums, 2 for sums."""
    base = factor.args[0] if factor.is_Pow else factor
    return 0 if not base.args else 1 + bool(factor.is_Add)


def _factor(factor: Any) -> Pieces:
    """The pieces of a factor, a sum in parentheses."""
    pieces = _pieces(factor)
    return ["(", *pieces, ")"] if factor.is_Add or factor.is_Mul else pieces
