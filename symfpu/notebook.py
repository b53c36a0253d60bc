"""SymEngine expressions as LaTeX in notebooks."""

from __future__ import annotations

import sys
from typing import Any

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
