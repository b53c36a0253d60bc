"""Expressions of universal series in frequencies and in N, collected, and compared exactly."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterable, Sequence
from numbers import Number
from typing import Any

import numpy as np
import symengine as se
from symengine.lib.symengine_wrapper import Relational

from symfpu.algebra.expansion import Expansion
from symfpu.algebra.formulas import Multiplier, NodeTable, multiplier_symbol
from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.length import HighMode, mode_label, seed_labels
from symfpu.chain.symbols import chosen_symbol, linear_symbol
from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.series.all_lengths import SeriesForAllN
from symfpu.series.series import LindstedtSeries

MODE = r"(N-\d+|\d+)"
MULTIPLIER = re.compile(rf"L_\{{{MODE}\}}\((-?\d+(?:,-?\d+)*)\)")
LINEAR = re.compile(rf"Omega_(?:\{{{MODE}\}}|(\d+))")
MOST_TERMS = 10**6  # of an expanded expression, or words of its integers
POWER_OF_A_WORD = 64


def formula_of(expression: Any, argument: str) -> Any:
    """A SymEngine expression of what is one, of a number or a text; InputError for the rest."""
    sympy = sys.modules.get("sympy")  # whoever passes its expressions has imported it
    known = isinstance(expression, str | Number | se.Basic)
    known = known or (sympy is not None and isinstance(expression, sympy.Basic))
    try:
        if not known or isinstance(expression, bool):
            raise TypeError("neither an expression nor a number")
        formula = se.sympify(expression)
    except (TypeError, ValueError, RuntimeError, OverflowError, se.SympifyError) as error:
        allowed = "an expression of SymEngine or SymPy, a number or a text such as 'A1**2'"
        raise InputError(
            argument, expression, allowed, "pass a term of a series"
        ) from error
    if not isinstance(formula, se.Expr) or isinstance(formula, Relational):
        allowed = "an expression, neither a truth value nor a relation"
        raise InputError(argument, expression, allowed, "pass a term of a series")
    return formula


@public
def substitute_multipliers(expression: Any, seeds: Sequence[int | str]) -> Any:
    """L_q(nu) written out as Omega_q^2 / (lambda_q - (nu.omega)^2), Eq. Lm.

    expression : of a universal series, `leading_term` or the like, in the symbols L_q(nu).
    seeds : of the series, ascending as the series has them; lambda_q = omega_q^2 for them,
        Omega_q^2 for other modes. All is dimensionless.

    Returns a SymEngine expression with the chosen frequencies omega_q as symbols. Differs from
    Eq. Lm, which has Omega_q^2 for lambda_q and is needed there for modes that are no seeds.
    Raises InputError for harmonics of another length than the seeds.

    >>> substitute_multipliers(se.Symbol("L_{2}(2)"), (1,))
    Omega_2**2/(Omega_2**2 - 4*omega_1**2)
    """
    labels = seed_labels(seeds)
    quotients = {}
    formula = formula_of(expression, "expression")
    for symbol in formula.free_symbols:
        found = MULTIPLIER.fullmatch(symbol.name)
        if not found:
            continue
        q, nu = _mode(found[1]), [int(n) for n in found[2].split(",")]
        if len(nu) != len(labels):
            allowed = f"those of a series with the {len(nu)} seeds of {symbol}"
            raise InputError("seeds", labels, allowed, "pass the seeds of the series")
        quotients[symbol] = multiplier_quotient(q, nu, labels)
    return formula.subs(quotients)


def multiplier_quotient(q: int, nu: Sequence[int], seeds: Sequence[int]) -> Any:
    """L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2), lambda_q = omega_q^2 of a seed (Eq. Lm)."""
    linear = linear_symbol(q)
    base = chosen_symbol(q) if q in seeds else linear
    drive = se.Add(*(n * chosen_symbol(p) for n, p in zip(nu, seeds, strict=True)))
    return linear**2 / (base**2 - drive**2)


@public
def closed_form(
    expression: Any,
    chain: Chain,
    seeds: Sequence[int | str],
    *,
    frequencies: str = "chosen",
) -> Any:
    """An expression of a universal series as a formula in N.

    Omega_q becomes 2 sin(q pi / 2N) (Eq. fpuspec), Omega_(N-b) 2 cos(b pi / 2N), and L_q(nu) its
    quotient (`substitute_multipliers`).

    expression : of a universal series, its phases in radians. chain : N, a symbol or a number.
    seeds : of the series, ascending. frequencies : 'chosen' leaves omega_q as symbols, 'linear'
        puts their linear values, with which the divisors are those of the leading order. For a
        symbolic N none of these vanishes, because sines of different multiples of pi/2N are
        linearly independent functions of N; for a number they may. All is dimensionless.

    Returns a SymEngine expression; a symbolic N is the symbol N in it. Ours.
    Raises InputError for another word, or as `substitute_multipliers`.

    >>> closed_form(se.Symbol("L_{2}(2)"), Chain("N", alpha=1), (1,))
    4*sin(pi/N)**2/(-4*omega_1**2 + 4*sin(pi/N)**2)
    >>> closed_form(se.Symbol("Omega_{N-1}"), Chain("N", alpha=1), (1,))
    2*cos((1/2)*pi/N)
    """
    require_chain(chain)
    if frequencies not in ("chosen", "linear"):
        allowed = "'chosen' or 'linear'"
        raise InputError("frequencies", frequencies, allowed, "leave it out for symbols")
    formula = substitute_multipliers(expression, seeds)
    length = se.Symbol("N") if chain.symbolic else se.Integer(chain.N)
    if frequencies == "linear":
        formula = formula.subs(
            {chosen_symbol(q): linear_symbol(q) for q in seed_labels(seeds)}
        )
    sines = {}
    for symbol in formula.free_symbols:
        found = LINEAR.fullmatch(symbol.name)
        if found:
            sines[symbol] = _sine(_mode(found[1] or found[2]), length)
    return formula.subs(sines)


def _mode(text: str) -> int:
    return mode_label(text if text.startswith("N") else int(text), "q")


def _sine(q: int, length: Any) -> Any:
    angle = abs(int(q)) * se.pi / (2 * length)
    return 2 * (se.cos(angle) if isinstance(q, HighMode) else se.sin(angle))


@public
def collect_terms(expression: Any, symbols: Iterable[Any]) -> dict[Any, Any]:
    """An expression sorted by powers of some symbols: {monomial: coefficient}.

    expression : of any kind. symbols : those to sort by; cosines and other
        functions of these alone stand in the monomials too.

    Returns expanded coefficients without the symbols, dimensionless as the expression is; their
    products with the monomials add up to it. Ours. Raises InputError for what are no symbols.

    >>> A, B = se.symbols("A B")
    >>> terms = collect_terms((A + 2 * B) ** 2 + B, [A])
    >>> terms[A], terms[A**2], len(terms)
    (4*B, 1, 3)
    """
    chosen = set()
    for given in symbols:
        symbol = formula_of(given, "symbols")
        if not getattr(symbol, "is_Symbol", False):
            raise InputError("symbols", str(given), "symbols", "take those of free_symbols")
        chosen.add(symbol)
    formula = formula_of(expression, "expression")
    if _expanded_terms(formula) > MOST_TERMS:
        allowed = f"one of at most {MOST_TERMS:,} terms when expanded"
        raise InputError("expression", f"{formula!s:.60}", allowed, "pass lower powers")
    expanded = se.expand(formula)
    summands = expanded.args if isinstance(expanded, se.Add) else (expanded,)
    terms: dict[Any, Any] = {}
    for summand in summands:
        factors = summand.args if isinstance(summand, se.Mul) else (summand,)
        inside = [f for f in factors if f.free_symbols and f.free_symbols <= chosen]
        monomial = se.Mul(*inside)
        terms[monomial] = terms.get(monomial, 0) + summand / monomial
    return {monomial: value for monomial, value in terms.items() if value != 0}


def _expanded_terms(node: Any) -> int:
    """At least as many terms, or words, as an expanded expression has, without expanding it."""
    if isinstance(node, se.Add):
        return sum(map(_expanded_terms, node.args))
    if isinstance(node, se.Mul):
        return math.prod(map(_expanded_terms, node.args))
    base, power = node.args if isinstance(node, se.Pow) else (node, se.Integer(1))
    if not (isinstance(base, se.Add) and isinstance(power, se.Integer) and power > 0):
        return 1
    terms, n = _expanded_terms(base), int(power)
    if terms > 1 and n > MOST_TERMS:
        return n
    return math.comb(n + terms - 1, n) * (1 + n // POWER_OF_A_WORD)


@public
def same_series(a: LindstedtSeries, b: LindstedtSeries) -> bool:
    """Are two universal series the same polynomials, term by term?

    All u_q^(k) and W_q^(k) are compared exactly as polynomials in the symbols L_q(nu), also
    between 'symbolic' and 'nested', and between chains of different N, where a mode that one chain
    lacks has to be zero in the other. Couplings and seeds have to be the same.

    a, b : universal series; for one of every N and one of a number, the first is taken at that
        number. All is dimensionless.

    Ours. Raises InputError for series with numbers, and where polynomials do not fit into memory.

    >>> from symfpu.series.lindstedt import lindstedt
    >>> short, long = (lindstedt(Chain(N, alpha=1), (1, 2), order=2) for N in (7, 30))
    >>> same_series(short, long), short.chain.N > 3 * max(short.seeds)
    (True, True)
    """
    for series in (a, b):
        if not series.symbolic or not all(
            isinstance(t, NodeTable) for t in series.coordinates
        ):
            advice = "leave frequencies out"
            raise InputError("series", series.ring, "a series in universal form", advice)
    a, b = _at_the_same_length(a, b)
    if (a.seeds, a.order) != (b.seeds, b.order):
        return False
    highest = a.degree(a.order)
    if a.chain.relative_couplings(highest) != b.chain.relative_couplings(highest):
        return False
    if _same_arrays(a, b):
        return True
    return all(_same_order(a, b, k) for k in range(a.order + 1))


def _at_the_same_length(
    a: LindstedtSeries, b: LindstedtSeries
) -> tuple[LindstedtSeries, LindstedtSeries]:
    if isinstance(a, SeriesForAllN) != isinstance(b, SeriesForAllN):
        if isinstance(a, SeriesForAllN):
            a = a.at_length(b.chain.N)
        elif isinstance(b, SeriesForAllN):
            b = b.at_length(a.chain.N)
    return a, b


def _same_arrays(a: LindstedtSeries, b: LindstedtSeries) -> bool:
    """The same program, and the same nodes of it."""
    first, second = a.coordinates[0].program, b.coordinates[0].program
    pairs = [(first.start, second.start), *zip(first.terms, second.terms, strict=True)]
    pairs += [(x.nodes, y.nodes) for x, y in zip(_tables(a), _tables(b), strict=True)]
    return first.symbols == second.symbols and all(np.array_equal(x, y) for x, y in pairs)


def _tables(series: LindstedtSeries) -> list[NodeTable]:
    return [*series.coordinates, *series.corrections[1:]]


def _same_order(a: LindstedtSeries, b: LindstedtSeries, k: int) -> bool:
    """All polynomials of an order, one by one."""
    tables = [(s.coordinates[k], list(s.modes)) for s in (a, b)]
    if k:
        tables += [(s.corrections[k], list(s.seeds)) for s in (a, b)]
    polynomials = [_polynomials(table, columns) for table, columns in tables]
    return polynomials[0::2] == polynomials[1::2]


def _polynomials(table: NodeTable, columns: Sequence[int]) -> dict[tuple[int, int], Any]:
    """By row and mode, what is not zero: {sorted names of symbols: integer}."""
    present = np.argwhere(table.nonzero)
    if not len(present):
        return {}
    expansion = Expansion(table.program, np.unique(table.nodes[table.nonzero]))
    names = [_name(symbol) for symbol in table.program.symbols]
    found = {}
    for row, column in present.tolist():
        polynomial = expansion.polynomial(int(table.nodes[row, column]))
        monomials = {}
        for numbers, c in zip(*(part.tolist() for part in polynomial), strict=True):
            monomials[tuple(sorted(names[i] for i in numbers if i >= 0))] = c
        if monomials:
            found[row, columns[column]] = monomials
    return found


def _name(symbol: Any) -> str:
    return (
        str(multiplier_symbol(*symbol)) if isinstance(symbol, Multiplier) else str(symbol)
    )
