"""The public face names an argument of a wrong type.

A public function runs as it is. Where it ends in an error of Python's own, or in NaN, its arguments
are held against their annotations, and the first that does not fit is named by an InputError. If
all fit, what came is passed on: it is a fault of ours, or of a function that was passed.
"""

from __future__ import annotations

import collections.abc
import functools
import inspect
import math
import threading
import types
import typing
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from numbers import Complex, Integral
from typing import Any, TypeVar

import mpmath
import numpy as np

from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.typed import exact

Public = TypeVar("Public")
UNIONS = (typing.Union, types.UnionType)


class _Array:
    """Stands for numpy's ArrayLike, which as a union would take every text."""


class _Exact:
    """Stands for Number: what `exact` reads."""


COMPLEX = {"Q", "P", "dQ", "dP"}  # names of arrays that are complex on a ring
MARKERS = {"ArrayLike": _Array, "Number": _Exact}


class _Thread(threading.local):
    """Whether a public function runs in this thread."""

    inside = False


_THREAD = _Thread()


def public(thing: Public) -> Public:
    """A function, or a class with its methods, that names an argument which does not fit."""
    if not isinstance(thing, type):
        return typing.cast(Public, _named(thing))
    for name, member in list(vars(thing).items()):
        if inspect.isfunction(member) and not name.startswith("_"):
            setattr(thing, name, _named(member))
    return thing


def _named(function: Any) -> Any:
    """The function, with errors of Python's own explained, and overflow of doubles.

    Calls of public functions by each other are ours, and no argument of theirs is named. It keeps
    the globals of its module, where doctest looks for it; what it needs is in its closure.
    """
    explained, unknown, honest = misfit, has_nan, (SymfpuError, OSError)
    thread, large, errstate = _THREAD, too_large, np.errstate

    def call(*arguments: Any, **named: Any) -> Any:
        if thread.inside:
            return function(*arguments, **named)
        thread.inside = True
        try:
            with errstate(over="raise"):
                result = function(*arguments, **named)
        except honest:
            raise
        except Exception as error:
            refusal = explained(function, arguments, named)
            if refusal is None and isinstance(error, FloatingPointError):
                refusal = large(function, arguments, named)
            if refusal is None:
                raise
            raise refusal from error
        finally:
            thread.inside = False
        if unknown(result):
            refusal = explained(function, arguments, named)
            if refusal is not None:
                raise refusal
        return result

    made = types.FunctionType(
        call.__code__, function.__globals__, function.__name__, None, call.__closure__
    )
    return functools.update_wrapper(made, function)


def has_nan(result: Any) -> bool:
    """Whether a number, or one of an array or of a tuple of such, is NaN."""
    if isinstance(result, tuple):
        return any(map(has_nan, result))
    if isinstance(result, np.ndarray):
        return result.dtype.kind in "fc" and bool(np.isnan(result).any())
    return (
        isinstance(result, float | complex | np.inexact | mpmath.mpf) and result != result
    )


def misfit(
    function: Callable[..., Any], arguments: Iterable[Any], named: Mapping[str, Any]
) -> InputError | None:
    """The refusal of the first argument that does not fit its annotation; None if all do."""
    signature = inspect.signature(function)
    try:
        given = signature.bind(*arguments, **named).arguments
    except TypeError:
        return None  # an argument too many or too few, which Python names
    for name, value in given.items():
        parameter = signature.parameters[name]
        hint = _hint(function, parameter.annotation)
        several = parameter.kind is parameter.VAR_POSITIONAL
        for one in value if several else [value]:
            if one is not parameter.default and not _fits_name(one, hint, name):
                return InputError(
                    name, one, wording(hint), f"see help({function.__name__})"
                )
    return None


def too_large(
    function: Callable[..., Any], arguments: Iterable[Any], named: Mapping[str, Any]
) -> InputError:
    """The refusal of the largest argument, for a result that is beyond doubles."""
    given = inspect.signature(function).bind(*arguments, **named).arguments
    name = max(given, key=lambda each: _largest(given[each]))
    allowed = "numbers whose results are within doubles, below 1e308"
    return InputError(name, given[name], allowed, "take smaller ones")


def _largest(value: Any) -> float:
    """Of the numbers of an argument; -1 of what has none."""
    try:
        return float(np.max(np.abs(np.asarray(value, dtype=complex))))
    except (TypeError, ValueError, OverflowError):
        return -1.0


def _fits_name(value: Any, hint: Any, name: str) -> bool:
    """Whether it fits a parameter of this name: complex arrays are states on a ring alone."""
    if not fits(value, hint):
        return False
    return hint is not _Array or name in COMPLEX or not np.iscomplexobj(value)


def _hint(function: Any, annotation: Any) -> Any:
    """An annotation as types; Any where it cannot be read."""
    if not isinstance(annotation, str):
        return Any if annotation is inspect.Parameter.empty else annotation
    try:
        return eval(annotation, {**function.__globals__, **MARKERS})  # noqa: S307, of our own source
    except (NameError, TypeError):
        return Any  # a name for type checkers alone


