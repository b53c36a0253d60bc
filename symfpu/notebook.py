"""SymEngine expressions as LaTeX in notebooks."""

from __future__ import annotations

import sys
from typing import Any

import symengine as se

LONGEST = 20_000  # characters of an expression up to which SymPy's printer is worth its time


def latex(expression: Any) -> str:
    """LaTeX of a SymEngine expression, with A1 as A_{1} and theta1 as a Greek letter; math delimiters included."""
    if len(str(expression)) > LONGEST:
        return str(expression._repr_latex_())
    import sympy

    return f"$\\displaystyle {sympy.latex(sympy.sympify(expression))}$"


def init_printing() -> None:
    """Print SymEngine expressions as LaTeX wherever a notebook shows them. Done on import of symfpu; harmless elsewhere."""
    se.init_printing()
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    if shell is not None and hasattr(shell, "display_formatter"):
        shell.display_formatter.formatters["text/latex"].for_type(se.Basic, latex)
