"""Links that the pages carry to be read on a code host too, and names, as links of the site.

A link that leads out of docs/ to a file or folder of the repository leads to a page that shows it. A literal that is a
public name leads to the API, one that is a file of the repository to that file; "Eq. omeser" leads to the index of
equations, whose lines become targets.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from make_equations import items
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexer import Lexer
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx import addnodes
from sphinx.transforms.post_transforms import SphinxPostTransform

import symfpu

ROOT = Path(symfpu.__file__).parents[1]
FILES = "_files"  # pages that show files of the repository
INDEX = "equations"  # the page with all labels
TUTORIALS = {"notebooks": "tutorials/index", "docs": "index", "README.md": "index"}
CALLED = re.compile(r"(?:symfpu\.)?(\w+(?:\.\w+)*)(?:\(.*\))?", re.DOTALL)
LINED = re.compile(r"([\w./-]+?):(\d+)")
LABELS = sorted((label for label in items() if " " not in label), key=len, reverse=True)
LABEL = "|".join(LABELS)
CITED = re.compile(rf"\bEqs?\. (?:{LABEL})\b(?:(?:, and |, | and | to )(?:{LABEL})\b)*")
ONE = re.compile(rf"\b(?:{LABEL})\b")
UNTOUCHED = (
    nodes.reference,
    nodes.title,
    addnodes.desc_signature,
    addnodes.pending_xref,
    nodes.literal_block,
    nodes.raw,
)
SHARED = "api/what-results-share"
MODULES = {
    "plots": ("symfpu.plots.", "symfpu."),
    "api/pictures": ("symfpu.plots.", "symfpu."),
}
COLOURED, SHOWN = 60_000, 400_000  # bytes up to which a file has colours, and is shown
LINES = HtmlFormatter(linenos="inline", lineanchors="line", anchorlinenos=True)


def page_of(path: str) -> str:
    """The page of the site that shows a file or folder of the repository."""
    if path in TUTORIALS:
        return TUTORIALS[path]
    if path.startswith("docs/") and path.endswith(".md"):
        return path.removeprefix("docs/").removesuffix(".md")
    if path.startswith("notebooks/") and path.endswith(".ipynb"):
        return f"tutorials/{Path(path).stem}"
    return f"{FILES}/{path}"


def repository_path(target: str, docname: str) -> str | None:
    """The file or folder of the repository that a link of a page means; None for what is not there."""
    folder = {"tutorials": "notebooks"}.get(docname.partition("/")[0], "docs")
    for start in (folder, "."):  # what is taken from README.md has links from the root
        path = os.path.normpath(f"{start}/{target}")
        if not path.startswith("..") and path != "." and (ROOT / path).exists():
            return path
    return None


class RepositoryLinks(SphinxPostTransform):
    """Before MyST resolves its references: those to files of the repository."""

    default_priority = 5

    def run(self, **kwargs: Any) -> None:
        for node in list(self.document.findall(addnodes.pending_xref)):
            if node.get("reftype") == "myst":
                self._resolve(node)

    def _resolve(self, node: addnodes.pending_xref) -> None:
        target = node["reftarget"]
        if node.get("refdomain") == "doc" and target in self.env.found_docs:
            return
        ending = ".md" if node.get("refdomain") == "doc" else ""
        path = repository_path(target.partition("#")[0] + ending, self.env.docname)
        if path is not None:
            link = _link(self.app, self.env.docname, path, "")
            link += node.children
            node.replace_self(link)


class NameLinks(SphinxPostTransform):
    """Literals that are names or files, and equations that are cited."""

    default_priority = 400

    def run(self, **kwargs: Any) -> None:
        for literal in list(self.document.findall(nodes.literal)):
            if not _within(literal):
                self._name(literal)
        if self.env.docname != INDEX:
            for text in list(self.document.findall(nodes.Text)):
                if not _within(text) and not isinstance(text.parent, nodes.literal):
                    _cite(self.app, self.env.docname, text)

    def _name(self, literal: nodes.literal) -> None:
        link = self._api(literal.astext()) or self._file(literal.astext())
        if link is not None:
            literal.replace_self(link)
            link += literal

    def _api(self, words: str) -> nodes.reference | None:
        found = CALLED.fullmatch(words)
        entry = self._entry(found[1]) if found else None
        if entry is None:
            return None
        uri = self.app.builder.get_relative_uri(self.env.docname, entry.docname)
        return nodes.reference("", "", internal=True, refuri=f"{uri}#{entry.node_id}")

    def _entry(self, name: str) -> Any:
        """The place of a public name, or of a class or method that results share."""
        objects = self.env.domains["py"].objects
        prefixes = MODULES.get(self.env.docname, ("symfpu.",))
        public = (objects.get(prefix + name) for prefix in prefixes)
        shared = (
            entry
            for full, entry in objects.items()
            if full.endswith(f".{name}") and entry.docname == SHARED
        )
        return next((entry for entry in [*public, *shared] if entry is not None), None)

    def _file(self, words: str) -> nodes.reference | None:
        lined = LINED.fullmatch(words)
        path, line = (lined[1], lined[2]) if lined else (words.rstrip("/"), "")
        known = (
            "/" in path
            and " " not in path
            and ".." not in path
            and not path.startswith("/")
        )
        if not known or not (ROOT / path).exists() or path.startswith("docs/gallery"):
            return None
        return _link(self.app, self.env.docname, path, line)


def _within(node: nodes.Node) -> bool:
    """Whether it stands in what has a link, or may have none."""
    while (node := node.parent) is not None:
        if isinstance(node, UNTOUCHED):
            return True
    return False


def _link(app: Any, docname: str, path: str, line: str) -> nodes.reference:
    """To the page that shows a file, which is made if there is none yet."""
    page = page_of(path)
    if page.startswith(FILES):
        app.shown_files.add(path)
        app.shown_files.update(inside(path) if (ROOT / path).is_dir() else ())
    elif page not in app.env.found_docs:
        raise LookupError(f"{docname}: {path} has no page {page}")
    uri = app.builder.get_relative_uri(docname, page)
    return nodes.reference(
        "", "", internal=True, refuri=uri + (f"#line-{line}" if line else "")
    )


def _cite(app: Any, docname: str, text: nodes.Text) -> None:
    """Labels of equations in a text become links to the index."""
    words, parts, last = str(text), [], 0
    places = [
        one for cited in CITED.finditer(words) for one in ONE.finditer(words, *cited.span())
    ]
    for one in places:
        uri = f"{app.builder.get_relative_uri(docname, INDEX)}#{identifier(one[0])}"
        link = nodes.reference("", one[0], internal=True, refuri=uri)
        parts += [nodes.Text(words[last : one.start()]), link]
        last = one.end()
    if parts:
        text.parent.replace(text, [*parts, nodes.Text(words[last:])])


def identifier(label: str) -> str:
    return f"equation-{nodes.make_id(label)}"


def mark_equations(app: Any, doctree: nodes.document) -> None:
    """Every line of the index is a target."""
    if app.env.docname == INDEX:
        for row in doctree.findall(nodes.row):
            label = row[0].astext()
            if label in items():
                row["ids"].append(identifier(label))


def inside(path: str) -> list[str]:
    """What a folder of the repository shows: the files right in it."""
    found = sorted((ROOT / path).iterdir())
    return [
        f"{path}/{one.name}"
        for one in found
        if one.is_file() and not one.name.startswith(".")
    ]


def file_pages(app: Any) -> Iterator[tuple[str, dict[str, str], str]]:
    """The event html-collect-pages: files and folders of the repository that the pages name."""
    for path in sorted(app.shown_files):
        page = f"{FILES}/{path}"
        body = (
            _folder(app, path, page) if (ROOT / path).is_dir() else _coloured(ROOT / path)
        )
        title = f"<h1><code>{escape(path)}</code></h1>"
        yield (
            page,
            {"title": path, "body": f'<div class="repository-file">{title}{body}</div>'},
            "page.html",
        )


def _folder(app: Any, path: str, page: str) -> str:
    lines = []
    for one in inside(path):
        uri = app.builder.get_relative_uri(page, page_of(one))
        lines.append(f'<li><a href="{uri}"><code>{escape(Path(one).name)}</code></a></li>')
    return f"<ul>{''.join(lines)}</ul>"


def _coloured(path: Path) -> str:
    """The text of a file with numbered lines."""
    content = path.read_bytes()
    try:
        text = content.decode()
    except UnicodeDecodeError:
        return f"<p>{len(content)} bytes, no text.</p>"
    if len(text) > SHOWN:
        return f"<p>{len(content)} bytes: too long to be shown.</p>"
    return highlight(text, _lexer(path, text), LINES)


def _lexer(path: Path, text: str) -> Lexer:
    try:
        return get_lexer_for_filename(path.name) if len(text) < COLOURED else TextLexer()
    except ClassNotFound:
        return TextLexer()


def begin(app: Any) -> None:
    app.shown_files = set()


def setup(app: Any) -> dict[str, bool]:
    app.connect("builder-inited", begin)
    app.connect("doctree-read", mark_equations)
    app.connect("html-collect-pages", file_pages)
    app.add_post_transform(RepositoryLinks)
    app.add_post_transform(NameLinks)
    return {"parallel_read_safe": True, "parallel_write_safe": False}
