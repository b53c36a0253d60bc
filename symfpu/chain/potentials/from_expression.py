"""Any potential that can be written down: V(r) as an expression, or as text."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from symfpu.chain.bonds import Law
from symfpu.chain.potentials.expressions.text import (
    named_stretch,
    parsed,
    refused,
    stretch,
    text_of,
)
from symfpu.chain.potentials.polynomial import HIGHEST_DEGREE, polynomial
from symfpu.chain.potentials.potential import Growth, Potential, checked_coupling
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import MULTIPRECISION, Arithmetic
from symfpu.numbers.public import public

OTHER_NAMES = ("expr",)
DIGITS, MOST_DIGITS = 50, 2000
SHORTEST = 32  # coefficients at once; twice as many when they do not suffice
LARGEST_POWER_OF_TEN = 300  # of coefficients, which laws take as doubles
LARGEST_COEFFICIENT = Fraction(10**LARGEST_POWER_OF_TEN)
LONGEST_ZERO = 64  # coefficients that may all be zero before V is taken for r^2/2


@dataclass(frozen=True, repr=False)
class Expression(Potential):
    """V(r) as text; coefficients are exact where all numbers on the way to them are rational."""

    kind = "from_expression"

    formula: str
    asked_digits: int = DIGITS

    @property
    def parameters(self) -> tuple[Fraction, ...]:
        return ()

    @cached_property
    def exact(self) -> bool:  # type: ignore[override]
        return self._rational(SHORTEST) is not None

    @property
    def digits(self) -> int | None:  # type: ignore[override]
        return None if self.exact else self.asked_digits

    @cached_property
    def degree(self) -> int | None:
        import sympy

        r = stretch()
        V = parsed(self.formula)
        return int(sympy.Poly(V, r).degree()) if V.is_polynomial(r) else None

    @cached_property
    def even(self) -> bool:
        import sympy

        if any(self.tension_series(LONGEST_ZERO)[::2]):
            return False
        r, V = stretch(), parsed(self.formula)
        return bool(sympy.expand(V - V.subs(r, -r)) == 0)

    @cached_property
    def wall(self) -> float | None:  # type: ignore[override]
        from symfpu.chain.potentials.expressions.domain import domain

        nearest = min(domain(self.formula), key=abs)
        return nearest if math.isfinite(nearest) else None

    def coefficient(self, n: int) -> Fraction:
        if self.even and n % 2:
            return Fraction(0)
        length = SHORTEST
        while length < n:
            length *= 2
        return self.tension_series(length)[n - 1]

    def tension_series(self, terms: int) -> tuple[Fraction, ...]:
        """The first coefficients of V'."""
        from symfpu.chain.potentials.expressions.series import rounded_tension

        rational = self._rational(terms)
        if rational is not None:
            return rational
        return rounded_tension(self.formula, terms, self.asked_digits)

    def _rational(self, terms: int) -> tuple[Fraction, ...] | None:
        from symfpu.chain.potentials.expressions.series import rational_tension

        return rational_tension(self.formula, terms)

    def growths(self) -> tuple[Growth, ...]:
        return self._growths

    @cached_property
    def _growths(self) -> tuple[Growth, ...]:
        """Of exponentials and powers; none of an even V, whose unit has a square root."""
        from symfpu.chain.potentials.expressions.growth import parts_of_tension

        if self.even:
            return ()
        return tuple(Growth(*part) for part in parts_of_tension(self.formula))

    def law(self, numbers: Arithmetic) -> Law:
        from symfpu.chain.potentials.expressions import law as laws

        if numbers is MULTIPRECISION:
            lowest = next(n for n in range(3, LONGEST_ZERO + 1) if self.coefficient(n))
            return laws.PreciseLaw(self.formula, lowest - 1)
        count = laws.TERMS + laws.CHECKED
        coefficients = tuple(self.coefficient(n) for n in range(3, 3 + count))
        return laws.rounded_law(self.formula, coefficients, numbers)

    def expression(self, r: Any) -> Any:
        return parsed(self.formula).subs(stretch(), r)

    @property
    def text(self) -> str:
        digits = f",r,{self.asked_digits}" if self.asked_digits != DIGITS else ""
        return f"{self.kind}:{self.formula}{digits}"

    def __repr__(self) -> str:
        digits = f", digits={self.asked_digits}" if self.asked_digits != DIGITS else ""
        return f"from_expression({self.formula!r}{digits})"


