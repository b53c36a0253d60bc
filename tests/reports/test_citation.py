"""How to cite: the file at the root is what the package says, with the version of pyproject.toml."""

import re
import tomllib
from pathlib import Path

import pytest

import symfpu
from symfpu.errors import InputError
from symfpu.reports.citation import cite

ROOT = Path(__file__).parents[2]


def test_the_file_is_what_the_package_says():
    assert (ROOT / "CITATION.cff").read_text() == cite("cff") + "\n", "make citation"


def test_the_version_is_that_of_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["version"] == symfpu.__version__
    for form in ("text", "bibtex", "cff"):
        assert symfpu.__version__ in cite(form)


def test_bibtex_has_closed_entries_with_their_fields():
    entries = cite("bibtex").split("\n\n")
    assert [re.match(r"@(\w+)\{(\w+),", entry).groups() for entry in entries] == [("misc", "symfpu"), ("article", "qtori2013")]
    assert all(entry.count("{") == entry.count("}") for entry in entries)
    assert "author = {Christodoulidi, H. and Efthymiopoulos, C.}" in entries[1]


def test_another_form_is_refused():
    with pytest.raises(InputError, match="text, bibtex, cff"):
        cite("ris")
