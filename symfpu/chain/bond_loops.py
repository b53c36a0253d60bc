"""The law of one bond inside compiled loops.

Importing this module imports numba, whose overloads have no annotations. A loop that calls
`tension(law, r)` is compiled for the type of its law: the coefficients of a polynomial, or the
class of a closed law with its own functions. These may call functions of their module, which are
compiled with them, and methods of the class. Where they are not for the compiler, the class has
others named after them, `tension_loop`, that make one from the decorator of its parts. r is a
number or lanes of numbers (symfpu.numbers.lanes): all lanes at once where the class says
`takes_lanes`, with exponentials and logarithms of our own (symfpu.numbers.exponentials),
else one after the other.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any

from numba.core import types
from numba.core.errors import NumbaError
from numba.core.registry import cpu_target
from numba.extending import overload, overload_method

from symfpu.chain import bonds
from symfpu.chain.bonds import stiffness, tension
from symfpu.compiled import compiled
from symfpu.errors import InputError
from symfpu.numbers import functions
from symfpu.numbers.exponentials import expm1_loop, log1p_loop
from symfpu.numbers.lanes import LANES, LanesType, lane, with_lane

__all__ = ["run_loop", "stiffness", "tension"]

Function = Callable[..., Any]
# a loop that calls its law is not cut into vectors
_inlined = compiled(error_model="numpy", keep=False, forceinline=True)
_series = _inlined(functions.expm2_series)
_of_exp, _of_log = _inlined(expm1_loop), _inlined(log1p_loop)
STEP_FAILED = re.compile(r"Failed in nopython mode pipeline \(step: [^)]*\)\s*")


def run_loop(loop: Function, law: bonds.Law, *arguments: Any) -> Any:
    """What a compiled loop returns for these arguments, of which `law` is one.

    The first call with a class of laws compiles its functions. InputError where the compiler does
    not take them; a polynomial is no class of its own, and what fails with it is our fault.
    """
    try:
        return loop(*arguments)
    except NumbaError as error:
        if type(law) is tuple:
            raise
        why = STEP_FAILED.split(str(error))[-1].partition("\n")[0]
        allowed = "one whose law numba compiles, with the functions that it calls"
        advice = (
            f"write tension and stiffness with math, numpy and numbers; numba says: {why}"
        )
        raise InputError("potential", type(law).__name__, allowed, advice) from error


def _with_parts(function: Function, made: dict[Function, Function]) -> Any:
    """A function compiled together with the functions of Python that it calls by name.

    made : those that are on the way already; a function that calls itself stays as it is.
    """
    if not isinstance(function, FunctionType) or _has_overload(function):
        return function
    made[function] = function
    known = function.__globals__
    parts = {
        name: made.get(part) or _with_parts(part, made)
        for name in function.__code__.co_names
        if isinstance(part := known.get(name), FunctionType)
    }
    whole = function
    if parts:
        defaults, cells = function.__defaults__, function.__closure__
        around = {**known, **parts}
        whole = FunctionType(function.__code__, around, None, defaults, cells)
    made[function] = _inlined(whole)
    return made[function]


def _has_overload(function: Function) -> bool:
    """Whether the compiler knows the function as it stands."""
    context = cpu_target.typing_context
    context.refresh()
    try:
        context.resolve_value_type(function)
    except ValueError:
        return False
    return True


@cache
def _teach_methods(kind: type[Any]) -> None:
    """Teaches the compiler the methods of a class of laws, so that one may call another."""
    for name, _ in inspect.getmembers(kind, inspect.isfunction):
        if not hasattr(tuple, name) and not name.startswith("__"):
            _teach_method(name)


@cache
def _teach_method(name: str) -> None:
    def choose(law, *arguments):  # type: ignore[no-untyped-def]
        own = getattr(getattr(law, "instance_class", None), name, None)
        if own is None:
            return None
        loop = _with_parts(own, {})
        return lambda law, *arguments: loop(law, *arguments)

    overload_method(types.BaseNamedTuple, name)(choose)


def _law_by_type(function: Function, of_polynomials: Function) -> None:
    """Teaches the compiler a function of symfpu.chain.bonds."""

    def choose(law, r):  # type: ignore[no-untyped-def]
        kind = getattr(law, "instance_class", None)
        own = getattr(kind, function.__name__, None)
        of_parts = getattr(kind, f"{function.__name__}_loop", None)
        if own and not of_parts:
            _teach_methods(kind)
        loop = of_parts(_inlined) if of_parts else _with_parts(own or of_polynomials, {})

        def of_every_lane(law, r):  # type: ignore[no-untyped-def]
            for place in range(LANES):
                r = with_lane(r, place, loop(law, lane(r, place)))
            return r

        if own and isinstance(r, LanesType) and not hasattr(kind, "takes_lanes"):
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
