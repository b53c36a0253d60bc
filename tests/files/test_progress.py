"""One shape of progress: every function that tells of its work takes the same callback."""

import importlib
import inspect
import math
import pkgutil
import typing

import pytest

import symfpu
from symfpu.chain.chain import Chain
from symfpu.files.progress import Progress
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.verdict import assess


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


def test_the_functions_that_tell_are_found():
    public = {name for name in symfpu.__all__ if _name(getattr(symfpu, name)) in TELLING}
    assert public >= {"lindstedt", "assess", "integrate", "alignment_indices", "family", "refine", "sweep_propagation"}
    assert len(TELLING) > 40


@pytest.mark.parametrize("name", TELLING)
def test_every_progress_is_of_the_one_type(name):
    hint = typing.get_type_hints(TELLING[name])["progress"]
    assert hint in (Progress, Progress | None)


@pytest.mark.parametrize("name", sorted(name for name in symfpu.__all__ if _name(getattr(symfpu, name)) in TELLING))
def test_public_functions_may_be_left_unheard_and_say_what_they_tell(name):
    function = getattr(symfpu, name)
    assert inspect.signature(function).parameters["progress"].default is None
    assert "progress : called as (label, " in inspect.getdoc(function)


def test_no_callback_has_another_shape():
    """Functions of a line, or of counts, under whatever name."""
    words = ("Callable[[str], None]", "Callable[[int, int], None]")
    hints = {(name, p.name): str(p.annotation) for name, f in DEFINED.items() for p in inspect.signature(f).parameters.values()}
    assert [place for place, hint in hints.items() if any(word in hint for word in words)] == []


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
