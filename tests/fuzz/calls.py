"""One call of the public face by its number: which function, which arguments, what became of it.

The number decides everything, so that a call is repeated by its number alone.
"""

import contextlib
import dataclasses
import inspect
import io
import random
import warnings
from functools import cache

import mpmath
import numpy as np

import symfpu
from symfpu import SymfpuError
from tests.fuzz import commands, values

# too dear to be called often, or without end by their nature: a share of the calls of the others
RARELY = {"atlas", "frequency_map", "profile_invariance", "prove_for_all_N", "sweep_propagation", "family", "normal_family"}
# what runs other programs or draws, and what has processes of its own
LEFT_OUT = {"import_module", "init_printing", "plot", "to_xarray", "compile_evaluator"}
RETURNED, REFUSED, FAULT = "returned", "refused", "fault"


@dataclasses.dataclass(frozen=True)
class Outcome:
    """number : of the call. where : the function. kind : returned, refused or fault. what : in words."""

    number: int
    where: str
    kind: str
    what: str


@cache
def functions():
    """Every public function, the constructor of chains, and public methods of results, by name."""
    found = {}
    for name in symfpu.__all__:
        value = getattr(symfpu, name)
        if inspect.isfunction(value) and name not in LEFT_OUT:
            found[name] = value
    found["Chain"] = symfpu.Chain
    return found


@cache
def methods():
    """Names of public methods by the maker of a result."""
    found = {}
    for maker in (*values.CHAINS[:1], *values.RESULTS):
        owner = maker()
        for name, _ in inspect.getmembers(type(owner), callable):
            if not name.startswith("_") and name not in LEFT_OUT:
                found[f"{type(owner).__name__}.{name}"] = (maker, name)
    return found


def chosen(number):
    """(name, function, arguments) of a call."""
    draw = random.Random(number)
    if draw.random() < 0.12:
        verb, words = commands.chosen(draw)
        return f"symfpu {verb}", commands.run, ([verb, words], {})
    if draw.random() < 0.3:
        name = draw.choice(sorted(methods()))
        maker, method = methods()[name]
        function = getattr(maker(), method)
    else:
        name = draw.choice(sorted(functions()))
        if name in RARELY and draw.random() < 0.8:
            name = "lindstedt"
        function = functions()[name]
    return name, function, arguments(function, draw)


def arguments(function, draw):
    """Sound values of what is required and of some of the rest; one, two or none of them odd."""
    try:
        parameters = list(inspect.signature(function).parameters.values())
    except ValueError:
        return [], {}
    given = {}
    for parameter in parameters:
        required = parameter.default is parameter.empty
        if required or draw.random() < 0.4:
            value = values.sound(parameter.name, draw)
            given[parameter.name] = value if value is not None or required else parameter.default
    for name in draw.sample(sorted(given), min(len(given), draw.choice((0, 1, 1, 1, 2)))):
        given[name] = values.odd(draw)
    return _placed(parameters, given)


def _placed(parameters, given):
    positional, named = [], {}
    for parameter in parameters:
        if parameter.name not in given:
            continue
        if parameter.kind is parameter.VAR_POSITIONAL:
            positional.append(given[parameter.name])
        elif parameter.kind is parameter.VAR_KEYWORD:
            continue
        elif parameter.kind is parameter.POSITIONAL_ONLY:
            positional.append(given[parameter.name])
        else:
            named[parameter.name] = given[parameter.name]
    return positional, named


def called(number):
    """What becomes of the call of this number."""
    name, function, (positional, named) = chosen(number)
    said = io.StringIO()
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            warnings.simplefilter("error", RuntimeWarning)
            result = function(*positional, **named)
            if inspect.isgenerator(result):
                result = next(result, None)
            repr(result)
    except SymfpuError as error:
        lines = str(error).count("\n")
        return Outcome(number, name, FAULT if lines else REFUSED, f"{type(error).__name__}: {error}")
    except OSError as error:  # of files, by their names, as everywhere in Python
        named = error.filename is not None
        return Outcome(number, name, REFUSED if named else FAULT, f"{type(error).__name__}: {error}")
    except Exception as error:
        return Outcome(number, name, FAULT, f"{type(error).__name__}: {error}")
    if function is commands.run:
        return judged(number, name, result, said.getvalue())
    if not_a_number(result) and "nan" not in words(function).lower():
        return Outcome(number, name, FAULT, "NaN without a word")
    return Outcome(number, name, RETURNED, "")


def judged(number, name, code, said):
    """What becomes of a command that ended with this exit code, and said this."""
    if code not in {0, 1, 2} or "Traceback" in said:
        return Outcome(number, name, FAULT, f"exit code {code}: {said[-200:]}")
    return Outcome(number, name, REFUSED if code else RETURNED, "")


def words(function):
    """What the documentation of a function and of its class says."""
    owner = getattr(function, "__self__", None)
    return f"{inspect.getdoc(function)} {inspect.getdoc(type(owner)) if owner is not None else ''}"


def not_a_number(value, depth=3):
    """Whether a number in a result is NaN, in its arrays and fields, too."""
    if isinstance(value, float | complex | np.inexact):
        return bool(np.isnan(value))
    if isinstance(value, mpmath.mpf):
        return bool(mpmath.isnan(value))
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "fc" and bool(np.isnan(value).any())
    if depth == 0:
        return False
    if isinstance(value, dict):
        return any(not_a_number(part, depth - 1) for part in value.values())
    if isinstance(value, list | tuple):
        return any(not_a_number(part, depth - 1) for part in value)
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        parts = (getattr(value, field.name) for field in dataclasses.fields(value))
        return "nan" not in words(type(value)).lower() and any(not_a_number(part, depth - 1) for part in parts)
    return False


def described(number):
    """The call in words, for one who repeats it."""
    name, _, (positional, named) = chosen(number)
    parts = [_short(value) for value in positional] + [f"{key}={_short(value)}" for key, value in named.items()]
    return f"{name}({', '.join(parts)})"


def _short(value):
    text = repr(value)
    return text if len(text) < 120 else f"{text[:80]}... {len(text)} characters"
