"""Small series as statements after common-subexpression elimination, for SymPy's printers of every language.

A harmonic coefficient c_k(A) is computed once a call, a cosine and a sine of every harmonic once a time:
Q_q = sum c_k cos(nu.theta), P_q = sum d_k sin(nu.theta) with d_k = -(nu.omega) c_k.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import mpmath
import symengine as se
import sympy

from symfpu.algebra.polynomials import Polynomial
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers
from symfpu.series.series import LindstedtSeries

STRAIGHT_LINE = 1000  # operations; up to it a call with few times is faster than by tables, and compiling takes no longer

LARGEST, LARGEST_ELIMINATED = 40_000, 15_000  # operations of a universal form before and after elimination: 7 s of compiling
CONSTANT_DIGITS = 40

Statement = tuple[str, sympy.Expr]


@dataclass(frozen=True, eq=False)
class StraightLine:
    """Names and expressions in the order in which they are to be computed.

    Given are A1.. (amplitude of every seed, by mode), and omega1.., theta1.. where they are needed. Expressions hold these, names
    of statements before, exact rationals and Floats. constants : name -> (value, the same as an expression of mpmath).
    coefficients : statements of the amplitudes, once a call. waves : cosines and sines of theta, once a time.
    positions, momenta : one expression for each mode 1 .. N-1. frequency_statements, then corrected (s,) and jacobian (s, s).
    """

    constants: dict[str, tuple[Any, str]]
    coefficients: tuple[Statement, ...] = field(repr=False)
    waves: tuple[Statement, ...] = field(repr=False)
    positions: tuple[sympy.Expr, ...] = field(repr=False)
    momenta: tuple[sympy.Expr, ...] = field(repr=False)
    frequency_statements: tuple[Statement, ...] = field(repr=False)
    corrected: tuple[sympy.Expr, ...] = field(repr=False)
    jacobian: tuple[tuple[sympy.Expr, ...], ...] = field(repr=False)

    @property
    def described(self) -> list[str]:
        """All statements and results as text."""
        named = (*self.coefficients, *self.waves, *self.frequency_statements)
        results = (*self.positions, *self.momenta, *self.corrected, *(x for row in self.jacobian for x in row))
        return [*(f"{name} = {sympy.srepr(e)}" for name, e in named), *map(sympy.srepr, results)]

    @property
    def operations(self) -> int:
        """Additions, multiplications and function calls, all of them."""
        statements = (*self.coefficients, *self.waves, *self.frequency_statements)
        results = (*self.positions, *self.momenta, *self.corrected, *(x for row in self.jacobian for x in row))
        return int(sum(sympy.count_ops(e) for e in (*(e for _, e in statements), *results)))

    @property
    def coefficient_symbols(self) -> set[str]:
        """Names in the statements of the coefficients."""
        return _symbols(e for _, e in self.coefficients)

    @property
    def frequency_symbols(self) -> set[str]:
        """Names in corrected frequencies, their Jacobian, and the statements for both."""
        results = (*self.corrected, *(x for row in self.jacobian for x in row))
        return _symbols((*(e for _, e in self.frequency_statements), *results))


def _symbols(expressions: Iterable[sympy.Expr]) -> set[str]:
    return {str(symbol) for e in expressions for symbol in e.free_symbols}


Row = tuple[tuple[int, ...], tuple[int, ...], int, Any]  # harmonic, powers of A, mode, coefficient


def straight_line(
    N: int, seeds: Sequence[int], rows: Iterable[Row], frequencies: Sequence[Polynomial], constants: dict[str, tuple[Any, str]]
) -> StraightLine:
    """Statements for Q_q = sum over rows of coefficient A^e cos(nu.theta), and omega_i(A), polynomials {powers of A: coefficient}."""
    A, omega, theta = ([sympy.Symbol(f"{name}{q}") for q in seeds] for name in ("A", "omega", "theta"))

    def monomial(powers: Sequence[int]) -> sympy.Expr:
        return sympy.Mul(*(a**e for a, e in zip(A, powers, strict=True)))

    sums: dict[tuple[tuple[int, ...], int], list[sympy.Expr]] = {}
    for nu, powers, mode, value in rows:
        sums.setdefault((nu, mode), []).append(value * monomial(powers))
    harmonics = sorted({nu for nu, _ in sums}, key=lambda nu: (sum(map(abs, nu)), nu))
    coefficients: list[Statement] = []
    waves: list[Statement] = []
    positions, momenta = [sympy.Integer(0)] * (N - 1), [sympy.Integer(0)] * (N - 1)
    for h, nu in enumerate(harmonics):
        moving = any(nu)
        if moving:
            angle = sympy.Add(*(n * x for n, x in zip(nu, theta, strict=True)))
            waves += [(f"cos{h}", sympy.cos(angle)), (f"sin{h}", sympy.sin(angle))]
            coefficients.append((f"rate{h}", sympy.Add(*(n * w for n, w in zip(nu, omega, strict=True)))))
        for mode in range(1, N):
            if (nu, mode) not in sums:
                continue
            name = f"{h}_{mode}"
            c = sympy.Symbol(f"c{name}")
            coefficients.append((f"c{name}", sympy.Add(*sums[nu, mode])))
            positions[mode - 1] += c * sympy.Symbol(f"cos{h}") if moving else c
            if moving:
                coefficients.append((f"d{name}", -sympy.Symbol(f"rate{h}") * c))
                momenta[mode - 1] += sympy.Symbol(f"d{name}") * sympy.Symbol(f"sin{h}")
    corrected = [sympy.Add(*(value * monomial(e) for e, value in polynomial.items())) for polynomial in frequencies]
    jacobian = [[sympy.diff(w, a) for a in A] for w in corrected]
    shared, reduced = sympy.cse([*corrected, *(x for row in jacobian for x in row)], symbols=sympy.numbered_symbols("y"))
    s = len(seeds)
    used = {str(x) for e in (*(e for _, e in (*coefficients, *shared)), *reduced) for x in e.free_symbols}
    return StraightLine(
        constants={name: constants[name] for name in sorted(constants) if name in used},
        coefficients=tuple(_eliminated(coefficients, "x")),
        waves=tuple(waves),
        positions=tuple(positions),
        momenta=tuple(momenta),
        frequency_statements=tuple((str(name), e) for name, e in shared),
        corrected=tuple(reduced[:s]),
        jacobian=tuple(tuple(reduced[s * (i + 1) : s * (i + 2)]) for i in range(s)),
    )


def _eliminated(statements: Sequence[Statement], prefix: str) -> list[Statement]:
    """The same statements after common-subexpression elimination; new names begin with the prefix and come first."""
    shared, reduced = sympy.cse([e for _, e in statements], symbols=sympy.numbered_symbols(prefix))
    early = [(str(name), e) for name, e in shared]
    return [*_ordered([*early, *((name, e) for (name, _), e in zip(statements, reduced, strict=True))])]


def _ordered(statements: list[Statement]) -> Iterable[Statement]:
    """Every statement after those it needs; otherwise the order they have."""
    known = dict(statements)
    done: set[str] = set()

    def visit(name: str) -> Iterable[Statement]:
        if name in done or name not in known:
            return
        done.add(name)
        for other in sorted(known[name].free_symbols, key=str):
            yield from visit(str(other))
        yield name, known[name]

    for name, _ in statements:
        yield from visit(name)


def numeric_statements(series: LindstedtSeries, order: int, scales: Numbers, frequencies: Sequence[Polynomial]) -> StraightLine:
    """Of a series with chosen frequencies. frequencies : of every seed, in powers of A."""
    places = 17 if series.digits is None else series.digits + 2
    rows: list[Row] = []
    with MULTIPRECISION.context(places):
        for k in range(order + 1):
            for nu, powers, values in zip(*(x.tolist() for x in series.amplitude_terms(k)), strict=True):
                factor = mpmath.fprod(x**e for x, e in zip(scales, powers, strict=True))
                rows += [(tuple(nu), tuple(powers), q, number(factor * v, places)) for q, v in enumerate(values, 1) if v != 0]
        numbers = [{e: number(c, places) for e, c in polynomial.items()} for polynomial in frequencies]
    return straight_line(series.chain.N, series.seeds, rows, numbers, {})


def number(value: Any, digits: int) -> sympy.Float:
    """An mpf as SymPy's Float."""
    return sympy.Float(mpmath.nstr(value, digits + 3), digits)


