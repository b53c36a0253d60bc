"""Shells complete verbs, options and words; words to choose from are in the help; tables fit 80 columns without colour."""

import os
import subprocess
import sys

import pytest

from symfpu.cli.export import LANGUAGES as SHOWN
from symfpu.cli.main import main
from symfpu.cli.verbs import VERBS
from symfpu.codegen.export import LANGUAGES

PROGRAM = "from symfpu.cli.main import run; run()"


def run(*words, **more):
    surroundings = {name: value for name, value in os.environ.items() if name != "NO_COLOR"} | more
    return subprocess.run([sys.executable, "-c", PROGRAM, *words], capture_output=True, text=True, check=False, env=surroundings)


def completed(line):
    """What bash is told for the last word of a line, which may be empty."""
    words = line.split(" ")
    found = run(COMP_WORDS=line, COMP_CWORD=str(len(words) - 1), _SYMFPU_COMPLETE="complete_bash")
    assert found.stderr == ""
    return found.stdout.split()


@pytest.mark.long
@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("symfpu so", ["solve"]),
        pytest.param("symfpu ", list(VERBS), marks=pytest.mark.long),
        pytest.param("symfpu orbit --scheme aba", ["aba864", "aba864_modes"], marks=pytest.mark.long),
        pytest.param("symfpu prove --model b", ["beta"], marks=pytest.mark.long),
        pytest.param("symfpu propagate --model a", ["alpha", "alpha+beta"], marks=pytest.mark.long),
        pytest.param("symfpu export f --lang ", list(SHOWN), marks=pytest.mark.long),
        pytest.param("symfpu solve --ends p", ["periodic"], marks=pytest.mark.long),
        pytest.param("symfpu solve --ene", ["--energy"], marks=pytest.mark.long),
    ],
)
def test_shells_complete(line, words):
    assert completed(line) == words


@pytest.mark.long
def test_the_completion_of_a_shell_is_printed():
    shown = run(_SYMFPU_COMPLETE="source_bash")  # `--show-completion` asks which shell runs it: in a test that may be any, or none
    assert shown.returncode == 0
    assert "_SYMFPU_COMPLETE=complete_bash" in shown.stdout


def test_languages_in_the_help_are_those_there_are():
    assert set(SHOWN) == set(LANGUAGES)


@pytest.mark.parametrize(("verb", "words"), [("propagate", "[alpha|beta|alpha+beta]"), ("solve", "[fixed|periodic]")])
def test_words_to_choose_from_are_in_the_help(capsys, monkeypatch, verb, words):
    monkeypatch.setenv("COLUMNS", "120")
    assert main([verb, "--help"]) == 0
    assert words in capsys.readouterr().out


@pytest.mark.long
@pytest.mark.parametrize("colour", [{}, {"NO_COLOR": "1"}, {"FORCE_COLOR": "1"}])
def test_tables_line_up_in_80_columns(colour):
    words = ["solve", "-N", "8", "--alpha", "0.3", "--seeds", "1,2", "--omega", "0.3905,0.7663", "--order", "6"]
    found = run(*words, COLUMNS="80", **colour)
    lines = found.stdout.splitlines()
    assert found.returncode == 0
    assert max(map(len, lines)) <= 80
    assert "\x1b" not in found.stdout
    first = next(i for i, line in enumerate(lines) if line.split()[:1] == ["order"])
    starts = [lines[first].index(name) for name in ("order", "A_1(k)", "dA(k)")]
    for row in lines[first + 1 : first + 8]:
        assert row[starts[0]] != " "
        assert row[starts[1] - 1] == " "
        assert row[starts[2] - 1] == " "


@pytest.mark.long
@pytest.mark.parametrize("verb", [*VERBS, ""])
def test_help_fits_80_columns_without_colour(verb):
    found = run(*[verb] * bool(verb), "--help", COLUMNS="80", NO_COLOR="1")
    assert found.returncode == 0
    assert max(map(len, found.stdout.splitlines())) <= 80
    assert "\x1b[3" not in found.stdout
