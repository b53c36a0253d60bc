"""Writes docs/equations.md: every label of the paper, and the files and functions whose docstrings cite it.

    python docs/make_equations.py

The labels stand in docs/equations.toml. A docstring cites as "Eq. omeser", "Eqs. moda, modb", "Eqs. delome to omeprime",
"Eqs. eksa (alpha) and eksp (beta)", "Definition 4", "section 3.2", "Appendix A", "Lemma", "Proposition". A list after "Eqs."
ends with its last label: what follows it does not begin with a comma, "and" or "to".
"""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

DOCS = Path(__file__).parent
ROOT = DOCS.parent
PAGE = DOCS / "equations.md"
LAST_ROOM = "symfpu/paper/"  # what judges the paper comes after what computes

ONE = re.compile(r"\bEq\. ([A-Za-z]\w*)")
SEVERAL = re.compile(r"\bEqs\. (?=[A-Za-z])")
LABEL = re.compile(r"([A-Za-z]\w*)(?: \([^)]*\))?")
SEPARATOR = re.compile(r", and |, | and | to ")
NAMED = re.compile(r"\b(Lemma|Proposition|Appendix [A-F]|Definition [1-4])\b")
SECTIONS = re.compile(r"\b[Ss]ections? (\d[\d.]*\b(?:(?:, | and )\d[\d.]*\b)*)")

HEAD = """# Where the equations of the paper are

Written by `make equations` from the docstrings; do not edit. Labels are those of the LaTeX source of
{source}.
Files are those of `symfpu/`. Where the code differs from a printed form, [errata.md](errata.md) says so.
"""


def parts() -> tuple[str, list[dict[str, object]]]:
    """The source, and the parts of the paper with their items, as docs/equations.toml has them."""
    table = tomllib.loads((DOCS / "equations.toml").read_text())
    return table["source"], table["part"]


def items() -> dict[str, dict[str, str]]:
    """Every item by its label, in the order of the paper."""
    _, found = parts()
    return {item["label"]: item for part in found for item in part["items"]}


def cited(text: str, order: list[str]) -> list[str]:
    """The labels that a text cites; order : the labels as the paper has them, for "Eqs. a to c"."""
    words = " ".join(text.split())
    labels = ONE.findall(words)
    for match in SEVERAL.finditer(words):
        labels += _listed(words, match.end(), order)
    labels += NAMED.findall(words)
    labels += [
        f"section {number}"
        for found in SECTIONS.findall(words)
        for number in re.split(", | and ", found)
    ]
    return list(dict.fromkeys(labels))


def _listed(words: str, at: int, order: list[str]) -> list[str]:
    """The labels of a list that begins at a place."""
    labels: list[str] = []
    joint = ""
    while match := LABEL.match(words, at):
        label = match[1]
        if joint == " to " and {label, labels[-1]} <= set(order):
            equations = [name for name in order if " " not in name]
            labels += equations[equations.index(labels[-1]) + 1 : equations.index(label)]
        labels.append(label)
        separator = SEPARATOR.match(words, match.end())
        if not separator:
            break
        joint, at = separator[0], separator.end()
    return labels


def docstrings(path: Path) -> Iterator[tuple[str, str]]:
    """The names in a file, "" for the file itself, with their docstrings."""

    def below(node: ast.AST, prefix: str) -> Iterator[tuple[str, str]]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
                name = prefix + child.name
                yield name, ast.get_docstring(child) or ""
                yield from below(child, f"{name}.")

    tree = ast.parse(path.read_text())
    yield "", ast.get_docstring(tree) or ""
    yield from below(tree, "")


def citations() -> dict[str, list[tuple[str, str]]]:
    """By label, the files and names whose docstrings cite it."""
    order = list(items())
    found: dict[str, list[tuple[str, str]]] = {}
    for path in sorted((ROOT / "symfpu").rglob("*.py")):
        file = path.relative_to(ROOT).as_posix()
        for name, text in docstrings(path):
            for label in cited(text, order):
                found.setdefault(label, []).append((file, name))
    return found


def homes(item: dict[str, object]) -> list[tuple[str, str]]:
    """Where an item lives, as files and names."""
    found = []
    for home in item.get("home", []):
        file, _, name = home.partition("::")
        found.append((f"symfpu/{file}", name))
    return found


def _places(found: list[tuple[str, str]]) -> str:
    """A file a line, with its names."""
    lines = []
    ordered = sorted(found, key=lambda place: (place[0].startswith(LAST_ROOM), place[0]))
    for file, places in groupby(ordered, key=lambda place: place[0]):
        names = ", ".join(f"`{name}`" for _, name in places if name)
        link = f"[{file.removeprefix('symfpu/')}](../{file})"
        lines.append(f"{link}: {names}" if names else link)
    return "<br>".join(lines)


def _row(item: dict[str, object], cited_by: list[tuple[str, str]]) -> str:
    """A line of the table: where the item lives, and what else cites it."""
    at_home = homes(item)
    files = [(file, "") for file, _ in at_home]
    others = [place for place in cited_by if place not in at_home + files]
    lives = f"not used: {item['unused']}" if "unused" in item else _places(at_home)
    return f"| {item['label']} | {item['about']} | {lives} | {_places(others)} |"


def page() -> str:
    """The whole page."""
    source, found = parts()
    where = citations()
    lines = [HEAD.format(source=source)]
    for part in found:
        lines += [
            f"## {part['title']}",
            "",
            "| label | what | lives in | cited by, too |",
            "| --- | --- | --- | --- |",
        ]
        lines += [_row(item, where.get(item["label"], [])) for item in part["items"]]
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    PAGE.write_text(page())
