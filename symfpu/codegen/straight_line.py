"""Small series as statements after common-subexpression elimination, for SymPy's printers.

A harmonic coefficient c_k(A) is computed once a call, a cosine and a sine of every harmonic once a
time: Q_q = sum c_k cos(nu.theta), P_q = sum d_k sin(nu.theta) with d_k = -(nu.omega) c_k.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import mpmath
import symengine as se
import sympy

from symfpu.algebra.polynomials import Polynomial
from symfpu.chain.chain import Chain
from symfpu.codegen.series_tables import monomial
from symfpu.codegen.torus_program import DOUBLE_DIGITS
from symfpu.errors import ExpansionTooLarge
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers
from symfpu.series.series import LindstedtSeries

# Operations, up to which a call with few times is faster than by tables, and compiling is too.
STRAIGHT_LINE = 1000

# Operations of a universal form before and after elimination: 7 s of compiling.
LARGEST_PROGRAM = 40_000
LARGEST_ELIMINATED = 15_000

CONSTANT_DIGITS = 40

Statement = tuple[str, sympy.Expr]
Powers = tuple[int, ...]
Row = tuple[Powers, Powers, int, Any]  # harmonic, powers of A, mode, coefficient
Constants = dict[
    str, tuple[Any, str]
]  # name -> (value, the same as an expression of mpmath)


@dataclass(frozen=True, eq=False)
class StraightLine:
    """Names and expressions in the order in which they are to be computed.

    Given are A1.. (amplitude of every seed, by mode), and omega1.., theta1.. where they are
    needed. Expressions hold these, constants, names of statements before, exact rationals and
    Floats. coefficients : statements of the amplitudes, once a call. waves : cosines and sines of
    theta, once a time. positions, momenta : one expression for each mode 1 .. N-1.
    frequency_statements, then corrected (s,) and jacobian (s, s).
    """

    constants: Constants
    coefficients: tuple[Statement, ...] = field(repr=False)
    waves: tuple[Statement, ...] = field(repr=False)
    positions: tuple[sympy.Expr, ...] = field(repr=False)
    momenta: tuple[sympy.Expr, ...] = field(repr=False)
    frequency_statements: tuple[Statement, ...] = field(repr=False)
    corrected: tuple[sympy.Expr, ...] = field(repr=False)
    jacobian: tuple[tuple[sympy.Expr, ...], ...] = field(repr=False)

    @property
    def statements(self) -> tuple[Statement, ...]:
        """All of them."""
        return (*self.coefficients, *self.waves, *self.frequency_statements)

    @property
    def results(self) -> tuple[sympy.Expr, ...]:
        """Q, P, omega(A) and its Jacobian, row by row."""
        return (*self.positions, *self.momenta, *self.corrected, *sum(self.jacobian, ()))

    @property
    def digest(self) -> str:
        """SHA-256 of all statements and results as text."""
        named = [f"{name} = {sympy.srepr(e)}" for name, e in self.statements]
        results = map(sympy.srepr, self.results)
        described = repr([*named, *results])
        return hashlib.sha256(described.encode()).hexdigest()

    @property
    def operations(self) -> int:
        """Additions, multiplications and function calls, all of them."""
        expressions = [e for _, e in self.statements]
        expressions += self.results
        return sum(int(sympy.count_ops(e)) for e in expressions)

    @property
    def coefficient_symbols(self) -> set[str]:
        """Names in the statements of the coefficients."""
        return _symbols(e for _, e in self.coefficients)

    @property
    def frequency_symbols(self) -> set[str]:
        """Names in corrected frequencies, their Jacobian, and the statements for both."""
        expressions = [e for _, e in self.frequency_statements]
        slopes = sum(self.jacobian, ())
        return _symbols([*expressions, *self.corrected, *slopes])


def _symbols(expressions: Iterable[sympy.Expr]) -> set[str]:
    return {str(symbol) for e in expressions for symbol in e.free_symbols}


def straight_line(
    N: int,
    seeds: Sequence[int],
    rows: Iterable[Row],
    frequencies: Sequence[Polynomial],
    constants: Constants,
) -> StraightLine:
    """Statements for Q_q, the sum over rows of coefficient A^e cos(nu.theta), and omega_i(A).

    frequencies : of every seed, polynomials {powers of A: coefficient}.
    """
    amplitudes = _Symbols("A", seeds)
    orbit = _Orbit(N, seeds, rows)
    omega = [amplitudes.polynomial(terms) for terms in frequencies]
    slopes = [sympy.diff(w, a) for w in omega for a in amplitudes.symbols]
    shared, reduced = _shared([*omega, *slopes], "y")
    s = len(seeds)
    corrected, *jacobian = (tuple(reduced[i : i + s]) for i in range(0, len(reduced), s))
    needed = [e for _, e in (*orbit.coefficients, *shared)]
    used = _symbols([*needed, *reduced])
    names = sorted(used & constants.keys())
    return StraightLine(
        constants={name: constants[name] for name in names},
        coefficients=_eliminated(orbit.coefficients, "x"),
        waves=tuple(orbit.waves),
        positions=tuple(orbit.positions),
        momenta=tuple(orbit.momenta),
        frequency_statements=tuple(shared),
        corrected=corrected,
        jacobian=tuple(jacobian),
    )


class _Symbols:
    """One symbol for every seed: a letter and the mode."""

    def __init__(self, letter: str, seeds: Sequence[int]) -> None:
        self.symbols = [sympy.Symbol(f"{letter}{q}") for q in seeds]

    def monomial(self, powers: Sequence[int]) -> sympy.Expr:
        """The product of powers."""
        factors = [x**e for x, e in zip(self.symbols, powers, strict=True)]
        return sympy.Mul(*factors)

    def polynomial(self, coefficients: Polynomial) -> sympy.Expr:
        """The sum of monomials times their coefficients."""
        terms = [value * self.monomial(e) for e, value in coefficients.items()]
        return sympy.Add(*terms)

    def combination(self, numbers: Sequence[int]) -> sympy.Expr:
        """The sum of multiples."""
        terms = [n * x for n, x in zip(numbers, self.symbols, strict=True)]
        return sympy.Add(*terms)


class _Orbit:
    """Statements and sums of Q and P, built harmonic by harmonic."""

    def __init__(self, N: int, seeds: Sequence[int], rows: Iterable[Row]) -> None:
        self.omega = _Symbols("omega", seeds)
        self.theta = _Symbols("theta", seeds)
        self.coefficients: list[Statement] = []
        self.waves: list[Statement] = []
        self.positions = [sympy.Integer(0)] * (N - 1)
        self.momenta = [sympy.Integer(0)] * (N - 1)
        sums = _sums(seeds, rows)
        harmonics = sorted(sums, key=lambda nu: (sum(map(abs, nu)), nu))
        for h, nu in enumerate(harmonics):
            moving = any(nu)
            if moving:
                self._add_wave(h, nu)
            for mode, terms in sorted(sums[nu].items()):
                self._add_term(h, mode, sympy.Add(*terms), moving=moving)

    def _add_wave(self, h: int, nu: Powers) -> None:
        angle = self.theta.combination(nu)
        rate = self.omega.combination(nu)
        self.waves.append((f"cos{h}", sympy.cos(angle)))
        self.waves.append((f"sin{h}", sympy.sin(angle)))
        self.coefficients.append((f"rate{h}", rate))

    def _add_term(
        self, h: int, mode: int, coefficient: sympy.Expr, *, moving: bool
    ) -> None:
        """A harmonic that does not move has no wave, and no momentum."""
        c, d = sympy.symbols(f"c{h}_{mode} d{h}_{mode}")
        column = mode - 1
        self.coefficients.append((c.name, coefficient))
        if not moving:
            self.positions[column] += c
            return
        cosine, sine, rate = sympy.symbols(f"cos{h} sin{h} rate{h}")
        self.positions[column] += c * cosine
        self.momenta[column] += d * sine
        self.coefficients.append((d.name, -rate * c))


def _sums(
    seeds: Sequence[int],
    rows: Iterable[Row],
) -> dict[Powers, dict[int, list[sympy.Expr]]]:
    """The terms of every harmonic in every mode that has it."""
    amplitudes = _Symbols("A", seeds)
    sums: dict[Powers, dict[int, list[sympy.Expr]]] = {}
    for nu, powers, mode, value in rows:
        of_harmonic = sums.setdefault(nu, {})
        terms = of_harmonic.setdefault(mode, [])
        terms.append(value * amplitudes.monomial(powers))
    return sums


def _shared(
    expressions: Sequence[sympy.Expr],
    prefix: str,
) -> tuple[list[Statement], list[sympy.Expr]]:
    """Statements for what expressions have in common, and the expressions in these names."""
    names = sympy.numbered_symbols(prefix)
    shared, reduced = sympy.cse(list(expressions), symbols=names)
    statements = [(str(name), e) for name, e in shared]
    return statements, reduced


def _eliminated(statements: Sequence[Statement], prefix: str) -> tuple[Statement, ...]:
    """The same statements without common subexpressions, whose new names come first."""
    names, expressions = zip(*statements, strict=True)
    shared, reduced = _shared(expressions, prefix)
    own = zip(names, reduced, strict=True)
    return tuple(_ordered([*shared, *own]))


def _ordered(statements: Sequence[Statement]) -> Iterator[Statement]:
    """Every statement after those it needs; otherwise the order they have."""
    known = dict(statements)
    done: set[str] = set()

    def visit(name: str) -> Iterator[Statement]:
        if name in done or name not in known:
            return
        done.add(name)
        needed = map(str, known[name].free_symbols)
        for other in sorted(needed):
            yield from visit(other)
        yield name, known[name]

    for name, _ in statements:
        yield from visit(name)


def numeric_statements(
    series: LindstedtSeries,
    order: int,
    scales: Numbers,
    frequencies: Sequence[Polynomial],
) -> StraightLine:
    """Of a series with chosen frequencies. frequencies : of every seed, in powers of A."""
    places = DOUBLE_DIGITS if series.digits is None else series.digits + 2
    with MULTIPRECISION.context(places):
        rows: list[Row] = []
        for k in range(order + 1):
            rows += _numeric_rows(series, k, scales, places)
        polynomials = [_numbers(polynomial, places) for polynomial in frequencies]
    return straight_line(series.chain.N, series.seeds, rows, polynomials, {})


def _numeric_rows(
    series: LindstedtSeries,
    k: int,
    scales: Numbers,
    places: int,
) -> Iterator[Row]:
    """Terms of order k in the amplitudes themselves."""
    terms = [part.tolist() for part in series.amplitude_terms(k)]
    for nu, e, values in zip(*terms, strict=True):
        harmonic, powers = tuple(nu), tuple(e)
        factor = monomial(scales, powers)
        for q, value in enumerate(values, 1):
            if value != 0:
                coefficient = number(factor * value, places)
                yield harmonic, powers, q, coefficient


def _numbers(polynomial: Polynomial, places: int) -> Polynomial:
    return {e: number(c, places) for e, c in polynomial.items()}


def number(value: Any, digits: int) -> sympy.Float:
    """An mpf as SymPy's Float."""
    text = mpmath.nstr(value, digits + 3)
    return sympy.Float(text, digits)


