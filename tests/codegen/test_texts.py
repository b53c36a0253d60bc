"""Exported files as text, in every language and form: facts in the header, lines that compilers take, the same bytes again."""

import os
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import jinja2
import pytest

from symfpu.codegen.export import LANGUAGES, LONGEST_NAME
from symfpu.codegen.languages.c import C
from tests.codegen import test_c99, universal_cases
from tests.codegen.series_cases import CASES, UNIVERSAL, numeric, program_of, universal

LONGEST = 132  # of the standard of Fortran; Python has no such limit


@cache
def program(form, again=0):
    """again : made anew, with the same content."""
    if form == "torus":
        return test_c99.program(test_c99.case("mixed, three seeds"))
    if form == "operations":
        return universal_cases.program("both couplings")
    if form == "universal":
        return program_of(universal(UNIVERSAL["lennard-jones, one seed"]), UNIVERSAL["lennard-jones, one seed"])
    return program_of(numeric(CASES["wrapped modes"]), CASES["wrapped modes"], form=form)


@pytest.mark.parametrize("form", ["torus", "universal", "operations", "statements", "tables"])
def test_the_longest_name_leaves_lines_that_fortran_takes(form):
    """Names of 30 letters and more made lines of 133 columns and more."""
    write = LANGUAGES["fortran"].torus if form == "torus" else LANGUAGES["fortran"].series
    text = write(replace(program(form), name="a" * LONGEST_NAME))
    assert max(map(len, text.splitlines())) <= LONGEST


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("form", ["torus", "universal", "operations", "statements", "tables"])
def test_a_file_says_what_it_is_in_lines_that_compilers_take(form, language):
    write = LANGUAGES[language].torus if form == "torus" else LANGUAGES[language].series
    made = program(form)
    text = write(made)
    assert text == write(program(form, again=1))
    assert text.isascii()
    if language not in ("numpy", "mpmath"):
        assert max(map(len, text.splitlines())) <= LONGEST
    words = " ".join(word for line in text.splitlines() for word in line.lstrip("!%#* ").split())
    for key, value in made.facts.items():
        assert f"{key}: {' '.join(value.split())}" in words, key


HASHES = """
import hashlib
from symfpu.codegen.export import LANGUAGES
from tests.codegen.series_cases import CASES, UNIVERSAL, numeric, program_of, universal

programs = []
for form in ("tables", "statements"):
    programs += [program_of(numeric(CASES[name]), CASES[name], form=form) for name in ("wrapped modes", "one mode")]
programs += [program_of(universal(UNIVERSAL[name]), UNIVERSAL[name]) for name in ("wrapped, order 1", "mixed, one mode")]
for name, language in LANGUAGES.items():
    for program in programs:
        print(name, hashlib.sha256(language.series(program).encode()).hexdigest())
"""


@pytest.mark.long
def test_same_bytes_whatever_the_order_of_sets():
    root = Path(__file__).parents[2]
    found = []
    for seed in ("1", "29"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        run = subprocess.run([sys.executable, "-c", HASHES], cwd=root, env=environment, capture_output=True, text=True, check=True)
        found.append(run.stdout.splitlines())
    assert len(found[0]) == 5 * 6
    assert found[0] == found[1]


def test_a_place_that_nothing_fills_is_an_error():
    without = replace(C, torus_words=lambda made: {name: x for name, x in C.torus_words(made).items() if name != "norm"})
    with pytest.raises(jinja2.UndefinedError, match="'norm' is undefined"):
        without.torus(program("torus"))
