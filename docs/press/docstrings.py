"""Docstrings of symfpu, which are plain text, as reStructuredText for autodoc.

Lines `name, name : text` about arguments and fields become lists of definitions, paragraphs stay, examples stay; characters that
reStructuredText would read as its own are kept as they are.
"""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from typing import Any

import symfpu
from press.plain import prose
from press.topics import bases_of

ROOT = Path(symfpu.__file__).parents[1]
HEAD = re.compile(r"\*{0,2}\w+(?:, \*{0,2}\w+)* : ")
# entries that follow each other on a line
SEVERAL = re.compile(rf"(?<=[.;]) (?={HEAD.pattern})")


def names_of(thing: Any) -> set[str]:
    """Arguments of a function, fields and attributes of a class."""
    if inspect.isclass(thing):
        fields = {
            name for base in inspect.getmro(thing) for name in inspect.get_annotations(base)
        }
        stored = set(re.findall(r"self\.(\w+)", _source(thing)))
        return fields | set(dir(thing)) | stored | _arguments(thing)
    return _arguments(getattr(thing, "fget", None) or thing)


def _source(thing: Any) -> str:
    try:
        return inspect.getsource(thing)
    except (OSError, TypeError):
        return ""


def _arguments(thing: Any) -> set[str]:
    try:
        return set(inspect.signature(thing).parameters)
    except (TypeError, ValueError):
        return set()


def rest(lines: list[str], names: set[str]) -> list[str]:
    """A docstring as reStructuredText. names : what its parameter lists may be about."""
    written: list[str] = []
    kind = ""
    for before, line in zip(["", *lines], lines, strict=False):
        if line.startswith((">>>", "...")) or (kind == "example" and line.strip()):
            new, text = "example", line
        elif not line.strip():
            new, text = "", ""
        elif _about(line, names):
            new, text = "field", line
        elif line.startswith("    "):
            new = "field" if kind == "field" else "formula"
            text = line if kind == "field" else f"    {prose(line.strip())}"
        else:
            new, text = "prose", prose(line)
        if text and new != kind and before.strip():
            written.append("")
        written += _field(text, names) if new == "field" else [text]
        kind = new
    return written


def _about(line: str, names: set[str]) -> list[str]:
    """The names that a line of a parameter list is about."""
    found = HEAD.match(line)
    listed = found[0].removesuffix(" : ").replace("*", "").split(", ") if found else []
    return listed if set(listed) <= names else []


def _field(line: str, names: set[str]) -> list[str]:
    """A line of a parameter list: it may open several entries, or go on with the last one."""
    written = []
    for piece in SEVERAL.split(line.strip()):
        listed = _about(piece, names)
        if listed:
            written.append(", ".join(f"**{prose(name)}**" for name in listed))
            piece = HEAD.sub("", piece, count=1)
        written.append(f"    {prose(piece)}")
    return written


def process(
    app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]
) -> None:
    """The event autodoc-process-docstring."""
    written = rest(list(lines), names_of(obj))
    if what == "class":
        bases = [
            f":py:class:`~{base.__module__}.{base.__name__}`" for base in bases_of(obj)
        ]
        written += (
            ["", f"It also has the methods of {', '.join(bases)}.", ""] if bases else []
        )
    if what in ("class", "function", "exception"):
        written += ["", f"Source: ``{home(obj)}``", ""]
    lines[:] = written


def home(thing: Any) -> str:
    """The file and the line where it is written, as symfpu/chain/chain.py:12."""
    unwrapped = inspect.unwrap(thing)
    file = Path(inspect.getfile(unwrapped)).relative_to(ROOT)
    return f"{file.as_posix()}:{inspect.getsourcelines(unwrapped)[1]}"


def signature(
    app: Any,
    what: str,
    name: str,
    obj: Any,
    options: Any,
    arguments: str | None,
    returned: str | None,
) -> tuple[str, str] | None:
    """The event autodoc-process-signature: arguments without types, and the result where it is a public name."""
    if what not in ("class", "function", "method", "exception"):
        return None
    try:
        found = inspect.signature(obj)
    except (TypeError, ValueError):
        return None
    if what == "exception":
        return "", ""
    bare = [
        one.replace(annotation=inspect.Parameter.empty) for one in found.parameters.values()
    ]
    if what == "method" and bare and bare[0].name in ("self", "cls"):
        bare = bare[1:]
    gives = str(found.return_annotation)
    known = gives if gives in symfpu.__all__ and what != "class" else ""
    shown = str(found.replace(parameters=bare, return_annotation=inspect.Signature.empty))
    return shown, known


def setup(app: Any) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", process)
    app.connect("autodoc-process-signature", signature)
    return {"parallel_read_safe": True}
