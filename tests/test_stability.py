"""docs/stability.md: every public name is stable or provisional, once, in the group of the stub."""

import ast
import re
from pathlib import Path

import symfpu

ROOT = Path(__file__).parents[1]
ROWS = [line.strip("|").split("|") for line in (ROOT / "docs" / "stability.md").read_text().splitlines() if line.startswith("| ")][2:]
NAMES = [[re.findall(r"`(\w+)`", cell) for cell in row[1:]] for row in ROWS]


def stub_groups():
    """Names by the comment above them."""
    text = (ROOT / "symfpu" / "__init__.pyi").read_text()
    parts = re.split(r"^# (.*)$", text, flags=re.MULTILINE)[1:]
    groups = {}
    for title, body in zip(parts[::2], parts[1::2], strict=True):
        imports = [node for node in ast.parse(body).body if isinstance(node, ast.ImportFrom)]
        groups[title.partition(":")[0]] = [alias.name for node in imports for alias in node.names]
    return groups


def test_every_public_name_is_listed_once():
    listed = [name for row in NAMES for cell in row for name in cell]
    assert sorted(listed) == sorted([*symfpu.__all__, "plots"])


def test_names_stand_in_the_groups_of_the_stub():
    assert {row[0].strip(): {name for cell in cells for name in cell} for row, cells in zip(ROWS, NAMES, strict=True)} == {
        title: set(names) for title, names in stub_groups().items()
    }


def test_what_a_stable_function_is_documented_to_return_or_take_is_not_hidden():
    """The first example's names are stable."""
    stable = {name for row in NAMES for name in row[0]}
    assert {"Chain", "lindstedt", "solve_amplitudes", "torus_at_energy", "assess", "refine", "save", "load", "InputError"} <= stable
