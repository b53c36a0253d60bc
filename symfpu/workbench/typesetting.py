"""Labels of pictures, which are TeX between dollars, as text of SVG with indices."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape

SYMBOLS = {
    "nu": "\u03bd",
    "omega": "\u03c9",
    "Omega": "\u03a9",
    "lambda": "\u03bb",
    "theta": "\u03b8",
    "mu": "\u03bc",
    "pi": "\u03c0",
    "Delta": "\u0394",
    "sum": "\u03a3",
    "cdot": "\u00b7",
    "times": "\u00d7",
    "max": "max",
    "log": "log",
    ",": "",
    "mathdefault": "",
    "quad": "\u2003",
}
THIN = "\u2009"  # space
BAR = "\u0304"  # above the letter before it
UPRIGHT = ("max", "log")
TOKEN = re.compile(r"\\([A-Za-z]+|.)|([_^])|([{}])|([A-Za-z]+)|(\s+)|(.)")
SMALL = 0.72  # size of an index
BELOW, ABOVE = 0.28, -0.42  # of the size of the text: how far an index is moved


def svg_text(label: str) -> str:
    """A label as content of an SVG element `text`; letters in formulas are slanted.

    >>> svg_text("order $k$")
    'order <tspan font-style="italic">k</tspan>'
    """
    pieces = [_piece(*piece) for piece in _levelled(label)]
    return "".join(pieces)


def plain(label: str) -> str:
    """A label as plain text, for titles and to count its characters.

    >>> plain(r"$D_{12}$, $10^{-3}$")
    'D12, 10\u22123'
    """
    return "".join(text for text, *_ in _levelled(label))


def _piece(text: str, slanted: bool, move: float, size: float) -> str:
    style = ' font-style="italic"' if slanted else ""
    if move:
        style += f' dy="{move:.2f}em"'
    if size != 1:
        style += f' font-size="{size:.0%}"'
    return f"<tspan{style}>{escape(text)}</tspan>" if style else escape(text)


def _levelled(label: str) -> Iterator[tuple[str, bool, float, float]]:
    """Text, whether it is slanted, how far down from the text before it, and its size."""
    height = 0.0  # in units of the full size
    for i, part in enumerate(label.split("$")):
        pieces = _math(part) if i % 2 else [(part, False, 0.0)]
        for text, slanted, level in pieces:
            size = SMALL if level else 1.0
            move = (level - height) / size
            height = level
            yield text, slanted, move, size


def _math(source: str) -> Iterator[tuple[str, bool, float]]:
    """Text, whether slanted, and its level; of the TeX that the pictures use."""
    levels, coming, barred, upright = [0.0], 0.0, False, False
    for name, script, brace, letters, space, other in TOKEN.findall(source):
        if script:
            coming = BELOW if script == "_" else ABOVE
        elif brace == "{":
            levels.append(coming or levels[-1])
            coming = 0.0
        elif brace == "}":
            levels.pop()
        elif name == "overline":
            barred = True
        elif name == "mathrm":
            upright = True
        elif name or letters or other:
            level, coming = coming or levels[-1], 0.0
            text = SYMBOLS[name] if name else letters or other.replace("-", "\u2212")
            slanted = bool(letters) or (name.isalpha() and name not in UPRIGHT)
            if upright and letters:
                slanted = upright = False
            if barred and letters:
                text, barred = text + BAR, False
            if text:
                yield text, slanted and name not in ("sum", "cdot", "times"), level
        elif space and levels[-1] == 0:
            yield THIN, False, 0.0
