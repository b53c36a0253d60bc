"""Templates: loaded when they are needed, compiled once, and strict."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import jinja2
import pytest

import symfpu.codegen
from symfpu.codegen.export import LANGUAGES
from symfpu.codegen.languages.c import C
from symfpu.codegen.templating import packed
from symfpu.codegen.torus_program import torus_facts, torus_program
from tests.codegen.test_c99 import case

FOLDER = Path(symfpu.codegen.__file__).parent / "templates"


@pytest.fixture(scope="module")
def program():
    torus = case("one mode")
    return torus_program(torus, "sample", torus_facts(torus))


def test_every_template_belongs_to_a_language():
    expected = {f"{kind}.{language.templates}.jinja" for kind in ("torus", "series", "universal") for language in LANGUAGES.values()}
    assert {path.name for path in FOLDER.iterdir()} == expected


@pytest.mark.long
def test_jinja_is_loaded_by_the_first_source_only():
    loaded = "import sys, symfpu.codegen.evaluator, symfpu.codegen.export; sys.exit('jinja2' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", loaded], check=False).returncode == 0


def test_a_place_that_nothing_fills_is_an_error(program):
    without = replace(C, torus_words=lambda program: {name: x for name, x in C.torus_words(program).items() if name != "norm"})
    with pytest.raises(jinja2.UndefinedError, match="'norm' is undefined"):
        without.torus(program)


def test_a_template_is_compiled_once(program, monkeypatch):
    first = C.torus(program)
    monkeypatch.setattr(jinja2.Environment, "compile", lambda *_: pytest.fail("compiled again"))
    assert C.torus(program) == first


def test_packed_lines_keep_every_piece_within_the_width():
    assert packed(["ab, ", "cd, ", "ef, ", "g"], 7, start="> ", indent=". ") == ["> ab,", ". cd,", ". ef, g"]
