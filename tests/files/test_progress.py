"""One shape of progress: every function that tells of its work takes the same callback."""

import importlib
import inspect
import math
import pkgutil
import typing

import pytest

import symfpu
from symfpu import Chain, assess, lindstedt, refine, solve_amplitudes
from symfpu.files.progress import Progress


def _modules():
    for found in pkgutil.walk_packages(symfpu.__path__, "symfpu."):
        if found.name != "symfpu.__main__":
            yield importlib.import_module(found.name)


def _callables(module):
    """Functions that a module defines, and those of its classes, by their full names."""
    for thing in vars(module).values():
        if getattr(thing, "__module__", None) != module.__name__:
            continue
        if inspect.isfunction(thing):
            yield thing
        elif inspect.isclass(thing):
            yield from (method for method in vars(thing).values() if inspect.isfunction(method))


def _name(function):
    return f"{function.__module__}.{function.__qualname__}"


DEFINED = {_name(function): function for module in _modules() for function in _callables(module)}
TELLING = {name: function for name, function in DEFINED.items() if "progress" in inspect.signature(function).parameters}


@pytest.mark.parametrize("name", TELLING)
def test_every_progress_is_of_the_one_type(name):
    hint = typing.get_type_hints(TELLING[name])["progress"]
    assert hint in (Progress, Progress | None)


def test_fractions_go_from_nothing_to_all_and_labels_say_what_is_done():
    told = []
    series = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 4, progress=lambda *one: told.append(one))
    torus = solve_amplitudes(series)
    assess(series, torus, progress=lambda *one: told.append(one))
    refine(torus, progress=lambda *one: told.append(one))
    assert all(isinstance(label, str) and isinstance(fraction, float) for label, fraction in told)
    known = [fraction for _, fraction in told if not math.isnan(fraction)]
    assert 0 < len(known) < len(told)
    assert all(0 <= fraction <= 1 for fraction in known)
