"""What a reproduction tells of its progress."""

from __future__ import annotations

from typing import Protocol


class Step(Protocol):
    """Hears what comes next, and of a long step the fraction that is done."""

    def __call__(self, label: str, done: float | None = None) -> None: ...


def unheard(label: str, done: float | None = None) -> None:
    """A step that nobody hears of."""
