"""Docstrings of public names leave nothing out: arguments, shapes, units, errors, sources, an example.

The examples themselves run with the tests (`--doctest-modules`).
"""

import ast
import builtins
import dataclasses
import importlib
import inspect
import re
import textwrap

import pytest

import symfpu

LONGEST_LINE = 100
UNITS = r"\b(dimensionless|radians|seconds|decades|bytes|in any unit|units of)\b"
SOURCES = r"\b(eqs?\. |figs?\. |sections? \d|appendix [a-f]|definition \d|proposition|lemma|mtac \d|ours\b)"
ARRAYS = ("ArrayLike", "NDArray", "Floats", "Ints", "Numbers")
SHAPE = r"\(([A-Z]|[ns1]|order|\.\.\.)[^()]*,[^()]*\)"  # such as (N-1,), (H, s), (..., N-1)
NO_ERRORS = {"init_printing"}  # these raise nothing, and say so
NO_CLASSES = {"SymPy", "RunInterrupted", "NumPy", "SymEngine", "IntegerTables"}

PUBLIC = {name: getattr(symfpu, name) for name in symfpu.__all__}
ERRORS = {name for name, thing in PUBLIC.items() if inspect.isclass(thing) and issubclass(thing, Exception)}
FUNCTIONS = sorted(name for name, thing in PUBLIC.items() if inspect.isfunction(thing))
RESULTS = sorted(name for name, thing in PUBLIC.items() if inspect.isclass(thing) and name not in ERRORS)


def _text(name):
    return " ".join(PUBLIC[name].__doc__.split())


def _named(word, text):
    return re.search(rf"(?<![\w.]){word}(?!\w)", text) is not None


def _left_out(words, text):
    return [word for word in words if not _named(word, text)]


def _words_of(thing):
    """What a docstring may quote: arguments of the function, names of its module, fields of results."""
    own = set(inspect.signature(thing).parameters) if inspect.isfunction(thing) else set(dir(thing))
    fields = {field.name for name in RESULTS for field in dataclasses.fields(PUBLIC[name])}
    return own | fields | set(PUBLIC) | set(vars(importlib.import_module(thing.__module__)))


def _tree(thing):
    return ast.parse(textwrap.dedent(inspect.getsource(thing))).body[0]


def _raised(tree):
    """Names of the exceptions that the statements of a function raise."""
    raises = [node.exc for node in ast.walk(tree) if isinstance(node, ast.Raise) and node.exc is not None]
    calls = [error.func for error in raises if isinstance(error, ast.Call)]
    return {call.id for call in calls if isinstance(call, ast.Name)}


def _set_attributes(error):
    """Public attributes that the constructor of an exception sets."""
    if "__init__" not in vars(error):
        return set()
    targets = [node for node in ast.walk(_tree(error.__init__)) if isinstance(node, ast.Attribute)]
    stored = {node.attr for node in targets if isinstance(node.ctx, ast.Store)}
    return {name for name in stored if not name.startswith("_")}


def test_there_is_a_kind_for_every_public_name():
    assert sorted([*FUNCTIONS, *RESULTS, *ERRORS]) == symfpu.__all__
    assert min(len(FUNCTIONS), len(RESULTS), len(ERRORS)) > 15


@pytest.mark.parametrize("name", symfpu.__all__)
def test_first_line_says_what_it_gives_and_lines_are_short(name):
    doc = PUBLIC[name].__doc__
    first = doc.split("\n")[0]
    assert first == first.strip()
    assert len(first) > 20
    assert first.endswith((".", "?"))
    assert max(map(len, doc.split("\n"))) <= LONGEST_LINE


@pytest.mark.parametrize("name", symfpu.__all__)
def test_docstring_names_its_source(name):
    assert re.search(SOURCES, _text(name), re.I)


@pytest.mark.parametrize("name", sorted({*FUNCTIONS, *RESULTS} - {"init_printing", "cite"}))
def test_docstring_names_units(name):
    assert re.search(UNITS, _text(name), re.I)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_docstring_of_a_function_names_every_argument(name):
    function = PUBLIC[name]
    assert _left_out(inspect.signature(function).parameters, function.__doc__) == []


@pytest.mark.parametrize("name", RESULTS)
def test_docstrings_of_methods_name_every_argument(name):
    result = PUBLIC[name]
    for called, method in inspect.getmembers(result, inspect.isfunction):
        if called.startswith("_"):
            continue
        _self, *arguments = inspect.signature(method).parameters
        assert _left_out(arguments, f"{method.__doc__} {result.__doc__}") == [], called


@pytest.mark.parametrize("name", RESULTS)
def test_docstring_of_a_result_names_every_field(name):
    result = PUBLIC[name]
    assert dataclasses.is_dataclass(result)
    assert _left_out([field.name for field in dataclasses.fields(result)], result.__doc__) == []


@pytest.mark.parametrize("name", sorted(ERRORS))
def test_docstring_of_an_error_says_when_it_is_raised_and_names_what_it_carries(name):
    error = PUBLIC[name]
    assert re.search(r"\b[Rr]aised\b", error.__doc__)
    assert _left_out(sorted(_set_attributes(error)), error.__doc__) == []


@pytest.mark.parametrize("name", sorted({*FUNCTIONS, *RESULTS} - {"frequency_rank"}))
def test_arrays_have_shapes(name):
    thing = PUBLIC[name]
    hints = [str(hint) for hint in thing.__annotations__.values()]
    if any(array in hint for hint in hints for array in ARRAYS):
        assert re.search(SHAPE, thing.__doc__), hints


@pytest.mark.parametrize("name", FUNCTIONS)
def test_docstring_of_a_function_says_what_is_raised(name):
    function = PUBLIC[name]
    assert re.search(r"Raises nothing" if name in NO_ERRORS else r"Raises \w*Error", _text(name))
    assert _left_out(sorted(_raised(_tree(function))), function.__doc__) == []


@pytest.mark.parametrize("name", symfpu.__all__)
def test_errors_and_results_that_docstrings_speak_of_exist(name):
    spoken = set(re.findall(r"\b[A-Z][a-z]+(?:[A-Z][a-z]+)+\b", PUBLIC[name].__doc__.split(">>>")[0]))
    quoted = set(re.findall(r"`(\w+)`", PUBLIC[name].__doc__))
    assert spoken - set(PUBLIC) - set(dir(builtins)) - NO_CLASSES == set()
    assert quoted - _words_of(PUBLIC[name]) == set()


@pytest.mark.parametrize("name", sorted({*FUNCTIONS, *RESULTS}))
def test_docstring_has_an_example_that_uses_the_name_or_makes_it(name):
    thing = PUBLIC[name]
    assert ">>> " in thing.__doc__
    shown = thing.__doc__.split(">>>", 1)[1]
    assert _named(name, shown) or "." + name + "(" in shown  # called, or the result shown
