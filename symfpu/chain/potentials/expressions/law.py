"""The law of a bond of any expression: closed functions, and a Taylor polynomial near zero.

V'(r) - r and its like cancel as r goes to zero. Doubles and long doubles take the first TERMS
coefficients within a radius where what is left out is below their rounding; beyond it the closed
functions lose the bits of 1/radius^2 at most. Numbers of many digits take the closed functions at
as many bits more as cancel. From the singularities of V on all are no numbers.

Each expression has a class of laws of its own, since compiled loops know laws by their class. Its
name holds the expression, so that it is found again where it is pickled and where numba keeps
machine code on disk.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from typing import Any, ClassVar, NamedTuple

import mpmath
import numpy as np

from symfpu.chain import bonds
from symfpu.chain.potentials.expressions.domain import domain
from symfpu.chain.potentials.expressions.text import parsed, stretch
from symfpu.numbers.arithmetic import Arithmetic

TERMS = 24  # of the polynomial, c_3 and up
CHECKED = 12  # more, by which its radius is found
LARGEST_RADIUS, SMALLEST_RADIUS = 1.0, 2.0**-20
DIGITS = 60  # of constants in long doubles
PREFIX = "ExpressionLaw_"
SPARE_BITS = 30
LARGEST_INTEGER = 2**31
NAMES = ("potential", "tension", "stiffness", "anharmonic_tension", "anharmonic_stiffness")
POLYNOMIALS = {name: getattr(bonds, f"polynomial_{name}") for name in NAMES}


def derivatives(text: str) -> dict[str, Any]:
    """The five functions of a bond as expressions in r."""
    import sympy

    r, V = stretch(), parsed(text)
    tension, stiffness = sympy.diff(V, r), sympy.diff(V, r, 2)
    values = (V, tension, stiffness, tension - r, stiffness - 1)
    return dict(zip(NAMES, values, strict=True))


@dataclass(frozen=True)
class Parts:
    """Expressions whose constants are symbols of their own: arithmetics differ in them."""

    functions: dict[str, Any]
    constants: dict[Any, Any]


@lru_cache(maxsize=64)
def _parts(text: str) -> Parts:
    constants: dict[Any, Any] = {}
    functions = {
        name: _lifted(expression, constants)
        for name, expression in derivatives(text).items()
    }
    return Parts(functions, constants)


def _lifted(node: Any, constants: dict[Any, Any]) -> Any:
    """The expression with a symbol for every number that is no integer."""
    import sympy

    short = node.is_Integer and abs(node) < LARGEST_INTEGER
    if short or node.is_Symbol:
        return node
    if not node.free_symbols:
        return constants.setdefault(node, sympy.Symbol(f"k{len(constants)}"))
    return node.func(*(_lifted(part, constants) for part in node.args))


class _Functions:
    """The five functions of a bond, made when they are first asked for: a class is cheap.

    Whoever opens numba's cache makes the classes of all expressions that were ever compiled.
    """

    formula: ClassVar[str]

    def potential(self, r: Any) -> Any:
        return _of_arrays(self, "potential", r)

    def tension(self, r: Any) -> Any:
        return _of_arrays(self, "tension", r)

    def stiffness(self, r: Any) -> Any:
        return _of_arrays(self, "stiffness", r)

    def anharmonic_tension(self, r: Any) -> Any:
        return _of_arrays(self, "anharmonic_tension", r)

    def anharmonic_stiffness(self, r: Any) -> Any:
        return _of_arrays(self, "anharmonic_stiffness", r)

    @classmethod
    def tension_loop(cls, compiled: Any) -> Any:
        return _of_loops(cls.formula, "tension", compiled)

    @classmethod
    def stiffness_loop(cls, compiled: Any) -> Any:
        return _of_loops(cls.formula, "stiffness", compiled)


@cache
def law_class(formula: str, constants: int) -> type[Any]:
    """The class of the laws of an expression with so many constants."""
    name = f"{PREFIX}{constants}_{formula.encode().hex()}"
    fields: Any = namedtuple  # whose names type checkers want to be literal
    base = fields(f"_{name}", _fields(constants))
    own = {"formula": formula, "__slots__": (), "__module__": __name__}
    return type(name, (_Functions, base), own)


def _fields(constants: int) -> list[str]:
    symbols = [f"k{n}" for n in range(constants)]
    return ["radius", "least", "most", *symbols, *(f"c{n}" for n in range(3, 3 + TERMS))]


def __getattr__(name: str) -> type[Any]:
    """The class of an expression, by the name it is pickled with."""
    if not name.startswith(PREFIX):
        raise AttributeError(name)
    constants, formula = name.removeprefix(PREFIX).split("_")
    return law_class(bytes.fromhex(formula).decode(), int(constants))


@lru_cache(maxsize=256)
def _closed(formula: str, name: str) -> Callable[..., Any]:
    """A function of a law and a stretch in NumPy's names."""
    import sympy

    parts = _parts(formula)
    symbols = tuple(map(sympy.Symbol, _fields(len(parts.constants))))
    return _function((symbols, stretch()), parts.functions[name])


def _function(arguments: Any, expression: Any) -> Callable[..., Any]:
    import sympy

    made: Callable[..., Any] = sympy.lambdify(
        arguments, expression, modules="numpy", cse=True
    )
    return made


