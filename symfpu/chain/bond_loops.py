"""The law of one bond inside compiled loops.

Importing this module imports numba, whose overloads have no annotations. A loop that calls
`tension(law, r)` is compiled for the type of its law: the coefficients of a polynomial, or the
class of a closed law with its own functions; where those are not for the compiler, the class has
others named after them, `tension_loop`, that make one from the decorator of its parts. r is a
number or lanes of numbers (symfpu.numbers.lanes), all of them at once, with exponentials and
logarithms of our own (symfpu.numbers.exponentials); a law made of an expression, whose functions
are calls, takes one lane after the other.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba.extending import overload

from symfpu.chain import bonds
from symfpu.chain.bonds import stiffness, tension
from symfpu.compiled import compiled
from symfpu.numbers import functions
from symfpu.numbers.exponentials import expm1_loop, log1p_loop
from symfpu.numbers.lanes import LANES, LanesType, lane, with_lane

__all__ = ["stiffness", "tension"]

Function = Callable[..., Any]
# a loop that calls its law is not cut into vectors
_inlined = compiled(error_model="numpy", keep=False, forceinline=True)
_series = _inlined(functions.expm2_series)
_of_exp, _of_log = _inlined(expm1_loop), _inlined(log1p_loop)


def _law_by_type(function: Function, of_polynomials: Function) -> None:
    """Teaches the compiler a function of symfpu.chain.bonds."""

    def choose(law, r):  # type: ignore[no-untyped-def]
        kind = getattr(law, "instance_class", None)
        own = getattr(kind, function.__name__, None)
        of_parts = getattr(kind, f"{function.__name__}_loop", None)
        loop = of_parts(_inlined) if of_parts else _inlined(own or of_polynomials)

        def of_every_lane(law, r):  # type: ignore[no-untyped-def]
            for place in range(LANES):
                r = with_lane(r, place, loop(law, lane(r, place)))
            return r

        if of_parts is not None and isinstance(r, LanesType):
            return of_every_lane
        return lambda law, r: loop(law, r)

    overload(function, jit_options={"forceinline": True})(choose)


_law_by_type(tension, bonds.polynomial_tension)
_law_by_type(stiffness, bonds.polynomial_stiffness)


@overload(functions.expm1, jit_options={"forceinline": True})
def _expm1(x):  # type: ignore[no-untyped-def]
    return lambda x: _of_exp(x)


@overload(functions.log1p, jit_options={"forceinline": True})
def _log1p(x):  # type: ignore[no-untyped-def]
    return lambda x: _of_log(x)


def _expm2_of_number(x):  # type: ignore[no-untyped-def]
    return float(_series(x)) if abs(x) < 1.0 else float(functions.expm1(x) - x)


@overload(functions.expm2, jit_options={"forceinline": True})
def _expm2(x):  # type: ignore[no-untyped-def]
    return _expm2_of_number