def universal_statements(series: LindstedtSeries, order: int, frequency_order: int) -> StraightLine:
    """Of a series in universal form, with the multipliers L_q(nu) written out in the frequencies.

    Raises InputError where the expressions are too large for straight-line code.
    """
    chain, seeds = series.chain, series.seeds
    known = _Multipliers(chain, seeds)
    rows: list[Row] = []
    size = 0
    for q in range(1, chain.N):
        for k in range(order + 1):
            exponents, values = series.coefficients(q, k)
            size += sum(map(se.count_ops, values))
            _refuse_large(size, LARGEST)
            for e, value in zip(exponents, values, strict=True):
                nu, powers = e[0::2] - e[1::2], e[0::2] + e[1::2]
                factor = sympy.Rational(2 if nu.any() else 1, 2 ** int(powers.sum()))
                rows.append((_ints(nu), _ints(powers), q, factor * known.mu**k * known.written_out(value)))
    frequencies: list[Polynomial] = []
    for q in seeds:
        polynomial: Polynomial = {}
        for k in range(frequency_order + 1):
            exponents, values = series.frequency_coefficients(q, k)
            size += sum(map(se.count_ops, values))
            _refuse_large(size, LARGEST)
            polynomial |= {_ints(e): known.mu**k * known.written_out(v) for e, v in zip(exponents, values, strict=True)}
        frequencies.append(polynomial)
    straight = straight_line(chain.N, seeds, rows, frequencies, known.constants)
    _refuse_large(straight.operations, LARGEST_ELIMINATED)
    return straight


