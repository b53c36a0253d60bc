"""A term of the series, typeset as SVG by matplotlib's own mathematics: no font, no network."""

from __future__ import annotations

import io
from dataclasses import dataclass
from html import escape
from typing import Any

from symfpu.errors import InputError, SymfpuError
from symfpu.notebook import latex_lines
from symfpu.plots.style import styled
from symfpu.series.closed_forms import closed_form
from symfpu.series.lindstedt import lindstedt
from symfpu.workbench.choice import FREQUENCIES, Choice, call, whole
from symfpu.workbench.parts import Problem

EXPANDED, FACTORED, CLOSED, NUMBERS = "expanded", "factored", "closed", "with numbers"
FORMS = (EXPANDED, FACTORED, CLOSED, NUMBERS)
COORDINATE, FREQUENCY = "Q", "omega"
LONGEST, MOST_LINES = 12_000, 40  # characters of an expression and lines that are typeset
LINE, SIZE = 0.55, 12  # inches of a line; points


@dataclass(frozen=True)
class Term:
    """Which term: Q_q^(k) or omega_q^(k) of the choice's series, in one of FORMS; as typed."""

    what: str = COORDINATE
    q: str = "3"
    order: str = "2"
    form: str = EXPANDED


@dataclass(frozen=True)
class Formula:
    """A typeset term: SVG, its LaTeX, and the lines of Python that make it."""

    svg: str
    latex: str
    python: str
    problem: str = ""


def formula(choice: Choice, term: Term) -> Formula | Problem:
    """The term as a picture; what is wrong, or too long to be read, as text."""
    try:
        python = python_of(choice, term)
        expression = _expression(choice, term)
        length = len(str(expression))
        if length > LONGEST:
            message = (
                f"{length:,} characters are too many to read; the lines of Python give them"
            )
            return Formula("", "", python, message)
        lines = latex_lines(expression, 90)
        name = _name(term)
        if len(lines) > MOST_LINES:
            message = f"{len(lines)} lines are too many; the lines of Python give them"
            return Formula("", "", python, message)
        svg = _typeset([rf"{name} = {lines[0]}", *(rf"\quad {line}" for line in lines[1:])])
        return Formula(svg, f"{name} = " + " ".join(lines), python)
    except SymfpuError as error:
        return Problem(str(error))


def _name(term: Term) -> str:
    letter = r"\omega" if term.what == FREQUENCY else "Q"
    return f"{letter}_{{{term.q}}}^{{({term.order})}}"


def _expression(choice: Choice, term: Term) -> Any:
    q, k = whole("q", term.q), whole("order k", term.order)
    numeric = term.form == NUMBERS
    if numeric and choice.given != FREQUENCIES:
        allowed = "a form in symbols where amplitudes or the energy are chosen"
        raise InputError("form", term.form, allowed, "choose frequencies, or another form")
    nested = term.what == FREQUENCY and term.form == FACTORED
    typed = choice.by_seed
    omega = tuple(typed.values()) if numeric else None
    ring = "nested" if nested else None
    series = lindstedt(choice.chain, tuple(typed), omega, k, ring=ring)
    if term.what == FREQUENCY:
        expression = series.frequency_correction(q, k)
    else:
        expression = series.term(q, k, form=_form(term))
    if term.form == CLOSED:
        return closed_form(expression, choice.chain, tuple(typed))
    return expression


def _form(term: Term) -> str | None:
    """The form of a coordinate, as `LindstedtSeries.term` names it."""
    if term.form == NUMBERS:
        return None
    return FACTORED if term.form == CLOSED else term.form


def python_of(choice: Choice, term: Term) -> str:
    """The lines of Python that make the term."""
    q, k = whole("q", term.q), whole("order k", term.order)
    typed = choice.by_seed
    numeric = term.form == NUMBERS
    arguments = ["chain", repr(tuple(typed))]
    named = {"order": str(k)}
    if numeric:
        named["frequencies"] = repr(tuple(typed.values()))
    if term.what == FREQUENCY and term.form == FACTORED:
        named["ring"] = '"nested"'
    form = _form(term)
    if term.what == FREQUENCY:
        made = f"series.frequency_correction({q}, {k})"
    elif form is None:
        made = f"series.term({q}, {k})"
    else:
        made = f'series.term({q}, {k}, form="{form}")'
    names = ["Chain", "lindstedt"]
    if term.form == CLOSED:
        names.append("closed_form")
        made = f"closed_form({made}, chain, {tuple(typed)!r})"
    lines = [
        f"from symfpu import {', '.join(sorted(names))}",
        "",
        f"chain = {choice.chain_text}",
        f"series = {call('lindstedt', *arguments, **named)}",
        made,
    ]
    return "\n".join(lines) + "\n"


def _typeset(lines: list[str]) -> str:
    """Lines of LaTeX as one SVG of paths, as wide as the longest."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    stream = io.StringIO()
    with styled(), mpl.rc_context({"mathtext.fontset": "cm"}):
        figure = Figure(figsize=(1.0, LINE * len(lines)))
        figure.set_layout_engine("none")
        height = len(lines)
        for i, line in enumerate(lines):
            place = 1 - (i + 0.5) / height
            figure.text(0, place, f"${_known(line)}$", fontsize=SIZE, va="center")
        figure.savefig(stream, format="svg", metadata={"Date": None}, bbox_inches="tight")
    svg = stream.getvalue()
    label = escape(" ".join(lines), quote=True)
    return svg[svg.index("<svg") :].replace(
        "<svg", f'<svg role="img" aria-label="{label}"', 1
    )


def _known(line: str) -> str:
    """LaTeX that matplotlib knows, the outer fraction of a summand in full size."""
    return line.replace(r"\frac", r"\dfrac", 1)
