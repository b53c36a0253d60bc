"""Plain text as reStructuredText."""

from __future__ import annotations

import re

CODE = re.compile(r"`([^`\n]+)`")
SPECIAL = re.compile(r"([\\*`|_])")


def prose(text: str) -> str:
    """A line of plain text; what stands in backticks becomes a literal."""
    pieces = CODE.split(text)
    kept = [
        SPECIAL.sub(r"\\\1", piece) if i % 2 == 0 else f"``{piece}``"
        for i, piece in enumerate(pieces)
    ]
    return "".join(_apart(kept))


def _apart(pieces: list[str]) -> list[str]:
    """Literals keep a boundary to letters beside them."""
    for i in range(2, len(pieces), 2):
        if re.match(r"\w", pieces[i]):
            pieces[i] = "\\ " + pieces[i]
    return pieces
