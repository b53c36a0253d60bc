"""Taylor series of expressions by power series arithmetic: in rationals, or in balls.

An expression is walked from its leaves; every node is one operation of FLINT on series in r. In
rationals a function is taken where its value at r = 0 is rational as well, as e^0 or log 1; what
is left goes to balls, whose radii say how many digits are right.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from functools import lru_cache
from typing import Any

import flint
import sympy

from symfpu.chain.potentials.expressions.text import parsed, refused, stretch

BITS_PER_DIGIT = 3.33
SPARE_TERMS = (
    8  # lost by quotients that are regular though their denominators vanish at zero
)
SPARE_BITS = 64
FINEST = 8  # times the asked digits: what is zero to so many is zero
LARGEST_BALL = flint.arb(2) ** 100_000
SIZES = "V whose Taylor coefficients are of size 1e-30000 to 1e30000, or zero"
ANALYTIC = "an expression that is analytic and real at r = 0"
Series = Any


class Irrational(Exception):
    """A number that the rationals do not have."""


class Walker(ABC):
    """One kind of power series."""

    @abstractmethod
    def series(self, coefficients: list[Any]) -> Series:
        """From its first coefficients."""

    @abstractmethod
    def constant(self, number: Any) -> Series:
        """A number of SymPy that is not rational."""

    @abstractmethod
    def power(self, base: Series, exponent: Any) -> Series:
        """With a rational exponent that is no integer."""

    @abstractmethod
    def applied(self, name: str, argument: Series) -> Series:
        """A function of the list in text.py."""

    def walk(self, node: Any) -> Series:
        """The series of an expression."""
        if node == stretch():
            return self.series([0, 1])
        if node.is_Rational:
            return self.series([flint.fmpq(int(node.p), int(node.q))])
        if node.is_Add:
            return sum(map(self.walk, node.args[1:]), self.walk(node.args[0]))
        if node.is_Mul or node.is_Pow:
            return self._product(node)
        if node.is_Function and len(node.args) == 1:
            return self.applied(node.func.__name__, self.walk(node.args[0]))
        return self.constant(node)

    def _product(self, node: Any) -> Series:
        """Factors above and below the line apart: a quotient may be regular where they vanish."""
        above, below = self.series([1]), self.series([1])
        for factor in sympy.Mul.make_args(node):
            base, exponent = factor.as_base_exp()
            if exponent.is_Integer and exponent < 0:
                below *= self.walk(base) ** int(-exponent)
            else:
                above *= self._powered(base, exponent)
        return above if below.length() == 1 and below[0] == 1 else above / below

    def _powered(self, base: Any, exponent: Any) -> Series:
        if exponent.is_Integer:
            return self.walk(base) ** int(exponent)
        if base == sympy.E:
            return self.applied("exp", self.walk(exponent))
        if exponent.is_Rational:
            return self.power(self.walk(base), exponent)
        logarithm = self.applied("log", self.walk(base))
        return self.applied("exp", self.walk(exponent) * logarithm)


class RationalWalker(Walker):
    """Series with rational coefficients."""

    def series(self, coefficients: list[Any]) -> Series:
        return flint.fmpq_series(coefficients)

    def constant(self, number: Any) -> Series:
        raise Irrational

    def power(self, base: Series, exponent: Any) -> Series:
        start = base[0]
        root = sympy.Rational(int(start.p), int(start.q)) ** exponent
        if not root.is_Rational or root == 0:
            raise Irrational
        p, q = int(exponent.p), int(exponent.q)
        logarithm = (base / self.series([start])).log()
        unit = (logarithm * flint.fmpq(p, q)).exp()
        return unit * self.walk(root)

    def applied(self, name: str, argument: Series) -> Series:
        start = 1 if name == "log" else 0
        function = getattr(argument, name, None)
        if argument[0] != start or function is None:
            raise Irrational
        return function()


class BallWalker(Walker):
    """Series whose coefficients are balls that hold them."""

    def series(self, coefficients: list[Any]) -> Series:
        return flint.arb_series([flint.arb(c) for c in coefficients])

    def constant(self, number: Any) -> Series:
        if number == sympy.pi:
            return self.series([flint.arb.pi()])
        if number == sympy.E:
            return self.series([flint.arb.const_e()])
        raise refused(number)

    def power(self, base: Series, exponent: Any) -> Series:
        p, q = int(exponent.p), int(exponent.q)
        if q == 2:
            return base.sqrt() ** p if p > 0 else self.series([1]) / base.sqrt() ** -p
        return (base.log() * flint.arb(flint.fmpq(p, q))).exp()

    def applied(self, name: str, argument: Series) -> Series:
        own = getattr(argument, name, None)
        return own() if own else _by_exponentials(name, argument)


def _by_exponentials(name: str, x: Series) -> Series:
    """The hyperbolic functions and their inverses."""
    e = x.exp()
    match name:
        case "sinh":
            return (e - 1 / e) / 2
        case "cosh":
            return (e + 1 / e) / 2
        case "tanh":
            return (e * e - 1) / (e * e + 1)
        case "asinh":
            return (x + (x * x + 1).sqrt()).log()
        case "acosh":
            return (x + (x * x - 1).sqrt()).log()
        case "atanh":
            return ((1 + x) / (1 - x)).log() / 2
    raise refused(name)


def _coefficients(walker: Walker, expression: Any, terms: int) -> list[Any]:
    """The first coefficients of an expression; InputError where it has none."""
    with _length(terms + SPARE_TERMS):
        found = _walked(walker, expression)
        missing = terms - found.length()
        return [found[n] for n in range(found.length())][:terms] + [flint.fmpq(0)] * missing


def _walked(walker: Walker, expression: Any) -> Series:
    """As it stands, and else over one denominator."""
    failures = (ValueError, ZeroDivisionError, OverflowError)
    try:
        return walker.walk(expression)
    except failures:
        try:
            return walker.walk(sympy.together(expression))
        except failures as error:
            raise refused(str(expression), ANALYTIC) from error


@contextmanager
def _length(terms: int) -> Iterator[None]:
    """FLINT's series cut to so many terms."""
    before = flint.ctx.cap
    flint.ctx.cap = terms
    try:
        yield
    finally:
        flint.ctx.cap = before


