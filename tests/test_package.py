"""The public face: light to import, documented, and complete."""

import ast
import importlib
import inspect
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import symfpu

ROOT = Path(symfpu.__file__).parent
HEAVY = ("numpy", "symengine", "sympy", "numba", "matplotlib", "scipy", "IPython", "pandas", "xarray")


def _run(code):
    """What a fresh interpreter prints."""
    command = [sys.executable, "-c", code]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def test_importing_the_package_loads_nothing_heavy():
    assert _run(f"import sys, symfpu; print([name for name in {HEAVY} if name in sys.modules])") == "[]"


def test_importing_the_package_changes_how_terms_print_only_inside_ipython():
    shown = "import symengine; print(symengine.sympify('x/2')._repr_latex_())"
    assert _run(f"import symfpu; {shown}") == "None"
    assert _run(f"import symfpu; symfpu.init_printing(); {shown}") == r"$\frac{x}{2}$"
    assert _run(f"import IPython, symfpu; {shown}") == r"$\frac{x}{2}$"


def test_every_public_name_stands_once_in_the_stub_and_is_what_it_says():
    stub = ast.parse((ROOT / "__init__.pyi").read_text())
    imports = [line for line in stub.body if isinstance(line, ast.ImportFrom)]
    lines = [line for line in imports if line.module != "symfpu"]
    names = [alias.name for line in lines for alias in line.names]
    assert sorted([*names, "plots"]) == symfpu.__all__ == sorted({*names, "plots"})
    reexported = [alias.asname == alias.name for line in lines for alias in line.names]
    assert all(reexported)
    for line in lines:
        for alias in line.names:
            thing = getattr(symfpu, alias.name)
            assert thing is getattr(importlib.import_module(line.module), alias.name)
            assert thing.__module__ == line.module


def test_the_room_of_pictures_is_there_without_an_import_of_its_own():
    """By its name, and by a star."""
    known = "'symfpu.plots' in sys.modules, 'matplotlib' in sys.modules"
    code = f"import sys, symfpu; print({known}); symfpu.plots.spectrum; print({known})\nfrom symfpu import *; print(plots.__name__)"
    assert _run(code).splitlines() == ["False False", "True False", "symfpu.plots"]
    stub = ast.parse((ROOT / "__init__.pyi").read_text())
    (rooms,) = [line for line in stub.body if isinstance(line, ast.ImportFrom) and line.module == "symfpu"]
    assert [(room.name, room.asname) for room in rooms.names] == [("plots", "plots")]


def test_the_stub_is_part_of_the_package():
    data = tomllib.loads((ROOT.parent / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    assert "*.pyi" in data["symfpu"]
    assert "py.typed" in data["symfpu"]


@pytest.mark.long
def test_type_checkers_know_the_types_of_public_names(tmp_path):
    script = tmp_path / "user.py"
    calls = "reveal_type(lindstedt(Chain(8, alpha=1), (1,)))"
    script.write_text(f"from symfpu import Chain, lindstedt\n{calls}\n")
    user = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    cache = Path(user) / "symfpu" / "mypy"  # that of the check of types in the Makefile
    command = [sys.executable, "-m", "mypy", "--cache-dir", str(cache), str(script)]
    finished = subprocess.run(command, capture_output=True, text=True, cwd=ROOT.parent)
    assert 'Revealed type is "symfpu.series.series.LindstedtSeries"' in finished.stdout
    assert finished.returncode == 0


@pytest.mark.long
def test_no_public_name_is_hidden_by_a_module_of_the_same_name():
    rooms = {path.stem for path in ROOT.iterdir()}
    assert rooms & set(symfpu.__all__) == {"plots"}
    code = "import symfpu, types; print([n for n in symfpu.__all__ if isinstance(getattr(symfpu, n), types.ModuleType)], dir(symfpu)[0])"
    assert _run(code).split()[0] == "['plots']"
    assert symfpu.__all__ == sorted(set(symfpu.__all__), key=lambda name: (not name[0].isupper(), name))
    assert set(symfpu.__all__) <= set(dir(symfpu))
    with pytest.raises(AttributeError, match="no attribute 'lindsted'"):
        _ = symfpu.lindsted


def test_every_public_name_is_listed_once_as_stable_or_provisional():
    page = (ROOT.parent / "docs" / "stability.md").read_text()
    rows = [line.strip("|").split("|") for line in page.splitlines() if line.startswith("| ")][2:]
    assert sorted(name for row in rows for cell in row[1:] for name in re.findall(r"`(\w+)`", cell)) == symfpu.__all__


def test_all_errors_are_of_one_tree_and_bad_input_is_a_value_error():
    errors = [getattr(symfpu, name) for name in symfpu.__all__ if inspect.isclass(getattr(symfpu, name))]
    errors = [error for error in errors if issubclass(error, Exception)]
    assert len(errors) >= 7
    assert all(issubclass(error, symfpu.SymfpuError) for error in errors)
    assert issubclass(symfpu.InputError, ValueError)
    assert issubclass(symfpu.TooLarge, symfpu.InputError)
    assert not issubclass(symfpu.NoRealAmplitude, ValueError)
