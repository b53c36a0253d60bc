"""Tests mirror the package: a folder for every room, beside oracles, benchmarks, fuzzer and fingerprint; pages name tests that exist."""

import re
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
OTHERS = {"fuzz", "oracles", "benchmarks", "fingerprint"}


def folders(parent):
    """Names of folders with Python in them."""
    return {path.name for path in parent.iterdir() if path.is_dir() and any(path.glob("*.py"))}


ROOMS = folders(TESTS.parent / "symfpu")


def test_every_folder_of_tests_is_a_room():
    assert folders(TESTS) - OTHERS <= ROOMS


@pytest.mark.parametrize("room", sorted(ROOMS))
def test_every_room_has_tests(room):
    assert list((TESTS / room).glob("test_*.py"))


def test_tests_that_pages_name_are_there():
    """As `tests/room/test_file.py`, followed by `: ` and names of its tests, if any."""
    pages = [TESTS.parent / "README.md", *(TESTS.parent / "docs").glob("*.md")]
    cited = re.compile(r"`(tests/[\w/]+\.py)`((?:[:,]? `test_\w+`)*)")
    found = [match for page in pages for match in cited.findall(page.read_text())]
    assert len(found) > 10
    for file, names in found:
        text = (TESTS.parent / file).read_text()
        assert all(f"def {name}(" in text for name in re.findall(r"test_\w+", names)), (file, names)
