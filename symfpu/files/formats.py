"""What kind a file of ours is that is not the one asked for, and what opens it."""

from __future__ import annotations

import re
from pathlib import Path

from symfpu.files.writing import open_to_read

ARCHIVE = b"PK\x03\x04"  # with which an archive begins
NAMED = re.compile(r'"format":\s*"([^"\\]*)"')
LONGEST_HEAD = 4096  # bytes in which a file names its format
BUNDLE = "symfpu bundle"  # what the document of an archive of ours names
ZIPPED = "ZIP archive"
OPENED_BY = {
    ZIPPED: "symfpu show opens those that symfpu.save wrote",
    "symfpu sweep": "read_sweep reads it, and sweep or frequency_map goes on from it",
    "symfpu decided flats": "symfpu prove --all-N --file goes on from it",
}


def format_of(path: Path) -> str:
    """The format that the head of a file names, ZIPPED of an archive; "" where it names none."""
    with open_to_read(path) as file:
        head = file.read(LONGEST_HEAD)
    if head.startswith(ARCHIVE):
        return ZIPPED
    found = NAMED.search(head.decode("ascii", "replace"))
    return found[1] if found else ""


def opened_by(named: str) -> str | None:
    """What opens a file of a format of ours, in words; None for any other."""
    if named.startswith("symfpu ") and named.endswith(" certificate"):
        return "symfpu verify opens it"
    return OPENED_BY.get(named)
