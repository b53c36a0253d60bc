"""The public face: light to import, documented, and complete."""

import inspect
import subprocess
import sys

import pytest

import symfpu

HEAVY = ("numba", "matplotlib", "scipy")


def test_importing_the_package_loads_nothing_heavy():
    code = f"import sys, symfpu; print([name for name in {HEAVY} if name in sys.modules])"
    finished = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert finished.stdout.strip() == "[]"


def test_no_public_name_is_hidden_by_a_module_of_the_same_name():
    code = "import symfpu, types; print([n for n in symfpu.__all__ if isinstance(getattr(symfpu, n), types.ModuleType)], dir(symfpu)[0])"
    finished = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert finished.stdout.split()[0] == "[]"
    assert symfpu.__all__ == sorted(set(symfpu.__all__), key=lambda name: (not name[0].isupper(), name))
    with pytest.raises(AttributeError, match="no attribute 'lindsted'"):
        _ = symfpu.lindsted


def test_every_public_name_has_a_docstring():
    public = [getattr(symfpu, name) for name in symfpu.__all__]
    assert all(inspect.getdoc(thing) for thing in public)
    methods = [
        (thing.__name__, name)
        for thing in public
        if inspect.isclass(thing)
        for name, member in vars(thing).items()
        if not name.startswith("_") and (inspect.isfunction(member) or isinstance(member, property)) and not inspect.getdoc(member)
    ]
    assert methods == []


def test_all_errors_are_of_one_tree_and_bad_input_is_a_value_error():
    errors = [getattr(symfpu, name) for name in symfpu.__all__ if inspect.isclass(getattr(symfpu, name))]
    errors = [error for error in errors if issubclass(error, Exception)]
    assert len(errors) >= 7
    assert all(issubclass(error, symfpu.SymfpuError) for error in errors)
    assert issubclass(symfpu.InputError, ValueError)
    assert issubclass(symfpu.TooLarge, symfpu.InputError)
    assert not issubclass(symfpu.NoRealAmplitude, ValueError)
