"""Docstrings of public names leave nothing out: arguments, fields, what is raised; and what they name exists.

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

NO_CLASSES = {"SymPy", "RunInterrupted", "NumPy", "SymEngine", "IntegerTables"}

PUBLIC = {name: getattr(symfpu, name) for name in symfpu.__all__}
ERRORS = {name for name, thing in PUBLIC.items() if inspect.isclass(thing) and issubclass(thing, Exception)}
FUNCTIONS = sorted(name for name, thing in PUBLIC.items() if inspect.isfunction(thing))
RESULTS = sorted(name for name, thing in PUBLIC.items() if inspect.isclass(thing) and name not in ERRORS)


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


@pytest.mark.parametrize("name", FUNCTIONS)
def test_docstring_of_a_function_names_every_argument_and_what_is_raised(name):
    function = PUBLIC[name]
    assert _left_out([*inspect.signature(function).parameters, *sorted(_raised(_tree(function)))], function.__doc__) == []


@pytest.mark.parametrize("name", RESULTS)
def test_docstring_of_a_result_names_every_field_and_argument_of_its_methods(name):
    result = PUBLIC[name]
    assert _left_out([field.name for field in dataclasses.fields(result)], result.__doc__) == []
    for called, method in inspect.getmembers(result, inspect.isfunction):
        if not called.startswith("_"):
            _self, *arguments = inspect.signature(method).parameters
            assert _left_out(arguments, f"{method.__doc__} {result.__doc__}") == [], called


@pytest.mark.parametrize("name", sorted(ERRORS))
def test_docstring_of_an_error_names_what_it_carries(name):
    assert _left_out(sorted(_set_attributes(PUBLIC[name])), PUBLIC[name].__doc__) == []


@pytest.mark.parametrize("name", [*RESULTS, *sorted(ERRORS)])
def test_every_method_has_a_docstring(name):
    public = {called: member for called, member in vars(PUBLIC[name]).items() if not called.startswith("_")}
    methods = {called: member for called, member in public.items() if inspect.isfunction(member) or isinstance(member, property)}
    assert [called for called, member in methods.items() if not inspect.getdoc(member)] == []


@pytest.mark.parametrize("name", [name for name in symfpu.__all__ if name != "plots"])
def test_errors_and_results_that_docstrings_speak_of_exist(name):
    spoken = set(re.findall(r"\b[A-Z][a-z]+(?:[A-Z][a-z]+)+\b", PUBLIC[name].__doc__.split(">>>")[0]))
    quoted = set(re.findall(r"`(\w+)`", PUBLIC[name].__doc__))
    assert spoken - set(PUBLIC) - set(dir(builtins)) - NO_CLASSES == set()
    assert quoted - _words_of(PUBLIC[name]) == set()
