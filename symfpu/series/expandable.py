"""Terms of a universal series whose symbols open in a notebook, down to sines and frequencies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import flint
import symengine as se

from symfpu.algebra.formulas import Multiplier, multiplier_symbol
from symfpu.chain.length import HighMode, mode_label
from symfpu.chain.symbols import (
    amplitude_symbol,
    chosen_symbol,
    coordinate_symbol,
    linear_symbol,
    phase_symbol,
)
from symfpu.errors import InputError
from symfpu.notebook import Meaning, OpenableFormulas
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number
from symfpu.series.arguments import frequencies_of
from symfpu.series.closed_forms import multiplier_quotient
from symfpu.series.named_parts import NamedParts
from symfpu.series.series import LindstedtSeries, require_series
from symfpu.series.substitution import leaves_in_balls

MOST_OPENINGS = 30_000  # some ten million characters
BITS = 160  # of numbers that are shown with ten digits: they may lose a hundred bits
BONDS = se.Symbol("N")


@public
@dataclass(frozen=True)
class ExpandableTerm:
    """A term of a series in which a click on a symbol shows what it stands for.

    Made by `expandable_term`; dimensionless, phases in radians. Ours.

    name : of the term, Q_q^(k). parts : the term with named parts. meanings : what every symbol in
        it stands for, and every symbol in that.

    >>> from symfpu import Chain, expandable_term, lindstedt
    >>> series = lindstedt(Chain(N=8, alpha=1), (1,), order=2)
    >>> term = expandable_term(series, 3, 2, ("0.3905",))
    >>> term
    ExpandableTerm(Q_3^(2), 13 symbols, 9 with numbers)
    >>> term.meaning("L_{3}(1)")
    Meaning(symbol=L_{3}(1), stands_for=Omega_3**2/(Omega_3**2 - omega_1**2), number=1.1409...)
    >>> term.html().count("<details>")
    43
    """

    name: str
    parts: NamedParts = field(repr=False)
    meanings: tuple[Meaning, ...] = field(repr=False)

    def __repr__(self) -> str:
        known = sum(meaning.number is not None for meaning in self.meanings)
        counts = f"{len(self.meanings)} symbols, {known} with numbers"
        return f"ExpandableTerm({self.name}, {counts})"

    def meaning(self, symbol: Any) -> Meaning:
        """What one symbol stands for, named as it prints. Raises InputError for others."""
        for meaning in self.meanings:
            if str(meaning.symbol) == str(symbol):
                return meaning
        names = ", ".join(str(meaning.symbol) for meaning in self.meanings)
        raise InputError("symbol", symbol, f"one of {names}", "name a symbol of this term")

    def html(self) -> str:
        """A part of a page, without scripts: it works where it is saved, too."""
        formulas = OpenableFormulas(self.meanings)
        return formulas.page(self.name, self.parts.expression)

    def _repr_html_(self) -> str:
        return self.html()


@public
def expandable_term(
    series: LindstedtSeries,
    q: int | str,
    order: int,
    frequencies: Sequence[Number] | None = None,
) -> ExpandableTerm:
    """Q_q^(k) of a universal series, for a notebook: click a symbol and see what it stands for.

    series : without frequencies, of one N or of all. q, order : as `series.term` takes them.
    frequencies : omega of every seed, shape (s,), exact as in `lindstedt`: then all symbols but
        the amplitudes and phases have numbers; None for linear frequencies only.

    The parts that occur more than once have names x0, x1, ..., which open like L_q(nu) and
    Omega_q. All dimensionless. Ours. Raises InputError for series with frequencies, for modes and
    orders that a series does not have and for terms too long to open; ResonantDivisor.

    >>> from symfpu import Chain, expandable_term, lindstedt
    >>> series = lindstedt(Chain("N", alpha=1), (1,), order=4)
    >>> expandable_term(series, 5, 4).meaning("Omega_5")
    Meaning(symbol=Omega_5, stands_for=2*sin((5/2)*pi/N), number=None)
    """
    require_series(series)
    parts = series.term(q, order, form="cse")  # type: ignore[arg-type]
    omega = None if frequencies is None else frequencies_of(frequencies, series.seeds)
    known = {str(m.symbol): m for m in _meanings(series, parts, omega)}
    reached = _reached(parts.expression, known)
    name = coordinate_symbol(mode_label(q, "q"))
    term = ExpandableTerm(f"{name}^({order})", parts, tuple(reached.values()))
    openings = OpenableFormulas(term.meanings).openings(parts.expression)
    if openings > MOST_OPENINGS:
        allowed = (
            f"a term with at most {MOST_OPENINGS} symbols to open (this one has {openings})"
        )
        raise InputError(
            "order", order, allowed, 'take a lower one, or term(q, k, form="cse")'
        )
    return term


def _meanings(
    series: LindstedtSeries, parts: NamedParts, omega: tuple[Fraction, ...] | None
) -> Iterator[Meaning]:
    """Of all symbols that may occur."""
    chain = series.chain
    if chain.symbolic:
        yield Meaning(BONDS, "the number of bonds, any that the series is valid for")
    else:
        yield Meaning(BONDS, "the number of bonds", chain.N)
    yield Meaning(se.Symbol("t"), "the time")
    chosen = dict(zip(series.seeds, omega or (), strict=False))
    for q in series.seeds:
        free, angle = (
            se.Symbol(f"phi{str(phase_symbol(q)).removeprefix('theta')}"),
            phase_symbol(q),
        )
        yield Meaning(amplitude_symbol(q), f"the amplitude of mode {q}, free")
        yield Meaning(angle, chosen_symbol(q) * se.Symbol("t") + free)
        yield Meaning(free, f"the phase of mode {q}, free")
        number = float(chosen[q]) if q in chosen else None
        yield Meaning(chosen_symbol(q), f"the chosen frequency of mode {q}", number)
    for q in series.modes:
        linear = None if chain.symbolic else float(chain.linear_frequency(q))
        yield Meaning(linear_symbol(q), _linear_frequency(q), linear)
    yield from _with_numbers(series, parts, omega)


def _linear_frequency(q: int) -> Any:
    """Omega_q = 2 sin(q pi / 2N), with N a symbol."""
    place = BONDS + int(q) if isinstance(q, HighMode) else se.Integer(q)
    return 2 * se.sin(place * se.pi / (2 * BONDS))


def _with_numbers(
    series: LindstedtSeries, parts: NamedParts, omega: tuple[Fraction, ...] | None
) -> Iterator[Meaning]:
    """Of the multipliers and of the named parts, each after its own parts."""
    program = series.node_tables()[0].program
    numbers: dict[Any, float] = {}
    values: Sequence[Any] = [None] * len(program.symbols)
    if omega is not None:
        with flint.ctx.workprec(BITS):
            values = leaves_in_balls(program, series.chain, series.seeds, omega, BITS)
    for leaf, value in zip(program.symbols, values, strict=True):
        if isinstance(leaf, Multiplier):
            symbol = multiplier_symbol(*leaf)
            if value is not None:
                numbers[symbol] = float(value)
            meaning = multiplier_quotient(leaf.mode, leaf.harmonic, series.seeds)
            yield Meaning(symbol, meaning, numbers.get(symbol))
    for name, expression in parts.names:
        if numbers:
            numbers[name] = float(expression.subs(numbers))
        yield Meaning(name, expression, numbers.get(name))


def _reached(expression: Any, known: dict[str, Meaning]) -> dict[str, Meaning]:
    """The meanings of the symbols of an expression, and of the symbols in these."""
    found: dict[str, Meaning] = {}
    waiting = [expression]
    while waiting:
        symbols = sorted(map(str, waiting.pop(0).free_symbols))
        for name in symbols:
            if name not in found:
                found[name] = known[name]
                if not isinstance(known[name].stands_for, str):
                    waiting.append(known[name].stands_for)
    return found
