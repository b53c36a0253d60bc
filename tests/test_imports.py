"""Tests import from symfpu what it gives, and inner names only of the room that their folder mirrors: walls inside can move."""

import ast
import functools
import importlib
from pathlib import Path

import symfpu

TESTS = Path(__file__).parent
FILES = sorted(TESTS.rglob("*.py"))

# rooms whose names any test may import, each with its reason
EVERYWHERE = {
    "cli": "the program, called in this process in place of another",
    "compiled": "the decorator of loops that a test compiles itself",
    "errors": "errors that are raised inside and reach nobody by a public name",
    "paper": "printed numbers, which tests of all rooms compare with",
}
# folders that mirror no room: the speed of inner loops, second routes to results, calls of everything
FREE = {"benchmarks", "fuzz", "oracles"}
# what the other folders still borrow; a list that gets shorter
BORROWED = {
    "action_angle": "algebra dynamics refinement",
    "algebra": "proofs series",
    "borders": "numbers refinement sweeps",
    "breathers": "chain dynamics numbers",
    "certified": "checkers normal numbers refinement",
    "chain": "numbers",
    "checkers": "certified chain",
    "cli": "checkers normal",
    "dynamics": "chain numbers",
    "families": "action_angle files normal refinement tori",
    "integrable": "numbers",
    "normal": "action_angle chain dynamics refinement series",
    "numbers": "certified chain tori",
    "paper": "action_angle breathers dynamics figures",
    "plots": "breathers sweeps",
    "proofs": "algebra chain checkers",
    "refinement": "borders numbers",
    "results": "families",
    "series": "algebra chain notebook numbers proofs tori",
    "spectral": "files",
    "store": "algebra checkers files proofs results series",
    "sweeps": "algebra files",
    "tori": "chain numbers series",
}


def room_of(path):
    """The folder of a test, or nothing for files about all rooms."""
    parts = path.relative_to(TESTS).parts
    return parts[0] if len(parts) > 1 else ""


@functools.cache
def imported(path):
    """Pairs (module, name) of the imports from inner modules."""
    statements = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ImportFrom)]
    inner = [node for node in statements if node.module and node.module.startswith("symfpu.")]
    return [(node.module, alias.name) for node in inner for alias in node.names]


def is_public(module, name):
    """Whether symfpu gives the same by the same name."""
    return name in symfpu.__all__ and getattr(importlib.import_module(module), name, None) is getattr(symfpu, name)


def borrowed(path):
    """Rooms from which a file has inner names, beside its own and those that all may use."""
    room = room_of(path)
    rooms = {module.split(".")[1] for module, _ in imported(path)}
    return set() if room in FREE | {""} else rooms - {room} - set(EVERYWHERE)


def test_public_names_come_from_the_package():
    found = {path.relative_to(TESTS).as_posix(): [pair for pair in imported(path) if is_public(*pair)] for path in FILES}
    assert {file: pairs for file, pairs in found.items() if pairs} == {}


def test_inner_names_are_of_the_room_of_the_test():
    found = {}
    for path in FILES:
        for room in borrowed(path):
            found.setdefault(room_of(path), set()).add(room)
    assert found == {folder: set(rooms.split()) for folder, rooms in BORROWED.items()}
