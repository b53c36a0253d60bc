"""A language as data: its three templates, their filters, and what they are given of a program.

Templates are Jinja2. Those of a language X, templates/torus.X.jinja, templates/series.X.jinja and
templates/universal.X.jinja, hold its whole text, with places for numbers; a place that nothing
fills is an error. The statements of straight-line code come from a printer of SymPy, which is
a filter.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from symfpu.codegen.series_program import SeriesProgram
from symfpu.codegen.torus_program import TOLERANCE, TorusProgram

if TYPE_CHECKING:
    from jinja2 import Environment

Words = dict[str, Any]  # what a template is given, by name
Filter = Callable[..., Any]


@dataclass(frozen=True, eq=False)
class Language:
    """A language that tori and series are written in.

    extension : of its files. templates : X of torus.X.jinja and the others. filters : of
    all templates, by name. torus_words, series_words : what a template is given besides
    `common_words`. reserved : names that no file may have. Sources are the same bytes for the
    same program.
    """

    extension: str
    templates: str
    filters: Mapping[str, Filter] = field(repr=False)
    torus_words: Callable[[TorusProgram], Words] = field(repr=False)
    series_words: Callable[[SeriesProgram], Words] = field(repr=False)
    reserved: frozenset[str] = field(repr=False)

    def torus(self, program: TorusProgram) -> str:
        """The source of a torus: Q(t), P(t), E_q(t) and H(t), with adjustable phases."""
        words = common_words(program) | self.torus_words(program)
        return self.filled("torus", words)

    def series(self, program: SeriesProgram) -> str:
        """The source of a series: Q(t; A), P(t; A), omega(A) and its Jacobian.

        Of a universal series in tables also the derivatives by the frequencies.
        """
        words = common_words(program) | self.series_words(program)
        return self.filled("universal" if program.operations else "series", words)

    def filled(self, kind: str, words: Words) -> str:
        """The template of a torus, a series or a universal one with its words."""
        name = f"{kind}.{self.templates}.jinja"
        template = self._environment.get_template(name)
        return template.render(words)

    @cached_property
    def _environment(self) -> Environment:
        """Compiles a template at its first use and keeps it."""
        from jinja2 import Environment, PackageLoader, StrictUndefined

        environment = Environment(  # noqa: S701 - source code is not HTML
            loader=PackageLoader("symfpu.codegen"),
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
            keep_trailing_newline=True,
            auto_reload=False,
        )
        environment.filters |= COMMON_FILTERS
        environment.filters |= self.filters
        return environment


def common_words(program: TorusProgram | SeriesProgram) -> Words:
    """The fields of a program by their names, and what every template needs of them.

    modes : N - 1. s : seeds. checks : times of the test vectors. tolerance : of the self-test.
    fpu, a_chain, a_named_chain : what chain it is.
    """
    words = dict(vars(program))
    words["modes"] = program.N - 1
    words["s"] = len(program.seeds)
    words["checks"] = len(program.check.times)
    words["tolerance"] = TOLERANCE
    other = "a chain of this potential"
    words["fpu"] = program.fpu
    words["a_chain"] = "an FPU chain" if program.fpu else other
    words["a_named_chain"] = "a Fermi-Pasta-Ulam chain" if program.fpu else other
    return words


def double(value: Any) -> str:
    """The nearest double, as decimal text that reads back as the same."""
    return repr(float(value))


def some(modes: tuple[int, ...]) -> str:
    """The first modes of a block, for a comment."""
    first = [str(q) for q in modes[:3]]
    if len(modes) > len(first):
        first.append("...")
    return ", ".join(first)


def packed(
    pieces: Iterable[str],
    width: int,
    *,
    start: str = "",
    indent: str = "",
) -> list[str]:
    """Pieces put together in lines of at most so many columns, without blanks at their ends.

    start, indent : what the first line and every other begin with.
    """
    lines = []
    line = start
    for piece in pieces:
        size = len(line) + len(piece.rstrip())
        if size > width:
            lines.append(line.rstrip())
            line = indent
        line += piece
    return [*lines, line.rstrip()]


COMMON_FILTERS: dict[str, Filter] = {"double": double, "some": some}