def _ints(row: Any) -> tuple[int, ...]:
    return tuple(int(x) for x in row)


def _refuse_large(size: int, largest: int) -> None:
    if size > largest:
        advice = "lower the orders, or give lindstedt frequencies: numbers become tables of any size"
        raise InputError("series", "universal form", f"expressions of at most {largest} operations, which compilers take", advice)


class _Multipliers:
    """The symbols of the universal form: Omega_q and mu are constants, L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2)."""

    def __init__(self, chain: Chain, seeds: Sequence[int]) -> None:
        self.chain, self.seeds = chain, seeds
        self.omega = {q: sympy.Symbol(f"omega{q}") for q in seeds}
        self.constants: dict[str, tuple[Any, str]] = {}
        self.mu = self._small_parameter()
        self._known: dict[Any, sympy.Expr] = {}

    def _small_parameter(self) -> sympy.Expr:
        chain = self.chain
        if chain.alpha == 0:
            return sympy.Rational(chain.beta.numerator, chain.beta.denominator) / (2 * chain.N)
        ratio = f"mp.mpf({chain.alpha.numerator}) / {chain.alpha.denominator}"
        with mpmath.workdps(CONSTANT_DIGITS):
            value = mpmath.mpf(chain.alpha.numerator) / chain.alpha.denominator / mpmath.sqrt(2 * chain.N)
        self.constants["mu"] = value, f"{ratio} / mp.sqrt({2 * chain.N})"
        return sympy.Symbol("mu")

    def written_out(self, value: Any) -> sympy.Expr:
        """A coefficient of the universal form as an expression in A, omega and constants."""
        expression = sympy.sympify(value)
        return expression.xreplace({symbol: self._written_out(symbol) for symbol in expression.free_symbols})

    def _written_out(self, symbol: sympy.Symbol) -> sympy.Expr:
        if symbol not in self._known:
            mode, *harmonic = map(int, re.findall(r"-?\d+", symbol.name))
            self._known[symbol] = self._multiplier(mode, harmonic) if symbol.name.startswith("L_") else self._linear(mode)
        return self._known[symbol]

    def _linear(self, q: int) -> sympy.Symbol:
        name = f"linear{q}"
        if name not in self.constants:
            with mpmath.workdps(CONSTANT_DIGITS):
                value = 2 * mpmath.sinpi(mpmath.mpf(q) / (2 * self.chain.N))
            self.constants[name] = value, f"2 * mp.sinpi(mp.mpf({q}) / {2 * self.chain.N})"
        return sympy.Symbol(name)

    def _multiplier(self, mode: int, harmonic: Sequence[int]) -> sympy.Expr:
        own = self.omega.get(mode, self._linear(mode))
        rate = sympy.Add(*(n * w for n, w in zip(harmonic, self.omega.values(), strict=True)))
        return self._linear(mode) ** 2 / (own**2 - rate**2)
