"""Where `plot()` of results finds their pictures.

Pictures are drawn by a room far above results, which makes them known when it is imported: the
package itself, which has all rooms, does that when the first picture is asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import symfpu


@dataclass(frozen=True)
class Picture:
    """What `plot()` draws of a kind of result.

    draw : by result and axes. small : the picture beside an answer, the bytes of a PNG file.
    possible : whether a result has what it shows. name : in words.
    """

    draw: Callable[..., Any]
    small: Callable[[Any], bytes]
    name: str
    possible: Callable[[Any], bool]


KNOWN: dict[type, Picture] = {}


def picture_of(kind: type) -> Picture | None:
    """The picture of a class, or of the nearest one that it inherits from."""
    symfpu._load_pictures()
    return next((KNOWN[one] for one in kind.__mro__ if one in KNOWN), None)