def _of_arrays(law: Any, name: str, r: Any) -> Any:
    """A function of a bond for numbers and arrays of doubles or long doubles."""
    stretches = np.atleast_1d(r)
    near = np.abs(stretches) < law.radius
    coefficients = tuple(law[-TERMS:])
    inside = POLYNOMIALS[name](coefficients, np.where(near, stretches, 0 * stretches))
    closed = _closed(law.formula, name)
    regular = (stretches > law.least) & (stretches < law.most)
    outside = closed(law, np.where(regular & ~near, stretches, law.radius))
    outside = np.where(regular, outside, np.nan)
    return np.where(near, inside, outside).reshape(np.shape(r))[()]


def _of_loops(formula: str, name: str, compiled: Any) -> Any:
    """A function of a bond for one double inside of loops, by the decorator of its parts."""
    import sympy

    symbols = tuple(map(sympy.Symbol, _fields(len(_parts(formula).constants))))
    polynomial = _nested(symbols[-TERMS:])[name]
    inside = compiled(sympy.lambdify((symbols, stretch()), polynomial))
    outside = compiled(_closed(formula, name))

    def function(law: Any, r: Any) -> Any:
        if abs(r) < law[0]:
            return inside(law, r)
        return outside(law, r) if law[1] < r < law[2] else np.nan

    return compiled(function)


def _nested(coefficients: tuple[Any, ...]) -> dict[str, Any]:
    """The polynomials of tension and stiffness by Horner's rule, written out for the compiler."""
    import sympy

    r = stretch()
    tension = stiffness = sympy.Integer(0)
    for n in range(len(coefficients) + 1, 1, -1):
        tension = coefficients[n - 2] + r * tension
        stiffness = n * coefficients[n - 2] + r * stiffness
    return {"tension": r + r * (r * tension), "stiffness": 1 + r * stiffness}


def rounded_law(
    text: str, coefficients: tuple[Fraction, ...], numbers: Arithmetic
) -> bonds.Law:
    """The law in doubles or long doubles, from c_3 and so on, TERMS + CHECKED of them."""
    parts = _parts(text)
    constants = [numbers.number(_fraction(constant)) for constant in parts.constants]
    kept = [numbers.number(c) for c in coefficients[:TERMS]]
    rounding = float(np.finfo(type(kept[0])).eps)
    radius = numbers.number(_radius(coefficients, rounding))
    walls = (type(radius)(wall) for wall in domain(text))
    make: Any = law_class(text, len(constants))
    return make._make((radius, *walls, *constants, *kept))  # type: ignore[no-any-return]


def _fraction(constant: Any) -> Fraction:
    """A number of SymPy, rounded to far more digits than a long double has."""
    import sympy

    if not constant.is_Rational:
        constant = sympy.Rational(str(constant.evalf(DIGITS)))
    return Fraction(int(constant.p), int(constant.q))


def _radius(coefficients: tuple[Fraction, ...], rounding: float) -> Fraction:
    """The largest power of two within which the terms left out of V'' - 1 are below rounding."""
    sizes = [abs(float(c)) * n for n, c in enumerate(coefficients, 2)]
    powers = range(1, len(sizes) + 1)
    radius = LARGEST_RADIUS
    while radius > SMALLEST_RADIUS:
        terms = [size * radius**n for n, size in zip(powers, sizes, strict=True)]
        if sum(terms[TERMS:]) <= rounding * max(terms[:TERMS]):
            break
        radius /= 2
    return Fraction(radius)


class PreciseLaw(NamedTuple):
    """The law at the working precision of mpmath."""

    text: str
    lowest: int  # the least power of r in V' - r

    def potential(self, r: Any) -> Any:
        return self._values("potential", 2, r)

    def tension(self, r: Any) -> Any:
        return self._values("tension", 1, r)

    def stiffness(self, r: Any) -> Any:
        return self._values("stiffness", 0, r)

    def anharmonic_tension(self, r: Any) -> Any:
        return self._values("anharmonic_tension", self.lowest, r)

    def anharmonic_stiffness(self, r: Any) -> Any:
        return self._values("anharmonic_stiffness", self.lowest - 1, r)

    def _values(self, name: str, power: int, r: Any) -> Any:
        """The function that goes to zero as a power of r, number by number."""
        closed = _precise_functions(self.text)[name]
        least, most = domain(self.text)

        def value(x: Any) -> Any:
            if not x:
                return mpmath.mpf(0 if power else 1)
            if not least < x < most:
                return mpmath.nan
            # two powers more for quotients that are regular though they vanish below the line
            lost = max(0, -(power + 2) * int(mpmath.mag(x)))
            with mpmath.workprec(mpmath.mp.prec + lost + SPARE_BITS):
                found = closed(mpmath.mpf(x))
            return +found

        return np.frompyfunc(value, 1, 1)(r)


@lru_cache(maxsize=64)
def _precise_functions(text: str) -> dict[str, Callable[..., Any]]:
    import sympy

    found = derivatives(text)
    r = stretch()
    return {name: sympy.lambdify(r, V, modules="mpmath") for name, V in found.items()}
