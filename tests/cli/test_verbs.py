"""Verbs load what they need and no more; all are in the table and in what shells complete; their help fits a terminal."""

import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from shlex import split

import pytest

import symfpu.cli
from symfpu.cli.export import LANGUAGES
from symfpu.cli.verbs import VERBS, app

FOUNDATIONS = set(
    split("certificates chains choices __init__ keeping application interrupting main pictures runs starts terminal theorems verbs")
)
MODULES = {verb.module for verb in VERBS.values()}
HEAVY = {"numba", "scipy", "scipy.optimize", "scipy.sparse", "matplotlib", "sympy", "pandas"}
PROPAGATE = split("propagate -N 8 --seeds 1 --order 2")
SHORT = {
    "solve": split("solve -N 8 --alpha 0.3 --seeds 1 --omega 0.3905 --order 4"),
    "propagate": PROPAGATE,
    **{verb: [verb, "--help"] for verb in ("refine", "family", "orbit", "gali", "prove")},
}
SCRIPT = "import sys; sys.argv[0] = 'symfpu'; from symfpu.cli.main import run; run()"


def python(*words, **changes):
    """A fresh interpreter, without COLUMNS unless it is asked for."""
    surroundings = {name: value for name, value in os.environ.items() if name != "COLUMNS"} | changes
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False, env=surroundings)


@pytest.mark.long
@pytest.mark.parametrize("verb", SHORT)
def test_a_general_verb_loads_neither_the_paper_nor_pictures(verb):
    code = f"""
import sys
from symfpu.cli.main import main
print(main({SHORT[verb]!r}))
heavy = ("matplotlib", "symfpu.paper", "symfpu.codegen.languages", "sympy")
print("loaded:", *(name for name in heavy if name in sys.modules))
"""
    finished = python("-c", code)
    *_, code, loaded = finished.stdout.splitlines()
    assert (code, loaded) == ("0", "loaded:"), finished.stderr


@pytest.mark.parametrize("option", ["--version", "--help"])
def test_the_version_and_the_help_load_no_verb(option):
    code = f"import sys; from symfpu.cli.main import main; main(['{option}']); print(*sys.modules)"
    loaded = set(python("-c", code).stdout.split())
    assert "symfpu.cli.main" in loaded
    assert not {f"symfpu.cli.{module}" for module in MODULES} & loaded
    assert not HEAVY & loaded


def test_all_verbs_together_load_nothing_heavy_before_they_run():
    names = [f"symfpu.cli.{module}" for module in sorted(MODULES)]
    loaded = set(python("-c", f"import sys, {', '.join(names)}; print(*sys.modules)").stdout.split())
    assert set(names) <= loaded
    assert not (HEAVY - {"scipy"}) & loaded  # certify needs its linear algebra, which is light


def test_the_table_has_every_module_and_every_verb():
    files = {path.stem for path in Path(symfpu.cli.__file__).parent.glob("*.py")}
    assert files - FOUNDATIONS == MODULES
    for module in MODULES:
        import_module(f"symfpu.cli.{module}")
    registered = {info.callback: info.name for info in app.registered_commands}
    homes = {name or function.__name__: function.__module__ for function, name in registered.items()}
    assert homes == {name: f"symfpu.cli.{verb.module}" for name, verb in VERBS.items()}


@pytest.mark.long
def test_the_package_is_a_program():
    """python -m symfpu is the console script: same output, same codes."""
    for words, code in ((PROPAGATE, 0), (["propagate"], 2)):
        module, installed = python("-m", "symfpu", *words), python("-c", SCRIPT, *words)
        assert module.returncode == installed.returncode == code
        assert (module.stdout, module.stderr) == (installed.stdout, installed.stderr)


COMPLETED = {
    "symfpu so": ["solve"],
    "symfpu ": list(VERBS),
    "symfpu orbit --scheme aba": ["aba864", "aba864_modes"],
    "symfpu prove --model b": ["beta"],
    "symfpu propagate --model a": ["alpha", "alpha+beta"],
    "symfpu export f --lang ": list(LANGUAGES),
    "symfpu solve --ends p": ["periodic"],
    "symfpu solve --ene": ["--energy"],
}


@pytest.mark.long
@pytest.mark.parametrize("line", COMPLETED)
def test_shells_complete(line):
    """What bash is told for the last word of a line, which may be empty."""
    asked = {"COMP_WORDS": line, "COMP_CWORD": str(line.count(" ")), "_SYMFPU_COMPLETE": "complete_bash"}
    found = python("-c", SCRIPT, **asked)
    assert (found.stdout.split(), found.stderr) == (COMPLETED[line], "")