@public
def from_expression(V: Any, r: Any = "r", digits: int | str = DIGITS) -> Potential:
    """The potential V(r) of a bond, an expression of SymPy or SymEngine in r, or as text.

    V : of numbers, r, powers, exp, log, the trigonometric and the hyperbolic functions and their
        inverses, with V(0) = V'(0) = 0 and V''(0) = 1; dimensionless. Floats are read by their
        shortest decimals. On the command line expr:cosh(r)-1.
    r : the symbol of the stretch.
    digits : of the Taylor coefficients c_n where numbers such as sqrt(2) are in the way; then
        `potential.exact` is False, and there are no proofs and no series of more digits. Where
        all numbers are rational the coefficients are exact.

    A polynomial with rational coefficients gives the same as `polynomial`. The law in doubles is
    V itself, near r = 0 its Taylor polynomial: anharmonic forces keep their digits but for those
    that 1/radius^2 has, the polynomial holding within the radius (up to 1).

    Ours. Raises InputError for an expression that is not analytic at r = 0, has a linear term or
    no unit stiffness there, or is r^2/2 and nothing else.

    >>> from symfpu import Chain
    >>> Chain(N=8, potential=from_expression("cosh(r) - 1"))
    Chain(N=8, potential=from_expression('cosh(r) - 1'))
    >>> Chain(N=8, potential=from_expression("r**2/2 + r**3/12"))
    Chain(N=8, alpha=0.25)
    """
    if isinstance(V, str):
        V, r = parsed(V, named_stretch(r)), stretch()
    potential = Expression(text_of(V, r), _digits(digits))
    _check_start(potential)
    return _as_polynomial(potential) or potential


def _digits(value: int | str) -> int:
    allowed = f"an integer from 1 to {MOST_DIGITS}"
    try:
        digits = int(value)
    except (TypeError, ValueError) as error:
        raise InputError("digits", value, allowed, "pass a whole number") from error
    if isinstance(value, (bool, float)) or not 1 <= digits <= MOST_DIGITS:
        raise InputError("digits", value, allowed, "pass a whole number")
    return digits


def _check_start(potential: Expression) -> None:
    """InputError where V does not begin as r^2/2, or ends there."""
    from symfpu.chain.potentials.expressions.series import value_at_rest

    V = potential.formula
    rest = value_at_rest(V)
    force, stiffness = potential.tension_series(SHORTEST)[:2]
    if not rest.contains(0):
        raise refused(V, "V with V(0) = 0", "subtract its value at r = 0")
    if force:
        allowed = f"V without a linear term, V'(0) = 0 and not {float(force):.6g}"
        raise refused(V, allowed, "write it in the stretch from its minimum")
    if stiffness != 1:
        allowed = f"V with unit stiffness, V''(0) = 1 and not {float(stiffness):.6g}"
        raise refused(V, allowed, "divide it by its stiffness")
    beyond = potential.tension_series(LONGEST_ZERO)[2:]
    if not any(beyond):
        raise refused(V, "V with a term beyond r^2/2", "add one: 'r**2/2 + r**3/3'")
    lowest = next(n for n, c in enumerate(beyond, 3) if c)
    checked_coupling(beyond[lowest - 3], f"c_{lowest} of V")
    for n, c in enumerate(beyond, 3):
        if abs(c) > LARGEST_COEFFICIENT:
            allowed = f"V whose Taylor coefficients are below 1e{LARGEST_POWER_OF_TEN}"
            advice = f"c_{n} is not: take another unit of length"
            raise refused(V, allowed, advice)


def _as_polynomial(potential: Expression) -> Potential | None:
    """The polynomial that an expression is; None where it is none of rationals."""
    degree = potential.degree
    if degree is None or degree > HIGHEST_DEGREE or not potential.exact:
        return None
    return polynomial(*map(potential.coefficient, range(3, degree + 1)))
