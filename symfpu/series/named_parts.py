"""Expressions whose shared parts have names."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from symfpu.notebook import latex_lines
from symfpu.numbers.public import public


@public
@dataclass(frozen=True)
class NamedParts:
    """An expression whose shared parts have names.

    Made by `LindstedtSeries.term` with form="cse"; dimensionless. Ours.

    names : pairs (name, expression), each after its parts. expression : in these names.

    >>> from symfpu import Chain, lindstedt
    >>> parts = lindstedt(Chain(N=8, alpha=1), (1,), order=4).term(5, 4, form="cse")
    >>> parts
    NamedParts(... where x0 = ..., x1 = ..., x2 = ..., x3 = ...)
    """

    names: tuple[tuple[Any, Any], ...]
    expression: Any

    def __repr__(self) -> str:
        names = ", ".join(f"{name} = {value}" for name, value in self.names)
        meaning = f" where {names}" if names else ""
        return f"NamedParts({self.expression}{meaning})"

    def latex(self) -> str:
        """Lines that fit a page: the expression, then what its names stand for."""
        lines = [f"&{line}" for line in latex_lines(self.expression)]
        for name, value in self.names:
            first, *others = latex_lines(value)
            [symbol] = latex_lines(name)
            lines.append(f"{symbol} &= {first}")
            lines += [rf"&\quad {line}" for line in others]
        rows = " \\\\\n".join(lines)
        return f"\\begin{{aligned}}\n{rows}\n\\end{{aligned}}"

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"

    def whole(self) -> Any:
        """The expression without names."""
        whole = self.expression
        for name, value in reversed(self.names):
            whole = whole.subs({name: value})
        return whole
