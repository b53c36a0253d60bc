"""Tests mirror the package: a folder for every room, and nothing else but the oracles and the benchmarks."""

from pathlib import Path

import pytest

TESTS = Path(__file__).parent
OTHERS = {"oracles", "benchmarks"}


def folders(parent):
    """Names of folders with Python in them."""
    return {path.name for path in parent.iterdir() if path.is_dir() and any(path.glob("*.py"))}


ROOMS = folders(TESTS.parent / "symfpu")


def test_every_folder_of_tests_is_a_room():
    assert folders(TESTS) - OTHERS <= ROOMS


@pytest.mark.parametrize("room", sorted(ROOMS))
def test_every_room_has_tests(room):
    assert list((TESTS / room).glob("test_*.py"))


def test_oracles_and_benchmarks_are_there():
    assert folders(TESTS) >= OTHERS
