"""Links of the built site: those within it lead to pages and anchors that are there, those out of it ask the network."""

from __future__ import annotations

import re
import socket
from collections.abc import Iterable, Mapping
from html.parser import HTMLParser
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit

ELSEWHERE = re.compile(r"https?://[\w.-]+")
PATIENCE = 5.0  # seconds for a host to answer


class Page(HTMLParser):
    """Links and targets of a page, and what it loads."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.targets: set[str] = set()
        self.loaded: list[str] = []
        self.feed(path.read_text())

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Notes what a tag names, links and loads."""
        known = {name: value for name, value in attrs if value}
        self.targets |= {known[name] for name in ("id", "name") if name in known}
        if tag == "a" and "href" in known:
            self.links.append(known["href"])
        if tag in ("script", "img", "link"):
            self.loaded += [known[name] for name in ("src", "href") if name in known]


def pages(folder: Path) -> dict[str, Page]:
    """All pages of a built site, by their paths in it."""
    return {
        path.relative_to(folder).as_posix(): Page(path) for path in folder.rglob("*.html")
    }


def lost_links(site: Mapping[str, Page], files: set[str]) -> list[tuple[str, str]]:
    """(page, link) of every link within the site to a file or an anchor that is not there."""
    return [
        (name, link)
        for name, page in site.items()
        for link in page.links
        if not urlsplit(link).scheme and not _leads(name, link, site, files)
    ]


def _leads(name: str, link: str, site: Mapping[str, Page], files: set[str]) -> bool:
    path, _, anchor = unquote(link).partition("#")
    target = _within(PurePosixPath(name).parent / path) if path else name
    if target not in files:
        return False
    return not anchor or target not in site or anchor in site[target].targets


def _within(path: PurePosixPath) -> str:
    """The path without its steps upwards; it may leave the site, and then is no file of it."""
    parts: list[str] = []
    for part in path.parts:
        if part == ".." and parts and parts[-1] != "..":
            parts.pop()
        else:
            parts.append(part)
    return "/".join(parts)


def lost_in(folder: Path) -> list[tuple[str, str]]:
    """The lost links of a built site."""
    files = {
        path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()
    }
    return lost_links(pages(folder), files)


def silent_hosts(written: Iterable[Path]) -> list[str]:
    """The hosts that some files link to, if none of them can be reached; else none."""
    texts = [path.read_text() for path in written]
    found = {urlsplit(link).netloc for text in texts for link in ELSEWHERE.findall(text)}
    hosts = sorted(found)
    return [] if any(map(_answers, hosts)) else hosts


def _answers(host: str) -> bool:
    try:
        socket.create_connection((host, 443), PATIENCE).close()
    except OSError:
        return False
    return True
