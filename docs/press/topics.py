"""Public names by topic, as the groups of symfpu/__init__.pyi have them, and the pages of the API.

A comment of the stub opens a topic; the imports below it, up to the next comment, are its names. A module among
them stands for the public names of its own `__init__`. Nothing is typed here a second time.
"""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import symfpu
from press.plain import prose

STUB = Path(symfpu.__file__).with_name("__init__.pyi")
COMMENT = re.compile(r"^# (.+)$", re.MULTILINE)
SHARED = "What results share"
SHARED_WORDS = "Classes that results are made from. A result has its own methods, on its own page, and these."


@dataclass(frozen=True)
class Topic:
    """A group of public names. words : of the stub. names : as in Python, "symfpu.lindstedt"."""

    words: str
    names: tuple[str, ...]

    @property
    def title(self) -> str:
        """The words up to the first comma or colon."""
        first = re.split("[,:]", self.words)[0]
        return first[0].upper() + first[1:]

    @property
    def rest(self) -> str:
        """What the words say after the title, as a sentence."""
        more = re.sub("^[,: ]+(and )?", "", self.words[len(self.title) :])
        return more[:1].upper() + more[1:] + "." * bool(more)

    @property
    def slug(self) -> str:
        return "-".join(self.title.lower().replace("'", "").split())


def topics(stub: str | None = None) -> list[Topic]:
    """The topics in the order of the stub. stub : its text; default that of the package."""
    text = STUB.read_text() if stub is None else stub
    heads = [
        (text.count("\n", 0, match.start()) + 1, match[1])
        for match in COMMENT.finditer(text)
    ]
    imports = [line for line in ast.parse(text).body if isinstance(line, ast.ImportFrom)]
    ends = [line for line, _ in heads[1:]] + [text.count("\n") + 2]
    found = []
    for (start, words), end in zip(heads, ends, strict=True):
        within = [line for line in imports if start < line.lineno < end]
        names = [
            name
            for line in within
            for alias in line.names
            for name in _names(line.module, alias.name)
        ]
        found.append(Topic(words, tuple(names)))
    return [topic for topic in found if topic.names]


def _names(module: str | None, name: str) -> Iterator[str]:
    """A public name, or those of a public module."""
    room = find_spec(f"{module}.{name}") if module == "symfpu" else None
    if room is None:
        yield f"symfpu.{name}"
        return
    tree = ast.parse(Path(str(room.origin)).read_text())
    for line in tree.body:
        if isinstance(line, ast.ImportFrom):
            yield from (
                f"{room.name}.{alias.asname}" for alias in line.names if alias.asname
            )


def thing(name: str) -> Any:
    """What a dotted name stands for."""
    module, _, last = name.rpartition(".")
    return getattr(import_module(module), last)


def shared_classes(names: Iterable[str]) -> list[str]:
    """Classes of symfpu that are no public names, and from which public ones inherit; dotted names."""
    public = [thing(name) for name in names]
    classes = [one for one in public if inspect.isclass(one)]
    bases = dict.fromkeys(base for one in classes for base in bases_of(one))
    return [f"{base.__module__}.{base.__name__}" for base in bases if base not in public]


def bases_of(one: type) -> list[type]:
    """The bases of a class that belong to symfpu and say what they are."""
    above = inspect.getmro(one)[1:]
    ours = [base for base in above if base.__module__.startswith("symfpu.")]
    return [
        base for base in ours if not base.__name__.startswith("_") and _public_members(base)
    ]


def _public_members(base: type) -> list[str]:
    return [
        name
        for name in vars(base)
        if not name.startswith("_") and inspect.getdoc(vars(base)[name])
    ]


def pages() -> dict[str, str]:
    """The pages of the API by name without ending, in reStructuredText."""
    found = topics()
    everything = [name for topic in found for name in topic.names]
    shared = Topic(SHARED, tuple(shared_classes(everything)))
    written = {topic.slug: _page(topic, topic.rest) for topic in found} | {
        shared.slug: _page(shared, SHARED_WORDS)
    }
    return {"index": _index([*found, shared])} | written


def _headed(title: str) -> list[str]:
    return [title, "=" * len(title), ""]


def _index(found: list[Topic]) -> str:
    """All topics, with their names."""
    lines = [
        *_headed("Public names"),
        "Every public name of symfpu, by what it is about.",
        "",
    ]
    for topic in found:
        listed = ", ".join(f":py:obj:`~{name}`" for name in topic.names)
        lines += [f":doc:`{topic.title} <{topic.slug}>`", f"    {listed}", ""]
    lines += [".. toctree::", "   :hidden:", ""]
    return "\n".join([*lines, *(f"   {topic.slug}" for topic in found), ""])


def _page(topic: Topic, words: str) -> str:
    """A table of the names, then each of them in full."""
    lines = [
        *_headed(topic.title),
        prose(words),
        "",
        ".. list-table::",
        "   :class: names",
        "   :widths: 30 70",
        "",
    ]
    for name in topic.names:
        lines += [f"   * - :py:obj:`~{name}`", f"     - {first_line(name)}"]
    for name in topic.names:
        module, _, last = name.rpartition(".")
        kind = "autofunction" if not inspect.isclass(thing(name)) else "autoclass"
        error = kind == "autoclass" and issubclass(thing(name), Exception)
        lines += ["", f".. py:currentmodule:: {module}", "", f".. {kind}:: {last}"]
        lines += ["   :members:"] if kind == "autoclass" and not error else []
    return "\n".join([*lines, ""])


def first_line(name: str) -> str:
    """What a name gives, in reStructuredText."""
    return prose((inspect.getdoc(thing(name)) or "").split("\n")[0])
