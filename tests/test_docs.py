"""The pages run as they stand: the blocks of a page in their order, in one namespace and one empty folder.

A fence is opened by ```python or ```shell. A word after that says otherwise: `long`, more than ten seconds, for `make long`;
`parsed`, minutes to hours, whose options alone are checked. Programs for compilers: tests/codegen/test_examples.py.
"""

import os
import re
import shlex
from pathlib import Path

import pytest
import typer

from symfpu.cli.application import app
from symfpu.cli.main import main

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
FENCE = re.compile(r"^```(\w+)(?: (\w+))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"^(?: {4}|\t)(?:symfpu|make|python|from|import)\b.*", re.MULTILINE)
WORDS = {"", "long", "parsed"}
ELSEWHERE = {"c", "fortran", "octave"}
WITHOUT_SYMFPU = ("export.md", "import two_torus\n")  # compiled and run with the gallery beside it
TARGET = re.compile(r"^(\w+):", re.MULTILINE)


def blocks(page):
    """(language, word, text) of every block that these tests are for."""
    found = [(language, word, text) for language, word, text in FENCE.findall(page.read_text()) if language not in ELSEWHERE]
    return [(language, word, text) for language, word, text in found if not _without_symfpu(page, text)]


def _without_symfpu(page, text):
    name, beginning = WITHOUT_SYMFPU
    return page.name == name and text.startswith(beginning)


def commands(text):
    """The command lines of a block, as lists of words without comments."""
    return [words for line in text.splitlines() if (words := shlex.split(line, comments=True))]


def run(page, folder, monkeypatch, *words):
    """Every block of a page that has no word, or one of these."""
    monkeypatch.chdir(folder)
    namespace = {"__name__": "__main__"}
    for language, word, text in blocks(page):
        if word not in {"", *words}:
            continue
        if language == "python":
            exec(compile(text, page.name, "exec"), namespace)
        else:
            for program, *given in commands(text):
                if program == "symfpu":
                    assert main(given) == 0, given


LONG = [page for page in PAGES if any(word == "long" for _, word, _ in blocks(page))]


# seconds of compilers, orbits, pictures
SLOW = {"actions", "asymptotics", "dynamics", "existence", "export", "figures", "localization", "plots", "precision", "programs"}
SLOW |= {"sweeps", "tables", *(page.stem for page in LONG)}
RUNNING = [page for page in PAGES if any(word in {"", "long"} for _, word, _ in blocks(page))]
PARAMETERS = [pytest.param(page, id=page.name, marks=[pytest.mark.long] * (page.stem in SLOW)) for page in RUNNING]


@pytest.mark.parametrize("page", PARAMETERS)
def test_page_runs(page, tmp_path, monkeypatch):
    run(page, tmp_path, monkeypatch, "long")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_blocks_say_how_they_run(page):
    assert {language for language, _, _ in blocks(page)} <= {"python", "shell"}
    assert {word for _, word, _ in blocks(page)} <= WORDS
    assert page.read_text().count("```") == 2 * len(FENCE.findall(page.read_text()))
    assert not INDENTED.findall(FENCE.sub("", page.read_text())), "open a fence: indented lines are not run"


@pytest.mark.long
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_have_the_options_they_are_given(page):
    group = typer.main.get_command(app)
    targets = TARGET.findall((ROOT / "Makefile").read_text())
    for language, _, text in blocks(page):
        for program, *words in commands(text) if language == "shell" else ():
            if program == "make":
                assert words[0] in targets
            if program == "symfpu":
                context = group.context_class(group, info_name="symfpu", obj=words)
                name, verb, rest = group.resolve_command(context, words)
                verb.make_context(name, rest, parent=context)


PATH = re.compile(r"(?<![\w/.-])((?:symfpu|tests|docs|generated|notebooks)/[\w./-]*\w/?)")
LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")
HOSTED = ROOT / ".github" / "workflows" / "ci.yml"
NAMED = [*PAGES, HOSTED, ROOT / "Makefile", ROOT / "pyproject.toml", *sorted((ROOT / "symfpu").rglob("*.py"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    assert [link for link in LINK.findall(page.read_text()) if not (page.parent / link).exists()] == []


@pytest.mark.parametrize("file", NAMED, ids=lambda file: os.fspath(file.relative_to(ROOT)))
def test_files_that_are_named_exist(file):
    assert [path for path in PATH.findall(file.read_text()) if not (ROOT / path).exists()] == []