def fits(value: Any, hint: Any) -> bool:
    """Whether a value is of the type of an annotation; numbers by their value, too."""
    origin, parts = typing.get_origin(hint), typing.get_args(hint)
    if origin in UNIONS:
        return any(fits(value, part) for part in parts)
    if origin is typing.Literal:
        return value in parts
    if hint in SIMPLE:
        return SIMPLE[hint](value)
    if origin is not None:
        return _fits_container(value, origin, parts)
    if isinstance(hint, type):
        return _has_members(value, hint) if _is_protocol(hint) else isinstance(value, hint)
    return True


def wording(hint: Any) -> str:
    """A type in words."""
    if typing.get_origin(hint) in UNIONS:
        return " or ".join(map(wording, typing.get_args(hint)))
    if hint in WORDS:
        return WORDS[hint]
    origin = typing.get_origin(hint) or hint
    if origin is collections.abc.Callable:
        arguments = [part for part in typing.get_args(hint)[:1] if part is not Ellipsis]
        count = sum(map(len, arguments))
        return f"a function of {count} arguments" if count else "a function"
    name = getattr(origin, "__name__", str(origin))
    elements = [wording(part) for part in typing.get_args(hint) if part is not Ellipsis]
    return f"{name} of {', '.join(elements)}" if elements else name


def _fits_container(value: Any, origin: Any, parts: tuple[Any, ...]) -> bool:
    """A mapping, a sequence or another generic type, with its elements where it has some."""
    if not isinstance(value, origin):
        return origin in SEQUENCES and isinstance(value, np.ndarray) and value.ndim > 0
    if origin is collections.abc.Callable:
        return _takes(value, parts[0])
    if origin not in SEQUENCES and origin not in MAPPINGS:
        return True
    if isinstance(value, str | bytes | collections.abc.Iterator):
        return isinstance(value, collections.abc.Iterator)
    if origin in MAPPINGS:
        key, element = parts
        return all(fits(k, key) and fits(v, element) for k, v in value.items())
    if origin is tuple and Ellipsis not in parts:
        return len(value) == len(parts) and all(map(fits, value, parts))
    return all(fits(element, parts[0]) for element in value)


def _takes(function: Callable[..., Any], parameters: Any) -> bool:
    """Whether a function may be called with so many arguments; True where nothing is known."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return True
    try:
        signature.bind(*([] if parameters is Ellipsis else parameters))
    except TypeError:
        return parameters is Ellipsis
    return True


SEQUENCES = {
    list,
    tuple,
    collections.abc.Sequence,
    collections.abc.Iterable,
    collections.abc.Collection,
}
MAPPINGS = {dict, collections.abc.Mapping}


def _is_protocol(hint: type) -> bool:
    return bool(getattr(hint, "_is_protocol", False))


def _has_members(value: Any, hint: type) -> bool:
    """Whether a value has what a protocol asks for."""
    classes = [owner for owner in hint.__mro__ if _is_protocol(owner)]
    fields = (vars(owner).get("__annotations__", {}) for owner in classes)
    names = {name for part in (*map(vars, classes), *fields) for name in part}
    return all(hasattr(value, name) for name in names if not name.startswith("_"))


def _is_integer(value: Any) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool)


def _is_float(value: Any) -> bool:
    """A finite real number within the range of doubles."""
    if isinstance(value, bool | str | bytes):
        return False
    try:
        return math.isfinite(float(value))
    except (TypeError, ValueError, OverflowError, RuntimeError, ArithmeticError):
        return False


def _is_exact(value: Any) -> bool:
    try:
        exact(value, "")
    except InputError:
        return False
    return True


def _is_array(value: Any) -> bool:
    """An array of finite numbers, or nested sequences of them.

    States on a ring are complex; a number alone, such as a time, is real.
    """
    if isinstance(value, str | bytes | complex | np.complexfloating):
        return False
    try:
        array = np.asarray(value)
        return bool(np.isfinite(array.astype(np.complex128)).all())
    except (TypeError, ValueError, OverflowError, RuntimeError, ArithmeticError):
        return False


SIMPLE: dict[Any, Callable[[Any], bool]] = {
    Any: lambda value: True,
    object: lambda value: True,
    None: lambda value: value is None,
    type(None): lambda value: value is None,
    bool: lambda value: isinstance(value, bool | np.bool_),
    int: _is_integer,
    float: _is_float,
    complex: lambda value: isinstance(value, Complex),
    str: lambda value: isinstance(value, str),
    Fraction: _is_exact,
    _Array: _is_array,
    _Exact: _is_exact,
    collections.abc.Callable: callable,
}
WORDS: dict[Any, str] = {
    Any: "any value",
    type(None): "None",
    bool: "True or False",
    int: "integer",
    float: "finite number within the range of doubles",
    str: "text",
    _Array: "array of finite numbers",
    _Exact: "exact number such as '0.33'",
}