def value_at_rest(text: str) -> Any:
    """V(0) as a ball."""
    with flint.ctx.workprec(4 * SPARE_BITS):
        return flint.arb(_coefficients(BallWalker(), parsed(text), 1)[0])


@lru_cache(maxsize=64)
def _tension(text: str) -> Any:
    """V' as an expression."""
    return sympy.diff(parsed(text), stretch())


@lru_cache(maxsize=256)
def rational_tension(text: str, terms: int) -> tuple[Fraction, ...] | None:
    """The first coefficients of V' in rationals; None where they are not all met as such."""
    try:
        found = _coefficients(RationalWalker(), _tension(text), terms)
    except Irrational:
        return None
    return tuple(Fraction(int(c.p), int(c.q)) for c in found)


@lru_cache(maxsize=256)
def rounded_tension(text: str, terms: int, digits: int) -> tuple[Fraction, ...]:
    """The first coefficients of V', each rounded to so many digits."""
    bits = int(digits * BITS_PER_DIGIT) + SPARE_BITS
    finest = FINEST * bits
    while True:
        with flint.ctx.workprec(bits):
            found = _coefficients(BallWalker(), _tension(text), terms)
            balls = [flint.arb(c) for c in found]
            if not all(ball.is_finite() for ball in balls):
                raise refused(text, ANALYTIC)
            if not all(abs(ball) < LARGEST_BALL and _is_seen(ball) for ball in balls):
                raise refused(text, SIZES, "take another unit of length")
            if bits >= finest or all(_known(ball, digits) for ball in balls):
                return tuple(_rounded(ball, digits) for ball in balls)
        bits *= 2


def _is_seen(ball: Any) -> bool:
    """Zero or not too small: its exact number is not longer than it need be."""
    return bool(ball.contains(0) or abs(ball) > 1 / LARGEST_BALL)


def _known(ball: Any, digits: int) -> bool:
    return bool(ball == 0) or ball.rel_accuracy_bits() >= digits * BITS_PER_DIGIT + 8


def _rounded(ball: Any, digits: int) -> Fraction:
    """A ball that holds zero at the finest precision is zero."""
    if ball.contains(0):
        return Fraction(0)
    return Fraction(ball.str(digits, radius=False))
