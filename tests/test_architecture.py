"""docs/architecture.md against the tree, the import contract and the code: rooms, floors, the way through, walls."""

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "architecture.md").read_text()
ROOMS = [(int(floor), room) for floor, room in re.findall(r"^\| (\d+) \| `(\w+)` \|", PAGE, re.MULTILINE)]
WAY = re.findall(r"^\d+\. `(symfpu/[\w/]+\.py)`: `(\w+)`", PAGE, re.MULTILINE)


def contract():
    """The rooms of each floor, the ground floor first."""
    table = tomllib.loads((ROOT / "pyproject.toml").read_text())
    (layers,) = [c["layers"] for c in table["tool"]["importlinter"]["contracts"] if c["type"] == "layers"]
    return [set(re.split(r"\s*[|:]\s*", layer)) for layer in reversed(layers)]


def imported(path):
    """(module, name) of every import in a file."""
    nodes = list(ast.walk(ast.parse((ROOT / path).read_text())))
    names = {(node.module, name.name) for node in nodes if isinstance(node, ast.ImportFrom) for name in node.names}
    return names | {(name.name, "") for node in nodes if isinstance(node, ast.Import) for name in node.names}


def module(path):
    return path.removesuffix(".py").replace("/", ".")


def test_every_room_stands_on_its_floor():
    floors = contract()
    assert {floor for floor, _ in ROOMS} == set(range(1, len(floors) + 1))
    assert [{room for floor, room in ROOMS if floor == number} for number in range(1, len(floors) + 1)] == floors


def test_the_page_has_the_rooms_of_the_tree():
    folders = {path.parent.name for path in (ROOT / "symfpu").glob("*/__init__.py")}
    files = {path.stem for path in (ROOT / "symfpu").glob("*.py")} - {"__init__"}
    assert sorted(room for _, room in ROOMS) == sorted(folders | files)


@pytest.mark.parametrize(("path", "name"), WAY, ids=lambda word: word)
def test_what_the_way_passes_is_there(path, name):
    defined = {node.name for node in ast.parse((ROOT / path).read_text()).body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    assert name in defined


CHECKERS = {
    "reading": set(),
    "rounding": set(),
    "propagation": {"reading"},
    "every_length": {"reading", "propagation"},
    "torus": {"reading", "rounding"},
    "existence": {"reading", "rounding"},
    "stability": {"reading", "rounding", "existence"},
    "verify": {"reading", "propagation", "every_length", "torus", "existence", "stability"},
}


@pytest.mark.parametrize("name", CHECKERS)
def test_a_checker_imports_the_standard_library_and_checkers_alone(name):
    room = ROOT / "symfpu" / "checkers"
    files = sorted((room / name).glob("*.py")) or [room / f"{name}.py"]
    found = set().union(*(imported(file.relative_to(ROOT)) for file in files))
    allowed = {f"symfpu.checkers.{part}" for part in CHECKERS[name] | {name}}
    named = {f"{source}.{part}" if source == "symfpu.checkers" else source for source, part in found}
    ours = {source for source in named if source.startswith("symfpu")}
    assert {source for source in ours if not source.startswith(tuple(allowed))} == set()
    assert {source.partition(".")[0] for source in named - ours} <= sys.stdlib_module_names


def test_importing_a_checker_loads_nothing_else():
    """Run alone in a new process: the package itself loads nothing that checkers could use."""
    script = f"import sys\nfrom symfpu.checkers import {', '.join(CHECKERS)}\nprint(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-S", "-c", script], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()
    ours = {name for name in loaded if name.startswith("symfpu.checkers.")}
    assert {name.split(".")[2] for name in ours} == set(CHECKERS)
    assert {name for name in loaded if name.startswith("symfpu")} - ours == {"symfpu", "symfpu.checkers"}
    assert {name.partition(".")[0] for name in loaded} <= sys.stdlib_module_names | {"symfpu", "__main__"}


@pytest.mark.parametrize("file", sorted((ROOT / "generated").glob("*.py")), ids=lambda file: file.name)
def test_exported_files_stand_alone(file):
    assert [source for source, _ in imported(file.relative_to(ROOT)) if source.startswith("symfpu")] == []