def universal_statements(
    series: LindstedtSeries,
    order: int,
    frequency_order: int,
) -> StraightLine | None:
    """Of a series in universal form, its multipliers L_q(nu) written out in the frequencies.

    None where the expressions are too large for straight-line code.
    """
    N, seeds = series.chain.N, series.seeds
    if not _short(_expressions(series, order, frequency_order)):
        return None
    known = _Multipliers(series.chain, seeds)
    rows: list[Row] = []
    for q in range(1, N):
        for k in range(order + 1):
            rows += _universal_rows(series, q, k, known)
    frequencies = [_universal_frequency(series, q, frequency_order, known) for q in seeds]
    straight = straight_line(N, seeds, rows, frequencies, known.constants)
    return straight if straight.operations <= LARGEST_ELIMINATED else None


def _expressions(
    series: LindstedtSeries, order: int, frequency_order: int
) -> Iterator[Any]:
    """All coefficients of coordinates and frequencies, low orders first."""
    for k in range(max(order, frequency_order) + 1):
        for q in range(1, series.chain.N):
            if k <= order:
                _, values = series.coefficients(q, k)
                yield from values
        for q in series.seeds:
            if k <= frequency_order:
                _, values = series.frequency_coefficients(q, k)
                yield from values


def _short(expressions: Iterable[Any]) -> bool:
    """Whether expressions have at most LARGEST_PROGRAM operations, and can be expanded at all."""
    size = 0
    try:
        for value in expressions:
            size += se.count_ops(value)
            if size > LARGEST_PROGRAM:
                return False
    except ExpansionTooLarge:
        return False
    return True


