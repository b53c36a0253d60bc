"""The public face: light to import, documented, and complete."""

import inspect
import subprocess
import sys

import symfpu

HEAVY = ("numba", "matplotlib", "scipy")


def test_importing_the_package_loads_nothing_heavy():
    code = f"import sys, symfpu; print([name for name in {HEAVY} if name in sys.modules])"
    finished = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert finished.stdout.strip() == "[]"


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
