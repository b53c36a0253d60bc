"""Verbs load what they need and no more; all of them are in the table; their help fits a terminal."""

import os
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
from typer.main import get_group

import symfpu.cli
from symfpu.cli.main import main
from symfpu.cli.verbs import VERBS, app

FOUNDATIONS = {"chains", "choices", "__init__", "keeping", "main", "pictures", "starts", "terminal", "theorems", "verbs"}
MODULES = {verb.module for verb in VERBS.values()}
HEAVY = {"numba", "scipy", "scipy.optimize", "scipy.sparse", "matplotlib", "sympy", "pandas"}
SOLVE = ["solve", "-N", "8", "--alpha", "0.3", "--seeds", "1", "--omega", "0.3905", "--order", "4"]
SHORT = {
    "solve": SOLVE,
    "propagate": ["propagate", "-N", "8", "--seeds", "1", "--order", "2"],
    "refine": ["refine", "--help"],
    "family": ["family", "--help"],
    "orbit": ["orbit", "--help"],
    "gali": ["gali", "--help"],
    "prove": ["prove", "--help"],
}


def python(*words, **changes):
    """A fresh interpreter, without COLUMNS unless it is asked for."""
    surroundings = {name: value for name, value in os.environ.items() if name != "COLUMNS"} | changes
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False, env=surroundings)


@pytest.mark.long
@pytest.mark.parametrize("verb", [pytest.param(verb, marks=[pytest.mark.long] * (verb not in ("solve", "orbit"))) for verb in SHORT])
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


def test_the_help_says_of_each_verb_what_its_own_help_begins_with():
    for name, verb in VERBS.items():
        import_module(f"symfpu.cli.{verb.module}")
        own = get_group(app).commands[name].help
        assert own.split("\n\n")[0].replace("\n", " ") == verb.line


def test_the_table_has_every_module_and_every_verb():
    files = {path.stem for path in Path(symfpu.cli.__file__).parent.glob("*.py")}
    assert files - FOUNDATIONS == MODULES
    for module in MODULES:
        import_module(f"symfpu.cli.{module}")
    registered = {info.callback: info.name for info in app.registered_commands}
    homes = {name or function.__name__: function.__module__ for function, name in registered.items()}
    assert homes == {name: f"symfpu.cli.{verb.module}" for name, verb in VERBS.items()}


def test_the_help_has_the_verbs_in_the_order_of_the_table(capsys):
    assert main(["--help"]) == 0
    _, table = capsys.readouterr().out.split("Commands")
    rows = [line.removeprefix("│ ") for line in table.splitlines()[1:]]
    assert [row.split()[0] for row in rows if row[:1].isalpha()] == list(VERBS)


def test_a_verb_that_is_none_is_named_beside_those_that_are(capsys):
    assert main(["solv"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert len(captured.err.splitlines()) == 1
    assert "'solv'" in captured.err
    assert all(verb in captured.err for verb in VERBS)


@pytest.mark.parametrize("verb", VERBS)
def test_help_fits_eighty_columns_with_its_example_on_one_line(verb, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "80")
    assert main([verb, "--help"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    assert not any("…" in line for line in lines)
    [example] = [line.strip() for line in lines if "Example:" in line]
    assert example.startswith(f"Example: symfpu {verb} ")
    after = lines[next(i for i, line in enumerate(lines) if "Example:" in line) + 1 :]
    assert not any(line.strip() for line in after)


@pytest.mark.long
def test_the_package_is_a_program():
    """python -m symfpu is the console script: same output, same codes."""
    script = "import sys; sys.argv[0] = 'symfpu'; from symfpu.cli.main import run; run()"
    for words, code in ((SHORT["propagate"], 0), (["propagate"], 2)):
        module, installed = python("-m", "symfpu", *words), python("-c", script, *words)
        assert module.returncode == installed.returncode == code
        assert (module.stdout, module.stderr) == (installed.stdout, installed.stderr)


def test_the_help_of_export_names_every_language():
    from symfpu.cli import export as verb
    from symfpu.codegen.export import LANGUAGES

    assert list(verb.LANGUAGES) == list(LANGUAGES)


@pytest.mark.parametrize("verb", VERBS)
def test_every_option_of_text_says_what_to_type(verb, capsys, monkeypatch):
    """A name or words to choose from, never the type."""
    monkeypatch.setenv("COLUMNS", "200")
    main([verb, "--help"])
    options = re.findall(r"^\W*--?\w.*$", capsys.readouterr().out, re.MULTILINE)
    assert any("--help" in line for line in options)
    assert [line for line in options if "<str>" in line] == []