def _universal_rows(
    series: LindstedtSeries,
    q: int,
    k: int,
    known: _Multipliers,
) -> Iterator[Row]:
    """Terms of mode q at order k, from powers of e^(i theta) A and of e^(-i theta) A."""
    exponents, values = series.coefficients(q, k)
    for e, value in zip(exponents, values, strict=True):
        plus, minus = e[0::2], e[1::2]
        nu = plus - minus
        powers = plus + minus
        degree = int(powers.sum())
        pair = 2 if nu.any() else 1
        factor = sympy.Rational(pair, 2**degree)
        coefficient = factor * known.mu**k * known.written_out(value)
        yield tuple(nu.tolist()), tuple(powers.tolist()), q, coefficient


def _universal_frequency(
    series: LindstedtSeries,
    q: int,
    order: int,
    known: _Multipliers,
) -> Polynomial:
    """omega_q(A) up to an order."""
    polynomial: Polynomial = {}
    for k in range(order + 1):
        exponents, values = series.frequency_coefficients(q, k)
        for e, value in zip(exponents, values, strict=True):
            powers = tuple(e.tolist())
            coefficient = known.mu**k * known.written_out(value)
            polynomial[powers] = coefficient
    return polynomial


class _Multipliers:
    """The symbols of the universal form.

    Omega_q and mu are constants, L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2).
    """

    def __init__(self, chain: Chain, seeds: Sequence[int]) -> None:
        self.chain = chain
        self.seeds = tuple(seeds)
        self.omega = _Symbols("omega", seeds)
        self.constants: Constants = {}
        self.mu = self._small_parameter()
        self._known: dict[Any, sympy.Expr] = {}

    def _small_parameter(self) -> sympy.Expr:
        unit = self.chain.unit_coupling
        twice = 2 * self.chain.N
        if self.chain.degree_step == 2:
            coupling = sympy.Rational(unit.numerator, unit.denominator)
            return coupling / twice
        with mpmath.workdps(CONSTANT_DIGITS):
            coupling = mpmath.mpf(unit.numerator) / unit.denominator
            value = coupling / mpmath.sqrt(twice)
        text = f"mp.mpf({unit.numerator}) / {unit.denominator} / mp.sqrt({twice})"
        self.constants["mu"] = value, text
        return sympy.Symbol("mu")

    def written_out(self, value: Any) -> sympy.Expr:
        """A coefficient of the universal form as an expression in A, omega and constants."""
        expression = sympy.sympify(value)
        symbols = expression.free_symbols
        known = {symbol: self._written_out(symbol) for symbol in symbols}
        return expression.xreplace(known)

    def _written_out(self, symbol: sympy.Symbol) -> sympy.Expr:
        if symbol not in self._known:
            numbers = re.findall(r"-?\d+", symbol.name)
            mode, *harmonic = map(int, numbers)
            if symbol.name.startswith("L_"):
                self._known[symbol] = self._multiplier(mode, harmonic)
            else:
                self._known[symbol] = self._linear(mode)
        return self._known[symbol]

    def _linear(self, q: int) -> sympy.Symbol:
        name = f"linear{q}"
        if name not in self.constants:
            with mpmath.workdps(CONSTANT_DIGITS):
                value = self.chain.linear_frequency(q)
            text = f"2 * mp.sinpi(mp.mpf({q}) / {2 * self.chain.N})"
            self.constants[name] = value, text
        return sympy.Symbol(name)

    def _multiplier(self, mode: int, harmonic: Sequence[int]) -> sympy.Expr:
        linear = self._linear(mode)
        own = linear
        if mode in self.seeds:
            i = self.seeds.index(mode)
            own = self.omega.symbols[i]
        rate = self.omega.combination(harmonic)
        return linear**2 / (own**2 - rate**2)
